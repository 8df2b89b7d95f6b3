"""The reference agrees with laws worked out by hand, and Silverball agrees with the reference."""

from __future__ import annotations

import pytest

from silverball.benchmarks.peers import accuracy
from silverball.benchmarks.peers.playfield import Stepping
from silverball.benchmarks.peers.reference import DIGITS, follow, positive_roots
from silverball.benchmarks.peers.silverball_table import SilverballPlayfield
from silverball.errors import SilverballError
from silverball.table import Table, load_table
from silverball.table.parts import Cylinder, SlantWall, TriangularPrism

mpmath = pytest.importorskip("mpmath")
TINY = mpmath.mpf(10) ** (5 - DIGITS)


def test_a_ball_that_falls_on_a_cylinder_bounces_with_the_times_of_free_fall():
    # From rest h above contact: t = √(2h/g); then each flight lasts 2·e·v/g, with v shrinking by e.
    table = Table(cylinder=(Cylinder(center=(0.0, 0.0), radius=0.75, restitution=0.5),))
    path = follow(table, (3.0, 0.0, 0.0, 0.0), 3)
    with mpmath.workdps(DIGITS):
        speed = mpmath.sqrt(2 * 10 * 2)
        times = [speed / 10, speed / 10 * 2, speed / 10 * mpmath.mpf("2.5")]
        for bounce, time, approach in zip(path.bounces, times, (speed, speed / 2, speed / 4), strict=True):
            assert abs(bounce.time - time) < TINY
            assert abs(bounce.approach - approach) < TINY
            assert abs(bounce.share - 1) < TINY


def test_a_ball_that_falls_on_a_45_degree_slant_wall_leaves_sideways():
    # The wall's face lies 0.1 above the line z = −x; the centre meets it (r + 0.1)·√2 above the line.
    wall = SlantWall(start=(-1.0, 1.0), end=(1.0, -1.0), restitution=1.0)
    path = follow(Table(slant_wall=(wall,)), (2.0, 0.0, 0.0, 0.0), 1)
    with mpmath.workdps(DIGITS):
        height = (mpmath.mpf(0.25) + mpmath.mpf(0.1)) * mpmath.sqrt(2)
        speed = mpmath.sqrt(2 * 10 * (2 - height))
        _, x, z, vx, vz = path.flights[1]
        assert abs(x - height) < TINY
        assert z == 0
        assert abs(vx) < TINY
        assert abs(vz - speed) < TINY


@pytest.mark.parametrize("corner", [(0.0, 0.0), (0.0, 1.5)])
def test_a_ball_that_falls_beside_a_corner_meets_it_round(corner):
    # A prism with its tip up at the corner: seen from the ball, the tip is an arc of the ball's radius.
    x, z = corner
    prism = TriangularPrism(vertices=((x, z), (x - 2.0, z - 0.25), (x - 2.0, z + 0.25)), restitution=0.5)
    path = follow(Table(triangular_prism=(prism,)), (x + 2.0, z + 0.125, 0.0, 0.0), 1)
    with mpmath.workdps(DIGITS):
        height = mpmath.sqrt(mpmath.mpf(0.25) ** 2 - mpmath.mpf(0.125) ** 2)
        assert abs(path.flights[1][1] - (x + height)) < TINY
        assert abs(path.bounces[0].share - height * 4) < TINY


@pytest.mark.parametrize("apart", ["1", "1e-9", "1e-20"])
def test_roots_are_right_in_all_digits_however_close_they_are(apart):
    # (t − 1)·(t − 1 − apart)·(t + 2)·t: one root is before now and one is now
    with mpmath.workdps(DIGITS + 30):
        second = 1 + mpmath.mpf(apart)
        product, total = second, 1 + second
        polynomial = [mpmath.mpf(0), 2 * product, product - 2 * total, 2 - total, mpmath.mpf(1)]
        first_found, second_found = sorted(positive_roots(polynomial))
        assert abs(first_found - 1) < TINY
        assert abs(second_found - second) < TINY


def test_the_place_between_bounces_lies_on_the_parabola():
    path = follow(Table(), (0.0, 0.0, 3.0, 1.0), 1)
    x, z = path.position(mpmath.mpf("0.5"))
    assert abs(x - (3 * 0.5 - 10 * 0.5**2 / 2)) < TINY
    assert abs(z - 0.5) < TINY


def test_a_ball_that_meets_nothing_ends_the_path():
    assert follow(Table(), (0.0, 0.0, 0.0, 0.0), 1).bounces == []


@pytest.fixture(scope="module")
def scenes():
    return accuracy.scenes(load_table("random"), 2)


def test_scenes_look_between_the_bounces_they_name(scenes):
    for scene in scenes:
        bounces = follow(scene.table, scene.start, 6, accuracy.ROUGH_DIGITS).bounces
        times = [0.0, *(float(bounce.time) for bounce in bounces)]
        for count, frame in zip(accuracy.BOUNCES, scene.frames, strict=True):
            assert times[count] < frame / 60 < times[count + 1]


def test_a_table_without_obstacles_has_no_scenes_and_that_is_said_in_words(monkeypatch):
    monkeypatch.setattr(accuracy, "MAX_DROPS", 3)
    with pytest.raises(SilverballError, match="more obstacles"):
        accuracy.scenes(Table(), 1)


@pytest.mark.parametrize("steps", [1, 4])
def test_silverball_agrees_with_the_reference_over_five_bounces(scenes, steps):
    for scene in scenes:
        found = accuracy.errors(scene, SilverballPlayfield(scene.table, Stepping(steps)))
        # Coordinates are rounded to 1e-15 u; the round parts on the way enlarge that some 200 times.
        assert max(found) < 1e-12
