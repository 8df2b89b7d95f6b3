"""Compile the drawing ahead of time: `python -m silverball.drawing.warm_up` fills the cache of machine code.

It bakes one tiny picture and composes two frames, which compiles exactly the kernels that every picture
calls.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

NICENESS = 5


def compile_all() -> None:
    """Compile every kernel of the drawing, or load it from the cache."""
    from silverball.drawing.moment import BallAt, Moment
    from silverball.drawing.picture_cache import PictureCache
    from silverball.drawing.renderer import Renderer
    from silverball.table import load_table
    from silverball.table.rulebook import Lamp
    from silverball.world import Event

    table = load_table("classic").replace(format=2, lamp=[Lamp(name="lamp", center=(0.0, 0.0), begins="on")])
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(table, (20, 32), cache=PictureCache(Path(folder)))
        hit = Event("hit", "cylinder[0]", 1, 0, 0.0, (5.0, 1.0, 0.0), (1.0, 0.0, 0.0), 12.0)
        renderer.add_events([hit], 240)
        renderer.array(Moment.before(table)._replace(time=0.01, balls=(BallAt(1, 0.0, 0.0),)))
        renderer.array(Moment.before(table)._replace(time=0.02, balls=(BallAt(1, 1.0, 0.0),)))


if __name__ == "__main__":
    if hasattr(os, "nice"):
        with contextlib.suppress(OSError):
            os.nice(NICENESS)
    compile_all()
