"""The music as samples, bar by bar: `Band` plays the bars of a table in any mood, one after the other.

A bar is a function of its number, its mood and the bar before it, whose last notes still ring in it. So the
mood may change at any bar without a click, and bars that follow one another are, to the sample, one long
piece: the loop has no seam.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound import instruments
from silverball.app.sound.bank import Samples, to_samples
from silverball.app.sound.composition import BARS, BEATS, LAYERS, Composition, Tone, compose
from silverball.app.sound.instruments import NOTE_LEVEL, Timbre
from silverball.app.sound.levels import k_weight, pan
from silverball.app.sound.sound_sets import DEFAULT_SET, SoundSet
from silverball.app.sound.synth import RATE, Wave, as_float32, pitch_of, soft_limit
from silverball.table.file import table_digest

if TYPE_CHECKING:
    from silverball.table import Table

MUSIC_LEVEL = -20.0
"""Loudness of all layers together [dB] at full volume. At the usual one it is 5 dB less: hits stand out of
it, and calls by far."""

MUSIC_PEAK = 0.8
"""Greatest sample of the music; what is above is bent."""

LIFT = 7
"""Semitones by which a multiball raises the key: a fifth, with four of five notes in common."""

MAX_LEVEL = len(LAYERS)
KEPT_BARS = 6  # rendered bars that are kept: two moods of the present one and its neighbours

# Loudness of a note in each part [dB]; chosen by the spectra and levels of single layers.
PART_LEVELS = {
    "pad": -35.0, "bass": -27.0, "arpeggio": -29.0, "lead": -25.0, "run": -34.0,
    "kick": -25.0, "snare": -28.0, "hat": -32.0, "open_hat": -33.0,
}  # fmt: skip


class Mood(NamedTuple):
    """What the music is like.

    Attributes:
        level: How many layers play, 1 to `MAX_LEVEL`.
        lift: By how many semitones the key is raised.
    """

    level: int
    lift: int = 0


class Place(NamedTuple):
    """A bar of the music: its number, counted on without end, and its mood."""

    number: int
    mood: Mood


class Band:
    """Plays the music of a table.

    Args:
        seed: Seed of the composition.
        sounds: The timbres.

    Attributes:
        composition: What it plays.
        bar_samples: Length of a bar [sample].
        gain: What the strength of every note is multiplied by.
    """

    def __init__(self, seed: int, sounds: SoundSet = DEFAULT_SET) -> None:
        self.composition: Composition = compose(seed, sounds.tempo, sounds.swing)
        self._beat = 60.0 / self.composition.tempo  # [s]
        self.bar_samples = round(BEATS * self._beat * RATE)
        self._timbres = {
            "pad": sounds.pad, "bass": sounds.bass, "arpeggio": sounds.pluck, "run": sounds.pluck,
            "lead": sounds.lead,
        }  # fmt: skip
        self._kept: OrderedDict[Place, Wave] = OrderedDict()
        self.gain = 1.0
        self.gain = 10.0 ** ((MUSIC_LEVEL - self._full_loudness()) / 20.0)

    def bar(self, place: Place, before: Place | None = None) -> Samples:
        """Return a bar, int16 `[sample, 2]`; `before` is the one that has just been played, if any."""
        count = self.bar_samples
        played = self._rendered(place)[:, :count].copy()
        if before is not None:
            ringing = self._rendered(before)[:, count:]
            played += ringing[:, :count]
        bent = MUSIC_PEAK * soft_limit(played / np.float32(MUSIC_PEAK))
        return to_samples(np.ascontiguousarray(bent.T))

    def _rendered(self, place: Place) -> Wave:
        """A bar and, for one bar more, what rings on after it: `[2, sample]`."""
        place = Place(place.number % BARS, place.mood)
        if place in self._kept:
            self._kept.move_to_end(place)
            return self._kept[place]
        total = np.zeros((2, 2 * self.bar_samples), np.float32)
        for bars in self.composition.layers[: place.mood.level]:
            for tone in bars[place.number]:
                self._add(total, tone, place.mood.lift)
        self._kept[place] = total
        if len(self._kept) > KEPT_BARS:
            self._kept.popitem(last=False)
        return total

    def _add(self, total: Wave, tone: Tone, lift: int) -> None:
        wave = self._wave(tone, lift)
        at = round(tone.start * self._beat * RATE)
        level = self.gain * tone.strength * 10.0 ** ((PART_LEVELS[tone.instrument] - NOTE_LEVEL) / 20.0)
        for ear, strength in zip(total, pan(tone.side, 2.0), strict=True):
            part = ear[at : at + len(wave)]
            part += np.float32(level * strength) * wave[: len(part)]

    def _wave(self, tone: Tone, lift: int) -> Wave:
        timbre = self._timbres.get(tone.instrument)
        if timbre is None:
            return drum(tone.instrument)
        if tone.instrument == "bass" and lift > 5:
            lift -= 12  # it goes down where the others go up
        return note(timbre, tone.step, lift, round(tone.beats * self._beat, 4))

    def _full_loudness(self) -> float:
        """The loudness of a bar with all layers [dB]."""
        wave = self._rendered(Place(0, Mood(MAX_LEVEL)))[:, : self.bar_samples]
        self._kept.clear()
        weighted = np.abs(np.fft.rfft(wave, axis=1)) * k_weight(wave.shape[1])
        power = 2.0 * float(np.sum(weighted**2)) / wave.shape[1] ** 2
        return 10.0 * math.log10(power)


def band_of(table: Table, sounds: SoundSet) -> Band:
    """Return the band of a table: its digest is the seed."""
    return Band(int(table_digest(table)[:16], 16), sounds)


@lru_cache(maxsize=256)
def note(timbre: Timbre, step: int, lift: int, seconds: float) -> Wave:
    """Return a note: a step of the scale, raised by some semitones, held for some seconds."""
    return as_float32(instruments.played(timbre, pitch_of(step) * 2.0 ** (lift / 12.0), seconds))


@lru_cache(maxsize=8)
def drum(name: str) -> Wave:
    """Return a stroke of "kick", "snare", "hat" or "open_hat"."""
    strokes: dict[str, Callable[[], Wave]] = {
        "kick": instruments.kick, "snare": instruments.snare,
        "hat": lambda: instruments.hat(0.06), "open_hat": lambda: instruments.hat(0.3),
    }  # fmt: skip
    return strokes[name]()


def loop_of(band: Band, mood: Mood, bars: int = BARS) -> NDArray[np.int16]:
    """Return some bars of one mood as they follow one another, int16 `[sample, 2]`."""
    places = [Place(number, mood) for number in range(bars)]
    return np.concatenate(
        [band.bar(place, places[index - 1] if index else None) for index, place in enumerate(places)]
    )
