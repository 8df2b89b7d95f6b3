"""The panel of the score display: glowing round dots behind dark glass.

The shape of the dots is computed once for a size. Each pixel is then looked up in a table of colours by the
brightness of its dot, the glow of the dots around, and its distance from the dot's centre.
"""

from __future__ import annotations

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots, Levels
from silverball.drawing.themes import Color

AMBER: Color = (255, 140, 24)
GLASS: Color = (12, 8, 6)
BEZEL: Color = (34, 32, 38)

RADIUS = 0.43  # radius of a dot, in spacings; at 0.5 neighbours would touch
UNLIT = 0.075  # light of a dot that is off: a plasma display is never quite dark
BLOOM = 0.26  # light between the dots if the whole neighbourhood is lit
HOT = 0.42  # how far the centre of the brightest dot goes from its colour to white
GAMMA = 0.8  # raises dim dots, which look darker beside unlit ones

LEVEL_BITS, GLOW_BITS, MASK_BITS = 5, 5, 5
REACH = 2  # [dot] how far the glow of a dot reaches
MIN_SPACING = 4.0  # [pixel]; panels with smaller spacing are drawn larger and scaled down
WHOLE_SPACING = 0.95  # spacings are rounded down to whole pixels if that leaves this share of the size
BEZEL_SHARE = 0.03  # minimum bezel width, as a fraction of the panel height


