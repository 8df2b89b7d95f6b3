"""How is an event written down, and how does the next call know what this one has left?"""

from __future__ import annotations

from typing import Any

from silverball.physics.kernel import inlined, internal
from silverball.physics.records import BALL_COUNT, LOG_LENGTH, LOG_RESERVE, LOG_SIZE, Contact, EventKind


@internal
def begin_step(log: Any) -> None:
    """Drop the events of the previous step, but not the balls created since it ended."""
    carried = min(max(log.count - log.done, 0), BALL_COUNT)
    first = log.count - carried
    for number in range(carried):
        log.event[number] = log.event[first + number]
    log.count, log.carried, log.done, log.lost = carried, carried, carried, 0


@internal
def log_event(log: Any, kind: int, ball: Any, tick: int, contact: Contact, speed: float) -> None:
    """Append an event of a ball where it is (see `records.EVENT`) to a world's log, or count it as lost."""
    room = log.carried + LOG_SIZE
    if kind <= EventKind.BALL_TOUCH:
        room -= LOG_RESERVE
    elif kind == EventKind.CREATED:
        room = LOG_LENGTH + 0
    if log.count >= room:
        log.lost += 1
        return
    event = log.event[log.count]
    log.count += 1
    event.kind, event.part, event.ball = kind, contact.part, ball.id
    event.tick, event.offset = tick, contact.time
    event.x, event.z = ball.x, ball.z
    event.normal_x, event.normal_z = contact.nx, contact.nz
    event.speed = speed


@internal
def store_checksum(world: Any, log: Any) -> None:
    """Keep in the log what a call leaves."""
    log.checksum = flight_checksum(world)


@inlined
def flight_checksum(world: Any) -> float:
    """A number that no other flights, contacts to come and angles have, if nobody seeks some that do."""
    angles = 3.0 * world.paddle[0].angle + 5.0 * world.paddle[1].angle
    return _ball_checksum(world.ball[0]) + _ball_checksum(world.ball[1]) + angles


@inlined
def _ball_checksum(ball: Any) -> float:
    """The share of one ball."""
    begin = (ball.start_x + ball.start_z) + (ball.start_vx + ball.start_vz)
    pull = (ball.accel_x + ball.accel_z) + (ball.offset + ball.motion)
    return begin + pull + (ball.contact_age + ball.contact_part)
