"""The bounds on where a paddle can be, which the step trusts, hold at every angle of its stroke."""

from __future__ import annotations

import math

import pytest

from boards import table_of
from silverball.table import Paddle
from silverball.world import WorldBatch

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
    board = WorldBatch(table).boards.board[0]
    radius = table.board.ball_radius
    middle, reach = (board[f"{side}_x"], board[f"{side}_z"]), board[f"{side}_reach"]
    for share in range(101):
        angle = paddle.rest_angle + (paddle.up_angle - paddle.rest_angle) * share / 100
        for corner in paddle.corners(angle):
            assert corner[0] + radius <= board["paddle_top"]
            assert math.dist(corner, middle) + radius <= reach
    assert reach - radius < 1.5 * (paddle.length + paddle.base)  # a bound, but not any bound


def test_a_paddle_that_is_not_there_is_out_of_reach() -> None:
    board = WorldBatch(table_of()).boards.board[0]
    assert board["paddle_top"] < -1e6
    assert min(abs(board["left_x"]), abs(board["right_x"])) > 1e6
