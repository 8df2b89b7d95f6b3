"""One tick of one world: the core of the simulation.

    set the paddles' motion
    → if nothing is near: advance balls and paddles to the end of the tick
    → else, until the tick is used up:
        find the earliest contact of each ball (parts, gutter, other balls)
        → advance the ball to it → bounce → log the event → start a new flight
    → advance the balls to the end of the tick, clamp their speeds → count the tick

A search also ends at the moment a paddle reaches its stop, so a paddle's motion is uniform within a search.
"""

from __future__ import annotations

from typing import Any, cast

from silverball.physics.balls import shove_balls
from silverball.physics.bounce import bounce_balls, bounce_off_held
from silverball.physics.cabinet import is_cabinet_moving, nudge_cabinet, swing_cabinet
from silverball.physics.captures import count_launch_ticks, is_launching, work_plungers
from silverball.physics.contact import first_contact, resolve
from silverball.physics.devices import (
    clock_time,
    has_devices,
    run_clocks,
    set_next_clock,
    ticks_to_clock,
)
from silverball.physics.event_log import begin_step, log_event, store_checksum
from silverball.physics.flight import contact_with_ball, state_at
from silverball.physics.for_devices import are_on_one_level, ball_slots, for_devices, paddle_count
from silverball.physics.jams import stop_jammed_balls
from silverball.physics.kernel import as_int, inlined, internal, kernel, prefetch
from silverball.physics.motion import advance_ticks, advance_to, is_fixed, release, restart_slip, start_flight
from silverball.physics.paddle import (
    angle_at,
    end_at_stop,
    is_turning,
    omega_at,
    read_sweep,
    start_sweep,
    time_to_stop,
    write_sweep,
)
from silverball.physics.records import (
    BALL,
    JITTER,
    LAUNCH,
    LEFT,
    NOTHING,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGE_UP,
    NUDGES,
    NULL_EVENT,
    PLAIN_WORLD,
    RIGHT,
    SHOVES,
    WORLD,
    BallRecord,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    Colliders,
    Contact,
    EventKind,
    Fault,
    Lane,
    Lanes,
    LogRecord,
    PaddleRecord,
    PaddleSweep,
    Part,
    WorldRecord,
)
from silverball.physics.skip_ahead import cannot_meet, event_free_ticks
from silverball.physics.tolerances import JAM_EVENT_RATE, JAM_EVENTS, NEVER
from silverball.physics.validation import admit_state, is_unchanged, validate_world

