"""The times of contacts against 50 digits.

Each reference starts from the numbers of the table and uses its own distance formula in mpmath (see
`contact_times.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf

from boards import CONTACTS, LEFT, RIGHT, edited, place, table_of
from contact_times import BOUND, SAMPLES, Gap, exact, first_root, from_segment, length
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism
from silverball.world import World

FLIGHTS = 200
RADIUS = 0.25
GRAVITY = 10
TICK = 0.1  # [s] one tick at the lowest rate: a whole flight


def position(ball, t):
    x, z, vx, vz = ball
    return x + vx * t - t * t * GRAVITY / 2, z + vz * t


def from_triangle(x, z, corners):
    """Distance of a point outside of a triangle."""
    a, b, c = corners
    least = from_segment(x, z, a, b)
    for p, q in ((b, c), (c, a)):
        other = from_segment(x, z, p, q)
        least = min(least, other) if isinstance(least, mpf) else np.minimum(least, other)
    return least


def flights(seed: int, aim: Callable[[Any], Any]):
    """Random balls that fly at random places of a part: x, z, vx, vz, as floats."""
    rng = np.random.default_rng(seed)
    while True:
        target = aim(rng)
        turn, speed, ahead = rng.uniform(0, 2 * math.pi), rng.uniform(3, 21), rng.uniform(0.01, TICK)
        vx, vz = speed * math.sin(turn), speed * math.cos(turn)
        x = target[0] - vx * ahead + GRAVITY / 2 * ahead**2
        yield float(x), float(target[1] - vz * ahead), float(vx), float(vz)


def is_on_board(ball) -> bool:
    return -8.5 < ball[0] < 9.5 and abs(ball[1]) < 4.5


class Range:
    """One world to fly many balls in, each alone, from its empty start."""

    def __init__(self, table: Table) -> None:
        self.world = World(table, tick_rate=10)
        self.empty = self.world.save()

    def fly(self, *balls, prepare=None, **buttons: bool):
        """The contacts of the first tick."""
        self.world.restore(self.empty)
        for x, z, vx, vz in balls:
            self.world.create_ball((x, z), (vx, vz))
        if prepare is not None:
            self.world.restore(edited(self.world, prepare))
        self.world.step(**buttons)
        return [event for event in self.world.events if event.kind in CONTACTS]


def check(
    name: str, table: Range, ball, gap: Gap, part: str, seen: list[float], prepare=None, **buttons: bool
) -> None:
    """Fly one ball, in one tick, and note its error as a share of the bound."""
    if not is_on_board(ball) or gap(np.array([0.0]))[0] < 1e-3:
        return
    with mpmath.workdps(50):
        found = first_root(gap, TICK)
        if found is None:
            return
        root, rate = found
        contacts = table.fly(ball, prepare=prepare, **buttons)
        if contacts and contacts[0].part != part:
            return
        assert contacts, f"{name}: the ball {ball} should have met it after {mpmath.nstr(root, 20)} s"
        error = abs(contacts[0].offset - root)
        assert abs(contacts[0].speed + rate) <= 1e-9 * (1 + abs(rate)) / min(1, abs(rate))
    seen.append(float(error * abs(rate) / BOUND))
    assert seen[-1] <= 1.0, (
        f"{name}: {ball} met after {contacts[0].offset!r}, exactly {mpmath.nstr(root, 25)}"
    )


def report(name: str, seen: list[float]) -> None:
    print(f"hit times, {name}: worst {max(seen):.3f} of 8·ulp(10)/|D′| in {len(seen)} flights")


def test_hit_times_on_slant_walls_and_their_ends() -> None:
    wall = SlantWall(start=(3.0, -1.5), end=(1.2, 2.0), thickness=0.13)
    table = Range(table_of(wall))
    seen: list[float] = []

    def aim(rng):
        share = rng.uniform(-0.15, 1.15)
        return 3.0 - 1.8 * share, -1.5 + 3.5 * share

    balls = flights(1, aim)
    while len(seen) < FLIGHTS:
        ball = next(balls)

        def gap(t, ball=ball):
            x, z = position([exact(n) for n in ball] if isinstance(t, mpf) else ball, t)
            ends = [
                tuple(exact(n) if isinstance(t, mpf) else n for n in end) for end in (wall.start, wall.end)
            ]
            return from_segment(x, z, *ends) - (
                exact(RADIUS) + exact(0.13) if isinstance(t, mpf) else RADIUS + 0.13
            )

        check("slant wall", table, ball, gap, "slant_wall[0]", seen)
    report("slant wall", seen)


@pytest.mark.parametrize("what", ["sides", "corners"])
def test_hit_times_on_prisms(what: str) -> None:
    corners = ((2.0, -1.0), (3.2, -1.4), (2.4, 0.2))
    table = Range(table_of(TriangularPrism(vertices=corners)))
    seen: list[float] = []

    def aim(rng):
        k = int(rng.integers(3))
        a, b = corners[k], corners[(k + 1) % 3]
        s = rng.uniform(0.1, 0.9) if what == "sides" else rng.normal(0, 0.03)
        return a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])

    balls = flights(2, aim)
    while len(seen) < FLIGHTS:
        ball = next(balls)
        if is_inside(ball, corners):
            continue

        def gap(t, ball=ball):
            if isinstance(t, mpf):
                x, z = position([exact(n) for n in ball], t)
                return from_triangle(x, z, [(exact(a), exact(b)) for a, b in corners]) - exact(RADIUS)
            return from_triangle(*position(ball, t), corners) - RADIUS

        check(f"prism {what}", table, ball, gap, "triangular_prism[0]", seen)
    report(f"prism, {what}", seen)


def test_hit_times_on_cylinders() -> None:
    table = Range(table_of(Cylinder(center=(2.0, 0.7), radius=0.6)))
    seen: list[float] = []
    balls = flights(3, lambda rng: (2.0 + rng.uniform(-0.8, 0.8), 0.7 + rng.uniform(-0.8, 0.8)))
    while len(seen) < FLIGHTS:
        ball = next(balls)

        def gap(t, ball=ball):
            if isinstance(t, mpf):
                x, z = position([exact(n) for n in ball], t)
                return length(x - 2, z - exact(0.7)) - exact(0.6) - exact(RADIUS)
            x, z = position(ball, t)
            return length(x - 2.0, z - 0.7) - 0.6 - RADIUS

        check("cylinder", table, ball, gap, "cylinder[0]", seen)
    report("cylinder", seen)


@pytest.mark.parametrize("border", ["left", "right", "top"])
def test_hit_times_on_borders(border: str) -> None:
    table = Range(table_of())
    seen: list[float] = []
    middle = {"left": (0, -4.6), "right": (0, 4.6), "top": (9.6, 0)}[border]
    balls = flights(4, lambda rng: (middle[0] + rng.uniform(-0.1, 0.3), middle[1] + rng.uniform(-0.3, 0.3)))
    # The compiled edge is what the table says to a rounding: 5 − 0.1.
    edge = 9.9 if border == "top" else 4.9
    while len(seen) < FLIGHTS:
        ball = next(balls)

        def gap(t, ball=ball):
            x, z = position([exact(n) for n in ball] if isinstance(t, mpf) else ball, t)
            reached = x if border == "top" else z if border == "right" else -z
            return exact(edge) - exact(RADIUS) - reached if isinstance(t, mpf) else edge - RADIUS - reached

        check(f"{border} border", table, ball, gap, f"board.{border}", seen)
    report(f"{border} border", seen)


def paddle_corners(paddle, angle):
    """An isosceles triangle: base of the given height around the pivot, its tip `length` away; mirrored on
    the right."""
    sine, cosine = (
        (mpmath.sin(angle), mpmath.cos(angle)) if isinstance(angle, mpf) else (np.sin(angle), np.cos(angle))
    )
    number = exact if isinstance(angle, mpf) else float
    side = 1 if paddle.side == "left" else -1
    px, pz, half, long = (number(n) for n in (*paddle.pivot, paddle.base / 2, paddle.length))
    return (
        (px - half * cosine, pz + side * half * sine),
        (px + long * sine, pz + side * long * cosine),
        (px + half * cosine, pz - side * half * sine),
    )


@pytest.mark.parametrize("motion", ["lifting", "returning", "resting"])
@pytest.mark.parametrize("paddle", [LEFT, RIGHT])
def test_hit_times_on_paddles(paddle, motion: str) -> None:
    table = Range(table_of(paddle))
    rest, up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
    omega = {"lifting": (up - rest) / 0.1, "returning": -(up - rest) / 0.1, "resting": 0.0}[motion]
    seen: list[float] = []
    rng = np.random.default_rng(5)
    side = 1 if paddle.side == "left" else -1

    def aim(rng):
        turn, out = rng.uniform(rest, up), rng.uniform(0.1, 1.05) * paddle.length
        return paddle.pivot[0] + out * math.sin(turn), paddle.pivot[1] + side * out * math.cos(turn)

    balls = flights(6, aim)
    # The right paddle is worked out as the mirrored left one: fewer flights show that.
    while len(seen) < (FLIGHTS if paddle is LEFT else FLIGHTS // 3):
        ball = next(balls)
        begin = rest if motion == "resting" else float(rng.uniform(rest, up))
        # The flight ends where the paddle would reach its stop; a later meeting is another test's.
        stop = {
            "lifting": (up - begin) / omega if omega else 1,
            "returning": (rest - begin) / omega if omega else 1,
        }
        end = min(TICK, stop.get(motion, TICK))

        def gap(t, ball=ball, begin=begin):
            if isinstance(t, mpf):
                x, z = position([exact(n) for n in ball], t)
                return from_triangle(x, z, paddle_corners(paddle, exact(begin) + exact(omega) * t)) - exact(
                    RADIUS
                )
            return from_triangle(*position(ball, t), paddle_corners(paddle, begin + omega * t)) - RADIUS

        def prepare(record, begin=begin):
            record["paddle"]["angle"][0] = begin

        times = np.linspace(0, end, SAMPLES)
        # In the middle of the paddle the distance from its sides is no gap: leave such starts out.
        if end < 1e-3 or not (gap(times) < 0).any() or is_inside(ball, paddle_corners(paddle, begin)):
            continue
        if is_inside(ball, paddle_corners(paddle, rest)):  # World.create_ball would refuse it
            continue
        if gap(np.array([0.0]), begin=rest)[0] < 1e-3:
            continue
        buttons = {paddle.side: motion == "lifting"}
        check(
            f"{motion} {paddle.side} paddle",
            table,
            ball,
            gap,
            f"paddle.{paddle.side}",
            seen,
            prepare,
            **buttons,
        )
    report(f"{motion} {paddle.side} paddle", seen)


def is_inside(ball, corners) -> bool:
    x, z = ball[:2]
    signs = [
        (b[1] - a[1]) * (x - a[0]) - (b[0] - a[0]) * (z - a[1]) > 0
        for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
    ]
    return all(signs) or not any(signs)


def test_hit_times_of_ball_against_ball() -> None:
    table = Range(table_of())
    rng = np.random.default_rng(8)
    seen: list[float] = []
    while len(seen) < FLIGHTS:
        a = tuple(float(n) for n in (*rng.uniform(-3, 3, 2), *rng.uniform(-14, 14, 2)))
        ahead, turn, w = rng.uniform(0.01, TICK), rng.uniform(0, 2 * math.pi, 2), rng.uniform(1, 15)
        vx, vz = a[2] + w * math.sin(turn[0]), a[3] + w * math.cos(turn[0])
        near = rng.uniform(0, 2 * RADIUS)
        x = a[0] + near * math.sin(turn[1]) + (a[2] - vx) * ahead
        z = a[1] + near * math.cos(turn[1]) + (a[3] - vz) * ahead
        b = (float(x), float(z), float(vx), float(vz))
        if math.hypot(b[0] - a[0], b[1] - a[1]) < 2 * RADIUS + 1e-3 or math.hypot(*b[2:]) > 22:
            continue

        def gap(t, a=a, b=b):
            one, other = ([exact(n) for n in ball] if isinstance(t, mpf) else ball for ball in (a, b))
            (ax, az), (bx, bz) = position(one, t), position(other, t)
            return length(ax - bx, az - bz) - (exact(2 * RADIUS) if isinstance(t, mpf) else 2 * RADIUS)

        with mpmath.workdps(50):
            found = first_root(gap, TICK)
            if found is None or not is_on_board(a) or not is_on_board(b):
                continue
            event = table.fly(a, b)[0]
            assert event.part == "ball"
            error = abs(event.offset - found[0])
            seen.append(float(error * abs(found[1]) / BOUND))
            assert seen[-1] <= 1.0
            at = position(a, float(found[0]))
            assert place(event) == pytest.approx(at, abs=1e-12)
    report("ball against ball", seen)


def test_the_reference_has_fifty_digits() -> None:
    """x = 1 − ½·10·t² falls on the border of a cylinder: the root must be √(0.2·gap) to 45 digits."""
    with mp.workdps(50):
        root, rate = first_root(lambda t: exact(1) - 5 * t * t if isinstance(t, mpf) else 1 - 5 * t * t, 1.0)
        assert abs(root - mpmath.sqrt(mpf(1) / 5)) < mpf(10) ** -40
        assert abs(rate + 10 * root) < mpf(10) ** -18
