"""How smoothly does it run? The times between the frames of the last second."""

from __future__ import annotations

from collections import deque


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
