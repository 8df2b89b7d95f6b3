"""One tick of one world: the core of the simulation.

    set the paddles' motion
    → if nothing is near: advance balls and paddles to the end of the tick
    → else, until the tick is used up:
        find the earliest contact of each ball (parts, gutter, other ball)
        → advance the ball to it → bounce → log the event → start a new flight
    → advance the balls to the end of the tick, clamp their speeds → count the tick

A search also ends at the moment a paddle reaches its stop, so a paddle's motion is uniform within a search.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from silverball.physics.balls import shove_balls
from silverball.physics.bounce import bounce_balls, bounce_off_held
from silverball.physics.broad_phase import is_near
from silverball.physics.contact import first_contact, resolve
from silverball.physics.event_log import begin_step, log_event, store_checksum
from silverball.physics.flight import contact_with_ball, state_at
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.motion import advance_ticks, advance_to, hold_still, release, start_flight
from silverball.physics.paddle import (
    angle_at,
    end_at_stop,
    is_turning,
    omega_at,
    paddle_distance,
    start_sweep,
    stop_sweep,
    time_to_stop,
)
from silverball.physics.records import (
    NOTHING,
    NULL_EVENT,
    BallRecord,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Contact,
    EventKind,
    Fault,
    Lane,
    Lanes,
    LogRecord,
    Motion,
    PaddleRecord,
    PaddleSweep,
    Part,
    WorldRecord,
)
from silverball.physics.skip_ahead import cannot_meet, event_free_ticks
from silverball.physics.tolerances import JAM_EVENT_RATE, JAM_EVENTS, JAM_GAP, JAM_SHARE, NEVER
from silverball.physics.validation import admit_state, is_unchanged, validate_world


class EventCounts(NamedTuple):
    """Events of this tick, to detect jams.

    Attributes:
        a: Events of ball 0 since its last jam.
        b: The same for ball 1.
        shared: How many of these were contacts between the two balls.
        jams_a: Jams of ball 0.
        jams_b: Jams of ball 1.
    """

    a: int
    b: int
    shared: int
    jams_a: int
    jams_b: int


@kernel
def step_world(
    lane: Lane, geometry: BoardGeometry, raise_left: bool, raise_right: bool, shove: bool, tick: float
) -> None:
    """Advance a world by one tick [s]. A world with a fault does not move."""
    world, board = lane.world, geometry.board
    if can_step(world, geometry, lane.log, tick):
        if shove:
            shove_balls(world, board, lane.log)
        if event_free_ticks(geometry, world.ball[0], world.ball[1], tick, 1) == 1:
            advance_paddles(world, board, geometry.colliders, raise_left, raise_right, tick)
            finish_ticks(world, board, tick, as_int(1))
        else:
            play_tick(lane, geometry, raise_left, raise_right, tick)
        if not are_balls_on_board(world, board):
            validate_world(world, board)  # sets the fault
        store_checksum(world, lane.log)


@inlined
def advance_paddles(
    world: WorldRecord,
    board: BoardRecord,
    colliders: Colliders,
    raise_left: bool,
    raise_right: bool,
    tick: float,
) -> None:
    """Turn the paddles through a tick in which they meet nothing."""
    left, right = world.paddle[0], world.paddle[1]
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    store_paddle(left, start_sweep(left_part, left, raise_left), tick)
    store_paddle(right, start_sweep(right_part, right, raise_right), tick)


@inlined
def finish_ticks(world: WorldRecord, board: BoardRecord, tick: float, count: int) -> None:
    """Advance the balls to the end of a tick, or of several event-free ones, and count the ticks."""
    advance_ticks(world.ball[0], board, tick, count)
    advance_ticks(world.ball[1], board, tick, count)
    world.tick += count


@internal
def play_tick(lane: Lane, geometry: BoardGeometry, raise_left: bool, raise_right: bool, tick: float) -> None:
    """Play all events of one tick in their order."""
    world, board, colliders = lane.world, geometry.board, geometry.colliders
    left_part = colliders[board.collider_first + Part.LEFT_PADDLE]
    right_part = colliders[board.collider_first + Part.RIGHT_PADDLE]
    left = start_sweep(left_part, world.paddle[0], raise_left)
    right = start_sweep(right_part, world.paddle[1], raise_right)
    left_stop_time, right_stop_time = time_to_stop(left, tick), time_to_stop(right, tick)
    a, b = world.ball[0], world.ball[1]
    are_apart = cannot_meet(board, a, b, tick, 1.0)
    jam_limit = JAM_EVENTS + int(JAM_EVENT_RATE * tick)
    counts = EventCounts(0, 0, 0, 0, 0)
    time = 0.0
    while True:
        limit = min(tick, left_stop_time, right_stop_time)
        contact_a = first_contact(geometry, left, right, a, time, limit, tick)
        contact_b = first_contact(geometry, left, right, b, time, limit, tick)
        ball_contact = Contact(min(contact_a.time, contact_b.time), NOTHING, 0.0, 0.0)
        if not are_apart:
            ball_contact = first_ball_contact(board, a, b, time, ball_contact.time)
        time = min(ball_contact.time, limit)
        is_free = ball_contact.part == NOTHING and contact_a.part == NOTHING and contact_b.part == NOTHING
        if is_free and limit == tick:
            break

        if ball_contact.part != NOTHING:
            resolve_ball_contact(world, board, lane.log, ball_contact)
            counts = EventCounts(counts.a + 1, counts.b + 1, counts.shared + 1, counts.jams_a, counts.jams_b)
        elif contact_a.part != NOTHING and contact_a.time <= contact_b.time:
            resolve(lane, geometry, a, contact_a, left if contact_a.part == Part.LEFT_PADDLE else right)
            counts = EventCounts(counts.a + 1, counts.b, counts.shared, counts.jams_a, counts.jams_b)
        elif contact_b.part != NOTHING:
            resolve(lane, geometry, b, contact_b, left if contact_b.part == Part.LEFT_PADDLE else right)
            counts = EventCounts(counts.a, counts.b + 1, counts.shared, counts.jams_a, counts.jams_b)
        if time >= left_stop_time:
            left, left_stop_time = end_at_stop(left), NEVER
        if time >= right_stop_time:
            right, right_stop_time = end_at_stop(right), NEVER

        if counts.a >= jam_limit or counts.b >= jam_limit:
            left, right, counts = stop_jammed_balls(lane, geometry, left, right, time, counts, jam_limit)
            left_stop_time, right_stop_time = time_to_stop(left, tick), time_to_stop(right, tick)
    release(a, board, tick)
    release(b, board, tick)
    store_paddle(world.paddle[0], left, tick)
    store_paddle(world.paddle[1], right, tick)
    finish_ticks(world, board, tick, as_int(1))


@inlined
def first_ball_contact(
    board: BoardRecord, a: BallRecord, b: BallRecord, start: float, limit: float
) -> Contact:
    """Find the first contact of the two balls between two times of the tick [s]."""
    if a.id == 0 or b.id == 0:
        return Contact(limit, NOTHING, 0.0, 0.0)
    accel_x, accel_z = a.accel_x - b.accel_x, a.accel_z - b.accel_z
    at_a, at_b = state_at(a, a.age + start), state_at(b, b.age + start)
    found = contact_with_ball(at_a, at_b, accel_x, accel_z, board.ball_radius, limit - start)
    return Contact(min(start + found.time, limit), found.part, found.nx, found.nz)


@internal
def resolve_ball_contact(world: WorldRecord, board: BoardRecord, log: LogRecord, contact: Contact) -> None:
    """Bounce the two balls off each other. A ball that is held acts like a wall."""
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
    kind = as_int(EventKind.BALL_TOUCH)
    if speed > board.hit_speed:
        kind = as_int(EventKind.BALL_HIT)
        world.ball_hits += 1
    else:
        world.touches += 1
    log_event(log, kind, a, world.tick, contact, speed)
    if a.motion != Motion.HELD:
        start_flight(a, board, time)
    if b.motion != Motion.HELD:
        start_flight(b, board, time)


@internal
def stop_jammed_balls(
    lane: Lane,
    geometry: BoardGeometry,
    left: PaddleSweep,
    right: PaddleSweep,
    time: float,
    counts: EventCounts,
    limit: int,
) -> tuple[PaddleSweep, PaddleSweep, EventCounts]:
    """Stop the balls that have reached `limit` events in this tick, and stall the paddles next to them.

    Both balls are stopped if contacts between the two make up at least 1/JAM_SHARE of `limit`.

    Returns:
        The updated paddles and counts.
    """
    a, b, jams_a, jams_b = counts.a, counts.b, counts.jams_a, counts.jams_b
    is_shared = JAM_SHARE * counts.shared >= limit
    if is_shared or counts.a >= limit:
        left, right = stop_jammed_ball(lane, geometry, lane.world.ball[0], left, right, time, jams_a > 0)
        a, jams_a = 0, jams_a + 1
    if is_shared or counts.b >= limit:
        left, right = stop_jammed_ball(lane, geometry, lane.world.ball[1], left, right, time, jams_b > 0)
        b, jams_b = 0, jams_b + 1
    return left, right, EventCounts(a, b, 0, jams_a, jams_b)


@internal
def stop_jammed_ball(
    lane: Lane,
    geometry: BoardGeometry,
    ball: BallRecord,
    left: PaddleSweep,
    right: PaddleSweep,
    time: float,
    is_repeat: bool,
) -> tuple[PaddleSweep, PaddleSweep]:
    """Stop a jammed ball at a time of the tick, and stall the paddles next to it.

    A ball that jams again in the same tick, although the paddles are still, is held until the tick is over.

    Returns:
        The updated paddles.
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
    log_event(lane.log, as_int(EventKind.JAM), ball, world.tick, Contact(time, NOTHING, 0.0, 0.0), 0.0)
    if is_repeat:
        hold_still(ball, time)
    else:
        start_flight(ball, board, time)
    return left, right


