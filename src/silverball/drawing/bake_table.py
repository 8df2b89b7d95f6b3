"""Baking of a table without its moving parts: its picture, its heights, and the flash of each part.

A random board differs from the empty board only around its obstacles. If the picture of the empty board is
given, only these pixels are baked; the result is the same bit for bit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.camera import Camera
from silverball.drawing.kernels import bake
from silverball.drawing.kernels.bake import Canvas, new_canvas
from silverball.drawing.kernels.inserts import LAMP_REACH
from silverball.drawing.kernels.stage import HALO, Material, Scene
from silverball.drawing.layout import Layout
from silverball.drawing.looks import LOOKS
from silverball.drawing.pictures import AddedLight, BakedTable
from silverball.drawing.scene import TableScene
from silverball.drawing.themes import Theme

SLACK = 0.05  # [u] added to a reach, for the heights between two that are tested
FAINT = 2  # of 255: added light that is weaker at the edge of its picture is left out
RECIPE_MATERIALS = (Material.ACRYLIC, Material.BUMPER)
"""Materials of what a recipe places at random, see `Layout.without_obstacles`."""


def bake_table(
    layout: Layout, camera: Camera, theme: Theme, bake_threads: BakeThreads, empty: BakedTable | None = None
) -> BakedTable:
    """Bake the playfield of a table, without moving parts, upper levels and balls.

    Args:
        layout: The table.
        camera: The view of it.
        theme: Its colours.
        bake_threads: The threads to use.
        empty: The baked picture of the same table without prisms and cylinders, if there is one.
    """
    table = TableScene(layout, camera, theme)
    scene = table.scene
    canvas = new_canvas(camera.size)
    inner = None
    if empty is not None:
        inner = _around_obstacles(scene, camera)
        canvas.mask[:] = _one_wider(inner)
    bake_threads.plan(2 * int(canvas.mask.any(axis=1).sum()))
    bake_threads.bake(scene, canvas, inner)
    pixels, height = to_bytes(canvas.shown), rounded(canvas.height)
    if empty is not None and inner is not None:
        pixels = np.where(inner[:, :, None], pixels, empty.pixels)
        height = np.where(inner, height, empty.height)
    flashes = _flashes(layout, table, camera, canvas, bake_threads)
    return BakedTable(pixels, height, flashes, _lamps(table.scene, camera, canvas, bake_threads))


def to_bytes(shown: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Convert colours (0 to 1) to RGB bytes, with ordered dither against bands in gradients."""
    rows, columns = shown.shape[:2]
    # The constants are powers of the plastic number, which spread points evenly
    # over a plane. Source: M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
    row, column = np.arange(rows)[:, None], np.arange(columns)[None, :]
    pattern = ((0.7548776662 * column + 0.5698402910 * row) % 1.0).astype(np.float32)
    levels: NDArray[np.uint8] = np.clip(shown * 255.0 + pattern[..., None], 0.0, 255.0).astype(np.uint8)
    return levels


def rounded(height: NDArray[np.float32]) -> NDArray[np.float32]:
    """Round heights to half precision, as the cache stores them: both give the same picture."""
    return height.astype(np.float16).astype(np.float32)


def _around_obstacles(scene: Scene, camera: Camera) -> NDArray[np.bool_]:
    """Return the pixels that prisms and cylinders can change: all within the reach of their light."""
    width, height = camera.size
    mask = np.zeros((height, width), np.bool_)
    reach = HALO * float(scene.stage[0]["unit"])
    for solid in scene.solids:
        if solid["material"] in RECIPE_MATERIALS:
            left, top, right, bottom = _box(camera, solid, reach)
            across = np.arange(left, right)[None, :] + 0.5
            down = np.arange(top, bottom)[:, None] + 0.5
            # A ray crosses the reach of a part at some height between the playfield and the top.
            for share in (0.0, 0.25, 0.5, 0.75, 1.0):
                x, z = _places(camera, across, down, share * camera.dimensions.top)
                size = solid["reach"] + reach + SLACK
                mask[top:bottom, left:right] |= (x - solid["x"]) ** 2 + (z - solid["z"]) ** 2 < size**2
    return mask


