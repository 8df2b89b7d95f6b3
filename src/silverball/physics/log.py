"""How is an event written down?"""

from __future__ import annotations

from typing import Any

from silverball.physics.kernel import kernel
from silverball.physics.layout import LOG_RESERVE, LOG_SIZE, EventKind


@kernel
def record(
    log: Any,
    kind: int,
    part: int,
    ball: int,
    tick: int,
    offset: float,
    x: float,
    z: float,
    nx: float,
    nz: float,
    speed: float,
) -> None:
    """Append an event (see `layout.EVENT`) to a world's log, or count it as lost when the log is full."""
    room = LOG_SIZE - LOG_RESERVE if kind <= EventKind.BALL_TOUCH else LOG_SIZE
    if log.count >= room:
        log.lost += 1
        return
    event = log.event[log.count]
    log.count += 1
    event.kind, event.part, event.ball = kind, part, ball
    event.tick, event.offset = tick, offset
    event.x, event.z = x, z
    event.normal_x, event.normal_z = nx, nz
    event.speed = speed
