"""Devices: what parts of a board do apart from bouncing balls.

* A *sensor* reports each ball that crosses it; a *passage* also changes the ball's level.
* A *spinner* turns after a ball has crossed it, and reports each turn.
* A *hole* captures balls and lets them go again; a *drain* takes them away for good.
* A *plunger* holds the balls that lie on it until the launch button is released, or until they are due.
* A *drop target* falls when it is hit; the bank to which it belongs comes back together.
* A *gate* is opened and closed by rules (`set_switch`).

`captures.py` has what holes, drains and plungers do with balls, `switches.py` drop targets and gates,
`spinner.py` the blades.

What devices do by themselves happens at exact times. `next_clock` of a world is the tick of the first of
them, so a tick without any of them costs nothing.

No device ever puts one thing into another: a ball changes its level, is captured or let go, and a drop target
or gate comes back, only where there is room; otherwise it is tried again (a passage throws the ball back).
"""

from __future__ import annotations

from silverball.physics.captures import enter_hole, has_room, is_clear, release_ball
from silverball.physics.due_times import is_due, later
from silverball.physics.event_log import count_score, log_event, log_part_event
from silverball.physics.flight import state_at
from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.motion import advance_to, start_flight, store
from silverball.physics.records import (
    NO_CLOCK,
    NOTHING,
    BallRecord,
    BoardGeometry,
    BoardRecord,
    Colliders,
    Contact,
    Device,
    EventKind,
    Lane,
    Motion,
    WorldRecord,
)
from silverball.physics.spinner import drive_spinner, time_of_next_turn, time_of_turn
from silverball.physics.switches import reset_bank
from silverball.physics.tolerances import NEVER


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
        enter_hole(lane, geometry, ball, row, time, tick)
        return
    if c.role == Device.PASSAGE:
        before = c.level_right if is_to_left else c.level_left
        after = c.level_left if is_to_left else c.level_right
        if ball.level != before:
            return  # it is on this level already
        advance_to(ball, board, age)
        if not (
            has_room(world, board, ball, ball.x, ball.z, after, time)
            and is_clear(lane, geometry, ball.x, ball.z, after, time)
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
    count_score(lane, c)
    log_event(lane.log, as_int(EventKind.PASS), ball, world.tick, c.part, contact, abs(speed))
    if c.role == Device.SPINNER:
        drive_spinner(world, board, ball, c, speed, time, tick)


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
        time = time_of_next_turn(world.spinner[number], c, world.tick, tick)
        if time < tick:
            first = min(first, max(time, 0.0))
    return first if first < tick else NEVER


@inlined
def is_held_for_a_time(ball: BallRecord, board: BoardRecord, colliders: Colliders) -> bool:
    """Whether a device holds a ball that it will let go by itself: a hole any, a plunger one that is due."""
    if ball.id == 0 or ball.motion != Motion.CAPTURED:
        return False
    return bool(ball.due_tick > 0 or colliders[board.collider_first + ball.holder].role == Device.HOLE)


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
        if is_held_for_a_time(ball, board, colliders) and is_due(
            world.tick, ball.due_tick, ball.due_offset, time
        ):
            release_ball(lane, geometry, ball, time)
    for number in range(board.banks):
        if world.banks_due >> number & 1 != 0 and is_due(
            world.tick, world.bank_tick[number], world.bank_offset[number], time
        ):
            reset_bank(lane, geometry, number, time)
    for number in range(board.spinners):
        c, spinner = colliders[board.collider_first + board.spinner_row[number]], world.spinner[number]
        if time_of_next_turn(spinner, c, world.tick, tick) <= time:
            spinner.turns += 1
            count_score(lane, c)
            log_part_event(lane.log, as_int(EventKind.SPIN), c, world.tick, time)
