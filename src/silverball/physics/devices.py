"""Devices: what parts of a board do apart from bouncing balls.

* A *sensor* reports each ball that crosses it; a *passage* also changes the ball's level.
* A *spinner* turns after a ball has crossed it, and reports each turn.
* A *hole* captures balls and lets them go again; a *drain* takes them away for good.
* A *plunger* holds the balls that lie on it until the launch button is released.
* A *drop target* falls when it is hit; the bank to which it belongs comes back together.
* A *gate* is opened and closed by rules (`set_switch`).

What devices do by themselves happens at exact times. `next_clock` of a world is the tick of the first of
them, so a tick without any of them costs nothing.

No device ever puts one thing into another: a ball changes its level, is captured or let go, and a drop target
or gate comes back, only where there is room; otherwise it is tried again (a passage throws the ball back).
"""

from __future__ import annotations

from math import floor, sqrt

from silverball.physics.bounce import clamp_speed
from silverball.physics.event_log import log_event, log_part_event
from silverball.physics.flight import state_at
from silverball.physics.for_devices import for_devices
from silverball.physics.holes import exit_velocity, is_captured, launch_speed
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.motion import (
    advance_to,
    capture,
    clear_ball,
    search_from,
    set_free,
    start_flight,
    store,
)
from silverball.physics.paddle import angle_at, paddle_distance, read_sweep
from silverball.physics.records import (
    LAUNCH,
    NO_CLOCK,
    NOTHING,
    BallRecord,
    BoardGeometry,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Contact,
    Device,
    EventKind,
    Lane,
    Motion,
    Part,
    Response,
    SpinnerRecord,
    WorldRecord,
)
from silverball.physics.shapes import distance
from silverball.physics.spinner import blade_angle, slowed_by_blade, time_of_turn
from silverball.physics.tolerances import FREE_GAP, MAX_DEPTH, NEVER


@for_devices(lambda lane, geometry, ball, row, tick: None)
@internal
def cross_sensor(lane: Lane, geometry: BoardGeometry, ball: BallRecord, row: int, tick: float) -> None:
    """Let a ball cross the sensor in a row, at its `contact_age`."""
    world, board = lane.world, geometry.board
    c = geometry.colliders[board.collider_first + row]
    age = ball.contact_age
    time = max(age - ball.age, 0.0)
    ball.contact_row, ball.passed_age, ball.passed_row = NOTHING, age, row
    at = state_at(ball, age)
    speed = at.vx * c.inward_x + at.vz * c.inward_z
    is_to_left = speed > 0.0
    side = 1.0 if is_to_left else -1.0
    if c.role in (Device.HOLE, Device.DRAIN, Device.PLUNGER):
        _enter_hole(lane, geometry, ball, row, time, tick)
        return
    if c.role == Device.PASSAGE:
        before = c.level_right if is_to_left else c.level_left
        after = c.level_left if is_to_left else c.level_right
        if ball.level != before:
            return  # it is on this level already
        advance_to(ball, board, age)
        if not (
            _has_room(world, board, ball, ball.x, ball.z, after, time)
            and _is_clear(lane, geometry, ball.x, ball.z, after, time)
        ):
            # Something is in the way on the other level: the ball is thrown back.
            ball.vx -= 2.0 * speed * c.inward_x
            ball.vz -= 2.0 * speed * c.inward_z
            contact = Contact(time, row, -side * c.inward_x, -side * c.inward_z)
            world.touches += 1
            log_event(lane.log, as_int(EventKind.TOUCH), ball, world.tick, c.part, contact, abs(speed))
            start_flight(ball, board, time)
            return
        ball.level = after
        start_flight(ball, board, time)
    else:
        store(ball, at)
    contact = Contact(time, row, side * c.inward_x, side * c.inward_z)
    _count(lane, c)
    log_event(lane.log, as_int(EventKind.PASS), ball, world.tick, c.part, contact, abs(speed))
    if c.role == Device.SPINNER:
        _drive_spinner(world, board, ball, c, speed, time, tick)


@inlined
def _count(lane: Lane, c: ColliderRecord) -> None:
    """Count an event that scores."""
    lane.world.score += c.points
    lane.tally[c.part] += 1


@inlined
def _has_room(
    world: WorldRecord, board: BoardRecord, ball: BallRecord, x: float, z: float, level: int, time: float
) -> bool:
    """Whether a ball at (x, z) on a level would overlap no other ball at a time of the tick [s]."""
    reach = 2.0 * board.ball_radius + FREE_GAP
    for slot in range(board.max_balls):
        other = world.ball[slot]
        if other.id not in (0, ball.id) and other.level == level:
            at = state_at(other, other.age + time)
            if (at.x - x) * (at.x - x) + (at.z - z) * (at.z - z) < reach * reach:
                return False
    return True


