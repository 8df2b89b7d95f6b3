"""One tick of one world: the whole simulation on one screen.

    the paddles get their motion
    → nothing is near: fly the balls, turn the paddles
    → else, until the tick is used up:
        for each ball the earliest contact along its flight (parts, gutter, the other ball)
        → bring the ball there → bounce → write it down → a new flight begins
    → bring the balls to the tick's end, clamp their speeds → count the tick

The moment at which a paddle reaches its stop ends a search too, so that none looks across it.
"""

from __future__ import annotations

from typing import Any

from silverball.physics.balls import shove_balls
from silverball.physics.bounce import bounce_off_held, exchange
from silverball.physics.contact import first_contact, is_near, resolve
from silverball.physics.event_log import leave, record
from silverball.physics.flight import flight_to_ball, flown
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import depart, end_flight, hold, land, let_go
from silverball.physics.paddle import aimed, angle_at, at_stop, held, paddle_distance, time_to_stop
from silverball.physics.records import (
    NOTHING,
    PAUSE,
    Contact,
    EventKind,
    Fault,
    Lane,
    Lanes,
    Motion,
    Paddle,
    Part,
    Playfield,
    Playfields,
)
from silverball.physics.skip_ahead import are_apart, free_ticks
from silverball.physics.tolerances import JAM_EVENT_RATE, JAM_EVENTS, JAM_GAP, JAM_SHARE, NEVER
from silverball.physics.validation import is_admitted, is_as_left, is_sound


@kernel
def step_world(
    lane: Lane, playfield: Playfield, raise_left: bool, raise_right: bool, shove: bool, tick: float
) -> None:
    """Move a world on by one tick [s]. A world with a fault stands still."""
    world, board = lane.world, playfield.board
    if is_ready(world, playfield, lane.log, tick):
        if shove:
            shove_balls(world, board, lane.log)
        if free_ticks(playfield, world.ball[0], world.ball[1], tick, 1) == 1:
            turn_paddles(world, board, playfield.colliders, raise_left, raise_right, tick)
            end_ticks(world, board, tick, 1 + 0)  # a bare 1 would be compiled as a version of its own
        else:
            play_tick(lane, playfield, raise_left, raise_right, tick)
        if not is_inside(world, board):
            is_sound(world, board)  # names the fault
        leave(world, lane.log)


@inlined
def turn_paddles(
    world: Any, board: Any, colliders: Any, raise_left: bool, raise_right: bool, tick: float
) -> None:
    """Turn the paddles through a tick in which they meet nothing."""
    left, right = world.paddle[0], world.paddle[1]
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    store_paddle(left, aimed(left_part, left.angle, raise_left), tick)
    store_paddle(right, aimed(right_part, right.angle, raise_right), tick)


@inlined
def end_ticks(world: Any, board: Any, tick: float, count: int) -> None:
    """Bring the balls to the end of a tick, or of several in which nothing happens to them."""
    end_flight(world.ball[0], board, tick, count)
    end_flight(world.ball[1], board, tick, count)
    world.tick += count


