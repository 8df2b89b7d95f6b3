"""What is written on top of the table? Short messages, and the help with all keys.

Every panel is put together once for a size and then only placed.
"""

from __future__ import annotations

from functools import lru_cache

import pygame

from silverball.app.controls import Action, Controls
from silverball.app.layout import column, in_columns, key_cap, panel, plate, row
from silverball.app.menus import ACTIONS, capital
from silverball.drawing import palette
from silverball.drawing.text import line, wrapped

TEXT_SIZE = 0.5  # [u] of ordinary text
LEAST_TEXT_SIZE = 11  # [pixel]
LEAST_MESSAGE_SIZE = 8  # [pixel] to which a message shrinks before it grows beyond its place
DIM = (0, 0, 0, 120)  # over the table behind the help and the pause


def text_size(scale: float) -> int:
    """The size of ordinary text [pixel] at so many pixels per table unit."""
    return max(round(TEXT_SIZE * scale), LEAST_TEXT_SIZE)


def draw_message(
    target: pygame.Surface, apron: pygame.Rect, scale: float, text: str, strength: float
) -> None:
    """A short message on the apron, where no play is; a long one grows upwards from there."""
    image = _message(text, text_size(scale), target.get_width(), target.get_height() - apron.top)
    image.set_alpha(round(255 * min(max(strength, 0.0), 1.0)))
    target.blit(image, image.get_rect(midbottom=(target.get_width() // 2, target.get_height())))


def draw_help(target: pygame.Surface, scale: float, seed: int, controls: Controls) -> None:
    """All keys as they are now, and the seed in full."""
    _dim(target)
    keys = []
    for one in ACTIONS:
        names = controls.shown_keys(Action(one.action))
        names = ("escape", *names) if one.action == "back" else names
        if names:
            keys.append((one.label.lower(), tuple(map(_cap, names))))
    _place(target, _help(text_size(scale), round(0.94 * target.get_width()), seed, tuple(keys)), 0.5)


def small_text_size(scale: float) -> int:
    """The size of figures [pixel] at so many pixels per table unit."""
    return max(round(0.7 * text_size(scale)), 9)


def _cap(name: str) -> str:
    """What stands on a key; "<" and ">" are the arrow keys."""
    short = {"left": "<", "right": ">", "escape": "Esc"}
    return short.get(name, capital(name) if len(name) < 3 or name[1:].isdigit() else name.capitalize())


@lru_cache(maxsize=16)
def _message(text: str, size: int, width: int, height: int) -> pygame.Surface:
    padding = size // 2
    lines = wrapped(text, size, width - 2 * padding)
    words = column([line(text, size, palette.TEXT) for text in lines], 0)
    if words.get_height() + 2 > height and size > LEAST_MESSAGE_SIZE:
        return _message(text, size - 1, width, height)
    return plate(words, width, max(height, words.get_height() + 2))


@lru_cache(maxsize=4)
def _help(size: int, width: int, seed: int, keys: tuple[tuple[str, tuple[str, ...]], ...]) -> pygame.Surface:
    gap = size // 2
    rows = [
        [row([key_cap(name, size) for name in names], gap // 2), line(label, size, palette.TEXT)]
        for label, names in keys
    ]
    title = line("KEYS", round(1.2 * size), palette.SCORE)
    listed = column(in_columns(rows, gap), gap // 2, centered=False)
    content = column([title, listed, line(f"seed {seed}", size, palette.FAINT_TEXT)], gap)
    whole = panel(content, size)
    if whole.get_width() > width and size > 7:
        return _help(size - 1, width, seed, keys)
    return whole


def _dim(target: pygame.Surface) -> None:
    target.blit(_veil(target.get_size()), (0, 0))


@lru_cache(maxsize=2)
def _veil(size: tuple[int, int]) -> pygame.Surface:
    veil = pygame.Surface(size, pygame.SRCALPHA)
    veil.fill(DIM)
    return veil


def _place(target: pygame.Surface, image: pygame.Surface, height: float, strength: float = 1.0) -> None:
    """Put an image into the middle, at a height from 0 (top) to 1 (bottom), more or less visible."""
    image.set_alpha(round(255 * min(max(strength, 0.0), 1.0)))
    middle = (target.get_width() // 2, round(height * target.get_height()))
    target.blit(image, image.get_rect(center=middle))