@internal
def stall_near(
    paddle: PaddleSweep, c: ColliderRecord, ball: BallRecord, near: float, time: float, is_repeat: bool
) -> PaddleSweep:
    """Stop a paddle for the rest of the tick if it is within `near` [u] of a jammed ball's centre.

    If the ball is about to be held (`is_repeat`), a paddle that could reach it stops too: no paddle may run
    into a held ball.
    """
    if not is_turning(paddle):
        return paddle
    gap, _, _ = paddle_distance(c, angle_at(paddle, time), ball.x, ball.z)
    if gap < near or (is_repeat and is_near(ball.x, ball.z, c.x, c.z, c.reach + near)):
        return stop_sweep(paddle, time)
    return paddle


@inlined
def store_paddle(record: PaddleRecord, paddle: PaddleSweep, tick: float) -> None:
    """Store a paddle at the end of the tick, together with the stop angle its button drives it to."""
    angle, omega = paddle.angle, 0.0
    if is_turning(paddle):
        angle = angle_at(paddle, tick)
        omega = 0.0 if angle == paddle.stop else omega_at(paddle, tick)
    record.angle, record.angle_commanded, record.angular_velocity = angle, paddle.stop, omega


@internal
def can_step(world: WorldRecord, geometry: BoardGeometry, log: LogRecord, tick: float) -> bool:
    """Whether a world can be advanced. A state that was modified externally is validated first."""
    if world.fault != Fault.NONE:
        return False
    return is_unchanged(world, geometry.board, log, tick) or admit_state(world, geometry, tick)