class DotPanel:
    """The panel on which dots are shown.

    Args:
        area: Its area in the picture [pixel], bezel included.
        color: Colour of the brightest dots.
        background: Colour of the glass between the dots.
        frame: Colour of the bezel around it; None for no bezel.
        rows: Rows of dots; columns are as many as always.
    """

    def __init__(
        self,
        area: pygame.Rect,
        color: Color = AMBER,
        background: Color = GLASS,
        frame: Color | None = BEZEL,
        rows: int = HEIGHT,
    ) -> None:
        self.area = pygame.Rect(area)
        width, height = max(self.area.width, 1), max(self.area.height, 1)
        rim = round(BEZEL_SHARE * height) if frame is not None else 0
        inner_width, inner_height = max(width - 2 * rim, 1), max(height - 2 * rim, 1)
        spacing = min(inner_width / WIDTH, inner_height / rows)
        if int(spacing) >= max(MIN_SPACING, WHOLE_SPACING * spacing):
            spacing = float(int(spacing))
        shrink = 1
        while spacing * shrink < MIN_SPACING:
            shrink += 1
        size = max(round(WIDTH * spacing), 1), max(round(rows * spacing), 1)
        self._face = _face((width, height), rim, background, frame)
        self._place = ((width - size[0]) // 2, (height - size[1]) // 2)
        self._shape = _Shape(size[0] * shrink, size[1] * shrink, rows)
        self._table = _colors(color, background, small=spacing < MIN_SPACING)
        self._size = size
        self._shown: Levels | None = None

    def draw(self, target: pygame.Surface, dots: Dots) -> None:
        """Draw dots with the bezel around them; unchanged dots are only copied."""
        self._match(target)
        self._light(dots.pixels)
        target.blit(self._face, self.area)

    def draw_changes(self, target: pygame.Surface, levels: Levels, *, whole: bool) -> None:
        """Draw what has changed onto a target that still shows the last dots.

        Args:
            target: The picture.
            levels: The dots, as many rows as the panel has.
            whole: Whether to draw everything, because the target shows something else.
        """
        self._match(target)
        box = self._light(levels)
        if whole:
            target.blit(self._face, self.area)
        elif box is not None:
            target.blit(self._face, box.move(self.area.topleft), box)

    def _match(self, target: pygame.Surface) -> None:
        if self._face.get_masks() != target.get_masks() or self._face.get_bitsize() != target.get_bitsize():
            # Once, because surfaces of the same format are copied fastest
            self._face = self._face.convert(target)

    def _light(self, levels: Levels) -> pygame.Rect | None:
        """Redraw the dots that have changed, with their glow; return where [pixel of the panel]."""
        before, self._shown = self._shown, levels.copy()
        first_row, first_column, end_row, end_column = 0, 0, *levels.shape
        if before is not None:
            rows, columns = np.nonzero(before != levels)
            if not rows.size:
                return None
            first_row, end_row = max(int(rows[0]) - REACH, 0), int(rows[-1]) + 1 + REACH
            first_column, end_column = max(int(columns.min()) - REACH, 0), int(columns.max()) + 1 + REACH
        index = (levels >> (8 - LEVEL_BITS)).astype(np.uint16)
        index <<= GLOW_BITS
        index |= _glow(levels) >> (8 - GLOW_BITS)
        picture, box = self._shape.light(
            index, self._table, slice(first_row, end_row), slice(first_column, end_column)
        )
        if picture.get_size() != self._size:
            picture, box = pygame.transform.smoothscale(picture, self._size), pygame.Rect((0, 0), self._size)
        self._face.blit(picture, box.move(self._place), box)
        return box.move(self._place)


class _Shape:
    """For each pixel, the dot that it belongs to and how much light of it is seen there."""

    def __init__(self, width: int, height: int, rows: int) -> None:
        x, y = (np.arange(width) + 0.5) * WIDTH / width, (np.arange(height) + 0.5) * rows / height
        self._rows, self._columns = y.astype(np.intp), x.astype(np.intp)
        spacing = width / WIDTH
        away = np.hypot((x % 1.0 - 0.5)[None, :], (y % 1.0 - 0.5)[:, None])
        edge = np.clip((RADIUS - away) * spacing + 0.5, 0.0, 1.0)  # smooth over one pixel
        dome = 1.0 - 0.35 * np.minimum(away / RADIUS, 1.0) ** 2  # brighter in the middle
        self._mask = np.rint(edge * dome * ((1 << MASK_BITS) - 1)).astype(np.uint16)
        self._image = np.empty((height, width), np.uint32)
        # The picture shares the memory of the array.
        self._picture = pygame.image.frombuffer(self._image.data, (width, height), "BGRA")
        self._picture.set_alpha(None)

    def light(
        self, index: NDArray[np.uint16], table: NDArray[np.uint32], rows: slice, columns: slice
    ) -> tuple[pygame.Surface, pygame.Rect]:
        """Redraw some rows and columns of dots.

        Args:
            index: Brightness and glow of all dots.
            table: Colours.
            rows: The rows of dots.
            columns: The columns of dots.

        Returns:
            All pixels, in a surface that the next call uses again, and where they have changed.
        """
        top, bottom = np.searchsorted(self._rows, (rows.start, rows.stop)).tolist()
        left, right = np.searchsorted(self._columns, (columns.start, columns.stop)).tolist()
        wide = np.take(index << MASK_BITS, self._columns[left:right], axis=1)
        found = np.take(wide, self._rows[top:bottom], axis=0)
        found |= self._mask[top:bottom, left:right]
        self._image[top:bottom, left:right] = np.take(table, found, mode="clip")
        return self._picture, pygame.Rect(left, top, right - left, bottom - top)


def _glow(levels: Levels) -> NDArray[np.uint16]:
    """Return the light that reaches each dot from those around it, 0 to 255."""
    rows, columns = levels.shape
    wide = np.zeros((rows + 4, columns + 4), np.uint16)
    wide[2:-2, 2:-2] = levels
    # Shares of 1, 4, 6, 4, 1 sixteenths across, then down; normalised after each pass, so that the sums fit
    # in 16 bits.
    across: NDArray[np.uint16] = wide[:, :-4] + wide[:, 4:]
    across += (wide[:, 1:-3] + wide[:, 3:-1]) << 2
    across += wide[:, 2:-2] * 6
    across >>= 4
    both: NDArray[np.uint16] = across[:-4] + across[4:]
    both += (across[1:-3] + across[3:-1]) << 2
    both += across[2:-2] * 6
    both >>= 4
    return both


def _colors(color: Color, background: Color, small: bool) -> NDArray[np.uint32]:
    """Return the colours by brightness, glow and mask (bits of the index, high to low), as 0xAARRGGBB."""
    level = np.linspace(0.0, 1.0, 1 << LEVEL_BITS)[:, None, None, None] ** GAMMA
    glow = np.linspace(0.0, 1.0, 1 << GLOW_BITS)[None, :, None, None]
    mask = np.linspace(0.0, 1.0, 1 << MASK_BITS)[None, None, :, None]
    if small:
        mask = mask**0.5  # shrunk dots lose light to the dark pixels around them
    tint, glass = np.array(color) / 255.0, np.array(background) / 255.0
    lit = (UNLIT + (1.0 - UNLIT) * level) * tint
    lit = lit + (1.0 - lit) * HOT * (level * mask) ** 3 * (0.35 + 0.65 * tint)
    ground = glass + BLOOM * glow * tint
    # A dot adds its light to the glow around it.
    rgb = np.rint(255.0 * np.clip(np.maximum(ground, 0.0) * (1.0 - 0.5 * mask) + lit * mask, 0.0, 1.0))
    packed = rgb.astype(np.uint32)
    argb = 0xFF000000 | packed[..., 0] << 16 | packed[..., 1] << 8 | packed[..., 2]
    return np.ascontiguousarray(argb.ravel(), np.uint32)


def _face(size: tuple[int, int], rim: int, background: Color, frame: Color | None) -> pygame.Surface:
    """Return the panel without dots: the glass, and the bezel around it."""
    face = pygame.Surface(size, 0, 32)
    face.fill(background)
    if frame is None or rim < 1:
        return face
    whole = face.get_rect()
    for step in range(rim):
        # Lit from above: the outer edge catches light, the inner edge falls off to the glass.
        depth = step / max(rim - 1, 1)
        for side, light in (("top", 1.5), ("bottom", 0.7), ("left", 1.1), ("right", 0.9)):
            bright = light * (1.0 - 0.55 * depth) if depth < 0.75 else 0.35 * light
            tone = tuple(min(round(channel * bright), 255) for channel in frame)
            ring = whole.inflate(-2 * step, -2 * step)
            ends = {
                "top": (ring.topleft, (ring.right - 1, ring.top)),
                "bottom": ((ring.left, ring.bottom - 1), (ring.right - 1, ring.bottom - 1)),
                "left": (ring.topleft, (ring.left, ring.bottom - 1)),
                "right": ((ring.right - 1, ring.top), (ring.right - 1, ring.bottom - 1)),
            }[side]
            pygame.draw.line(face, tone, *ends)
    return face
