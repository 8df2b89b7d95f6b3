"""How does a ball move over the playfield: sliding, rolling or slipping?

A ball of radius r with velocity v and spin ω touches the playfield with its lowest point, which moves with

    u = v + ω × (−r·ŷ) = (vx + r·ω_z, vz − r·ω_x).

While u ≠ 0 the ball *slips*: friction accelerates it by f = −μ·p·u/|u| (p = the force onto the playfield by
the mass) and turns it, so that u changes by g + 7/2·f. Once u = 0 the ball *rolls*: friction is what keeps
it so, f = −2/7·g, and 5/7 of gravity is left. On a table without friction the ball *slides* with all of it.

The direction of slip is held from the beginning of a flight to its end, at most for a tick: the flight stays
a parabola, and friction never works the wrong way round, since the slip along the held direction has not
turned over before the flight ends. The error: gravity across the slip turns its direction by at most g·h/|u|
in a tick h, and friction by as much; where a slip ends, what is left across it, at most g·h, is taken away
at once (the ball rolls from there). Both go to zero with the tick.

Source of 2/7 and 5/7: moment of inertia 2/5·m·r² of a solid sphere; e.g. A. Sommerfeld, "Mechanics" (1952),
§ on the billiard ball. The spin about y turns on a point and is left alone.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.bounce import capped
from silverball.physics.flight import flown
from silverball.physics.kernel import inlined, internal
from silverball.physics.records import NOTHING, Ball, Motion
from silverball.physics.tolerances import CREEP, NEVER

ROLLING_SHARE = 5.0 / 7.0  # of the acceleration of a sliding ball
GRIP_SHARE = 3.5  # slip changes by this times friction: 1 by the ball's speed, 5/2 by its spin
LONGER = 1.0 + 1e-9  # for the rounding of a time


@inlined
def put(ball: Any, at: Ball) -> None:
    """Write a ball's place and velocity into its record."""
    ball.x, ball.z, ball.vx, ball.vz = at.x, at.z, at.vx, at.vz


@inlined
def depart(ball: Any, board: Any, offset: float) -> None:
    """Begin a new flight from where the ball's record says it is, so late in the tick [s]."""
    _begin(ball, offset)
    if board.press == 0.0:
        ball.pull_x, ball.pull_z, ball.motion = board.pull_x, board.pull_z, Motion.SLIDING + 0
        ball.grips = NEVER
    else:
        _take_grip(ball, board)


@internal
def hold(ball: Any, offset: float) -> None:
    """Let a ball stay where its record says it is, from so late in the tick [s] until `let_go`."""
    _begin(ball, offset)
    ball.pull_x, ball.pull_z, ball.motion, ball.grips, ball.due = 0.0, 0.0, Motion.HELD + 0, NEVER, NEVER


@inlined
def let_go(ball: Any, board: Any, tick: float) -> None:
    """Let a ball that was held move on from the end of the tick."""
    if ball.motion == Motion.HELD:
        depart(ball, board, tick)


@inlined
def turn_slip(ball: Any, board: Any) -> None:
    """Let a slipping ball's friction follow its slip again: the direction is held for a tick at most."""
    if ball.motion == Motion.SLIPPING and ball.id != 0:
        _begin(ball, 0.0)
        follow_slip(ball, board)


@inlined
def _begin(ball: Any, offset: float) -> None:
    ball.from_x, ball.from_z, ball.from_vx, ball.from_vz = ball.x, ball.z, ball.vx, ball.vz
    ball.ticks, ball.offset, ball.age = 0, offset, -offset
    search_anew(ball)


@inlined
def search_anew(ball: Any) -> None:
    """Forget what a flight is known to meet: it will be searched from its beginning."""
    ball.due, ball.meets = 0.0, NOTHING


@internal
def _take_grip(ball: Any, board: Any) -> None:
    """`follow_slip`, not compiled into its many callers."""
    follow_slip(ball, board)


