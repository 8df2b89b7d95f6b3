"""Baking kernels: one ray per pixel first, then more rays where neighbouring pixels differ.

They fill the arrays of a `Canvas`, but only in the given rows and where its mask is set, so threads share a
picture and a patch costs no more than its pixels.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.inserts import insert_light
from silverball.drawing.kernels.march import trace
from silverball.drawing.kernels.shade import part_glow, radiance
from silverball.drawing.kernels.solids import cell_at
from silverball.drawing.kernels.stage import ROOM, Material, Pixels, Scene, StageRecord
from silverball.drawing.kernels.surfaces import surface_of
from silverball.drawing.kernels.tones import RGB, add_scaled, scale, tone_map
from silverball.physics.kernel import inlined, internal, kernel

CONTRAST = 0.045  # difference of neighbours, 0 to 1, above which a pixel gets more rays
FINE = 4  # rays per pixel then
FLASH = 2.6  # factor of the glow of a part that has just been hit


class Canvas(NamedTuple):
    """A picture being baked.

    Attributes:
        shown: Colours of the screen, 0 to 1, float32 [row, column, 3].
        light: Linear light at the centre of each pixel, float32 [row, column, 3].
        height: Of the surface above the playfield [u], float32 [row, column].
        part: The number of the visible solid, or FLOOR, RAIL, APRON or ROOM, int16 [row, column].
        mask: The pixels to bake, bool [row, column].
    """

    shown: NDArray[np.float32]
    light: NDArray[np.float32]
    height: NDArray[np.float32]
    part: NDArray[np.int16]
    mask: NDArray[np.bool_]


def new_canvas(size: tuple[int, int]) -> Canvas:
    """Return an empty canvas of a width and height [pixel], with all pixels in the mask."""
    shape = (size[1], size[0])
    return Canvas(
        np.zeros((*shape, 3), np.float32),
        np.zeros((*shape, 3), np.float32),
        np.zeros(shape, np.float32),
        np.zeros(shape, np.int16),
        np.ones(shape, np.bool_),
    )


@internal
def _ray_direction(s: StageRecord, across: float, down: float) -> tuple[float, float, float]:
    """The unit vector from the eye through a point of the picture."""
    u, v = (across - s.across) / s.focal, (s.down - down) / s.focal
    dx, dy, dz = s.sine + v * s.cosine, v * s.sine - s.cosine, u
    length = sqrt(dx * dx + dy * dy + dz * dz)
    return dx / length, dy / length, dz / length


@internal
def _trace_pixel(scene: Scene, across: float, down: float) -> tuple[RGB, float, int]:
    """Trace the ray through a point of the picture: the light, the height, the number of the solid."""
    s = scene.stage[0]
    dx, dy, dz = _ray_direction(s, across, down)
    t, part = trace(scene, s.eye_x, s.eye_y, 0.0, dx, dy, dz, 1e9)
    x, y, z = s.eye_x + t * dx, s.eye_y + t * dy, t * dz
    light = radiance(scene, part, (x, y, z), (dx, dy, dz), t / s.focal)
    return light, y, part


@internal
def _is_edge(canvas: Canvas, shown: Pixels, row: int, column: int) -> bool:
    """Return whether a pixel shows another part than one of its four neighbours, or another colour."""
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
def bake_rows(scene: Scene, canvas: Canvas, rough: Pixels, rays: int, first: int, end: int) -> None:
    """Bake the rows first … end − 1: one kernel for both passes, to compile everything once.

    Args:
        scene: The table.
        canvas: Receives the pixels of its mask.
        rough: In the second pass, a copy of `canvas.shown` after the first.
        rays: 1 in the first pass, through the centre of every pixel; `FINE` in the second, for pixels at
            an edge of `rough`.
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
    """Return the position of a ray in its pixel: the centre, or four with distinct rows and columns."""
    if rays == 1:
        return 0.5, 0.5
    if ray == 0:
        return 0.875, 0.625
    if ray == 1:
        return 0.625, 0.125
    if ray == 2:
        return 0.375, 0.875
    return 0.125, 0.375


@inlined
def _is_lit_by(scene: Scene, solid: int, x: float, z: float) -> bool:
    """Whether a solid is among those that light up the surroundings of (x, z)."""
    cell = cell_at(scene.stage[0], x, z)
    is_near = False
    for place in range(scene.lit[cell], scene.lit[cell + 1]):
        is_near = is_near or scene.lit[place] == solid
    return is_near


@kernel
def bake_light(
    scene: Scene, canvas: Canvas, source: int, left: int, top: int, patch: Pixels, first: int, end: int
) -> None:
    """Compute the light that a hit of a solid adds, or a lit lamp: one kernel, to compile surfaces once.

    Args:
        scene: The table.
        canvas: It, baked.
        source: The number of the solid; those of inserts follow.
        left: First column of the picture of light.
        top: Its first row.
        patch: Receives the light, uint8 [row, column, 3].
        first: The first row to compute.
        end: The row after the last.
    """
    s = scene.stage[0]
    strength = s.exposure if source >= len(scene.solids) else FLASH * s.exposure
    for i in range(first, end):
        for j in range(patch.shape[1]):
            row, column = top + i, left + j
            part = canvas.part[row, column]
            if part == ROOM:
                continue
            dx, dy, dz = _ray_direction(s, column + 0.5, row + 0.5)
            t = (canvas.height[row, column] - s.eye_y) / dy
            x, y, z = s.eye_x + t * dx, canvas.height[row, column], t * dz
            if source < len(scene.solids) and not _is_lit_by(scene, source, x, z):
                continue
            f = surface_of(scene, part, x, y, z, t / s.focal)
            if source >= len(scene.solids):
                insert = source - len(scene.solids)
                glow = insert_light(scene, insert, part, (x, y, z), (f.nx, f.ny, f.nz), f.paint)
            elif part == source:
                glow = f.light
                if scene.solids[source].material == Material.BUMPER:
                    glow = add_scaled(glow, f.paint, 0.25)
            else:
                glow = part_glow(scene, source, part, f, x, y, z)
            for channel in range(3):
                light = canvas.light[row, column, channel]
                more = tone_map(light + strength * glow[channel]) - tone_map(light)
                patch[i, j, channel] = int(255.0 * min(max(more, 0.0), 1.0))
