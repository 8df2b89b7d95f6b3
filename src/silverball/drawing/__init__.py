"""What a table looks like: a moment of play in, a picture out. There is no window in here.

    camera.py, dimensions.py, themes.py   where everything lies, how tall it is, which colours it has
    scene.py                         the table as arrays, beside the shapes that the physics collides with
    kernels/                         rays, surfaces and light, compiled
    bake_table.py, bake_paddles.py             pictures of what stands still, and of paddles at every angle
    bake_threads.py, picture_provider.py           who bakes, and what comes from the store instead
    (store.py, pictures.py)
    sketch.py, background.py         a picture at once, and a better one soon (warm_up.py)
    compose.py, effects.py           one moment, put together
    renderer.py                      the face of it all

Works without any display: `Renderer(table, size).array(moment)` is an RGB array.
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on the terminal otherwise

from silverball.drawing.camera import Camera, best_size
from silverball.drawing.moment import Moment
from silverball.drawing.renderer import Renderer
from silverball.drawing.themes import THEMES, Theme

__all__ = ["THEMES", "Camera", "Moment", "Renderer", "Theme", "best_size"]
