"""Lines of text that fit a width: smaller at first, then cut."""

from __future__ import annotations

import pygame

from silverball.drawing.text import line
from silverball.drawing.themes import Color

LEAST = 0.7  # size of a text that has been made smaller, by what was asked for
GAP = 0.8  # between two texts of a row, by their size


def clipped(text: str, size: int, color: Color, width: int) -> pygame.Surface:
    """Return one line no wider than `width` [pixel]: in a smaller size, or with its end cut off."""
    image = line(text, size, color)
    if image.get_width() <= width:
        return image
    image = line(text, max(round(LEAST * size), size * width // image.get_width(), 7), color)
    return (
        image if image.get_width() <= width else image.subsurface((0, 0, max(width, 1), image.get_height()))
    )


def label_row(
    target: pygame.Surface,
    label: str,
    detail: str,
    top: int,
    size: int,
    colors: tuple[Color, Color],
    left: int = 0,
) -> pygame.Rect:
    """Draw a label at the left of a row and a detail at its right, and return where the detail is.

    Args:
        target: Where to draw.
        label: The text at the left.
        detail: The text at the right.
        top: Of the row [pixel].
        size: Of the text [pixel].
        colors: Of label and detail.
        left: Where the label begins [pixel].
    """
    room = target.get_width() - left
    gap = round(GAP * size)
    wanted = line(label, size, colors[0]).get_width()
    most = max(room - wanted - gap, 2 * room // 5)
    right = clipped(detail, size, colors[1], most) if detail else None
    used = 0 if right is None else right.get_width() + gap
    first = clipped(label, size, colors[0], max(room - used, 1))
    middle = top + round(0.6 * size)
    target.blit(first, first.get_rect(midleft=(left, middle)))
    place = pygame.Rect(left + room, top, 0, size)
    if right is not None:
        place = right.get_rect(midright=(left + room, middle))
        target.blit(right, place)
    return place
