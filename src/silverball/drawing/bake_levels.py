"""Baking of upper levels: one translucent picture for each, which is blended over what lies below it.

What stands on the level is blended with `OPACITY` and has a bright outline. Where its walls and the mouths of
its passages enclose an area, that is its floor, tinted; a level that is open to the board has none.
"""

from __future__ import annotations

import math
from collections import deque
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.bake_table import rounded, to_bytes
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import LEVEL_RISE
from silverball.drawing.kernels.bake import new_canvas
from silverball.drawing.layout import Layout
from silverball.drawing.pictures import Sprite
from silverball.drawing.scene import TableScene
from silverball.drawing.themes import Theme
from silverball.physics.forms import Shape
from silverball.table.outlines import path
from silverball.table.primitive import Point, Primitive

OPACITY = 0.7  # of what stands on an upper level
OUTLINE = 0.95  # of its outline
FLOOR_OPACITY = 0.45
FLOOR_CELL = 0.1  # [u]
EDGE = 0.05  # [u] around a solid within which it is smoothed
MARGIN = 0.35  # [u] around what stands on a level


def bake_level(layout: Layout, level: int, camera: Camera, theme: Theme, bake_threads: BakeThreads) -> Sprite:
    """Bake what stands on an upper level."""
    places = [
        place for row in layout.rows if level in row.primitive.levels for place in extent(row.primitive)
    ]
    base = level * LEVEL_RISE * camera.dimensions.unit
    xs, zs = [x for x, _ in places], [z for _, z in places]
    left, top, right, bottom = camera.box(
        min(xs) - MARGIN, max(xs) + MARGIN, min(zs) - MARGIN, max(zs) + MARGIN, 0.0,
        base + camera.dimensions.top,
    )  # fmt: skip
    box = (slice(top, bottom), slice(left, right))
    table = TableScene(layout, camera, theme, level)
    canvas = new_canvas(camera.size)
    canvas.mask[:] = False
    is_on_level = np.isclose(table.scene.solids["base"], base)
    for solid in table.scene.solids[is_on_level]:
        x, z, reach = solid["x"], solid["z"], solid["reach"] + EDGE
        place = camera.box(x - reach, x + reach, z - reach, z + reach, base, float(solid["height"]) + EDGE)
        canvas.mask[place[1] : place[3], place[0] : place[2]] = True
    bake_threads.plan(2 * (bottom - top))
    bake_threads.bake(table.scene, canvas)
    seen = (
        canvas.mask[box] & np.append(is_on_level, [False] * 4)[canvas.part[box]]
    )  # the last: floor, rail, …
    alpha = np.where(seen, np.where(_edge(seen), OUTLINE, OPACITY), 0.0)
    color = to_bytes(canvas.shown[box]).astype(np.float64)
    color = np.where((seen & _edge(seen))[:, :, None], np.minimum(1.25 * color + 30.0, 255.0), color)
    floor = _floor_share(layout, level, camera, base, (left, top, right, bottom))
    tint = np.array(theme.ramp, np.float64)
    share = np.where(seen, 0.0, FLOOR_OPACITY * floor)
    added = alpha[:, :, None] * color + share[:, :, None] * tint
    remaining = 255.0 * (1.0 - alpha - share)
    changed = (alpha + share) > 0.004
    height = np.where(
        seen, rounded(canvas.height[box]), np.where(floor > 0.5, np.float32(base), np.float32(-1))
    )
    return Sprite(
        left, top,
        np.where(changed, np.minimum(np.round(remaining), 254.0), 255.0).astype(np.uint8),
        np.where(changed[:, :, None], np.round(added), 0.0).clip(0.0, 255.0).astype(np.uint8),
        np.ascontiguousarray(height.astype(np.float32)),
    )  # fmt: skip


def extent(primitive: Primitive) -> list[Point]:
    """Return points around a primitive, no farther apart than its size."""
    radius = max(primitive.radius, primitive.tip_radius)
    if primitive.mover is not None:
        (x, z), points = primitive.mover.pivot, primitive.points
        radius += max(math.hypot(*point) for point in points)
        points = ((x, z),)
    elif primitive.shape == Shape.ARC:
        points = tuple(path(primitive))
    else:
        points = primitive.points
    return [(x + dx, z + dz) for x, z in points for dx in (-radius, radius) for dz in (-radius, radius)]


