"""Is the drawing compiled, and how is it? `python -m silverball.drawing.warm_up` fills the cache of code.

One tiny picture is baked and one moment composed, so exactly those kernels are compiled that every picture
calls.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

LAST_KERNEL = "draw_ball"  # that a moment calls: when it is compiled, all are
NICENESS = 5


def is_compiled() -> bool:
    """Whether the compiled code of the drawing is on disk."""
    from silverball.physics import kernel

    return kernel.is_compiled(LAST_KERNEL, kernel.DRAWING)


def compile_all() -> None:
    """Compile, or load, every kernel of the drawing."""
    from silverball.drawing.moment import BallAt, Moment
    from silverball.drawing.picture_cache import Store
    from silverball.drawing.renderer import Renderer
    from silverball.table import load_table
    from silverball.world import Event

    table = load_table("classic")
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(table, (20, 32), store=Store(Path(folder)))
        hit = Event("hit", "cylinder[0]", 1, 0, 0.0, (5.0, 1.0, 0.0), (1.0, 0.0, 0.0), 12.0)
        renderer.note([hit], 240)
        renderer.array(Moment.before(table)._replace(time=0.01, balls=(BallAt(1, 0.0, 0.0),)))
        renderer.array(Moment.before(table)._replace(time=0.02, balls=(BallAt(1, 1.0, 0.0),)))


if __name__ == "__main__":
    if hasattr(os, "nice"):
        with contextlib.suppress(OSError):
            os.nice(NICENESS)
    compile_all()
