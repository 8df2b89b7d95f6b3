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
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import BallRecord, ColliderRecord
from silverball.physics.shapes import point_distance
from silverball.physics.tolerances import CONTACT_GAP, CROSSED_GAP, FLIGHT_STEPS, NEVER

ROOT_STEPS = 100  # more than bisection needs within a flight; Newton takes some 5
FIRST_SPAN = 0.125  # [s] first guess of how long after t₂ a flight is closest to a disc
MAX_SPAN = 1e9  # [s] later closest points are ignored: the ball hardly moves


class Path(NamedTuple):
    """A flight relative to a point: position [u], velocity [u/s] and acceleration [u/s²] at its start."""

    x: float
    z: float
    vx: float
    vz: float
    accel_x: float
    accel_z: float


@kernel
def line_crossing(
    c: ColliderRecord, ball: BallRecord, start: float, is_past_start: bool, limit: float
) -> tuple[float, int]:
    """Find when a ball's centre next crosses a line, the segment from corner 0 to corner 1.

    Args:
        c: The line: x0, z0, along_x0, along_z0, length0.
        ball: The ball.
        start: The age at which the search starts [s].
        is_past_start: Whether a crossing at exactly this age has been handled.
        limit: The age at which the search ends [s].

    Returns:
        The age and the direction: 1 towards the left of corner 0 → corner 1 as the player sees it, −1 towards
        the right. Without a crossing before the limit: the limit and 0.
    """
    left_x, left_z = c.along_z0, -c.along_x0
    gap = (ball.start_x - c.x0) * left_x + (ball.start_z - c.z0) * left_z
    rate = ball.start_vx * left_x + ball.start_vz * left_z
    gap_accel = ball.accel_x * left_x + ball.accel_z * left_z
    to_right, to_left = falling_time(gap, rate, gap_accel), falling_time(-gap, -rate, -gap_accel)
    if to_right < NEVER and to_left < NEVER and (to_right - to_left) * gap_accel >= 0.0:
        return limit, 0  # a graze: rounding has put the two crossings at one age, or in the wrong order
    if abs(gap) <= CROSSED_GAP:
        if rate <= 0.0:
            to_right = NEVER
        if rate >= 0.0:
            to_left = NEVER
    time, direction = limit, 0
    if _is_due(to_right, start, is_past_start, time) and _is_between_ends(c, ball, to_right):
        time, direction = to_right, -1
    if _is_due(to_left, start, is_past_start, time) and _is_between_ends(c, ball, to_left):
        time, direction = to_left, 1
    return time, direction


@inlined
def falling_time(gap: float, rate: float, gap_accel: float) -> float:
    """Compute the time [s] at which a gap's parabola falls through zero; it may be negative.

    A parabola does so once at most, with the rate −√Δ (see `flight.time_to_line`). The result is NEVER where
    it only touches zero, and where it fell through zero in the past and does not fall now.
    """
    discriminant = rate * rate - 2.0 * gap_accel * gap
    if discriminant <= 0.0:
        return NEVER
    if rate < 0.0:
        return 2.0 * gap / (sqrt(discriminant) - rate)
    return (rate + sqrt(discriminant)) / -gap_accel if gap_accel < 0.0 else NEVER


@inlined
def _is_due(time: float, start: float, is_past_start: bool, limit: float) -> bool:
    return start <= time < limit and not (is_past_start and time == start)


@inlined
def _is_between_ends(c: ColliderRecord, ball: BallRecord, age: float) -> bool:
    at = state_at(ball, age)
    return 0.0 <= (at.x - c.x0) * c.along_x0 + (at.z - c.z0) * c.along_z0 <= c.length0


@kernel
def disc_entry(
    c: ColliderRecord, ball: BallRecord, start: float, is_past_start: bool, limit: float
) -> tuple[float, bool]:
    """Find when a ball's centre next enters a disc.

    Args:
        c: The disc: x, z, radius.
        ball: The ball.
        start: The age at which the search starts [s].
        is_past_start: Whether an entry at exactly this age has been handled.
        limit: The age at which the search ends [s].

    Returns:
        The age and True; or the limit and False.
    """
    now = state_at(ball, start)
    gap, nx, nz = point_distance(now.x, now.z, c.x, c.z)
    gap -= c.radius + CROSSED_GAP
    rate, gap_accel = nx * now.vx + nz * now.vz, nx * ball.accel_x + nz * ball.accel_z
    if gap > 0.0 and stays_open(gap, rate, gap_accel, limit - start):
        return limit, False
    path = path_from(ball, c.x, c.z)
    first, second = disc_entries(path, c.radius, limit)
    if sqrt(path.x * path.x + path.z * path.z) - c.radius <= CROSSED_GAP:
        first = NEVER
    if _is_due(first, start, is_past_start, limit):
        return first, True
    if _is_due(second, start, is_past_start, limit):
        return second, True
    return limit, False


@inlined
def path_from(ball: BallRecord, x: float, z: float) -> Path:
    """The flight of a ball relative to a point."""
    return Path(ball.start_x - x, ball.start_z - z, ball.start_vx, ball.start_vz, ball.accel_x, ball.accel_z)


