"""Texts in pygame's own font, each line rendered once and cached.

Characters that it lacks, such as Hebrew letters, come from a system font. Rendering a line
takes milliseconds, so a score that counts up is composed of cached digits.
"""

from __future__ import annotations

import os
from functools import lru_cache

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.dimensions import Dimensions
from silverball.drawing.themes import Color
from silverball.plain import plain

SMALL = 30  # [pixel]; smaller sizes are drawn larger and shrunk
ENLARGED = 4
APRON_ROWS = 48  # [pixel] height of the image on the apron
APRON_LETTERS = 40  # [pixel] size of the letters in it
_SYSTEM_FONTS = (
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",  # Debian and Ubuntu
    "/usr/share/fonts/TTF/DejaVuSans.ttf",  # Arch
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",  # Fedora
    "/System/Library/Fonts/Supplemental/Arial Unicode.ttf",
    *(f"C:/Windows/Fonts/{name}.ttf" for name in ("arial", "segoeui", "sylfaen", "nirmala", "leelawui")),
)
"""Fonts with many letters on common systems; asking a system for all its fonts may take seconds."""
_NO_CHARACTER = "\ufffe"  # in no font, so it renders as what a font draws for missing characters


@lru_cache(maxsize=64)
def font(size: int, bold: bool = False, file: str | None = None) -> pygame.font.Font:
    """Return a font at a size [pixel]: of a file, or the one that comes with pygame."""
    if not pygame.font.get_init():
        pygame.font.init()
    face = pygame.font.Font(file, max(size, 6))
    face.set_bold(bold)
    pygame.register_quit(font.cache_clear)  # another program's pygame.quit() makes fonts useless
    return face


@lru_cache(maxsize=1024)
def line(text: str, size: int, color: Color) -> pygame.Surface:
    """Return one line of text. The surface is shared: blit it, do not change it."""
    text = plain(text)  # some characters reverse the direction of writing, and fonts refuse others
    if size >= SMALL:
        return rendered(font(size, file=_file_for(text)), text, color)
    # Hinting spaces small letters unevenly; drawn large and shrunk they are even.
    large = rendered(font(ENLARGED * size, file=_file_for(text)), text, color)
    return pygame.transform.smoothscale_by(large, 1.0 / ENLARGED)


def rendered(face: pygame.font.Font, text: str, color: Color) -> pygame.Surface:
    """Render a text in a font; the surface is empty if no character has a width of its own."""
    return face.render(text if face.size(text)[0] else "", True, color)


def font_of(character: str, size: int) -> pygame.font.Font | None:
    """Return a font that has a character, at a size [pixel]; None if no font has it."""
    return next((font(size, file=file) for file in _files() if _has(file, character)), None)


def can_show(text: str) -> bool:
    """Return whether one font has all characters of a text."""
    return any(all(_has(file, character) for character in text) for file in _files())


def _file_for(text: str) -> str | None:
    """Return the first font that has all characters of a text; None, pygame's own, if no font has."""
    if text.isascii():
        return None
    return next((file for file in _files() if all(_has(file, one) for one in text)), None)


@lru_cache(maxsize=1)
def _files() -> tuple[str | None, ...]:
    """Return the available fonts; pygame's own, which is None, comes first."""
    return (None, *(file for file in _SYSTEM_FONTS if os.path.exists(file)))


@lru_cache(maxsize=4096)
def _has(file: str | None, character: str) -> bool:
    if character.isascii() or not character.isprintable():
        return character.isprintable()
    face = font(SMALL, file=file)
    missing, drawn = (rendered(face, one, (0, 0, 0)) for one in (_NO_CHARACTER, character))
    return drawn.get_width() > 0 and pygame.image.tobytes(drawn, "RGBA") != pygame.image.tobytes(
        missing, "RGBA"
    )


def number(value: int, size: int, color: Color) -> list[pygame.Surface]:
    """Return the glyphs of a number with thousands separators, left to right."""
    return [line(glyph, size, color) for glyph in f"{value:,}"]


def text_width(text: str, size: int) -> int:
    """Return the width [pixel] that `line` gives a text."""
    if size >= SMALL:
        return font(size).size(text)[0]
    return -(-font(ENLARGED * size).size(text)[0] // ENLARGED)


def wrapped(text: str, size: int, width: int) -> list[str]:
    """Break a text into lines no wider than `width` [pixel].

    Words are not broken, except those that are wider than a line, as a path may be.
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
    """Split a word into as few pieces as fit a line each; a piece has at least one letter."""
    pieces = []
    while len(word) > 1 and text_width(word, size) > width:
        count = next((end for end in range(len(word) - 1, 1, -1) if text_width(word[:end], size) <= width), 1)
        pieces.append(word[:count])
        word = word[count:]
    return [*pieces, word]


@lru_cache(maxsize=8)
def lettering(name: str, dimensions: Dimensions) -> NDArray[np.float32]:
    """Return the table's name as an image for the apron: brightness 0 to 1, float32 [row, column].

    Fonts are not thread-safe and the result is cached: call this once before baking in a thread.
    """
    depth = dimensions.apron_top + dimensions.half_length
    width = 2.0 * (dimensions.half_width - dimensions.thickness)
    columns = min(max(round(APRON_ROWS * width / max(depth, 1e-3)), 1), 4096)
    plate = np.zeros((APRON_ROWS, columns), np.float32)
    if not name.strip() or depth < 0.04 * width:
        return plate
    letters = "  ".join(plain(name.upper()).split())
    words = rendered(font(APRON_LETTERS, bold=True), letters, (255, 255, 255))
    if not words.get_width():
        return plate
    image = pygame.Surface(words.get_size(), 0, 24)
    image.blit(words, (0, 0))
    if image.get_width() > 0.7 * columns:
        share = 0.7 * columns / image.get_width()
        small = max(round(share * image.get_width()), 1), max(round(share * image.get_height()), 1)
        image = pygame.transform.smoothscale(image, small)
    ink = pygame.surfarray.array3d(image)[:, :, 0].T.astype(np.float32) / np.float32(255.0)
    ink = ink[:APRON_ROWS, :columns]
    top, left = (APRON_ROWS - ink.shape[0]) // 2, (columns - ink.shape[1]) // 2
    plate[top : top + ink.shape[0], left : left + ink.shape[1]] = ink
    return plate
