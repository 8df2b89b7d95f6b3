"""What does a ball look like by itself, as the sign of the program? A small picture of polished steel."""

from __future__ import annotations

import numpy as np
import pygame


def ball_icon(side: int) -> pygame.Surface:
    """A ball in a square of a side [pixel], with nothing around it."""
    middle, radius = 0.5 * side, 0.46 * side
    offset = (np.arange(side) + 0.5 - middle) / radius
    right, down = offset[:, None], offset[None, :]  # surfarray: columns first
    square = right**2 + down**2
    out = np.sqrt(np.clip(1.0 - square, 0.0, 1.0))
    up = -down
    # What the mirrored view meets: sky above, a dark horizon, a bright floor; and the lamp.
    look = 2.0 * out * up
    gray = np.where(
        look > 0.05, 0.55 + 0.45 * np.clip(look, 0.0, 1.0), 0.18 + 0.32 * np.clip(-look, 0.0, 1.0)
    )
    gray = gray * (0.45 + 0.55 * np.sqrt(out))
    glint = np.clip(1.0 - ((right + 0.30) ** 2 + (down + 0.38) ** 2) / 0.06, 0.0, 1.0)
    gray = np.clip(gray + glint, 0.0, 1.0)
    image = pygame.Surface((side, side), pygame.SRCALPHA)
    colors, alpha = pygame.surfarray.pixels3d(image), pygame.surfarray.pixels_alpha(image)
    colors[:] = np.round(255.0 * gray[:, :, None] * np.array([0.96, 0.98, 1.0]))
    alpha[:] = np.round(255.0 * np.clip((1.0 - np.sqrt(square)) * radius + 0.5, 0.0, 1.0))
    del colors, alpha
    return image
