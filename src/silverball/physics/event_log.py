"""The event log of a world, and the checksum by which the next call recognises an unchanged state."""

from __future__ import annotations

from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.records import (
    LOG_LENGTH,
    LOG_RESERVE,
    LOG_SIZE,
    MAX_BALLS,
    BallRecord,
    BoardRecord,
    ColliderRecord,
    Contact,
    EventKind,
    LogRecord,
    WorldRecord,
)

LOW_BITS = 1023


@internal
def begin_step(log: LogRecord) -> None:
    """Drop the events of the previous step, but not the balls created since it ended."""
    if log.count == 0 and log.lost == 0:
        return
    carried = min(max(log.count - log.done, 0), MAX_BALLS)
    first = log.count - carried
    for number in range(carried):
        log.event[number] = log.event[first + number]
    log.count, log.carried, log.done, log.lost = carried, carried, carried, 0


@inlined
def clear_log(log: LogRecord) -> None:
    """Drop all events, created balls included."""
    log.count, log.carried, log.done, log.lost = 0, 0, 0, 0


@internal
def log_event(
    log: LogRecord, kind: int, ball: BallRecord, tick: int, part: int, contact: Contact, speed: float
) -> None:
    """Append an event of a ball at its present position (see `records.EVENT`), or count it as lost."""
    capacity = log.carried + LOG_SIZE
    if kind <= EventKind.BALL_TOUCH:
        capacity -= LOG_RESERVE
    elif kind == EventKind.CREATED:
        capacity = as_int(LOG_LENGTH)
    if log.count >= capacity:
        log.lost += 1
        return
    event = log.event[log.count]
    log.count += 1
    event.kind, event.part, event.ball = kind, part, ball.id
    event.tick, event.offset = tick, contact.time
    event.x, event.z = ball.x, ball.z
    event.normal_x, event.normal_z = contact.nx, contact.nz
    event.speed = speed


@internal
def log_part_event(log: LogRecord, kind: int, c: ColliderRecord, tick: int, time: float) -> None:
    """Append an event of a part without a ball, at the place of its collider, or count it as lost."""
    if log.count >= log.carried + LOG_SIZE:
        log.lost += 1
        return
    event = log.event[log.count]
    log.count += 1
    event.kind, event.part, event.ball, event.tick, event.offset = kind, c.part, 0, tick, time
    event.x, event.z, event.normal_x, event.normal_z, event.speed = c.x, c.z, 0.0, 0.0, 0.0


@internal
def store_checksum(world: WorldRecord, board: BoardRecord, log: LogRecord) -> None:
    """Store the checksum of the state that a call leaves, for `validation.is_unchanged`."""
    log.checksum = flight_checksum(world, board)


@inlined
def flight_checksum(world: WorldRecord, board: BoardRecord) -> float:
    """Compute a number that identifies the flights, the next contacts and the paddles' angles.

    It detects changed states, but does not protect against deliberate collisions.
    """
    checksum = 0.0
    if board.switches != 0 or board.sensors != 0:
        checksum += _device_checksum(world, board)
    for slot in range(board.max_balls):
        checksum += _ball_checksum(world.ball[slot])
    for index in range(board.paddles):
        checksum += (3.0 + 2.0 * index) * world.paddle[index].angle
    return checksum


@internal
def _device_checksum(world: WorldRecord, board: BoardRecord) -> float:
    """Compute the share of the devices. Few bits of an integer count, so that no other digits are lost."""
    checksum = 3.0 * (world.off % 1021) + (world.next_clock & LOW_BITS)
    checksum += 5.0 * (world.launch_held & LOW_BITS) + 7.0 * (world.banks_due & LOW_BITS)
    for number in range(board.spinners):
        spinner = world.spinner[number]
        checksum += (spinner.angle + spinner.speed) + (spinner.tick & LOW_BITS) + spinner.offset
        checksum += spinner.turns & LOW_BITS
    for number in range(board.banks):
        checksum += (world.bank_tick[number] & LOW_BITS) + world.bank_offset[number]
    return checksum


@inlined
def _ball_checksum(ball: BallRecord) -> float:
    """Compute the share of one ball."""
    start = (ball.start_x + ball.start_z) + (ball.start_vx + ball.start_vz)
    motion = (ball.accel_x + ball.accel_z) + (ball.offset + ball.motion)
    place = (ball.level + ball.holder) + ((ball.due_tick & LOW_BITS) + ball.due_offset)
    search = (ball.search_age + ball.passed_age) + (ball.passed_row + ball.solid_row)
    return start + motion + (ball.contact_age + ball.contact_row) + (place + search)