@inlined
def are_balls_on_board(world: WorldRecord, board: BoardRecord) -> bool:
    """Whether the balls are within the borders: the only condition that a step itself can violate."""
    a, b = world.ball[0], world.ball[1]
    x, z = board.half_length, board.half_width
    return (a.id == 0 or (abs(a.x) <= x and abs(a.z) <= z)) and (
        b.id == 0 or (abs(b.x) <= x and abs(b.z) <= z)
    )


@kernel
def run_worlds(
    lanes: Lanes, geometries: BatchGeometry, actions: Any, first: int, end: int, ticks: int, tick: float
) -> None:
    """Advance the worlds first … end − 1 by a number of ticks.

    Args:
        lanes: The worlds. Events of the previous step are dropped first, tallies are added to.
        geometries: Their boards.
        actions: bool [1 or ticks, world, 3]: left, right, jitter. With one row the paddles are held for all
            ticks and the jitter comes on the first.
        first: The first world of the slice.
        end: One past its last world.
        ticks: How many ticks. A negative number continues the previous call by −ticks: logs are not emptied,
            and with one row there is no jitter.
        tick: Length of a tick [s].
    """
    is_held = actions.shape[0] == 1
    is_continued = ticks < 0
    ticks = abs(ticks)
    for index in range(first, end):
        lane = Lane(lanes.worlds[index], lanes.logs[index], lanes.tallies[index])
        world, log, board = lane.world, lane.log, geometries.boards[lanes.board_of[index]]
        colliders = geometries.colliders
        geometry = BoardGeometry(board, colliders, geometries.grid)
        if not is_continued:
            begin_step(log)
        if ticks == 0 or not can_step(world, geometry, log, tick):
            continue
        tick_index = 0
        while tick_index < ticks and are_balls_on_board(world, board):
            row = 0 if is_held else tick_index
            if actions[row, index, 2] and (not is_held or (tick_index == 0 and not is_continued)):
                shove_balls(world, board, log)
            free = event_free_ticks(geometry, world.ball[0], world.ball[1], tick, ticks - tick_index)
            if free == 0:
                left, right = actions[row, index, 0], actions[row, index, 1]
                play_tick(lane, geometry, left, right, tick)
                tick_index += 1
                continue
            count = 0
            while count < free and (count == 0 or is_held or not actions[tick_index + count, index, 2]):
                row = 0 if is_held else tick_index + count
                advance_paddles(world, board, colliders, actions[row, index, 0], actions[row, index, 1], tick)
                count += 1
            finish_ticks(world, board, tick, count)
            tick_index += count
        if not are_balls_on_board(world, board):
            validate_world(world, board)  # sets the fault
        store_checksum(world, log)
        log.done = log.count
