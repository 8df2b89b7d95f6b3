"""Compiling tables: from parts as data to the arrays that the physics reads.

The parts of every board are a run of rows in one shared array of colliders, in the order of `part_names`:
three borders, two paddles, then slant walls, prisms and cylinders in the order of the file. An event, a tally
and a collider row name a part by this number.

    compile_tables   everything for a world: rows, grids, places for new balls, hashes
    compile_parts    the rows of one table alone, for drawing
    part_numbers     the number of each part, without compiling

Tables from files and from the generator have passed `check_table`. A table made in Python is not checked, so
that unusual boards are possible; only parts without an extent are refused.
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
from silverball.physics.records import (
    BOARD,
    COLLIDER,
    LEFT,
    MAX_PADDLES,
    RIGHT,
    WORLD,
    Kind,
    Part,
    Shape,
    records,
)
from silverball.physics.tolerances import (
    CELL_SHARE,
    GRID_CELL,
    LOW_GRAVITY,
    MAX_SEARCH_TIME,
    SEARCH_TIME,
    SKIN,
    SKIN_SHARE,
)
from silverball.table import (
    Board,
    Cylinder,
    Paddle,
    SlantWall,
    Table,
    TriangularPrism,
    ball_places,
    expand,
    table_digest,
)

SLACK = 1e-9  # [u] added to bounds, so that their rounding cannot matter
FIRST_GRID_SIZE = 1024  # initial capacity of a board's grid [int32 entries]; most boards need less
TINY = 1e-300  # smallest divisor, to avoid division by zero
FAR = 1e9  # [u] place of a paddle that the table does not have, out of every ball's reach
FIRST_PART_NAMES = ("board.left", "board.right", "board.top", "paddle.left", "paddle.right")
PADDLES = ((Part.LEFT_PADDLE, "left", LEFT), (Part.RIGHT_PADDLE, "right", RIGHT))
FIRST_SHAPE = int(Part.FIRST_PADDLE) + len(PADDLES)  # row of the first stationary shape
SHARED_FIELDS = (
    "ball_radius", "ball_restitution", "friction", "gravity", "gutter", "hit_speed", "jitter", "max_balls",
    "speed_cap",
)  # fmt: skip
"""Fields that `silverball.table.Board` and BOARD records share."""


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
    """Compile concrete tables (random parts already generated) into arrays.

    Raises:
        TableError: A part has no extent, or two paddles are on one side.
    """
    boards = records(len(tables), BOARD)
    colliders = [compile_parts(table) for table in tables]
    places = []
    collider_count = place_count = 0
    for row, table, parts in zip(boards, tables, colliders, strict=True):
        _set_board(row, table.board)
        _set_bounds(row, table, parts)
        row["paddles"], row["shape_first"] = len(PADDLES), FIRST_SHAPE
        centers, size = ball_places(table)
        row["collider_first"], row["collider_end"] = collider_count, collider_count + len(parts)
        row["place_first"], row["place_end"] = place_count, place_count + len(centers)
        row["place_size"] = size
        row["place_lowest"] = centers[:, 0].min() - size / 2 if len(centers) else math.inf
        places.append(centers)
        collider_count += len(parts)
        place_count += len(centers)
    collider = records(collider_count, COLLIDER)
    np.concatenate(colliders, out=collider)
    return Boards(
        boards,
        collider,
        _grids(boards, collider),
        np.ascontiguousarray(np.concatenate(places)),
        tuple(part_names(table) for table in tables),
        tuple(table_digest(table) for table in tables),
    )


def compile_parts(table: Table) -> NDArray[Any]:
    """Return the COLLIDER records of a finished table in the order of `part_names`, without its grid.

    Raises:
        TableError: A part has no extent, or two paddles are on one side.
    """
    _refuse_degenerate(table)
    rows = records(FIRST_SHAPE + len(table.stationary_parts), COLLIDER)
    rows["speed_factor"], rows["levels"] = 1.0, 1
    rows["friction"], rows["hit_speed"] = table.board.friction, table.board.hit_speed
    rows["part"] = np.arange(len(rows))
    _set_borders(rows, table.board)
    paddles: dict[str, Paddle] = {paddle.side: paddle for paddle in table.paddle}
    for number, side, button in PADDLES:
        _set_paddle(rows[number], paddles.get(side), table.board.ball_radius)
        rows[number]["button"] = button
    for row, part in zip(rows[FIRST_SHAPE:], table.stationary_parts, strict=True):
        if isinstance(part, SlantWall):
            _set_slant_wall(row, part, table.board)
        elif isinstance(part, TriangularPrism):
            _set_prism(row, part)
        else:
            _set_cylinder(row, part)
        _set_surface(row, part)
    return rows


def part_names(table: Table) -> tuple[str, ...]:
    """Return the names of a table's parts in the order of their numbers: "board.left" … "cylinder[2]"."""
    return (*FIRST_PART_NAMES, *(name for name in expand(table).names if name not in FIRST_PART_NAMES))