def _edge(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the pixels of a mask with a neighbour outside of it."""
    inner = mask.copy()
    inner[1:] &= mask[:-1]
    inner[:-1] &= mask[1:]
    inner[:, 1:] &= mask[:, :-1]
    inner[:, :-1] &= mask[:, 1:]
    edge: NDArray[np.bool_] = mask & ~inner
    return edge


def _floor_share(
    layout: Layout, level: int, camera: Camera, base: float, box: tuple[int, int, int, int]
) -> NDArray[np.float64]:
    """Return how much of each pixel of a box shows the floor of a level."""
    left, top, right, bottom = box
    cells = floor_cells(layout, level)
    share = np.zeros((bottom - top, right - left))
    if not cells.any():
        return share
    f = camera.frustum
    u = (np.arange(left, right)[None, :] + 0.5 - f.across) / f.focal
    v = (f.down - np.arange(top, bottom)[:, None] - 0.5) / f.focal
    t = (base - f.eye_y) / (v * f.sine - f.cosine)
    row = (f.eye_x + t * (f.sine + v * f.cosine) + 0.5 * layout.board.length) / FLOOR_CELL - 0.5
    column = (t * u + 0.5 * layout.board.width) / FLOOR_CELL - 0.5
    row = np.broadcast_to(row, share.shape)
    i, j = np.floor(row).astype(int), np.floor(column).astype(int)
    p, q = row - i, column - j
    for di, dj, weight in (
        (0, 0, (1 - p) * (1 - q)),
        (1, 0, p * (1 - q)),
        (0, 1, (1 - p) * q),
        (1, 1, p * q),
    ):
        inside = (i + di >= 0) & (i + di < cells.shape[0]) & (j + dj >= 0) & (j + dj < cells.shape[1])
        at = cells[np.clip(i + di, 0, cells.shape[0] - 1), np.clip(j + dj, 0, cells.shape[1] - 1)]
        share += weight * (inside & at)
    smooth: NDArray[np.float64] = np.clip(2.5 * share - 0.75, 0.0, 1.0)  # narrower than a cell's width
    return smooth


def floor_cells(layout: Layout, level: int) -> NDArray[np.bool_]:
    """Return the cells of the board, from its lower left corner, that an upper level's walls enclose.

    The centres of balls are followed from the mouths of the level's passages up to its walls and mouths.
    Where they can reach the edge of the board, nothing is enclosed.
    """
    shape = (
        math.ceil(layout.board.length / FLOOR_CELL) + 1,
        math.ceil(layout.board.width / FLOOR_CELL) + 1,
    )
    walls, mouths = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
    starts: list[tuple[int, int]] = []
    for row in layout.rows:
        primitive = row.primitive
        if primitive.passage is not None and level in primitive.passage:
            _block(mouths, layout, *_lengthened(primitive.points, FLOOR_CELL))
            starts.append(_behind(layout, primitive, level))
        elif level in primitive.levels and primitive.shape in (Shape.CAPSULE, Shape.ARC):
            for start, end in pairwise(path(primitive)):
                _block(walls, layout, start, end)
    ball = round(layout.board.ball_radius / FLOOR_CELL)
    blocked = _grown(walls, ball) | mouths
    floor = np.zeros(shape, np.bool_)
    for start in starts:
        filled = _filled(blocked, start)
        if filled is not None:
            floor |= filled
    return _grown(floor, ball)


def _behind(layout: Layout, passage: Primitive, level: int) -> tuple[int, int]:
    """Return a cell on a level beside the mouth of a passage: to its left if that leads there, else right."""
    (x0, z0), (x1, z1) = passage.points
    assert passage.passage is not None
    side = 2.5 * FLOOR_CELL / max(math.hypot(x1 - x0, z1 - z0), 1e-9)
    if passage.passage[1] != level:
        side = -side
    return _cell(layout, 0.5 * (x0 + x1) + side * (z1 - z0), 0.5 * (z0 + z1) - side * (x1 - x0))


def _lengthened(points: tuple[Point, ...], length: float) -> tuple[Point, Point]:
    """Return a segment that is longer at both ends, so that no gap of a cell is left beside it."""
    (x0, z0), (x1, z1) = points
    share = length / max(math.hypot(x1 - x0, z1 - z0), 1e-9)
    dx, dz = share * (x1 - x0), share * (z1 - z0)
    return (x0 - dx, z0 - dz), (x1 + dx, z1 + dz)


def _grown(mask: NDArray[np.bool_], cells: int) -> NDArray[np.bool_]:
    """Return the cells within a distance of a mask."""
    grown, wide = mask.copy(), np.pad(mask, cells)
    for i in range(-cells, cells + 1):
        for j in range(-cells, cells + 1):
            if i * i + j * j <= cells * cells:
                down, right = cells + i, cells + j
                grown |= wide[down : down + mask.shape[0], right : right + mask.shape[1]]
    return grown


def _cell(layout: Layout, x: float, z: float) -> tuple[int, int]:
    return (
        int((x + 0.5 * layout.board.length) / FLOOR_CELL),
        int((z + 0.5 * layout.board.width) / FLOOR_CELL),
    )


def _block(blocked: NDArray[np.bool_], layout: Layout, start: Point, end: Point) -> None:
    """Block the cells along a segment."""
    count = max(math.ceil(2.0 * math.dist(start, end) / FLOOR_CELL), 1)
    for step in range(count + 1):
        share = step / count
        i, j = _cell(layout, start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        if 0 <= i < blocked.shape[0] and 0 <= j < blocked.shape[1]:
            blocked[i, j] = True


def _filled(blocked: NDArray[np.bool_], start: tuple[int, int]) -> NDArray[np.bool_] | None:
    """Return the free cells around a cell; None if they reach the edge."""
    rows, columns = blocked.shape
    filled = np.zeros_like(blocked)
    todo = deque([start])
    while todo:
        i, j = todo.popleft()
        if not (0 < i < rows - 1 and 0 < j < columns - 1):
            return None
        if blocked[i, j] or filled[i, j]:
            continue
        filled[i, j] = True
        todo.extend(((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)))
    return filled
