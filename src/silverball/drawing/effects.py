"""What is seen for a while? Hits light up a part, balls leave trails and dive under the apron.

All of it is a function of the world's own time, so that a film of the same game always looks the same and a
paused game holds still.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from silverball.drawing.moment import BallAt, Moment

if TYPE_CHECKING:
    from silverball.world import Event

FLASH_SECONDS = 0.4
TRAIL_SECONDS = 0.11
TRAIL_SPACING = 0.16  # [u] between two spots of a trail
DIVE_SECONDS = 0.2
LEAST_DIVE_SPEED = 2.0  # [u/s]


class Spot(NamedTuple):
    """A spot of a trail: place (x, z) [u] and age from 0 (now) to 1 (gone)."""

    x: float
    z: float
    age: float


class _Dive(NamedTuple):
    time: float
    x: float
    z: float
    speed: float


class Effects:
    """Remembers the last moments of a game for as long as they are seen."""

    def __init__(self) -> None:
        self._hits: dict[str, float] = {}
        self._dives: list[_Dive] = []
        self._paths: dict[int, deque[tuple[float, float, float]]] = {}

    def forget(self) -> None:
        """Forget everything: another game begins."""
        self._hits.clear()
        self._dives.clear()
        self._paths.clear()

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Remember what happened."""
        for event in events:
            time = event.tick / tick_rate + event.offset
            if event.kind == "hit":
                self._hits[event.part] = time
            elif event.kind == "gutter":
                speed = max(event.speed, LEAST_DIVE_SPEED)
                self._dives.append(_Dive(time, event.position[0], event.position[2], speed))

    def flashes(self, time: float) -> Iterator[tuple[str, float]]:
        """The parts that light up at a time, and how strongly, 1 to 0."""
        for part, hit in list(self._hits.items()):
            left = 1.0 - (time - hit) / FLASH_SECONDS
            if left <= 0.0:
                del self._hits[part]
            else:
                yield part, min(left, 1.0) ** 2

    def dives(self, time: float) -> Iterator[BallAt]:
        """Balls on their way under the apron; the world no longer knows them."""
        self._dives = [dive for dive in self._dives if time - dive.time < DIVE_SECONDS]
        for dive in self._dives:
            yield BallAt(0, dive.x - dive.speed * max(time - dive.time, 0.0), dive.z)

    def trails(self, moment: Moment) -> Iterator[Spot]:
        """Note where the balls are, and give the spots of their trails."""
        for id_ in self._paths.keys() - {ball.id for ball in moment.balls}:
            del self._paths[id_]
        for ball in moment.balls:
            path = self._paths.setdefault(ball.id, deque())
            if not path or path[-1][0] < moment.time:
                path.append((moment.time, ball.x, ball.z))
            while moment.time - path[0][0] > TRAIL_SECONDS:
                path.popleft()
            yield from _spots(path, moment.time)


def _spots(path: deque[tuple[float, float, float]], now: float) -> Iterator[Spot]:
    """Spots at even distances along a path."""
    along = 0.0
    for (time0, x0, z0), (time1, x1, z1) in zip(path, list(path)[1:], strict=False):
        length = ((x1 - x0) ** 2 + (z1 - z0) ** 2) ** 0.5
        while along < length:
            part = along / length
            age = (now - (time0 + part * (time1 - time0))) / TRAIL_SECONDS
            yield Spot(x0 + part * (x1 - x0), z0 + part * (z1 - z0), min(max(age, 0.0), 1.0))
            along += TRAIL_SPACING
        along -= length
