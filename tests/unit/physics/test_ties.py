"""The order of two contacts at the very same moment.

Exact mirror images about z = 0 meet at the same time to the bit, so that the order alone decides.
"""

from __future__ import annotations

import pytest

from boards import contacts, launched, moment, table_of
from silverball.table import Cylinder, Paddle, SlantWall

PAIR = (Cylinder(center=(0.0, -0.7), radius=0.5), Cylinder(center=(0.0, 0.7), radius=0.5))


@pytest.mark.parametrize("tick_rate", [10, 60, 1000])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("rub", [{}, {"friction": 0.2}, {"friction": 0.2, "rolling": True}], ids=str)
def test_of_two_balls_the_first_comes_first_on_either_side(tick_rate: int, side: float, rub) -> None:
    world = launched(
        table_of(**rub), (5.0, side, 0.0, side * 9.0), (5.0, -side, 0.0, -side * 9.0), tick_rate=tick_rate
    )
    met = contacts(world, 5 * tick_rate)
    first, second = next(met), next(met)
    assert moment(world, first) == moment(world, second)
    assert (first.ball, second.ball) == (1, 2)
    assert {first.part, second.part} == {"board.left", "board.right"}


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("kind", ["cylinders", "slant walls"])
def test_of_two_parts_the_one_that_stands_first_in_the_table_comes_first(swapped: bool, kind: str) -> None:
    """A ball falls into the middle between them."""
    parts = PAIR
    if kind == "slant walls":
        parts = tuple(SlantWall(start=(2.0, side * 2.0), end=(0.0, side * 0.3)) for side in (-1.0, 1.0))
    world = launched(table_of(*(parts[::-1] if swapped else parts)), (3.0, 0.0, 0.0, 0.0))
    first = next(contacts(world, 1000))
    assert first.part.endswith("[0]")
    assert (
        first.normal[2] * (-1.0 if swapped else 1.0) > 0.0
    )  # away from the part on the left, or on the right


def test_of_two_paddles_the_left_one_comes_first() -> None:
    paddles = tuple(
        Paddle(side=side, pivot=(0.0, z), rest_angle=-5.0) for side, z in (("right", 2.25), ("left", -2.25))
    )
    world = launched(table_of(*paddles), (3.0, 0.0, 0.0, 0.0))
    assert next(contacts(world, 1000)).part == "paddle.left"
