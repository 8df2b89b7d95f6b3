"""Baking of paddles: a sprite for every degree of their swing, which is blended over the table.

For each pixel a sprite holds the share of the background that remains (less in the shadow, none on the
paddle), the colour to add, and the height of the paddle: new = old · remaining / 255 + added.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.bake_table import to_bytes, without_obstacles
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.camera import Camera
from silverball.drawing.kernels.bake import new_canvas
from silverball.drawing.kernels.solids import list_cells
from silverball.drawing.kernels.stage import HALO, NEAR, Scene
from silverball.drawing.pictures import PaddleSprite
from silverball.drawing.scene import make_scene
from silverball.drawing.themes import Theme
from silverball.physics.records import Part
from silverball.table import Paddle, Table

DEGREES = 1.0  # about, between two sprites of a paddle
SHADOW_REACH = 0.7  # [u] how far its shadow and its mirror image reach around a paddle
NUMBERS = {"left": Part.LEFT_PADDLE, "right": Part.RIGHT_PADDLE}


def step_count(paddle: Paddle) -> int:
    """Return the number of equal steps of a paddle's swing."""
    return max(math.ceil((paddle.up_angle - paddle.rest_angle) / DEGREES), 1)


def nearest_step(paddle: Paddle, angle: float) -> int:
    """Return the step nearest to an angle [deg]."""
    share = (angle - paddle.rest_angle) / (paddle.up_angle - paddle.rest_angle)
    steps = step_count(paddle)
    return min(max(round(share * steps), 0), steps)


def step_angle(paddle: Paddle, step: int) -> float:
    """Return the angle [deg] of a step; the first and the last are exactly the stops."""
    steps = step_count(paddle)
    return paddle.up_angle if step == steps else (
        paddle.rest_angle + step * (paddle.up_angle - paddle.rest_angle) / steps
    )  # fmt: skip


def coarse_to_fine(steps: int) -> list[int]:
    """Return the steps from coarse to fine: the stops, the middle, the quarters, and so on."""
    order = dict.fromkeys((0, steps))
    stride = steps
    while stride > 1:
        stride = (stride + 1) // 2
        order.update(dict.fromkeys(range(0, steps, stride)))
    return list(order)


def has_mirrored_paddles(table: Table, camera: Camera) -> bool:
    """Return whether the right paddle, and its picture, is the mirror image of the left one."""
    paddles = {paddle.side: paddle for paddle in table.paddle}
    if len(paddles) < 2 or abs(2.0 * camera.frustum.across - camera.size[0]) > 1e-6:
        return False
    left, right = paddles["left"], paddles["right"]
    x, z = left.pivot
    return right == left.model_copy(update={"side": "right", "pivot": (x, -z), "name": right.name,
        "stroke": right.stroke, "return_stroke": right.return_stroke, "points": right.points,
        "restitution": right.restitution, "restitution_falloff": right.restitution_falloff})  # fmt: skip


class PaddleBaker:
    """Bakes the paddles of a table, one angle at a time.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        bake_threads: The threads to use.
    """

    def __init__(self, table: Table, camera: Camera, theme: Theme, bake_threads: BakeThreads) -> None:
        self._camera = camera
        self._theme = theme
        self._bake_threads = bake_threads
        self._paddles: dict[str, Paddle] = {paddle.side: paddle for paddle in table.paddle}
        self._bare = make_scene(without_obstacles(table), camera, theme)
        self._with = make_scene(without_obstacles(table), camera, theme, (0.0, 0.0))
        self._canvas = new_canvas(camera.size)
        self._canvas.mask[:] = False
        self._bare_canvas = new_canvas(camera.size)
        self._bare_canvas.mask[:] = False
        self._bare_done: set[str] = set()

    def bake(self, side: str, step: int) -> PaddleSprite:
        """Bake the paddle of a side at a step of its swing."""
        self._bake_bare(side)
        paddle = self._paddles[side]
        angle = step_angle(paddle, step)
        left, top, right, bottom = self._box(paddle, angle)
        box = (slice(top, bottom), slice(left, right))
        self._canvas.mask[box] = True
        self._bake_threads.bake(self._scene(side, angle), self._canvas)
        self._canvas.mask[box] = False
        is_paddle = self._canvas.part[box] == NUMBERS[side]
        return _sprite(
            left, top, self._bare_canvas.shown[box], self._canvas.shown[box],
            np.where(is_paddle, self._canvas.height[box], np.float32(-1.0)),
        )  # fmt: skip

    def _bake_bare(self, side: str) -> None:
        """Bake, once, the table below all positions of a paddle."""
        if side in self._bare_done:
            return
        paddle = self._paddles[side]
        for step in range(0, step_count(paddle) + 1):
            left, top, right, bottom = self._box(paddle, step_angle(paddle, step))
            self._bare_canvas.mask[top:bottom, left:right] = True
        self._bake_threads.bake(self._bare, self._bare_canvas)
        self._bare_canvas.mask[:] = False
        self._bare_done.add(side)

    def _scene(self, side: str, angle: float) -> Scene:
        scene = self._with
        solids = scene.solids.copy()
        for number in NUMBERS.values():
            if number != NUMBERS[side]:
                solids[number]["form"] = 0
        solid = solids[NUMBERS[side]]
        solid["sine"], solid["cosine"] = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        unit = float(scene.stage[0]["unit"])
        return scene._replace(
            solids=solids,
            near=list_cells(scene.stage, solids, scene.shapes, NEAR * unit),
            lit=list_cells(scene.stage, solids, scene.shapes, HALO * unit),
        )

    def _box(self, paddle: Paddle, angle: float) -> tuple[int, int, int, int]:
        corners = paddle.corners(angle)
        reach = SHADOW_REACH * self._camera.dimensions.unit
        xs, zs = [x for x, _ in corners], [z for _, z in corners]
        return self._camera.box(
            min(xs) - reach, max(xs) + 0.3 * reach, min(zs) - reach, max(zs) + reach, 0.0,
            1.3 * self._camera.dimensions.paddle_height,
        )  # fmt: skip


def _sprite(
    left: int, top: int, bare: NDArray[np.float32], seen: NDArray[np.float32], height: NDArray[np.float32]
) -> PaddleSprite:
    """Return the sprite that turns the bare table into one with a paddle, cropped to what differs."""
    below, above = to_bytes(bare).astype(np.float32), to_bytes(seen).astype(np.float32)
    dimmed = np.clip((above.sum(axis=2) + 1.0) / (below.sum(axis=2) + 1.0), 0.0, 1.0)
    # A pixel at the paddle's edge shows it in part: a quarter of the background remains.
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
            return PaddleSprite(left, top, empty, np.zeros((0, 0, 3), np.uint8), empty.astype(np.float32))
    box = (slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1))
    # 255 is reserved for pixels that the sprite does not change.
    remaining = np.where(changed, np.minimum(remaining, 254.0), 255.0)
    added[~changed] = 0.0
    return PaddleSprite(
        left + box[1].start,
        top + box[0].start,
        np.ascontiguousarray(remaining[box].astype(np.uint8)),
        np.ascontiguousarray(added[box].astype(np.uint8)),
        np.ascontiguousarray(height[box].astype(np.float16).astype(np.float32)),
    )
