"""How does a scene become pixels? Row by row: first one ray a pixel, then more where neighbours differ.

A canvas is a handful of arrays of the picture's size, filled by these kernels. They write only the pixels
that the mask asks for, in the rows they are given, so that threads share a picture and a patch costs what it
covers.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.march import trace
from silverball.drawing.kernels.shade import part_glow, radiance
from silverball.drawing.kernels.solids import cell_at
from silverball.drawing.kernels.stage import ROOM, Form, Scene
from silverball.drawing.kernels.surfaces import surface_of
from silverball.drawing.kernels.tones import RGB, add_scaled, scale, tone_map
from silverball.physics.kernel import inlined, internal, kernel

CONTRAST = 0.045  # of neighbours, 0 to 1, above which a pixel is looked at more closely
FINE = 4  # rays of such a pixel
FLASH = 2.6  # how much brighter a part is that has just been hit


class Canvas(NamedTuple):
    """A picture in the making.

    Attributes:
        shown: Colours as on the screen, 0 to 1, float32 [row, column, 3].
        light: The linear light of the middle of each pixel, float32 [row, column, 3].
        height: Of the surface above the playfield [u], float32 [row, column].
        part: The number of what is seen, int16 [row, column].
        mask: Which pixels to bake, bool [row, column].
    """

    shown: NDArray[np.float32]
    light: NDArray[np.float32]
    height: NDArray[np.float32]
    part: NDArray[np.int16]
    mask: NDArray[np.bool_]


def new_canvas(size: tuple[int, int]) -> Canvas:
    """An empty canvas of a width and height [pixel], all of which is to be baked."""
    shape = (size[1], size[0])
    return Canvas(
        np.zeros((*shape, 3), np.float32),
        np.zeros((*shape, 3), np.float32),
        np.zeros(shape, np.float32),
        np.zeros(shape, np.int16),
        np.ones(shape, np.bool_),
    )


@internal
def _ray_direction(s: Any, across: float, down: float) -> tuple[float, float, float]:
    """The unit vector from the eye through a point of the picture."""
    u, v = (across - s.across) / s.focal, (s.down - down) / s.focal
    dx, dy, dz = s.sine + v * s.cosine, v * s.sine - s.cosine, u
    length = sqrt(dx * dx + dy * dy + dz * dz)
    return dx / length, dy / length, dz / length


@internal
def _trace_pixel(scene: Scene, across: float, down: float) -> tuple[RGB, float, int]:
    """What is seen through a point of the picture: its light, its height, its number."""
    s = scene.stage[0]
    dx, dy, dz = _ray_direction(s, across, down)
    t, part = trace(scene, s.eye_x, s.eye_y, 0.0, dx, dy, dz, 1e9)
    x, y, z = s.eye_x + t * dx, s.eye_y + t * dy, t * dz
    light = radiance(scene, part, (x, y, z), (dx, dy, dz), t / s.focal)
    return light, y, part


@internal
def _is_edge(canvas: Canvas, shown: Any, row: int, column: int) -> bool:
    """Whether a pixel differs from one of its four neighbours in what it shows, or much in colour."""
    rows, columns = canvas.part.shape
    for side in range(4):
        i = row + (1 if side == 0 else -1 if side == 1 else 0)
        j = column + (1 if side == 2 else -1 if side == 3 else 0)
        if 0 <= i < rows and 0 <= j < columns:
            if canvas.part[i, j] != canvas.part[row, column]:
                return True
            for channel in range(3):
                if abs(shown[i, j, channel] - shown[row, column, channel]) > CONTRAST:
                    return True
    return False


@kernel
def bake_rows(scene: Scene, canvas: Canvas, rough: Any, rays: int, first: int, end: int) -> None:
    """Bake the rows first … end − 1: one kernel for both rounds, since each would compile all it calls anew.

    Args:
        scene: What is seen.
        canvas: Where to; its mask says which pixels.
        rough: In the second round, a copy of `canvas.shown` after the first.
        rays: 1 in the first round, through the middle of every pixel; `FINE` in the second, where `rough` has
            an edge.
        first: The first row.
        end: The row after the last.
    """
    s = scene.stage[0]
    for row in range(first, end):
        for column in range(canvas.mask.shape[1]):
            if not canvas.mask[row, column] or (rays > 1 and not _is_edge(canvas, rough, row, column)):
                continue
            shown = (0.0, 0.0, 0.0)
            for ray in range(rays):
                across, down = _place_in_pixel(ray, rays)
                light, height, part = _trace_pixel(scene, column + across, row + down)
                light = scale(light, s.exposure)
                shown = add_scaled(
                    shown, (tone_map(light[0]), tone_map(light[1]), tone_map(light[2])), 1.0 / rays
                )
                if rays == 1:
                    canvas.height[row, column] = height
                    canvas.part[row, column] = part
                    for channel in range(3):
                        canvas.light[row, column, channel] = light[channel]
            for channel in range(3):
                canvas.shown[row, column, channel] = shown[channel]


@inlined
def _place_in_pixel(ray: int, rays: int) -> tuple[float, float]:
    """Where a ray goes through its pixel: one in the middle, four with no two in a row or a column."""
    if rays == 1:
        return 0.5, 0.5
    if ray == 0:
        return 0.875, 0.625
    if ray == 1:
        return 0.625, 0.125
    if ray == 2:
        return 0.375, 0.875
    return 0.125, 0.375


@kernel
def bake_flash(
    scene: Scene, canvas: Canvas, index: int, left: int, top: int, patch: Any, first: int, end: int
) -> None:
    """What a hit of one part adds to the picture: uint8 [row, column, 3], its corner at (left, top)."""
    s = scene.stage[0]
    for i in range(first, end):
        for j in range(patch.shape[1]):
            row, column = top + i, left + j
            part = canvas.part[row, column]
            if part == ROOM:
                continue
            dx, dy, dz = _ray_direction(s, column + 0.5, row + 0.5)
            t = (canvas.height[row, column] - s.eye_y) / dy
            x, y, z = s.eye_x + t * dx, canvas.height[row, column], t * dz
            near = False
            cell = cell_at(s, x, z)
            for place in range(scene.lit[cell], scene.lit[cell + 1]):
                near = near or scene.lit[place] == index
            if not near:
                continue
            f = surface_of(scene, part, x, y, z, t / s.focal)
            if part == index:
                glow = f.light
                if scene.solids[index].form == Form.CYLINDER:
                    glow = add_scaled(glow, f.paint, 0.25)
            else:
                glow = part_glow(scene, index, part, f, x, y, z)
            for channel in range(3):
                light = canvas.light[row, column, channel]
                more = tone_map(light + FLASH * s.exposure * glow[channel]) - tone_map(light)
                patch[i, j, channel] = int(255.0 * min(max(more, 0.0), 1.0))
