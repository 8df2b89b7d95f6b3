"""The painting behind table and backglass, computed at a small size and enlarged: no window has black bars.

It takes the colours of the table's theme, darkened, so that the table stays the brightest thing.
"""

from __future__ import annotations

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.kernels.stage import Art
from silverball.drawing.sketch import rgb_surface
from silverball.drawing.themes import Theme

COARSE = 4  # [pixel] of the picture for one of the painting
RAYS = 18
STARS_PER_MEGAPIXEL = 220
DARK = 0.62  # of the theme's floor
FADE = 0.08  # width of the transition to the table, by the height of the window
SEED = 7  # of stars and grain; any other would do


def backdrop(size: tuple[int, int], theme: Theme, table: pygame.Rect) -> pygame.Surface:
    """Paint a backdrop.

    Args:
        size: Its width and height [pixel].
        theme: Its colours.
        table: Where the table is [pixel]: towards it the painting fades to the room around the table.
    """
    width, height = max(size[0] // COARSE, 2), max(size[1] // COARSE, 2)
    small = rgb_surface((width, height))
    pygame.surfarray.blit_array(
        small, np.ascontiguousarray(_painting(width, height, theme, table).swapaxes(0, 1))
    )
    picture = pygame.transform.smoothscale(small, size)
    if theme.art is Art.COSMOS:
        _stars(picture, theme)
    return picture


def _painting(width: int, height: int, theme: Theme, table: pygame.Rect) -> NDArray[np.uint8]:
    x = np.linspace(-1.0, 1.0, width)[None, :] * width / height
    y = np.linspace(-1.0, 1.0, height)[:, None]
    low, middle, high = (DARK * np.array(color, float) for color in theme.floor)
    room = np.array(theme.room, float)
    down = (0.5 * (y + 1.0))[..., None]
    ground = high * (1.0 - down) ** 2 + middle * 2.0 * down * (1.0 - down) + low * down**2
    away = np.hypot(x - 0.35 * width / height, y + 0.25)[..., None]
    light = np.exp(-1.8 * away)
    picture = room + (ground - room) * np.exp(-0.45 * away**2)
    picture = picture + 0.26 * light * np.array(theme.glow, float)
    if theme.art is Art.COSMOS:
        angle = np.arctan2(y + 0.25, x - 0.35 * width / height)[..., None]
        rays = np.clip(np.cos(RAYS * angle), 0.0, 1.0) ** 2 * np.exp(-0.9 * away)
        picture = picture + 0.22 * rays * np.array(theme.ray, float)
    elif theme.art is Art.WOOD:
        picture = picture * _grain(width, height)[..., None]
    across = COARSE * (np.arange(width) + 0.5)
    beside = np.maximum(np.maximum(table.left - across, across - table.right), 0.0)
    share = np.clip(beside / (FADE * COARSE * height), 0.0, 1.0)[None, :, None]
    pixels: NDArray[np.uint8] = np.clip(room + (picture - room) * share, 0.0, 255.0).astype(np.uint8)
    return pixels


def _grain(width: int, height: int) -> NDArray[np.float64]:
    """Return the light of wooden boards, whose grain runs downwards."""
    random = np.random.default_rng(SEED)
    lines = np.convolve(random.normal(size=width + 8), np.ones(5) / 5.0, mode="same")[:width]
    boards = 1.0 - 0.35 * (np.arange(width) % max(width // 14, 4) == 0)
    waves = 0.02 * np.sin(np.linspace(0.0, 9.0, height))[:, None] * np.sin(0.13 * np.arange(width))[None, :]
    light: NDArray[np.float64] = 0.62 * (1.0 + 0.12 * lines[None, :] + waves) * boards[None, :]
    return light


def _stars(picture: pygame.Surface, theme: Theme) -> None:
    width, height = picture.get_size()
    random = np.random.default_rng(SEED)
    count = round(STARS_PER_MEGAPIXEL * width * height / 1e6)
    for x, y, light in zip(
        random.integers(0, width, count), random.integers(0, height, count), random.random(count), strict=True
    ):
        share = 0.25 + 0.75 * light**4
        red, green, blue = (round(share * channel) for channel in theme.label)
        side = 2 if light > 0.93 else 1
        picture.fill((red, green, blue), (int(x), int(y), side, side))
