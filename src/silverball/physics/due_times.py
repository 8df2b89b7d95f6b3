"""When something is due: in which tick, and at what time in it [s]."""

from __future__ import annotations

from math import floor

from silverball.physics.kernel import inlined


@inlined
def later(now: int, time: float, tick: float) -> tuple[int, float]:
    """Compute the tick, and the time in it [s], of what is due `time` [s] after the tick `now` began."""
    ticks = floor(time / tick)
    return now + int(ticks), min(max(time - ticks * tick, 0.0), tick)


@inlined
def is_due(now: int, due_tick: int, due_offset: float, time: float) -> bool:
    """Whether something is due at a time of the tick `now`."""
    return due_tick < now or (due_tick == now and due_offset <= time)
