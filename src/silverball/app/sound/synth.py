"""Synthesis: sums of decaying tones, coloured noise and gliding tones, as pure functions, in one scale.

A wave is float32, shape `[sample]`, mono, at `RATE` samples a second. Times are in seconds, pitches in Hz.
Randomness comes only from the generator that is passed in, so the same seed makes the same wave.

The scale is G major pentatonic (G A B D E), in which no two notes clash: hits that coincide sound like a
chord.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

G4 = 440.0 * 2.0 ** (-2.0 / 12.0)
"""The root of the scale [Hz]; A4 is 440 Hz, twelve equal semitones make an octave."""

SCALE = (0, 2, 4, 7, 9)
"""G A B D E, in semitones above G."""

BELL_STEPS = 10
"""Steps of the bell: two octaves of the scale, so that the tenth hit in a row is an E6 of 1319 Hz."""

# Ratios of partials. A bar with free ends: the zeros of cos·cosh = 1, squared. A tuned bar (marimba): the
# second partial is carved to 4. A bell: hum, prime, tierce, quint and nominal of bell founding, with a major
# tierce. A skin: zeros of Bessel functions. Source: N. Fletcher, T. Rossing, "The Physics of Musical
# Instruments", 2nd ed. (1998), ch. 2, 3, 19 and 21.
BAR = (1.0, 2.756, 5.404, 8.933)
TUNED_BAR = (1.0, 4.0, 9.2, 16.0)
BELL = (1.0, 2.0, 2.5, 3.0, 4.0, 5.33, 6.67)
SKIN = (1.0, 1.594, 2.136, 2.653, 3.156)


def pitch_of(step: int) -> float:
    """Return the pitch [Hz] of a step of the scale; G4 is step 0, and steps may be negative."""
    octave, degree = divmod(step, len(SCALE))
    return G4 * math.pow(2.0, octave + SCALE[degree] / 12.0)


RATE = 48_000
"""Samples per second: the rate of most sound devices, so that nothing is resampled."""

Wave: TypeAlias = NDArray[np.floating[Any]]

FADE_IN = 0.0004  # [s] at the start of every sound: a shorter fade clicks; a longer one dulls the attack
FADE_OUT = 0.012  # [s] at its end
EDGE_LOW, EDGE_HIGH = 2_200.0, 6_000.0  # [Hz] band of the click of a blow; it falls off by 12 dB per octave
EDGE_RISE = 0.0003  # [s]
STEEL = (2_780.0, 4_350.0, 6_910.0)  # [Hz] small steel parts: coil plungers, brackets, plates; chosen
DECAY_FLOOR = -80.0  # [dB] below which a decay is cut off
_BLOCK = 256  # samples of decaying tones computed at once
_EDGE = 480  # samples in which a layer of a mix fades out
_FALL = (0.5 - 0.5 * np.cos(np.pi * np.arange(1, _EDGE + 1) / _EDGE)).astype(np.float32)


class Partial(NamedTuple):
    """A decaying tone of a struck object.

    Attributes:
        pitch: [Hz].
        strength: Amplitude at the start.
        decay: Time in which it falls by 60 dB [s].
    """

    pitch: float
    strength: float
    decay: float


def as_float32(values: Any) -> Wave:
    """Convert to float32, which is twice as fast to add as float64 and precise enough."""
    wave: Wave = values.astype(np.float32, copy=False)
    return wave


def sample_count(seconds: float) -> int:
    """Return the number of samples of a duration [s], at least 1."""
    return max(round(seconds * RATE), 1)


def ring(partials: Sequence[Partial], seconds: float) -> Wave:
    """Return decaying tones that start together: Σ strength · e^(−6.9·t/decay) · sin(2π·pitch·t).

    A sine and a decay are both powers of one complex number, z^n = z^(256·k) · z^j, so a tone is an outer
    product of two short vectors: about a hundred times cheaper than a sine and a power per sample.
    """
    count = sample_count(seconds)
    blocks = -(-count // _BLOCK)
    wave = np.zeros((blocks, _BLOCK), np.float32)
    for pitch, strength, decay in partials:
        if pitch >= 0.45 * RATE:
            continue
        exponent = complex(-math.log(1000.0) / decay, 2.0 * math.pi * pitch) / RATE
        audible = min(blocks, math.ceil(sample_count(-DECAY_FLOOR / 60.0 * decay) / _BLOCK))
        coarse = strength * np.exp(exponent * _BLOCK * np.arange(audible))
        fine = np.exp(exponent * np.arange(_BLOCK))
        wave[:audible] += np.outer(coarse.real.astype(np.float32), fine.imag.astype(np.float32))
        wave[:audible] += np.outer(coarse.imag.astype(np.float32), fine.real.astype(np.float32))
    return wave.reshape(-1)[:count]


def struck(
    pitch: float,
    ratios: Sequence[float],
    decay: float,
    *,
    brightness: float = 0.5,
    damping: float = 0.6,
    detune: float = 0.0,
    random: np.random.Generator,
) -> list[Partial]:
    """Return the partials of a struck object.

    Args:
        pitch: Pitch of the lowest partial [Hz].
        ratios: Ratios of the pitches to the lowest.
        decay: Decay of the lowest partial [s].
        brightness: Strength of each partial relative to the one below; a harder blow is brighter.
        damping: Exponent of the decay of high partials, `decay` · ratio^−damping. Wood 0.9, metal 0.6.
        detune: Greatest relative detuning of a partial, so that no two hits sound alike.
        random: Draws the detuning and small differences of strength.
    """
    partials = []
    for number, ratio in enumerate(ratios):
        off = 1.0 + detune * random.uniform(-1.0, 1.0) if number else 1.0
        strength = brightness**number * random.uniform(0.8, 1.2) if number else 1.0
        partials.append(Partial(pitch * ratio * off, strength, decay * ratio**-damping))
    return partials


def noise(
    seconds: float, low: float, high: float, random: np.random.Generator, *, slope: float = 12.0
) -> Wave:
    """Return noise between two pitches [Hz] with RMS 1, falling off outside by `slope` dB per octave."""
    count = _good_length(sample_count(seconds))
    pitches = np.fft.rfftfreq(count, 1.0 / RATE)
    spectrum = np.fft.rfft(random.standard_normal(count, np.float32)) * _band(pitches, low, high, slope)
    wave = np.fft.irfft(spectrum, count)
    return as_float32(wave[: sample_count(seconds)] / np.sqrt(np.mean(wave**2)))


def puff(
    seconds: float, low: float, high: float, decay: float, random: np.random.Generator, *, rise: float = 0.001
) -> Wave:
    """Return a burst of noise that rises in `rise` [s] and falls by 60 dB in `decay` [s]."""
    time = np.arange(sample_count(seconds), dtype=np.float32) / RATE
    return noise(seconds, low, high, random) * np.minimum(time / rise, 1.0) * _fall(time, decay)


def edge(decay: float, random: np.random.Generator) -> Wave:
    """Return the bright edge of a blow, 2 to 10 kHz: the click of hard surfaces and a trace of ringing steel.

    Args:
        decay: Time in which it falls by 60 dB [s]; 10 ms for wood, 60 ms for free steel.
        random: Draws the noise, and the pitches of the steel around those of `STEEL`.
    """
    seconds = 1.2 * decay
    click = puff(seconds, EDGE_LOW, EDGE_HIGH, decay, random, rise=EDGE_RISE)
    steel = [
        Partial(pitch * random.uniform(0.96, 1.04), 0.5, 1.5 * decay * (STEEL[0] / pitch) ** 0.5)
        for pitch in STEEL
    ]
    return as_float32(click + ring(steel, seconds))


def glide(
    pitch: Callable[[Wave], Wave],
    seconds: float,
    overtones: Sequence[float] = (1.0,),
) -> Wave:
    """Return a tone whose pitch [Hz] is a function of the time from 0 to 1; overtones are strengths."""
    count = sample_count(seconds)
    turns = np.cumsum(pitch(np.arange(count) / count)) / RATE
    phase = (2.0 * np.pi * (turns % 1.0)).astype(np.float32)
    wave = np.zeros(count, np.float32)
    for number, strength in enumerate(overtones, 1):
        wave += np.float32(strength) * np.sin(np.float32(number) * phase)
    return wave


def envelope(seconds: float, rise: float, decay: float) -> Wave:
    """Return an envelope that rises to 1 within `rise` [s], then falls by 60 dB within `decay` [s]."""
    time = np.arange(sample_count(seconds), dtype=np.float32) / RATE
    up = np.minimum(time / rise, 1.0)
    return (0.5 - 0.5 * np.cos(np.pi * up)) * _fall(np.maximum(time - rise, 0.0), decay)


def mix(seconds: float, *layers: tuple[float, float, Wave]) -> Wave:
    """Add waves, each with a soft end: (start [s], strength, wave)."""
    total = np.zeros(sample_count(seconds), np.float32)
    for start, strength, wave in layers:
        at = round(start * RATE)
        part = wave[: max(len(total) - at, 0)]
        fall = min(_EDGE, len(part))
        total[at : at + len(part)] += np.float32(strength) * part
        total[at + len(part) - fall : at + len(part)] -= (
            strength * part[len(part) - fall :] * _FALL[_EDGE - fall :]
        )
    return total


def finished(wave: Wave) -> Wave:
    """Return a wave that begins and ends at zero and has no offset, so that it does not click."""
    count = len(wave)
    edge = np.ones(count, np.float32)
    rise, fall = min(sample_count(FADE_IN), count // 2), min(sample_count(FADE_OUT), count // 2)
    edge[:rise] = 0.5 - 0.5 * np.cos(np.pi * np.arange(rise) / rise)
    edge[count - fall :] = 0.5 + 0.5 * np.cos(np.pi * np.arange(1, fall + 1) / fall)
    wave = wave * edge
    # The correction has the shape of the wave itself: the ends stay at zero, and no low frequency is added.
    size = np.abs(wave)
    return wave - size * np.float32(
        wave.sum(dtype=np.float64) / max(float(size.sum(dtype=np.float64)), 1e-30)
    )


def looped(spectrum: Callable[[Wave], Wave], seconds: float, seed: int) -> Wave:
    """Return noise that repeats without a seam; its RMS is 1.

    It consists of tones that fit the loop a whole number of times, with random phases.

    Args:
        spectrum: Returns the strength at a pitch [Hz].
        seconds: Length of the loop.
        seed: Seed of the phases.
    """
    count = sample_count(seconds)
    pitches = np.fft.rfftfreq(count, 1.0 / RATE)
    random = np.random.default_rng(seed)
    drawn = random.standard_normal(len(pitches)) + 1j * random.standard_normal(len(pitches))
    drawn[0] = 0.0
    wave = np.fft.irfft(drawn * spectrum(pitches), count)
    return as_float32(wave / np.sqrt(np.mean(wave**2)))


def soft_limit(wave: Wave, knee: float = 0.7) -> Wave:
    """Limit a wave to −1 … 1: unchanged up to the knee, compressed smoothly above it."""
    over = np.abs(wave) > knee
    if not over.any():
        return wave
    bent = wave.copy()
    high = wave[over]
    bent[over] = np.sign(high) * (knee + (1.0 - knee) * np.tanh((np.abs(high) - knee) / (1.0 - knee)))
    return bent


def _fall(time: Wave, decay: float) -> Wave:
    return as_float32(np.exp(-math.log(1000.0) / decay * time))


def _band(pitches: Wave, low: float, high: float, slope: float) -> Wave:
    power = slope / (20.0 * math.log10(2.0))
    with np.errstate(divide="ignore"):
        below = np.minimum(pitches / low, 1.0) ** power
        above = np.minimum(high / pitches, 1.0) ** power
    return as_float32(below * above)


def _good_length(count: int) -> int:
    """Return a length ≥ `count` for a fast Fourier transform: 2^n or 3·2^n."""
    power = 1 << (count - 1).bit_length()
    return 3 * power // 4 if 3 * power // 4 >= count else power
