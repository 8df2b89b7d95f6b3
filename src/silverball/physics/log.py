"""How is an event written down?"""

from __future__ import annotations

from typing import Any

from silverball.physics.kernel import internal
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
