"""Crossing times: when the centre of a ball in flight crosses a line or enters a disc.

Sensors, passages and spinners are lines; holes and round sensors are discs. A crossing does not end the
flight, so one flight may cross a line twice and enter a disc twice.

The age of a crossing is computed from the start of the flight alone. It has the same bits in every search,
wherever the search starts and ends, and so a crossing is found exactly once:

* a search covers the ages from `start` on and before `limit`; the next one starts at that limit;
* after a crossing at the age t the search resumes at t. Crossings at exactly t count for the colliders whose
  turn has not come (`is_past_start` False) and no longer for the others (True);
* a flight that starts within `CROSSED_GAP` of a line, or of the edge of a disc, has crossed it already: the
  crossing may be what started the flight.

All times are ages of the flight [s], as in `flight.py`.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from silverball.physics.flight import newton_refined, state_at, stays_open, time_to_line
from silverball.physics.kernel import internal, kernel
from silverball.physics.records import BallRecord, ColliderRecord
from silverball.physics.tolerances import CONTACT_GAP, CROSSED_GAP, FLIGHT_STEPS, NEVER

ROOT_STEPS = 100  # more than bisection needs within a flight; Newton takes some 5
FIRST_SPAN = 0.125  # [s] first guess of how long after t₂ a flight is closest to a disc
MAX_AGE = 1e9  # [s] no flight is as old


class Center(NamedTuple):
    """The centre of a disc [u]."""

    x: float
    z: float


class Approach(NamedTuple):
    """A moment of a flight relative to a centre: the products |p|², p·v, v² and p·a."""

    square: float
    rate: float
    speed_square: float
    pull: float


@kernel
def line_crossing(
    c: ColliderRecord, ball: BallRecord, start: float, is_past_start: bool, limit: float
) -> tuple[float, int]:
    """Find when a ball's centre next crosses a line, the segment from corner 0 to corner 1.

    Args:
        c: The line; `inward` is the unit normal to the left of corner 0 → corner 1 as the player sees it.
        ball: The ball.
        start: The age at which the search starts [s].
        is_past_start: Whether a crossing at exactly this age has been handled.
        limit: The age at which the search ends [s].

    Returns:
        The age and the direction: 1 to the left, −1 to the right; or the limit and 0.
    """
    gap = (ball.start_x - c.x0) * c.inward_x + (ball.start_z - c.z0) * c.inward_z
    rate = ball.start_vx * c.inward_x + ball.start_vz * c.inward_z
    gap_accel = ball.accel_x * c.inward_x + ball.accel_z * c.inward_z
    to_right, to_left = falling_time(gap, rate, gap_accel), falling_time(-gap, -rate, -gap_accel)
    if abs(gap) <= CROSSED_GAP:
        if rate <= 0.0:
            to_right = NEVER
        if rate >= 0.0:
            to_left = NEVER
    time, direction = limit, 0
    for side in (-1, 1):
        age = to_right if side < 0 else to_left
        if start <= age < time and not (is_past_start and age == start):
            at = state_at(ball, age)
            if 0.0 <= (at.x - c.x0) * c.along_x0 + (at.z - c.z0) * c.along_z0 <= c.length0:
                time, direction = age, side
    return time, direction


@internal
def falling_time(gap: float, rate: float, gap_accel: float) -> float:
    """Compute the time [s] at which a gap's parabola falls through zero; it may be negative.

    A parabola does so once at most, with the rate −√Δ (see `flight.time_to_line`). The result is NEVER where
    it only touches zero, and where it fell through zero in the past and does not fall now. Rounding cannot
    swap this time and the one at which the gap rises: Δ > 0 is at least an ulp of rate², and so the two are
    some 1e-8 of the time apart.
    """
    discriminant = rate * rate - 2.0 * gap_accel * gap
    if discriminant <= 0.0:
        return NEVER
    if rate < 0.0:
        return 2.0 * gap / (sqrt(discriminant) - rate)
    return (rate + sqrt(discriminant)) / -gap_accel if gap_accel < 0.0 else NEVER


@kernel
def disc_entry(
    c: ColliderRecord, ball: BallRecord, start: float, is_past_start: bool, limit: float
) -> tuple[float, bool]:
    """Find when a ball's centre next enters a disc.

    Args:
        c: The disc.
        ball: The ball.
        start: The age at which the search starts [s].
        is_past_start: Whether an entry at exactly this age has been handled.
        limit: The age at which the search ends [s].

    Returns:
        The age and True; or the limit and False.
    """
    center = Center(c.x, c.z)
    first, second = disc_entries(ball, center, c.radius, start, limit)
    if sqrt(approach(ball, center, 0.0).square) - c.radius <= CROSSED_GAP:
        first = NEVER
    for age in (first, second):
        if start <= age < limit and not (is_past_start and age == start):
            return age, True
    return limit, False


@internal
def disc_entries(
    ball: BallRecord, center: Center, radius: float, start: float, limit: float
) -> tuple[float, float]:
    """Compute the ages [s] at which a flight enters a disc; NEVER if it does not.

    Half the derivative of |p|² is the cubic p·v. Its derivative v² + p·a is a quadratic with the roots
    t₁ ≤ t₂, if any: p·v rises up to t₁, falls up to t₂, and rises from there. So the distance falls at most
    twice, down to a minimum before t₁ and to one after t₂, and is monotonic in between. There is one entry in
    a fall from outside to inside.

    Args:
        ball: The ball.
        center: The centre of the disc.
        radius: The radius of the disc [u].
        start: Entries before this age are not needed,
        limit: nor are those after this one; they may be found or not.

    Returns:
        The entry in a fall that begins with the flight, and that in a later one.
    """
    now = approach(ball, center, start)
    apart = sqrt(now.square)
    gap = apart - radius - CROSSED_GAP
    if gap > 0.0 and stays_open(gap, now.rate / apart, now.pull / apart, limit - start):
        return NEVER, NEVER
    # 3/2·a²·t² + 3·(v₀·a)·t + (v₀² + p₀·a) = 0, the form without cancellation for each root
    at_first = approach(ball, center, 0.0)
    square = 1.5 * (ball.accel_x * ball.accel_x + ball.accel_z * ball.accel_z)
    half = 1.5 * (ball.start_vx * ball.accel_x + ball.start_vz * ball.accel_z)
    rest = at_first.speed_square + at_first.pull
    discriminant = half * half - square * rest
    early, late = 0.0, 0.0
    if square > 0.0 and discriminant > 0.0:
        if half > 0.0:
            q = -half - sqrt(discriminant)
            early, late = q / square, rest / q
        else:
            q = -half + sqrt(discriminant)
            early, late = rest / q, q / square
        early, late = early if early > 0.0 else 0.0, late if late > 0.0 else 0.0
    first, low = NEVER, 0.0
    rate_late = approach(ball, center, late).rate
    is_later = approach(ball, center, early).rate > 0.0
    if is_later:  # there is a minimum before `early`, or the flight starts outwards
        if at_first.rate < 0.0:
            high = _extreme(ball, center, radius, 1.0, 0.0, early)
            first = _entry_between(ball, center, radius, 0.0, high)
        if rate_late < 0.0 and early < limit:
            low = _extreme(ball, center, radius, -1.0, early, late)
    if rate_late >= 0.0 or low >= limit:
        return first, NEVER
    high = late + FIRST_SPAN
    while approach(ball, center, high).rate < 0.0:
        if high > MAX_AGE:
            return first, NEVER
        high = late + 2.0 * (high - late)
    high = _extreme(ball, center, radius, 1.0, late, high)
    entry = _entry_between(ball, center, radius, low, high)
    return (first, entry) if is_later else (entry, NEVER)


@internal
def approach(ball: BallRecord, center: Center, age: float) -> Approach:
    """Compute how a flight approaches a centre at an age."""
    vx, vz = ball.start_vx + ball.accel_x * age, ball.start_vz + ball.accel_z * age
    x = ball.start_x - center.x + age * (ball.start_vx + 0.5 * ball.accel_x * age)
    z = ball.start_z - center.z + age * (ball.start_vz + 0.5 * ball.accel_z * age)
    return Approach(x * x + z * z, x * vx + z * vz, vx * vx + vz * vz, x * ball.accel_x + z * ball.accel_z)


@internal
def _entry_between(ball: BallRecord, center: Center, radius: float, low: float, high: float) -> float:
    """Compute when a flight, outside at one age and inside at another, enters the disc; NEVER if it is not.

    The steps are those of `flight.time_to_shape`: they never overshoot.
    """
    square = radius * radius
    if approach(ball, center, high).square >= square or approach(ball, center, low).square <= square:
        return NEVER
    time = low
    for _ in range(FLIGHT_STEPS):
        now = approach(ball, center, time)
        apart = sqrt(now.square)
        gap, rate = apart - radius, now.rate / apart
        if gap <= CONTACT_GAP and rate < 0.0:
            return newton_refined(time, gap, rate)
        time += time_to_line(gap if gap > 0.0 else 0.0, rate, now.pull / apart)
        time = min(time, high)
    return time  # a long graze, entered within rounding


@internal
def _extreme(ball: BallRecord, center: Center, radius: float, sign: float, low: float, high: float) -> float:
    """Compute the age between two others at which the distance is least (sign 1) or greatest (−1).

    It is a root of p·v. Where the flight is inside at its least distance, or outside at its greatest, any age
    will do at which it is. Newton's method; a step that leaves the bracket is replaced by bisection.
    """
    time = low
    for _ in range(ROOT_STEPS):
        now = approach(ball, center, time)
        if sign * (radius * radius - now.square) > 0.0:
            break
        if sign * now.rate < 0.0:
            low = time
        else:
            high = time
        before, slope = time, now.speed_square + now.pull
        time = time - now.rate / slope if slope != 0.0 else low
        if not low < time < high:
            time = low + 0.5 * (high - low)
        if abs(time - before) <= 4e-16 * time:
            break
    return time