def _places(
    camera: Camera, across: NDArray[Any], down: NDArray[Any], y: float
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return (x, z) where the rays through pixels are at height y; `Camera.to_board` for arrays."""
    f = camera.frustum
    u, v = (across - f.across) / f.focal, (f.down - down) / f.focal
    t = (y - f.eye_y) / (v * f.sine - f.cosine)
    return f.eye_x + t * (f.sine + v * f.cosine), t * u


def _box(camera: Camera, solid: np.void, reach: float) -> tuple[int, int, int, int]:
    """Return the box of pixels that shows a solid and its surroundings within a reach."""
    x, z, size = solid["x"], solid["z"], solid["reach"] + reach
    return camera.box(x - size, x + size, z - size, z + size, 0.0, camera.dimensions.top)


def _one_wider(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    wider = mask.copy()
    wider[1:] |= mask[:-1]
    wider[:-1] |= mask[1:]
    wider[:, 1:] |= mask[:, :-1]
    wider[:, :-1] |= mask[:, 1:]
    return wider


def _flashes(
    layout: Layout, table: TableScene, camera: Camera, canvas: Canvas, bake_threads: BakeThreads
) -> dict[str, tuple[AddedLight, ...]]:
    reaches = {
        row.part: LOOKS[row.primitive.finish].flash_reach
        for row in layout.rows
        if LOOKS[row.primitive.finish].flashes
    }
    flashes: dict[str, tuple[AddedLight, ...]] = {}
    for index, name in enumerate(table.parts):
        if name not in reaches or table.scene.solids[index]["glow"] == 0.0:
            continue
        reach = reaches[name] * camera.dimensions.unit
        left, top, right, bottom = _box(camera, table.scene.solids[index], reach)
        pixels = np.zeros((bottom - top, right - left, 3), np.uint8)
        arguments = (table.scene, canvas, index, left, top, pixels)
        bake_threads.rows(bake.bake_light, arguments, 0, bottom - top)
        flashes[name] = (*flashes.get(name, ()), AddedLight(left, top, _smoothed(pixels)))
    return flashes


def _lamps(scene: Scene, camera: Camera, canvas: Canvas, bake_threads: BakeThreads) -> tuple[AddedLight, ...]:
    """Bake the light of every lamp that lies in the playfield."""
    lights = []
    for index, insert in enumerate(scene.inserts):
        x, z, size = insert["x"], insert["z"], insert["size"] + LAMP_REACH * camera.dimensions.unit
        box = camera.box(x - size, x + size, z - size, z + size, 0.0, camera.dimensions.wall_height)
        left, top, right, bottom = box
        pixels = np.zeros((bottom - top, right - left, 3), np.uint8)
        arguments = (scene, canvas, len(scene.solids) + index, left, top, pixels)
        bake_threads.rows(bake.bake_light, arguments, 0, bottom - top)
        lights.append(_cropped(AddedLight(left, top, _smoothed(pixels))))
    return tuple(lights)


def _cropped(light: AddedLight) -> AddedLight:
    """Return a light without the edges that hardly shine."""
    shines: NDArray[np.bool_] = np.any(light.pixels >= FAINT, axis=2)
    if not shines.any():
        return light._replace(pixels=np.zeros((0, 0, 3), np.uint8))
    rows, columns = (np.flatnonzero(np.any(shines, axis=axis)) for axis in (1, 0))
    pixels = light.pixels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return AddedLight(light.left + int(columns[0]), light.top + int(rows[0]), np.ascontiguousarray(pixels))


def _smoothed(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Average each pixel with its eight neighbours, to smooth the edges of one ray per pixel."""
    for axis in (0, 1):
        wide = np.pad(pixels.astype(np.uint16), [(1, 1) if a == axis else (0, 0) for a in range(3)], "edge")
        size = pixels.shape[axis]
        before, center, after = (wide.take(range(shift, shift + size), axis) for shift in range(3))
        pixels = ((before + center + after) // 3).astype(np.uint8)
    return np.ascontiguousarray(pixels)
