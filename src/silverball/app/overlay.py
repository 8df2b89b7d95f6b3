"""What is written on top of the table? The first hint, messages, the help, the pause and the frame rate.

Every panel is put together once for a size and then only placed.
"""

from __future__ import annotations

import math
from functools import lru_cache

import pygame

from silverball.app.controls import BINDINGS, Action, Binding
from silverball.app.framerate import FrameTimes
from silverball.app.layout import column, in_columns, key_cap, panel, plate, row
from silverball.drawing import palette
from silverball.drawing.text import line, wrapped

TEXT_SIZE = 0.5  # [u] of ordinary text
LEAST_TEXT_SIZE = 11  # [pixel]
HINT_AT = 0.72  # of the height, 0 is the top: below the middle, above the paddles of most tables
LEAST_MESSAGE_SIZE = 8  # [pixel] to which a message shrinks before it grows beyond its place
DIM = (0, 0, 0, 120)  # over the table behind the help and the pause


def text_size(scale: float) -> int:
    """The size of ordinary text [pixel] at so many pixels per table unit."""
    return max(round(TEXT_SIZE * scale), LEAST_TEXT_SIZE)


def draw_first_hint(target: pygame.Surface, scale: float) -> None:
    """Before the first ball: what to press."""
    _place(target, _first_hint(text_size(scale)), HINT_AT)


def draw_next_ball_hint(target: pygame.Surface, scale: float, seconds: float) -> None:
    """When no ball is left: how to get another; it breathes slowly."""
    _place(target, _next_ball_hint(text_size(scale)), HINT_AT, 0.62 + 0.38 * math.cos(3.0 * seconds))


def draw_message(
    target: pygame.Surface, apron: pygame.Rect, scale: float, text: str, strength: float
) -> None:
    """A short message on the apron, where no play is; a long one grows upwards from there."""
    image = _message(text, text_size(scale), target.get_width(), target.get_height() - apron.top)
    image.set_alpha(round(255 * min(max(strength, 0.0), 1.0)))
    target.blit(image, image.get_rect(midbottom=(target.get_width() // 2, target.get_height())))


def draw_help(target: pygame.Surface, scale: float, seed: int) -> None:
    """All keys, and the seed in full."""
    _dim(target)
    _place(target, _help(text_size(scale), round(0.94 * target.get_width()), seed), 0.5)


def draw_pause(target: pygame.Surface, scale: float) -> None:
    """The game is paused."""
    _dim(target)
    _place(target, _pause(text_size(scale)), 0.5)


def draw_frame_rate(
    target: pygame.Surface, apron: pygame.Rect, scale: float, times: FrameTimes, seed: int
) -> None:
    """Above the apron: frames per second, the longest time between two of them, and the seed in full."""
    texts = (
        f"{times.per_second:.0f} frames/s, slowest {1000.0 * times.slowest:.0f} ms",
        f"seed {seed}",
    )
    image = column([line(text, text_size(scale), palette.TEXT) for text in texts], 0)
    target.blit(image, image.get_rect(midbottom=(target.get_width() // 2, apron.top - round(0.1 * scale))))


@lru_cache(maxsize=4)
def _first_hint(size: int) -> pygame.Surface:
    gap = size // 2
    large = round(1.3 * size)
    title = row([key_cap("Space", large), line("drops a ball", large, palette.SCORE)], gap)
    sides = [
        [
            row([key_cap(label, size) for label in _binding(action).shown[:2]], gap // 2),
            line(does, size, palette.TEXT),
        ]
        for action, does in ((Action.LEFT, "left paddle"), (Action.RIGHT, "right paddle"))
    ]
    more = row([key_cap("F1", size), line("shows all keys", size, palette.FAINT_TEXT)], gap)
    keys = column(in_columns(sides, gap), gap, centered=False)
    return panel(column([title, keys, more], round(0.7 * size)), size)


@lru_cache(maxsize=4)
def _next_ball_hint(size: int) -> pygame.Surface:
    return panel(row([key_cap("Space", size), line("new ball", size, palette.SCORE)], size // 2), size // 2)


@lru_cache(maxsize=16)
def _message(text: str, size: int, width: int, height: int) -> pygame.Surface:
    padding = size // 2
    lines = wrapped(text, size, width - 2 * padding)
    words = column([line(text, size, palette.TEXT) for text in lines], 0)
    if words.get_height() + 2 > height and size > LEAST_MESSAGE_SIZE:
        return _message(text, size - 1, width, height)
    return plate(words, width, max(height, words.get_height() + 2))


@lru_cache(maxsize=4)
def _help(size: int, width: int, seed: int) -> pygame.Surface:
    gap = size // 2
    rows = [
        [
            row([key_cap(label, size) for label in binding.shown], gap // 2),
            line(binding.does, size, palette.TEXT),
        ]
        for binding in BINDINGS
    ]
    title = line("KEYS", round(1.2 * size), palette.SCORE)
    keys = column(in_columns(rows, gap), gap // 2, centered=False)
    content = column([title, keys, line(f"seed {seed}", size, palette.FAINT_TEXT)], gap)
    whole = panel(content, size)
    if whole.get_width() > width and size > 7:
        return _help(size - 1, width, seed)
    return whole


@lru_cache(maxsize=4)
def _pause(size: int) -> pygame.Surface:
    title = line("PAUSE", round(1.8 * size), palette.SCORE)
    return panel(
        column([title, row([key_cap("P", size), line("goes on", size, palette.TEXT)], size // 2)], size), size
    )


def _binding(action: Action) -> Binding:
    return next(binding for binding in BINDINGS if binding.action is action)


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