@internal
def disc_entries(path: Path, radius: float, limit: float) -> tuple[float, float]:
    """Compute the ages [s] at which a flight enters a disc around the origin; NEVER if it does not.

    Half the derivative of |p|² is the cubic p·v. Its derivative v² + p·a is a quadratic with the roots
    t₁ ≤ t₂, if any: p·v rises up to t₁, falls up to t₂, and rises from there. So the distance falls at most
    twice, down to a minimum before t₁ and to one after t₂, and is monotonic in between. There is one entry in
    a fall from outside to inside.

    Args:
        path: The flight relative to the centre of the disc.
        radius: The radius of the disc [u].
        limit: Entries after this age are not needed.

    Returns:
        The entry in a fall that begins with the flight, and that in a later one.
    """
    early, late = _inflections(path)
    first, low = NEVER, 0.0
    is_later = _approach(path, early) > 0.0
    if is_later:  # there is a minimum before `early`, or the flight starts outwards
        if _approach(path, 0.0) < 0.0:
            first = _entry_between(path, radius, 0.0, _extreme(path, radius, True, 0.0, early))
        if _approach(path, late) >= 0.0 or early >= limit:
            return first, NEVER
        low = _extreme(path, radius, False, early, late)  # the greatest distance between the two minima
    elif _approach(path, late) >= 0.0:
        return NEVER, NEVER
    span = FIRST_SPAN
    while _approach(path, late + span) < 0.0:
        if span > MAX_SPAN:
            return first, NEVER
        span *= 2.0
    entry = _entry_between(path, radius, low, _extreme(path, radius, True, late, late + span))
    return (first, entry) if is_later else (entry, NEVER)


@inlined
def _inflections(path: Path) -> tuple[float, float]:
    """Compute the ages t₁ ≤ t₂ between which p·v falls, cut off at 0; both 0 if it never does.

    v² + p·a = (v₀² + p₀·a) + 3·(v₀·a)·t + 3/2·a²·t²
    """
    square = 1.5 * (path.accel_x * path.accel_x + path.accel_z * path.accel_z)
    half = 1.5 * (path.vx * path.accel_x + path.vz * path.accel_z)
    rest = path.vx * path.vx + path.vz * path.vz + path.x * path.accel_x + path.z * path.accel_z
    discriminant = half * half - square * rest
    if square == 0.0 or discriminant <= 0.0:
        return 0.0, 0.0
    # The form without cancellation for each root.
    if half > 0.0:
        q = -half - sqrt(discriminant)
        early, late = q / square, rest / q
    else:
        q = -half + sqrt(discriminant)
        early, late = rest / q, q / square
    return max(early, 0.0), max(late, 0.0)


@inlined
def _approach(path: Path, age: float) -> float:
    """Compute p·v at an age: negative while the ball approaches the origin."""
    return (path.x + age * (path.vx + 0.5 * path.accel_x * age)) * (path.vx + path.accel_x * age) + (
        path.z + age * (path.vz + 0.5 * path.accel_z * age)
    ) * (path.vz + path.accel_z * age)


@internal
def _entry_between(path: Path, radius: float, low: float, high: float) -> float:
    """Compute when a flight, outside at one age and inside at another, enters the disc; NEVER if it is not.

    The steps are those of `flight.time_to_shape`: they never overshoot.
    """
    if not (_excess(path, radius, low) > 0.0 and _excess(path, radius, high) < 0.0):
        return NEVER
    time = low
    for _ in range(FLIGHT_STEPS):
        vx, vz = path.vx + path.accel_x * time, path.vz + path.accel_z * time
        x = path.x + time * (path.vx + 0.5 * path.accel_x * time)
        z = path.z + time * (path.vz + 0.5 * path.accel_z * time)
        gap, nx, nz = point_distance(x, z, 0.0, 0.0)
        gap -= radius
        rate = nx * vx + nz * vz
        if gap <= CONTACT_GAP and rate < 0.0:
            return newton_refined(time, gap, rate)
        step = time_to_line(max(gap, 0.0), rate, nx * path.accel_x + nz * path.accel_z)
        time = min(time + step, high)
    return time  # a long graze, entered within rounding


@inlined
def _excess(path: Path, radius: float, age: float) -> float:
    """Compute |p|² − radius² at an age."""
    x = path.x + age * (path.vx + 0.5 * path.accel_x * age)
    z = path.z + age * (path.vz + 0.5 * path.accel_z * age)
    return x * x + z * z - radius * radius


@internal
def _extreme(path: Path, radius: float, is_minimum: bool, low: float, high: float) -> float:
    """Compute the age between two others at which the distance is least or greatest, a root of p·v.

    Where the flight is inside at its least distance, or outside at its greatest, any age will do at which it
    is. Newton's method; a step that leaves the bracket is replaced by bisection.
    """
    time = low
    for _ in range(ROOT_STEPS):
        excess = _excess(path, radius, time)
        if (is_minimum and excess < 0.0) or (not is_minimum and excess > 0.0):
            return time
        value = _approach(path, time)
        if (value < 0.0) == is_minimum:
            low = time
        else:
            high = time
        before, slope = time, _approach_rate(path, time)
        time = time - value / slope if slope != 0.0 else low
        if not low < time < high:
            time = low + 0.5 * (high - low)
        if abs(time - before) <= 4e-16 * time:
            return time
    return time


@inlined
def _approach_rate(path: Path, age: float) -> float:
    """Compute the derivative of p·v:  v² + p·a."""
    vx, vz = path.vx + path.accel_x * age, path.vz + path.accel_z * age
    x = path.x + age * (path.vx + 0.5 * path.accel_x * age)
    z = path.z + age * (path.vz + 0.5 * path.accel_z * age)
    return vx * vx + vz * vz + x * path.accel_x + z * path.accel_z
