"""Compiling tables: from parts as data to the arrays that the physics reads.

The primitives of every board are a run of rows in one shared array of colliders, in the order of
`table.expand`: three borders, the paddles, then all other parts. A part may have many rows; an event and a
tally name it by its own number.

    compile_tables   everything for a world: rows, grids, places for new balls, hashes
    compile_parts    the rows of one table alone, for drawing
    part_numbers     the number of each part, without compiling

Tables from files and from the generator have passed `check_table`. A table made in Python is not checked, so
that unusual boards are possible; only parts without an extent, and too many of something, are refused.
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
    MAX_BANKS,
    MAX_LEVELS,
    MAX_PADDLES,
    MAX_SPINNERS,
    MAX_SWITCHES,
    NO_CLOCK,
    PLAIN_BALLS,
    PLAIN_PADDLES,
    PLAIN_WORLD,
    RIGHT,
    WORLD,
    Device,
    Kind,
    Part,
    Response,
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
from silverball.table import Board, Table, ball_places, expand, table_digest
from silverball.table.expand import Expansion
from silverball.table.primitive import Point, Primitive
from silverball.table.standard_rules import rules_of, standard_rules
from silverball.world.rows import highest_x, set_row, swept_circle

FIRST_GRID_SIZE = 1024  # initial capacity of a board's grid [int32 entries]; most boards need less
TINY = 1e-300  # smallest divisor, to avoid division by zero
FAR = 1e9  # [u] below every board
ANY_SPEED = 1e300  # [u/s] capture speed of what captures every ball
BUTTONS = {"left": LEFT, "right": RIGHT}
SHARED_FIELDS = (
    "ball_radius", "ball_restitution", "friction", "gravity", "gutter", "hit_speed", "jitter", "max_balls",
    "nudge", "speed_cap",
)  # fmt: skip
"""Fields that `silverball.table.Board` and BOARD records share."""
KINDS = {
    "board": Kind.WALL,
    "slant_wall": Kind.SLANT_WALL,
    "paddle": Kind.PADDLE,
    "triangular_prism": Kind.TRIANGULAR_PRISM,
    "cylinder": Kind.CYLINDER,
}
"""The kinds of the parts of format 1, by their section; all others are OTHER."""


class Boards(NamedTuple):
    """The compiled tables of a world or a batch.

    Attributes:
        board: BOARD records, shape [board].
        collider: COLLIDER records of all boards, shape [collider].
        grid: The grids of all boards, 32-bit numbers (see physics/broad_phase.py).
        place: Centres (x, z) [u] of the squares in which balls may be created, shape [place, 2].
        names: For each board, the names of its parts in the order of their numbers.
        digests: For each board, the hash of its table.
        plain: Whether a world on the board has a PLAIN_WORLD record when it is alone, bool [board].
    """

    board: NDArray[Any]
    collider: NDArray[Any]
    grid: NDArray[np.int32]
    place: NDArray[np.float64]
    names: tuple[tuple[str, ...], ...]
    digests: tuple[str, ...]
    plain: NDArray[np.bool_]

    @property
    def layout(self) -> np.dtype[Any]:
        """The record of worlds that may be on any of the boards: PLAIN_WORLD if all are plain, else WORLD."""
        return PLAIN_WORLD if self.plain.all() else WORLD


def compile_tables(tables: Sequence[Table]) -> Boards:
    """Compile concrete tables (random parts already generated) into arrays.

    Raises:
        TableError: A part has no extent, or there is too much of something.
    """
    boards = records(len(tables), BOARD)
    colliders = [compile_parts(table) for table in tables]
    places = []
    collider_count = place_count = 0
    for row, table, rows in zip(boards, tables, colliders, strict=True):
        expansion = expand(table)
        _set_board(row, table.board, expansion)
        _set_bounds(row, expansion, rows)
        _set_devices(row, expansion, rows)
        centers, size = ball_places(table)
        row["collider_first"], row["collider_end"] = collider_count, collider_count + len(rows)
        row["place_first"], row["place_end"] = place_count, place_count + len(centers)
        row["place_size"] = size
        row["place_lowest"] = centers[:, 0].min() - size / 2 if len(centers) else math.inf
        places.append(centers)
        collider_count += len(rows)
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
        np.array([_is_plain(*one) for one in zip(tables, boards, colliders, strict=True)], np.bool_),
    )


def compile_parts(table: Table) -> NDArray[Any]:
    """Return the COLLIDER records of a finished table, one for each row of its expansion, without its grid.

    Raises:
        TableError: A part has no extent, or there is too much of something.
    """
    expansion = expand(table)
    _refuse_impossible(table, expansion)
    rows = records(len(expansion.rows), COLLIDER)
    switches, spinners = 0, 0
    banks = _banks(expansion)
    for row, (number, primitive) in zip(rows, expansion.rows, strict=True):
        set_row(row, primitive, table.board)
        row["part"], row["kind"] = number, KINDS.get(expansion.parts[number].kind, Kind.OTHER)
        if primitive.mover is not None:
            row["button"] = BUTTONS[primitive.mover.button]
            row["sweep_x"], row["sweep_z"], reach = swept_circle(primitive, primitive.mover)
            row["sweep_reach"] = reach + table.board.ball_radius
        if primitive.bank is not None or primitive.is_gate:
            row["switch"] = 1 << switches
            switches += 1
        row["role"] = device = _device(primitive)
        if primitive.bank is not None:
            row["number"] = banks.index(primitive.bank)
        elif device == Device.SPINNER:
            row["number"] = spinners
            spinners += 1
        _set_device_row(row, primitive)
    return rows


def part_names(table: Table) -> tuple[str, ...]:
    """Return the names of a table's parts in the order of their numbers: "board.left" … "cylinder[2]"."""
    return expand(table).names


