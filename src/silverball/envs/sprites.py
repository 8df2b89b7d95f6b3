"""Backgrounds of the boards and sprites of balls and paddles, made before the first picture is drawn.

The board is stretched to the whole picture. Grey is the luminance of the colours.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool
from silverball.envs.pixels import ANGLES, SUBPIXELS, count_coverage
from silverball.envs.state import RASTER
from silverball.physics.records import Kind, records
from silverball.table.geometry import offsets, paddle_cores

SAMPLES = 4  # along each axis of a pixel
LUMINANCE = (0.299, 0.587, 0.114)  # Source: ITU-R BT.601

Color: TypeAlias = tuple[int, int, int]
"""Red, green and blue, 0 to 255 each."""

# Few colours, far apart, for agents. Parts of one kind cycle through the colours of a tuple.
FLOOR: Color = (52, 26, 84)
RAIL: Color = (84, 72, 132)
SLANT_WALL: Color = (112, 92, 178)
GUTTER: Color = (255, 58, 92)
PADDLE: Color = (255, 150, 34)
PRISMS: tuple[Color, ...] = ((246, 74, 46), (246, 74, 46), (34, 186, 246), (34, 186, 246))
CYLINDERS: tuple[Color, ...] = ((255, 196, 40), (255, 58, 130), (66, 222, 110))
LIGHT: Color = (255, 252, 240)  # of a part that was just hit
BALL: Color = (255, 255, 255)

Bytes = NDArray[np.uint8]


class Pictures(NamedTuple):
    """Everything that the kernels need to draw the boards of one pool at one size.

    Attributes:
        raster: One RASTER record; each engine copies it.
        backgrounds: uint8 [board, pixel].
        balls: Sprites of a ball at each position within a pixel, flat.
        paddles: Sprites of the left, then of the right paddle at each angle, flat.
    """

    raster: NDArray[Any]
    backgrounds: Bytes
    balls: Bytes
    paddles: Bytes


def make_pictures(pool: Pool, size: tuple[int, int], rgb: bool) -> Pictures:
    """The pictures of a pool at a size (height, width)."""
    return _cached_pictures(_PoolKey(pool), size, rgb)


def empty_pictures(pool: Pool) -> Pictures:
    """Empty arrays, for environments that show states."""
    empty = np.zeros(0, np.uint8)
    return Pictures(records(1, RASTER), np.zeros((len(pool.tables), 0), np.uint8), empty, empty)


class _PoolKey:
    """A pool as a cache key, compared by identity since it holds arrays."""

    def __init__(self, pool: Pool) -> None:
        self.pool = pool

    def __hash__(self) -> int:
        return id(self.pool.boards.board)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _PoolKey) and self.pool.boards.board is other.pool.boards.board


@lru_cache(maxsize=8)
def _cached_pictures(key: _PoolKey, size: tuple[int, int], rgb: bool) -> Pictures:
    pool = key.pool
    raster = _raster(pool, size, rgb)
    backgrounds = np.stack([_background(raster, pool, board) for board in range(len(pool.tables))])
    balls = _ball_sprites(raster, pool.tables[0].board.ball_radius)
    paddles = _paddle_sprites(raster, pool)
    for array in (backgrounds, balls, paddles):
        array.flags.writeable = False
    return Pictures(raster, backgrounds, balls, paddles)


def _channels(color: Color, rgb: bool) -> NDArray[np.float64]:
    """A colour as one (grey) or three channels, 0 to 255."""
    values = np.array(color, np.float64)
    return values if rgb else np.array([values @ LUMINANCE])


def _raster(pool: Pool, size: tuple[int, int], rgb: bool) -> NDArray[Any]:
    board = pool.tables[0].board
    raster = records(1, RASTER)
    row = raster[0]
    row["height"], row["width"], row["channels"] = *size, 3 if rgb else 1
    row["rows"], row["columns"] = size[0] / board.length, size[1] / board.width
    row["half_length"], row["half_width"] = board.length / 2, board.width / 2
    row["ball_rows"] = math.ceil(board.ball_radius * row["rows"])
    row["ball_columns"] = math.ceil(board.ball_radius * row["columns"])
    light = np.rint(_channels(LIGHT, rgb)).astype(int)
    row["red"], row["green"], row["blue"] = light[0], light[-2] if rgb else 0, light[-1]
    return raster


def _background(raster: NDArray[Any], pool: Pool, board: int) -> Bytes:
    """The static parts of a board, uint8 [pixel]."""
    height, width, channels = (int(raster[name][0]) for name in ("height", "width", "channels"))
    rgb = channels == 3
    picture = np.tile(_channels(FLOOR, rgb), (height, width, 1))
    table = pool.tables[board]
    edge = table.board.wall_thickness
    x = table.board.length / 2 - (np.arange(height) + 0.5) / raster["rows"][0]
    z = (np.arange(width) + 0.5) / raster["columns"][0] - table.board.width / 2
    picture[x > table.board.length / 2 - edge] = _channels(RAIL, rgb)
    picture[:, np.abs(z) > table.board.width / 2 - edge] = _channels(RAIL, rgb)
    picture[np.abs(x - table.board.gutter) * raster["rows"][0] <= 0.5] = _channels(GUTTER, rgb)
    covered = np.zeros((height, width), np.int64)
    first, end = pool.boards.board["collider_first"][board], pool.boards.board["collider_end"][board]
    counts = {Kind.SLANT_WALL: 0, Kind.TRIANGULAR_PRISM: 0, Kind.CYLINDER: 0}
    for index in range(first + pool.boards.board["shape_first"][board], end):
        collider = pool.boards.collider[index]
        kind = Kind(int(collider["kind"]))
        count_coverage(raster[0], collider, SAMPLES, covered)
        share = (covered / SAMPLES**2)[:, :, None]
        picture += share * (_channels(_color(kind, counts[kind]), rgb) - picture)
        counts[kind] += 1
    return np.rint(picture).astype(np.uint8).reshape(-1)


def _color(kind: Kind, number: int) -> Color:
    """The colour of the part with this number among those of its kind."""
    if kind == Kind.TRIANGULAR_PRISM:
        return PRISMS[number % len(PRISMS)]
    if kind == Kind.CYLINDER:
        return CYLINDERS[number % len(CYLINDERS)]
    return SLANT_WALL


def _ball_sprites(raster: NDArray[Any], radius: float) -> Bytes:
    """A ball at each of SUBPIXELS × SUBPIXELS positions within the middle pixel, antialiased."""
    reach_rows, reach_columns = int(raster["ball_rows"][0]), int(raster["ball_columns"][0])
    fine = (np.arange(SUBPIXELS) + 0.5) / SUBPIXELS
    points = (np.arange(SAMPLES) + 0.5) / SAMPLES
    rows = np.arange(-reach_rows, reach_rows + 1)[:, None] + points
    columns = np.arange(-reach_columns, reach_columns + 1)[:, None] + points
    x = (rows[None] - fine[:, None, None]) / raster["rows"][0]  # [place, row, sample]
    z = (columns[None] - fine[:, None, None]) / raster["columns"][0]
    square = x[:, None, :, None, :, None] ** 2 + z[None, :, None, :, None, :] ** 2
    share = (square <= radius * radius).mean(axis=(-1, -2))[..., None]
    color = _channels(BALL, int(raster["channels"][0]) == 3)
    sprites: Bytes = np.rint(share * color).astype(np.uint8).reshape(-1)
    return sprites


def _paddle_sprites(raster: NDArray[Any], pool: Pool) -> Bytes:
    """The paddles at ANGLES angles from rest to raised, in one box each; writes the boxes into the raster."""
    board = pool.tables[0].board
    boxes: dict[int, tuple[int, int, int, int]] = {}
    cores: dict[int, NDArray[np.float64]] = {}
    height, width, channels = (int(raster[name][0]) for name in ("height", "width", "channels"))
    for paddle in pool.tables[0].paddle:
        side = 0 if paddle.side == "left" else 1
        angles = np.linspace(paddle.rest_angle, paddle.up_angle, ANGLES)
        cores[side] = paddle_cores(paddle, angles)
        rows = (board.length / 2 - cores[side][..., 0]) * raster["rows"][0]
        columns = (board.width / 2 + cores[side][..., 1]) * raster["columns"][0]
        top, bottom = max(0, math.floor(rows.min())), min(height, math.floor(rows.max()) + 1)
        left, right = max(0, math.floor(columns.min())), min(width, math.floor(columns.max()) + 1)
        boxes[side] = (top, left, bottom - top, right - left)
    if not boxes:
        return np.zeros(1, np.uint8)
    high = max(box[2] for box in boxes.values())
    wide = max(box[3] for box in boxes.values())
    raster["paddle_rows"], raster["paddle_columns"] = high, wide
    sprites = np.zeros((2, ANGLES, high, wide, channels), np.uint8)
    color = _channels(PADDLE, channels == 3)
    points = (np.arange(SAMPLES) + 0.5) / SAMPLES
    for side, (top, left, _, _) in boxes.items():
        raster["paddle_row"][0, side], raster["paddle_column"][0, side] = top, left
        x = board.length / 2 - (top + np.arange(high)[:, None] + points) / raster["rows"][0]
        z = (left + np.arange(wide)[:, None] + points) / raster["columns"][0] - board.width / 2
        grid = np.stack(np.broadcast_arrays(x[:, None, :, None], z[None, :, None, :]), axis=-1)
        for number in range(ANGLES):
            inside = (offsets(grid, cores[side][number]) == 0.0).all(axis=-1)
            sprites[side, number] = np.rint(inside.mean(axis=(-1, -2))[..., None] * color)
    return sprites.reshape(-1)
