"""Spinners: blades that turn after a ball has passed, in closed form.

A ball that crosses the line of a spinner with the normal speed v sets the angular velocity of its blade to
ω₀ = v/h, h being half of the blade's height. Damping k [1/s] slows the blade, dω/dt = −k·ω:

    ω(t) = ω₀·e^(−k·t),    θ(t) = θ₀ + ω₀·(1 − e^(−k·t))/k.

Angles are measured from the position at rest, −π to π. The blade makes a turn whenever it passes the top, ±π.
The number-th turn is Δ = (2·number − 1)·π ∓ θ₀ ahead (− for ω₀ > 0), and takes place at

    t = −ln(1 − k·Δ/|ω₀|)/k,    if  k·Δ < |ω₀|.

`elapsed` and all times count from the last crossing [s].
"""

from __future__ import annotations

from math import floor, sqrt

from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import advance_to, start_flight
from silverball.physics.portable_math import exp, expm1, log1p
from silverball.physics.records import BallRecord, BoardRecord, ColliderRecord, SpinnerRecord, WorldRecord
from silverball.physics.tolerances import NEVER

PI = 3.141592653589793
TWO_PI = 6.283185307179586


@kernel
def blade_speed(speed: float, damping: float, elapsed: float) -> float:
    """Compute the angular velocity [rad/s] that is left of a blade's first one."""
    return speed * exp(-damping * elapsed)


@kernel
def blade_angle(angle: float, speed: float, damping: float, elapsed: float, turns: int) -> float:
    """Compute the angle of a blade [rad], −π to π.

    Args:
        angle: The angle at the crossing [rad].
        speed: The angular velocity after it [rad/s].
        damping: The rate at which the speed decays [1/s].
        elapsed: The time since the crossing [s].
        turns: Turns since then that have been counted. The angle never disagrees with them: rounding cannot
            put a blade on the other side of the top, where the same turn would be counted again.
    """
    decay = -expm1(-damping * elapsed) / damping if damping > 0.0 else elapsed
    back = turns * TWO_PI if speed > 0.0 else -turns * TWO_PI
    return min(max(angle + speed * decay - back, -PI), PI)


@kernel
def time_of_turn(angle: float, speed: float, damping: float, number: int) -> float:
    """Compute the time [s] of a turn after a crossing, the first being number 1; NEVER if it is not made."""
    if speed == 0.0:
        return NEVER
    time = _angle_to_turn(angle, speed, number) / abs(speed)
    if damping == 0.0:
        return time
    share = damping * time
    return -log1p(-share) / damping if share < 1.0 else NEVER


@kernel
def remaining_turns(angle: float, speed: float, damping: float, number: int) -> int:
    """Compute how many turns a blade makes after its number-th since the crossing, for damping > 0.

    The result agrees with `time_of_turn`: these turns have a time, the next one has none.
    """
    if speed == 0.0:
        return 0
    ahead = 0.5 + (abs(speed) / damping + (angle if speed > 0.0 else -angle)) / TWO_PI
    last = floor(ahead)
    if damping * (_angle_to_turn(angle, speed, last) / abs(speed)) >= 1.0:  # rounding, at most one turn
        last -= 1
    elif damping * (_angle_to_turn(angle, speed, last + 1) / abs(speed)) < 1.0:
        last += 1
    return max(last - number, 0)


@inlined
def _angle_to_turn(angle: float, speed: float, number: int) -> float:
    """Compute by what angle a blade turns from a crossing to a turn."""
    return (2 * number - 1) * PI - (angle if speed > 0.0 else -angle)


@kernel
def slowed_by_blade(vx: float, vz: float, drag: float) -> tuple[float, float]:
    """Take `drag` [u/s] from a ball's speed; a slower ball stops."""
    speed = sqrt(vx * vx + vz * vz)
    if speed <= drag:
        return 0.0, 0.0
    share = (speed - drag) / speed
    return vx * share, vz * share


@internal
def drive_spinner(
    world: WorldRecord,
    board: BoardRecord,
    ball: BallRecord,
    c: ColliderRecord,
    speed: float,
    time: float,
    tick: float,
) -> None:
    """Set the speed of a spinner's blade by a ball that crosses it with this normal speed [u/s]."""
    spinner = world.spinner[c.number]
    elapsed = (world.tick - spinner.tick) * tick + (time - spinner.offset)
    spinner.angle = blade_angle(spinner.angle, spinner.speed, c.damping, max(elapsed, 0.0), spinner.turns)
    spinner.speed = speed / c.blade
    spinner.tick, spinner.offset, spinner.turns = world.tick, time, 0
    if c.drag > 0.0:
        advance_to(ball, board, ball.age + time)
        ball.vx, ball.vz = slowed_by_blade(ball.vx, ball.vz, c.drag)
        start_flight(ball, board, time)


@inlined
def time_of_next_turn(spinner: SpinnerRecord, c: ColliderRecord, now: int, tick: float) -> float:
    """Compute the time of a spinner's next turn, from the start of the tick `now` [s]; NEVER for none."""
    turn = time_of_turn(spinner.angle, spinner.speed, c.damping, spinner.turns + 1)
    return spinner.offset + turn - (now - spinner.tick) * tick if turn < NEVER else NEVER


@internal
def is_possible_spinner(
    spinner: SpinnerRecord, c: ColliderRecord, board: BoardRecord, now: int, tick: float
) -> bool:
    """Whether a spinner can have this state: all turns of the past were counted, and no others."""
    if not (abs(spinner.angle) < 3.2 and abs(spinner.speed) * c.blade <= board.speed_cap * 1.001):
        return False
    if not (0.0 <= spinner.offset <= tick and 0 <= spinner.tick <= now and spinner.turns >= 0):
        return False
    return spinner.speed == 0.0 or time_of_next_turn(spinner, c, now, tick) > -tick
