"""Region labelling: the places on a board that the centre of a ball can reach from one another.

The board is cut into square cells. A cell is *blocked* when no point of it is free for a ball's centre, by
the distance of its middle; *clear* when all of it is further than a ball's radius from every stationary
part; otherwise *narrow*. Cells that are not blocked and touch, corners included, form a *region*
(connected-component labelling with 8 neighbours). No free point lies in a blocked cell, so a ball can never
get from one region to another: a ball that does has escaped. Paddles move and block nothing, nor do parts
that may be away, one-way parts and sensors. Every level has cells of its own. Regions that touch the gutter
line are all number 1, because they are connected below it.

Like `audit.py`, which it uses, this module shares no code with the solver.
"""

from __future__ import annotations

from math import floor, sqrt
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.audit import box, part_gap
from silverball.physics.kernel import kernel
from silverball.physics.records import BoardRecord, Colliders, Part, Response, records

CELL = 0.4  # [ball radii] side of a cell: a wall is at least two radii thick to a centre
SLACK = 1e-6  # [u] for a ball that is deeper in something than it may be, and for rounding

OFF_BOARD = -1
BLOCKED = 0
MAIN_REGION = 1  # the one with the gutter

# Labels of cells before their region is known; the others are `BLOCKED` or those of `label_of`.
NARROW, CLEAR = -1, -2

GRID_HEADER = np.dtype(
    [
        ("first", "i8"),  # this board's first cell among the labels of all boards
        ("rows", "i8"), ("columns", "i8"), ("levels", "i8"),  # along x and z, and of how many levels
        ("low_x", "f8"), ("low_z", "f8"), ("high_x", "f8"), ("high_z", "f8"),  # where the board ends [u]
        ("cell", "f8"),  # side of a cell [u]
        ("crossings", "i8"),  # rows that are crossed: sensors and one-way parts
    ],
    align=True,
)  # fmt: skip
GridHeaderRecord: TypeAlias = Any  # a GRID_HEADER record


class RegionMap(NamedTuple):
    """The labelled cells of some boards.

    Attributes:
        headers: GRID_HEADER records [board].
        labels: Of every cell of every board [cell]: 0 if blocked, else twice the number of its region, plus 1
            if it is narrow.
    """

    headers: NDArray[Any]
    labels: NDArray[np.int64]


def region_map(boards: NDArray[Any], colliders: NDArray[Any]) -> RegionMap:
    """The regions of boards, from their BOARD and COLLIDER records."""
    headers = records(len(boards), GRID_HEADER)
    count = 0
    for header, board in zip(headers, boards, strict=True):
        cell = CELL * board["ball_radius"]
        header["first"], header["cell"] = count, cell
        header["low_x"], header["low_z"] = -board["half_length"], -board["half_width"]
        header["high_x"], header["high_z"] = board["half_length"], board["half_width"]
        header["rows"] = np.ceil(2.0 * board["half_length"] / cell) + 1
        header["columns"] = np.ceil(2.0 * board["half_width"] / cell) + 1
        rows = colliders[board["collider_first"] : board["collider_end"]]
        header["crossings"] = ((rows["response"] != Response.BOUNCE) | (rows["one_way"] != 0)).sum()
        header["levels"] = level_count(rows)
        count += int(header["rows"] * header["columns"] * header["levels"])
    labels = np.zeros(count, np.int64)
    stack = np.zeros(max(int(header["rows"] * header["columns"]) for header in headers), np.int64)
    label_boards(boards, colliders, headers, labels, stack)
    return RegionMap(headers, labels)


def level_count(colliders: NDArray[Any]) -> int:
    """Count the levels from 0 to the highest one of a board with these COLLIDER records."""
    masks = colliders["levels"][Part.FIRST_PADDLE :].tolist()  # the borders are on all levels
    return max(1, int(colliders["exit_level"].max()) + 1, *(mask.bit_length() for mask in masks))


@kernel
def label_boards(boards: Any, colliders: Colliders, headers: Any, labels: Any, stack: Any) -> None:
    """Label the cells of all boards; `stack` is scratch for the cells of the largest one."""
    for index in range(len(headers)):
        header = headers[index]
        cells = header.rows * header.columns
        for level in range(header.levels):
            of_level = labels[header.first + level * cells : header.first + (level + 1) * cells]
            classify_cells(boards[index], colliders, header, of_level, level)
            label_regions(boards[index], header, of_level, stack)


