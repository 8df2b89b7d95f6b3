"""How far is each pixel from a shape? Signed distances [u] on a grid: negative inside, zero on the edge.

Every function takes the grid's board coordinates x, shape [row, 1], and z, shape [1, column], and gives
float32 of shape [row, column]. From a distance come antialiased masks, glows and bevels, at any size.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Field: TypeAlias = NDArray[np.float32]


def circle(x: Field, z: Field, center: tuple[float, float], radius: float) -> Field:
    """Distance to a disc."""
    return _single(np.hypot(x - np.float32(center[0]), z - np.float32(center[1])) - np.float32(radius))


def segment(x: Field, z: Field, start: tuple[float, float], end: tuple[float, float], radius: float) -> Field:
    """Distance to a line between two points with round ends, `radius` thick to each side."""
    along_x, along_z = end[0] - start[0], end[1] - start[1]
    from_x, from_z = x - np.float32(start[0]), z - np.float32(start[1])
    square = along_x * along_x + along_z * along_z
    if square == 0.0:
        return circle(x, z, start, radius)
    part = np.clip((from_x * along_x + from_z * along_z) / square, 0.0, 1.0)
    return _single(np.hypot(from_x - part * along_x, from_z - part * along_z) - np.float32(radius))


def polygon(x: Field, z: Field, corners: tuple[tuple[float, float], ...]) -> Field:
    """Distance to a polygon, its corners given in either order."""
    nearest = np.full(np.broadcast_shapes(x.shape, z.shape), np.inf, np.float32)
    inside = np.zeros(nearest.shape, np.bool_)
    for (x0, z0), (x1, z1) in zip(corners, corners[1:] + corners[:1], strict=True):
        nearest = np.minimum(nearest, segment(x, z, (x0, z0), (x1, z1), 0.0))
        if x0 != x1:
            # Even–odd rule: does a ray towards +z from the pixel cross this edge?
            crosses = (x < max(x0, x1)) & (x >= min(x0, x1))
            inside ^= crosses & (z < z0 + (x - x0) * ((z1 - z0) / (x1 - x0)))
    return np.where(inside, -nearest, nearest)


def rectangle(
    x: Field, z: Field, low: tuple[float, float], high: tuple[float, float], rounding: float = 0.0
) -> Field:
    """Distance to the rectangle from corner `low` to corner `high`, its corners rounded."""
    out_x = np.abs(x - 0.5 * (low[0] + high[0])) - (0.5 * (high[0] - low[0]) - rounding)
    out_z = np.abs(z - 0.5 * (low[1] + high[1])) - (0.5 * (high[1] - low[1]) - rounding)
    outside = np.hypot(np.maximum(out_x, 0.0), np.maximum(out_z, 0.0))
    return _single(outside + np.minimum(np.maximum(out_x, out_z), 0.0) - rounding)


def cover(distance: Field, pixel: float) -> Field:
    """How much of each pixel a shape covers, 0 to 1: the edge is one pixel wide, which is antialiasing."""
    return _single(np.clip(0.5 - distance / np.float32(pixel), 0.0, 1.0))


def ring(distance: Field, half_width: float, pixel: float) -> Field:
    """How much of each pixel a line along the edge covers."""
    return cover(np.abs(distance) - np.float32(half_width), pixel)


def glow(distance: Field, reach: float) -> Field:
    """A soft light around a shape: 1 within, 1/e at a distance of `reach`, gone at about five times it."""
    return _single(np.exp(-np.maximum(distance, 0.0) / np.float32(reach)))


def slope(distance: Field, pixel: float) -> tuple[Field, Field]:
    """The unit direction (x, z) in which a distance grows: the outward normal."""
    if min(distance.shape) < 2:
        return np.zeros_like(distance), np.zeros_like(distance)
    down, right = np.gradient(distance, pixel)
    length = np.maximum(np.hypot(down, right), 1e-6)
    return _single(-down / length), _single(right / length)


def _single(values: NDArray[np.floating]) -> Field:
    return values.astype(np.float32, copy=False)