@internal
def play_tick(lane: Lane, playfield: Playfield, raise_left: bool, raise_right: bool, tick: float) -> None:
    """Let everything happen that happens within a tick, in its order."""
    world, board, colliders = lane.world, playfield.board, playfield.colliders
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    left = aimed(left_part, world.paddle[0].angle, raise_left)
    right = aimed(right_part, world.paddle[1].angle, raise_right)
    a, b = world.ball[0], world.ball[1]
    apart = are_apart(board, a, b, tick, 1.0)
    stop_left, stop_right = time_to_stop(left, tick), time_to_stop(right, tick)
    time, busy_a, busy_b, meetings, again_a, again_b = 0.0, 0, 0, 0, False, False
    jammed = JAM_EVENTS + int(JAM_EVENT_RATE * tick)
    while True:
        limit = min(tick, stop_left, stop_right)
        meet_a = first_contact(playfield, left, right, a, time, limit, tick)
        meet_b = first_contact(playfield, left, right, b, time, limit, tick)
        meet = Contact(min(meet_a.time, meet_b.time), NOTHING, 0.0, 0.0)
        if not apart:
            meet = first_meeting(board, a, b, time, meet.time)
        time = min(meet.time, limit)
        free = meet.part == NOTHING and meet_a.part == NOTHING and meet_b.part == NOTHING
        if free and limit == tick:
            break

        if meet.part != NOTHING:
            balls_met(world, board, lane.log, meet)
            busy_a, busy_b, meetings = busy_a + 1, busy_b + 1, meetings + 1
        elif meet_a.part != NOTHING and meet_a.time <= meet_b.time:
            turn = left.turn if meet_a.part == Part.LEFT_PADDLE else right.turn
            resolve(lane, playfield, a, meet_a, turn)
            busy_a += 1
        elif meet_b.part != NOTHING:
            turn = left.turn if meet_b.part == Part.LEFT_PADDLE else right.turn
            resolve(lane, playfield, b, meet_b, turn)
            busy_b += 1
        if time >= stop_left:
            left, stop_left = at_stop(left), NEVER
        if time >= stop_right:
            right, stop_right = at_stop(right), NEVER

        if busy_a >= jammed or busy_b >= jammed:
            both = JAM_SHARE * meetings >= jammed  # they press each other
            if both or busy_a >= jammed:
                left, right = jam(lane, playfield, a, left, right, time, again_a)
                busy_a, again_a = 0, True
            if both or busy_b >= jammed:
                left, right = jam(lane, playfield, b, left, right, time, again_b)
                busy_b, again_b = 0, True
            meetings = 0
            stop_left, stop_right = time_to_stop(left, tick), time_to_stop(right, tick)
    let_go(a, board, tick)
    let_go(b, board, tick)
    store_paddle(world.paddle[0], left, tick)
    store_paddle(world.paddle[1], right, tick)
    end_ticks(world, board, tick, 1 + 0)


@inlined
def first_meeting(board: Any, a: Any, b: Any, start: float, limit: float) -> Contact:
    """The contact of the two balls, if nothing comes first."""
    if a.id == 0 or b.id == 0:
        return Contact(limit, NOTHING, 0.0, 0.0)
    bend_x, bend_z = a.pull_x - b.pull_x, a.pull_z - b.pull_z
    at_a, at_b = flown(a, a.age + start), flown(b, b.age + start)
    found = flight_to_ball(at_a, at_b, bend_x, bend_z, board.ball_radius, limit - start)
    return Contact(min(start + found.time, limit), found.part, found.nx, found.nz)


@internal
def balls_met(world: Any, board: Any, log: Any, contact: Contact) -> None:
    """Let two balls bounce off each other; one that is held is like a wall."""
    a, b, time = world.ball[0], world.ball[1], contact.time
    if contact.part == PAUSE:
        return
    land(a, board, a.age + time)
    land(b, board, b.age + time)
    if a.motion == Motion.HELD:
        speed = bounce_off_held(b, board, -contact.nx, -contact.nz)
    elif b.motion == Motion.HELD:
        speed = bounce_off_held(a, board, contact.nx, contact.nz)
    else:
        speed = exchange(a, b, board, contact)
    kind = EventKind.BALL_TOUCH + 0
    if speed > board.hit_speed:
        kind = EventKind.BALL_HIT + 0
        world.ball_hits += 1
    else:
        world.touches += 1
    record(log, kind, a, world.tick, contact, speed)
    if a.motion != Motion.HELD:
        depart(a, board, time)
    if b.motion != Motion.HELD:
        depart(b, board, time)


@internal
def jam(
    lane: Lane, playfield: Playfield, ball: Any, left: Paddle, right: Paddle, time: float, again: bool
) -> tuple[Paddle, Paddle]:
    """Stop a jammed ball dead at a time of the tick, and stall the paddles at it; both paddles.

    If it is jammed again in the same tick, even with the paddles still, it is held until the tick is over.
    """
    if ball.id == 0 or ball.motion == Motion.HELD:
        return left, right
    world, board, colliders = lane.world, playfield.board, playfield.colliders
    land(ball, board, ball.age + time)
    near = board.ball_radius + JAM_GAP
    left = stalled(left, colliders[board.collider_first + Part.LEFT_PADDLE], ball, near, time, again)
    right = stalled(right, colliders[board.collider_first + Part.RIGHT_PADDLE], ball, near, time, again)
    ball.vx, ball.vz, ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0, 0.0, 0.0
    world.jams += 1
    record(lane.log, EventKind.JAM + 0, ball, world.tick, Contact(time, NOTHING, 0.0, 0.0), 0.0)
    if again:
        hold(ball, time)
    else:
        depart(ball, board, time)
    return left, right


