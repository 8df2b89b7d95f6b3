"""A hit of every kind of part scores the points in the table."""

from __future__ import annotations

import pytest

import silverball as sb
from silverball.table import Board, Cylinder, Paddle, SlantWall, Table, TriangularPrism

PARTS = {
    "slant_wall[0]": Table(slant_wall=(SlantWall(start=(-5, -2), end=(-5.5, 2), points=7),)),
    "paddle.left": Table(paddle=(Paddle(side="left", pivot=(-5, -1), points=7),)),
    "triangular_prism[0]": Table(
        triangular_prism=(TriangularPrism(center=(-5, 0), size=1, rotation=15, points=7),)
    ),
    "cylinder[0]": Table(cylinder=(Cylinder(center=(-5, 0.1), radius=1, points=7),)),
}


def first_contact(world):
    met = []
    while not met and world.time < 5:
        world.step()
        met = [event for event in world.events if event.kind != "created"]
    (event,) = met
    return event


@pytest.mark.parametrize("part", PARTS)
def test_a_hit_scores_the_points_of_the_part(part):
    world = sb.World(PARTS[part])
    world.create_ball(position=(0.0, 0.0))
    event = first_contact(world)
    assert (event.kind, event.part) == ("hit", part)
    assert (world.score, world.hits[part]) == (7, 1)


def test_a_touch_scores_nothing():
    table = PARTS["cylinder[0]"].model_copy(update={"board": Board(hit_speed=10.0)})
    world = sb.World(table)
    world.create_ball(position=(-3.0, 0.1))
    assert (first_contact(world).kind, world.score) == ("touch", 0)
