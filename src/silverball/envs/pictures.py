"""What must be ready before a picture can be drawn? Backgrounds of all boards, and sprites of what moves.

The colours are few and far apart (colors.py); grey is their luminance. The board is stretched to the whole
picture.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.envs import colors
from silverball.envs.board_pool import Pool
from silverball.envs.pixels import ANGLES, FINE, cover
from silverball.envs.state import FILM
from silverball.physics.records import Kind, Part, records
from silverball.table.geometry import offsets, paddle_cores

SAMPLES = 4  # along each axis of a pixel
LUMINANCE = (0.299, 0.587, 0.114)  # Source: ITU-R BT.601
FLOOR = colors.FLOOR

Bytes = NDArray[np.uint8]


class Pictures(NamedTuple):
    """What the drawing of one pool's boards at one size needs.

    Attributes:
        film: One FILM record, to be copied.
        backgrounds: uint8 [board, pixel].
        balls: Sprites of a ball at each place within a pixel, flat.
        paddles: Sprites of the left, then of the right paddle at each angle, flat.
    """

    film: NDArray[Any]
    backgrounds: Bytes
    balls: Bytes
    paddles: Bytes


def pictures_of(pool: Pool, size: tuple[int, int], rgb: bool) -> Pictures:
    """The pictures of a pool at a size (height, width)."""
    return _made(_Key(pool), size, rgb)


class _Key:
    """A pool, compared by identity: it holds arrays."""

    def __init__(self, pool: Pool) -> None:
        self.pool = pool

    def __hash__(self) -> int:
        return id(self.pool.boards.board)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self.pool.boards.board is other.pool.boards.board


@lru_cache(maxsize=8)
def _made(key: _Key, size: tuple[int, int], rgb: bool) -> Pictures:
    pool = key.pool
    film = _film(pool, size, rgb)
    backgrounds = np.stack([_background(film, pool, board) for board in range(len(pool.tables))])
    balls = _ball_sprites(film, pool.tables[0].board.ball_radius)
    paddles = _paddle_sprites(film, pool)
    for array in (backgrounds, balls, paddles):
        array.flags.writeable = False
    return Pictures(film, backgrounds, balls, paddles)


def shade(color: colors.Color, rgb: bool) -> NDArray[np.float64]:
    """A colour as one or three channels, 0 to 255."""
    channels = np.array(color, np.float64)
    return channels if rgb else np.array([channels @ LUMINANCE])


def _film(pool: Pool, size: tuple[int, int], rgb: bool) -> NDArray[Any]:
    board = pool.tables[0].board
    film = records(1, FILM)
    row = film[0]
    row["height"], row["width"], row["channels"] = *size, 3 if rgb else 1
    row["rows"], row["columns"] = size[0] / board.length, size[1] / board.width
    row["half_length"], row["half_width"] = board.length / 2, board.width / 2
    row["ball_rows"] = math.ceil(board.ball_radius * row["rows"])
    row["ball_columns"] = math.ceil(board.ball_radius * row["columns"])
    light = np.rint(shade(colors.LIGHT, rgb)).astype(int)
    row["red"], row["green"], row["blue"] = light[0], light[-2] if rgb else 0, light[-1]
    return film


def _background(film: NDArray[Any], pool: Pool, board: int) -> Bytes:
    """The still parts of a board, uint8 [pixel]."""
    height, width, channels = (int(film[name][0]) for name in ("height", "width", "channels"))
    rgb = channels == 3
    picture = np.tile(shade(FLOOR, rgb), (height, width, 1))
    table = pool.tables[board]
    edge = table.board.wall_thickness
    x = table.board.length / 2 - (np.arange(height) + 0.5) / film["rows"][0]
    z = (np.arange(width) + 0.5) / film["columns"][0] - table.board.width / 2
    picture[x > table.board.length / 2 - edge] = shade(colors.RAIL, rgb)
    picture[:, np.abs(z) > table.board.width / 2 - edge] = shade(colors.RAIL, rgb)
    picture[np.abs(x - table.board.gutter) * film["rows"][0] <= 0.5] = shade(colors.GUTTER, rgb)
    covered = np.zeros((height, width), np.int64)
    first, end = pool.boards.board["collider_first"][board], pool.boards.board["collider_end"][board]
    counts = {Kind.SLANT_WALL: 0, Kind.TRIANGULAR_PRISM: 0, Kind.CYLINDER: 0}
    for index in range(first + Part.FIRST_SHAPE, end):
        collider = pool.boards.collider[index]
        kind = Kind(int(collider["kind"]))
        cover(film[0], collider, SAMPLES, covered)
        share = (covered / SAMPLES**2)[:, :, None]
        picture += share * (shade(_color(kind, counts[kind]), rgb) - picture)
        counts[kind] += 1
    return np.rint(picture).astype(np.uint8).reshape(-1)


def _color(kind: Kind, number: int) -> colors.Color:
    if kind == Kind.TRIANGULAR_PRISM:
        return colors.in_turn(colors.PRISMS, number)
    if kind == Kind.CYLINDER:
        return colors.in_turn(colors.CYLINDERS, number)
    return colors.SLANT_WALL


def _ball_sprites(film: NDArray[Any], radius: float) -> Bytes:
    """A ball at each of FINE × FINE places within the middle pixel, antialiased."""
    reach_rows, reach_columns = int(film["ball_rows"][0]), int(film["ball_columns"][0])
    fine = (np.arange(FINE) + 0.5) / FINE
    points = (np.arange(SAMPLES) + 0.5) / SAMPLES
    rows = np.arange(-reach_rows, reach_rows + 1)[:, None] + points
    columns = np.arange(-reach_columns, reach_columns + 1)[:, None] + points
    x = (rows[None] - fine[:, None, None]) / film["rows"][0]  # [place, row, sample]
    z = (columns[None] - fine[:, None, None]) / film["columns"][0]
    square = x[:, None, :, None, :, None] ** 2 + z[None, :, None, :, None, :] ** 2
    share = (square <= radius * radius).mean(axis=(-1, -2))[..., None]
    color = shade(colors.BALL, int(film["channels"][0]) == 3)
    sprites: Bytes = np.rint(share * color).astype(np.uint8).reshape(-1)
    return sprites


def _paddle_sprites(film: NDArray[Any], pool: Pool) -> Bytes:
    """The paddles at ANGLES angles from rest to up, in one box for each; sets the boxes in the film."""
    board = pool.tables[0].board
    boxes: dict[int, tuple[int, int, int, int]] = {}
    cores: dict[int, NDArray[np.float64]] = {}
    height, width, channels = (int(film[name][0]) for name in ("height", "width", "channels"))
    for paddle in pool.tables[0].paddle:
        side = 0 if paddle.side == "left" else 1
        angles = np.linspace(paddle.rest_angle, paddle.up_angle, ANGLES)
        cores[side] = paddle_cores(paddle, angles)
        rows = (board.length / 2 - cores[side][..., 0]) * film["rows"][0]
        columns = (board.width / 2 + cores[side][..., 1]) * film["columns"][0]
        top, bottom = max(0, math.floor(rows.min())), min(height, math.floor(rows.max()) + 1)
        left, right = max(0, math.floor(columns.min())), min(width, math.floor(columns.max()) + 1)
        boxes[side] = (top, left, bottom - top, right - left)
    if not boxes:
        return np.zeros(1, np.uint8)
    high = max(box[2] for box in boxes.values())
    wide = max(box[3] for box in boxes.values())
    film["paddle_rows"], film["paddle_columns"] = high, wide
    sprites = np.zeros((2, ANGLES, high, wide, channels), np.uint8)
    color = shade(colors.PADDLE, channels == 3)
    points = (np.arange(SAMPLES) + 0.5) / SAMPLES
    for side, (top, left, _, _) in boxes.items():
        film["paddle_row"][0, side], film["paddle_column"][0, side] = top, left
        x = board.length / 2 - (top + np.arange(high)[:, None] + points) / film["rows"][0]
        z = (left + np.arange(wide)[:, None] + points) / film["columns"][0] - board.width / 2
        grid = np.stack(np.broadcast_arrays(x[:, None, :, None], z[None, :, None, :]), axis=-1)
        for number in range(ANGLES):
            inside = (offsets(grid, cores[side][number]) == 0.0).all(axis=-1)
            sprites[side, number] = np.rint(inside.mean(axis=(-1, -2))[..., None] * color)
    return sprites.reshape(-1)
