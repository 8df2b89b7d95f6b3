"""Composes words, key caps and panels from small surfaces, side by side and one below the other."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import pygame

from silverball.drawing import themes
from silverball.drawing.text import line

PANEL_OPACITY = 226  # of 255


def row(images: Sequence[pygame.Surface], gap: int) -> pygame.Surface:
    """Place images side by side, vertically centred."""
    width = sum(image.get_width() for image in images) + gap * (len(images) - 1)
    result = _transparent(width, max(image.get_height() for image in images))
    left = 0
    for image in images:
        result.blit(image, image.get_rect(midleft=(left, result.get_height() // 2)))
        left += image.get_width() + gap
    return result


def side_by_side(images: Sequence[pygame.Surface], gap: int) -> pygame.Surface:
    """Place images side by side, their tops at one height."""
    height = max(image.get_height() for image in images)
    result = _transparent(sum(image.get_width() for image in images) + gap * (len(images) - 1), height)
    left = 0
    for image in images:
        result.blit(image, (left, 0))
        left += image.get_width() + gap
    return result


def column(images: Sequence[pygame.Surface], gap: int, *, centered: bool = True) -> pygame.Surface:
    """Place images one below the other."""
    width = max(image.get_width() for image in images)
    result = _transparent(width, sum(image.get_height() for image in images) + gap * (len(images) - 1))
    top = 0
    for image in images:
        left = (width - image.get_width()) // 2 if centered else 0
        result.blit(image, (left, top))
        top += image.get_height() + gap
    return result


def in_columns(rows: Sequence[Sequence[pygame.Surface]], gap: int) -> list[pygame.Surface]:
    """Build rows whose first images are padded to one width, so that the second ones line up."""
    width = max(first.get_width() for first, *_ in rows)
    lined_up = []
    for first, *others in rows:
        cell = _transparent(width, first.get_height())
        cell.blit(first, (0, 0))
        lined_up.append(row([cell, *others], gap))
    return lined_up


def panel(content: pygame.Surface, padding: int) -> pygame.Surface:
    """Draw a dark rounded panel around an image."""
    width, height = content.get_width() + 2 * padding, content.get_height() + 2 * padding
    result = _rounded(width, height, padding, (*themes.PANEL, PANEL_OPACITY), themes.PANEL_INNER)
    result.blit(content, (padding, padding))
    return result


def plate(content: pygame.Surface, width: int, height: int) -> pygame.Surface:
    """Draw a dark rounded plate of a given size with an image in its middle."""
    result = _rounded(width, height, height // 6, (*themes.PANEL, 255), themes.PANEL_INNER)
    result.blit(content, content.get_rect(center=(width // 2, height // 2)))
    return result


@lru_cache(maxsize=256)
def key_cap(label: str, size: int) -> pygame.Surface:
    """Draw a key cap; "<" and ">" are the arrow keys."""
    text = _arrow(label, size) if label in ("<", ">") else line(label, size, themes.TEXT)
    height = round(1.7 * size)
    width = max(height, text.get_width() + round(0.9 * size))
    cap = _rounded(width, height, round(0.35 * size), (*themes.KEY_FACE, 255), themes.KEY_EDGE)
    cap.blit(text, text.get_rect(center=(width // 2, height // 2)))
    return cap


def _arrow(label: str, size: int) -> pygame.Surface:
    large = _transparent(4 * size, 4 * size)
    tip, back = (0.7, 3.3) if label == "<" else (3.3, 0.7)
    points = [(tip * size, 2 * size), (back * size, 0.6 * size), (back * size, 3.4 * size)]
    pygame.draw.polygon(large, themes.TEXT, points)
    return pygame.transform.smoothscale(large, (round(0.8 * size), round(0.8 * size)))


def _rounded(
    width: int, height: int, rounding: int, face: tuple[int, int, int, int], edge: themes.Color
) -> pygame.Surface:
    """Draw a rounded box with a thin edge, antialiased by supersampling."""
    large = _transparent(3 * width, 3 * height)
    pygame.draw.rect(large, face, large.get_rect(), border_radius=3 * rounding)
    pygame.draw.rect(large, edge, large.get_rect(), max(round(0.3 * rounding), 4), border_radius=3 * rounding)
    return pygame.transform.smoothscale(large, (width, height))


def _transparent(width: int, height: int) -> pygame.Surface:
    return pygame.Surface((max(width, 1), max(height, 1)), pygame.SRCALPHA)
