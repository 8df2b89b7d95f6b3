"""A flight whose highest point just touches a border had gap and rate both 0, and 0/0 made a contact at once.

The Newton step that refines a time divides the gap by its rate. Balls that just touch in passing were
stopped dead in mid-air for the same reason.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.world import World

TOP = 10.0 - 0.1 - 0.25  # [u] where the top wall stops a ball's centre


@pytest.mark.parametrize("tenths", range(1, 180))
def test_a_ball_thrown_just_up_to_the_top_wall_meets_it_there_or_not_at_all(tenths: int) -> None:
    speed = tenths / 10
    world = World(table_of(), tick_rate=60)
    world.create_ball((TOP - speed * speed / 20, 0.0), (speed, 0.0))
    for _ in range(150):
        world.step()
        for event in world.events:
            if event.part == "board.top":
                assert event.position[0] == pytest.approx(TOP, abs=1e-9)


@pytest.mark.parametrize("way", [0.55, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("speed", [2.0, 5.0, 20.0])
def test_balls_that_pass_at_exactly_two_radii_are_no_jam(way: float, speed: float) -> None:
    world = World(table_of(), tick_rate=60)
    world.create_ball((2.0, 0.25), (0.0, 0.0))
    world.create_ball((2.0 + way, -0.25), (-speed, 0.0))
    world.step(ticks=30)
    assert world.jams == 0
