"""Skip-ahead: the number of event-free ticks, through which the balls are advanced at once.

A ball's state is always computed from the start of its flight, so skipping many ticks gives the same bits as
one tick after the other; only the paddles are advanced tick by tick. Everything in this file is a safe bound:
a skip may be shorter than possible, never longer.
"""

from __future__ import annotations

from silverball.physics.broad_phase import is_near, max_travel
from silverball.physics.contact import find_contact
from silverball.physics.devices import ticks_to_clock
from silverball.physics.flight import contact_with_ball, state_at, time_to_line
from silverball.physics.for_devices import ball_slots, is_captured, paddle_count, switches_off
from silverball.physics.kernel import inlined, internal
from silverball.physics.motion import start_rolling
from silverball.physics.records import (
    NOTHING,
    ROLL_START,
    BallRecord,
    BoardGeometry,
    BoardRecord,
    Motion,
    Part,
    WorldRecord,
)
from silverball.physics.tolerances import FREE_GAP

SHORTER = 1.0 - 1e-9  # factor on time bounds, so that their rounding cannot matter


@inlined
def starts_rolling_next(ball: BallRecord, tick: float) -> bool:
    """Whether a ball's slip ends in the next tick, before it meets anything."""
    return ball.contact_row == ROLL_START and ball.contact_age < ball.age + tick and ball.id != 0


@inlined
def is_undisturbed(geometry: BoardGeometry, ball: BallRecord, off: int, tick: float) -> bool:
    """Whether a ball meets nothing in the next tick, apart from other balls."""
    if ball.id == 0 or is_captured(ball):
        return True
    end = ball.age + tick
    if ball.contact_age < end and ball.contact_row == NOTHING:
        find_contact(geometry, ball, off, tick)
    if ball.contact_age < end and ball.contact_row != ROLL_START:
        return False
    board = geometry.board
    margin = 1.0 if ball.contact_age >= end else 2.0  # a ball that starts to roll changes its flight
    if ball.x + margin * tick * (min(ball.vx, 0.0) - board.max_accel * tick) > board.paddle_top:
        return True
    travel = margin * tick * (abs(ball.vx) + abs(ball.vz) + board.max_accel * tick)
    first = board.collider_first + Part.FIRST_PADDLE
    for number in range(paddle_count(ball, board)):
        c = geometry.colliders[first + number]
        if is_near(ball.x, ball.z, c.sweep_x, c.sweep_z, c.sweep_reach + travel):
            return False
    return True


@inlined
def cannot_meet(board: BoardRecord, a: BallRecord, b: BallRecord, tick: float, margin: float) -> bool:
    """Whether the balls are too far apart to meet in the next tick; `margin` scales the travel assumed."""
    if a.id == 0 or b.id == 0:
        return True
    dx, dz = a.x - b.x, a.z - b.z
    reach = 2.0 * (board.ball_radius + margin * max_travel(board, 0.0, tick))
    return dx * dx + dz * dz > reach * reach


@internal
def rolls_undisturbed(geometry: BoardGeometry, ball: BallRecord, off: int, tick: float) -> bool:
    """Start the roll that is due in the next tick; return whether the ball then meets nothing in it."""
    start_rolling(ball, geometry.board)
    find_contact(geometry, ball, off, tick)
    return ball.contact_age >= ball.age + tick


@inlined
def undisturbed_ticks(board: BoardRecord, ball: BallRecord, tick: float, limit: int) -> int:
    """Compute a lower bound, at least one, of the ticks for which a ball stays undisturbed.

    The ball must be undisturbed in the next tick. The bound is the first time at which its contact is due, a
    paddle can be in reach, or its speed reaches the cap. Other balls are ignored.
    """
    if ball.id == 0 or limit == 1 or is_captured(ball):
        return limit
    if ball.motion == Motion.SLIPPING:
        return 1
    if ball.x <= board.paddle_top:
        return 1
    above = time_to_line(ball.x - board.paddle_top, ball.vx, -board.max_accel)
    free = min(above, ball.contact_age - ball.age) * SHORTER
    count = int(free / tick) if free < limit * tick else limit
    end = state_at(ball, ball.age + count * tick)
    # The square of the speed is greatest at one of the ends.
    max_square = board.speed_cap * board.speed_cap * SHORTER
    is_slow = (
        ball.vx * ball.vx + ball.vz * ball.vz < max_square and end.vx * end.vx + end.vz * end.vz < max_square
    )
    return max(count, 1) if is_slow and end.x > -board.half_length else 1


@internal
def event_free_ticks(geometry: BoardGeometry, world: WorldRecord, tick: float, limit: int) -> int:
    """Compute how many of the next ticks, at most `limit`, are free of events."""
    board = geometry.board
    slots = ball_slots(world, board)
    limit = min(limit, ticks_to_clock(world))
    if limit <= 0:
        return 0
    off = switches_off(world)
    changes = False
    for slot in range(slots):
        if not is_undisturbed(geometry, world.ball[slot], off, tick):
            return 0
        changes = changes or starts_rolling_next(world.ball[slot], tick)
    # Twice the distance: if one ball does not roll undisturbed although another one already rolls, the tick
    # is played with that one's new flight, which must not be evaluated before it began.
    margin = 2.0 if changes else 1.0
    for other in range(1, slots):
        for one in range(other):
            if not cannot_meet(board, world.ball[one], world.ball[other], tick, margin):
                return 0
    if changes:
        for slot in range(slots):
            ball = world.ball[slot]
            if starts_rolling_next(ball, tick) and not rolls_undisturbed(geometry, ball, off, tick):
                return 0
    count = limit
    for slot in range(slots):
        count = undisturbed_ticks(board, world.ball[slot], tick, count)
    if count == 1:
        return count
    for other in range(1, slots):
        for one in range(other):
            a, b = world.ball[one], world.ball[other]
            if a.id != 0 and b.id != 0:
                count = apart_ticks(board, a, b, tick, count)
    return count


@inlined
def apart_ticks(board: BoardRecord, a: BallRecord, b: BallRecord, tick: float, limit: int) -> int:
    """Compute a lower bound, at least one, of the ticks for which two balls do not meet."""
    at_a, at_b = state_at(a, a.age), state_at(b, b.age)
    accel_x, accel_z = a.accel_x - b.accel_x, a.accel_z - b.accel_z
    end = limit * tick
    contact = contact_with_ball(at_a, at_b, accel_x, accel_z, board.ball_radius + FREE_GAP, end)
    return limit if contact.row == NOTHING else max(1, int(contact.time * SHORTER / tick))