JITTER_COLUMN, LAUNCH_COLUMN, NUDGE_COLUMN = 2, 3, 4  # of actions
ACTION_COLUMNS = (3, 4, 7)  # without the launch button, with it, with the three nudges too
LINE = 64  # bytes of a line of the cache
HOT_BYTES = cast(Any, WORLD.fields)["ball"][1] + 2 * BALL.itemsize  # of a world, up to its second ball
HOT_LINES, PLAIN_LINES = -(-HOT_BYTES // LINE), -(-PLAIN_WORLD.itemsize // LINE)


@inlined
def button_bits(left: bool, right: bool) -> int:
    """Compute the bits of two held buttons."""
    return (LEFT if left else 0) | (RIGHT if right else 0)


@kernel
def step_world(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float) -> None:
    """Advance a world by one tick [s], with these bits of buttons. A world with a fault does not move."""
    world, board = lane.world, geometry.board
    if can_step(world, geometry, lane.log, tick):
        if buttons & SHOVES != 0:
            shove(world, board, lane.log, buttons, tick)
        advance(lane, geometry, buttons, tick, as_int(1))
        if not are_balls_on_board(world, board):
            validate_world(world, board)  # sets the fault
        store_checksum(world, board, lane.log)


@internal
def shove(world: WorldRecord, board: BoardRecord, log: LogRecord, buttons: int, tick: float) -> None:
    """Shove the balls, or nudge the cabinet, as the bits of buttons say."""
    if buttons & JITTER != 0:
        shove_balls(world, board, log)
    if buttons & NUDGES != 0:
        nudge_cabinet(world, board, log, buttons, tick)


@internal
def advance(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float, limit: int) -> int:
    """Advance a world with the same buttons by one tick, or by as many as are free of events up to `limit`.

    Returns:
        The number of ticks.
    """
    world, board = lane.world, geometry.board
    free = free_ticks(world, geometry, buttons, tick, limit)
    if free == 0:
        play_tick(lane, geometry, buttons, tick)
        return 1
    for _ in range(free):
        if turn_paddles(world, board, geometry.colliders, buttons, tick):
            break
    count_launch_ticks(world, board, buttons, free)
    finish_ticks(world, board, tick, free)
    return free


@inlined
def free_ticks(world: WorldRecord, geometry: BoardGeometry, buttons: int, tick: float, limit: int) -> int:
    """Start a tick; return how many ticks from it on, at most `limit`, are free of events.

    The cabinet swings, which is felt in every tick, and slips start anew.
    """
    if is_cabinet_moving(world, geometry.board):
        swing_cabinet(world, geometry.board, tick)
        limit = as_int(1)
    for slot in range(ball_slots(world, geometry.board)):
        restart_slip(world.ball[slot], geometry.board)
    if is_launching(world, geometry.board, buttons):
        return 0
    return event_free_ticks(geometry, world, tick, limit)


@inlined
def turn_paddles(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, buttons: int, tick: float
) -> bool:
    """Turn the paddles through a tick in which they meet nothing; return whether all stood still.

    Then they stand still as long as the buttons are the same.
    """
    first, stand = board.collider_first + Part.FIRST_PADDLE, True
    for index in range(paddle_count(world, board)):
        c, paddle = colliders[first + index], world.paddle[index]
        sweep = start_sweep(c, paddle, buttons & c.button != 0)
        store_paddle(paddle, sweep, tick)
        stand = stand and not is_turning(sweep)
    return stand


@inlined
def finish_ticks(world: WorldRecord, board: BoardRecord, tick: float, count: int) -> None:
    """Advance the balls to the end of a tick, or of several event-free ones, and count the ticks."""
    for slot in range(ball_slots(world, board)):
        advance_ticks(world.ball[slot], board, tick, count)
    world.tick += count


@internal
def play_tick(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float) -> None:
    """Play all events of one tick in their order.

    At equal times the contact of a ball with a part comes before one with another ball, and balls follow
    each other in the order of their slots.
    """
    world, board, scratch = lane.world, geometry.board, lane.scratch
    start_tick(lane, geometry, buttons, tick)
    work_plungers(lane, geometry, buttons, tick)
    near = near_pairs(world, board, tick)
    clock = clock_time(world, geometry, tick) if ticks_to_clock(world) <= 0 else NEVER
    jam_limit = JAM_EVENTS + int(JAM_EVENT_RATE * tick)
    time = 0.0
    while True:
        limit = min(tick, clock)
        for index in range(paddle_count(world, board)):
            limit = min(limit, scratch.sweep[index].stop_time)
        slot, other, contact = as_int(-1), -1, Contact(limit, as_int(NOTHING), 0.0, 0.0)
        for index in range(ball_slots(world, board)):
            found = first_contact(lane, geometry, world.ball[index], time, limit, tick)
            if found.row != NOTHING and found.time < contact.time:
                slot, contact = index, found
        end = contact.time
        if near != 0:
            slot, other, contact, end = first_ball_contact(world, board, near, time, slot, contact)
        time = min(end, limit)
        if slot < 0 and limit == tick:
            break

        if other >= 0:
            resolve_ball_contact(lane, board, world.ball[slot], world.ball[other], contact)
            count_pair_event(scratch, slot, other)
        elif slot >= 0:
            resolve(lane, geometry, world.ball[slot], contact, tick)
            scratch.ball_events[slot] += 1
        for index in range(paddle_count(world, board)):
            sweep = scratch.sweep[index]
            if time >= sweep.stop_time:
                write_sweep(sweep, end_at_stop(read_sweep(sweep)), NEVER)
        if time >= clock:
            run_clocks(lane, geometry, time, tick)
        if has_devices(world, board):
            clock = clock_time(world, geometry, tick)
            near = near_pairs(world, board, tick)  # a ball may have been let go, or have left

        if slot >= 0 and (
            scratch.ball_events[slot] >= jam_limit or (other >= 0 and scratch.ball_events[other] >= jam_limit)
        ):
            stop_jammed_balls(lane, geometry, time, jam_limit)
    for index in range(ball_slots(world, board)):
        release(world.ball[index], board, tick)
    for index in range(paddle_count(world, board)):
        store_paddle(world.paddle[index], read_sweep(scratch.sweep[index]), tick)
    count_launch_ticks(world, board, buttons, as_int(1))
    finish_ticks(world, board, tick, as_int(1))
    if has_devices(world, board):
        set_next_clock(world, geometry, tick)


@inlined
def start_tick(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float) -> None:
    """Set the paddles' motion in a tick, and empty the counters that detect jams."""
    world, board, scratch = lane.world, geometry.board, lane.scratch
    first = board.collider_first + Part.FIRST_PADDLE
    for index in range(paddle_count(world, board)):
        c = geometry.colliders[first + index]
        sweep = start_sweep(c, world.paddle[index], buttons & c.button != 0)
        write_sweep(scratch.sweep[index], sweep, time_to_stop(sweep, tick))
    pair = 0
    for slot in range(ball_slots(world, board)):
        ball = world.ball[slot]
        scratch.ball_events[slot], scratch.ball_jams[slot] = 0, 0
        scratch.before_x[slot], scratch.before_z[slot] = ball.x, ball.z
        for _ in range(slot):
            scratch.pair_events[pair] = 0
            pair += 1


@inlined
def near_pairs(world: WorldRecord, board: BoardRecord, tick: float) -> int:
    """Compute which pairs of balls may meet in a tick: bit n stands for the n-th pair (see `MAX_PAIRS`)."""
    near, bit = 0, 1
    for other in range(1, ball_slots(world, board)):
        for one in range(other):
            if not cannot_meet(board, world.ball[one], world.ball[other], tick, 1.0):
                near |= bit
            bit <<= 1
    return near


@inlined
def count_pair_event(scratch: LogRecord, one: int, other: int) -> None:
    """Count a contact of two balls, `one` in the slot before `other`."""
    scratch.ball_events[one] += 1
    scratch.ball_events[other] += 1
    scratch.pair_events[other * (other - 1) // 2 + one] += 1


@internal
def first_ball_contact(
    world: WorldRecord, board: BoardRecord, near: int, start: float, slot: int, best: Contact
) -> tuple[int, int, Contact, float]:
    """Find the first contact of two balls from a time of the tick [s] on, if it is earlier than `best`.

    Returns:
        The slots of the two balls and their contact; or `slot`, −1 and `best`. And the end of the search,
        start + (end − start), rounded; it is part of the bits of a replay.
    """
    pair, partner, end = 0, -1, best.time
    for other in range(1, ball_slots(world, board)):
        for one in range(other):
            a, b = world.ball[one], world.ball[other]
            if near >> pair & 1 != 0 and a.id != 0 and b.id != 0 and are_on_one_level(a, b):
                accel_x, accel_z = a.accel_x - b.accel_x, a.accel_z - b.accel_z
                at_a, at_b = state_at(a, a.age + start), state_at(b, b.age + start)
                limit = best.time - start
                found = contact_with_ball(at_a, at_b, accel_x, accel_z, board.ball_radius, limit)
                if found.row != NOTHING:
                    slot, partner = one, other
                    best = Contact(min(start + found.time, best.time), found.row, found.nx, found.nz)
                    end = best.time
                else:
                    end = min(start + limit, end)
            pair += 1
    return slot, partner, best, end


@internal
def resolve_ball_contact(
    lane: Lane, board: BoardRecord, a: BallRecord, b: BallRecord, contact: Contact
) -> None:
    """Bounce two balls off each other. A ball that is held or captured acts like a wall."""
    world, time = lane.world, contact.time
    if contact.row == NULL_EVENT:
        return
    advance_to(a, board, a.age + time)
    advance_to(b, board, b.age + time)
    if is_fixed(a):
        speed = bounce_off_held(b, board, -contact.nx, -contact.nz)
    elif is_fixed(b):
        speed = bounce_off_held(a, board, contact.nx, contact.nz)
    else:
        speed = bounce_balls(a, b, board, contact)
    kind = as_int(EventKind.BALL_TOUCH)
    if speed > board.hit_speed:
        kind = as_int(EventKind.BALL_HIT)
        world.ball_hits += 1
    else:
        world.touches += 1
    log_event(lane.log, kind, a, world.tick, contact.row, contact, speed)
    if not is_fixed(a):
        start_flight(a, board, time)
    if not is_fixed(b):
        start_flight(b, board, time)


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
    x, z = board.half_length, board.half_width
    for slot in range(ball_slots(world, board)):
        ball = world.ball[slot]
        if ball.id != 0 and not (abs(ball.x) <= x and abs(ball.z) <= z):
            return False
    return True


@inlined
def held_buttons(actions: Any, row: int, index: int) -> int:
    """Compute the bits of the buttons that a row of actions holds in a world; without the shoves."""
    buttons = button_bits(actions[row, index, 0], actions[row, index, 1])
    if actions.shape[2] > LAUNCH_COLUMN and actions[row, index, LAUNCH_COLUMN]:
        buttons |= LAUNCH
    return buttons


@inlined
def shove_bits(actions: Any, row: int, index: int) -> int:
    """Compute the bits of the shoves that a row of actions holds in a world."""
    bits = JITTER if actions[row, index, JITTER_COLUMN] else 0
    if actions.shape[2] > NUDGE_COLUMN:
        bits |= NUDGE_LEFT if actions[row, index, NUDGE_COLUMN] else 0
        bits |= NUDGE_RIGHT if actions[row, index, NUDGE_COLUMN + 1] else 0
        bits |= NUDGE_UP if actions[row, index, NUDGE_COLUMN + 2] else 0
    return bits


@for_devices(lambda world: PLAIN_LINES)
@inlined
def hot_lines(world: WorldRecord) -> int:
    """The lines of the cache at the start of a world's record that every tick reads."""
    return HOT_LINES


@inlined
def run_held(lane: Lane, geometry: BoardGeometry, buttons: int, ticks: int, tick: float) -> None:
    """Advance a world by a number of ticks, with these bits of buttons held and the shoves on the first.

    A negative number continues the previous call by −ticks, as for `run_worlds`.
    """
    world, board, log = lane.world, geometry.board, lane.log
    if ticks >= 0:
        begin_step(log)
    if ticks == 0 or not can_step(world, geometry, log, tick):
        return
    if buttons & SHOVES != 0 and ticks > 0 and are_balls_on_board(world, board):
        shove(world, board, log, buttons, tick)
    left = abs(ticks)
    while left > 0 and are_balls_on_board(world, board):
        left -= advance(lane, geometry, buttons & ~SHOVES, tick, left)
    end_step(world, board, log)


@inlined
def end_step(world: WorldRecord, board: BoardRecord, log: LogRecord) -> None:
    """Set the fault of a world after its last tick, and what its log says about it."""
    if not are_balls_on_board(world, board):
        validate_world(world, board)  # sets the fault
    store_checksum(world, board, log)
    log.done = log.count


@kernel
def run_worlds(
    lanes: Lanes, geometries: BatchGeometry, actions: Any, first: int, end: int, ticks: int, tick: float
) -> None:
    """Advance the worlds first … end − 1 by a number of ticks.

    Args:
        lanes: The worlds. Events of the previous step are dropped first, tallies are added to.
        geometries: Their boards.
        actions: bool [1 or ticks, world, 3, 4 or 7]: left, right, jitter and, if they are there, launch, and
            a nudge left, right and up. With one row the buttons are held for all ticks, and the jitter and
            the nudges come on the first.
        first: The first world of the slice.
        end: One past its last world.
        ticks: How many ticks. A negative number continues the previous call by −ticks: logs are not emptied,
            and with one row there is no shove.
        tick: Length of a tick [s].
    """
    is_held = actions.shape[0] == 1
    is_continued = ticks < 0
    ticks = abs(ticks)
    for index in range(first, end):
        lane = Lane(lanes.worlds[index], lanes.logs[index], lanes.tallies[index], lanes.logs[first])
        if index + 1 < end:
            next_world = lanes.worlds[index + 1]
            for line in range(hot_lines(next_world)):
                prefetch(next_world, line * LINE)
            prefetch(lanes.logs[index + 1], 0)
        world, log, board = lane.world, lane.log, geometries.boards[lanes.board_of[index]]
        colliders = geometries.colliders
        geometry = BoardGeometry(board, colliders, geometries.grid)
        if is_held:
            buttons = held_buttons(actions, as_int(0), index) | shove_bits(actions, as_int(0), index)
            run_held(lane, geometry, buttons, -ticks if is_continued else ticks, tick)
            continue
        if not is_continued:
            begin_step(log)
        if ticks == 0 or not can_step(world, geometry, log, tick):
            continue
        tick_index = 0
        while tick_index < ticks and are_balls_on_board(world, board):
            shoves = shove_bits(actions, tick_index, index)
            if shoves != 0:
                shove(world, board, log, shoves, tick)
            buttons = held_buttons(actions, tick_index, index)
            free = free_ticks(world, geometry, buttons, tick, ticks - tick_index)
            if free == 0:
                play_tick(lane, geometry, buttons, tick)
                tick_index += 1
                continue
            count, standing = 0, -1  # the buttons with which the paddles stand
            while count < free:
                row = tick_index + count
                buttons = held_buttons(actions, row, index)
                if count > 0 and (
                    shove_bits(actions, row, index) != 0 or is_launching(world, board, buttons)
                ):
                    break
                if buttons != standing:
                    standing = buttons if turn_paddles(world, board, colliders, buttons, tick) else -1
                count_launch_ticks(world, board, buttons, as_int(1))
                count += 1
            finish_ticks(world, board, tick, count)
            tick_index += count
        end_step(world, board, log)
