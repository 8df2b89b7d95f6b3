"""The walls: how are the rails around the board, the slant walls and the apron below the gutter painted?"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from silverball.drawing import fields, palette
from silverball.drawing.camera import RAIL, Camera, Patch
from silverball.drawing.canvas import facing, light, paint, shade
from silverball.drawing.fields import Field
from silverball.table import Board, SlantWall

SHADOW_OFFSET = 0.13  # [u] to the lower right, for everything that stands on the floor
SHADOW_SOFTNESS = 0.16  # [u]
ROUNDING = 0.3  # [u] of the rail's outer corners
TOUCHES_BORDER = 1e-6  # [u] an end of a slant wall this close to a border lies on it


def cast_shadow(canvas: NDArray[np.float32], patch: Patch, distance: Field, strength: float = 0.55) -> None:
    """Darken the floor where a shape keeps the light off; it has been `moved` to where its shadow falls."""
    mask = np.clip(0.5 - distance / np.float32(2.0 * SHADOW_SOFTNESS), 0.0, 1.0)
    mask *= mask * (3.0 - 2.0 * mask)
    paint(canvas[patch.rows_columns], palette.SHADOW, (strength * mask).astype(np.float32))


def paint_corner(canvas: NDArray[np.float32], camera: Camera, wall: SlantWall) -> None:
    """Fill the corner that a slant wall cuts off, if it runs from a side border to the top."""
    corner = _corner_behind(camera.board, wall)
    if corner is None:
        return
    patch = _patch_around(camera, (wall.start, wall.end, corner), 0.1)
    distance = fields.polygon(patch.x, patch.z, (wall.start, wall.end, corner))
    region = canvas[patch.rows_columns]
    mask = fields.cover(distance, patch.pixel)
    paint(region, palette.CORNER, mask)
    wall_distance = fields.segment(patch.x, patch.z, wall.start, wall.end, wall.thickness)
    shade(region, -0.3 * fields.glow(wall_distance, 0.4), mask)


def shadow_slant_wall(canvas: NDArray[np.float32], camera: Camera, wall: SlantWall) -> None:
    """The shadow of a slant wall on the floor."""
    start, end = moved(wall.start), moved(wall.end)
    patch = _patch_around(camera, (start, end), wall.thickness + 0.4)
    cast_shadow(canvas, patch, fields.segment(patch.x, patch.z, start, end, wall.thickness))


def paint_slant_wall(canvas: NDArray[np.float32], camera: Camera, wall: SlantWall) -> None:
    """A round bar between two points, exactly as thick as the physics says."""
    patch = _patch_around(camera, (wall.start, wall.end), wall.thickness + 0.4)
    region, pixel = canvas[patch.rows_columns], patch.pixel
    thickness = max(wall.thickness, 0.75 * pixel)
    distance = fields.segment(patch.x, patch.z, wall.start, wall.end, thickness)
    mask = fields.cover(distance, pixel)
    light(region, palette.SLANT_WALL, 0.16 * fields.glow(distance, 0.13))
    paint(region, palette.SLANT_WALL, mask)
    # A round bar: its surface tilts outwards with the distance from the middle line.
    tilt = np.clip(1.0 + distance / thickness, 0.0, 1.0)
    shade(region, 0.75 * tilt * facing(*fields.slope(distance, pixel)), mask)
    crest = np.clip(1.0 - np.abs(tilt - 0.25) / 0.3, 0.0, 1.0)
    shade(region, (0.2 * crest).astype(np.float32), mask)


def paint_rails(canvas: NDArray[np.float32], camera: Camera) -> None:
    """The frame at the left, right and top; its inner edge is the surface that balls meet."""
    board = camera.board
    half_length, half_width = 0.5 * board.length, 0.5 * board.width
    patch = camera.patch(
        -half_length - RAIL, -half_width - RAIL - 0.1, half_length + RAIL + 0.1, half_width + RAIL + 0.1
    )
    region, pixel = canvas[patch.rows_columns], patch.pixel
    bottom = -half_length - RAIL
    outer = fields.rectangle(
        patch.x, patch.z, (bottom, -half_width - RAIL), (half_length + RAIL, half_width + RAIL), ROUNDING
    )
    surface = board.wall_thickness
    inner = fields.rectangle(
        patch.x,
        patch.z,
        (bottom - 10.0, -half_width + surface),
        (half_length - surface, half_width - surface),
        0.02,
    )
    outside = fields.cover(outer, pixel)
    paint(region, palette.ROOM, 1.0 - outside)  # nothing of the floor shows around the frame
    frame = np.minimum(outside, fields.cover(-inner, pixel))
    paint(region, palette.RAIL, frame)
    across = np.clip(inner / (RAIL + surface), 0.0, 1.0)
    out_of = facing(*fields.slope(inner, pixel))
    bevel = np.clip(np.abs(2.0 * across - 1.0) * 3.2 - 2.2, 0.0, 1.0) * np.sign(across - 0.5)
    shade(region, (0.55 * bevel * out_of).astype(np.float32), frame)
    shade(region, (0.14 * (1.0 - np.abs(2.0 * across - 1.0))).astype(np.float32), frame)
    shade(
        region,
        (0.5 * np.sign(out_of) * fields.ring(inner - 0.02, 0.5 * pixel, pixel)).astype(np.float32),
        frame,
    )


def apron_top(board: Board) -> float:
    """The x [u] of the apron's upper edge: a ball has just dived under it when it is gone."""
    return max(board.gutter - board.ball_radius, -0.5 * board.length - 0.5 * RAIL)


def paint_apron(canvas: NDArray[np.float32], camera: Camera) -> None:
    """The plate at the bottom under which balls disappear."""
    board = camera.board
    half_width = 0.5 * board.width - board.wall_thickness
    top, bottom = apron_top(board), -0.5 * board.length - RAIL
    patch = camera.patch(bottom, -half_width, top + 0.6, half_width)
    region, pixel = canvas[patch.rows_columns], patch.pixel
    distance = np.broadcast_to(patch.x - np.float32(top), region.shape[:2])
    mask = fields.cover(distance, pixel)
    light(region, palette.GUTTER, 0.3 * fields.glow(distance, 0.14))
    paint(region, palette.APRON, mask)
    shade(region, (0.25 * np.exp(np.minimum(distance, 0.0) / 0.3)).astype(np.float32), mask)
    light(region, palette.GUTTER, 0.8 * fields.ring(distance, 0.02, pixel))


def moved(point: tuple[float, float]) -> tuple[float, float]:
    """Where the shadow of a point falls."""
    return point[0] - SHADOW_OFFSET, point[1] + 0.8 * SHADOW_OFFSET


def _patch_around(camera: Camera, points: tuple[tuple[float, float], ...], reach: float) -> Patch:
    xs, zs = [point[0] for point in points], [point[1] for point in points]
    return camera.patch(min(xs) - reach, min(zs) - reach, max(xs) + reach, max(zs) + reach)


def _corner_behind(board: Board, wall: SlantWall) -> tuple[float, float] | None:
    """The board's corner that a slant wall from a side border to the top cuts off."""
    half_length, half_width = 0.5 * board.length, 0.5 * board.width
    for low, high in ((wall.start, wall.end), (wall.end, wall.start)):
        on_side = math.isclose(abs(low[1]), half_width, abs_tol=TOUCHES_BORDER)
        on_top = math.isclose(high[0], half_length, abs_tol=TOUCHES_BORDER)
        if on_side and on_top:
            return half_length, math.copysign(half_width, low[1])
    return None
