"""Timing of the window: real time into ticks, frame times, and the latency of the buttons."""

from __future__ import annotations

import time
from collections import deque

MAX_CATCH_UP = 0.05
"""Greatest real time [s] that one frame advances: below 20 frames a second the game slows down. A larger
limit would make it jump after a stall, and would hang a machine that is too slow for its ticks."""


class TickClock:
    """Converts real time into whole ticks; the remainder is carried over, and a stall is not caught up with.

    Args:
        tick_rate: Ticks per second of play.

    Attributes:
        speed: Seconds of play per second of real time.
    """

    def __init__(self, tick_rate: int) -> None:
        self.tick_rate = tick_rate
        self.speed = 1.0
        self._due = 0.0  # [tick]

    @property
    def max_ticks(self) -> int:
        """The greatest number of ticks per call."""
        return max(1, round(MAX_CATCH_UP * self.tick_rate * max(self.speed, 1.0)))

    @property
    def fraction(self) -> float:
        """The fraction of the next tick that has passed, 0 to 1, for drawing between two ticks."""
        return min(self._due, 1.0)

    def advance(self, seconds: float) -> int:
        """Return the ticks that are due after more real time [s]."""
        self._due += max(seconds, 0.0) * self.tick_rate * self.speed
        if self._due >= self.max_ticks:
            self._due = 0.0
            return self.max_ticks
        ticks = int(self._due)
        self._due -= ticks
        return ticks


class FrameTimes:
    """Statistics of the frames of the last second."""

    def __init__(self) -> None:
        self._times: deque[float] = deque()
        self._sum = 0.0
        self._last: float | None = None

    def add(self, now: float) -> None:
        """Record a frame at a time [s]."""
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


KEPT_PRESSES = 64


class LatencyMeter:
    """Latency of the last presses of a paddle button.

    Measurement begins when the program receives the event: the path from the key to the program, and from the
    program to the light of the screen, cannot be measured.

    Attributes:
        to_tick: Time from the event to the end of the tick that moved the paddle [s].
        to_picture: Time from the event to the moment when its frame was passed to the screen [s].
    """

    def __init__(self) -> None:
        self.to_tick: deque[float] = deque(maxlen=KEPT_PRESSES)
        self.to_picture: deque[float] = deque(maxlen=KEPT_PRESSES)
        self._pressed: list[float] = []
        self._moved: list[float] = []
        self._drawn: list[float] = []

    def record_press(self) -> None:
        """Record that a paddle button went down."""
        self._pressed.append(time.perf_counter())

    def record_tick(self) -> None:
        """Record that the world has advanced with all buttons pressed so far."""
        if self._pressed:
            now = time.perf_counter()
            self.to_tick.extend(now - pressed for pressed in self._pressed)
            self._moved += self._pressed
            self._pressed.clear()

    def record_draw(self) -> None:
        """Record that a frame of the current world was drawn."""
        self._drawn += self._moved
        self._moved.clear()

    def record_flip(self) -> None:
        """Record that this frame was passed to the screen."""
        if self._drawn:
            now = time.perf_counter()
            self.to_picture.extend(now - pressed for pressed in self._drawn)
            self._drawn.clear()

    def reset(self) -> None:
        """Drop open measurements, because no game is running."""
        for presses in (self._pressed, self._moved, self._drawn):
            presses.clear()


def median(values: deque[float]) -> float:
    """Return the median [s]; 0 without values."""
    ordered = sorted(values)
    return ordered[len(ordered) // 2] if ordered else 0.0
