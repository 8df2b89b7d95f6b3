"""How are words and numbers drawn? In pygame's own font, each piece rendered once and kept.

Rendering a line anew costs milliseconds; a score that counts up is put together from kept digits instead.
"""

from __future__ import annotations

from functools import lru_cache

import pygame

from silverball.drawing.palette import Color
from silverball.plain import plain

SMALL = 30  # [pixel] sizes below it are drawn larger and shrunk
ENLARGED = 4


@lru_cache(maxsize=64)
def font(size: int, bold: bool = False) -> pygame.font.Font:
    """The font that comes with pygame, at a size [pixel]."""
    if not pygame.font.get_init():
        pygame.font.init()
    face = pygame.font.Font(None, max(size, 6))
    face.set_bold(bold)
    return face


@lru_cache(maxsize=1024)
def line(text: str, size: int, color: Color) -> pygame.Surface:
    """One line of text. The surface is shared: blit it, do not change it."""
    text = plain(text)  # some characters turn the direction round, and a font refuses others
    if size >= SMALL:
        return font(size).render(text, True, color)
    # The font's hints push small letters unevenly onto whole pixels; drawn large and shrunk they stand well.
    large = font(ENLARGED * size).render(text, True, color)
    return pygame.transform.smoothscale_by(large, 1.0 / ENLARGED)


def number(value: int, size: int, color: Color) -> list[pygame.Surface]:
    """The glyphs of a number with its thousands apart, left to right."""
    return [line(glyph, size, color) for glyph in f"{value:,}"]


def text_width(text: str, size: int) -> int:
    """How wide `line` makes a text [pixel]."""
    if size >= SMALL:
        return font(size).size(text)[0]
    return -(-font(ENLARGED * size).size(text)[0] // ENLARGED)


def wrapped(text: str, size: int, width: int) -> list[str]:
    """The lines into which a text breaks so that none is wider than `width` [pixel].

    Words are kept whole, but for those that are wider than a line, as a path may be.
    """
    lines: list[str] = []
    for paragraph in plain(text, keep="\n").split("\n"):
        current = ""
        for word in paragraph.split():
            for piece in _pieces(word, size, width):
                longer = f"{current} {piece}" if current else piece
                if current and text_width(longer, size) > width:
                    lines.append(current)
                    current = piece
                else:
                    current = longer
        lines.append(current)
    return lines


def _pieces(word: str, size: int, width: int) -> list[str]:
    """A word in as few pieces as fit a line each; a letter is never cut."""
    pieces = []
    while len(word) > 1 and text_width(word, size) > width:
        count = next((end for end in range(len(word) - 1, 1, -1) if text_width(word[:end], size) <= width), 1)
        pieces.append(word[:count])
        word = word[count:]
    return [*pieces, word]