@internal
def _is_clear(lane: Lane, geometry: BoardGeometry, x: float, z: float, level: int, time: float) -> bool:
    """Whether a ball at (x, z) on a level would overlap no collider at a time of the tick [s]."""
    world, board, scratch = lane.world, geometry.board, lane.scratch
    if min(z - board.low_z, board.high_z - z, board.top_x - x) < -MAX_DEPTH:
        return False
    for index in range(board.collider_first + Part.FIRST_PADDLE, board.collider_end):
        c = geometry.colliders[index]
        if c.response != Response.BOUNCE or c.levels >> level & 1 == 0 or c.switch & world.off != 0:
            continue
        if c.one_way != 0:  # a ball may overlap it
            continue
        dx, dz, reach = x - c.x, z - c.z, c.reach + board.ball_radius
        if dx * dx + dz * dz > reach * reach:
            continue
        row = index - board.collider_first
        if row < board.shape_first:
            angle = angle_at(read_sweep(scratch.sweep[row - Part.FIRST_PADDLE]), time)
            gap, _, _ = paddle_distance(c, angle, x, z)
        else:
            gap, _, _ = distance(c, x, z)
        if gap < board.ball_radius - MAX_DEPTH:
            return False
    return True


@internal
def _enter_hole(
    lane: Lane, geometry: BoardGeometry, ball: BallRecord, row: int, time: float, tick: float
) -> None:
    """Capture a ball that enters a hole, unless it is too fast or there is no room for it in the middle."""
    world, board = lane.world, geometry.board
    c = geometry.colliders[board.collider_first + row]
    at = state_at(ball, ball.age + time)
    if not is_captured(at.vx, at.vz, c.capture_speed):
        return
    speed = sqrt(at.vx * at.vx + at.vz * at.vz)
    contact = Contact(time, row, 0.0, 0.0)
    if c.role == Device.DRAIN:
        advance_to(ball, board, ball.age + time)
        world.drained += 1
        lane.tally[c.part] += 1
        log_event(lane.log, as_int(EventKind.GUTTER), ball, world.tick, c.part, contact, speed)
        clear_ball(ball)
        return
    if not _has_room(world, board, ball, c.x, c.z, ball.level, time):
        return
    if not _is_clear(lane, geometry, c.x, c.z, ball.level, time):
        return
    capture(ball, row, c.x, c.z, time)
    _count(lane, c)
    log_event(lane.log, as_int(EventKind.CAPTURED), ball, world.tick, c.part, contact, speed)
    if c.role == Device.HOLE:
        ball.due_tick, ball.due_offset = later(world.tick, time + c.hold_time, tick)


@inlined
def later(now: int, time: float, tick: float) -> tuple[int, float]:
    """Compute the tick, and the time in it [s], of what is due `time` [s] after the tick `now` began."""
    ticks = floor(time / tick)
    return now + int(ticks), min(max(time - ticks * tick, 0.0), tick)


@internal
def _drive_spinner(
    world: WorldRecord,
    board: BoardRecord,
    ball: BallRecord,
    c: ColliderRecord,
    speed: float,
    time: float,
    tick: float,
) -> None:
    """Set the speed of a spinner's blade by a ball that crosses it with this normal speed [u/s]."""
    spinner = world.spinner[c.number]
    elapsed = (world.tick - spinner.tick) * tick + (time - spinner.offset)
    spinner.angle = blade_angle(spinner.angle, spinner.speed, c.damping, max(elapsed, 0.0), spinner.turns)
    spinner.speed = speed / c.blade
    spinner.tick, spinner.offset, spinner.turns = world.tick, time, 0
    if c.drag > 0.0:
        advance_to(ball, board, ball.age + time)
        ball.vx, ball.vz = slowed_by_blade(ball.vx, ball.vz, c.drag)
        start_flight(ball, board, time)


@inlined
def _time_of_next_turn(spinner: SpinnerRecord, c: ColliderRecord, now: int, tick: float) -> float:
    """Compute the time of a spinner's next turn, from the start of the tick `now` [s]; NEVER for none."""
    turn = time_of_turn(spinner.angle, spinner.speed, c.damping, spinner.turns + 1)
    return spinner.offset + turn - (now - spinner.tick) * tick if turn < NEVER else NEVER


