"""Ducking: while a call sounds, the music and the rolling of balls step back."""

from __future__ import annotations

import math

DUCKED = 0.35
"""Strength of music and rolling under a call: 9 dB less."""

ROLL_UNDER_MUSIC = 0.7
"""Strength of rolling while music plays: 3 dB less."""

DOWN, UP = 0.05, 0.35
"""Time constants [s] of stepping back and of coming back."""

TAIL = 0.25
"""The last part of a call [s], which rings out under the music that comes back."""


class Ducker:
    """Knows how far music and rolling step back, frame by frame.

    Attributes:
        gain: Their strength now, `DUCKED` to 1.
    """

    def __init__(self) -> None:
        self.gain = 1.0
        self._left = 0.0  # [s] of the calls that sound

    def reset(self) -> None:
        """Forget all calls."""
        self.gain, self._left = 1.0, 0.0

    def call(self, seconds: float) -> None:
        """A call of some seconds begins."""
        self._left = max(self._left, seconds - TAIL)

    def update(self, seconds: float) -> float:
        """Return the strength after some more seconds."""
        goal, time = (DUCKED, DOWN) if self._left > 0.0 else (1.0, UP)
        self._left = max(self._left - seconds, 0.0)
        self.gain = goal + (self.gain - goal) * math.exp(-seconds / time)
        return self.gain
