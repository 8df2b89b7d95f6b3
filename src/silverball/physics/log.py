"""How is an event written down, and how does the next call know what this one has left?"""

from __future__ import annotations

from typing import Any

from silverball.physics.kernel import inlined, internal
from silverball.physics.layout import LOG_RESERVE, LOG_SIZE, EventKind


@internal
def record(
    log: Any, kind: int, ball: Any, part: int, tick: int, offset: float, nx: float, nz: float, speed: float
) -> None:
    """Append an event of a ball where it is (see `layout.EVENT`) to a world's log, or count it as lost."""
    room = LOG_SIZE - LOG_RESERVE if kind <= EventKind.BALL_TOUCH else LOG_SIZE
    if log.count >= room:
        log.lost += 1
        return
    event = log.event[log.count]
    log.count += 1
    event.kind, event.part, event.ball = kind, part, ball.id
    event.tick, event.offset = tick, offset
    event.x, event.z = ball.x, ball.z
    event.normal_x, event.normal_z = nx, nz
    event.speed = speed


@inlined
def leave(world: Any, log: Any) -> None:
    """Keep in the log what a call leaves."""
    log.mark = mark(world)


@inlined
def mark(world: Any) -> float:
    """A number that tells flights, what they lead to, and angles from others, if nobody seeks one like it."""
    a, b = world.ball[0], world.ball[1]
    first = (2.0 * a.from_x + 3.0 * a.from_z) + (5.0 * a.from_vx + 7.0 * a.from_vz)
    second = (11.0 * b.from_x + 13.0 * b.from_z) + (17.0 * b.from_vx + 19.0 * b.from_vz)
    next_ones = (a.due + a.meets) + (23.0 * b.due + 29.0 * b.meets)
    return (first + second) + (next_ones + (31.0 * world.paddle[0].angle + 37.0 * world.paddle[1].angle))
