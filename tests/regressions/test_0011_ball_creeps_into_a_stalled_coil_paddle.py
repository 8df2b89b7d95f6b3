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
