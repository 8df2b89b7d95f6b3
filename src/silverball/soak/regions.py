"""Where on a board can the centre of a ball be, and which of these places hang together? The audit's map.

The board is cut into square cells. A cell is *blocked* when no point of it is free for a ball's centre, told
from the distance of its middle; *clear* when all of it is further than a ball's radius from everything that
stands still; else *narrow*. Cells that are not blocked and touch, corners included, form a *ground*. Since no
free point lies in a blocked cell, a ball can never get from one ground to another: whoever does has escaped.
The paddles, which move, block nothing. Grounds that touch the gutter line are number 1, for they hang
together below it.

Like `audit.py`, on which it rests, it shares no code with the solver.
"""

from __future__ import annotations

from math import floor, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.audit import box, part_gap
from silverball.physics.kernel import kernel
from silverball.physics.records import Part, records

CELL = 0.4  # [ball radii] side of a cell: a wall is at least two radii thick to a centre
SLACK = 1e-6  # [u] for a ball that is deeper in something than it may be, and for rounding

OFF_BOARD = -1
BLOCKED = 0
MAIN_GROUND = 1  # the one with the gutter

SITE = np.dtype(
    [
        ("first", "i8"),  # this board's first cell among all marks
        ("rows", "i8"), ("columns", "i8"),  # along x and z
        ("low_x", "f8"), ("low_z", "f8"), ("high_x", "f8"), ("high_z", "f8"),  # where the board ends [u]
        ("cell", "f8"),  # side of a cell [u]
    ],
    align=True,
)  # fmt: skip


class Grounds(NamedTuple):
    """The maps of some boards.

    Attributes:
        site: SITE records, shape [board].
        mark: Of every cell of every board, shape [cell]: 0 if blocked, else twice the number of its
            ground, and 1 more if it is narrow.
    """

    site: NDArray[Any]
    mark: NDArray[np.int64]


def survey(boards: NDArray[Any], colliders: NDArray[Any]) -> Grounds:
    """The maps of boards, from their BOARD and COLLIDER records."""
    sites = records(len(boards), SITE)
    count = 0
    for site, board in zip(sites, boards, strict=True):
        cell = CELL * board["ball_radius"]
        site["first"], site["cell"] = count, cell
        site["low_x"], site["low_z"] = -board["half_length"], -board["half_width"]
        site["high_x"], site["high_z"] = board["half_length"], board["half_width"]
        site["rows"] = np.ceil(2.0 * board["half_length"] / cell) + 1
        site["columns"] = np.ceil(2.0 * board["half_width"] / cell) + 1
        count += int(site["rows"] * site["columns"])
    marks = np.zeros(count, np.int64)
    stack = np.zeros(max(int(site["rows"] * site["columns"]) for site in sites), np.int64)
    draw_maps(boards, colliders, sites, marks, stack)
    return Grounds(sites, marks)


@kernel
def draw_maps(boards: Any, colliders: Any, sites: Any, marks: Any, stack: Any) -> None:
    """Mark the cells of all boards; `stack` has room for the cells of the largest."""
    for index in range(len(sites)):
        mark_cells(boards[index], colliders, sites[index], marks)
        number_grounds(boards[index], sites[index], marks, stack)


@kernel
def mark_cells(board: Any, colliders: Any, site: Any, marks: Any) -> None:
    """Mark each cell 0 if blocked, −1 if narrow, −2 if clear; the ground is not known yet."""
    first, radius, half = board.collider_first, board.ball_radius, site.cell / sqrt(2.0) + SLACK
    left = colliders[first + Part.LEFT_WALL].z + radius
    right = colliders[first + Part.RIGHT_WALL].z - radius
    top = colliders[first + Part.TOP_WALL].x - radius
    for row in range(site.rows):
        x = site.low_x + (row + 0.5) * site.cell
        for column in range(site.columns):
            z = site.low_z + (column + 0.5) * site.cell
            gap = min(z - left, right - z, top - x)
            marks[site.first + row * site.columns + column] = 0 if gap < -half else -1 if gap <= half else -2
    for index in range(first + Part.FIRST_SHAPE, board.collider_end):
        c = colliders[index]
        low_x, high_x, low_z, high_z = box(c)
        wide = radius + half
        for row in range(
            cell_number(low_x - wide, site.low_x, site.cell, site.rows),
            cell_number(high_x + wide, site.low_x, site.cell, site.rows) + 1,
        ):
            x = site.low_x + (row + 0.5) * site.cell
            for column in range(
                cell_number(low_z - wide, site.low_z, site.cell, site.columns),
                cell_number(high_z + wide, site.low_z, site.cell, site.columns) + 1,
            ):
                z = site.low_z + (column + 0.5) * site.cell
                place = site.first + row * site.columns + column
                gap = part_gap(c, 0.0, x, z) - radius
                if gap < -half:
                    marks[place] = 0
                elif gap <= half and marks[place] == -2:
                    marks[place] = -1


@kernel
def cell_number(value: float, low: float, cell: float, count: int) -> int:
    """The row or column of a coordinate, the first or last one if it lies beyond."""
    return int(min(max(floor((value - low) / cell), 0.0), count - 1.0))


@kernel
def number_grounds(board: Any, site: Any, marks: Any, stack: Any) -> None:
    """Give each cell that is not blocked the number of its ground; cells at the gutter line have number 1."""
    gutter_row = cell_number(board.gutter, site.low_x, site.cell, site.rows)
    for column in range(site.columns):
        spread(site, marks, stack, gutter_row * site.columns + column, MAIN_GROUND)
    ground = MAIN_GROUND
    for place in range(site.rows * site.columns):
        if marks[site.first + place] < 0:
            ground += 1
            spread(site, marks, stack, place, ground)


@kernel
def spread(site: Any, marks: Any, stack: Any, start: int, ground: int) -> None:
    """Number all cells that hang together with a cell, if it has no number yet and is not blocked."""
    if marks[site.first + start] >= 0:
        return
    marks[site.first + start] += 2 * ground + 2  # −1 becomes the odd number, −2 the even one
    stack[0], count = start, 1
    while count > 0:
        count -= 1
        row, column = stack[count] // site.columns, stack[count] % site.columns
        for near_row in range(max(row - 1, 0), min(row + 2, site.rows)):
            for near_column in range(max(column - 1, 0), min(column + 2, site.columns)):
                place = near_row * site.columns + near_column
                if marks[site.first + place] < 0:
                    marks[site.first + place] += 2 * ground + 2
                    stack[count] = place
                    count += 1


@kernel
def mark_at(site: Any, marks: Any, x: float, z: float) -> int:
    """The mark of the cell of (x, z), or OFF_BOARD; a number that is none is off the board too."""
    if not (site.low_x <= x <= site.high_x and site.low_z <= z <= site.high_z):
        return OFF_BOARD
    row, column = int((x - site.low_x) / site.cell), int((z - site.low_z) / site.cell)
    return marks[site.first + row * site.columns + column]


@kernel
def ground_of(mark: int) -> int:
    """The number of the ground of a cell with this mark; BLOCKED, OFF_BOARD: there is none."""
    return mark if mark <= BLOCKED else mark // 2


@kernel
def is_narrow(mark: int) -> bool:
    """Whether a ball in a cell with this mark may touch something that stands still."""
    return mark <= BLOCKED or mark % 2 == 1
