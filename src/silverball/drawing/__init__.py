"""What a table looks like: a moment of play in, a picture out. There is no window in here.

    still.py    everything that does not move, painted once per table and size from the distances in fields.py
    sprites.py  what moves or lights up, as small images
    renderer.py puts the sprites of one moment on top of the still table

Works without any display: `Renderer(table, size).array(moment)` is an RGB array.
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on the terminal otherwise

from silverball.drawing.camera import Camera, best_size
from silverball.drawing.moment import Moment
from silverball.drawing.renderer import Renderer

__all__ = ["Camera", "Moment", "Renderer", "best_size"]
