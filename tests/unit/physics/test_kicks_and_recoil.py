"""Bounces with what each part may have of its own: kick, threshold, friction, and the mass of a paddle."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from hypothesis import given, strategies as st

from rows_of import RADIUS, ball_at, row_of
from silverball.physics.bounce import bounce
from silverball.physics.records import BOARD, Contact, Shape, records
from silverball.physics.tolerances import HOP
from silverball.table import Board
from silverball.table.primitive import Mover, Primitive, Surface

CAP = 60.0


@numba.njit(error_model="numpy")
def _bounce(ball, board, c, nx, nz, ux, uz, acceleration):  # pragma: no cover  (compiled)
    return bounce(ball, board, c, Contact(0.0, 5, nx, nz), ux, uz, acceleration)


def bounced(row, ball, normal, surface=(0.0, 0.0), acceleration: float = 10.0, friction: float = 0.0):
    """The approach speed, and the ball after a bounce."""
    board = records(1, BOARD)[0]
    board["ball_radius"], board["curvature"], board["speed_cap"] = RADIUS, 1 / RADIUS, CAP
    board["hit_speed"], board["friction"] = 99.0, 99.0  # those of the row are used
    return _bounce(ball, board, row, *normal, *surface, acceleration), ball


def wall(**surface) -> Primitive:
    """A capsule from z = −1 to z = 1 on the line x = 0."""
    return Primitive(Shape.CAPSULE, ((0.0, -1.0), (0.0, 1.0)), 0.1, surface=Surface(**surface))


@given(st.floats(-1.2, 1.2), st.floats(0.1, 20), st.floats(-10, 10), st.floats(0, 30), st.floats(0, 3))
def test_a_kick_is_strongest_in_the_middle_and_needs_its_threshold(place, w, along, kick, threshold) -> None:
    row = row_of(wall(restitution=0.5, kick=kick, kick_profile="parabola", hit_speed=threshold))
    speed, ball = bounced(row, ball_at(0.35, place, -w, along), (1.0, 0.0))
    assert speed == w
    if w > threshold:
        out = 0.5 * w + kick * max(0.0, 1 - place**2)
    else:
        out = max(0.5 * w, min(math.sqrt(2 * 10.0 * HOP), 0.9 * threshold), 1e-9)
    assert (ball["vx"], ball["vz"]) == pytest.approx((out, along), abs=1e-12)


@pytest.mark.parametrize("bulge", [0.4, 1.0, 2.0])
def test_a_kick_of_an_arc_goes_by_the_place_along_its_chord(bulge: float) -> None:
    surface = Surface(kick=8.0, kick_profile="parabola", hit_speed=0.5)
    arc = Primitive(Shape.ARC, ((0.0, -1.0), (0.0, 1.0)), 0.1, bulge=bulge, surface=surface)
    (cx, cz), radius = arc.arc.center, arc.arc.radius
    for turn in np.linspace(-0.9, 0.9, 7):
        nx, nz = -math.cos(turn), math.sin(turn)  # the arc bulges downwards; the ball is below it
        x, z = cx + (radius + 0.1 + RADIUS) * nx, cz + (radius + 0.1 + RADIUS) * nz
        place = cz + (radius + 0.1) * nz
        _, ball = bounced(row_of(arc), ball_at(x, z, -3 * nx, -3 * nz), (nx, nz))
        out = 8.0 * max(0.0, 1 - place**2)
        assert (ball["vx"], ball["vz"]) == pytest.approx((out * nx, out * nz), abs=1e-12)


def test_a_flat_kick_is_the_same_everywhere_and_limited_by_the_speed_cap() -> None:
    post = Primitive(Shape.CIRCLE, ((0.0, 0.0),), 0.3, surface=Surface(restitution=0.3, kick=12.0))
    _, ball = bounced(row_of(post), ball_at(0.55, 0.0, -5.0, 2.0), (1.0, 0.0))
    assert (ball["vx"], ball["vz"]) == (0.3 * 5.0 + 12.0, 2.0)
    _, ball = bounced(row_of(post._replace(surface=Surface(kick=900.0))), ball_at(0.55, 0, -5), (1.0, 0.0))
    assert math.hypot(ball["vx"], ball["vz"]) == pytest.approx(CAP, rel=1e-15)


def test_each_row_has_its_own_friction_and_threshold() -> None:
    board = Board(friction=0.2, hit_speed=0.7)
    assert row_of(wall(), board)["friction"] == 0.2
    assert row_of(wall(), board)["hit_speed"] == 0.7
    smooth, rough = (row_of(wall(restitution=0.5, friction=mu, hit_speed=2.0), board) for mu in (0.0, 0.3))
    _, ball = bounced(smooth, ball_at(0.35, 0.0, -4.0, 9.0), (1.0, 0.0))
    assert (ball["vz"], ball["spin_y"]) == (9.0, 0.0)
    _, ball = bounced(rough, ball_at(0.35, 0.0, -4.0, 9.0), (1.0, 0.0))
    impulse = 0.3 * (4.0 + 2.0)  # it slips: the limit of Coulomb's law
    assert (ball["vz"], ball["spin_y"]) == pytest.approx((9.0 - impulse, -2.5 * impulse / RADIUS))


MOVER = Mover((0.0, 0.0), 1.0, -0.5, 0.4, 0.03, 0.1, "left")


def lifting_paddle(mass: float | None, shape: Shape, restitution: float) -> Primitive:
    points = ((0.0, 0.0), (0.0, 1.2)) if shape == Shape.TAPERED else ((-0.2, 0.0), (0.0, 1.2), (0.2, 0.0))
    surface = Surface(restitution=restitution)
    return Primitive(shape, points, 0.2, 0.1, surface=surface, mover=MOVER._replace(mass=mass))


@given(
    st.sampled_from([Shape.TAPERED, Shape.TRIANGLE]),
    st.floats(0.5, 50),
    st.floats(0.0, 1.3),
    st.floats(2.0, 20.0),
    st.floats(0.0, 1.0),
)
def test_a_light_paddle_gives_way_by_its_moment_of_inertia(shape, mass, out, omega, e) -> None:
    """Struck at rest at the distance r a ball gets (1 + e)·ω·r / (1 + 3·r²/(m·L²)), if that is faster than
    the surface."""
    x, z = 0.15, out
    _, ball = bounced(
        row_of(lifting_paddle(mass, shape, e)), ball_at(x + RADIUS, z), (1.0, 0.0), (omega * z, -omega * x)
    )
    square = x * x + z * z
    factor = 1 / (1 + 3 * square / (mass * 1.2**2))
    surface = omega * z
    hop = min(math.sqrt(2 * 10.0 * HOP), 0.45)
    impulse = (1 + e) * surface if surface > 0.5 else surface + max(e * surface, hop)
    assert ball["vx"] == pytest.approx(max(impulse * factor, surface + hop), rel=1e-12)


def test_a_heavy_paddle_and_one_at_its_stop_are_rigid() -> None:
    for mass, surface in ((None, (9.0, -1.0)), (1.0, (0.0, 0.0))):
        row = row_of(lifting_paddle(mass, Shape.TAPERED, 0.5))
        _, ball = bounced(row, ball_at(0.4, 1.0, -3.0), (1.0, 0.0), surface)
        assert ball["vx"] == pytest.approx(-3.0 + 1.5 * (3.0 + surface[0]))


def test_the_exit_speed_of_a_light_paddle_is_flatter_than_that_of_a_rigid_one() -> None:
    def exit_speed(mass: float | None, out: float) -> float:
        row = row_of(lifting_paddle(mass, Shape.TAPERED, 0.8))
        return float(bounced(row, ball_at(0.4, out), (1.0, 0.0), (20.0 * out, 0.0))[1]["vx"])

    assert exit_speed(None, 1.1) / exit_speed(None, 0.55) == pytest.approx(2.0)
    assert exit_speed(3.0, 1.1) / exit_speed(3.0, 0.55) < 1.5


def test_a_touch_inside_a_curve_hops_by_the_acceleration_of_its_path() -> None:
    """A ball that runs along the inside at 4 u/s hops as high as one under 10 + 4²/ρ u/s²."""
    surface = Surface(hit_speed=2.0)
    arc = Primitive(Shape.ARC, ((0.0, -2.0), (0.0, 2.0)), 0.1, bulge=1.0, surface=surface)
    for normal, x, extra in ((1.0, -2.0 + 0.1 + RADIUS, 16 / (2 - 0.1 - RADIUS)), (-1.0, -2.35, 0.0)):
        _, ball = bounced(row_of(arc), ball_at(x, 0.0, -0.01 * normal, 4.0), (normal, 0.0))
        assert ball["vx"] * normal == pytest.approx(math.sqrt(2 * (10 + extra) * HOP))
        assert ball["vz"] == 4.0
