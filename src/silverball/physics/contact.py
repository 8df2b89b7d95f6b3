"""What does a ball meet next, and what comes of it?

Still parts are searched for once a flight: the contact found, or the age up to which there is none, stays in
the ball's record until the flight ends. Paddles are searched for in every tick in which they are near.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.bounce import bounce
from silverball.physics.event_log import record
from silverball.physics.flight import flight_to_shape, flown, time_to_border
from silverball.physics.grid import cell_of
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import begin_to_roll, depart, land
from silverball.physics.paddle import flight_to_paddle, surface_velocity
from silverball.physics.records import (
    GRIP,
    GUTTER,
    NOTHING,
    PAUSE,
    Ball,
    Contact,
    EventKind,
    Kind,
    Lane,
    Motion,
    Paddle,
    Part,
    Playfield,
)
from silverball.physics.shapes import distance
from silverball.physics.tolerances import FLIGHT_STEPS, FREE_GAP


@kernel
def search(playfield: Playfield, ball: Any, tick: float) -> None:
    """Follow a ball's flight on from its age `due`, until a still part is met or `skin` [u] are gone.

    The flight of a slipping ball is followed to the end of the tick alone, where it ends. At equal times the
    earlier part in the order of the table is met first, which is the same in the mirror.
    """
    board, colliders, grid = playfield.board, playfield.colliders, playfield.grid
    start = ball.due
    here = flown(ball, start)
    speed = sqrt(here.vx * here.vx + here.vz * here.vz)
    span = board.search_time
    if ball.motion == Motion.SLIPPING:
        span = min(span, max(ball.age + tick - start, 0.0))
    mean = speed + 0.5 * board.steepest * span  # at most
    if mean * span > board.skin:
        span = board.skin / mean
    time, part = start + span, NOTHING
    if ball.grips < time:
        time, part = max(ball.grips, start), GRIP
    stray = 0.5 * board.steepest * span * span  # from the straight line, at most
    way = mean * span

    if here.z - way < board.low_z:
        at = start + time_to_border(here.z - board.low_z, here.vz, ball.pull_z)
        if at < time:
            time, part = at, Part.LEFT_WALL + 0
    if here.z + way > board.high_z:
        at = start + time_to_border(board.high_z - here.z, -here.vz, -ball.pull_z)
        if at < time:
            time, part = at, Part.RIGHT_WALL + 0
    if here.x + way > board.top_x:
        at = start + time_to_border(board.top_x - here.x, -here.vx, -ball.pull_x)
        if at < time:
            time, part = at, Part.TOP_WALL + 0
    if here.x - way < board.gutter:
        at = start + time_to_border(here.x - board.gutter, here.vx, ball.pull_x)
        if at < time:
            time, part = at, GUTTER

    reach = board.ball_radius + FREE_GAP
    cell = cell_of(board, here.x, here.z)
    for entry in range(grid[cell], grid[cell + 1]):
        index = board.collider_first + grid[entry]
        if is_passed_by(colliders[index], here, speed, reach + way, reach + stray):
            continue
        at, met = flight_to_shape(colliders[index], ball, board.ball_radius, start, time)
        if at < time:
            time, part = at, index - board.collider_first if met else NOTHING
    ball.due, ball.meets = time, part


@inlined
def is_passed_by(c: Any, here: Ball, speed: float, way: float, stray: float) -> bool:
    """Whether a ball that goes so far and strays so far from its straight line misses a part's circle.

    The line comes as near as  √(d² − (d·v)²/v²)  to the middle, or as d if it leads away.
    """
    dx, dz = here.x - c.x, here.z - c.z
    square = dx * dx + dz * dz
    if square > (c.reach + way) * (c.reach + way):
        return True
    outside = square - (c.reach + stray) * (c.reach + stray)
    toward = -(dx * here.vx + dz * here.vz)
    return outside > 0.0 and (toward <= 0.0 or outside * speed * speed > toward * toward)


@internal
def first_contact(
    playfield: Playfield, left: Paddle, right: Paddle, ball: Any, start: float, limit: float, tick: float
) -> Contact:
    """The first of all contacts of a ball between two times of the tick [s]; normals of still parts left out.

    Of a still part and a paddle at the very same moment the still part comes first, of two paddles the left.
    """
    if ball.id == 0:
        return Contact(limit, NOTHING, 0.0, 0.0)
    searches = 0
    while ball.meets == NOTHING and ball.due < ball.age + limit:
        if searches == FLIGHT_STEPS:
            return Contact(start, PAUSE, 0.0, 0.0)
        search(playfield, ball, tick)
        searches += 1
    board, colliders = playfield.board, playfield.colliders
    best = Contact(limit, NOTHING, 0.0, 0.0)
    if ball.meets != NOTHING:
        time = max(ball.due - ball.age, start)
        if time < limit:
            best = Contact(time, ball.meets, 0.0, 0.0)
    here = flown(ball, ball.age + start)
    span = best.time - start
    if here.x + span * (min(here.vx, 0.0) - board.steepest * span) > board.paddle_top:
        return best
    speed = sqrt(here.vx * here.vx + here.vz * here.vz)
    way = span * (speed + board.steepest * span)
    if is_near(here.x, here.z, board.left_x, board.left_z, board.left_reach + way):
        c = colliders[board.collider_first + Part.LEFT_PADDLE]
        best = flight_to_paddle(c, Part.LEFT_PADDLE + 0, left, ball, board.ball_radius, speed, start, best)
    if is_near(here.x, here.z, board.right_x, board.right_z, board.right_reach + way):
        c = colliders[board.collider_first + Part.RIGHT_PADDLE]
        best = flight_to_paddle(c, Part.RIGHT_PADDLE + 0, right, ball, board.ball_radius, speed, start, best)
    return best


@inlined
def is_near(x: float, z: float, px: float, pz: float, reach: float) -> bool:
    """Whether two points are closer to each other than a reach that is positive."""
    return (x - px) * (x - px) + (z - pz) * (z - pz) < reach * reach


@inlined
def way_in(board: Any, start: float, end: float) -> float:
    """A bound on a ball's way [u] between two times of a tick [s] that it began below the speed cap."""
    return (end - start) * (board.speed_cap * (1.0 + 1e-9) + board.steepest * end)


