"""Backgrounds of the boards and sprites of what moves, made before the first picture is drawn.

The board is stretched to the whole picture. Grey is the luminance of the colours. Everything is drawn from
the primitives of the parts, in the colour of their finish.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool
from silverball.envs.pixels import ANGLES, SUBPIXELS
from silverball.envs.state import LAMPS, PICTURED_BOARD, PIECE, RASTER
from silverball.physics.forms import Shape
from silverball.physics.records import records
from silverball.table import Table, expand
from silverball.table.outlines import closed_outline
from silverball.table.primitive import Finish, Primitive

SAMPLES = 4  # along each axis of a pixel
LUMINANCE = (0.299, 0.587, 0.114)  # Source: ITU-R BT.601
LINE_WIDTH = 0.06  # [u] half the width of a line in the playfield
UPPER_LEVEL = 0.5  # opacity of what stands on an upper level

Color: TypeAlias = tuple[int, int, int]
"""Red, green and blue, 0 to 255 each."""

# Few colours, far apart, for agents. Parts of one finish cycle through the colours of a tuple.
FLOOR: Color = (52, 26, 84)
RAIL: Color = (84, 72, 132)
GUTTER: Color = (255, 58, 92)
PADDLE: Color = (255, 150, 34)
COLORS: dict[Finish, tuple[Color, ...]] = {
    Finish.BORDER: (RAIL,),
    Finish.WALL: ((112, 92, 178),),
    Finish.METAL: ((140, 146, 170),),
    Finish.WOOD: ((128, 92, 60),),
    Finish.PLASTIC: ((70, 96, 190),),
    Finish.RUBBER: ((190, 170, 200),),
    Finish.PADDLE: (PADDLE,),
    Finish.PRISM: ((246, 74, 46), (246, 74, 46), (34, 186, 246), (34, 186, 246)),
    Finish.BUMPER: ((255, 196, 40), (255, 58, 130), (66, 222, 110)),
    Finish.TARGET: ((240, 110, 110),),
    Finish.ROLLOVER: ((60, 150, 150),),
    Finish.GATE: ((150, 190, 90),),
    Finish.SPINNER: ((220, 60, 160),),
    Finish.HOLE: ((12, 8, 20),),
    Finish.PLUNGER: ((120, 120, 120),),
    Finish.RAMP: ((90, 120, 60),),
}
"""The colours of each finish; a test refuses a finish without one."""
LAMP_FINISHES = frozenset(
    {Finish.PRISM, Finish.BUMPER, Finish.TARGET, Finish.ROLLOVER, Finish.SPINNER, Finish.HOLE, Finish.RAMP}
)
"""Finishes of parts that light up in the step in which they are hit or passed."""
LIGHT: Color = (255, 252, 240)  # of a part that was just hit
BALL: Color = (255, 255, 255)

Bytes = NDArray[np.uint8]
Mask = NDArray[np.bool_]


class Pictures(NamedTuple):
    """Everything that the kernels need to draw the boards of one pool at one size.

    Attributes:
        raster: One RASTER record; each engine copies it.
        backgrounds: uint8 [board, pixel].
        balls: Sprites of a ball at each position within a pixel, flat.
        paddles: Sprites of each paddle at each angle, flat.
        pictured_boards: PICTURED_BOARD records [board].
        lamp_of: The number of the lamp of each part, or −1, int64 [board, part].
        pieces: PIECE records: for each board its lamps, then what switches remove.
        masks: The pixels of all pieces, flat; 1 within.
    """

    raster: NDArray[Any]
    backgrounds: Bytes
    balls: Bytes
    paddles: Bytes
    pictured_boards: NDArray[Any]
    lamp_of: NDArray[np.int64]
    pieces: NDArray[Any]
    masks: Bytes


def make_pictures(pool: Pool, size: tuple[int, int], rgb: bool) -> Pictures:
    """The pictures of a pool at a size (height, width)."""
    return _cached_pictures(_PoolKey(pool), size, rgb)


def empty_pictures(pool: Pool) -> Pictures:
    """Empty arrays, for environments that show states."""
    empty, count = np.zeros(0, np.uint8), len(pool.tables)
    return Pictures(
        records(1, RASTER), np.zeros((count, 0), np.uint8), empty, empty, records(count, PICTURED_BOARD),
        np.zeros((count, 0), np.int64), records(0, PIECE), empty,
    )  # fmt: skip


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
    drawers = [_Drawer(raster, table) for table in pool.tables]
    backgrounds = np.stack([drawer.background() for drawer in drawers])
    balls = _ball_sprites(raster, pool.tables[0].board.ball_radius)
    paddles = _paddle_sprites(raster, drawers[0])
    pictures = Pictures(raster, backgrounds, balls, paddles, *_pieces(pool, drawers))
    for array in pictures[1:]:
        array.flags.writeable = False
    return pictures


def _channels(color: Color, rgb: bool) -> NDArray[np.float64]:
    """A colour as one (grey) or three channels, 0 to 255."""
    if rgb:
        return np.array(color, np.float64)
    # A product of arrays would be rounded as the library of this processor likes.
    return np.array([sum(share * one for share, one in zip(LUMINANCE, color, strict=True))])


def _raster(pool: Pool, size: tuple[int, int], rgb: bool) -> NDArray[Any]:
    board = pool.tables[0].board
    raster = records(1, RASTER)
    row = raster[0]
    row["height"], row["width"], row["channels"] = *size, 3 if rgb else 1
    row["rows"], row["columns"] = size[0] / board.length, size[1] / board.width
    row["half_length"], row["half_width"] = board.length / 2, board.width / 2
    row["ball_rows"] = math.ceil(board.ball_radius * row["rows"])
    row["ball_columns"] = math.ceil(board.ball_radius * row["columns"])
    row["red"], row["green"], row["blue"] = _three(LIGHT, rgb)
    return raster


def _three(color: Color, rgb: bool) -> tuple[int, int, int]:
    """A colour in the fields of a record: all three, or its grey as red."""
    values = np.rint(_channels(color, rgb)).astype(int).tolist()
    return (values[0], values[1], values[2]) if rgb else (values[0], 0, values[0])


class _Area(NamedTuple):
    """Pixels of a picture: the first row and column, and those after the last."""

    top: int
    left: int
    bottom: int
    right: int


class _Drawer:
    """Draws the primitives of one table at one size."""

    def __init__(self, raster: NDArray[Any], table: Table) -> None:
        self.table = table
        self.expansion = expand(table)
        self.height, self.width, channels = (int(raster[n][0]) for n in ("height", "width", "channels"))
        self.rgb = channels == 3
        self.rows, self.columns = float(raster["rows"][0]), float(raster["columns"][0])

    def background(self) -> Bytes:
        """The static parts of the board, uint8 [pixel]."""
        board = self.table.board
        picture = np.tile(_channels(FLOOR, self.rgb), (self.height, self.width, 1))
        edge = board.wall_thickness
        x = board.length / 2 - (np.arange(self.height) + 0.5) / self.rows
        z = (np.arange(self.width) + 0.5) / self.columns - board.width / 2
        picture[x > board.length / 2 - edge] = _channels(RAIL, self.rgb)
        picture[:, np.abs(z) > board.width / 2 - edge] = _channels(RAIL, self.rgb)
        picture[np.abs(x - board.gutter) * self.rows <= 0.5] = _channels(GUTTER, self.rgb)
        for _, color, primitives in sorted(self.parts(), key=lambda part: min(part[2][0].levels)):
            still = [p for p in primitives if p.mover is None and not p.has_switch]
            opacity = UPPER_LEVEL if min(primitives[0].levels) > 0 else 1.0
            outline = closed_outline(still)
            if outline is not None:
                area = self.area([*outline])
                self._blend(picture, area, 0.7 * opacity * _share(self.samples(area), outline), color)
            for primitive in still:
                area, share = self.coverage(primitive)
                self._blend(picture, area, opacity * share, color)
        return np.rint(picture).astype(np.uint8).reshape(-1)

    def parts(self) -> Iterator[tuple[int, Color, tuple[Primitive, ...]]]:
        """Yield the number, colour and primitives of every part but the borders."""
        counts: dict[Finish, int] = {}
        for number, rows in groupby(self.expansion.rows, key=lambda row: row.part):
            primitives = tuple(row.primitive for row in rows)
            if primitives[0].shape == Shape.PLANE:
                continue
            finish = primitives[0].finish
            counts[finish] = counts.get(finish, -1) + 1
            yield number, COLORS[finish][counts[finish] % len(COLORS[finish])], primitives

    def area(self, points: list[tuple[float, float]], radius: float = 0.0) -> _Area:
        """The pixels within a radius [u] of points, clipped to the picture."""
        board = self.table.board
        xs, zs = [x for x, _ in points], [z for _, z in points]
        top = math.floor((board.length / 2 - max(xs) - radius) * self.rows) - 1
        bottom = math.ceil((board.length / 2 - min(xs) + radius) * self.rows) + 1
        left = math.floor((min(zs) - radius + board.width / 2) * self.columns) - 1
        right = math.ceil((max(zs) + radius + board.width / 2) * self.columns) + 1
        top, left = min(max(top, 0), self.height), min(max(left, 0), self.width)
        return _Area(top, left, min(max(bottom, top), self.height), min(max(right, left), self.width))

    def samples(self, area: _Area, samples: int = SAMPLES) -> tuple[NDArray[Any], NDArray[Any]]:
        """The points (x, z) [u] of an area, that broadcast to [row, column, sample, sample]."""
        board = self.table.board
        points = (np.arange(samples) + 0.5) / samples - 0.5
        x = board.length / 2 - (np.arange(area.top, area.bottom) + 0.5) / self.rows
        z = (np.arange(area.left, area.right) + 0.5) / self.columns - board.width / 2
        at_x = x[:, None] + points / self.rows
        at_z = z[:, None] + points / self.columns
        return at_x[:, None, :, None], at_z[None, :, None, :]

    def coverage(self, primitive: Primitive) -> tuple[_Area, NDArray[np.float64]]:
        """An area that contains a primitive, and the share of each of its pixels that lies within it."""
        area = self.area_of(primitive)
        return area, is_within(primitive, *self.samples(area)).mean(axis=(-1, -2))

    def area_of(self, primitive: Primitive) -> _Area:
        """The pixels that a primitive can cover."""
        if primitive.shape != Shape.ARC:
            return self.area(list(primitive.points), max(primitive.radius, LINE_WIDTH))
        arc = primitive.arc
        return self.area([arc.center], arc.radius + primitive.radius)

    def _blend(self, picture: NDArray[Any], area: _Area, share: NDArray[Any], color: Color) -> None:
        part = picture[area.top : area.bottom, area.left : area.right]
        part += share[:, :, None] * (_channels(color, self.rgb) - part)


def is_within(primitive: Primitive, x: NDArray[Any], z: NDArray[Any]) -> Mask:
    """Whether points (x, z) [u] lie within a primitive; a line in the playfield has a width."""
    shape, points, radius = primitive.shape, primitive.points, primitive.radius
    if shape in (Shape.CIRCLE, Shape.DISC):
        return _distance(x, z, points[0]) - radius <= 0.0
    if shape == Shape.TRIANGLE:
        inside: Mask = np.ones(np.broadcast_shapes(x.shape, z.shape), np.bool_)
        for (x0, z0), (x1, z1) in zip(points, (*points[1:], points[0]), strict=True):
            length = math.sqrt((x1 - x0) ** 2 + (z1 - z0) ** 2)
            along_x, along_z = (x1 - x0) / length, (z1 - z0) / length
            inside &= (x - x0) * -along_z + (z - z0) * along_x <= 0.0
        return inside
    if shape == Shape.TAPERED:
        (x0, z0), (x1, z1) = points
        length = math.dist(*points)
        sine = (radius - primitive.tip_radius) / length
        cosine = math.sqrt(1.0 - sine * sine)
        along = ((x - x0) * (x1 - x0) + (z - z0) * (z1 - z0)) / length
        across = np.abs((x - x0) * (z1 - z0) - (z - z0) * (x1 - x0)) / length
        side = along * cosine - across * sine
        on_side = (side > 0.0) & (side < cosine * length) & (across * cosine + along * sine <= radius)
        ends = _distance(x, z, points[0]) <= radius, _distance(x, z, points[1]) <= primitive.tip_radius
        return on_side | ends[0] | ends[1]
    if shape == Shape.ARC:
        center, size, middle, _, cosine = primitive.arc
        out_x, out_z, rho = x - center[0], z - center[1], _distance(x, z, center)
        on_arc = (out_x * middle[0] + out_z * middle[1] >= rho * cosine) & (np.abs(rho - size) <= radius)
        return on_arc | (_distance(x, z, points[0]) <= radius) | (_distance(x, z, points[1]) <= radius)
    if shape == Shape.LINE:
        radius = LINE_WIDTH
    elif shape != Shape.CAPSULE:
        raise ValueError(f"a {shape.name} has no inside")
    (x0, z0), (x1, z1) = points
    dx, dz = x1 - x0, z1 - z0
    length = math.sqrt(dx * dx + dz * dz)
    foot = (x - x0) * (dx / length) + (z - z0) * (dz / length)
    beside = np.abs((x - x0) * (dz / length) - (z - z0) * (dx / length))
    between = (foot > 0.0) & (foot < length) & (beside - radius <= 0.0)
    near_first = (foot <= 0.0) & (_distance(x, z, points[0]) - radius <= 0.0)
    near_second = (foot >= length) & (_distance(x, z, points[1]) - radius <= 0.0)
    within: Mask = between | near_first | near_second
    return within


def _distance(x: NDArray[Any], z: NDArray[Any], point: tuple[float, float]) -> NDArray[np.float64]:
    dx, dz = x - point[0], z - point[1]
    distance: NDArray[np.float64] = np.sqrt(dx * dx + dz * dz)
    return distance


def _share(points: tuple[NDArray[Any], NDArray[Any]], outline: tuple[tuple[float, float], ...]) -> Any:
    """The share of each pixel that lies within a polygon, by the sides that a ray from it crosses."""
    x, z = points
    inside = np.zeros(np.broadcast_shapes(x.shape, z.shape), np.bool_)
    for (px, pz), (qx, qz) in zip(outline, (*outline[1:], outline[0]), strict=True):
        if pz != qz:
            inside ^= ((pz > z) != (qz > z)) & (x < px + (z - pz) / (qz - pz) * (qx - px))
    return inside.mean(axis=(-1, -2))


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


def _paddle_sprites(raster: NDArray[Any], drawer: _Drawer) -> Bytes:
    """The paddles at ANGLES angles from rest to raised, in one box each; writes the boxes into the raster."""
    paddles = [row.primitive for row in drawer.expansion.rows if row.primitive.mover is not None]
    if not paddles:
        return np.zeros(1, np.uint8)
    turns = [
        np.linspace(p.mover.rest_angle, p.mover.up_angle, ANGLES) for p in paddles if p.mover is not None
    ]
    areas = [_swept_area(drawer, paddle, angles) for paddle, angles in zip(paddles, turns, strict=True)]
    high = max(area.bottom - area.top for area in areas)
    wide = max(area.right - area.left for area in areas)
    raster["paddle_rows"], raster["paddle_columns"] = high, wide
    sprites = np.zeros((len(paddles), ANGLES, high, wide, 3 if drawer.rgb else 1), np.uint8)
    color = _channels(PADDLE, drawer.rgb)
    for number, (paddle, angles, area) in enumerate(zip(paddles, turns, areas, strict=True)):
        raster["paddle_row"][0, number], raster["paddle_column"][0, number] = area.top, area.left
        x, z = drawer.samples(_Area(area.top, area.left, area.top + high, area.left + wide))
        for step, angle in enumerate(angles):
            share = is_within(paddle, *_in_its_frame(paddle, angle, x, z)).mean(axis=(-1, -2))
            sprites[number, step] = np.rint(share[..., None] * color)
    return sprites.reshape(-1)


def _in_its_frame(
    paddle: Primitive, angle: float, x: NDArray[Any], z: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Points in the frame of a paddle at an angle [rad], see physics/paddle.py."""
    assert paddle.mover is not None
    rx, rz = x - paddle.mover.pivot[0], paddle.mover.direction * (z - paddle.mover.pivot[1])
    sine, cosine = math.sin(angle), math.cos(angle)
    return rx * cosine - rz * sine, rx * sine + rz * cosine