@for_devices(lambda world, board: False)
@inlined
def has_devices(world: WorldRecord, board: BoardRecord) -> bool:
    """Whether anything on a board can act or be away."""
    return bool(board.sensors != 0 or board.switches != 0)


@for_devices(lambda world: NO_CLOCK)
@inlined
def ticks_to_clock(world: WorldRecord) -> int:
    """Ticks before the one in which a device acts by itself next; 0 or less: the present one."""
    return int(world.next_clock - world.tick)


@for_devices(lambda world, geometry, tick: NEVER)
@internal
def clock_time(world: WorldRecord, geometry: BoardGeometry, tick: float) -> float:
    """Compute the time of the present tick at which a device acts by itself next [s]; NEVER for none."""
    board, colliders = geometry.board, geometry.colliders
    first = NEVER
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if is_held_for_a_time(ball, board, colliders) and ball.due_tick <= world.tick:
            first = min(first, ball.due_offset if ball.due_tick == world.tick else 0.0)
    for number in range(board.banks):
        if world.banks_due >> number & 1 != 0 and world.bank_tick[number] <= world.tick:
            first = min(first, world.bank_offset[number] if world.bank_tick[number] == world.tick else 0.0)
    for number in range(board.spinners):
        c = colliders[board.collider_first + board.spinner_row[number]]
        time = _time_of_next_turn(world.spinner[number], c, world.tick, tick)
        if time < tick:
            first = min(first, max(time, 0.0))
    return first if first < tick else NEVER


@inlined
def is_held_for_a_time(ball: BallRecord, board: BoardRecord, colliders: Colliders) -> bool:
    """Whether a hole holds a ball, and will let it go."""
    if ball.id == 0 or ball.motion != Motion.CAPTURED:
        return False
    return bool(colliders[board.collider_first + ball.holder].role == Device.HOLE)


@for_devices(lambda world, geometry, tick: None)
@internal
def set_next_clock(world: WorldRecord, geometry: BoardGeometry, tick: float) -> None:
    """Store the next tick in which a device acts by itself."""
    board, colliders = geometry.board, geometry.colliders
    first = as_int(NO_CLOCK)
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if is_held_for_a_time(ball, board, colliders):
            first = min(first, ball.due_tick)
    for number in range(board.banks):
        if world.banks_due >> number & 1 != 0:
            first = min(first, world.bank_tick[number])
    for number in range(board.spinners):
        c = colliders[board.collider_first + board.spinner_row[number]]
        spinner = world.spinner[number]
        turn = time_of_turn(spinner.angle, spinner.speed, c.damping, spinner.turns + 1)
        if turn < NEVER:
            due, _ = later(spinner.tick, spinner.offset + turn, tick)
            first = min(first, due)
    world.next_clock = first


@for_devices(lambda lane, geometry, time, tick: None)
@internal
def run_clocks(lane: Lane, geometry: BoardGeometry, time: float, tick: float) -> None:
    """Let all devices act whose time in the present tick has come."""
    world, board, colliders = lane.world, geometry.board, geometry.colliders
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if is_held_for_a_time(ball, board, colliders) and _is_due(
            world.tick, ball.due_tick, ball.due_offset, time
        ):
            _release_ball(lane, geometry, ball, time)
    for number in range(board.banks):
        if world.banks_due >> number & 1 != 0 and _is_due(
            world.tick, world.bank_tick[number], world.bank_offset[number], time
        ):
            _reset_bank(lane, geometry, number, time)
    for number in range(board.spinners):
        c, spinner = colliders[board.collider_first + board.spinner_row[number]], world.spinner[number]
        if _time_of_next_turn(spinner, c, world.tick, tick) <= time:
            spinner.turns += 1
            _count(lane, c)
            log_part_event(lane.log, as_int(EventKind.SPIN), c, world.tick, time)


@inlined
def _is_due(now: int, due_tick: int, due_offset: float, time: float) -> bool:
    return due_tick < now or (due_tick == now and due_offset <= time)


@internal
def _release_ball(lane: Lane, geometry: BoardGeometry, ball: BallRecord, time: float) -> None:
    """Let a hole send off its ball; if its exit is blocked, it is tried again in the next tick."""
    world, board = lane.world, geometry.board
    c = geometry.colliders[board.collider_first + ball.holder]
    if not (
        _has_room(world, board, ball, c.exit_x, c.exit_z, c.exit_level, time)
        and _is_clear(lane, geometry, c.exit_x, c.exit_z, c.exit_level, time)
    ):
        ball.due_tick, ball.due_offset = world.tick + 1, 0.0
        return
    vx, vz, world.draws = exit_velocity(c.exit_vx, c.exit_vz, c.exit_spread, world.seed, world.draws)
    ball.x, ball.z, ball.level = c.exit_x, c.exit_z, c.exit_level
    _send_off(lane, board, ball, c, vx, vz, time)


