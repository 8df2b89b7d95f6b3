"""One tick of one world: the whole simulation on one screen.

    the paddles get their motion → until the tick is used up:
        for each ball the earliest contact along its flight (parts, gutter, the other ball)
        → fly both balls to it, turn the paddles → write it down → bounce
    → clamp the speeds → count the tick

The moment at which a paddle reaches its stop ends a flight too, so that no search looks across it.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.balls import shove_balls
from silverball.physics.bounce import capped, exchanged
from silverball.physics.contact import first_contact, resolved
from silverball.physics.flight import flight_to_ball, flown
from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import NOTHING, OTHER_BALL, Ball, Contact, EventKind, Fault, Kind, Paddle, Part
from silverball.physics.log import record
from silverball.physics.paddle import aimed, paddle_distance, turned
from silverball.physics.tolerances import JAM_EVENT_RATE, JAM_EVENTS, JAM_GAP, NEVER


@kernel
def step_world(
    world: Any,
    board: Any,
    colliders: Any,
    log: Any,
    tally: Any,
    raise_left: bool,
    raise_right: bool,
    shove: bool,
    tick: float,
) -> None:
    """Move a world on by one tick [s]. A world with a fault stands still."""
    if world.fault != Fault.NONE or not is_sound(world, board):
        return
    if shove:
        shove_balls(world, board, log)
    a, b = loaded(world.ball[0]), loaded(world.ball[1])
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    left, left_stop = aimed(left_part, world.paddle[0].angle, raise_left)
    right, right_stop = aimed(right_part, world.paddle[1].angle, raise_right)
    time, busy_a, busy_b, stalled = 0.0, 0, 0, False
    jammed = JAM_EVENTS + int(JAM_EVENT_RATE * tick)

    while True:
        limit = min(tick - time, left.stop_in, right.stop_in)
        meet_a = first_contact(board, colliders, left, right, a, limit)
        meet_b = first_contact(board, colliders, left, right, b, limit)
        meet = first_meeting(board, a, b, min(meet_a.time, meet_b.time))
        h = min(meet.time, limit)
        a, b = flown(a, board.pull_x, board.pull_z, h), flown(b, board.pull_x, board.pull_z, h)
        turn_left, turn_right = left.turn, right.turn
        left, right = turned(left, left_stop, h), turned(right, right_stop, h)
        free = meet.part == NOTHING and meet_a.part == NOTHING and meet_b.part == NOTHING
        if free and limit == tick - time:
            break
        time += h

        if meet.part == OTHER_BALL:
            a, b = balls_met(world, board, log, a, b, meet, time)
            busy_a, busy_b = busy_a + 1, busy_b + 1
        elif meet_a.part != NOTHING and meet_a.time <= meet_b.time:
            turn = turn_left if meet_a.part == Part.LEFT_PADDLE else turn_right
            a = resolved(world, board, colliders, log, tally, a, meet_a, turn, time)
            busy_a += 1
        elif meet_b.part != NOTHING:
            turn = turn_left if meet_b.part == Part.LEFT_PADDLE else turn_right
            b = resolved(world, board, colliders, log, tally, b, meet_b, turn, time)
            busy_b += 1

        if busy_a >= jammed or busy_b >= jammed:
            left = stalled_at(left, left_part, board, a, b)
            right = stalled_at(right, right_part, board, a, b)
            a = halted(world, log, a, 2 * busy_a >= jammed, time)
            b = halted(world, log, b, 2 * busy_b >= jammed, time)
            if stalled:  # even with the paddles still: hold everything until the tick is over
                break
            busy_a, busy_b, stalled = 0, 0, True

    store_ball(world.ball[0], capped(a, board.speed_cap))
    store_ball(world.ball[1], capped(b, board.speed_cap))
    store_paddle(world.paddle[0], left, left_stop)
    store_paddle(world.paddle[1], right, right_stop)
    world.tick += 1


@inlined
def loaded(record: Any) -> Ball:
    """A ball of the world, as a tuple."""
    return Ball(record.x, record.z, record.vx, record.vz, record.id)


@inlined
def store_paddle(record: Any, paddle: Paddle, stop: float) -> None:
    """Write a paddle back, with the stop that its button commands."""
    record.angle, record.angle_commanded, record.angular_velocity = paddle.angle, stop, paddle.turn


@inlined
def store_ball(record: Any, ball: Ball) -> None:
    """Write a ball back; an empty slot is all zeros."""
    if record.id == 0:
        return
    record.id = ball.id
    if ball.id == 0:
        record.x, record.z, record.vx, record.vz = 0.0, 0.0, 0.0, 0.0
    else:
        record.x, record.z, record.vx, record.vz = ball.x, ball.z, ball.vx, ball.vz


@inlined
def first_meeting(board: Any, a: Ball, b: Ball, limit: float) -> Contact:
    """The contact of the two balls, if both are there and nothing comes first."""
    if a.id == 0 or b.id == 0:
        return Contact(limit, NOTHING, 0.0, 0.0)
    return flight_to_ball(a, b, board.ball_radius, limit)


@kernel
def balls_met(
    world: Any, board: Any, log: Any, a: Ball, b: Ball, contact: Contact, offset: float
) -> tuple[Ball, Ball]:
    """Both balls after they have met, written down."""
    acceleration = sqrt(board.pull_x * board.pull_x + board.pull_z * board.pull_z)
    after_a, after_b, speed = exchanged(
        a, b, contact, board.ball_restitution, acceleration, board.hit_speed, board.speed_cap
    )
    kind = EventKind.BALL_TOUCH + 0
    if speed > board.hit_speed:
        kind = EventKind.BALL_HIT + 0
        world.ball_hits += 1
    else:
        world.touches += 1
    record(log, kind, OTHER_BALL, a.id, world.tick, offset, a.x, a.z, contact.nx, contact.nz, speed)
    return after_a, after_b


@kernel
def stalled_at(paddle: Paddle, c: Any, board: Any, a: Ball, b: Ball) -> Paddle:
    """The paddle, stopped for the rest of the tick if one of the balls is at it."""
    if c.kind != Kind.PADDLE or paddle.turn == 0.0:
        return paddle
    gap_a, _, _ = paddle_distance(c, paddle.angle, a.x, a.z)
    gap_b, _, _ = paddle_distance(c, paddle.angle, b.x, b.z)
    near = board.ball_radius + JAM_GAP
    if (a.id != 0 and gap_a < near) or (b.id != 0 and gap_b < near):
        return Paddle(paddle.angle, 0.0, NEVER)
    return paddle


@kernel
def halted(world: Any, log: Any, ball: Ball, involved: bool, offset: float) -> Ball:
    """A ball that takes part in a jam stops dead, and the jam is counted and written down."""
    if ball.id == 0 or not involved:
        return ball
    world.jams += 1
    record(log, EventKind.JAM, NOTHING, ball.id, world.tick, offset, ball.x, ball.z, 0.0, 0.0, 0.0)
    return Ball(ball.x, ball.z, 0.0, 0.0, ball.id)


@kernel
def is_sound(world: Any, board: Any) -> bool:
    """Whether the balls are where and as fast as they can be; if not, the world gets a named fault."""
    fastest = board.speed_cap * (1.0 + 1e-9)
    for slot in range(2):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        inside = abs(ball.x) <= board.half_length and abs(ball.z) <= board.half_width
        slow = ball.vx * ball.vx + ball.vz * ball.vz <= fastest * fastest
        if inside and slow:
            continue
        # A number that is none compares as false, so it ends here too.
        if not (
            abs(ball.x) < NEVER and abs(ball.z) < NEVER and abs(ball.vx) < NEVER and abs(ball.vz) < NEVER
        ):
            world.fault = Fault.NOT_FINITE + 0
        elif not inside:
            world.fault = Fault.OUTSIDE + 0
        else:
            world.fault = Fault.TOO_FAST + 0
        return False
    if not (abs(world.paddle[0].angle) < 10.0 and abs(world.paddle[1].angle) < 10.0):
        world.fault = Fault.NOT_FINITE + 0
        return False
    return True


@kernel
def run_worlds(
    worlds: Any, boards: Any, board_of: Any, colliders: Any, logs: Any, tallies: Any,
    actions: Any, first: int, end: int, ticks: int, tick: float,
) -> None:  # fmt: skip
    """Move the worlds first … end − 1 on by a number of ticks.

    Args:
        worlds: WORLD records [world].
        boards: BOARD records [board].
        board_of: The board of each world [world].
        colliders: COLLIDER records of all boards.
        logs: LOG records [world]; emptied first.
        tallies: Hits of each part [world, part], added to.
        actions: bool [1 or ticks, world, 3]: left, right, jitter. With one row the paddles are held for all
            ticks and the jitter comes on the first.
        first: The first world of the slice.
        end: One past its last world.
        ticks: How many ticks.
        tick: Length of a tick [s].
    """
    held = actions.shape[0] == 1
    for index in range(first, end):
        world, log, tally = worlds[index], logs[index], tallies[index]
        board = boards[board_of[index]]
        log.count, log.lost = 0, 0
        for step in range(ticks):
            row = 0 if held else step
            shove = actions[row, index, 2] and (step == 0 or not held)
            step_world(
                world,
                board,
                colliders,
                log,
                tally,
                actions[row, index, 0],
                actions[row, index, 1],
                shove,
                tick,
            )