def _swept_area(drawer: _Drawer, paddle: Primitive, angles: NDArray[Any]) -> _Area:
    """The pixels that a paddle covers at some angle."""
    assert paddle.mover is not None
    (x, z), side, board = paddle.mover.pivot, paddle.mover.direction, drawer.table.board
    sine, cosine = np.sin(angles)[:, None], np.cos(angles)[:, None]
    across, along = np.array(paddle.points).T
    radii = np.zeros(len(along)) if paddle.shape == Shape.TRIANGLE else (paddle.radius, paddle.tip_radius)
    up = x + (across * cosine + along * sine)
    right = z + side * (along * cosine - across * sine)
    rows, columns = (board.length / 2 - up) * drawer.rows, (board.width / 2 + right) * drawer.columns
    tall, wide = np.array(radii) * drawer.rows, np.array(radii) * drawer.columns
    return _Area(
        max(0, math.floor((rows - tall).min())),
        max(0, math.floor((columns - wide).min())),
        min(drawer.height, math.floor((rows + tall).max()) + 1),
        min(drawer.width, math.floor((columns + wide).max()) + 1),
    )


def _pieces(
    pool: Pool, drawers: list[_Drawer]
) -> tuple[NDArray[Any], NDArray[np.int64], NDArray[Any], Bytes]:
    """The lamps of all boards and what switches remove, and the masks of both."""
    boards = records(len(drawers), PICTURED_BOARD)
    parts = max(len(drawer.expansion.parts) for drawer in drawers)
    lamp_of = np.full((len(drawers), parts), -1, np.int64)
    found: list[tuple[_Area, Mask, Color, int]] = []
    for number, drawer in enumerate(drawers):
        boards["lamp_first"][number] = len(found)
        lamps = 0
        for part, _, primitives in drawer.parts():
            if primitives[0].finish in LAMP_FINISHES and lamps < LAMPS:
                lamp_of[number, part] = lamps
                lamps += 1
                found.append((*_pixels_of(drawer, primitives[0]), LIGHT, 0))
        boards["switch_first"][number] = len(found)
        first = pool.boards.board["collider_first"][number]
        for part, color, primitives in drawer.parts():
            row = drawer.expansion.parts[part].first
            for index, primitive in enumerate(primitives):
                if primitive.has_switch:
                    switch = int(pool.boards.collider["switch"][first + row + index])
                    found.append((*_pixels_of(drawer, primitive), color, switch))
        boards["piece_end"][number] = len(found)
    pieces, masks, used = records(len(found), PIECE), [], 0
    for piece, (area, mask, color, switch) in zip(pieces, found, strict=True):
        piece["top"], piece["left"] = area.top, area.left
        piece["rows"], piece["columns"], piece["mask_first"] = *mask.shape, used
        piece["red"], piece["green"], piece["blue"] = _three(color, drawers[0].rgb)
        piece["switch"] = switch
        masks.append(mask.astype(np.uint8).reshape(-1))
        used += mask.size
    return boards, lamp_of, pieces, np.concatenate([*masks, np.zeros(1, np.uint8)])


def _pixels_of(drawer: _Drawer, primitive: Primitive) -> tuple[_Area, Mask]:
    """The pixels whose centre lies within a primitive, in an area that contains it."""
    area = drawer.area_of(primitive)
    return area, is_within(primitive, *drawer.samples(area, 1))[:, :, 0, 0]
