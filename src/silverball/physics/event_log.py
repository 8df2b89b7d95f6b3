"""How is an event written down, and how does the next call know what this one has left?"""

from __future__ import annotations

from typing import Any

from silverball.physics.kernel import inlined, internal
from silverball.physics.records import LOG_RESERVE, LOG_SIZE, Contact, EventKind


@internal
def record(log: Any, kind: int, ball: Any, tick: int, contact: Contact, speed: float) -> None:
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
def leave(world: Any, log: Any) -> None:
    """Keep in the log what a call leaves."""
    log.mark = mark(world)


@inlined
def mark(world: Any) -> float:
    """A number that no other flights, contacts to come and angles have, if nobody seeks some that do."""
    angles = 3.0 * world.paddle[0].angle + 5.0 * world.paddle[1].angle
    return mark_of(world.ball[0]) + mark_of(world.ball[1]) + angles


@inlined
def mark_of(ball: Any) -> float:
    """The share of one ball."""
    begin = (ball.from_x + ball.from_z) + (ball.from_vx + ball.from_vz)
    pull = (ball.pull_x + ball.pull_z) + (ball.offset + ball.motion)
    return begin + pull + (ball.due + ball.meets)
