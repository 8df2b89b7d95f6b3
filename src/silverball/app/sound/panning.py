"""How loud is a hit, and from where does it come? By its speed and its place across the table."""

from __future__ import annotations

import math

FULL_SPEED = 20.0
"""Impact speed [u/s] from which on a hit is at full strength; a table's usual cap is 22."""

LOUDNESS_POWER = 0.7
"""Strength = (speed / FULL_SPEED)^0.7, so twice the speed is 4.2 dB more. By energy it would be 6 dB, and the
soft touches of a long rally would be lost; the ear calls 10 dB "twice as loud"."""

SPREAD = 0.75
"""How far to the side the table's border is; 1 would be wholly in one ear, unpleasant with headphones."""


def strength_of(speed: float) -> float:
    """The strength of a hit, 0 to 1, by the impact speed [u/s]."""
    return float(min(max(speed, 0.0) / FULL_SPEED, 1.0) ** LOUDNESS_POWER)


def pan(z: float, width: float) -> tuple[float, float]:
    """Strength in the left and in the right ear at a place z [u] on a table of a width [u].

    Constant power: their squares add up to 1, so that a ball seems as loud on its whole way across. Source:
    the sine and cosine law, e.g. C. Roads, "The Computer Music Tutorial" (1996), ch. 11.
    """
    side = SPREAD * min(max(2.0 * z / width, -1.0), 1.0)
    turn = 0.25 * math.pi * (1.0 + side)
    return math.cos(turn), math.sin(turn)
