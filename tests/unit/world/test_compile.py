"""Compiled tables: part numbers, blank worlds, and bounds on a paddle that hold at every angle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import full_table, table_of
from silverball.physics.records import Part
from silverball.table import Paddle, load_table
from silverball.world import World, WorldBatch
from silverball.world.compile import blank_worlds, compile_parts, compile_tables, part_names, part_numbers

SHAPES = [
    {},
    {"length": 1.0, "base": 2.0},
    {"rest_angle": -80.0, "up_angle": 80.0},
    {"rest_angle": -60.0, "up_angle": -20.0, "base": 0.05},
    {"rest_angle": 30.0, "up_angle": 84.0, "length": 4.0},
]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("side", ["left", "right"])
def test_top_and_circle_hold_every_corner_at_every_angle(side: str, shape: dict) -> None:
    z = -2.5 if side == "left" else 2.5
    paddle = Paddle(side=side, pivot=(-7.2, z), **shape)
    table = table_of(paddle)
    boards = WorldBatch(table).boards
    board, row = boards.board[0], boards.collider[Part.FIRST_PADDLE]
    radius = table.board.ball_radius
    middle, reach = (row["sweep_x"], row["sweep_z"]), row["sweep_reach"]
    for share in range(101):
        angle = paddle.rest_angle + (paddle.up_angle - paddle.rest_angle) * share / 100
        for corner in paddle.corners(angle):
            assert corner[0] + radius <= board["paddle_top"]
            assert math.dist(corner, middle) + radius <= reach
    assert reach - radius < 1.5 * (paddle.length + paddle.base)  # a bound, but not any bound


def test_a_board_without_paddles_has_no_rows_for_them_and_none_is_in_reach() -> None:
    boards = WorldBatch(table_of()).boards
    board = boards.board[0]
    assert (board["paddles"], board["shape_first"], len(boards.collider)) == (0, 3, 3)
    assert board["paddle_top"] < -1e6


def test_the_number_of_a_part_is_its_row_and_its_column_of_tallies() -> None:
    table = full_table()
    boards, numbers = compile_tables([table]), part_numbers(table)
    assert tuple(numbers) == boards.names[0] == part_names(table)
    assert list(numbers.values()) == list(range(len(boards.collider)))
    for kind in ("slant_wall", "triangular_prism", "cylinder"):
        for index, part in enumerate(getattr(table, kind)):
            row = boards.collider[numbers[f"{kind}[{index}]"]]
            assert (row["points"], row["restitution"]) == (part.points, part.restitution)
    world = World(table, seed=2)
    for _ in range(40):
        if not world.balls:
            world.create_ball()
        world.step(ticks=240)
    assert sum(world.hits.values()) > 20
    assert list(world.hits) == list(numbers)


def test_the_rows_of_one_table_are_those_of_the_compiled_tables() -> None:
    tables = [load_table("classic"), full_table()]
    boards = compile_tables(tables)
    for board, table in zip(boards.board, tables, strict=True):
        rows = boards.collider[board["collider_first"] : board["collider_end"]]
        assert rows.tobytes() == compile_parts(table).tobytes()


def test_blank_worlds_are_the_worlds_of_a_new_batch() -> None:
    tables = [load_table("classic"), full_table(), table_of(), full_table()]
    batch = WorldBatch(tables, 4, seed=[0] * 4)
    blank = blank_worlds(batch.boards, batch.board_of)
    assert blank.tobytes() == batch.state.tobytes()
    assert np.array_equal(blank["paddle"]["angle"], blank["paddle"]["angle_commanded"])
    assert blank["paddle"]["angle"][0, :2].tolist() == [math.radians(p.rest_angle) for p in tables[0].paddle]
