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
from silverball.physics.bounce import bounce_balls, bounce_off_held
from silverball.physics.contact import first_contact, is_near, resolve
from silverball.physics.event_log import begin_step, log_event, store_checksum
from silverball.physics.flight import contact_with_ball, state_at
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import advance_ticks, advance_to, hold_still, release, start_flight
from silverball.physics.paddle import (
    angle_at,
    end_at_stop,
    paddle_distance,
    start_sweep,
    stop_sweep,
    time_to_stop,
)
from silverball.physics.records import (
    NOTHING,
    NULL_EVENT,
    BatchGeometry,
    BoardGeometry,
    Contact,
    EventKind,
    Fault,
    Lane,
    Lanes,
    Motion,
    PaddleSweep,
    Part,
)
from silverball.physics.skip_ahead import cannot_meet, event_free_ticks
from silverball.physics.tolerances import JAM_EVENT_RATE, JAM_EVENTS, JAM_GAP, JAM_SHARE, NEVER
from silverball.physics.validation import admit_state, is_unchanged, validate_world


@kernel
def step_world(
    lane: Lane, geometry: BoardGeometry, raise_left: bool, raise_right: bool, shove: bool, tick: float
) -> None:
    """Move a world on by one tick [s]. A world with a fault stands still."""
    world, board = lane.world, geometry.board
    if can_step(world, geometry, lane.log, tick):
        if shove:
            shove_balls(world, board, lane.log)
        if event_free_ticks(geometry, world.ball[0], world.ball[1], tick, 1) == 1:
            advance_paddles(world, board, geometry.colliders, raise_left, raise_right, tick)
            finish_ticks(world, board, tick, 1 + 0)  # a bare 1 would be compiled as a version of its own
        else:
            play_tick(lane, geometry, raise_left, raise_right, tick)
        if not are_balls_on_board(world, board):
            validate_world(world, board)  # names the fault
        store_checksum(world, lane.log)


@inlined
def advance_paddles(
    world: Any, board: Any, colliders: Any, raise_left: bool, raise_right: bool, tick: float
) -> None:
    """Turn the paddles through a tick in which they meet nothing."""
    left, right = world.paddle[0], world.paddle[1]
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    store_paddle(left, start_sweep(left_part, left.angle, raise_left), tick)
    store_paddle(right, start_sweep(right_part, right.angle, raise_right), tick)


@inlined
def finish_ticks(world: Any, board: Any, tick: float, count: int) -> None:
    """Bring the balls to the end of a tick, or of several in which nothing happens to them."""
    advance_ticks(world.ball[0], board, tick, count)
    advance_ticks(world.ball[1], board, tick, count)
    world.tick += count


@internal
def play_tick(lane: Lane, geometry: BoardGeometry, raise_left: bool, raise_right: bool, tick: float) -> None:
    """Let everything happen that happens within a tick, in its order."""
    world, board, colliders = lane.world, geometry.board, geometry.colliders
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    left = start_sweep(left_part, world.paddle[0].angle, raise_left)
    right = start_sweep(right_part, world.paddle[1].angle, raise_right)
    a, b = world.ball[0], world.ball[1]
    apart = cannot_meet(board, a, b, tick, 1.0)
    left_stop_time, right_stop_time = time_to_stop(left, tick), time_to_stop(right, tick)
    time, events_a, events_b, ball_events, repeat_a, repeat_b = 0.0, 0, 0, 0, False, False
    jam_limit = JAM_EVENTS + int(JAM_EVENT_RATE * tick)
    while True:
        limit = min(tick, left_stop_time, right_stop_time)
        contact_a = first_contact(geometry, left, right, a, time, limit, tick)
        contact_b = first_contact(geometry, left, right, b, time, limit, tick)
        contact = Contact(min(contact_a.time, contact_b.time), NOTHING, 0.0, 0.0)
        if not apart:
            contact = first_ball_contact(board, a, b, time, contact.time)
        time = min(contact.time, limit)
        free = contact.part == NOTHING and contact_a.part == NOTHING and contact_b.part == NOTHING
        if free and limit == tick:
            break

        if contact.part != NOTHING:
            resolve_ball_contact(world, board, lane.log, contact)
            events_a, events_b, ball_events = events_a + 1, events_b + 1, ball_events + 1
        elif contact_a.part != NOTHING and contact_a.time <= contact_b.time:
            omega = left.omega if contact_a.part == Part.LEFT_PADDLE else right.omega
            resolve(lane, geometry, a, contact_a, omega)
            events_a += 1
        elif contact_b.part != NOTHING:
            omega = left.omega if contact_b.part == Part.LEFT_PADDLE else right.omega
            resolve(lane, geometry, b, contact_b, omega)
            events_b += 1
        if time >= left_stop_time:
            left, left_stop_time = end_at_stop(left), NEVER
        if time >= right_stop_time:
            right, right_stop_time = end_at_stop(right), NEVER

        if events_a >= jam_limit or events_b >= jam_limit:
            both = JAM_SHARE * ball_events >= jam_limit  # they press each other
            if both or events_a >= jam_limit:
                left, right = stop_jammed_ball(lane, geometry, a, left, right, time, repeat_a)
                events_a, repeat_a = 0, True
            if both or events_b >= jam_limit:
                left, right = stop_jammed_ball(lane, geometry, b, left, right, time, repeat_b)
                events_b, repeat_b = 0, True
            ball_events = 0
            left_stop_time, right_stop_time = time_to_stop(left, tick), time_to_stop(right, tick)
    release(a, board, tick)
    release(b, board, tick)
    store_paddle(world.paddle[0], left, tick)
    store_paddle(world.paddle[1], right, tick)
    finish_ticks(world, board, tick, 1 + 0)


