"""The fonts of the score display, and how a text is fitted into a width.

The glyphs are drawn dot by dot in `fonts.txt`. A character that a font lacks is shown as its capital if there
is one, else rasterized from the font that other texts use, else as a box.
"""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Glyph: TypeAlias = NDArray[np.bool_]
"""The dots of a character, true where lit, shape [row, column]."""

RASTER_SIZE = 200  # [pixel] size of the letters that are rasterized
FULL_COVER = 255  # alpha of a pixel that a letter covers
LIT_COVER = 0.5  # share of a dot that a letter must cover to light it
MAX_DESCENT = 0.3  # of a rasterized letter below the baseline, in heights of a capital


class Font(NamedTuple):
    """A set of glyphs.

    Attributes:
        name: "tiny", "normal", "bold" or "huge".
        height: Height of a capital [dot].
        gap: Gap between two glyphs [dot].
        glyphs: Glyphs by character; rows beyond `height` reach below the baseline.
        box: Glyph shown for missing characters.
    """

    name: str
    height: int
    gap: int
    glyphs: dict[str, Glyph]
    box: Glyph

    def glyph(self, character: str) -> Glyph:
        """Return the dots of a character; a box if no font has it."""
        found = self.glyphs.get(character)
        if found is None:
            found = self.glyphs.get(character.upper())
        if found is None and not character.isascii():
            found = rasterize(character, self.height)
        return self.box if found is None else found

    def width(self, text: str) -> int:
        """Return the width of a text [dot]."""
        if not text:
            return 0
        widths = (int(self.glyph(character).shape[1]) for character in text)
        return sum(widths) + self.gap * (len(text) - 1)

    def has(self, character: str) -> bool:
        """Return whether the font itself has a character, or its capital."""
        return character in self.glyphs or character.upper() in self.glyphs


def fitting(text: str, width: int, fonts: tuple[Font, ...] | None = None) -> Font:
    """Return the first font in which a text is no wider than `width` [dot], or the last one.

    Args:
        text: One line.
        width: Space for it [dot].
        fonts: The fonts to try, the largest first; by default bold, normal, tiny.
    """
    fonts = (BOLD, NORMAL, TINY) if fonts is None else fonts
    return next((font for font in fonts if font.width(text) <= width), fonts[-1])


@lru_cache(maxsize=512)
def rasterize(character: str, height: int) -> Glyph | None:
    """Turn a letter of a system font into dots: a dot is lit where the letter covers most of it.

    Args:
        character: The letter.
        height: Height of a capital [dot].

    Returns:
        The dots, at least one column; None if no font has the letter.
    """
    import pygame  # slow to load, and rarely needed

    from silverball.drawing.text import font_of

    face = font_of(character, RASTER_SIZE)
    if face is None:
        return None
    letter, capital = (face.render(one, True, (255, 255, 255)) for one in (character, "H"))
    box, line = letter.get_bounding_rect(), capital.get_bounding_rect()
    if not box:
        return None
    top = min(box.top, line.top)  # a capital with an accent is squeezed to make space for the accent
    pitch = (line.bottom - top) / height  # [pixel] of a dot
    below = min(max(math.ceil((box.bottom - line.bottom) / pitch), 0), round(MAX_DESCENT * height))
    sheet = pygame.Surface((box.width, round(pitch * (height + below))), pygame.SRCALPHA)
    sheet.blit(letter, (-box.left, -top))
    width = max(round(box.width * height / line.height), 1)
    dots = pygame.transform.smoothscale(sheet, (width, height + below))
    lit = pygame.surfarray.array_alpha(dots).T > LIT_COVER * FULL_COVER
    while len(lit) > height and not lit[-1].any():
        lit = lit[:-1]
    return np.asarray(lit, np.bool_)


def _load(file: Path) -> dict[str, Font]:
    """Read fonts by name from a file whose head describes its format."""
    fonts: dict[str, Font] = {}
    glyphs: dict[str, Glyph] = {}
    for block in file.read_text(encoding="utf-8").strip().split("\n\n"):
        head, *rows = block.split("\n")
        kind, _, rest = head.partition(" ")
        if kind == "font":
            name, *numbers = rest.split()
            width, height, gap, space = map(int, numbers)
            glyphs = {" ": np.zeros((height, space), np.bool_)}
            fonts[name] = Font(name, height, gap, glyphs, _box(width, height, max(gap, 1)))
        elif kind == "glyphs":
            columns = zip(*(row.split() for row in rows), strict=True)
            for character, column in zip(rest, columns, strict=True):
                glyphs[character] = np.array([[dot == "#" for dot in row] for row in column], np.bool_)
    return fonts


def _box(width: int, height: int, thickness: int) -> Glyph:
    box = np.ones((height, width), np.bool_)
    box[thickness:-thickness, thickness:-thickness] = False
    return box


_fonts = _load(Path(__file__).with_name("fonts.txt"))
TINY = _fonts["tiny"]
"""3 × 5 dots, capitals only: for unimportant text."""
NORMAL = _fonts["normal"]
"""5 × 7 dots, with small letters: for all texts."""
BOLD = _fonts["bold"]
"""7 × 11 dots, capitals and digits: for titles and the chosen entry of a menu."""
HUGE = _fonts["huge"]
"""12 × 19 dots, digits and comma only: for the score."""
FONTS = (TINY, NORMAL, BOLD, HUGE)
"""All fonts, the smallest first."""
