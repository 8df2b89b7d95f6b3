"""Is a state that may come from outside one that can be, and is each ball on its flight?

What the last call left goes on; the log keeps a mark of it. Anything else has come from outside: it was
restored, copied, shoved, or somebody wrote numbers into it. Then the balls must be where balls can be, or the
world gets a named fault. A flight that leads to where its ball is goes on, but its next contact is searched
for again from the flight's beginning; a search is a function of the flight alone, so a world that is restored
comes to the same bits. A ball on no such flight begins a new one from where it is.
"""

from __future__ import annotations

from typing import Any

from silverball.physics.balls import part_balls
from silverball.physics.contact import is_near
from silverball.physics.event_log import mark
from silverball.physics.grid import cell_of
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import depart, is_lawful, leads_here, search_anew
from silverball.physics.paddle import paddle_distance
from silverball.physics.records import Fault, Part, Playfield
from silverball.physics.shapes import distance
from silverball.physics.tolerances import DEEPEST, NEVER


@inlined
def is_as_left(world: Any, board: Any, log: Any, tick: float) -> bool:
    """Whether the balls are on the flights, and the paddles at the angles, that the last call left."""
    return (
        mark(world) == log.mark
        and goes_on(world.ball[0], board, tick)
        and goes_on(world.ball[1], board, tick)
    )


@inlined
def goes_on(ball: Any, board: Any, tick: float) -> bool:
    """Whether a ball is on a flight that has not come to its end yet; an empty slot is."""
    return ball.id == 0 or (
        ball.age <= ball.due
        and leads_here(ball, tick)
        and is_number(ball.spin_x + ball.spin_y + ball.spin_z)
        and (board.press == 0.0 or is_lawful(ball, board, tick))  # its spin may be another one
    )


@internal
def is_admitted(world: Any, playfield: Playfield, tick: float) -> bool:
    """Whether a state from outside can be, each ball on a flight of its own; if not, the fault is named."""
    board = playfield.board
    if not is_sound(world, board) or not is_clear(world, playfield):
        return False
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        if leads_here(ball, tick) and is_lawful(ball, board, tick):
            search_anew(ball)
        else:
            depart(ball, board, 0.0)
    return True


@internal
def is_clear(world: Any, playfield: Playfield) -> bool:
    """Whether the paddles are within their stops and no ball is inside anything; if not, it is a named fault.

    Two balls that overlap are parted, if there is room.
    """
    board, colliders = playfield.board, playfield.colliders
    for side in range(2):
        c, angle = colliders[board.collider_first + Part.LEFT_PADDLE + side], world.paddle[side].angle
        if not min(c.angle_rest, c.angle_up) <= angle <= max(c.angle_rest, c.angle_up):
            world.fault = Fault.BEYOND_STOP + 0
            return False
    is_free = part_balls(world, board, colliders)
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id != 0:
            is_free = is_free and is_in_no_part(world, playfield, ball.x, ball.z)
    if not is_free:
        world.fault = Fault.INSIDE + 0
    return bool(is_free)


@internal
def is_in_no_part(world: Any, playfield: Playfield, x: float, z: float) -> bool:
    """Whether a ball at (x, z) is inside no part, paddles as they stand."""
    board, colliders, grid = playfield.board, playfield.colliders, playfield.grid
    if min(z - board.low_z, board.high_z - z, board.top_x - x) < -DEEPEST:
        return False
    least = board.ball_radius - DEEPEST
    cell = cell_of(board, x, z)
    for entry in range(grid[cell], grid[cell + 1]):
        gap, _, _ = distance(colliders[board.collider_first + grid[entry]], x, z)
        if gap < least:
            return False
    for side in range(2):
        c = colliders[board.collider_first + Part.LEFT_PADDLE + side]
        if is_near(x, z, c.x, c.z, c.reach + board.ball_radius):
            gap, _, _ = paddle_distance(c, world.paddle[side].angle, x, z)
            if gap < least:
                return False
    return True


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