@inlined
def first_ball_contact(board: Any, a: Any, b: Any, start: float, limit: float) -> Contact:
    """The contact of the two balls, if nothing comes first."""
    if a.id == 0 or b.id == 0:
        return Contact(limit, NOTHING, 0.0, 0.0)
    accel_x, accel_z = a.accel_x - b.accel_x, a.accel_z - b.accel_z
    at_a, at_b = state_at(a, a.age + start), state_at(b, b.age + start)
    found = contact_with_ball(at_a, at_b, accel_x, accel_z, board.ball_radius, limit - start)
    return Contact(min(start + found.time, limit), found.part, found.nx, found.nz)


@internal
def resolve_ball_contact(world: Any, board: Any, log: Any, contact: Contact) -> None:
    """Let two balls bounce off each other; one that is held is like a wall."""
    a, b, time = world.ball[0], world.ball[1], contact.time
    if contact.part == NULL_EVENT:
        return
    advance_to(a, board, a.age + time)
    advance_to(b, board, b.age + time)
    if a.motion == Motion.HELD:
        speed = bounce_off_held(b, board, -contact.nx, -contact.nz)
    elif b.motion == Motion.HELD:
        speed = bounce_off_held(a, board, contact.nx, contact.nz)
    else:
        speed = bounce_balls(a, b, board, contact)
    kind = EventKind.BALL_TOUCH + 0
    if speed > board.hit_speed:
        kind = EventKind.BALL_HIT + 0
        world.ball_hits += 1
    else:
        world.touches += 1
    log_event(log, kind, a, world.tick, contact, speed)
    if a.motion != Motion.HELD:
        start_flight(a, board, time)
    if b.motion != Motion.HELD:
        start_flight(b, board, time)


@internal
def stop_jammed_ball(
    lane: Lane,
    geometry: BoardGeometry,
    ball: Any,
    left: PaddleSweep,
    right: PaddleSweep,
    time: float,
    is_repeat: bool,
) -> tuple[PaddleSweep, PaddleSweep]:
    """Stop a jammed ball dead at a time of the tick, and stall the paddles at it; both paddles.

    If it is jammed again in the same tick, even with the paddles still, it is held until the tick is over.
    """
    if ball.id == 0 or ball.motion == Motion.HELD:
        return left, right
    world, board, colliders = lane.world, geometry.board, geometry.colliders
    advance_to(ball, board, ball.age + time)
    near = board.ball_radius + JAM_GAP
    left = stall_near(left, colliders[board.collider_first + Part.LEFT_PADDLE], ball, near, time, is_repeat)
    right = stall_near(
        right, colliders[board.collider_first + Part.RIGHT_PADDLE], ball, near, time, is_repeat
    )
    ball.vx, ball.vz, ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0, 0.0, 0.0
    world.jams += 1
    log_event(lane.log, EventKind.JAM + 0, ball, world.tick, Contact(time, NOTHING, 0.0, 0.0), 0.0)
    if is_repeat:
        hold_still(ball, time)
    else:
        start_flight(ball, board, time)
    return left, right