@internal
def _send_off(
    lane: Lane, board: BoardRecord, ball: BallRecord, c: ColliderRecord, vx: float, vz: float, time: float
) -> None:
    ball.vx, ball.vz = clamp_speed(vx, vz, board.speed_cap)
    set_free(ball, board, time)
    speed = sqrt(ball.vx * ball.vx + ball.vz * ball.vz)
    nx, nz = (ball.vx / speed, ball.vz / speed) if speed > 0.0 else (0.0, 0.0)
    contact = Contact(time, as_int(NOTHING), nx, nz)
    log_event(lane.log, as_int(EventKind.RELEASED), ball, lane.world.tick, c.part, contact, speed)


@for_devices(lambda lane, geometry, buttons, tick: None)
@internal
def work_plungers(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float) -> None:
    """Launch the balls on the plungers at the start of a tick, if the button has been released.

    A ball stays where something is in its place, as a paddle that has turned over it.
    """
    world, board = lane.world, geometry.board
    if not is_launching(world, board, buttons):
        return
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and ball.motion == Motion.CAPTURED:
            c = geometry.colliders[board.collider_first + ball.holder]
            if c.role == Device.PLUNGER and _is_clear(lane, geometry, c.x, c.z, ball.level, 0.0):
                speed = launch_speed(
                    c.launch_least, c.launch_greatest, c.charge_time, world.launch_held, tick
                )
                _send_off(lane, board, ball, c, speed * c.launch_x, speed * c.launch_z, 0.0)


@for_devices(lambda world, board, buttons: False)
@inlined
def is_launching(world: WorldRecord, board: BoardRecord, buttons: int) -> bool:
    """Whether the launch button was held up to now and is not any more."""
    return board.plungers != 0 and world.launch_held != 0 and buttons & LAUNCH == 0


@for_devices(lambda world, board, buttons, count: None)
@inlined
def count_launch_ticks(world: WorldRecord, board: BoardRecord, buttons: int, count: int) -> None:
    """Count how long the launch button has been held, at the end of `count` ticks."""
    if board.plungers != 0:
        world.launch_held = world.launch_held + count if buttons & LAUNCH != 0 else 0


@for_devices(lambda lane, geometry, c, time, tick: None)
@internal
def drop_target(lane: Lane, geometry: BoardGeometry, c: ColliderRecord, time: float, tick: float) -> None:
    """Let a drop target fall, and set the clock of its bank if it was the last one."""
    world, board = lane.world, geometry.board
    change_switches(world, board, world.off | c.switch, time)
    mask = board.bank_switches[c.number]
    if world.off & mask == mask:
        world.banks_due |= 1 << c.number
        due, offset = later(world.tick, time + board.bank_time[c.number], tick)
        world.bank_tick[c.number], world.bank_offset[c.number] = due, offset


@internal
def change_switches(world: WorldRecord, board: BoardRecord, off: int, time: float) -> None:
    """Set which colliders are away, from a time of the tick [s] on."""
    world.off = off
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and ball.motion != Motion.CAPTURED:
            search_from(ball, ball.age + time)


@internal
def _reset_bank(lane: Lane, geometry: BoardGeometry, number: int, time: float) -> None:
    """Let a bank come back; if a ball is in the way, it is tried again in the next tick."""
    world, board = lane.world, geometry.board
    mask = board.bank_switches[number]
    if not is_free_of_balls(world, geometry, mask, time):
        world.bank_tick[number], world.bank_offset[number] = world.tick + 1, 0.0
        return
    world.banks_due &= ~(1 << number)
    change_switches(world, board, world.off & ~mask, time)
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = geometry.colliders[index]
        if c.switch & mask != 0:
            log_part_event(lane.log, as_int(EventKind.RESET), c, world.tick, time)


