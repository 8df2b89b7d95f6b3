"""For how many ticks does nothing happen? Then the balls are flown through all of them at once.

A ball is always worked out from the beginning of its flight, so a leap over many ticks gives the same bits as
one tick after the other; only the paddles are moved tick by tick. Everything in here is a safe bound: a leap
may be shorter than it could be, never longer.
"""

from __future__ import annotations

from typing import Any

from silverball.physics.contact import is_near, search, way_in
from silverball.physics.flight import flight_to_ball, flown, time_to_line
from silverball.physics.kernel import inlined, internal
from silverball.physics.motion import begin_to_roll, turn_slip
from silverball.physics.records import GRIP, NOTHING, Motion, Playfield
from silverball.physics.tolerances import FREE_GAP

SHORTER = 1.0 - 1e-9  # a bound on a time is shortened by this share, so that its rounding cannot matter


@inlined
def begins_to_roll(ball: Any, tick: float) -> bool:
    """Whether the slip of a ball comes to its end in the next tick, before it meets anything."""
    return ball.meets == GRIP and ball.due < ball.age + tick and ball.id != 0


@inlined
def is_undisturbed(playfield: Playfield, ball: Any, tick: float) -> bool:
    """Whether a ball meets nothing in the next tick, the other ball left aside."""
    if ball.id == 0:
        return True
    end = ball.age + tick
    if ball.due < end and ball.meets == NOTHING:
        search(playfield, ball, tick)
    if ball.due < end and ball.meets != GRIP:
        return False
    board = playfield.board
    share = 1.0 if ball.due >= end else 2.0  # room to spare for a ball that changes its flight on the way
    if ball.x + share * tick * (min(ball.vx, 0.0) - board.steepest * tick) > board.paddle_top:
        return True
    way = share * tick * (abs(ball.vx) + abs(ball.vz) + board.steepest * tick)
    return not (
        is_near(ball.x, ball.z, board.left_x, board.left_z, board.left_reach + way)
        or is_near(ball.x, ball.z, board.right_x, board.right_z, board.right_reach + way)
    )


@inlined
def are_apart(board: Any, a: Any, b: Any, tick: float, share: float) -> bool:
    """Whether the balls are too far from each other to meet in the next tick, with so much room to spare."""
    if a.id == 0 or b.id == 0:
        return True
    dx, dz = a.x - b.x, a.z - b.z
    reach = 2.0 * (board.ball_radius + share * way_in(board, 0.0, tick))
    return dx * dx + dz * dz > reach * reach


@internal
def rolls_on(playfield: Playfield, ball: Any, tick: float) -> bool:
    """Let a ball begin to roll in the next tick, far from everything else; whether it meets nothing then."""
    begin_to_roll(ball, playfield.board)
    search(playfield, ball, tick)
    return ball.due >= ball.age + tick


@inlined
def undisturbed_ticks(board: Any, ball: Any, tick: float, most: int) -> int:
    """For how many ticks, at least one, a ball undisturbed in the next one goes on, the other left aside.

    Until its contact is due, it can be in reach of a paddle, or its speed reaches the cap.
    """
    if ball.id == 0 or most == 1:
        return most
    if ball.motion == Motion.SLIPPING:
        return 1
    if ball.x <= board.paddle_top:
        return 1
    above = time_to_line(ball.x - board.paddle_top, ball.vx, -board.steepest)
    free = min(above, ball.due - ball.age) * SHORTER
    count = int(free / tick) if free < most * tick else most
    end = flown(ball, ball.age + count * tick)
    below = board.speed_cap * board.speed_cap * SHORTER  # of squares, which are greatest at one of the ends
    is_slow = ball.vx * ball.vx + ball.vz * ball.vz < below and end.vx * end.vx + end.vz * end.vz < below
    return max(count, 1) if is_slow and end.x > -board.half_length else 1


@internal
def free_ticks(playfield: Playfield, a: Any, b: Any, tick: float, most: int) -> int:
    """For how many of the next ticks, at most `most`, nothing happens to the balls."""
    board = playfield.board
    turn_slip(a, board)
    turn_slip(b, board)
    if not (is_undisturbed(playfield, a, tick) and is_undisturbed(playfield, b, tick)):
        return 0
    change_a, change_b = begins_to_roll(a, tick), begins_to_roll(b, tick)
    # Twice the room: should b refuse after a has begun to roll, the tick is played with a's new flight, which
    # must not be looked at before it began.
    if not are_apart(board, a, b, tick, 2.0 if change_a or change_b else 1.0):
        return 0
    if change_a and not rolls_on(playfield, a, tick):
        return 0
    if change_b and not rolls_on(playfield, b, tick):
        return 0
    count = undisturbed_ticks(board, a, tick, most)
    count = undisturbed_ticks(board, b, tick, count)
    if count == 1 or a.id == 0 or b.id == 0:
        return count
    at_a, at_b = flown(a, a.age), flown(b, b.age)
    bend_x, bend_z = a.pull_x - b.pull_x, a.pull_z - b.pull_z
    end = count * tick
    meeting = flight_to_ball(at_a, at_b, bend_x, bend_z, board.ball_radius + FREE_GAP, end)
    return count if meeting.part == NOTHING else max(1, int(meeting.time * SHORTER / tick))
