"""What moves: how do balls, paddles and lights become small images that only need to be put in place?

A sprite is a surface and the picture's point of its upper left corner. Paddles are kept per angle, balls per
quarter of a pixel, so that both move smoothly.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing import fields, palette
from silverball.drawing.camera import Camera, Patch
from silverball.drawing.canvas import facing, paint, shade, tone
from silverball.drawing.fields import Field
from silverball.drawing.palette import Color
from silverball.drawing.walls import SHADOW_OFFSET, SHADOW_SOFTNESS, moved
from silverball.table import Paddle

ANGLE_STEPS = 2  # paddle images per degree: the tip moves by less than a pixel from one to the next
SHIFTS = 4  # ball images per pixel and direction
PIVOT_RADIUS = 0.3  # of the paddle's base


class Sprite(NamedTuple):
    """A small image and where it belongs.

    Attributes:
        image: With an alpha channel, or pure light to be added.
        place: The picture's pixel of its upper left corner.
    """

    image: pygame.Surface
    place: tuple[int, int]


class PaddleSprites:
    """The images of one paddle at every angle it takes."""

    def __init__(self, camera: Camera, paddle: Paddle) -> None:
        self._camera = camera
        self._paddle = paddle
        self._kept: dict[int, Sprite] = {}

    def at(self, angle: float) -> Sprite:
        """The image at an angle [deg], painted when it is first needed."""
        step = round(angle * ANGLE_STEPS)
        sprite = self._kept.get(step)
        if sprite is None:
            sprite = self._kept[step] = _paddle_sprite(self._camera, self._paddle, step / ANGLE_STEPS)
        return sprite


class BallSprites:
    """The images of a ball: on every quarter of a pixel, and its shadow and trail."""

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self.radius = camera.board.ball_radius * camera.scale  # [pixel]
        self._reach = math.ceil(self.radius) + 2  # [pixel] from the middle pixel to the image's edge
        self._kept: dict[tuple[int, int], pygame.Surface] = {}
        self._shadow_reach = math.ceil(self.radius + 2.0 * SHADOW_SOFTNESS * camera.scale) + 1
        self.shadow = self._paint_shadow()
        self.trail = tuple(self._paint_trail(age / 8) for age in range(8))

    def at(self, x: float, z: float) -> Sprite:
        """The ball with its centre at (x, z) [u]."""
        across, down = self._camera.to_pixel(x, z)
        column, row = math.floor(across), math.floor(down)
        shift = (int((across - column) * SHIFTS), int((down - row) * SHIFTS))
        image = self._kept.get(shift)
        if image is None:
            image = self._kept[shift] = self._paint_ball(*shift)
        return Sprite(image, (column - self._reach, row - self._reach))

    def shadow_at(self, x: float, z: float) -> Sprite:
        """The shadow of a ball at (x, z) [u]."""
        across, down = self._camera.to_pixel(*moved((x, z)))
        reach = self._shadow_reach
        return Sprite(self.shadow, (round(across) - reach, round(down) - reach))

    def trail_at(self, x: float, z: float, age: float) -> Sprite:
        """A spot of light where a ball was; age 0 (now) to 1 (gone)."""
        image = self.trail[min(int(age * 8), 7)]
        across, down = self._camera.to_pixel(x, z)
        return Sprite(
            image, (round(across - 0.5 * image.get_width()), round(down - 0.5 * image.get_height()))
        )

    def _paint_ball(self, shift_right: int, shift_down: int) -> pygame.Surface:
        center = self._reach + (shift_right + 0.5) / SHIFTS, self._reach + (shift_down + 0.5) / SHIFTS
        return ball_image(self.radius, center, 2 * self._reach + 1)

    def _paint_shadow(self) -> pygame.Surface:
        reach = self._shadow_reach
        right, down = _grid(2 * reach + 1)
        soft = SHADOW_SOFTNESS * self._camera.scale
        distance = fields.circle(down, right, (reach + 0.5, reach + 0.5), self.radius)
        mask = np.clip(0.5 - distance / (2.0 * soft), 0.0, 1.0)
        return _surface(
            _plain(palette.SHADOW, mask), (0.62 * mask * mask * (3.0 - 2.0 * mask)).astype(np.float32)
        )

    def _paint_trail(self, age: float) -> pygame.Surface:
        radius = self.radius * (0.85 - 0.45 * age)
        right, down = _grid(2 * math.ceil(radius) + 3)
        middle = math.ceil(radius) + 1.5
        away = fields.circle(down, right, (middle, middle), 0.0)
        mask = np.clip(1.0 - (away / radius) ** 2, 0.0, 1.0) * 0.16 * (1.0 - age)
        return light_surface(mask[..., None] * tone(palette.TRAIL))


def ball_image(radius: float, center: tuple[float, float], side: int) -> pygame.Surface:
    """A silver ball in a square image; radius, centre (across, down) and side in pixels."""
    right, down = _grid(side)
    distance = fields.circle(down, right, (center[1], center[0]), radius)
    u, v = (right - center[0]) / radius, (down - center[1]) / radius
    # A mirror ball under a lamp: bright towards the upper left, dark at its rim, some light from the floor.
    tall = np.sqrt(np.clip(1.0 - u * u - v * v, 0.0, 1.0))
    lit = np.clip(0.55 * tall - 0.42 * u - 0.62 * v + 0.28, 0.0, 1.0)[..., None]
    colors = tone(palette.BALL_DARK) + lit * (tone(palette.BALL_MIDDLE) - tone(palette.BALL_DARK))
    canvas = np.array(colors, np.float32)
    glint = np.exp(-((u + 0.34) ** 2 + (v + 0.4) ** 2) / 0.1)
    paint(canvas, palette.BALL_LIGHT, np.clip(1.25 * glint, 0.0, 1.0).astype(np.float32))
    below = np.exp(-(((u - 0.28) / 0.5) ** 2 + ((v - 0.6) / 0.2) ** 2))
    paint(canvas, palette.BALL_MIDDLE, (0.75 * below).astype(np.float32))
    rim = np.clip((np.hypot(u, v) - 0.8) / 0.2, 0.0, 1.0) ** 2
    shade(canvas, (-0.5 * rim).astype(np.float32), np.ones_like(distance))
    return _surface(canvas, fields.cover(distance, 1.0))


class Flash:
    """The light that a part adds when it is hit, at any strength."""

    STEPS = 12

    def __init__(self, patch: Patch, flash: NDArray[np.float32]) -> None:
        self._flash = flash
        self._place = (patch.left, patch.top)
        self._kept: dict[int, pygame.Surface] = {}

    def at(self, strength: float) -> Sprite | None:
        """The light at a strength from 0 to 1; None where there is nothing to see."""
        step = round(strength * self.STEPS)
        if step <= 0 or not self._flash.size:
            return None
        if step not in self._kept:
            self._kept[step] = light_surface(self._flash * np.float32(step / self.STEPS))
        return Sprite(self._kept[step], self._place)


def light_surface(light: NDArray[np.float32]) -> pygame.Surface:
    """A surface to be blitted with BLEND_RGB_ADD."""
    levels = np.clip(light * 255.0, 0.0, 255.0).astype(np.uint8)
    return pygame.image.frombuffer(levels.tobytes(), (levels.shape[1], levels.shape[0]), "RGB")


@cache
def _grid(side: int) -> tuple[Field, Field]:
    """The pixel centres of a square image: columns [1, side] and rows [side, 1]."""
    line = np.arange(side, dtype=np.float32) + np.float32(0.5)
    return line[None, :], line[:, None]


def _paddle_sprite(camera: Camera, paddle: Paddle, angle: float) -> Sprite:
    corners = paddle.corners(angle)
    xs, zs = [corner[0] for corner in corners], [corner[1] for corner in corners]
    reach = SHADOW_OFFSET + 2.5 * SHADOW_SOFTNESS
    patch = camera.patch(min(xs) - reach, min(zs) - reach, max(xs) + reach, max(zs) + reach)
    pixel = patch.pixel
    distance = fields.polygon(patch.x, patch.z, corners)
    mask = fields.cover(distance, pixel)
    canvas = _plain(palette.PADDLE, mask)
    edge = np.clip(1.0 + distance / np.float32(0.28 * paddle.base), 0.0, 1.0)
    shade(canvas, 0.6 * edge * facing(*fields.slope(distance, pixel)), np.ones_like(mask))
    shade(canvas, -0.35 * fields.ring(distance + np.float32(0.5 * pixel), 0.5 * pixel, pixel), mask)
    _paint_pivot(canvas, patch, paddle)
    cast = fields.polygon(patch.x, patch.z, tuple(moved(corner) for corner in corners))
    shadow = 0.5 * np.clip(0.5 - cast / np.float32(2.0 * SHADOW_SOFTNESS), 0.0, 1.0)
    alpha = mask + (1.0 - mask) * shadow
    canvas *= (mask / np.maximum(alpha, 1e-6))[..., None]  # the shadow's own colour is black
    return Sprite(_surface(canvas, alpha.astype(np.float32)), (patch.left, patch.top))


def _paint_pivot(canvas: NDArray[np.float32], patch: Patch, paddle: Paddle) -> None:
    """The screw on which a paddle turns."""
    x, z = paddle.pivot
    toward_tip = 0.32 * paddle.base if paddle.side == "left" else -0.32 * paddle.base
    head = fields.circle(patch.x, patch.z, (x, z + toward_tip), PIVOT_RADIUS * paddle.base)
    mask = fields.cover(head, patch.pixel)
    paint(canvas, palette.PADDLE_PIVOT, mask)
    rim = np.clip(1.0 + head / (PIVOT_RADIUS * paddle.base), 0.0, 1.0)
    shade(canvas, 0.6 * rim * facing(*fields.slope(head, patch.pixel)), mask)


def _plain(color: Color, like: NDArray[np.floating]) -> NDArray[np.float32]:
    canvas = np.empty((*like.shape, 3), np.float32)
    canvas[:] = tone(color)
    return canvas


def _surface(canvas: NDArray[np.float32], alpha: Field) -> pygame.Surface:
    """A surface with an alpha channel from colours and a mask, 0 to 1 both."""
    rgba = np.concatenate([canvas, alpha[..., None]], axis=2)
    levels = np.clip(rgba * 255.0 + 0.5, 0.0, 255.0).astype(np.uint8)
    return pygame.image.frombuffer(levels.tobytes(), (levels.shape[1], levels.shape[0]), "RGBA")
