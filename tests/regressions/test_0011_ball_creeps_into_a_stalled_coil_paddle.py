"""A ball between a border and a stalled paddle on a coil sank by 3e-12 u in each of 1000 ticks a second.

The paddle went back to where it was before the tick, but the ball did not.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.physics.audit import deepest
from silverball.physics.tolerances import MAX_DEPTH
from silverball.table import Paddle
from silverball.world import World

PADDLE = Paddle(
    side="right", pivot=(-3.338, -2.7544), length=1.6737, base=0.529, rest_angle=-24.7, up_angle=8.3,
    stroke=0.154, return_stroke=0.1286, profile="coil", mass=20.0,
)  # fmt: skip
TABLE = table_of(
    PADDLE,
    gravity=15.0,
    friction=0.2,
    rolling=True,
    ball_restitution=0.95,
    wall_restitution=0.438,
    gutter=-9.0,
)


@pytest.mark.parametrize("tick_rate", [60, 240, 1000])
@pytest.mark.parametrize("x", [-3.58, -3.46, -3.34, -2.96])
def test_a_ball_that_is_pressed_to_a_border_for_long_does_not_sink_into_the_paddle(x, tick_rate: int) -> None:
    world = World(TABLE, tick_rate=tick_rate)
    world.create_ball((x, -4.645), (0.0, 0.0))
    depths = []
    for _ in range(3 * tick_rate):
        world.step(right=True)
        assert world.fault is None
        depths.append(deepest(*world.records))
    assert world.jams > 20  # else nothing was tried
    assert max(depths) < 0.1 * MAX_DEPTH


AT_ITS_STOP = Paddle(
    side="right", pivot=(-2.1559519555055906, -3.2306022731146116), length=1.07844863101728, shape="capsule",
    base_radius=0.16777909825831147, tip_radius=0.1164632559074792, rest_angle=-1.1456758260307254,
    up_angle=51.66231238896795, stroke=0.15951422511326624, return_stroke=0.13743071390351924,
    profile="coil", mass=20.0, restitution=0.0, restitution_falloff=0.02,
)  # fmt: skip


@pytest.mark.parametrize("tick_rate", [60, 240, 1000])
def test_nor_where_the_paddle_is_at_its_stop_and_cannot_turn_back(tick_rate: int) -> None:
    table = table_of(AT_ITS_STOP, friction=0.2, wall_restitution=0.2681601755880002, speed_cap=25.0)
    world = World(table, tick_rate=tick_rate)
    world.create_ball((0.0, -4.6), (0.0, 0.0))
    ball = world.records[0]["ball"]
    ball["x"][0], ball["z"][0] = -2.0437167217758816, -4.65  # 1e-10 u deep between the border and the paddle
    depths = []
    for _ in range(3 * tick_rate):
        world.step(right=True)
        assert world.fault is None
        depths.append(deepest(*world.records))
    assert world.jams > 20
    assert max(depths) < 0.2 * MAX_DEPTH
