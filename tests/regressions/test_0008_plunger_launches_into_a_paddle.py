"""A paddle that rests over a plunger: the ball was launched inside the paddle, and the world stopped."""

from __future__ import annotations

from boards import table_of
from silverball.physics.audit import deepest
from silverball.table import Paddle
from silverball.table.kinds import Plunger
from silverball.world import World

PADDLE = Paddle(side="left", pivot=(1.0, -1.0), length=1.5, rest_angle=-60.0, up_angle=10.0, stroke=0.2)
PLUNGER = Plunger(position=(1.0, 0.2))


def test_a_ball_stays_on_its_plunger_while_a_paddle_is_over_it() -> None:
    world = World(table_of(PADDLE, PLUNGER), tick_rate=240)
    world.create_ball()
    for launch in (True, False):  # the paddle is up, over the ball
        world.step(left=True, ticks=120, launch=launch)
    assert deepest(*world.records) == 0.0
    assert world.balls[0].position == (1.0, 1.0, 0.2)
    world.step(ticks=120)
    world.step(ticks=10, launch=True)
    world.step()
    assert world.fault is None
    assert world.balls[0].velocity[0] > 1.0
