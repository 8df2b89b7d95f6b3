"""Which pitches are there? One scale for all that sings, and the partials of things that are struck.

The scale is G major pentatonic (G A B D E), in which no two notes clash: hits that fall together by chance
still sound like a chord.
"""

from __future__ import annotations

import math

G4 = 440.0 * 2.0 ** (-2.0 / 12.0)
"""The note on which the scale stands [Hz]; A4 is 440 Hz, twelve equal semitones make an octave."""

SCALE = (0, 2, 4, 7, 9)
"""G A B D E, in semitones above G."""

BELL_STEPS = 10
"""Steps of the bell: two octaves of the scale, so that the tenth hit in a row is an E6 of 1319 Hz."""

# Ratios of partials. A bar with free ends: the zeros of cos·cosh = 1, squared. A tuned bar (marimba) has its
# second partial carved to 4. A bell: hum, prime, tierce, quint, nominal, as bell founders aim at, with the
# tierce major. A skin: zeros of Bessel functions. Source: N. Fletcher, T. Rossing, "The Physics of Musical
# Instruments", 2nd ed. (1998), ch. 2, 3, 19 and 21.
BAR = (1.0, 2.756, 5.404, 8.933)
TUNED_BAR = (1.0, 4.0, 9.2, 16.0)
BELL = (1.0, 2.0, 2.5, 3.0, 4.0, 5.33, 6.67)
SKIN = (1.0, 1.594, 2.136, 2.653, 3.156)


def pitch_of(step: int) -> float:
    """The pitch [Hz] of a step of the scale, from G4 = 0 on; steps may be negative."""
    octave, degree = divmod(step, len(SCALE))
    return G4 * math.pow(2.0, octave + SCALE[degree] / 12.0)