@kernel
def is_free_of_balls(world: WorldRecord, geometry: BoardGeometry, switches: int, time: float) -> bool:
    """Whether no ball overlaps a collider with one of these switches at a time of the tick [s]."""
    board = geometry.board
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = geometry.colliders[index]
        if c.switch & switches == 0:
            continue
        for slot in range(board.max_balls):
            ball = world.ball[slot]
            if ball.id != 0 and c.levels >> ball.level & 1 != 0:
                at = state_at(ball, ball.age + time)
                gap, _, _ = distance(c, at.x, at.z)
                if gap < board.ball_radius + FREE_GAP:
                    return False
    return True


@for_devices(lambda world, geometry, switches, is_away: False)
@kernel
def set_switch(world: WorldRecord, geometry: BoardGeometry, switches: int, is_away: bool) -> bool:
    """Open or close gates between two ticks.

    Returns:
        Whether they are open or closed now as wanted; they do not close on a ball.
    """
    if is_away:
        change_switches(world, geometry.board, world.off | switches, 0.0)
        return True
    if not is_free_of_balls(world, geometry, switches, 0.0):
        return False
    change_switches(world, geometry.board, world.off & ~switches, 0.0)
    return True


@for_devices(lambda world, geometry, tick: None)
@internal
def validate_devices(world: WorldRecord, geometry: BoardGeometry, tick: float) -> None:
    """Make the state of the devices in a world from outside a possible one."""
    board, colliders = geometry.board, geometry.colliders
    world.off &= board.switches
    world.banks_due &= (1 << board.banks) - 1
    world.launch_held = min(max(world.launch_held, 0), world.tick) if board.plungers != 0 else 0
    for number in range(board.banks):
        mask = board.bank_switches[number]
        is_possible = world.off & mask == mask and 0.0 <= world.bank_offset[number] <= tick
        if not is_possible:
            world.banks_due &= ~(1 << number)
        if world.off & mask == mask and world.banks_due >> number & 1 == 0:
            world.banks_due |= 1 << number
            due, offset = later(world.tick, board.bank_time[number], tick)
            world.bank_tick[number], world.bank_offset[number] = due, offset
    for number in range(board.spinners):
        spinner = world.spinner[number]
        c = colliders[board.collider_first + board.spinner_row[number]]
        if not _is_possible_spinner(spinner, c, board, world.tick, tick):
            spinner.angle, spinner.speed, spinner.turns = 0.0, 0.0, 0
            spinner.tick, spinner.offset = world.tick, 0.0
    set_next_clock(world, geometry, tick)


@internal
def _is_possible_spinner(
    spinner: SpinnerRecord, c: ColliderRecord, board: BoardRecord, now: int, tick: float
) -> bool:
    """Whether a spinner can have this state: all turns of the past were counted, and no others."""
    if not (abs(spinner.angle) < 3.2 and abs(spinner.speed) * c.blade <= board.speed_cap * 1.001):
        return False
    if not (0.0 <= spinner.offset <= tick and 0 <= spinner.tick <= now and spinner.turns >= 0):
        return False
    return spinner.speed == 0.0 or _time_of_next_turn(spinner, c, now, tick) > -tick


@for_devices(lambda ball, board, colliders, tick: False)
@internal
def is_possible_capture(ball: BallRecord, board: BoardRecord, colliders: Colliders, tick: float) -> bool:
    """Whether a device can hold a captured ball as its record says."""
    if not 0 <= ball.holder < board.collider_end - board.collider_first:
        return False
    c = colliders[board.collider_first + ball.holder]
    return bool(
        c.role in (Device.HOLE, Device.PLUNGER)
        and ball.x == c.x
        and ball.z == c.z
        and ball.start_x == c.x
        and ball.start_z == c.z
        and ball.vx == 0.0
        and ball.vz == 0.0
        and ball.start_vx == 0.0
        and ball.start_vz == 0.0
        and ball.accel_x == 0.0
        and ball.accel_z == 0.0
        and 0.0 <= ball.due_offset <= tick
        and ball.due_tick >= 0
    )


@internal
def free_plunger(world: WorldRecord, board: BoardRecord, colliders: Colliders) -> int:
    """Find the row of a plunger on which a new ball can lie; −1 if there is none."""
    for row in range(board.plunger_row, board.collider_end - board.collider_first):
        c = colliders[board.collider_first + row]
        if c.role == Device.PLUNGER:
            is_free = True
            reach = 2.0 * board.ball_radius + FREE_GAP
            for slot in range(board.max_balls):
                ball = world.ball[slot]
                dx, dz = ball.x - c.x, ball.z - c.z
                if ball.id != 0 and c.levels >> ball.level & 1 != 0 and dx * dx + dz * dz < reach * reach:
                    is_free = False
            if is_free:
                return row
    return -1