def part_numbers(table: Table) -> dict[str, int]:
    """Return the number of each part by its name: its column of tallies, and its number in events.

    Examples:
        >>> import silverball as sb
        >>> from silverball.world.compile import part_numbers
        >>> part_numbers(sb.load_table("classic"))["paddle.left"]
        3
    """
    return dict(expand(table).numbers)


def blank_worlds(boards: Boards, board_of: NDArray[np.int64]) -> NDArray[Any]:
    """Make worlds in which nothing has happened: no balls, paddles at rest, gates closed, seed 0.

    Args:
        boards: The compiled tables.
        board_of: The board of each world [world].

    Returns:
        WORLD or PLAIN_WORLD records, shape [world].
    """
    worlds = records(len(board_of), boards.layout)
    if boards.layout == WORLD:
        worlds["next_clock"] = NO_CLOCK
    first = boards.board["collider_first"][board_of]
    for index in range(worlds["paddle"].shape[1]):
        worlds_with = np.flatnonzero(boards.board["paddles"][board_of] > index)
        rest = boards.collider["angle_rest"][first[worlds_with] + Part.FIRST_PADDLE + index]
        worlds["paddle"]["angle"][worlds_with, index] = rest
        worlds["paddle"]["angle_commanded"][worlds_with, index] = rest
    return worlds


def _set_board(row: Any, board: Board, expansion: Expansion) -> None:
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
    for level, (x, z) in enumerate(expansion.gravity):
        size = abs(x) if z == 0.0 else math.sqrt(x * x + z * z)
        normal = _normal_accel(size, board.gravity, row["normal_accel"])
        row["level_x"][level], row["level_z"][level] = x, z
        row["level_size"][level], row["level_normal"][level] = size, normal
        row["max_accel"] = max(row["max_accel"], size + board.friction * normal)


def _normal_accel(pull: float, gravity: float, normal: float) -> float:
    """The acceleration onto a level along which it is `pull` [u/s²]; 0: vertical, or without friction.

    Both have the size that `gravity` and `normal` have together, those of the playfield.
    """
    if normal == 0.0 or pull == gravity:
        return normal
    return math.sqrt(max(0.0, normal * normal + (gravity - pull) * (gravity + pull)))


def _set_bounds(row: Any, expansion: Expansion, rows: NDArray[Any]) -> None:
    """Set where the borders stop a ball's centre, and where the paddles can reach it."""
    radius = row["ball_radius"]
    row["low_z"] = rows[Part.LEFT_WALL]["z"] + radius
    row["high_z"] = rows[Part.RIGHT_WALL]["z"] - radius
    row["top_x"] = rows[Part.TOP_WALL]["x"] - radius
    movers = [one for _, one in expansion.rows if one.mover is not None]
    row["paddles"], row["shape_first"] = len(movers), int(Part.FIRST_PADDLE) + len(movers)
    row["paddle_top"] = max((highest_x(one, one.mover) + radius for one in movers if one.mover), default=-FAR)


def _set_devices(row: Any, expansion: Expansion, rows: NDArray[Any]) -> None:
    """Set what the devices of a board are, and where."""
    row["sensors"] = np.count_nonzero(rows["response"] != Response.BOUNCE)
    row["switches"] = int(np.bitwise_or.reduce(rows["switch"]))
    plungers = np.flatnonzero(rows["role"] == Device.PLUNGER)
    row["plungers"], row["plunger_row"] = len(plungers), plungers[0] if len(plungers) else 0
    spinners = np.flatnonzero(rows["role"] == Device.SPINNER)
    row["spinners"], row["spinner_row"][: len(spinners)] = len(spinners), spinners
    row["banks"] = len(_banks(expansion))
    for collider, (_, primitive) in zip(rows, expansion.rows, strict=True):
        if primitive.bank is not None:
            number = collider["number"]
            row["bank_switches"][number] |= collider["switch"]
            row["bank_time"][number] = max(row["bank_time"][number], primitive.reset_after)


