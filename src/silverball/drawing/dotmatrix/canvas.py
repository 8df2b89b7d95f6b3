"""The dots of the score display, 160 × 32 levels of brightness, and how to draw with them.

Positions are (x to the right, y downwards) from the upper left dot. Drawing is clipped at the edges.
Brightness is 0 (dark) to 255.
"""

from __future__ import annotations

from typing import Literal, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.dotmatrix.fonts import BOLD, HUGE, NORMAL, TINY, Font

WIDTH, HEIGHT = 160, 32
FULL = 255

Align: TypeAlias = Literal["left", "center", "right"]
Direction: TypeAlias = Literal["left", "right", "up", "down"]
Levels: TypeAlias = NDArray[np.uint8]


class Dots:
    """A picture of dots.

    Attributes:
        pixels: Brightness, 0 to 255, shape [row, column].

    Args:
        pixels: The initial picture, not copied; dark by default.
    """

    def __init__(self, pixels: Levels | None = None) -> None:
        self.pixels: Levels = np.zeros((HEIGHT, WIDTH), np.uint8) if pixels is None else pixels

    def copy(self) -> Self:
        """Return a copy."""
        return type(self)(self.pixels.copy())

    def clear(self, brightness: int = 0) -> None:
        """Set all dots to one brightness."""
        self.pixels[:] = brightness

    def text(
        self,
        text: str,
        x: int,
        y: int,
        font: Font = NORMAL,
        align: Align = "left",
        brightness: int = FULL,
        scale: int = 1,
        window: tuple[int, int] = (0, WIDTH),
    ) -> int:
        """Write one line; the dots between its strokes are unchanged.

        Args:
            text: The line. A character that no font has becomes a box.
            x: Its left end, its middle, or the first dot to the right of it, by `align`.
            y: The top of its capitals.
            font: Its font.
            align: The meaning of `x`.
            brightness: Brightness of its dots; 0 writes dark letters on a bright background.
            scale: Width and height of each dot of the font [dot].
            window: The columns to write in: the first, and the one after the last.

        Returns:
            The width of the text [dot].
        """
        width = scale * font.width(text)
        left = x - {"left": 0, "center": width // 2, "right": width}[align]
        at = left
        for character in text:
            glyph = font.glyph(character)
            if scale != 1:
                glyph = glyph.repeat(scale, axis=0).repeat(scale, axis=1)
            self.stamp(glyph, at, y, brightness, window)
            at += glyph.shape[1] + scale * font.gap
        return width

    def number(
        self,
        value: int,
        x: int,
        y: int,
        width: int = WIDTH,
        fonts: tuple[Font, ...] = (HUGE, BOLD, NORMAL, TINY),
        align: Align = "center",
        brightness: int = FULL,
    ) -> Font:
        """Write an integer with thousands separators, in the first font in which it fits.

        Args:
            value: The number.
            x: See `text`.
            y: The top of the space for it, which is as high as the first font; smaller fonts are centred.
            width: Space for it [dot].
            fonts: The fonts to try; the last one is used even if the number does not fit.
            align: Meaning of `x`.
            brightness: Brightness of its dots.

        Returns:
            The font used.
        """
        text = f"{value:,}"
        font = next((font for font in fonts if font.width(text) <= width), fonts[-1])
        self.text(text, x, y + (fonts[0].height - font.height) // 2, font, align, brightness)
        return font

    def stamp(
        self,
        mask: NDArray[np.bool_],
        x: int,
        y: int,
        brightness: int = FULL,
        window: tuple[int, int] = (0, WIDTH),
    ) -> None:
        """Set the dots of a mask, shape [row, column], whose upper left dot is at (x, y)."""
        target, source = _overlap(mask.shape, x, y, window)
        self.pixels[target][mask[source]] = brightness

    def sprite(self, levels: Levels, x: int, y: int) -> None:
        """Blend a small picture at (x, y) into this one; the brighter dot wins."""
        target, source = _overlap(levels.shape, x, y, (0, WIDTH))
        self.pixels[target] = np.maximum(self.pixels[target], levels[source])

    def dot(self, x: int, y: int, brightness: int = FULL) -> None:
        """Set one dot."""
        if 0 <= x < WIDTH and 0 <= y < HEIGHT:
            self.pixels[y, x] = brightness

    def line(self, x0: int, y0: int, x1: int, y1: int, brightness: int = FULL) -> None:
        """Draw a line of one dot's width, both ends included."""
        count = max(abs(x1 - x0), abs(y1 - y0)) + 1
        x = np.rint(np.linspace(x0, x1, count)).astype(np.int64)
        y = np.rint(np.linspace(y0, y1, count)).astype(np.int64)
        visible = (x >= 0) & (x < WIDTH) & (y >= 0) & (y < HEIGHT)
        self.pixels[y[visible], x[visible]] = brightness

    def box(self, x: int, y: int, width: int, height: int, brightness: int = FULL) -> None:
        """Fill a rectangle."""
        self.pixels[_slices(x, y, width, height)] = brightness

    def frame(self, x: int, y: int, width: int, height: int, brightness: int = FULL) -> None:
        """Draw the border of a rectangle, one dot wide."""
        if width > 0 and height > 0:
            self.box(x, y, width, 1, brightness)
            self.box(x, y + height - 1, width, 1, brightness)
            self.box(x, y, 1, height, brightness)
            self.box(x + width - 1, y, 1, height, brightness)

    def invert(self, x: int = 0, y: int = 0, width: int = WIDTH, height: int = HEIGHT) -> None:
        """Invert the brightness in a rectangle."""
        place = _slices(x, y, width, height)
        self.pixels[place] = FULL - self.pixels[place]

    def dim(self, share: float, x: int = 0, y: int = 0, width: int = WIDTH, height: int = HEIGHT) -> None:
        """Multiply the brightness in a rectangle by a share, 0 to 1."""
        place = _slices(x, y, width, height)
        self.pixels[place] = (self.pixels[place] * np.float32(min(max(share, 0.0), 1.0))).astype(np.uint8)


def blend(before: Dots, after: Dots, share: float) -> Dots:
    """Return a cross-fade: share 0 gives `before`, 1 gives `after`."""
    part = np.float32(_share(share))
    mixed = before.pixels + (after.pixels.astype(np.float32) - before.pixels) * part
    return Dots(np.rint(mixed).astype(np.uint8))


def wipe(before: Dots, after: Dots, share: float, direction: Direction = "right") -> Dots:
    """Return a wipe: a bright edge moves in a direction and reveals `after` behind it."""
    axis, forwards = _axis(direction)
    length = before.pixels.shape[axis]
    edge = round(_share(share) * (length + 1))
    place = np.arange(length) if forwards else np.arange(length)[::-1]
    place = place if axis else place[:, None]
    pixels = np.where(place < edge - 1, after.pixels, before.pixels)
    if 0 < edge <= length:
        pixels = np.where(place == edge - 1, np.uint8(FULL), pixels)
    return Dots(pixels)


def scroll(before: Dots, after: Dots, share: float, direction: Direction = "up") -> Dots:
    """Return a scroll: both pictures move in a direction, `after` behind `before`."""
    axis, forwards = _axis(direction)
    length = before.pixels.shape[axis]
    moved = round(_share(share) * length)
    pair = (after, before) if forwards else (before, after)
    both = np.concatenate([picture.pixels for picture in pair], axis=axis)
    start = length - moved if forwards else moved
    return Dots(both.take(np.arange(start, start + length), axis=axis))


def picture(rows: str, levels: str = ".+#") -> Levels:
    """Return a small picture for `Dots.sprite`, from rows of characters of `levels`, the darkest first."""
    step = FULL // (len(levels) - 1)
    return np.array([[step * levels.index(dot) for dot in row] for row in rows.split()], np.uint8)


def _share(share: float) -> float:
    return min(max(share, 0.0), 1.0)


def _axis(direction: Direction) -> tuple[int, bool]:
    """Return the axis of the array, and whether the direction is that of larger indices."""
    return {"left": (1, False), "right": (1, True), "up": (0, False), "down": (0, True)}[direction]


def _slices(x: int, y: int, width: int, height: int) -> tuple[slice, slice]:
    return (
        slice(min(max(y, 0), HEIGHT), min(max(y + height, 0), HEIGHT)),
        slice(min(max(x, 0), WIDTH), min(max(x + width, 0), WIDTH)),
    )


def _overlap(
    shape: tuple[int, ...], x: int, y: int, window: tuple[int, int]
) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Return the slices of the display that a picture at (x, y) covers, and those of the picture."""
    first, last = max(window[0], 0), min(window[1], WIDTH)
    left, right = min(max(x, first), last), max(min(x + shape[1], last), first)
    top, bottom = min(max(y, 0), HEIGHT), max(min(y + shape[0], HEIGHT), 0)
    right, bottom = max(right, left), max(bottom, top)
    return (slice(top, bottom), slice(left, right)), (slice(top - y, bottom - y), slice(left - x, right - x))
