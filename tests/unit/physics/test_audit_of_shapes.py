"""The audit of arcs, tapered capsules and closed walls, against many points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contact_times import SAMPLES
from rows_of import RADIUS, row_of
from silverball.physics.audit import angle_after, box, depth_in_stationary, is_in_solid, part_gap
from silverball.physics.records import BOARD, COLLIDER, Response, Shape, records
from silverball.table import Board
from silverball.table.primitive import Mover, Point, Primitive
from silverball.world.rows import set_row

PIVOT = (-3.0, 1.0)


def paddle(direction: float = 1.0, **more) -> Primitive:
    mover = Mover(PIVOT, direction, math.radians(-30), math.radians(20), 0.03, 0.1, "left", **more)
    return Primitive(Shape.TAPERED, ((0.0, 0.0), (0.0, 1.15)), 0.2, 0.12, mover=mover)


def points_of_arc(start: Point, end: Point, bulge: float, count: int = SAMPLES) -> np.ndarray:
    """Points (x, z) on an arc: the chord bent by its bulge, as complex numbers z + i·x."""
    a, b = complex(start[1], start[0]), complex(end[1], end[0])
    if bulge == 0.0:
        points = a + (b - a) * np.linspace(0, 1, count)
    else:
        center = (a + b) / 2 + 1j * (b - a) * (1 - bulge**2) / (4 * bulge)
        points = center + (a - center) * np.exp(4j * math.atan(bulge) * np.linspace(0, 1, count))
    return np.stack([points.imag, points.real], axis=1)


@pytest.mark.parametrize("bulge", [0.4, -0.9, 1.0, 2.5, -3.0, 0.003])
def test_the_gap_of_an_arc_is_that_of_many_of_its_points(bulge: float) -> None:
    start, end = (1.0, -1.0), (0.3, 1.2)
    row = row_of(Primitive(Shape.ARC, (start, end), 0.1, bulge=bulge))
    points = points_of_arc(start, end, bulge, 20001)
    low_x, high_x, low_z, high_z = box(row)
    assert (points.min(axis=0) >= (low_x + 0.1 - 1e-12, low_z + 0.1 - 1e-12)).all()
    assert (points.max(axis=0) <= (high_x - 0.1 + 1e-12, high_z - 0.1 + 1e-12)).all()
    for x, z in np.random.default_rng(1).uniform(-4, 4, (200, 2)):
        near = np.hypot(x - points[:, 0], z - points[:, 1]).min()
        assert part_gap(row, 0.0, x, z) == pytest.approx(near - 0.1, abs=min(1e-3, 1e-6 / near))


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_gap_of_a_tapered_paddle_is_that_of_a_hull_of_many_circles(direction: float) -> None:
    row = row_of(paddle(direction))
    share = np.linspace(0, 1, 20001)
    rng = np.random.default_rng(2)
    for _ in range(200):
        angle, x, z = rng.uniform(-0.6, 0.5), *(PIVOT + rng.uniform(-2, 2, 2))
        xs = PIVOT[0] + 1.15 * share * math.sin(angle)
        zs = PIVOT[1] + direction * 1.15 * share * math.cos(angle)
        near = (np.hypot(x - xs, z - zs) - (0.2 - 0.08 * share)).min()
        assert part_gap(row, angle, x, z) == pytest.approx(near, abs=1e-7)


def board_of(*parts: list[Primitive]):
    """A BOARD record and COLLIDER rows: five that are not looked at, then those of each part."""
    rows = records(5 + sum(map(len, parts)), COLLIDER)
    number = 5
    for part, primitives in enumerate(parts):
        for primitive in primitives:
            set_row(rows[number], primitive, Board())
            rows[number]["part"] = 5 + part
            number += 1
    board = records(1, BOARD)[0]
    board["collider_end"], board["ball_radius"] = len(rows), RADIUS
    return board, rows


def chain(*points: tuple[float, float, float], closed: bool = True) -> list[Primitive]:
    """The primitives of a wall: points (x, z, bulge of the edge that follows)."""
    count = len(points) if closed else len(points) - 1
    return [
        Primitive(
            Shape.ARC if bulge else Shape.CAPSULE,
            ((x, z), points[(index + 1) % len(points)][:2]),
            0.05,
            bulge=bulge,
        )
        for index, (x, z, bulge) in enumerate(points[:count])
    ]


BLOB = ((-2, -2, 0.5), (-2, 2, -0.3), (2, 2, 0.0), (0.5, 0, 0.4), (2, -2, 1.2))
"""Concave, with arcs to both sides."""


def test_a_closed_wall_is_solid_inside() -> None:
    """Against the winding number of a polygon of very many points."""
    board, rows = board_of(chain((-8, -3, 0), (-8, 3, 0), (-7, 0, 0)), chain(*BLOB))
    outline = np.concatenate(
        [points_of_arc(edge.points[0], edge.points[1], edge.bulge) for edge in chain(*BLOB)]
    )
    inside = 0
    for x, z in np.random.default_rng(3).uniform((-4, -5), (4, 4), (600, 2)):
        away = (outline[:, 1] - z) + 1j * (outline[:, 0] - x)
        if abs(away).min() < 2e-3:
            continue
        turns = np.angle(np.roll(away, -1) / away).sum() / (2 * math.pi)
        is_inside = bool(abs(turns) > 0.5)
        assert is_in_solid(board, rows, x, z) == is_inside, (x, z)
        inside += is_inside
    assert 100 < inside < 500


def test_an_open_wall_has_no_inside_and_two_walls_make_none_together() -> None:
    open_wall = chain(*BLOB, closed=False)
    board, rows = board_of(open_wall, chain(*BLOB)[-1:])
    assert not is_in_solid(board, rows, -1.0, 0.0)
    board, rows = board_of(chain(*BLOB))
    assert is_in_solid(board, rows, -1.0, 0.0)


def test_what_a_ball_does_not_meet_has_no_depth() -> None:
    wall = chain(*BLOB)
    board, rows = board_of([edge._replace(levels=(1,)) for edge in wall])
    assert depth_in_stationary(board, rows, 2.0, -2.0) == 0.0
    assert depth_in_stationary(board, rows, 2.0, -2.0, 1) == pytest.approx(RADIUS + 0.05)
    assert not is_in_solid(board, rows, -1.0, 0.0)
    assert is_in_solid(board, rows, -1.0, 0.0, 1)
    rows["switch"] = 4
    assert depth_in_stationary(board, rows, 2.0, -2.0, 1, 2) == pytest.approx(RADIUS + 0.05)
    assert depth_in_stationary(board, rows, 2.0, -2.0, 1, 4) == 0.0
    assert not is_in_solid(board, rows, -1.0, 0.0, 1, 4)
    gate = Primitive(Shape.CAPSULE, ((0, 0), (0, 1)), 0.05, one_way=(1.0, 0.0))
    line = Primitive(Shape.LINE, ((1, 0), (1, 1)), response=Response.PASS)
    disc = Primitive(Shape.DISC, ((1, 0),), 0.5, response=Response.HOLD)
    board, rows = board_of([gate], [line], [disc])
    assert depth_in_stationary(board, rows, 0.0, 0.5) == 0.0
    assert depth_in_stationary(board, rows, 1.0, 0.2) == 0.0
    rows["one_way"] = 0
    assert depth_in_stationary(board, rows, 0.0, 0.5) == pytest.approx(RADIUS + 0.05)


def test_the_angle_of_a_coil_paddle_follows_from_its_speed() -> None:
    row = row_of(paddle(is_coil=True))
    swing = math.radians(50)
    rest, up = math.radians(-30), math.radians(20)
    for time in (0.0, 0.01, 0.02, 0.0299):
        assert angle_after(row, rest, up, time) == pytest.approx(rest + swing * (time / 0.03) ** 2)
    middle, omega = rest + swing / 4, 2 * swing / 0.03 / 2  # after half of the time
    assert angle_after(row, middle, up, 0.005, omega) == pytest.approx(rest + swing * (0.02 / 0.03) ** 2)
    assert angle_after(row, middle, rest, 0.05, omega) == pytest.approx(middle - swing * 0.25)
    assert angle_after(row, middle, up, 0.1, omega) == up
