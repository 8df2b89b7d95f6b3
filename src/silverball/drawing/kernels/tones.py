"""Colour arithmetic on three floats, tone mapping, and noise."""

from __future__ import annotations

from math import sqrt
from typing import TypeAlias

from silverball.drawing.kernels.stage import Inks
from silverball.physics.kernel import inlined, internal

RGB: TypeAlias = tuple[float, float, float]


@inlined
def ink(inks: Inks, row: int) -> RGB:
    """Return a colour of the scene."""
    at = row + 0  # as a number, because before Numba 0.68 a member of an enum does not index arrays
    return inks[at, 0], inks[at, 1], inks[at, 2]


@inlined
def mix(a: RGB, b: RGB, share: float) -> RGB:
    """Interpolate from a to b."""
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])


@inlined
def add_scaled(a: RGB, b: RGB, strength: float) -> RGB:
    """Return a + strength · b."""
    return a[0] + strength * b[0], a[1] + strength * b[1], a[2] + strength * b[2]


@inlined
def multiply(a: RGB, b: RGB) -> RGB:
    """Multiply two colours channel by channel."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]


@inlined
def scale(a: RGB, strength: float) -> RGB:
    """Return strength · a."""
    return strength * a[0], strength * a[1], strength * a[2]


@inlined
def clamp01(value: float) -> float:
    """Limit a value to 0 … 1."""
    return min(max(value, 0.0), 1.0)


@inlined
def smoothstep(low: float, high: float, value: float) -> float:
    """Return 0 below `low`, 1 above `high`, and a smooth transition in between."""
    share = min(max((value - low) / (high - low), 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@inlined
def coverage(distance: float, pixel: float) -> float:
    """Return how much of a pixel lies inside a shape whose edge is at a distance [same unit]."""
    return min(max(0.5 - distance / pixel, 0.0), 1.0)


@inlined
def tone_map(light: float) -> float:
    """Map linear light to the screen: a long shoulder, so that bright colours glow instead of clipping.

    Source: K. Narkowicz, "ACES filmic tone mapping curve", 2016; with a gamma of 2.
    """
    shown = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14)
    return sqrt(min(max(shown, 0.0), 1.0))


@internal
def value_noise(x: float, z: float) -> float:
    """Smooth noise, 0 to 1, with one bump per unit."""
    i, j = int(x // 1.0), int(z // 1.0)
    u, v = x - i, z - j
    u, v = u * u * (3.0 - 2.0 * u), v * v * (3.0 - 2.0 * v)
    low = hash01(i, j) + u * (hash01(i + 1, j) - hash01(i, j))
    high = hash01(i, j + 1) + u * (hash01(i + 1, j + 1) - hash01(i, j + 1))
    return low + v * (high - low)


@inlined
def hash01(i: int, j: int) -> float:
    """Return a pseudo-random number from 0 to 1, a hash of a cell."""
    bits = (i * 374761393 + j * 668265263 + 1013904223) & 0xFFFFFFFF
    bits = ((bits ^ (bits >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((bits ^ (bits >> 16)) & 0xFFFFFF) / 16777216.0
