"""How long from a button to the simulation, and to the picture? Measured on every press of a paddle button.

What is measured begins when the program hears of the button. The system's own way from the key to the program
and from the program to the screen's light cannot be seen from in here.
"""

from __future__ import annotations

import time
from collections import deque

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
