"""For how many ticks does nothing happen? Then the balls are flown through all of them at once.

A ball is always worked out from the beginning of its flight, so a leap over many ticks gives the same bits as
one tick after the other; only the paddles are moved tick by tick. Everything in here is a safe bound: a leap
may be shorter than it could be, never longer.
"""

from __future__ import annotations

from typing import Any

from silverball.physics.contact import is_near, search, way_in
from silverball.physics.flight import flight_to_ball, flown, time_to_line
from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import GRIP, NOTHING, Motion
from silverball.physics.motion import begin_to_roll, depart

SHORTER = 1.0 - 1e-9  # a bound on a time is shortened by this share, so that its rounding cannot matter


@inlined
def turn_slip(board: Any, ball: Any) -> None:
    """Let a slipping ball's friction follow its slip again: the direction is held for a tick at most."""
    if ball.motion == Motion.SLIPPING and ball.id != 0:
        depart(ball, board, 0.0)


@inlined
def is_undisturbed(board: Any, colliders: Any, grid: Any, ball: Any, tick: float) -> bool:
    """Whether a ball meets nothing in the next tick, the other ball left aside."""
    if ball.id == 0:
        return True
    end = (ball.ticks + 1) * tick - ball.offset
    if ball.due < end and ball.meets == NOTHING:
        search(board, colliders, grid, ball, tick)
    if ball.due < end and ball.meets != GRIP:
        return False
    if ball.x + tick * (min(ball.vx, 0.0) - board.steepest * tick) <= board.paddle_top:
        way = tick * (abs(ball.vx) + abs(ball.vz) + board.steepest * tick)
        if is_near(ball.x, ball.z, board.left_x, board.left_z, board.left_reach + way) or is_near(
            ball.x, ball.z, board.right_x, board.right_z, board.right_reach + way
        ):
            return False
    if ball.due < end:  # far from the rest a change from slipping to rolling needs no more than this
        begin_to_roll(ball, board)
        search(board, colliders, grid, ball, tick)
        return ball.due >= tick - ball.offset
    return True


@inlined
def are_apart(board: Any, a: Any, b: Any, tick: float) -> bool:
    """Whether the balls are too far from each other to meet in the next tick."""
    if a.id == 0 or b.id == 0:
        return True
    dx, dz = a.x - b.x, a.z - b.z
    reach = 2.0 * (board.ball_radius + way_in(board, 0.0, tick))
    return dx * dx + dz * dz > reach * reach


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
    is_slow = end.vx * end.vx + end.vz * end.vz < board.speed_cap * board.speed_cap * SHORTER
    return max(count, 1) if is_slow else 1


@kernel
def free_ticks(board: Any, colliders: Any, grid: Any, a: Any, b: Any, tick: float, most: int) -> int:
    """For how many of the next ticks, at most `most`, nothing happens to the balls."""
    turn_slip(board, a)
    turn_slip(board, b)
    if not (
        is_undisturbed(board, colliders, grid, a, tick)
        and is_undisturbed(board, colliders, grid, b, tick)
        and are_apart(board, a, b, tick)
    ):
        return 0
    count = undisturbed_ticks(board, a, tick, most)
    count = undisturbed_ticks(board, b, tick, count)
    if count == 1 or a.id == 0 or b.id == 0:
        return count
    at_a, at_b = flown(a, a.age), flown(b, b.age)
    bend_x, bend_z = a.pull_x - b.pull_x, a.pull_z - b.pull_z
    end = count * tick
    meeting = flight_to_ball(at_a, at_b, bend_x, bend_z, board.ball_radius, end)
    return count if meeting.part == NOTHING else max(1, int(meeting.time * SHORTER / tick))