def part_numbers(table: Table) -> dict[str, int]:
    """Return the number of each part by its name: its row among the colliders and its column of tallies.

    Examples:
        >>> import silverball as sb
        >>> from silverball.world.compile import part_numbers
        >>> part_numbers(sb.load_table("classic"))["paddle.left"]
        3
    """
    return {name: number for number, name in enumerate(part_names(table))}


def blank_worlds(boards: Boards, board_of: NDArray[np.int64]) -> NDArray[Any]:
    """Make worlds in which nothing has happened: no balls, paddles at rest, seed 0.

    Args:
        boards: The compiled tables.
        board_of: The board of each world [world].

    Returns:
        WORLD records, shape [world].
    """
    worlds = records(len(board_of), WORLD)
    first = boards.board["collider_first"][board_of]
    for index in range(MAX_PADDLES):
        worlds_with = np.flatnonzero(boards.board["paddles"][board_of] > index)
        rest = boards.collider["angle_rest"][first[worlds_with] + Part.FIRST_PADDLE + index]
        worlds["paddle"]["angle"][worlds_with, index] = rest
        worlds["paddle"]["angle_commanded"][worlds_with, index] = rest
    return worlds


def _set_board(row: Any, board: Board) -> None:
    """Set the fields of a board, and the bound on the acceleration of flights on it."""
    for name in SHARED_FIELDS:
        row[name] = getattr(board, name)
    row["accel_x"], row["accel_z"] = 0.0 - board.gravity, 0.0  # not −0.0
    row["curvature"] = 1.0 / board.ball_radius
    row["half_length"], row["half_width"] = board.length / 2, board.width / 2
    if board.rolling and board.friction > 0.0:
        sine, cosine = sine_cosine(math.radians(board.slope))
        row["normal_accel"] = board.gravity * cosine / sine
    row["max_accel"] = board.gravity + board.friction * row["normal_accel"]


def _set_bounds(row: Any, table: Table, parts: NDArray[Any]) -> None:
    """Set where the borders stop a ball's centre, and where the paddles can reach it."""
    radius = table.board.ball_radius
    row["low_z"] = parts[Part.LEFT_WALL]["z"] + radius
    row["high_z"] = parts[Part.RIGHT_WALL]["z"] - radius
    row["top_x"] = parts[Part.TOP_WALL]["x"] - radius
    row["paddle_top"] = max((_top(paddle) + radius for paddle in table.paddle), default=-FAR)


def _grids(boards: NDArray[Any], collider: NDArray[Any]) -> NDArray[np.int32]:
    """The grids of all boards, in one array; also sets the boards' fields about them."""
    grid = np.zeros(FIRST_GRID_SIZE * len(boards), np.int32)
    used = 0
    for row in boards:
        shapes = row["collider_end"] - row["collider_first"] - row["shape_first"]
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
    """Maximum simulated time that one search may cover [s].

    At low gravity it is the time that a ball starting from rest takes to travel `skin`.
    """
    if board["gravity"] >= LOW_GRAVITY:
        return SEARCH_TIME
    return min(math.sqrt(board["skin"] / max(board["max_accel"], TINY)), MAX_SEARCH_TIME)


def _set_slant_wall(row: Any, wall: SlantWall, board: Board) -> None:
    row["kind"], row["shape"] = Kind.SLANT_WALL, Shape.CAPSULE
    _set_side(row, 0, wall.start, wall.end)
    row["x1"], row["z1"] = wall.end
    row["radius"] = wall.thickness
    row["inward_x"], row["inward_z"] = wall.inward_normal(board)
    row["x"], row["z"] = (wall.start[0] + wall.end[0]) / 2, (wall.start[1] + wall.end[1]) / 2
    row["reach"] = row["length0"] / 2 + wall.thickness


def _set_prism(row: Any, prism: TriangularPrism) -> None:
    row["kind"], row["shape"] = Kind.TRIANGULAR_PRISM, Shape.TRIANGLE
    corners = prism.corners(sine_cosine)
    _set_triangle(row, corners)
    row["x"], row["z"], row["reach"] = _circle_around(corners)


