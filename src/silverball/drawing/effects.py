"""Effects that last for a moment: flashes of parts that were hit, sparks, trails of balls, light shows.

All are functions of the world's time, so films of the same game are equal and a paused game stands still.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from silverball.drawing.light_shows import ALWAYS, EVENT_SHOWS, SHOWS, Running
from silverball.drawing.moment import BallAt, Moment
from silverball.game.view import GameEvent, GameEventKind

if TYPE_CHECKING:
    from silverball.world import Event

FLASH_SECONDS = 0.45
TRAIL_SECONDS = 0.13
TRAIL_SPACING = 0.7  # between two spots of a trail, in radii of a ball
SINK_SECONDS = 0.2
MAX_AHEAD = 0.25  # [s]; an event farther in the future is older than a rewind of the game
MIN_SINK_SPEED = 2.0  # [u/s]
SPARK_SPEED = 6.0  # [u/s] least speed of an impact with sparks
SPARK_SECONDS = 0.38
MAX_SPARKS = 12  # sparks of one hit
SPARK_GRAVITY = 14.0  # [u/s²] back to the playfield
MAX_HITS = 24  # whose sparks are remembered
LIT_BY = frozenset({"hit", "pass", "spin", "captured"})  # kinds of events at which a part lights up
GOLDEN = 0.6180339887498949  # the fractional parts of its multiples are spread evenly over 0 to 1


class Spot(NamedTuple):
    """A spot of light: position and radius [u], and strength from 1 (new) to 0 (invisible)."""

    x: float
    y: float
    z: float
    radius: float
    strength: float


class Kick(NamedTuple):
    """A hit of a part: when it was [s], and where the ball was [u]."""

    time: float
    x: float
    z: float


class _SinkingBall(NamedTuple):
    time: float
    x: float
    z: float
    speed: float


class _Begun(NamedTuple):
    """The light show that began last, and when [s]."""

    name: str
    time: float


class _Hit(NamedTuple):
    time: float
    number: int
    x: float
    z: float
    normal: float  # its direction [rad], from +z to +x
    speed: float


class Effects:
    """Remembers the recent hits and paths of a game for as long as they are visible.

    Args:
        radius: Of a ball [u].
        is_full: Whether to show trails and sparks; otherwise only flashes, and weaker ones.
    """

    def __init__(self, radius: float = 0.25, *, is_full: bool = True) -> None:
        self.is_full = is_full
        self._radius = radius
        self._hits: dict[str, float] = {}
        self._kicks: dict[str, Kick] = {}
        self._sparks: deque[_Hit] = deque(maxlen=MAX_HITS)
        self._sinking: list[_SinkingBall] = []
        self._paths: dict[int, deque[tuple[float, float, float]]] = {}
        self._show: _Begun | None = None
        self._is_ball_ready = False

    def clear(self) -> None:
        """Discard everything, because another game begins."""
        self._hits.clear()
        self._kicks.clear()
        self._sparks.clear()
        self._sinking.clear()
        self._paths.clear()
        self._show, self._is_ball_ready = None, False

    def add_events(self, events: Iterable[Event], tick_rate: int) -> None:
        """Remember events of a world; `tick_rate` is in ticks per second."""
        for event in events:
            time = event.tick / tick_rate + event.offset
            if event.kind in LIT_BY:
                self._hits[event.part] = time
                self._kicks[event.part] = Kick(time, event.position[0], event.position[2])
            elif event.kind == "created" and self._is_ball_ready:
                self._is_ball_ready = False
                self._show = _Begun("ball start", time)
            elif event.kind == "gutter":
                speed = max(event.speed, MIN_SINK_SPEED)
                self._sinking.append(_SinkingBall(time, event.position[0], event.position[2], speed))
            if event.kind in ("hit", "ball_hit") and event.speed > SPARK_SPEED:
                nx, _, nz = event.normal
                x, z = event.position[0] - nx * self._radius, event.position[2] - nz * self._radius
                number = event.tick + 7 * event.ball
                self._sparks.append(_Hit(time, number, x, z, math.atan2(nx, nz), event.speed))

    def add_game_events(self, events: Iterable[GameEvent], tick_rate: int) -> None:
        """Remember the light show that events of a game begin; `tick_rate` is in ticks per second."""
        for event in events:
            name = event.part if event.kind is GameEventKind.CUE else EVENT_SHOWS.get(event.kind)
            time = event.tick / tick_rate
            if event.kind is GameEventKind.BALL_READY:
                self._is_ball_ready = True
            if name not in SHOWS or (event.kind is GameEventKind.BALL_READY and event.tick == 0):
                continue
            running = self.show(time)
            if event.kind in ALWAYS or running is None or SHOWS[name].rank >= SHOWS[running.name].rank:
                self._show = _Begun(name, time)

    def show(self, time: float) -> Running | None:
        """Return the light show that runs at a time [s]; None if none does."""
        if self._show is None:
            return None
        age = time - self._show.time
        if not -MAX_AHEAD < age < SHOWS[self._show.name].seconds:
            return None
        return Running(self._show.name, max(age, 0.0))

    def flashes(self, time: float) -> Iterator[tuple[str, float]]:
        """Yield the parts that flash at a time [s], with a strength from 1 to 0."""
        for part, hit in list(self._hits.items()):
            left = 1.0 - (time - hit) / FLASH_SECONDS
            if left <= 0.0 or time - hit <= -MAX_AHEAD:
                del self._hits[part]
            else:
                strength = min(left, 1.0) ** 2
                yield part, strength if self.is_full else 0.4 * strength

    def kick(self, part: str, time: float) -> Kick | None:
        """Return the last hit of a part before a time [s]; None if there was none."""
        kick = self._kicks.get(part)
        return None if kick is None or time - kick.time <= -MAX_AHEAD else kick

    def sinking_balls(self, time: float) -> Iterator[BallAt]:
        """Yield balls that roll under the apron at a time [s]; the world has removed them already."""
        self._sinking = [ball for ball in self._sinking if -MAX_AHEAD < time - ball.time < SINK_SECONDS]
        for ball in self._sinking:
            yield BallAt(0, ball.x - ball.speed * max(time - ball.time, 0.0), ball.z)

    def trails(self, moment: Moment) -> Iterator[tuple[int, list[Spot]]]:
        """Record the positions of the balls, and yield the id of each ball with the spots of its trail."""
        for id_ in self._paths.keys() - {ball.id for ball in moment.balls}:
            del self._paths[id_]
        for ball in moment.balls:
            path = self._paths.setdefault(ball.id, deque())
            if path and path[-1][0] > moment.time:
                path.clear()  # time was set back
            if not path or path[-1][0] < moment.time:
                path.append((moment.time, ball.x, ball.z))
            while moment.time - path[0][0] > TRAIL_SECONDS:
                path.popleft()
            if self.is_full:
                yield ball.id, list(self._spots(path, moment.time))

    def _spots(self, path: deque[tuple[float, float, float]], now: float) -> Iterator[Spot]:
        """Yield spots at even distances along a path; older ones are smaller."""
        along, spacing = 0.0, TRAIL_SPACING * self._radius
        for (time0, x0, z0), (time1, x1, z1) in zip(path, list(path)[1:], strict=False):
            length = math.hypot(x1 - x0, z1 - z0)
            while along < length:
                part = along / length
                fresh = 1.0 - (now - (time0 + part * (time1 - time0))) / TRAIL_SECONDS
                fresh = min(max(fresh, 0.0), 1.0)
                radius = self._radius * (0.35 + 0.65 * fresh)
                yield Spot(x0 + part * (x1 - x0), self._radius, z0 + part * (z1 - z0), radius, fresh * fresh)
                along += spacing
            along -= length

    def sparks(self, time: float) -> Iterator[list[Spot]]:
        """Yield the sparks of each hard hit at a time [s]."""
        if self.is_full:
            for hit in self._sparks:
                if 0.0 <= time - hit.time < SPARK_SECONDS:
                    yield list(self._sparks_of(hit, time - hit.time))

    def _sparks_of(self, hit: _Hit, age: float) -> Iterator[Spot]:
        for index in range(min(4 + int(hit.speed), MAX_SPARKS)):
            chance = (GOLDEN * (index + 1) + 0.317 * hit.number) % 1.0
            other = (7.0 * chance + 0.113 * index) % 1.0
            fresh = 1.0 - age / (SPARK_SECONDS * (0.5 + 0.5 * other))
            if fresh <= 0.0:
                continue
            direction = hit.normal + (chance - 0.5) * 2.6
            path = (2.0 + 0.32 * hit.speed * (0.4 + other)) * age * (1.0 - 0.9 * age)
            rise = self._radius + (1.0 + 3.0 * other) * age - 0.5 * SPARK_GRAVITY * age * age
            x, z = hit.x + path * math.sin(direction), hit.z + path * math.cos(direction)
            yield Spot(x, max(rise, 0.03), z, self._radius * (0.12 + 0.22 * fresh), fresh)