@inlined
def follow_slip(ball: Any, board: Any) -> None:
    """Decide whether a ball on a playfield with friction slips or rolls, and its acceleration.

    Along its direction the slip falls from |u| at the rate  7/2·μ·p − g·u/|u|.
    """
    slip_x, slip_z = slip(ball, board)
    speed = sqrt(slip_x * slip_x + slip_z * slip_z)
    grip = board.friction * board.press
    ball.grips = NEVER
    if speed <= CREEP:
        if board.gravity <= GRIP_SHARE * grip:
            ball.motion = Motion.ROLLING + 0
            ball.pull_x, ball.pull_z = ROLLING_SHARE * board.pull_x, ROLLING_SHARE * board.pull_z
            return
        along_x, along_z = (
            board.pull_x / board.gravity,
            board.pull_z / board.gravity,
        )  # too smooth: it begins to slip
    else:
        inverse = 1.0 / speed
        along_x, along_z = slip_x * inverse, slip_z * inverse
        rate = GRIP_SHARE * grip - (board.pull_x * along_x + board.pull_z * along_z)
        if rate > 0.0:
            ball.grips = speed / rate
    ball.motion = Motion.SLIPPING + 0
    ball.pull_x = board.pull_x - grip * along_x
    ball.pull_z = board.pull_z - grip * along_z


@inlined
def slip(ball: Any, board: Any) -> tuple[float, float]:
    """Velocity [u/s] of the ball's lowest point, from its record."""
    return ball.vx + board.ball_radius * ball.spin_z, ball.vz - board.ball_radius * ball.spin_x


@inlined
def land(ball: Any, board: Any, age: float) -> None:
    """Bring the ball's record, spin included, to an age of its flight."""
    put(ball, flown(ball, age))
    if board.press != 0.0:
        _turn(ball, board, age)


@inlined
def _roll(ball: Any, board: Any) -> None:
    """Give a ball the spin with which its lowest point stands still."""
    ball.spin_x, ball.spin_z = ball.vz * board.curvature, -ball.vx * board.curvature


@inlined
def _turn(ball: Any, board: Any, age: float) -> None:
    """The spin at an age of the flight: of rolling, or changed by friction f:  dω/dt = 5/(2r)·(−f_z, f_x)."""
    if ball.motion == Motion.ROLLING:
        _roll(ball, board)
    elif ball.motion == Motion.SLIPPING:
        gain = 2.5 * age * board.curvature
        ball.spin_x -= gain * (ball.pull_z - board.pull_z)
        ball.spin_z += gain * (ball.pull_x - board.pull_x)


@internal
def begin_to_roll(ball: Any, board: Any) -> None:
    """Let a ball whose slip comes to its end roll: an impulse −2/7·u takes away what is left of it."""
    time = ball.due - ball.age
    land(ball, board, ball.due)
    slip_x, slip_z = slip(ball, board)
    ball.vx -= slip_x / GRIP_SHARE
    ball.vz -= slip_z / GRIP_SHARE
    _roll(ball, board)
    depart(ball, board, time)


@inlined
def end_flight(ball: Any, board: Any, tick: float, count: int) -> None:
    """Bring a ball to the end of a tick, or of several, and clamp its speed; else the flight goes on."""
    if ball.id == 0:
        return
    ball.ticks += count
    ball.age = ball.ticks * tick - ball.offset
    land(ball, board, ball.age)
    if ball.vx * ball.vx + ball.vz * ball.vz > board.speed_cap * board.speed_cap:
        ball.vx, ball.vz = capped(ball.vx, ball.vz, board.speed_cap)
        depart(ball, board, 0.0)


@inlined
def leads_here(ball: Any, tick: float) -> bool:
    """Whether the flight in a ball's record leads to where it is: not so after a change from outside."""
    at = flown(ball, ball.age)
    return (
        ball.x == at.x
        and ball.z == at.z
        and ball.vx == at.vx
        and ball.vz == at.vz
        and ball.age == ball.ticks * tick - ball.offset
    )


@internal
def is_lawful(ball: Any, board: Any, tick: float) -> bool:
    """Whether a ball moves as its board lets balls move, on a flight that began before this tick."""
    if not (0.0 <= ball.offset <= tick * LONGER and ball.age >= tick - tick * LONGER):
        return False
    if ball.motion == Motion.SLIPPING:
        return board.press != 0.0
    share = ROLLING_SHARE if ball.motion == Motion.ROLLING else 1.0
    if ball.pull_x != share * board.pull_x or ball.pull_z != share * board.pull_z or ball.grips != NEVER:
        return False
    if ball.motion == Motion.ROLLING:
        return board.press != 0.0 and not is_slipping(ball, board)
    return ball.motion == Motion.SLIDING and board.press == 0.0


@internal
def is_slipping(ball: Any, board: Any) -> bool:
    """Whether the lowest point of a ball rubs over the playfield."""
    slip_x, slip_z = slip(ball, board)
    return slip_x * slip_x + slip_z * slip_z > CREEP * CREEP
