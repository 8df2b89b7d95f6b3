"""How is an event written down, and how does the next call know what this one has left?"""

from __future__ import annotations

from silverball.physics.kernel import inlined, internal
from silverball.physics.records import (
    LOG_RESERVE,
    LOG_SIZE,
    BallRecord,
    Contact,
    EventKind,
    LogRecord,
    WorldRecord,
)


@internal
def log_event(log: LogRecord, kind: int, ball: BallRecord, tick: int, contact: Contact, speed: float) -> None:
    """Append an event of a ball where it is (see `records.EVENT`) to a world's log, or count it as lost."""
    room = LOG_SIZE - LOG_RESERVE if kind <= EventKind.BALL_TOUCH else LOG_SIZE
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
def store_checksum(world: WorldRecord, log: LogRecord) -> None:
    """Keep in the log what a call leaves."""
    log.checksum = flight_checksum(world)


@inlined
def flight_checksum(world: WorldRecord) -> float:
    """A number that no other flights, contacts to come and angles have, if nobody seeks some that do."""
    angles = 3.0 * world.paddle[0].angle + 5.0 * world.paddle[1].angle
    return _ball_checksum(world.ball[0]) + _ball_checksum(world.ball[1]) + angles


@inlined
def _ball_checksum(ball: BallRecord) -> float:
    """The share of one ball."""
    begin = (ball.start_x + ball.start_z) + (ball.start_vx + ball.start_vz)
    pull = (ball.accel_x + ball.accel_z) + (ball.offset + ball.motion)
    return begin + pull + (ball.contact_age + ball.contact_part)
