"""How are words and numbers drawn? In pygame's own font, each piece rendered once and kept.

Rendering a line anew costs milliseconds; a score that counts up is put together from kept digits instead.
"""

from __future__ import annotations

from functools import lru_cache

import pygame

from silverball.drawing.palette import Color

SMALL = 30  # [pixel] sizes below it are drawn larger and shrunk
ENLARGED = 4


@lru_cache(maxsize=64)
def font(size: int, bold: bool = False) -> pygame.font.Font:
    """The font that comes with pygame, at a size [pixel]."""
    if not pygame.font.get_init():
        pygame.font.init()
    face = pygame.font.Font(None, max(size, 6))
    face.set_bold(bold)
    pygame.register_quit(font.cache_clear)  # another program's pygame.quit() makes fonts useless
    return face


@lru_cache(maxsize=1024)
def line(text: str, size: int, color: Color) -> pygame.Surface:
    """One line of text. The surface is shared: blit it, do not change it."""
    if size >= SMALL:
        return font(size).render(text, True, color)
    # The font's hints push small letters unevenly onto whole pixels; drawn large and shrunk they stand well.
    large = font(ENLARGED * size).render(text, True, color)
    return pygame.transform.smoothscale_by(large, 1.0 / ENLARGED)


def number(value: int, size: int, color: Color) -> list[pygame.Surface]:
    """The glyphs of a number with its thousands apart, left to right."""
    return [line(glyph, size, color) for glyph in f"{value:,}"]


def wrapped(text: str, size: int, width: int) -> list[str]:
    """The lines into which a text breaks so that none is wider than `width` [pixel], words kept whole."""
    lines: list[str] = []
    for paragraph in text.split("\n"):
        current = ""
        for word in paragraph.split():
            longer = f"{current} {word}" if current else word
            if current and font(size).size(longer)[0] > width:
                lines.append(current)
                current = word
            else:
                current = longer
        lines.append(current)
    return lines
