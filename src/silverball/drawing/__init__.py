"""Pictures of tables in play, ray-marched and composed without a display or a graphics card.

    renderer.py                           `Renderer`, and what `World.render` calls
    camera.py, dimensions.py, themes.py   projection, heights of the parts, colours
    scene.py                              a table as arrays for the kernels, next to the physics' own shapes
    kernels/                              rays, surfaces and light, compiled
    bake_table.py, bake_paddles.py        the table without moving parts; the paddles at every angle
    bake_threads.py                       the threads that bake
    picture_provider.py                   baked pictures, cached by picture_cache.py, pictures.py
    sketch.py                             a picture without compiled code, until the table is baked
    background.py, warm_up.py             baking and compiling while a game is played
    compose.py, effects.py                one frame: flashes, paddles, shadows, trails, balls, sparks
    text.py, dotmatrix/                   texts, and the score display

`Renderer(table, height=480).render(world)` is an RGB array.
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # otherwise pygame prints a greeting

from silverball.drawing.camera import Camera, best_size
from silverball.drawing.moment import Moment
from silverball.drawing.renderer import Renderer
from silverball.drawing.themes import THEMES, Theme

__all__ = ["THEMES", "Camera", "Moment", "Renderer", "Theme", "best_size"]
