"""Loudness of a wave as the ear weighs it, strength of a hit by its speed, and panning by its place.

K-weighting, as for broadcast loudness, has two filters: a shelf that raises pitches above 2 kHz by 4 dB, and
a high-pass at 38 Hz. Source: Recommendation ITU-R BS.1770-5 (2023), annex 1; here as a factor for every
pitch.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.synth import RATE, Wave

MOMENT = 0.1
"""Window of the loudness measurement [s]: roughly the time over which the ear integrates."""

_SHELF_PITCH, _SHELF_GAIN, _SHELF_Q = 1681.974450955533, 3.999843853973347, 0.7071752369554196
_LOW_PITCH, _LOW_Q = 38.13547087602444, 0.5003270373238773


def loudness(wave: Wave) -> float:
    """Return the loudness of the loudest moment [dB]; a full sine of 1 kHz has −3 dB, silence −inf."""
    moment = round(MOMENT * RATE)
    if len(wave) > moment:
        power = np.cumsum(wave.astype(np.float64) ** 2)
        begin = int(np.argmax(power[moment:] - power[:-moment])) + 1
        wave = wave[begin : begin + moment]
    weighted = np.abs(np.fft.rfft(wave, moment)) * k_weight(moment)
    power_sum = 2.0 * float(np.sum(weighted**2)) / moment**2  # Parseval's theorem, for half of the spectrum
    return 10.0 * math.log10(power_sum) if power_sum > 0.0 else -math.inf


@lru_cache
def k_weight(count: int) -> NDArray[np.float64]:
    """Return the K-weight of every frequency of a Fourier transform of `count` samples."""
    # The analogue prototypes; the digital filters differ from them by up to 0.3 dB below 10 kHz.
    s = 1j * np.fft.rfftfreq(count, 1.0 / RATE)
    lift = 10.0 ** (_SHELF_GAIN / 20.0)
    shelf = s / _SHELF_PITCH
    high = (lift * shelf**2 + math.sqrt(lift) * shelf / _SHELF_Q + 1.0) / (shelf**2 + shelf / _SHELF_Q + 1.0)
    low = s / _LOW_PITCH
    weight: NDArray[np.float64] = np.abs(high * low**2 / (low**2 + low / _LOW_Q + 1.0))
    return weight


FULL_SPEED = 20.0
"""Impact speed [u/s] of a hit at full strength; the usual speed limit of a table is 22."""

LOUDNESS_POWER = 0.7
"""Strength = (speed / FULL_SPEED)^0.7, so twice the speed is 4.2 dB more. By energy it would be 6 dB, and the
soft touches of a long rally would be inaudible; 10 dB sound twice as loud."""

SPREAD = 0.75
"""Pan of the table's border; 1 would be entirely in one ear, which is unpleasant with headphones."""


def strength_of(speed: float) -> float:
    """Return the strength of a hit, 0 to 1, from its impact speed [u/s]."""
    return float(min(max(speed, 0.0) / FULL_SPEED, 1.0) ** LOUDNESS_POWER)


def pan(z: float, width: float) -> tuple[float, float]:
    """Return the strength in the left and right ear at a place z [u] on a table of a width [u].

    Constant power: their squares add up to 1, so that a ball is equally loud everywhere. Source:
    the sine and cosine law, e.g. C. Roads, "The Computer Music Tutorial" (1996), ch. 11.
    """
    side = SPREAD * min(max(2.0 * z / width, -1.0), 1.0)
    turn = 0.25 * math.pi * (1.0 + side)
    return math.cos(turn), math.sin(turn)
