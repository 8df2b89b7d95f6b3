"""How loud does a wave seem? Its moment with the most power, weighted by pitch as the ear does.

K-weighting is that of broadcast loudness: two filters, a shelf that lifts what lies above 2 kHz by 4 dB and a
high-pass at 38 Hz. Source: Recommendation ITU-R BS.1770-5 (2023), annex 1; here as a factor for every pitch.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.synth import RATE, Wave

MOMENT = 0.1
"""Length of a moment [s]: about what the ear takes as one."""

_SHELF_PITCH, _SHELF_GAIN, _SHELF_Q = 1681.974450955533, 3.999843853973347, 0.7071752369554196
_LOW_PITCH, _LOW_Q = 38.13547087602444, 0.5003270373238773


def loudness(wave: Wave) -> float:
    """The loudness of the moment with the most power [dB]; a full sine of 1 kHz has −3 dB, silence −inf."""
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
    """The factor for every pitch of a Fourier transform of so many samples."""
    # The analogue prototypes, without the warping of the digital ones: the same up to 0.3 dB below 10 kHz.
    s = 1j * np.fft.rfftfreq(count, 1.0 / RATE)
    lift = 10.0 ** (_SHELF_GAIN / 20.0)
    shelf = s / _SHELF_PITCH
    high = (lift * shelf**2 + math.sqrt(lift) * shelf / _SHELF_Q + 1.0) / (shelf**2 + shelf / _SHELF_Q + 1.0)
    low = s / _LOW_PITCH
    weight: NDArray[np.float64] = np.abs(high * low**2 / (low**2 + low / _LOW_Q + 1.0))
    return weight
