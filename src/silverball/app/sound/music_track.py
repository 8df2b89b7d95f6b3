"""The music of a film: bars placed to the sample, in the mood that the game has when each begins."""

from __future__ import annotations

import numpy as np

from silverball.app.sound.bank import FULL
from silverball.app.sound.music import Band, Mood, Place
from silverball.app.sound.synth import RATE, Wave, as_float32

STOP_SECONDS = 0.12
"""How fast the music goes when a ball drains [s]."""


class MusicTrack:
    """Adds the music of a table to the samples of a film, frame by frame.

    Args:
        band: Who plays.
        volume: Strength of the music.
    """

    def __init__(self, band: Band, volume: float) -> None:
        self._band, self._volume = band, volume
        self._place: Place | None = None  # the bar that plays
        self._bar = np.zeros((2, 0), np.float32)
        self._at = 0  # the next sample of it
        self._strength = 0.0

    @property
    def is_heard(self) -> bool:
        """Whether music plays now."""
        return self._strength > 0.0

    def add(self, total: Wave, span: slice, mood: Mood | None, ducks: tuple[float, float]) -> None:
        """Add the music of a span of samples.

        Args:
            total: All samples, `[2, sample]`.
            span: The samples of a frame.
            mood: The mood in it; None: the music stops.
            ducks: How far the music steps back, at the start and at the end of the frame.
        """
        count = span.stop - span.start
        if mood is not None and not self.is_heard:
            self._place, self._at, self._bar = None, 0, self._bar[:, :0]
        first = self._strength
        change = count / (STOP_SECONDS * RATE)
        self._strength = max(first - change, 0.0) if mood is None else 1.0
        if first == 0.0 and mood is None:
            return
        first = 1.0 if mood is not None else first
        gains = np.linspace(first * ducks[0], self._strength * ducks[1], count, dtype=np.float32)
        done = 0
        while done < count:
            if self._at == self._bar.shape[1]:
                self._next_bar(mood)
            piece = self._bar[:, self._at : self._at + count - done]
            size = piece.shape[1]
            total[:, span.start + done : span.start + done + size] += (
                self._volume * gains[done : done + size] * piece
            )
            self._at += size
            done += size

    def _next_bar(self, mood: Mood | None) -> None:
        before = self._place
        if before is None:
            self._place = Place(0, mood or Mood(1))
        else:
            self._place = Place(before.number + 1, mood or before.mood)
        self._bar = as_float32(self._band.bar(self._place, before).T / FULL)
        self._at = 0
