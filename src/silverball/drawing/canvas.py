"""How is paint put on? A canvas of floats, painted over or lit up through masks.

A canvas is float32 [row, column, 3], 0 to 1, in the screen's own (gamma) values, as designers mix colours.
A mask is float32 [row, column], 0 to 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.fields import Field
from silverball.drawing.palette import Color

# Where the light comes from (x up, z right): the upper left.
LIGHT_X, LIGHT_Z = 0.83, -0.56


def paint(canvas: NDArray[np.float32], color: Color | NDArray[np.float32], mask: Field) -> None:
    """Cover a canvas with a colour where the mask is 1."""
    canvas += (tone(color) - canvas) * mask[..., None]


def light(canvas: NDArray[np.float32], color: Color, mask: Field) -> None:
    """Add light of a colour; it never overflows and never darkens."""
    canvas += (1.0 - canvas) * (tone(color) * mask[..., None])


def shade(canvas: NDArray[np.float32], brightness: Field, mask: Field) -> None:
    """Brighten (> 0, towards white) or darken (< 0, towards black) where the mask is 1."""
    amount = (brightness * mask)[..., None]
    canvas += np.where(amount > 0.0, (1.0 - canvas) * amount, canvas * amount)


def facing(normal_x: Field, normal_z: Field) -> Field:
    """How much a slanting surface faces the light, −1 to 1."""
    return (normal_x * np.float32(LIGHT_X) + normal_z * np.float32(LIGHT_Z)).astype(np.float32)


def tone(color: Color | NDArray[np.float32]) -> NDArray[np.float32]:
    """A colour as three floats, 0 to 1; arrays of floats stay as they are."""
    if isinstance(color, np.ndarray):
        return color
    return np.array(color, np.float32) / np.float32(255.0)


def to_bytes(canvas: NDArray[np.float32]) -> NDArray[np.uint8]:
    """The canvas as RGB bytes, with a fixed fine pattern against bands in slow gradients."""
    rows, columns = canvas.shape[:2]
    # Half a step of ordered dither; the constants are the plastic number's powers, which spread points evenly
    # over a plane. Source: M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
    row, column = np.arange(rows)[:, None], np.arange(columns)[None, :]
    pattern = ((0.7548776662 * column + 0.5698402910 * row) % 1.0).astype(np.float32)
    levels: NDArray[np.uint8] = np.clip(canvas * 255.0 + pattern[..., None], 0.0, 255.0).astype(np.uint8)
    return levels
