"""What does a ball meet next, and what comes of it?"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.bounce import bounced
from silverball.physics.flight import flight_to_shape, time_to_border
from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import GUTTER, NOTHING, PAUSE, Ball, Contact, EventKind, Kind, Paddle, Part
from silverball.physics.log import record
from silverball.physics.paddle import flight_to_paddle, surface_velocity


@inlined
def _reached(c: Any, ball: Ball, reach: float) -> bool:
    """Whether the circle around a part comes within the ball's reach: the broad phase."""
    dx = ball.x - c.x
    dz = ball.z - c.z
    bound = c.reach + reach
    return dx * dx + dz * dz < bound * bound


@inlined
def _earlier(best: Contact, time: float, part: int, nx: float, nz: float) -> Contact:
    return Contact(time, part, nx, nz) if time < best.time else best


@kernel
def first_contact(
    board: Any, colliders: Any, left: Paddle, right: Paddle, ball: Ball, limit: float
) -> Contact:
    """The first of all contacts of a ball with the parts and the gutter line before `limit` [s].

    At equal times the earlier part in the order of the table is met first, which is the same in the mirror;
    only of the two paddles, at the very same moment, the left one always comes first.
    """
    best = Contact(limit, NOTHING, 0.0, 0.0)
    if ball.id == 0:
        return best
    pull_x, pull_z, radius = board.pull_x, board.pull_z, board.ball_radius
    first = board.collider_first
    speed = sqrt(ball.vx * ball.vx + ball.vz * ball.vz)
    reach = radius + limit * (speed + 0.5 * limit * (abs(pull_x) + abs(pull_z)))

    low = colliders[first + Part.LEFT_WALL].z + radius
    if ball.z - reach + radius < low:
        best = _earlier(best, time_to_border(ball.z - low, ball.vz, pull_z), Part.LEFT_WALL + 0, 0.0, 1.0)
    high = colliders[first + Part.RIGHT_WALL].z - radius
    if ball.z + reach - radius > high:
        best = _earlier(
            best, time_to_border(high - ball.z, -ball.vz, -pull_z), Part.RIGHT_WALL + 0, 0.0, -1.0
        )
    top = colliders[first + Part.TOP_WALL].x - radius
    if ball.x + reach - radius > top:
        best = _earlier(best, time_to_border(top - ball.x, -ball.vx, -pull_x), Part.TOP_WALL + 0, -1.0, 0.0)
    if ball.x - reach < board.gutter:
        best = _earlier(best, time_to_border(ball.x - board.gutter, ball.vx, pull_x), GUTTER, 1.0, 0.0)

    for part in range(Part.LEFT_PADDLE, Part.FIRST_SHAPE):
        c = colliders[first + part]
        if c.kind == Kind.PADDLE and _reached(c, ball, reach):
            paddle = left if part == Part.LEFT_PADDLE else right
            found = flight_to_paddle(c, part, paddle, ball, pull_x, pull_z, radius, best.time)
            best = _earlier(best, found.time, found.part, found.nx, found.nz)

    for index in range(first + Part.FIRST_SHAPE, board.collider_end):
        c = colliders[index]
        if _reached(c, ball, reach):
            found = flight_to_shape(c, index - first, ball, pull_x, pull_z, radius, best.time)
            best = _earlier(best, found.time, found.part, found.nx, found.nz)
    return best


@kernel
def resolved(
    world: Any,
    board: Any,
    colliders: Any,
    log: Any,
    tally: Any,
    ball: Ball,
    contact: Contact,
    turn: float,
    offset: float,
) -> Ball:
    """The ball after its contact: bounced off a part, gone through the gutter, or unchanged after a pause.

    `turn` is the angular velocity of the paddle met [rad/s], `offset` the time since the tick began [s].
    """
    if contact.part == PAUSE:
        return ball
    if contact.part == GUTTER:
        world.drained += 1
        speed = -ball.vx
        record(log, EventKind.GUTTER, GUTTER, ball.id, world.tick, offset, ball.x, ball.z, 1.0, 0.0, speed)
        return Ball(0.0, 0.0, 0.0, 0.0, 0)
    c = colliders[board.collider_first + contact.part]
    ux, uz = 0.0, 0.0
    acceleration = sqrt(board.pull_x * board.pull_x + board.pull_z * board.pull_z)
    if c.kind == Kind.PADDLE and turn != 0.0:
        x = ball.x - board.ball_radius * contact.nx
        z = ball.z - board.ball_radius * contact.nz
        ux, uz = surface_velocity(c, turn, x, z)
        acceleration += turn * turn * c.reach
    after, speed = bounced(ball, contact, c, ux, uz, acceleration, board.hit_speed, board.speed_cap)
    kind = EventKind.TOUCH + 0
    if speed > board.hit_speed:
        kind = EventKind.HIT + 0
        world.score += c.points
        tally[contact.part] += 1
        count_hit(world, c.kind)
    else:
        world.touches += 1
    record(
        log, kind, contact.part, ball.id, world.tick, offset, ball.x, ball.z, contact.nx, contact.nz, speed
    )
    return after


@kernel
def count_hit(world: Any, kind: int) -> None:
    """One more hit of a kind of part."""
    if kind == Kind.WALL:
        world.wall_hits += 1
    elif kind == Kind.SLANT_WALL:
        world.slant_wall_hits += 1
    elif kind == Kind.PADDLE:
        world.paddle_hits += 1
    elif kind == Kind.TRIANGULAR_PRISM:
        world.triangular_prism_hits += 1
    else:
        world.cylinder_hits += 1
