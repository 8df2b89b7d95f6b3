"""A ball between a border and a paddle on a coil, whose button is held: in each tick the paddle crept on.

It starts from rest in every tick, turns by some 1e-10 rad until the jam is noticed, and kept that.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.physics.audit import deepest
from silverball.physics.tolerances import MAX_DEPTH
from silverball.table import Paddle
from silverball.world import World

PADDLE = Paddle(
    side="right", pivot=(0.0, 4.31), length=1.6, shape="capsule", base_radius=0.1, tip_radius=0.1,
    rest_angle=60.0, up_angle=110.0, stroke=0.15, profile="coil",
)  # fmt: skip


@pytest.mark.parametrize("tick_rate", [60, 240])
def test_a_jammed_ball_is_not_pressed_deeper_while_the_button_is_held(tick_rate: int) -> None:
    world = World(table_of(PADDLE, speed_cap=50.0), tick_rate=tick_rate)
    world.create_ball((1.0, 4.6), (0.0, 0.0))
    depths = []
    for _ in range(200):
        world.step(left=True, right=True)
        assert world.fault is None
        depths.append(deepest(*world.records))
    assert world.jams > 0  # else nothing was tried
    assert max(depths) < 0.1 * MAX_DEPTH
