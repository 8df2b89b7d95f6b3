"""What is written on the apron? The table's name, as an image that the marcher lays onto the plate."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.dimensions import Build
from silverball.drawing.text import font, rendered
from silverball.plain import plain

ROWS = 48  # [pixel] of the image
LETTERS = 40  # [pixel] size of the letters in it


@lru_cache(maxsize=8)
def lettering(name: str, build: Build) -> NDArray[np.float32]:
    """Brightness 0 to 1 of the name on the apron, shape [row, column]; the first row is the upper one.

    It is kept: fonts are not made for threads, so a program calls this once before it bakes in a thread.
    """
    depth = build.apron_top + build.half_length
    width = 2.0 * (build.half_width - build.thickness)
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
