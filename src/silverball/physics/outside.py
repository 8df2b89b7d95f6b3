"""Is a state that may come from outside one that can be, and is each ball on its flight?

A record that is as the last call left it, number for number, is believed; the log keeps what that is. Any
other one has come from outside: it was restored, copied, shoved, or somebody wrote numbers into it. Then the
balls must be where balls can be, or the world gets a named fault, and a flight is believed only if the search
from its beginning finds the same next contact. Else a new flight begins from where the ball is.
"""

from __future__ import annotations

from typing import Any

from silverball.physics.balls import clearance, part_balls
from silverball.physics.contact import search
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.layout import NOTHING, Fault, Motion, Part
from silverball.physics.motion import depart, is_on_flight
from silverball.physics.tolerances import DEEPEST, MOST_SEARCHES, NEVER


@inlined
def leave(world: Any, log: Any) -> None:
    """Keep in the log what a call leaves."""
    log.ball[0] = world.ball[0]
    log.ball[1] = world.ball[1]
    log.angle[0] = world.paddle[0].angle
    log.angle[1] = world.paddle[1].angle


@inlined
def is_as_left(world: Any, log: Any) -> bool:
    """Whether the balls and the paddles are as the last call left them."""
    return (
        world.paddle[0].angle == log.angle[0]
        and world.paddle[1].angle == log.angle[1]
        and is_same(world.ball[0], log.ball[0])
        and is_same(world.ball[1], log.ball[1])
    )


@inlined
def is_same(a: Any, b: Any) -> bool:
    """Whether two ball records are equal in every field."""
    return a.id == b.id and (
        a.id == 0
        or (
            a.x == b.x
            and a.z == b.z
            and a.vx == b.vx
            and a.vz == b.vz
            and a.spin_x == b.spin_x
            and a.spin_y == b.spin_y
            and a.spin_z == b.spin_z
            and a.from_x == b.from_x
            and a.from_z == b.from_z
            and a.from_vx == b.from_vx
            and a.from_vz == b.from_vz
            and a.pull_x == b.pull_x
            and a.pull_z == b.pull_z
            and a.motion == b.motion
            and a.grips == b.grips
            and a.ticks == b.ticks
            and a.offset == b.offset
            and a.age == b.age
            and a.due == b.due
            and a.meets == b.meets
        )
    )


@internal
def is_admitted(world: Any, board: Any, colliders: Any, grid: Any, tick: float) -> bool:
    """Whether a state from outside can be; if so each ball is on its flight now, else the fault is named."""
    if not is_sound(world, board) or not is_clear(world, board, colliders):
        return False
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id == 0 or (
            is_on_flight(ball, board, tick) and is_searched(board, colliders, grid, ball, tick)
        ):
            continue
        depart(ball, board, 0.0)
    return True


@internal
def is_searched(board: Any, colliders: Any, grid: Any, ball: Any, tick: float) -> bool:
    """Whether the next contact in a ball's record is what the searches from its flight's beginning find.

    A search is a function of the flight alone; only that of a slipping ball is not, whose flight begins anew
    in every tick.
    """
    if ball.motion == Motion.SLIPPING:
        return True
    due, meets = ball.due, ball.meets
    ball.due, ball.meets = 0.0, NOTHING
    for _ in range(MOST_SEARCHES):
        if ball.meets != NOTHING or not ball.due < due:
            break
        search(board, colliders, grid, ball, tick)
    return bool(ball.due == due and ball.meets == meets)


@kernel
def is_clear(world: Any, board: Any, colliders: Any) -> bool:
    """Whether the paddles are within their stops and no ball is inside anything; if not, it is a named fault.

    Two balls that overlap are parted, if there is room.
    """
    for side in range(2):
        c, angle = colliders[board.collider_first + Part.LEFT_PADDLE + side], world.paddle[side].angle
        if not min(c.angle_rest, c.angle_up) <= angle <= max(c.angle_rest, c.angle_up):
            world.fault = Fault.BEYOND_STOP + 0
            return False
    is_free = part_balls(world, board, colliders)
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id != 0:
            gap, _ = clearance(world, board, colliders, ball.x, ball.z)
            is_free = is_free and gap >= -DEEPEST
    if not is_free:
        world.fault = Fault.INSIDE + 0
    return is_free


@kernel
def is_sound(world: Any, board: Any) -> bool:
    """Whether the balls are where and as fast as they can be; if not, the world gets a named fault."""
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id == 0 or is_fair(ball, board):
            continue
        sum_of_all = ball.x + ball.z + ball.vx + ball.vz + ball.spin_x + ball.spin_y + ball.spin_z
        if not is_number(sum_of_all):
            world.fault = Fault.NOT_FINITE + 0
        elif not (abs(ball.x) <= board.half_length and abs(ball.z) <= board.half_width):
            world.fault = Fault.OUTSIDE + 0
        else:
            world.fault = Fault.TOO_FAST + 0
        return False
    if not (is_number(world.paddle[0].angle) and is_number(world.paddle[1].angle)):
        world.fault = Fault.NOT_FINITE + 0
        return False
    return True


@inlined
def is_fair(ball: Any, board: Any) -> bool:
    """Whether a ball is where and as fast as it can be."""
    inside = abs(ball.x) <= board.half_length and abs(ball.z) <= board.half_width
    fastest = board.speed_cap * (1.0 + 1e-9)
    slow = ball.vx * ball.vx + ball.vz * ball.vz <= fastest * fastest
    return inside and slow and is_number(ball.spin_x + ball.spin_y + ball.spin_z)


@inlined
def is_number(x: float) -> bool:
    """Whether x is finite: not so when it is infinite or no number at all."""
    return abs(x) < NEVER