@internal
def stall_near(
    paddle: PaddleSweep, c: Any, ball: Any, near: float, time: float, is_repeat: bool
) -> PaddleSweep:
    """The paddle, stopped for the rest of the tick if a jammed ball is at it.

    No paddle may run into a ball that is held; so then one that only might come to it stops too.
    """
    if paddle.omega == 0.0:
        return paddle
    gap, _, _ = paddle_distance(c, angle_at(paddle, time), ball.x, ball.z)
    if gap < near or (is_repeat and is_near(ball.x, ball.z, c.x, c.z, c.reach + near)):
        return stop_sweep(paddle, time)
    return paddle


@inlined
def store_paddle(record: Any, paddle: PaddleSweep, tick: float) -> None:
    """Write a paddle back as it is at the tick's end, with the stop that its button commands."""
    angle, omega = paddle.angle, paddle.omega
    if omega != 0.0:
        angle = angle_at(paddle, tick)
        if angle == paddle.stop:
            omega = 0.0
    record.angle, record.angle_commanded, record.angular_velocity = angle, paddle.stop, omega


@internal
def can_step(world: Any, geometry: BoardGeometry, log: Any, tick: float) -> bool:
    """Whether a world can move; a change from outside is looked at first, and puts balls on new flights."""
    if world.fault != Fault.NONE:
        return False
    return is_unchanged(world, geometry.board, log, tick) or admit_state(world, geometry, tick)


@inlined
def are_balls_on_board(world: Any, board: Any) -> bool:
    """Whether the balls are within the borders: the one mishap that a world can come to by itself."""
    a, b = world.ball[0], world.ball[1]
    x, z = board.half_length, board.half_width
    return (a.id == 0 or (abs(a.x) <= x and abs(a.z) <= z)) and (
        b.id == 0 or (abs(b.x) <= x and abs(b.z) <= z)
    )


@kernel
def run_worlds(
    lanes: Lanes, geometries: BatchGeometry, actions: Any, first: int, end: int, ticks: int, tick: float
) -> None:
    """Move the worlds first … end − 1 on by a number of ticks.

    Args:
        lanes: The worlds; their logs lose the events of the previous step, their tallies are added to.
        geometries: Their boards.
        actions: bool [1 or ticks, world, 3]: left, right, jitter. With one row the paddles are held for all
            ticks and the jitter comes on the first.
        first: The first world of the slice.
        end: One past its last world.
        ticks: How many ticks; below zero: so many more, as if the call before this one went on. Logs are
            then left as they are, and with one row there is no jitter.
        tick: Length of a tick [s].
    """
    is_held = actions.shape[0] == 1
    continues_flight = ticks < 0
    ticks = abs(ticks)
    for index in range(first, end):
        lane = Lane(lanes.worlds[index], lanes.logs[index], lanes.tallies[index])
        world, log, board = lane.world, lane.log, geometries.boards[lanes.board_of[index]]
        colliders = geometries.colliders
        geometry = BoardGeometry(board, colliders, geometries.grid)
        if not continues_flight:
            begin_step(log)
        if ticks == 0 or not can_step(world, geometry, log, tick):
            continue
        step = 0
        while step < ticks and are_balls_on_board(world, board):
            row = 0 if is_held else step
            if actions[row, index, 2] and (not is_held or (step == 0 and not continues_flight)):
                shove_balls(world, board, log)
            free = event_free_ticks(geometry, world.ball[0], world.ball[1], tick, ticks - step)
            if free == 0:
                left, right = actions[row, index, 0], actions[row, index, 1]
                play_tick(lane, geometry, left, right, tick)
                step += 1
                continue
            count = 0
            while count < free and (count == 0 or is_held or not actions[step + count, index, 2]):
                row = 0 if is_held else step + count
                advance_paddles(world, board, colliders, actions[row, index, 0], actions[row, index, 1], tick)
                count += 1
            finish_ticks(world, board, tick, count)
            step += count
        if not are_balls_on_board(world, board):
            validate_world(world, board)  # names the fault
        store_checksum(world, log)
        log.done = log.count
