"""Balls that roll along the rail of a ramp cross the passage in it, whose line ends where their centres are.

Some lines end exactly there, others a little before; a ball hops, and a contact is rounded.
"""

from __future__ import annotations

import math

import pytest

from boards import place, table_of
from silverball.table import Table
from silverball.table.kinds import Level, Passage, Wall
from silverball.world import World

RADIUS = 0.25
RATES = (60, 240, 1000)
SHORT = (0.0, 0.02)
"""[u] by which a line ends before the centre of a ball that touches the rail."""


def ramp(*rails: Wall, ends: tuple, towards: tuple[float, float], gravity: float) -> Table:
    """A ramp with a passage that leads from level 0 to level 1 in a direction."""
    line = Passage(start=ends[0], end=ends[1], from_level=0, to_level=1)
    if line.left_normal[0] * towards[0] + line.left_normal[1] * towards[1] < 0.0:
        line = Passage(start=ends[1], end=ends[0], from_level=0, to_level=1)
    return table_of(line, Level(number=1), *rails, gravity=gravity)


def rail(*points: tuple[float, ...]) -> Wall:
    return Wall(points=points, thickness=0.0, restitution=0.0, levels=(0, 1))


def crosses_once(table: Table, ball: tuple[float, float, float, float], rate: int) -> tuple[float, float]:
    """Play until the ball is on level 1; where it crossed."""
    world = World(table, tick_rate=rate)
    world.create_ball(ball[:2], ball[2:])
    for _ in range(4 * rate):
        world.step()
        for event in world.events:
            if event.kind == "pass":
                assert world.records[0]["ball"]["level"][0] == 1
                return place(event)
    raise AssertionError(f"{ball} has missed the passage")


@pytest.mark.parametrize("short", SHORT)
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0])
def test_no_ball_along_a_straight_rail_misses_the_passage(
    turn: float, side: int, rate: int, short: float
) -> None:
    """The ramp is turned out of the direction up the table."""
    cosine, sine = math.cos(turn), math.sin(turn)

    def at(along: float, across: float) -> tuple[float, float]:
        return along * cosine - across * sine, along * sine + across * cosine

    reach = 1.0 - RADIUS - short
    rails = [rail(at(-3.0, across), at(4.0, across)) for across in (-1.0, 1.0)]
    table = ramp(*rails, ends=(at(2.0, -reach), at(2.0, reach)), towards=at(1.0, 0.0), gravity=0.0)
    for number in range(12):
        speed = 2.0 + 0.37 * number
        ball = (*at(-1.0, 0.5 * side), *at(speed, side * (0.6 + 0.01 * number) * speed))
        x, z = crosses_once(table, ball, rate)
        assert side * (z * cosine - x * sine) == pytest.approx(1.0 - RADIUS, abs=1e-3)


@pytest.mark.parametrize("short", SHORT)
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("is_outer", [False, True])
def test_no_ball_along_the_rails_of_a_bend_misses_the_passage(
    is_outer: bool, rate: int, short: float
) -> None:
    """A fast ball keeps to the outer rail, a slow one lies on the inner one."""
    rails = (rail((2.0, -2.0, 1.0), (2.0, 2.0)), rail((2.0, -3.0, 1.0), (2.0, 3.0)))
    if rails[0].primitives(table_of().board)[0].arc.middle[0] < 0.0:
        rails = (rail((2.0, -2.0, -1.0), (2.0, 2.0)), rail((2.0, -3.0, -1.0), (2.0, 3.0)))
    ends = ((4.0 + RADIUS + short, 0.0), (5.0 - RADIUS - short, 0.0))
    table = ramp(*rails, ends=ends, towards=(0.0, 1.0), gravity=10.0)
    for number in range(12):
        ball = (4.27, -0.3, 0.0, 0.9 + 0.05 * number)
        if is_outer:
            ball = (2.0, -2.6, 11.0 + 0.3 * number, 0.0)
        x, _ = crosses_once(table, ball, rate)
        assert x == pytest.approx(5.0 - RADIUS if is_outer else 4.0 + RADIUS, abs=0.019)
