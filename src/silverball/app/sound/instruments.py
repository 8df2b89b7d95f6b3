"""The instruments of the music: notes as sums of tones, and a few drums. All are mono, at equal loudness.

A note is as loud as the ear weighs it (`levels.loudness`), so that a melody keeps its level from low to high
and every timbre can take every part.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from silverball.app.sound.levels import loudness
from silverball.app.sound.synth import (
    BELL,
    RATE,
    TUNED_BAR,
    Partial,
    Wave,
    as_float32,
    envelope,
    glide,
    noise,
    puff,
    ring,
    sample_count,
)

NOTE_LEVEL = -20.0
"""Loudness of every note [dB]; the layers of the music scale it."""

DRUM_SEED = 808
HARMONICS = tuple(float(number) for number in range(1, 13))
ODD = HARMONICS[::2]
BRIGHTEST = 10_000.0  # [Hz] partials above are left out
SUSTAINED = 60.0  # [s] decay of a tone that is held


class Timbre(NamedTuple):
    """How an instrument sounds.

    Attributes:
        ratios: Ratios of its partials to the lowest.
        slope: Strength of a partial is ratio^−slope.
        decay: Time in which the lowest partial falls by 60 dB [s].
        damping: Decay of a partial is decay · ratio^−damping.
        spread: Each tone is two, this share of the pitch apart: they beat.
        attack: Time to full strength [s].
        release: Time to silence after the end of the note [s].
    """

    ratios: tuple[float, ...]
    slope: float
    decay: float
    damping: float = 0.0
    spread: float = 0.0
    attack: float = 0.004
    release: float = 0.06


SAW_PAD = Timbre(HARMONICS[:8], 1.3, SUSTAINED, spread=0.006, attack=0.18, release=0.6)
ORGAN = Timbre((1.0, 2.0, 3.0, 4.0, 6.0), 0.9, SUSTAINED, spread=0.002, attack=0.05, release=0.3)
BREATH = Timbre((1.0, 2.0, 3.0, 5.0), 1.9, SUSTAINED, spread=0.004, attack=0.3, release=0.9)
SAW_BASS = Timbre(HARMONICS, 1.0, 1.1, 0.9, spread=0.002, release=0.05)
ROUND_BASS = Timbre(HARMONICS[:6], 1.6, 0.9, 0.6, release=0.06)
SAW_PLUCK = Timbre(HARMONICS, 0.9, 0.7, 0.7, spread=0.004, release=0.2)
MUSIC_BOX = Timbre(BELL, 0.9, 1.2, 0.7, release=0.5)
MARIMBA = Timbre(TUNED_BAR, 1.1, 0.5, 0.8, release=0.2)
SQUARE_LEAD = Timbre(ODD, 1.05, 3.0, 0.3, spread=0.005, attack=0.012, release=0.15)
REED_LEAD = Timbre(HARMONICS[:9], 0.8, SUSTAINED, spread=0.0015, attack=0.03, release=0.12)
GLASS_LEAD = Timbre((1.0, 2.0, 3.01, 5.4), 1.2, 1.6, 0.4, spread=0.001, attack=0.008, release=0.5)


def played(timbre: Timbre, pitch: float, seconds: float) -> Wave:
    """Return a note of a pitch [Hz] that is held for some seconds and then dies away."""
    return levelled_note(sounded(timbre, pitch, seconds))


def sounded(timbre: Timbre, pitch: float, seconds: float) -> Wave:
    """Return a note before its loudness is set."""
    length = seconds + timbre.release
    partials = []
    for ratio in timbre.ratios:
        tone = pitch * ratio
        if tone > BRIGHTEST:
            continue
        strength, decay = ratio**-timbre.slope, timbre.decay * ratio**-timbre.damping
        partials.append(Partial(tone * (1.0 - 0.5 * timbre.spread), strength, decay))
        if timbre.spread:
            partials.append(Partial(tone * (1.0 + 0.5 * timbre.spread), strength, decay))
    return ring(partials, length) * _held(length, timbre.attack, timbre.release)


def kick() -> Wave:
    """Return a bass drum: a tone that falls from 190 to 48 Hz, and its click."""
    random = np.random.default_rng(DRUM_SEED)
    body = glide(lambda t: 48.0 + 142.0 * np.exp(-14.0 * t), 0.28) * envelope(0.28, 0.001, 0.34)
    body[: sample_count(0.02)] += 0.5 * puff(0.02, 1500.0, 5000.0, 0.012, random)
    return levelled_note(body * _held(0.28, 0.0005, 0.03))


def snare() -> Wave:
    """Return a snare drum: a skin of two tones and a burst of noise."""
    random = np.random.default_rng(DRUM_SEED + 1)
    skin = ring([Partial(185.0, 1.0, 0.14), Partial(331.0, 0.6, 0.1)], 0.26)
    wires = noise(0.26, 1400.0, 7000.0, random) * envelope(0.26, 0.001, 0.24)
    return levelled_note((skin + 0.7 * wires) * _held(0.26, 0.0005, 0.03))


def hat(decay: float) -> Wave:
    """Return a cymbal that falls by 60 dB in a time [s]: 0.05 closed, 0.3 open."""
    random = np.random.default_rng(DRUM_SEED + 2)
    seconds = 1.1 * decay
    metal = puff(seconds, 6500.0, 12_000.0, decay, random, rise=0.0008)
    return levelled_note(metal * _held(seconds, 0.0005, 0.01))


def levelled_note(wave: Wave) -> Wave:
    """Scale a note to `NOTE_LEVEL`."""
    return as_float32(wave * np.float32(10.0 ** ((NOTE_LEVEL - loudness(wave)) / 20.0)))


def _held(seconds: float, attack: float, release: float) -> Wave:
    """An envelope of a whole note: up within the attack, down within the release, zero at both ends."""
    time = np.arange(sample_count(seconds)) / RATE
    shape = np.minimum(np.minimum(time / attack, 1.0), (time[-1] - time) / release)
    return as_float32(0.5 - 0.5 * np.cos(np.pi * np.clip(shape, 0.0, 1.0)))
