"""Tests read the score display: does a text stand on it?"""

import numpy as np

from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.fonts import BOLD, HUGE, NORMAL, Font


def reads(dots: Dots, text: str, fonts: tuple[Font, ...] = (HUGE, BOLD, NORMAL)) -> bool:
    """Whether a text stands somewhere on the dots, bright on dark or dark on bright."""
    lit = dots.pixels > 0
    return any(
        _stands(picture, text, font)
        for font in fonts
        if all(font.has(letter) for letter in text) and font.width(text) <= lit.shape[1]
        for picture in (lit, ~lit)
    )


def _stands(picture: np.ndarray, text: str, font: Font) -> bool:
    sheet = Dots()
    width = sheet.text(text, 0, 0, font)
    # Each column of a line becomes one number, so that whole columns are compared at once.
    weights = 1 << np.arange(font.height)
    pattern = weights @ (sheet.pixels[: font.height, :width] > 0)
    lines = np.lib.stride_tricks.sliding_window_view(picture, font.height, axis=0) @ weights
    fits = np.ones((lines.shape[0], lines.shape[1] - width + 1), np.bool_)
    for column, code in enumerate(pattern):
        fits &= lines[:, column : column + fits.shape[1]] == code
        if not fits.any():
            return False
    return True
