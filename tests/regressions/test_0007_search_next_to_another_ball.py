"""A search while two balls are near each other ended one ulp later than in earlier versions, so that one of
some thousand replays of a second diverged."""

from __future__ import annotations

from silverball.table import generate_table
from silverball.world import World

HELD = ("R", "LR", "LR", "LR", "", "R", "R", "R", "LR", "L")  # buttons, for a tenth of a second each
EXPECTED = ("-0x1.864bea8881bf9p+1", "-0x1.2626cef52e4ccp+0", "0x1.8f2dfefb508dfp+4", "0x1.a69ed59c00223p+0")


def test_two_balls_next_to_a_turning_paddle_have_the_bits_of_earlier_versions() -> None:
    world = World(generate_table(8), seed=3656, tick_rate=60)
    world.create_ball()
    world.create_ball()
    for buttons in HELD:
        world.step("L" in buttons, "R" in buttons, ticks=6)
    ball = world.balls[0]
    x, z = ball.position[0], ball.position[-1]
    vx, vz = ball.velocity[0], ball.velocity[-1]
    assert tuple(float(value).hex() for value in (x, z, vx, vz)) == EXPECTED
