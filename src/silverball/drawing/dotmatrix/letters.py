"""How does the score display write letters that its own fonts lack, as those on other keyboards?

They are taken from the font of all other texts, drawn large and read off: a dot is lit where a letter fills
most of it.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.text import font_of

SIZE = 200  # [pixel] of the letters that are read off
FULL = 255  # cover of a pixel
FILLED = 0.5  # share of a dot that is covered, from which it is lit
BELOW = 0.3  # of the height of a capital: how far a letter may reach below the line


@lru_cache(maxsize=512)
def read_off(character: str, height: int) -> NDArray[np.bool_] | None:
    """The dots of a letter.

    Args:
        character: The letter.
        height: Of a capital [dot].

    Returns:
        Shape [row, column], one column or more; None if no font has the letter.
    """
    face = font_of(character, SIZE)
    if face is None:
        return None
    letter, capital = (face.render(one, True, (255, 255, 255)) for one in (character, "H"))
    box, line = letter.get_bounding_rect(), capital.get_bounding_rect()
    if not box:
        return None
    top = min(box.top, line.top)  # a capital with an accent is squeezed, so that the accent has a place
    pitch = (line.bottom - top) / height  # [pixel] of a dot
    below = min(max(math.ceil((box.bottom - line.bottom) / pitch), 0), round(BELOW * height))
    sheet = pygame.Surface((box.width, round(pitch * (height + below))), pygame.SRCALPHA)
    sheet.blit(letter, (-box.left, -top))
    width = max(round(box.width * height / line.height), 1)
    dots = pygame.transform.smoothscale(sheet, (width, height + below))
    lit = pygame.surfarray.array_alpha(dots).T > FILLED * FULL
    while len(lit) > height and not lit[-1].any():
        lit = lit[:-1]
    return np.asarray(lit, np.bool_)
