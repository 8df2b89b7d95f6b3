"""A ball lay between a post and a paddle on a coil that had come down on it; the button did not free it.

In each tick the paddle starts from rest. Without a gap between them, the ball met it and the post again and
again at the first instant, and the jam stopped the paddle. A paddle that leaves a jammed ball now goes on.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.table import Paddle
from silverball.table.kinds import Post, Wall
from silverball.world import World

PADDLE = Paddle(
    side="left", pivot=(1.4951, -3.2366), length=1.15, shape="capsule", base_radius=0.202, tip_radius=0.12,
    rest_angle=-73.0, up_angle=-21.0, stroke=0.05, return_stroke=0.088, profile="coil", restitution=0.86,
)  # fmt: skip
TABLE = table_of(
    PADDLE,
    Post(center=(-0.1585, -2.7553), radius=0.0969, restitution=0.765),
    Wall(points=((-0.02899, -2.8488), (0.27506, -2.98602)), thickness=0.0, restitution=0.5),
    gravity=19.193, slope=6.25, friction=0.2, rolling=True, speed_cap=60.0,
)  # fmt: skip


@pytest.mark.parametrize("tick_rate", [60, 240, 1000])
def test_a_button_frees_a_ball_that_its_paddle_has_pinched(tick_rate: int) -> None:
    world = World(TABLE, tick_rate=tick_rate)
    world.step(left=True, ticks=tick_rate)
    world.create_ball((0.178, -2.66))
    world.step(ticks=tick_rate // 2)
    before, jams, angle = world.balls[0].position, world.jams, world.paddles[-1].angle
    assert jams > 10  # the paddle has come down on it
    world.step(left=True)
    assert world.paddles[-1].angle > angle
    world.step(left=True, ticks=tick_rate)
    assert world.jams <= jams + 3
    assert world.balls[0].position[0] < before[0] - 1.0
