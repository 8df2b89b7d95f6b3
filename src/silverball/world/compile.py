"""How does a table come to life: from the parts a person wrote to the arrays that the step reads?

Every board takes a run of rows of one shared array of colliders, in the order of `physics.layout.Part`:
three borders, two paddles, then slant walls, prisms and cylinders in the order of the file.

Tables from files and from the generator have passed `check_table`; one made in Python is taken as it is, so
that strange boards can be tried, unless its parts make no sense at all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.errors import Problem, TableError
from silverball.physics.broad_phase import fill_grid
from silverball.physics.portable_math import sine_cosine
from silverball.physics.records import BOARD, COLLIDER, Kind, Part, records
from silverball.physics.tolerances import (
    CELL_SHARE,
    GRID_CELL,
    LOW_GRAVITY,
    MAX_SEARCH_TIME,
    SEARCH_TIME,
    SKIN,
    SKIN_SHARE,
)
from silverball.table import Board, Paddle, Table, TriangularPrism, ball_places, table_digest

SLACK = 1e-9  # [u] added to bounds, so that their rounding cannot matter
GRID_ROOM = 1024  # numbers for a board's grid at first; most need fewer
TINY = 1e-300  # what a divisor is at least
FAR = 1e9  # [u] where the paddle lies that a table does not have: out of every ball's reach


class Boards(NamedTuple):
    """The compiled tables of a world or a batch.

    Attributes:
        board: BOARD records, shape [board].
        collider: COLLIDER records of all boards, shape [collider].
        grid: The grids of all boards, 32-bit numbers (see physics/broad_phase.py).
        place: Centres (x, z) [u] of the squares in which balls may be created, shape [place, 2].
        names: For each board, the names of its parts in the order of their numbers.
        digests: For each board, the hash of its table.
    """

    board: NDArray[Any]
    collider: NDArray[Any]
    grid: NDArray[np.int32]
    place: NDArray[np.float64]
    names: tuple[tuple[str, ...], ...]
    digests: tuple[str, ...]


def compile_tables(tables: Sequence[Table]) -> Boards:
    """Compile finished tables (without a `[random]` section) into arrays."""
    boards = records(len(tables), BOARD)
    colliders: list[NDArray[Any]] = []
    places: list[NDArray[np.float64]] = []
    names: list[tuple[str, ...]] = []
    collider_count = place_count = 0
    for row, table in zip(boards, tables, strict=True):
        parts, part_names = _colliders(table)
        cells, size = ball_places(table)
        b = table.board
        row["accel_x"], row["accel_z"] = 0.0 - b.gravity, 0.0  # not −0.0
        for name in (
            "ball_radius",
            "ball_restitution",
            "speed_cap",
            "hit_speed",
            "jitter",
            "gutter",
            "max_balls",
        ):
            row[name] = getattr(b, name)
        row["curvature"] = 1.0 / b.ball_radius
        row["half_length"], row["half_width"] = b.length / 2, b.width / 2
        row["low_z"], row["high_z"] = (
            parts[Part.LEFT_WALL]["z"] + b.ball_radius,
            parts[Part.RIGHT_WALL]["z"] - b.ball_radius,
        )
        row["top_x"] = parts[Part.TOP_WALL]["x"] - b.ball_radius
        row["left_x"] = row["right_x"] = FAR
        for p in table.paddle:
            x, z, reach = _sweep(p)
            row[f"{p.side}_x"], row[f"{p.side}_z"], row[f"{p.side}_reach"] = x, z, reach + b.ball_radius
        row["paddle_top"] = max((_top(p) + b.ball_radius for p in table.paddle), default=-FAR)
        _set_friction(row, b)
        row["collider_first"], row["collider_end"] = collider_count, collider_count + len(parts)
        row["place_first"], row["place_end"] = place_count, place_count + len(cells)
        row["place_size"] = size
        row["place_lowest"] = cells[:, 0].min() - size / 2 if len(cells) else math.inf
        colliders.append(parts)
        places.append(cells)
        names.append(part_names)
        collider_count += len(parts)
        place_count += len(cells)
    collider = records(collider_count, COLLIDER)
    np.concatenate(colliders, out=collider)
    return Boards(
        boards,
        collider,
        _grids(boards, collider),
        np.ascontiguousarray(np.concatenate(places)),
        tuple(names),
        tuple(table_digest(table) for table in tables),
    )


def _set_friction(row: Any, board: Board) -> None:
    """The friction of a board, and the greatest acceleration that a flight on it can have."""
    row["friction"] = board.friction
    if board.rolling and board.friction > 0.0:
        sine, cosine = sine_cosine(math.radians(board.slope))
        row["normal_accel"] = board.gravity * cosine / sine
    row["gravity"] = board.gravity
    row["max_accel"] = board.gravity + board.friction * row["normal_accel"]


def _grids(boards: NDArray[Any], collider: NDArray[Any]) -> NDArray[np.int32]:
    """The grids of all boards, in one array."""
    grid = np.zeros(GRID_ROOM * len(boards), np.int32)
    used = 0
    for row in boards:
        shapes = row["collider_end"] - row["collider_first"] - Part.FIRST_SHAPE
        spacing = math.sqrt(4.0 * row["half_length"] * row["half_width"] / max(shapes, 1))
        row["grid_first"], row["skin"] = used, min(SKIN, SKIN_SHARE * spacing)
        row["search_time"] = _search_time(row)
        row["grid_scale"] = 1.0 / min(GRID_CELL, spacing * CELL_SHARE)
        row["grid_rows"] = math.ceil(2 * row["half_length"] * row["grid_scale"])
        row["grid_columns"] = math.ceil(2 * row["half_width"] * row["grid_scale"])
        need = fill_grid(row, collider, grid)
        if used + need > len(grid):
            grid = np.concatenate([grid, np.zeros(len(grid) + need, np.int32)])
            fill_grid(row, collider, grid)
        used += need
    return np.ascontiguousarray(grid[:used])


def _search_time(board: Any) -> float:
    """How long a search may be [s]; where hardly anything pulls, until a ball from rest has gone the skin."""
    if board["gravity"] >= LOW_GRAVITY:
        return SEARCH_TIME
    return min(math.sqrt(board["skin"] / max(board["max_accel"], TINY)), MAX_SEARCH_TIME)


def compile_parts(table: Table) -> NDArray[Any]:
    """Return the COLLIDER records of one table, in the order of `part_numbers`."""
    return _colliders(table)[0]


def part_numbers(table: Table) -> dict[str, int]:
    """Return the number of each part of a table by its path, such as "cylinder[0]"."""
    return {name: number for number, name in enumerate(_colliders(table)[1])}


def _colliders(table: Table) -> tuple[NDArray[Any], tuple[str, ...]]:
    """The COLLIDER records of one table, and the names of its parts."""
    count = Part.FIRST_SHAPE + len(table.slant_wall) + len(table.triangular_prism) + len(table.cylinder)
    _refuse_nonsense(table)
    rows = records(count, COLLIDER)
    rows["speed_factor"] = 1.0
    names = ["board.left", "board.right", "board.top", "paddle.left", "paddle.right"]
    _set_borders(rows, table)
    for number, side in ((Part.LEFT_PADDLE, "left"), (Part.RIGHT_PADDLE, "right")):
        paddle = next((p for p in table.paddle if p.side == side), None)
        _set_paddle(rows[number], paddle)
    next_row = iter(rows[Part.FIRST_SHAPE :])
    for index, wall in enumerate(table.slant_wall):
        row = next(next_row)
        row["kind"] = Kind.SLANT_WALL
        _set_segment(row, wall.start, wall.end, wall.thickness, wall.inward_normal(table.board))
        _set_surface(row, wall)
        names.append(f"slant_wall[{index}]")
    for index, prism in enumerate(table.triangular_prism):
        row = next(next_row)
        row["kind"] = Kind.TRIANGULAR_PRISM
        corners = _corners(prism)
        _set_triangle(row, corners)
        row["x"], row["z"], row["reach"] = _circle_around(corners)
        _set_surface(row, prism)
        names.append(f"triangular_prism[{index}]")
    for index, cylinder in enumerate(table.cylinder):
        row = next(next_row)
        row["kind"] = Kind.CYLINDER
        row["x"], row["z"], row["radius"] = cylinder.circle()
        row["reach"] = row["radius"]
        _set_surface(row, cylinder)
        names.append(f"cylinder[{index}]")
    return rows, tuple(names)


def _refuse_nonsense(table: Table) -> None:
    """Refuse parts that have no outline or no side, which only a table made in Python can have."""
    problems = []
    sides = [paddle.side for paddle in table.paddle]
    if len(set(sides)) < len(sides):
        problems.append(Problem("paddle", f"there can be one paddle a side, got {', '.join(sides)}"))
    for index, wall in enumerate(table.slant_wall):
        if wall.start == wall.end:
            problems.append(Problem(f"slant_wall[{index}]", "must have two different ends"))
    for index, prism in enumerate(table.triangular_prism):
        a, b, c = prism.corners()
        if (b[1] - a[1]) * (c[0] - a[0]) == (b[0] - a[0]) * (c[1] - a[1]):
            problems.append(Problem(f"triangular_prism[{index}]", "must not be flat"))
    if problems:
        raise TableError(table.name, problems)


def _corners(prism: TriangularPrism) -> Sequence[tuple[float, float]]:
    """The corners of a prism, those of an equilateral one by our own sine: the same bits on every machine."""
    if prism.center is None or prism.size is None:
        return prism.corners()
    x, z = prism.center
    turns = (sine_cosine(math.radians(prism.rotation + third)) for third in (0.0, 120.0, 240.0))
    return [(x + prism.size * sine, z + prism.size * cosine) for sine, cosine in turns]


def _set_borders(rows: NDArray[Any], table: Table) -> None:
    b = table.board
    borders = rows[Part.LEFT_WALL : Part.TOP_WALL + 1]
    borders["kind"] = Kind.WALL
    borders["restitution"] = b.wall_restitution
    rows[Part.LEFT_WALL]["z"] = -b.width / 2 + b.wall_thickness
    rows[Part.RIGHT_WALL]["z"] = b.width / 2 - b.wall_thickness
    rows[Part.TOP_WALL]["x"] = b.length / 2 - b.wall_thickness
    rows[Part.LEFT_WALL]["inward_z"], rows[Part.RIGHT_WALL]["inward_z"] = 1.0, -1.0
    rows[Part.TOP_WALL]["inward_x"] = -1.0


def _set_paddle(row: Any, paddle: Paddle | None) -> None:
    """A paddle in its own frame (see physics/paddle.py): base at the origin, tip along z′, x′ > 0 lifts."""
    if paddle is None:
        row["kind"], row["x"], row["z"], row["side"] = Kind.ABSENT, FAR, FAR, 1.0
        return
    row["kind"] = Kind.PADDLE
    row["side"] = 1.0 if paddle.side == "left" else -1.0
    row["x"], row["z"] = paddle.pivot
    half = paddle.base / 2
    _set_triangle(row, ((-half, 0.0), (0.0, paddle.length), (half, 0.0)))
    row["reach"] = paddle.reach
    row["angle_rest"], row["angle_up"] = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
    swing = row["angle_up"] - row["angle_rest"]
    row["lift_speed"], row["return_speed"] = swing / paddle.stroke, swing / paddle.return_stroke
    for name in ("rest", "up"):
        row[f"sine_{name}"], row[f"cosine_{name}"] = sine_cosine(row[f"angle_{name}"])
    _set_surface(row, paddle)


def _top(paddle: Paddle) -> float:
    """An x [u] that no point of a paddle gets above, at any of its angles."""
    tip = paddle.length * math.sin(math.radians(paddle.up_angle))
    return paddle.pivot[0] + max(tip, 0.5 * paddle.base) + SLACK


def _sweep(paddle: Paddle) -> tuple[float, float, float]:
    """A circle (x, z, radius) [u] that holds a paddle at all its angles.

    Its middle lies halfway to the tip at the middle angle; the farthest from it are the tip at either stop
    and the ends of the base.
    """
    middle = math.radians(0.5 * (paddle.rest_angle + paddle.up_angle))
    swing = math.radians(0.5 * (paddle.up_angle - paddle.rest_angle))
    way = 0.5 * paddle.length
    x, z = (
        way * math.sin(middle),
        math.copysign(way * math.cos(middle), 1.0 if paddle.side == "left" else -1.0),
    )
    tip = math.sqrt(paddle.length**2 + way**2 - 2 * paddle.length * way * math.cos(swing))
    return paddle.pivot[0] + x, paddle.pivot[1] + z, max(tip, way + 0.5 * paddle.base) + SLACK


def _set_surface(row: Any, part: Any) -> None:
    row["restitution"], row["restitution_falloff"] = part.restitution, part.restitution_falloff
    row["points"] = part.points
    row["speed_factor"] = getattr(part, "speed_factor", 1.0)


def _set_side(row: Any, number: int, start: Sequence[float], end: Sequence[float]) -> None:
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
    row[f"x{number}"], row[f"z{number}"] = start
    row[f"along_x{number}"], row[f"along_z{number}"], row[f"length{number}"] = (
        dx / length,
        dz / length,
        length,
    )


def _set_triangle(row: Any, corners: Sequence[Sequence[float]]) -> None:
    for number in range(3):
        _set_side(row, number, corners[number], corners[(number + 1) % 3])


def _set_segment(
    row: Any, start: Sequence[float], end: Sequence[float], thickness: float, inward: Sequence[float]
) -> None:
    _set_side(row, 0, start, end)
    row["x1"], row["z1"] = end
    row["radius"] = thickness
    row["inward_x"], row["inward_z"] = inward
    row["x"], row["z"] = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    row["reach"] = row["length0"] / 2 + thickness


def _circle_around(corners: Sequence[Sequence[float]]) -> tuple[float, float, float]:
    """Centroid of the corners, and the distance of the farthest: not the smallest circle, but simple."""
    x = sum(corner[0] for corner in corners) / 3
    z = sum(corner[1] for corner in corners) / 3
    farthest = max((corner[0] - x) ** 2 + (corner[1] - z) ** 2 for corner in corners)
    return x, z, math.sqrt(farthest) * (1 + 1e-12)
