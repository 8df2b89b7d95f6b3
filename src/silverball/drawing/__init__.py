"""Pictures of tables in play, ray-marched and composed without a display or a graphics card.

    renderer.py                           `Renderer`, and what `World.render` calls
    camera.py, dimensions.py, themes.py   projection, heights of the parts, colours
    layout.py, looks.py                   the primitives of a table, and the look of each finish
    scene.py, build_solids.py             a table as arrays for the kernels
    moving.py, poses.py                   what moves, and its pose at a moment of play
    kernels/                              rays, surfaces and light, compiled
    bake_table.py                         the playfield without moving parts
    bake_sprites.py, bake_levels.py       moving parts in every pose; upper levels
    bake_threads.py                       the threads that bake
    picture_provider.py                   baked pictures, cached by picture_cache.py, pictures.py
    sketch.py                             a picture without compiled code, until the table is baked
    background.py, warm_up.py             baking and compiling while a game is played
    compose.py, effects.py                one frame: flashes, moving parts, shadows, trails, balls, sparks
    lamp_levels.py, light_shows.py        how bright each lamp is; lamp_lights.py adds its light
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
