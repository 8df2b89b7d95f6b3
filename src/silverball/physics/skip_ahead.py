"""For how many ticks does nothing happen? Then the balls are flown through all of them at once.

A ball is always worked out from the beginning of its flight, so a leap over many ticks gives the same bits as
one tick after the other; only the paddles are moved tick by tick. Everything in here is a safe bound: a leap
may be shorter than it could be, never longer.
"""

from __future__ import annotations

from silverball.physics.broad_phase import is_near, max_travel
from silverball.physics.contact import find_contact
from silverball.physics.flight import contact_with_ball, state_at, time_to_line
from silverball.physics.kernel import inlined, internal
from silverball.physics.motion import restart_slip, start_rolling
from silverball.physics.records import NOTHING, ROLL_START, BallRecord, BoardGeometry, BoardRecord, Motion
from silverball.physics.tolerances import FREE_GAP

SHORTER = 1.0 - 1e-9  # a bound on a time is shortened by this share, so that its rounding cannot matter


@inlined
def starts_rolling_next(ball: BallRecord, tick: float) -> bool:
    """Whether the slip of a ball comes to its end in the next tick, before it meets anything."""
    return ball.contact_part == ROLL_START and ball.contact_age < ball.age + tick and ball.id != 0


@inlined
def is_undisturbed(geometry: BoardGeometry, ball: BallRecord, tick: float) -> bool:
    """Whether a ball meets nothing in the next tick, the other ball left aside."""
    if ball.id == 0:
        return True
    end = ball.age + tick
    if ball.contact_age < end and ball.contact_part == NOTHING:
        find_contact(geometry, ball, tick)
    if ball.contact_age < end and ball.contact_part != ROLL_START:
        return False
    board = geometry.board
    share = (
        1.0 if ball.contact_age >= end else 2.0
    )  # room to spare for a ball that changes its flight on the way
    if ball.x + share * tick * (min(ball.vx, 0.0) - board.max_accel * tick) > board.paddle_top:
        return True
    travel = share * tick * (abs(ball.vx) + abs(ball.vz) + board.max_accel * tick)
    return not (
        is_near(ball.x, ball.z, board.left_x, board.left_z, board.left_reach + travel)
        or is_near(ball.x, ball.z, board.right_x, board.right_z, board.right_reach + travel)
    )


@inlined
def cannot_meet(board: BoardRecord, a: BallRecord, b: BallRecord, tick: float, share: float) -> bool:
    """Whether the balls are too far from each other to meet in the next tick, with so much room to spare."""
    if a.id == 0 or b.id == 0:
        return True
    dx, dz = a.x - b.x, a.z - b.z
    reach = 2.0 * (board.ball_radius + share * max_travel(board, 0.0, tick))
    return dx * dx + dz * dz > reach * reach


@internal
def rolls_undisturbed(geometry: BoardGeometry, ball: BallRecord, tick: float) -> bool:
    """Let a ball begin to roll in the next tick, far from everything else; whether it meets nothing then."""
    start_rolling(ball, geometry.board)
    find_contact(geometry, ball, tick)
    return ball.contact_age >= ball.age + tick


@inlined
def undisturbed_ticks(board: BoardRecord, ball: BallRecord, tick: float, most: int) -> int:
    """For how many ticks, at least one, a ball undisturbed in the next one goes on, the other left aside.

    Until its contact is due, it can be in reach of a paddle, or its speed reaches the cap.
    """
    if ball.id == 0 or most == 1:
        return most
    if ball.motion == Motion.SLIPPING:
        return 1
    if ball.x <= board.paddle_top:
        return 1
    above = time_to_line(ball.x - board.paddle_top, ball.vx, -board.max_accel)
    free = min(above, ball.contact_age - ball.age) * SHORTER
    count = int(free / tick) if free < most * tick else most
    end = state_at(ball, ball.age + count * tick)
    below = board.speed_cap * board.speed_cap * SHORTER  # of squares, which are greatest at one of the ends
    is_slow = ball.vx * ball.vx + ball.vz * ball.vz < below and end.vx * end.vx + end.vz * end.vz < below
    return max(count, 1) if is_slow and end.x > -board.half_length else 1


@internal
def event_free_ticks(geometry: BoardGeometry, a: BallRecord, b: BallRecord, tick: float, most: int) -> int:
    """For how many of the next ticks, at most `most`, nothing happens to the balls."""
    board = geometry.board
    restart_slip(a, board)
    restart_slip(b, board)
    if not (is_undisturbed(geometry, a, tick) and is_undisturbed(geometry, b, tick)):
        return 0
    change_a, change_b = starts_rolling_next(a, tick), starts_rolling_next(b, tick)
    # Twice the room: should b refuse after a has begun to roll, the tick is played with a's new flight, which
    # must not be looked at before it began.
    if not cannot_meet(board, a, b, tick, 2.0 if change_a or change_b else 1.0):
        return 0
    if change_a and not rolls_undisturbed(geometry, a, tick):
        return 0
    if change_b and not rolls_undisturbed(geometry, b, tick):
        return 0
    count = undisturbed_ticks(board, a, tick, most)
    count = undisturbed_ticks(board, b, tick, count)
    if count == 1 or a.id == 0 or b.id == 0:
        return count
    at_a, at_b = state_at(a, a.age), state_at(b, b.age)
    accel_x, accel_z = a.accel_x - b.accel_x, a.accel_z - b.accel_z
    end = count * tick
    meeting = contact_with_ball(at_a, at_b, accel_x, accel_z, board.ball_radius + FREE_GAP, end)
    return count if meeting.part == NOTHING else max(1, int(meeting.time * SHORTER / tick))
