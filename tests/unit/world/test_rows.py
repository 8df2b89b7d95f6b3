"""The rows of colliders: one function for each shape of primitive."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rows_of import row_of
from silverball.physics.records import KickProfile, Response, Shape
from silverball.table import Board
from silverball.table.primitive import Mover, Primitive, Surface
from silverball.world.rows import SET_SHAPE, highest_x, swept_circle

MOVER = Mover((-7.0, -2.0), 1.0, math.radians(-80), math.radians(110), 0.05, 0.1, "left")
TAPERED = Primitive(Shape.TAPERED, ((0.0, 0.0), (0.0, 1.2)), 0.2, 0.12, mover=MOVER)
TRIANGLE = Primitive(Shape.TRIANGLE, ((-0.3, 0.0), (0.0, 1.2), (0.3, 0.0)), mover=MOVER)


def test_every_shape_has_its_function() -> None:
    assert set(SET_SHAPE) == set(Shape)


def test_levels_are_bits_and_the_board_gives_what_a_surface_leaves_open() -> None:
    post = Primitive(Shape.CIRCLE, ((1.0, 2.0),), 0.3, levels=(0, 2, 2), response=Response.PASS)
    row = row_of(post, Board(friction=0.3, hit_speed=0.8))
    assert (row["levels"], row["response"], row["friction"], row["hit_speed"]) == (5, 1, 0.3, 0.8)
    row = row_of(post._replace(surface=Surface(friction=0.0, hit_speed=1.5)), Board(friction=0.3))
    assert (row["friction"], row["hit_speed"]) == (0.0, 1.5)


def test_a_parabola_needs_ends() -> None:
    surface = Surface(kick=1.0, kick_profile="parabola")
    assert (
        row_of(Primitive(Shape.CIRCLE, ((0, 0),), 1.0, surface=surface))["kick_profile"] == KickProfile.FLAT
    )
    wall = Primitive(Shape.CAPSULE, ((0, 0), (0, 1)), surface=surface)
    assert row_of(wall)["kick_profile"] == KickProfile.PARABOLA


@pytest.mark.parametrize("ends", [((1.0, 1.0), (2.0, 3.0)), ((2.0, 3.0), (1.0, 1.0))])
def test_the_normal_of_a_capsule_points_to_the_centre_or_where_it_is_met(ends) -> None:
    x, z = -2.0 / math.sqrt(5), 1.0 / math.sqrt(5)
    row = row_of(Primitive(Shape.CAPSULE, ends))
    assert (row["inward_x"], row["inward_z"], row["one_way"]) == pytest.approx((x, z, 0))
    for direction in ((x, z), (-x, -z)):
        row = row_of(Primitive(Shape.CAPSULE, ends, one_way=direction))
        assert (row["inward_x"], row["inward_z"], row["one_way"]) == pytest.approx((*direction, 1))


def test_the_normal_of_a_line_points_to_the_left_of_its_direction() -> None:
    up = row_of(Primitive(Shape.LINE, ((1.0, 3.0), (2.0, 3.0))))  # to the top: left is −z
    right = row_of(Primitive(Shape.LINE, ((1.0, 3.0), (1.0, 4.0))))  # to the right: left is up
    assert (up["inward_x"], up["inward_z"]) == (0.0, -1.0)
    assert (right["inward_x"], right["inward_z"]) == (1.0, 0.0)


@pytest.mark.parametrize("bulge", [0.01, 0.5, 1.0, 1.2, 4.0, -0.3, -2.0])
def test_an_arc_is_inside_its_bounding_circle_and_its_tangents_point_to_the_middle(bulge: float) -> None:
    arc = Primitive(Shape.ARC, ((1.0, -1.0), (-0.5, 2.0)), 0.1, bulge=bulge)
    row, (cx, cz), radius = row_of(arc), arc.arc.center, arc.arc.radius
    middle = math.atan2(row["inward_z"], row["inward_x"])
    turns = middle + np.linspace(-1, 1, 1001) * arc.arc.half_angle
    xs, zs = cx + radius * np.cos(turns), cz + radius * np.sin(turns)
    assert np.hypot(xs - row["x"], zs - row["z"]).max() + 0.1 <= row["reach"]
    for number, step in ((0, 0.01), (1, 0.01)):
        ex, ez = row[f"x{number}"] - cx, row[f"z{number}"] - cz
        tx, tz = row[f"along_x{number}"], row[f"along_z{number}"]
        assert (tx * ex + tz * ez, math.hypot(tx, tz)) == pytest.approx((0.0, 1.0), abs=1e-12)
        ahead = math.atan2(ez + step * radius * tz, ex + step * radius * tx)
        assert abs(math.remainder(ahead - middle, 2 * math.pi)) < arc.arc.half_angle + 1e-9


def test_a_capsule_that_is_all_base_is_refused() -> None:
    for length, tip in ((0.05, 0.12), (1.0, 0.3)):
        with pytest.raises(ValueError, match="longer than the difference of its radii"):
            row_of(TAPERED._replace(points=((0.0, 0.0), (0.0, length)), tip_radius=tip))


@pytest.mark.parametrize("shape", [TAPERED, TRIANGLE])
@pytest.mark.parametrize(
    ("direction", "rest", "up"), [(1.0, -80, 110), (-1.0, -30, 25), (1.0, 95, 120), (1.0, -120, -90)]
)
def test_the_bounds_of_a_paddle_hold_at_all_its_angles(shape: Primitive, direction: float, rest, up) -> None:
    mover = MOVER._replace(direction=direction, rest_angle=math.radians(rest), up_angle=math.radians(up))
    paddle = shape._replace(mover=mover)
    row, (cx, cz, reach), top = row_of(paddle), swept_circle(paddle, mover), highest_x(paddle, mover)
    radii = (0.2, 0.12) if shape is TAPERED else (0.0, 0.0, 0.0)
    farthest = highest = outermost = 0.0 - math.inf
    for angle in np.linspace(mover.rest_angle, mover.up_angle, 400):
        for (across, along), radius in zip(paddle.points, radii, strict=True):
            x = mover.pivot[0] + across * math.cos(angle) + along * math.sin(angle)
            z = mover.pivot[1] + direction * (along * math.cos(angle) - across * math.sin(angle))
            farthest = max(farthest, math.hypot(x - cx, z - cz) + radius)
            highest = max(highest, x + radius)
            outermost = max(outermost, math.hypot(x - mover.pivot[0], z - mover.pivot[1]) + radius)
    assert farthest <= reach < farthest + 0.35
    assert highest <= top < highest + 0.35
    assert outermost == pytest.approx(row["reach"])


def test_a_coil_has_twice_the_mean_speed_and_a_mass_gives_way() -> None:
    mover = MOVER._replace(is_coil=True, mass=2.0)
    row, swing = row_of(TAPERED._replace(mover=mover)), math.radians(190)
    assert (row["lift_speed"], row["lift_accel"]) == pytest.approx((2 * swing / 0.05, 2 * swing / 0.05**2))
    assert (row["return_speed"], row["return_accel"]) == pytest.approx((2 * swing / 0.1, 2 * swing / 0.1**2))
    assert row["recoil"] == pytest.approx(3 / (2.0 * 1.2**2))
    assert row_of(TAPERED)["lift_accel"] == row_of(TAPERED)["recoil"] == 0.0
