"""The playfield: what does the floor under everything look like?

A slow gradient with rays, a few stars, an emblem where the rays meet, and the dark end towards the gutter.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from silverball.drawing import fields, palette
from silverball.drawing.camera import Camera
from silverball.drawing.canvas import light, paint, shade, tone
from silverball.drawing.fields import Field
from silverball.table import Board

RAYS = 22
STARS_PER_AREA = 0.9  # stars per square unit
EMBLEM_AT = -0.07  # of the board's length, from the centre: just above the slingshots of most tables


def paint_floor(canvas: NDArray[np.float32], camera: Camera) -> None:
    """Paint the whole floor, borders excluded."""
    board = camera.board
    half_length, half_width = 0.5 * board.length, 0.5 * board.width
    patch = camera.patch(-half_length, -half_width, half_length, half_width)
    rows_columns = patch.rows_columns
    region = canvas[rows_columns]
    _gradient(region, patch.x, half_length)
    _rays(region, patch.x, patch.z, board, patch.pixel)
    _stars(canvas, camera)
    _emblem(canvas, camera)
    _edges(region, patch.x, patch.z, board)


def _gradient(region: NDArray[np.float32], x: Field, half_length: float) -> None:
    stops = np.array([-half_length, 0.0, half_length], np.float32)
    colors = (tone(palette.FLOOR_BOTTOM), tone(palette.FLOOR_MIDDLE), tone(palette.FLOOR_TOP))
    for channel in range(3):
        region[..., channel] = np.interp(x, stops, [color[channel] for color in colors])


def _rays(region: NDArray[np.float32], x: Field, z: Field, board: Board, pixel: float) -> None:
    from_x, from_z = x - np.float32(EMBLEM_AT * board.length), z
    distance = np.hypot(from_x, from_z)
    waves = np.cos(RAYS * np.arctan2(from_z, from_x))
    # The edge of a ray is where the wave is 0; its slope there is RAYS / distance, so this is one pixel wide.
    edge = np.clip(0.5 + waves * distance / (RAYS * pixel), 0.0, 1.0)
    reach = np.float32(0.5 * board.length)
    strength = 0.34 * np.exp(-((distance / reach) ** 2)) + 0.07
    paint(region, palette.RAY, (edge * strength).astype(np.float32))
    light(region, palette.GLOW, (0.3 * np.exp(-((distance / (0.36 * reach)) ** 2))).astype(np.float32))


def _stars(canvas: NDArray[np.float32], camera: Camera) -> None:
    board = camera.board
    chance = np.random.default_rng(5)  # always the same sky
    count = int(STARS_PER_AREA * board.length * board.width)
    places = chance.uniform(-0.5, 0.5, (count, 2)) * (board.length, board.width)
    sizes = chance.uniform(0.012, 0.032, count)
    strengths = chance.uniform(0.15, 0.75, count)
    for (x, z), size, strength in zip(places.tolist(), sizes.tolist(), strengths.tolist(), strict=True):
        reach = size + 2.0 * camera.pixel
        patch = camera.patch(x - reach, z - reach, x + reach, z + reach)
        distance = fields.circle(patch.x, patch.z, (x, z), size)
        light(canvas[patch.rows_columns], palette.STAR, strength * fields.cover(distance, patch.pixel))


def _emblem(canvas: NDArray[np.float32], camera: Camera) -> None:
    """A printed star in two rings: faint, so that nobody takes it for an obstacle."""
    board = camera.board
    center = (EMBLEM_AT * board.length, 0.0)
    size = 0.125 * board.width
    patch = camera.patch(center[0] - 2 * size, -2 * size, center[0] + 2 * size, 2 * size)
    region, pixel = canvas[patch.rows_columns], patch.pixel
    for radius, strength in ((size, 0.16), (0.86 * size, 0.08)):
        edge = fields.circle(patch.x, patch.z, center, radius)
        light(region, palette.EMBLEM, 0.35 * strength * fields.glow(np.abs(edge), 0.12 * size))
        paint(region, palette.EMBLEM, strength * fields.ring(edge, 0.016 * size, pixel))
    star = fields.polygon(patch.x, patch.z, _star(center, 0.66 * size)) - np.float32(0.05 * size)
    light(region, palette.EMBLEM_HEART, 0.05 * fields.glow(star, 0.12 * size))
    paint(region, palette.EMBLEM_HEART, 0.08 * fields.cover(star, pixel))
    paint(region, palette.EMBLEM_HEART, 0.16 * fields.ring(star, 0.018 * size, pixel))


def _star(center: tuple[float, float], radius: float) -> tuple[tuple[float, float], ...]:
    points = []
    for number in range(10):
        reach = radius if number % 2 == 0 else 0.46 * radius
        turn = math.radians(36.0 * number)
        points.append((center[0] + reach * math.cos(turn), center[1] + reach * math.sin(turn)))
    return tuple(points)


def _edges(region: NDArray[np.float32], x: Field, z: Field, board: Board) -> None:
    """Darken the floor along the rails, whose shadow falls on it, and towards the gutter."""
    half_length = 0.5 * board.length
    half_width = 0.5 * board.width - board.wall_thickness
    from_left, from_right, from_top = z + half_width, half_width - z, half_length - board.wall_thickness - x
    dark = 0.62 * np.exp(-np.minimum(from_left, from_top) / 0.32) + 0.4 * np.exp(-from_right / 0.3)
    shade(region, -np.clip(dark, 0.0, 0.8).astype(np.float32), np.ones_like(dark, np.float32))
    depth = np.clip((board.gutter + 1.9 - x) / 2.2, 0.0, 1.0) ** 2
    shade(region, (-0.82 * depth).astype(np.float32), np.ones_like(region[..., 0]))