def _set_cylinder(row: Any, cylinder: Cylinder) -> None:
    row["kind"], row["shape"] = Kind.CYLINDER, Shape.CIRCLE
    row["x"], row["z"], row["radius"] = cylinder.circle()
    row["reach"] = row["radius"]


def _refuse_degenerate(table: Table) -> None:
    """Refuse parts without an extent and paddles on one side, which only a table made in Python can have."""
    problems = []
    sides = [paddle.side for paddle in table.paddle]
    if len(set(sides)) < len(sides):
        problems.append(Problem("paddle", f"there can be one paddle per side, got {', '.join(sides)}"))
    for index, wall in enumerate(table.slant_wall):
        if wall.start == wall.end:
            problems.append(Problem(f"slant_wall[{index}]", "must have two different ends"))
    for index, prism in enumerate(table.triangular_prism):
        a, b, c = prism.corners()
        if (b[1] - a[1]) * (c[0] - a[0]) == (b[0] - a[0]) * (c[1] - a[1]):
            problems.append(Problem(f"triangular_prism[{index}]", "must not be flat"))
    if problems:
        raise TableError(table.name, problems)


def _set_borders(rows: NDArray[Any], board: Board) -> None:
    borders = rows[Part.LEFT_WALL : Part.TOP_WALL + 1]
    borders["kind"] = Kind.WALL
    borders["restitution"] = board.wall_restitution
    rows[Part.LEFT_WALL]["z"] = -board.width / 2 + board.wall_thickness
    rows[Part.RIGHT_WALL]["z"] = board.width / 2 - board.wall_thickness
    rows[Part.TOP_WALL]["x"] = board.length / 2 - board.wall_thickness
    rows[Part.LEFT_WALL]["inward_z"], rows[Part.RIGHT_WALL]["inward_z"] = 1.0, -1.0
    rows[Part.TOP_WALL]["inward_x"] = -1.0


def _set_paddle(row: Any, paddle: Paddle | None, ball_radius: float) -> None:
    """Set a paddle in its own frame (see physics/paddle.py): pivot at the origin, tip along z′."""
    if paddle is None:
        row["kind"], row["x"], row["z"], row["side"] = Kind.ABSENT, FAR, FAR, 1.0
        row["sweep_x"] = FAR
        return
    row["kind"], row["shape"] = Kind.PADDLE, Shape.TRIANGLE
    row["side"] = paddle.direction
    row["x"], row["z"] = paddle.pivot
    _set_triangle(row, paddle.local_corners())
    row["reach"] = paddle.reach
    row["sweep_x"], row["sweep_z"], reach = _swept_circle(paddle)
    row["sweep_reach"] = reach + ball_radius
    row["angle_rest"], row["angle_up"] = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
    swing = row["angle_up"] - row["angle_rest"]
    row["lift_speed"], row["return_speed"] = swing / paddle.stroke, swing / paddle.return_stroke
    for name in ("rest", "up"):
        row[f"sine_{name}"], row[f"cosine_{name}"] = sine_cosine(row[f"angle_{name}"])
    _set_surface(row, paddle)


def _top(paddle: Paddle) -> float:
    """An upper bound on the x [u] that any point of the paddle reaches."""
    tip = paddle.length * math.sin(math.radians(paddle.up_angle))
    return paddle.pivot[0] + max(tip, 0.5 * paddle.base) + SLACK


def _swept_circle(paddle: Paddle) -> tuple[float, float, float]:
    """A circle (x, z, radius) [u] around a paddle at all its angles.

    The centre lies halfway to the tip at the middle angle; the farthest points are the tip at either stop and
    the ends of the base.
    """
    middle = math.radians(0.5 * (paddle.rest_angle + paddle.up_angle))
    swing = math.radians(0.5 * (paddle.up_angle - paddle.rest_angle))
    half = 0.5 * paddle.length
    x, z = half * math.sin(middle), math.copysign(half * math.cos(middle), paddle.direction)
    tip = math.sqrt(paddle.length**2 + half**2 - 2 * paddle.length * half * math.cos(swing))
    return paddle.pivot[0] + x, paddle.pivot[1] + z, max(tip, half + 0.5 * paddle.base) + SLACK


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


def _circle_around(corners: Sequence[Sequence[float]]) -> tuple[float, float, float]:
    """A circle (x, z, radius) [u] around a triangle, centred on its centroid."""
    x = sum(corner[0] for corner in corners) / 3
    z = sum(corner[1] for corner in corners) / 3
    farthest = max((corner[0] - x) ** 2 + (corner[1] - z) ** 2 for corner in corners)
    return x, z, math.sqrt(farthest) * (1 + 1e-12)
