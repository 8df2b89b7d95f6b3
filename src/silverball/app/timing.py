"""Timing of the window: real time into ticks, frame times, and the latency of the buttons."""

from __future__ import annotations

import time
from collections import deque

MAX_SECONDS = 0.05
"""Real time [s] that one frame may make up for. Below 20 frames a second the game slows down; larger values
make it jump after a stall, and a machine too slow for its ticks would hang."""


class TickClock:
    """Turns real time into ticks.

    Args:
        tick_rate: Ticks per second of play.

    Attributes:
        speed: Seconds of play per second of real time.
    """

    def __init__(self, tick_rate: int) -> None:
        self.tick_rate = tick_rate
        self.speed = 1.0
        self._owed = 0.0  # [tick]

    @property
    def most_ticks(self) -> int:
        """Ticks at once at most."""
        return max(1, round(MAX_SECONDS * self.tick_rate * max(self.speed, 1.0)))

    @property
    def share(self) -> float:
        """How much of the next tick has passed, 0 to 1: what a picture between two ticks shows."""
        return min(self._owed, 1.0)

    def advance(self, seconds: float) -> int:
        """The ticks that are due after so much more real time."""
        self._owed += max(seconds, 0.0) * self.tick_rate * self.speed
        if self._owed >= self.most_ticks:
            self._owed = 0.0
            return self.most_ticks
        ticks = int(self._owed)
        self._owed -= ticks
        return ticks


class FrameTimes:
    """Remembers the frames of the last second."""

    def __init__(self) -> None:
        self._times: deque[float] = deque()
        self._sum = 0.0
        self._last: float | None = None

    def add(self, now: float) -> None:
        """There is a frame at this time [s]."""
        if self._last is not None:
            self._times.append(now - self._last)
            self._sum += now - self._last
        self._last = now
        while len(self._times) > 1 and self._sum > 1.0:
            self._sum -= self._times.popleft()

    @property
    def per_second(self) -> float:
        """Frames per second."""
        return len(self._times) / self._sum if self._sum > 0.0 else 0.0

    @property
    def slowest(self) -> float:
        """The longest time between two frames [s]."""
        return max(self._times, default=0.0)


KEPT = 64  # presses that the percentiles are taken from


class LatencyMeter:
    """Remembers the last presses.

    Attributes:
        to_tick: From hearing a button to the end of the tick that moved its paddle [s].
        to_picture: From hearing it to the picture that shows it handed to the screen [s].
    """

    def __init__(self) -> None:
        self.to_tick: deque[float] = deque(maxlen=KEPT)
        self.to_picture: deque[float] = deque(maxlen=KEPT)
        self._heard: list[float] = []
        self._moved: list[float] = []
        self._drawn: list[float] = []

    def heard(self) -> None:
        """A paddle button went down."""
        self._heard.append(time.perf_counter())

    def ticked(self) -> None:
        """The world has moved on, with all buttons heard so far."""
        if self._heard:
            now = time.perf_counter()
            self.to_tick.extend(now - heard for heard in self._heard)
            self._moved += self._heard
            self._heard.clear()

    def drawn(self) -> None:
        """A picture of the world as it is was made."""
        self._drawn += self._moved
        self._moved.clear()

    def shown(self) -> None:
        """That picture was handed to the screen."""
        if self._drawn:
            now = time.perf_counter()
            self.to_picture.extend(now - heard for heard in self._drawn)
            self._drawn.clear()

    def forget(self) -> None:
        """No play is going on: what is held now moves no paddle."""
        for presses in (self._heard, self._moved, self._drawn):
            presses.clear()


def middle(values: deque[float]) -> float:
    """The median [s]; 0 if nothing was measured yet."""
    ordered = sorted(values)
    return ordered[len(ordered) // 2] if ordered else 0.0