@kernel
def classify_cells(
    board: BoardRecord, colliders: Colliders, header: GridHeaderRecord, labels: Any, level: int
) -> None:
    """Label each cell of a level BLOCKED, NARROW or CLEAR."""
    first, radius, half = board.collider_first, board.ball_radius, header.cell / sqrt(2.0) + SLACK
    left = colliders[first + Part.LEFT_WALL].z + radius
    right = colliders[first + Part.RIGHT_WALL].z - radius
    top = colliders[first + Part.TOP_WALL].x - radius
    for row in range(header.rows):
        x = header.low_x + (row + 0.5) * header.cell
        for column in range(header.columns):
            z = header.low_z + (column + 0.5) * header.cell
            gap = min(z - left, right - z, top - x)
            label = BLOCKED if gap < -half else NARROW if gap <= half else CLEAR
            labels[row * header.columns + column] = label
    for index in range(first + board.shape_first, board.collider_end):
        c = colliders[index]
        if c.levels >> level & 1 == 0 or c.response != Response.BOUNCE or c.one_way != 0:
            continue
        low_x, high_x, low_z, high_z = box(c)
        wide = radius + half
        for row in range(
            cell_number(low_x - wide, header.low_x, header.cell, header.rows),
            cell_number(high_x + wide, header.low_x, header.cell, header.rows) + 1,
        ):
            x = header.low_x + (row + 0.5) * header.cell
            for column in range(
                cell_number(low_z - wide, header.low_z, header.cell, header.columns),
                cell_number(high_z + wide, header.low_z, header.cell, header.columns) + 1,
            ):
                z = header.low_z + (column + 0.5) * header.cell
                cell = row * header.columns + column
                gap = part_gap(c, 0.0, x, z) - radius
                if gap < -half and c.switch == 0:
                    labels[cell] = BLOCKED
                elif gap <= half and labels[cell] == CLEAR:
                    labels[cell] = NARROW


@kernel
def cell_number(value: float, low: float, cell: float, count: int) -> int:
    """The row or column of a coordinate, clamped to the first and last one."""
    return int(min(max(floor((value - low) / cell), 0.0), count - 1.0))


@kernel
def label_regions(board: BoardRecord, header: GridHeaderRecord, labels: Any, stack: Any) -> None:
    """Label each cell that is not blocked with its region; the cells at the gutter line are in region 1."""
    gutter_row = cell_number(board.gutter, header.low_x, header.cell, header.rows)
    for column in range(header.columns):
        flood_fill(header, labels, stack, gutter_row * header.columns + column, MAIN_REGION)
    region = MAIN_REGION
    for cell in range(header.rows * header.columns):
        if labels[cell] < 0:
            region += 1
            flood_fill(header, labels, stack, cell, region)


@kernel
def flood_fill(header: GridHeaderRecord, labels: Any, stack: Any, start: int, region: int) -> None:
    """Label all cells connected to `start` with a region, unless it is blocked or labelled already."""
    if labels[start] >= 0:
        return
    labels[start] = label_of(region, labels[start])
    stack[0], count = start, 1
    while count > 0:
        count -= 1
        row, column = stack[count] // header.columns, stack[count] % header.columns
        for near_row in range(max(row - 1, 0), min(row + 2, header.rows)):
            for near_column in range(max(column - 1, 0), min(column + 2, header.columns)):
                cell = near_row * header.columns + near_column
                if labels[cell] < 0:
                    labels[cell] = label_of(region, labels[cell])
                    stack[count] = cell
                    count += 1


@kernel
def label_of(region: int, kind: int) -> int:
    """The label of a NARROW or CLEAR cell of a region."""
    return 2 * region + 1 if kind == NARROW else 2 * region


@kernel
def label_at(header: GridHeaderRecord, labels: Any, level: int, x: float, z: float) -> int:
    """The label of the cell at (x, z) on a level, or OFF_BOARD, as where a coordinate is not a number."""
    if not 0 <= level < header.levels:
        return OFF_BOARD
    if not (header.low_x <= x <= header.high_x and header.low_z <= z <= header.high_z):
        return OFF_BOARD
    row, column = int((x - header.low_x) / header.cell), int((z - header.low_z) / header.cell)
    return labels[header.first + (level * header.rows + row) * header.columns + column]


@kernel
def region_of(label: int) -> int:
    """The number of the region of a cell with this label; BLOCKED and OFF_BOARD are returned as they are."""
    return label if label <= BLOCKED else label // 2


@kernel
def is_narrow(label: int) -> bool:
    """Whether a ball in a cell with this label may touch a stationary part."""
    return label <= BLOCKED or label % 2 == 1
