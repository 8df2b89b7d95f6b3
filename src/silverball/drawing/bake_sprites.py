"""Baking of moving parts: a sprite for every pose, which is blended over the table.

For each pixel a sprite holds the share of the background that remains (less in the shadow, none on the
part), the colour to add, and the height of the part: new = old · remaining / 255 + added.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.bake_table import to_bytes
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import LEVEL_RISE
from silverball.drawing.kernels.bake import new_canvas
from silverball.drawing.kernels.stage import Box
from silverball.drawing.layout import Layout
from silverball.drawing.moving import PULL, Motion, MovingPart, pose_angle, turned
from silverball.drawing.pictures import Sprite
from silverball.drawing.scene import TableScene
from silverball.drawing.themes import Theme

SHADOW_REACH = 0.7  # [u] how far its shadow and its mirror image reach around a part


class SpriteBaker:
    """Bakes the moving parts of a table, one pose at a time.

    Args:
        layout: The table; its obstacles are left out, so that all boards of a recipe share the sprites.
        camera: The view of it.
        theme: Its colours.
        bake_threads: The threads to use.
    """

    def __init__(self, layout: Layout, camera: Camera, theme: Theme, bake_threads: BakeThreads) -> None:
        self._layout = layout.without_obstacles()
        self._camera = camera
        self._theme = theme
        self._bake_threads = bake_threads
        self._tables: dict[int, TableScene] = {}
        self._canvas = new_canvas(camera.size)
        self._canvas.mask[:] = False
        self._bare_canvas = new_canvas(camera.size)
        self._bare_canvas.mask[:] = False
        self._bare_done: set[MovingPart] = set()

    def bake(self, part: MovingPart, pose: int) -> Sprite:
        """Bake a part in one of its poses."""
        if part.level not in self._tables:
            self._tables[part.level] = TableScene(self._layout, self._camera, self._theme, part.level)
        table = self._tables[part.level]
        self._bake_bare(part, table)
        left, top, right, bottom = pose_box(self._camera, part, pose)
        box = (slice(top, bottom), slice(left, right))
        self._canvas.mask[box] = True
        self._bake_threads.bake(table.posed([(part, pose)]), self._canvas)
        self._canvas.mask[box] = False
        is_part = self._canvas.part[box] >= len(table.scene.solids)
        return sprite_of(
            left, top, self._bare_canvas.shown[box], self._canvas.shown[box],
            np.where(is_part, self._canvas.height[box], np.float32(-1.0)),
        )  # fmt: skip

    def _bake_bare(self, part: MovingPart, table: TableScene) -> None:
        """Bake, once, the table below all poses of a part."""
        if part in self._bare_done:
            return
        for pose in range(part.poses):
            left, top, right, bottom = pose_box(self._camera, part, pose)
            self._bare_canvas.mask[top:bottom, left:right] = True
        self._bake_threads.bake(table.scene, self._bare_canvas)
        self._bare_canvas.mask[:] = False
        self._bare_done.add(part)


def pose_box(camera: Camera, part: MovingPart, pose: int) -> Box:
    """Return the pixels that a part in a pose, its shadow and its mirror image can cover."""
    unit = camera.dimensions.unit
    reach = SHADOW_REACH * unit
    primitive = part.primitive
    base, high = part.level * LEVEL_RISE * unit, 1.3 * camera.dimensions.paddle_height
    if part.motion is Motion.TURNING:
        points, around = (
            turned(primitive, pose_angle(part, pose)),
            max(primitive.radius, primitive.tip_radius),
        )
    else:
        points, around, high = list(primitive.points), primitive.radius, 1.1 * unit
        if primitive.launch is not None:
            x, z = points[0]
            (to_x, to_z), length = (
                primitive.launch.direction,
                1.4 * unit + PULL * unit + 2.0 * camera.dimensions.ball,
            )
            points = [(x, z), (x - length * to_x, z - length * to_z)]
        elif part.motion is not Motion.STANDING:
            around += 0.3 * unit
    xs, zs = [x for x, _ in points], [z for _, z in points]
    return camera.box(
        min(xs) - reach - around, max(xs) + 0.3 * reach + around, min(zs) - reach - around,
        max(zs) + reach + around, base, base + high,
    )  # fmt: skip


def sprite_of(
    left: int, top: int, bare: NDArray[np.float32], seen: NDArray[np.float32], height: NDArray[np.float32]
) -> Sprite:
    """Return the sprite that turns the bare table into one with a part, cropped to what differs."""
    below, above = to_bytes(bare).astype(np.float32), to_bytes(seen).astype(np.float32)
    dimmed = np.clip((above.sum(axis=2) + 1.0) / (below.sum(axis=2) + 1.0), 0.0, 1.0)
    # A pixel at the part's edge shows it in part: a quarter of the background remains.
    solid = (height >= 0.0).astype(np.float32)
    around = solid.copy()
    around[1:] += solid[:-1]
    around[:-1] += solid[1:]
    around[:, 1:] += solid[:, :-1]
    around[:, :-1] += solid[:, 1:]
    remaining = np.where(solid > 0.0, np.where(around >= 5.0, 0.0, 0.25), dimmed)
    remaining = np.round(255.0 * remaining)
    added = np.clip(np.round(above - below * remaining[:, :, None] / 255.0), 0.0, 255.0)
    changed = (np.abs(above - below).max(axis=2) > 1.0) | (height >= 0.0)
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    if not len(rows):
        rows = columns = np.zeros(1, np.int64)
        if not changed.size:
            empty = np.zeros((0, 0), np.uint8)
            return Sprite(left, top, empty, np.zeros((0, 0, 3), np.uint8), empty.astype(np.float32))
    box = (slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1))
    # 255 is reserved for pixels that the sprite does not change.
    remaining = np.where(changed, np.minimum(remaining, 254.0), 255.0)
    added[~changed] = 0.0
    return Sprite(
        left + box[1].start,
        top + box[0].start,
        np.ascontiguousarray(remaining[box].astype(np.uint8)),
        np.ascontiguousarray(added[box].astype(np.uint8)),
        np.ascontiguousarray(height[box].astype(np.float16).astype(np.float32)),
    )
