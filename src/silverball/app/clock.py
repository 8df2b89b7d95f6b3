"""How much real time becomes how many ticks? Whole ones; the rest is kept, a stall is not caught up."""

from __future__ import annotations

MOST_SECONDS = 0.05
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
        return max(1, round(MOST_SECONDS * self.tick_rate * max(self.speed, 1.0)))

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