@internal
def resolve(lane: Lane, playfield: Playfield, ball: Any, contact: Contact, turn: float) -> None:
    """Let a contact happen: the ball bounces off a part, begins to roll, or is gone through the gutter.

    `turn` is the angular velocity of the paddle met [rad/s].
    """
    world, board, time = lane.world, playfield.board, contact.time
    if contact.part == PAUSE:
        return
    if contact.part == GRIP:
        begin_to_roll(ball, board)
        return
    land(ball, board, ball.age + time)
    if contact.part == GUTTER:
        world.drained += 1
        record(lane.log, EventKind.GUTTER + 0, ball, world.tick, Contact(time, GUTTER, 1.0, 0.0), -ball.vx)
        clear(ball)
        return
    c = playfield.colliders[board.collider_first + contact.part]
    nx, nz, ux, uz = contact.nx, contact.nz, 0.0, 0.0
    acceleration = board.gravity
    if c.kind == Kind.WALL:
        nx, nz = c.inward_x, c.inward_z
    elif c.kind != Kind.PADDLE:
        _, nx, nz = distance(c, ball.x, ball.z)
    elif turn != 0.0:
        ux, uz = surface_velocity(c, turn, ball.x - board.ball_radius * nx, ball.z - board.ball_radius * nz)
        acceleration += turn * turn * c.reach
    contact = Contact(time, contact.part, nx, nz)
    speed = bounce(ball, board, c, contact, ux, uz, acceleration)
    kind = EventKind.TOUCH + 0
    if speed > board.hit_speed:
        kind = EventKind.HIT + 0
        world.score += c.points
        lane.tally[contact.part] += 1
        count_hit(world, c.kind)
    else:
        world.touches += 1
    record(lane.log, kind, ball, world.tick, contact, speed)
    depart(ball, board, time)


@inlined
def clear(ball: Any) -> None:
    """An empty slot is all zeros."""
    ball.x, ball.z, ball.vx, ball.vz = 0.0, 0.0, 0.0, 0.0
    ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0
    ball.id = 0
    ball.from_x, ball.from_z, ball.from_vx, ball.from_vz = 0.0, 0.0, 0.0, 0.0
    ball.pull_x, ball.pull_z, ball.motion, ball.grips = 0.0, 0.0, 0, 0.0
    ball.ticks, ball.offset, ball.age, ball.due, ball.meets = 0, 0.0, 0.0, 0.0, 0


@internal
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
