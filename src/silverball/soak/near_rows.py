"""Which rows of a board a ball at some place can touch, so that hundreds of rows are checked as fast as ten.

The board is cut into squares. A square lists the stationary rows whose bounding box is within a ball's radius
of it; the other rows cannot be touched from it. Rows that are crossed, sensors and one-way parts, are listed
once for the whole board. Like `audit.py`, which it uses, this module shares no code with the solver.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.audit import box, is_met, is_outside_box, part_gap
from silverball.physics.kernel import kernel
from silverball.physics.records import BoardRecord, Colliders, Response, records
from silverball.soak.regions import SLACK, cell_number

SIDE = 1.0  # [u] of a square: a judgement call

NEAR_HEADER = np.dtype(
    [
        ("first", "i8"),  # this board's first square among those of all boards
        ("along_x", "i8"), ("along_z", "i8"),  # the number of squares
        ("low_x", "f8"), ("low_z", "f8"),  # where they begin [u]
        ("crossed_first", "i8"), ("crossed_end", "i8"),  # the list of the rows that are crossed
    ],
    align=True,
)  # fmt: skip
NearHeaderRecord: TypeAlias = Any  # a NEAR_HEADER record


class NearRows(NamedTuple):
    """The lists of some boards.

    Attributes:
        headers: NEAR_HEADER records [board].
        starts: Where the list of each square of each board starts; one more at the end [square + 1].
        rows: All lists: positions among the COLLIDER records of all boards.
    """

    headers: Any
    starts: NDArray[np.int64]
    rows: NDArray[np.int64]


class NearBoard(NamedTuple):
    """The lists of one board: its NEAR_HEADER record, `starts` and `rows` of all boards."""

    header: NearHeaderRecord
    starts: Any
    rows: Any


def near_rows(boards: NDArray[Any], colliders: NDArray[Any]) -> NearRows:
    """Make the lists of boards, from their BOARD and COLLIDER records."""
    headers = records(len(boards), NEAR_HEADER)
    lists: list[list[int]] = []
    crossed: list[int] = []
    for header, board in zip(headers, boards, strict=True):
        header["first"] = len(lists)
        header["low_x"], header["low_z"] = -board["half_length"], -board["half_width"]
        header["along_x"] = int(np.ceil(2.0 * board["half_length"] / SIDE))
        header["along_z"] = int(np.ceil(2.0 * board["half_width"] / SIDE))
        lists += _lists_of(header, board, colliders)
        shapes = range(board["collider_first"] + board["shape_first"], board["collider_end"])
        of_board = [row for row in shapes if _is_crossed(colliders[row])]
        header["crossed_first"], header["crossed_end"] = len(crossed), len(crossed) + len(of_board)
        crossed += of_board
    lengths = [0, *map(len, lists)]
    starts = np.cumsum(lengths, dtype=np.int64)
    for name in ("crossed_first", "crossed_end"):
        headers[name] += starts[-1]
    return NearRows(headers, starts, np.array([*(row for one in lists for row in one), *crossed], np.int64))


def _lists_of(header: Any, board: Any, colliders: NDArray[Any]) -> list[list[int]]:
    """The rows of each square of a board."""
    along_x, along_z = int(header["along_x"]), int(header["along_z"])
    lists: list[list[int]] = [[] for _ in range(along_x * along_z)]
    margin = board["ball_radius"] + SLACK
    for row in range(board["collider_first"] + board["shape_first"], board["collider_end"]):
        low_x, high_x, low_z, high_z = box(colliders[row])
        if low_x > high_x:  # a line or a disc, which nothing touches
            continue
        first_x, last_x = (
            cell_number(x, header["low_x"], SIDE, along_x) for x in (low_x - margin, high_x + margin)
        )
        first_z, last_z = (
            cell_number(z, header["low_z"], SIDE, along_z) for z in (low_z - margin, high_z + margin)
        )
        for x in range(first_x, last_x + 1):
            for z in range(first_z, last_z + 1):
                lists[x * along_z + z].append(row)
    return lists


def _is_crossed(c: Any) -> bool:
    return bool(c["response"] != Response.BOUNCE or c["one_way"] != 0)


@kernel
def depth_near(
    near: NearBoard, board: BoardRecord, colliders: Colliders, x: float, z: float, level: int, off: int
) -> float:
    """Compute what `audit.depth_in_stationary` does, from the rows near (x, z) alone."""
    header, depth, radius = near.header, 0.0, board.ball_radius
    row = cell_number(x, header.low_x, SIDE, header.along_x)
    square = header.first + row * header.along_z + cell_number(z, header.low_z, SIDE, header.along_z)
    for entry in range(near.starts[square], near.starts[square + 1]):
        c = colliders[near.rows[entry]]
        if is_met(c, level, off) and not is_outside_box(c, x, z, radius):
            depth = max(depth, radius - part_gap(c, 0.0, x, z))
    return depth
