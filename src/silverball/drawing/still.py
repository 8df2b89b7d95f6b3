"""The still table: in which order is everything painted that does not move?

From the floor upwards: floor, shadows, corners, obstacles, slant walls, apron, rails.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.canvas import to_bytes, tone
from silverball.drawing.floor import paint_floor
from silverball.drawing.obstacles import paint_cylinder, paint_prism, shadow_cylinder, shadow_prism
from silverball.drawing.palette import CYLINDERS, PRISMS, ROOM, in_turn
from silverball.drawing.walls import (
    paint_apron,
    paint_corner,
    paint_rails,
    paint_slant_wall,
    shadow_slant_wall,
)
from silverball.table import Table


def paint_still(table: Table, camera: Camera) -> NDArray[np.uint8]:
    """The table without paddles, balls and score.

    Returns:
        RGB, shape [row, column, 3].
    """
    width, height = camera.size
    canvas = np.empty((height, width, 3), np.float32)
    canvas[:] = tone(ROOM)
    paint_floor(canvas, camera)
    for wall in table.slant_wall:
        shadow_slant_wall(canvas, camera, wall)
    for prism in table.triangular_prism:
        shadow_prism(canvas, camera, prism)
    for cylinder in table.cylinder:
        shadow_cylinder(canvas, camera, cylinder)
    for wall in table.slant_wall:
        paint_corner(canvas, camera, wall)
    for index, prism in enumerate(table.triangular_prism):
        paint_prism(canvas, camera, prism, in_turn(PRISMS, index))
    for index, cylinder in enumerate(table.cylinder):
        paint_cylinder(canvas, camera, cylinder, in_turn(CYLINDERS, index))
    for wall in table.slant_wall:
        paint_slant_wall(canvas, camera, wall)
    paint_apron(canvas, camera)
    paint_rails(canvas, camera)
    return to_bytes(canvas)
