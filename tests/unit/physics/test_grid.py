"""A cell of the grid lists every part that a ball anywhere in it can touch within a travel of `skin`."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from boards import FIRST_SHAPE, full_table
from silverball.benchmarks.step_costs import crowded_table
from silverball.physics.audit import part_gap
from silverball.physics.broad_phase import cell_of
from silverball.table import generate_table
from silverball.world import WorldBatch

TABLES = {"full": full_table(), "random": generate_table(3), "crowded": crowded_table()}


@njit
def cell_at(board, x, z):  # what only kernels call is called by a kernel
    return cell_of(board, x, z)


@pytest.mark.parametrize("name", TABLES)
def test_a_cell_lists_all_that_can_be_reached_from_its_corners(name: str) -> None:
    boards = WorldBatch(TABLES[name], 1).boards
    board, grid = boards.board[0], boards.grid
    reach = board["ball_radius"] + board["skin"]
    side = 1.0 / board["grid_scale"]
    inside = 1e-9  # of the cell: what lies on a line belongs to either
    seen = 0
    for row in range(board["grid_rows"]):
        for column in range(board["grid_columns"]):
            for down in (inside, 1.0 - inside):
                for across in (inside, 1.0 - inside):
                    x = (row + down) * side - board["half_length"]
                    z = (column + across) * side - board["half_width"]
                    cell = cell_at(board, x, z)
                    assert cell == board["grid_first"] + row * board["grid_columns"] + column
                    listed = set(grid[grid[cell] : grid[cell + 1]].tolist())
                    assert sorted(listed) == grid[grid[cell] : grid[cell + 1]].tolist()
                    for number in range(FIRST_SHAPE, len(boards.collider)):
                        if part_gap(boards.collider[number], 0.0, x, z) < reach:
                            assert number in listed
                            seen += 1
    assert seen > 100


def test_a_place_beyond_the_board_belongs_to_the_nearest_cell() -> None:
    board = WorldBatch(full_table(), 1).boards.board[0]
    last = board["grid_first"] + board["grid_rows"] * board["grid_columns"] - 1
    assert cell_at(board, -1e6, -1e6) == board["grid_first"]
    assert cell_at(board, 1e6, 1e6) == last
    assert board["grid_first"] <= cell_at(board, np.nan, np.nan) <= last