@internal
def stalled(paddle: Paddle, c: Any, ball: Any, near: float, time: float, again: bool) -> Paddle:
    """The paddle, stopped for the rest of the tick if a jammed ball is at it.

    No paddle may run into a ball that is held; so then one that only might come to it stops too.
    """
    if paddle.turn == 0.0:
        return paddle
    gap, _, _ = paddle_distance(c, angle_at(paddle, time), ball.x, ball.z)
    if gap < near or (again and is_near(ball.x, ball.z, c.x, c.z, c.reach + near)):
        return held(paddle, time)
    return paddle


@inlined
def store_paddle(record: Any, paddle: Paddle, tick: float) -> None:
    """Write a paddle back as it is at the tick's end, with the stop that its button commands."""
    angle, turn = paddle.angle, paddle.turn
    if turn != 0.0:
        angle = angle_at(paddle, tick)
        if angle == paddle.stop:
            turn = 0.0
    record.angle, record.angle_commanded, record.angular_velocity = angle, paddle.stop, turn


@internal
def is_ready(world: Any, playfield: Playfield, log: Any, tick: float) -> bool:
    """Whether a world can move; a change from outside is looked at first, and puts balls on new flights."""
    if world.fault != Fault.NONE:
        return False
    return is_as_left(world, playfield.board, log, tick) or is_admitted(world, playfield, tick)


@inlined
def is_inside(world: Any, board: Any) -> bool:
    """Whether the balls are within the borders: the one mishap that a world can come to by itself."""
    a, b = world.ball[0], world.ball[1]
    x, z = board.half_length, board.half_width
    return (a.id == 0 or (abs(a.x) <= x and abs(a.z) <= z)) and (
        b.id == 0 or (abs(b.x) <= x and abs(b.z) <= z)
    )


@kernel
def run_worlds(
    lanes: Lanes, playfields: Playfields, actions: Any, first: int, end: int, ticks: int, tick: float
) -> None:
    """Move the worlds first … end − 1 on by a number of ticks.

    Args:
        lanes: The worlds; their logs are emptied first, their tallies added to.
        playfields: Their boards.
        actions: bool [1 or ticks, world, 3]: left, right, jitter. With one row the paddles are held for all
            ticks and the jitter comes on the first.
        first: The first world of the slice.
        end: One past its last world.
        ticks: How many ticks; below zero: so many more, as if the call before this one went on. Logs are
            then not emptied, and with one row there is no jitter.
        tick: Length of a tick [s].
    """
    is_held = actions.shape[0] == 1
    goes_on = ticks < 0
    ticks = abs(ticks)
    for index in range(first, end):
        lane = Lane(lanes.worlds[index], lanes.logs[index], lanes.tallies[index])
        world, log, board = lane.world, lane.log, playfields.boards[lanes.board_of[index]]
        colliders = playfields.colliders
        playfield = Playfield(board, colliders, playfields.grid)
        if not goes_on:
            log.count, log.lost = 0, 0
        if ticks == 0 or not is_ready(world, playfield, log, tick):
            continue
        step = 0
        while step < ticks and is_inside(world, board):
            row = 0 if is_held else step
            if actions[row, index, 2] and (not is_held or (step == 0 and not goes_on)):
                shove_balls(world, board, log)
            free = free_ticks(playfield, world.ball[0], world.ball[1], tick, ticks - step)
            if free == 0:
                left, right = actions[row, index, 0], actions[row, index, 1]
                play_tick(lane, playfield, left, right, tick)
                step += 1
                continue
            count = 0
            while count < free and (count == 0 or is_held or not actions[step + count, index, 2]):
                row = 0 if is_held else step + count
                turn_paddles(world, board, colliders, actions[row, index, 0], actions[row, index, 1], tick)
                count += 1
            end_ticks(world, board, tick, count)
            step += count
        if not is_inside(world, board):
            is_sound(world, board)  # names the fault
        leave(world, log)
