"""How are words and numbers drawn? In pygame's own font, each piece rendered once and kept.

Letters that it lacks, such as those on a Hebrew keyboard, come from a font of the system if one has them.

Rendering a line anew costs milliseconds; a score that counts up is put together from kept digits instead.
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

SMALL = 30  # [pixel] sizes below it are drawn larger and shrunk
ENLARGED = 4
ROWS = 48  # [pixel] of the image
LETTERS = 40  # [pixel] size of the letters in it
_SYSTEM_FONTS = (
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",  # Debian and Ubuntu
    "/usr/share/fonts/TTF/DejaVuSans.ttf",  # Arch
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",  # Fedora
    "/System/Library/Fonts/Supplemental/Arial Unicode.ttf",
    *(f"C:/Windows/Fonts/{name}.ttf" for name in ("arial", "segoeui", "sylfaen", "nirmala", "leelawui")),
)
"""Where systems have fonts with many letters; to ask a system for all its fonts may take seconds."""
_NO_CHARACTER = "\ufffe"  # in no font, so it shows what a font draws for characters that it lacks


@lru_cache(maxsize=64)
def font(size: int, bold: bool = False, file: str | None = None) -> pygame.font.Font:
    """A font at a size [pixel]: of a file, or the one that comes with pygame."""
    if not pygame.font.get_init():
        pygame.font.init()
    face = pygame.font.Font(file, max(size, 6))
    face.set_bold(bold)
    pygame.register_quit(font.cache_clear)  # another program's pygame.quit() makes fonts useless
    return face


@lru_cache(maxsize=1024)
def line(text: str, size: int, color: Color) -> pygame.Surface:
    """One line of text. The surface is shared: blit it, do not change it."""
    text = plain(text)  # some characters turn the direction round, and a font refuses others
    if size >= SMALL:
        return rendered(font(size, file=_file_for(text)), text, color)
    # The font's hints push small letters unevenly onto whole pixels; drawn large and shrunk they stand well.
    large = rendered(font(ENLARGED * size, file=_file_for(text)), text, color)
    return pygame.transform.smoothscale_by(large, 1.0 / ENLARGED)


def rendered(face: pygame.font.Font, text: str, color: Color) -> pygame.Surface:
    """A text in a font; as wide as nothing where it has only characters without any width of their own."""
    return face.render(text if face.size(text)[0] else "", True, color)


def font_of(character: str, size: int) -> pygame.font.Font | None:
    """A font that has a character, at a size [pixel]; None if none has it."""
    return next((font(size, file=file) for file in _files() if _has(file, character)), None)


def can_show(text: str) -> bool:
    """Whether there is a font that has all of a text."""
    return any(all(_has(file, character) for character in text) for file in _files())


def _file_for(text: str) -> str | None:
    """The first font that has all of a text; pygame's own, None, if none has."""
    if text.isascii():
        return None
    return next((file for file in _files() if all(_has(file, one) for one in text)), None)


@lru_cache(maxsize=1)
def _files() -> tuple[str | None, ...]:
    """All fonts there are; pygame's own, which is None, comes first."""
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


@lru_cache(maxsize=8)
def lettering(name: str, dimensions: Dimensions) -> NDArray[np.float32]:
    """Brightness 0 to 1 of the name on the apron, shape [row, column]; the first row is the upper one.

    It is kept: fonts are not made for threads, so a program calls this once before it bakes in a thread.
    """
    depth = dimensions.apron_top + dimensions.half_length
    width = 2.0 * (dimensions.half_width - dimensions.thickness)
    columns = min(max(round(ROWS * width / max(depth, 1e-3)), 1), 4096)
    plate = np.zeros((ROWS, columns), np.float32)
    if not name.strip() or depth < 0.04 * width:
        return plate
    letters = "  ".join(plain(name.upper()).split())
    words = rendered(font(LETTERS, bold=True), letters, (255, 255, 255))
    if not words.get_width():
        return plate
    image = pygame.Surface(words.get_size(), 0, 24)
    image.blit(words, (0, 0))
    if image.get_width() > 0.7 * columns:
        share = 0.7 * columns / image.get_width()
        small = max(round(share * image.get_width()), 1), max(round(share * image.get_height()), 1)
        image = pygame.transform.smoothscale(image, small)
    ink = pygame.surfarray.array3d(image)[:, :, 0].T.astype(np.float32) / np.float32(255.0)
    ink = ink[:ROWS, :columns]
    top, left = (ROWS - ink.shape[0]) // 2, (columns - ink.shape[1]) // 2
    plate[top : top + ink.shape[0], left : left + ink.shape[1]] = ink
    return plate
