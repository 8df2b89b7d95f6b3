"""Balls roll and slip on every level as on the playfield.

The gravity of the whole table is g/sin(slope). What a level has of it along itself is its `gravity`, the rest
presses balls to it:  p = √((g/sin(slope))² − |gravity|²).
"""

from __future__ import annotations

import math

import pytest

from boards import edited, launched, place, speed_of, table_of
from silverball.physics.records import Motion
from silverball.table.kinds import Level
from silverball.world import World

GRAVITY, SLOPE, FRICTION = 6.0, 20.0, 0.2
WHOLE = GRAVITY / math.sin(math.radians(SLOPE))


def on_level(number: int, *balls: tuple[float, float, float, float], gravity=None) -> World:
    """A world with balls on a level, on a large board without anything else."""
    level = Level(number=1, gravity=gravity)
    table = table_of(
        level, length=50, width=50, gutter=-24, gravity=GRAVITY, slope=SLOPE, friction=FRICTION, rolling=True
    )
    world = launched(table, *balls)

    def change(record) -> None:
        record["ball"]["level"][: len(balls)] = number

    world.restore(edited(world, change))
    return world


def motion_of(world: World) -> Motion:
    return Motion(int(world.records[0]["ball"]["motion"][0]))


def test_a_level_without_gravity_of_its_own_is_the_playfield_bit_for_bit() -> None:
    balls = ((0.0, 0.0, 3.0, 2.0), (4.0, -1.0, 0.0, 0.0))
    below, above = on_level(0, *balls), on_level(1, *balls)
    for _ in range(60):
        for world in (below, above):
            world.step(ticks=7)
        assert [(b.position, b.velocity, b.spin) for b in above.balls] == [
            (b.position, b.velocity, b.spin) for b in below.balls
        ]
    assert motion_of(above) == Motion.ROLLING


@pytest.mark.parametrize("gravity", [(-3.0, 2.0), (4.0, 0.0), (0.0, 0.0)])
def test_a_ball_rolls_with_five_sevenths_of_the_gravity_of_its_level(gravity) -> None:
    world = on_level(1, (0.0, 0.0, 0.0, 0.0), gravity=gravity)
    world.step(ticks=240)
    assert motion_of(world) == Motion.ROLLING
    (ball,) = world.balls
    assert place(ball) == pytest.approx([5.0 / 14.0 * g for g in gravity], abs=1e-9)
    assert ball.spin[0] == pytest.approx(5.0 / 7.0 * gravity[1] / 0.25, abs=1e-9)


@pytest.mark.parametrize("down", [-9.0, -3.0, 0.0, 5.0])
def test_friction_on_a_level_is_that_of_what_presses_the_ball_to_it(down: float) -> None:
    grip = FRICTION * math.sqrt(WHOLE**2 - down**2)
    world = on_level(1, (0.0, 0.0, 8.0, 0.0), gravity=(down, 0.0))
    world.step(ticks=60)
    assert motion_of(world) == Motion.SLIPPING
    assert speed_of(world.balls[0]) == pytest.approx((8.0 + 0.25 * (down - grip), 0.0), abs=1e-9)
    assert world.balls[0].spin[2] == pytest.approx(-2.5 / 0.25 * grip * 0.25, abs=1e-9)


def test_on_a_level_with_more_gravity_than_the_table_has_balls_slide() -> None:
    world = on_level(1, (0.0, 0.0, 0.0, 0.0), gravity=(-1.1 * WHOLE, 0.0))
    world.step(ticks=60)
    assert motion_of(world) == Motion.SLIDING
    assert speed_of(world.balls[0])[0] == pytest.approx(-1.1 * WHOLE / 4.0, abs=1e-9)
    assert world.balls[0].spin == (0.0, 0.0, 0.0)
