"""The event log of a world, and the checksum by which the next call recognises an unchanged state."""

from __future__ import annotations

from silverball.physics.for_devices import ball_slots, for_devices, paddle_count
from silverball.physics.kernel import as_int, inlined, internal, mixed_bits, wrapped
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
    Lane,
    LogRecord,
    WorldRecord,
)


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
def flight_checksum(world: WorldRecord, board: BoardRecord) -> int:
    """Compute a number that identifies the flights, the next contacts and the paddles' angles.

    It is a sum of the bits of fields: it detects changed states, but does not protect against deliberate
    collisions.
    """
    checksum = as_int(0)
    if board.switches != 0 or board.sensors != 0:
        checksum += _device_checksum(world, board)
    if board.nudge != 0.0:
        checksum += _cabinet_checksum(world)
    for slot in range(ball_slots(world, board)):
        checksum += _ball_checksum(world.ball[slot])
    for index in range(paddle_count(world, board)):
        checksum += (3 + 2 * index) * mixed_bits(world.paddle[index].angle)
    return wrapped(checksum)


@for_devices(lambda world, board: as_int(0))
@internal
def _device_checksum(world: WorldRecord, board: BoardRecord) -> int:
    """Compute the share of the devices."""
    checksum = 3 * mixed_bits(world.off) + mixed_bits(world.next_clock)
    checksum += 5 * mixed_bits(world.launch_held) + 7 * mixed_bits(world.banks_due)
    for number in range(board.spinners):
        spinner = world.spinner[number]
        checksum += mixed_bits(spinner.angle) + mixed_bits(spinner.speed) + mixed_bits(spinner.turns)
        checksum += mixed_bits(spinner.tick) + mixed_bits(spinner.offset)
    for number in range(board.banks):
        checksum += mixed_bits(world.bank_tick[number]) + mixed_bits(world.bank_offset[number])
    return wrapped(checksum)


@for_devices(lambda world: as_int(0))
@internal
def _cabinet_checksum(world: WorldRecord) -> int:
    """Compute the share of the cabinet."""
    place = 3 * mixed_bits(world.cabinet_x) + 5 * mixed_bits(world.cabinet_z)
    return wrapped(place + 7 * mixed_bits(world.cabinet_vx) + 11 * mixed_bits(world.cabinet_vz))


@inlined
def _ball_checksum(ball: BallRecord) -> int:
    """Compute the share of one ball."""
    start = (
        mixed_bits(ball.start_x)
        + mixed_bits(ball.start_z)
        + mixed_bits(ball.start_vx)
        + mixed_bits(ball.start_vz)
    )
    motion = (
        mixed_bits(ball.accel_x)
        + mixed_bits(ball.accel_z)
        + mixed_bits(ball.offset)
        + mixed_bits(ball.motion)
    )
    contact = mixed_bits(ball.contact_age) + mixed_bits(ball.contact_row)
    return start + motion + contact + _place_checksum(ball)


@for_devices(lambda ball: as_int(0))
@inlined
def _place_checksum(ball: BallRecord) -> int:
    """Compute the share of the fields that balls of plain worlds do not have."""
    place = (
        mixed_bits(ball.level)
        + mixed_bits(ball.holder)
        + mixed_bits(ball.due_tick)
        + mixed_bits(ball.due_offset)
    )
    passed = mixed_bits(ball.passed_age) + mixed_bits(ball.passed_row)
    return place + passed + mixed_bits(ball.search_age) + mixed_bits(ball.solid_row)


@inlined
def count_score(lane: Lane, c: ColliderRecord) -> None:
    """Count an event that scores."""
    lane.world.score += c.points
    lane.tally[c.part] += 1