def _is_plain(table: Table, board: Any, rows: NDArray[Any]) -> bool:
    """Whether PLAIN_WORLD has room for a world on a board, and its kernels know all that is there.

    The referee's kernels know the standard rules only.
    """
    return bool(
        rules_of(table) is standard_rules()
        and board["max_balls"] <= PLAIN_BALLS
        and board["paddles"] == PLAIN_PADDLES
        and board["sensors"] == board["switches"] == board["nudge"] == 0
        and not rows["one_way"].any()
        and not (rows["form"] == Shape.ARC).any()
        and (rows["levels"] & 1).all()
    )


def _banks(expansion: Expansion) -> list[str]:
    """The names of the banks of drop targets, in the order of their first members."""
    return list(dict.fromkeys(one.bank for _, one in expansion.rows if one.bank is not None))


def _device(primitive: Primitive) -> Device:
    """What a primitive does apart from bouncing a ball."""
    if primitive.launch is not None:
        return Device.PLUNGER
    if primitive.hold is not None:
        return Device.DRAIN if primitive.hold.is_drain else Device.HOLE
    if primitive.spin is not None:
        return Device.SPINNER
    if primitive.passage is not None:
        return Device.PASSAGE
    if primitive.bank is not None:
        return Device.DROP_TARGET
    if primitive.is_gate:
        return Device.GATE
    return Device.SENSOR if primitive.response == Response.PASS else Device.NONE


def _set_device_row(row: Any, primitive: Primitive) -> None:
    """Write how a device works."""
    if primitive.passage is not None:
        row["level_right"], row["level_left"] = primitive.passage
    if (spin := primitive.spin) is not None:
        row["damping"], row["drag"], row["blade"] = spin.damping, spin.drag, spin.height
    if (hold := primitive.hold) is not None:
        row["capture_speed"], row["hold_time"] = hold.capture_speed, hold.duration
        row["exit_x"], row["exit_z"] = hold.exit
        row["exit_vx"], row["exit_vz"] = hold.exit_velocity
        row["exit_spread"], row["exit_level"] = hold.spread, hold.exit_level
    if (launch := primitive.launch) is not None:
        row["capture_speed"] = ANY_SPEED
        row["launch_least"], row["launch_greatest"] = launch.least, launch.greatest
        row["charge_time"] = launch.charge
        row["launch_x"], row["launch_z"] = launch.direction
        # It sends off by itself, as a hole does, a ball that is due.
        least, greatest = launch.auto or (launch.greatest, launch.greatest)
        (row["exit_x"], row["exit_z"]), row["exit_level"] = primitive.points[0], min(primitive.levels)
        row["exit_vx"], row["exit_vz"] = least * launch.direction[0], least * launch.direction[1]
        row["exit_gain"] = greatest / least - 1.0


def _square(start: Point, end: Point) -> float:
    """The square of the distance between two points [u²]; 0 below 1e-162 u."""
    return (end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2


def _refuse_impossible(table: Table, expansion: Expansion) -> None:
    """Refuse what only a table made in Python can have: parts without an extent, and too many of a kind."""
    problems = []
    for number, primitive in expansion.rows:
        part = expansion.parts[number]
        if primitive.shape in ENDED and _square(*primitive.points) == 0.0:
            problems.append(Problem(part.path, "must have two different ends"))
        if primitive.shape == Shape.TRIANGLE and primitive.mover is None:
            a, b, c = primitive.points
            # A side of 1e-200 u has no length either: its square is 0.
            has_sides = all(_square(*pair) > 0.0 for pair in ((a, b), (b, c), (c, a)))
            if not has_sides or (b[1] - a[1]) * (c[0] - a[0]) == (b[0] - a[0]) * (c[1] - a[1]):
                problems.append(Problem(part.path, "must not be flat"))
    count = sum(1 for _, one in expansion.rows if one.mover is not None)
    switches = sum(1 for _, one in expansion.rows if one.bank is not None or one.is_gate)
    spinners = sum(1 for _, one in expansion.rows if one.spin is not None)
    for name, found, limit in (
        ("paddles", count, MAX_PADDLES),
        ("drop targets and held gates", switches, MAX_SWITCHES),
        ("banks of drop targets", len(_banks(expansion)), MAX_BANKS),
        ("spinners", spinners, MAX_SPINNERS),
        ("levels", len(expansion.gravity), MAX_LEVELS),
    ):
        if found > limit:
            problems.append(Problem("table", f"must have at most {limit} {name}, got {found}"))
    if problems:
        raise TableError(table.name, problems)


ENDED = (Shape.CAPSULE, Shape.LINE, Shape.ARC)


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
