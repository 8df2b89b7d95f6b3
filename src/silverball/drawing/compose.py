"""Composing of a frame: the baked table, and on it everything that moves.

    flashes of hits → paddles → shadows of balls → trails → balls → sparks

Each layer sees what lies below it, heights included, so a ball is hidden by a raised paddle and its shadow
climbs onto an obstacle. Between two frames only the dirty rectangles of the first are restored.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pygame

from silverball.drawing.bake_table import without_obstacles
from silverball.drawing.camera import Camera
from silverball.drawing.effects import Effects, Spot
from silverball.drawing.kernels.chrome import cast_shadow, draw_ball
from silverball.drawing.kernels.patches import add_light, add_spots, lay_paddle
from silverball.drawing.kernels.stage import Box
from silverball.drawing.moment import BallAt, Moment
from silverball.drawing.pictures import BakedTable, PaddleSprite
from silverball.drawing.scene import make_scene
from silverball.drawing.sketch import Pen, sketch_paddle
from silverball.drawing.themes import Color, Theme
from silverball.table import Paddle, Table

MAX_SPOTS = 64  # spots of one trail, or sparks of one hit
TRAIL_LIGHT, SPARK_LIGHT = 0.5, 1.0


class Composer:
    """Draws moments of one table in full quality.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        baked: The table without moving parts.
        paddle: Returns the sprite of a side's paddle at an angle [deg], or None while it is not baked.
    """

    def __init__(
        self,
        table: Table,
        camera: Camera,
        theme: Theme,
        baked: BakedTable,
        paddle: Callable[[str, float], PaddleSprite | None],
    ) -> None:
        self._camera = camera
        self._theme = theme
        self._baked = baked
        self._paddle = paddle
        self._paddles: dict[str, Paddle] = {part.side: part for part in table.paddle}
        scene = make_scene(without_obstacles(table), camera, theme)
        self._stage, self._inks = scene.stage, scene.inks
        width, height = camera.size
        self._bytes = bytearray(baked.pixels.tobytes())
        self._frame = np.frombuffer(self._bytes, np.uint8).reshape(height, width, 3)
        self._rows = self._frame.reshape(height, 3 * width)
        self._height = baked.height.copy()
        self._changed: list[Box] = []  # dirty rectangles of colours,
        self._raised: list[Box] = []  # and of heights, which only paddles change
        self._spots = np.zeros((MAX_SPOTS, 7))
        self._before = np.zeros((1, 1, 3), np.uint8)
        self.surface = pygame.image.frombuffer(self._bytes, camera.size, "RGB")

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""
        for box in self._changed:
            at = _within(box)
            self._frame[at] = self._baked.pixels[at]
        for box in self._raised:
            at = _within(box)
            self._height[at] = self._baked.height[at]
        self._changed.clear()
        self._raised.clear()
        for part, strength in effects.flashes(moment.time):
            self._light_up(part, strength)
        for side, angle in zip(("left", "right"), moment.angles, strict=True):
            if side in self._paddles:
                self._lay_paddle(side, angle)
        balls = [*moment.balls, *effects.sinking_balls(moment.time)]
        for ball in balls:
            self._shade(ball)
        for trail in effects.trails(moment):
            self._add_spots(trail, self._theme.trail, TRAIL_LIGHT)
        for ball in sorted(balls, key=lambda ball: -ball.x):  # the far one first
            self._draw_ball(ball)
        for sparks in effects.sparks(moment.time):
            self._add_spots(sparks, self._theme.spark, SPARK_LIGHT)
        return self.surface

    def _light_up(self, part: str, strength: float) -> None:
        flash = self._baked.flashes.get(part)
        if flash is not None:
            rows, columns = flash.pixels.shape[:2]
            flat = flash.pixels.reshape(rows, 3 * columns)
            add_light(self._rows, flash.left, flash.top, flat, round(256 * strength))
            self._changed.append((flash.left, flash.top, flash.left + columns, flash.top + rows))

    def _lay_paddle(self, side: str, angle: float) -> None:
        sprite = self._paddle(side, angle)
        if sprite is None:
            paddle = self._paddles[side]
            corners = paddle.corners(angle)
            xs, zs = [x for x, _ in corners], [z for _, z in corners]
            self._changed.append(
                self._camera.box(
                    min(xs), max(xs), min(zs), max(zs), 0.0, self._camera.dimensions.paddle_height
                )
            )
            sketch_paddle(Pen(self.surface, self._camera), paddle, angle, self._theme)
            return
        lay_paddle(self._frame, self._height, *sprite)
        rows, columns = sprite.remaining.shape
        box = (sprite.left, sprite.top, sprite.left + columns, sprite.top + rows)
        self._changed.append(box)
        self._raised.append(box)

    def _shade(self, ball: BallAt) -> None:
        r = self._camera.dimensions.ball
        box = self._camera.box(
            ball.x - 2.8 * r, ball.x + 2.2 * r, ball.z - 2.2 * r, ball.z + 2.2 * r, 0.0, 2.0 * r
        )
        cast_shadow(self._frame, self._height, self._stage, (ball.x, ball.z, r), box)
        self._changed.append(box)

    def _draw_ball(self, ball: BallAt) -> None:
        r = self._camera.dimensions.ball
        box = self._camera.box(ball.x - r, ball.x + r, ball.z - r, ball.z + r, 0.0, 2.0 * r)
        rows, columns = box[3] - box[1], box[2] - box[0]
        if rows > self._before.shape[0] or columns > self._before.shape[1]:
            self._before = np.zeros((rows + 4, columns + 4, 3), np.uint8)
        draw_ball(self._frame, self._height, self._before, self._stage, self._inks, (ball.x, ball.z, r), box)
        self._changed.append(box)

    def _add_spots(self, spots: Sequence[Spot], color: Color, light: float) -> None:
        if not spots:
            return
        count = min(len(spots), MAX_SPOTS)
        for row, spot in zip(self._spots, spots, strict=False):
            shine = light * spot.strength
            row[:] = (*spot[:4], shine * color[0], shine * color[1], shine * color[2])
        self._changed.append(add_spots(self._frame, self._height, self._stage, self._spots, count))


def _within(box: Box) -> tuple[slice, slice]:
    """Return the slices of a box, without what lies beyond the frame's left and upper edge."""
    left, top, right, bottom = box
    return slice(max(top, 0), max(bottom, 0)), slice(max(left, 0), max(right, 0))
