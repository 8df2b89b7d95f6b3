"""The audit measures depths correctly, and can fail."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import FIRST_SHAPE, LEFT, RIGHT, launched, table_of
from silverball.physics.audit import deepest, part_gap
from silverball.physics.records import Part
from silverball.table import Cylinder, SlantWall, TriangularPrism
from silverball.world import World

POINTS = 4001


def nearest_of_many(x: float, z: float, p: tuple[float, float], q: tuple[float, float]) -> float:
    """Distance from a segment by looking at very many of its points: no formula to get wrong."""
    share = np.linspace(0, 1, POINTS)
    return float(np.hypot(x - p[0] - share * (q[0] - p[0]), z - p[1] - share * (q[1] - p[1])).min())


def is_around(x: float, z: float, corners) -> bool:
    """Whether the corners go once round the point: the angles between them add up to a full turn."""
    turn = 0.0
    for (ax, az), (bx, bz) in zip(corners, (*corners[1:], corners[0]), strict=True):
        a, b = math.atan2(ax - x, az - z), math.atan2(bx - x, bz - z)
        turn += (b - a + math.pi) % (2 * math.pi) - math.pi
    return abs(turn) > math.pi


def brute_gap(x: float, z: float, corners) -> float:
    sides = zip(corners, (*corners[1:], corners[0]), strict=True)
    distance = min(nearest_of_many(x, z, p, q) for p, q in sides)
    return -distance if is_around(x, z, corners) else distance


def collider(table, part: int):
    world = World(table)
    return world.records[2][part]


PRISM = TriangularPrism(vertices=((2.0, -1.0), (3.2, -1.4), (2.4, 0.2)))
WALL = SlantWall(start=(1.0, -2.0), end=(-1.5, 1.5), thickness=0.2)
CYLINDER = Cylinder(center=(4.0, 1.0), radius=0.8)


@pytest.mark.parametrize("kind", ["prism", "left paddle", "right paddle", "slant wall", "cylinder"])
def test_the_audit_agrees_with_a_brute_force_of_many_points(kind: str) -> None:
    rng = np.random.default_rng(3)
    world = World(table_of(LEFT, RIGHT, PRISM, WALL, CYLINDER))
    _, _, colliders = world.records
    for _ in range(200):
        angle = float(rng.uniform(-0.3, 0.9))
        if kind == "prism":
            row, middle, corners = colliders[FIRST_SHAPE + 1], (2.5, -0.7), PRISM.corners()
        elif kind.endswith("paddle"):
            paddle = LEFT if kind == "left paddle" else RIGHT
            row = colliders[Part.LEFT_PADDLE if paddle is LEFT else Part.RIGHT_PADDLE]
            middle, corners = (-7.0, paddle.pivot[1] * 0.6), paddle.corners(math.degrees(angle))
        elif kind == "slant wall":
            row, middle, corners = colliders[FIRST_SHAPE], (0.0, 0.0), None
        else:
            row, middle, corners = colliders[FIRST_SHAPE + 2], (4.0, 1.0), None
        x, z = (float(m + d) for m, d in zip(middle, rng.uniform(-2, 2, 2), strict=True))
        got = part_gap(row, angle, x, z)
        if corners is not None:
            # Of 4001 points on at most 2.2 u the nearest is at most 2.8e-4 u off its foot; the distance d
            # then by its square over 2·d.
            exact = brute_gap(x, z, corners)
            assert got == pytest.approx(exact, abs=min(3e-4, 1e-7 / max(abs(exact), 1e-9)))
        elif kind == "slant wall":
            exact = nearest_of_many(x, z, WALL.start, WALL.end) - 0.2
            assert got == pytest.approx(exact, abs=1e-6 if exact > 0 else 4e-4)
        else:
            # As the angle at which the circle is seen: sin φ = radius / distance, from outside.
            apart = abs(complex(x - 4.0, z - 1.0))
            assert got == pytest.approx(apart - 0.8, abs=1e-14)


@pytest.mark.parametrize(
    ("where", "depth"),
    [
        ((2.0, 4.9 - 0.25 + 0.03), 0.03),  # right border
        ((2.0, -4.9 + 0.25 - 0.04), 0.04),  # left border
        ((9.9 - 0.25 + 0.05, 0.0), 0.05),  # top
        ((4.0, 1.0 + 0.8 + 0.25 - 0.06), 0.06),  # cylinder
        ((-0.25, -0.25), 0.45),  # on the line of the slant wall: radius + thickness
        ((3.2 + 0.2, -1.4), 0.05),  # above the corner of the prism
    ],
)
@pytest.mark.parametrize("slot", [0, 1])
def test_the_audit_reports_how_deep_a_ball_was_put_inside_something(where, depth: float, slot: int) -> None:
    world = launched(table_of(LEFT, RIGHT, PRISM, WALL, CYLINDER), (7.0, 0.0, 0.0, 0.0), (7.0, 3.0, 0.0, 0.0))
    assert deepest(*world.records) == 0.0
    world.records[0]["ball"]["x"][slot], world.records[0]["ball"]["z"][slot] = where
    assert deepest(*world.records) == pytest.approx(depth, abs=1e-12)


@pytest.mark.parametrize(("angle", "inside"), [(45.0, True), (-10.0, False)])
@pytest.mark.parametrize("paddle", [LEFT, RIGHT])
def test_the_audit_looks_at_the_paddle_where_it_is_now(angle: float, inside: bool, paddle) -> None:
    world = launched(table_of(LEFT, RIGHT), (7.0, 0.0, 0.0, 0.0))
    number = [LEFT, RIGHT].index(paddle)
    tip = paddle.corners(45.0)[1]
    record = world.records[0]
    record["ball"]["x"][0], record["ball"]["z"][0] = tip[0] + 0.24, tip[1]
    record["paddle"]["angle"][number] = math.radians(angle)
    assert deepest(*world.records) == pytest.approx(0.01 if inside else 0.0, abs=1e-12)


def test_the_audit_sees_two_balls_in_one_another_and_no_ball_that_is_gone() -> None:
    world = launched(table_of(), (7.0, 0.0, 0.0, 0.0), (7.0, 3.0, 0.0, 0.0))
    world.records[0]["ball"]["z"][1] = 0.4
    assert deepest(*world.records) == pytest.approx(0.1, abs=1e-14)
    world.records[0]["ball"]["id"][1] = 0
    assert deepest(*world.records) == 0.0
