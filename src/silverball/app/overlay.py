"""What is written on top of the table? Short messages, and the help: all keys, and how to score.

Every panel is put together once for a size and then only placed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import pygame

from silverball.app.controls import Action, Controls
from silverball.app.menus import ACTIONS, capital
from silverball.app.scoring import Rule
from silverball.app.widgets import column, in_columns, key_cap, panel, plate, row
from silverball.drawing import themes
from silverball.drawing.text import line, wrapped

TEXT_SIZE = 0.5  # [u] of ordinary text
LEAST_TEXT_SIZE = 11  # [pixel]
LEAST_MESSAGE_SIZE = 8  # [pixel] to which a message shrinks before it grows beyond its place
LEAST_HELP_SIZE = 7  # [pixel] to which the help shrinks before it is made smaller as a picture
HELP_SHARE = 0.94  # of the table's area that the help may take
HELP_PAGES = 2
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


def draw_help(
    target: pygame.Surface, scale: float, seed: int, controls: Controls, page: int, rules: Sequence[Rule]
) -> None:
    """All keys as they are now, and the seed in full; or, on the second page, how to score."""
    _dim(target)
    room = (round(HELP_SHARE * target.get_width()), round(HELP_SHARE * target.get_height()))
    size = text_size(scale)
    turn, leave = _first(controls, Action.CREATE), _first(controls, Action.HELP)
    if page:
        _place(target, _rules(size, room, tuple(rules), _foot(turn, "keys", leave)), 0.5)
        return
    keys = []
    for one in ACTIONS:
        names = controls.shown_keys(Action(one.action))
        names = ("escape", *names) if one.action == "back" else names
        if names:
            keys.append((one.label.lower(), tuple(map(_cap, names))))
    _place(target, _help(size, room, seed, tuple(keys), _foot(turn, "how to score", leave)), 0.5)


def _first(controls: Controls, action: Action) -> str:
    names = controls.shown_keys(action)
    return _cap(names[0]) if names else "Esc"


def _foot(turn: str, other: str, leave: str) -> str:
    """How one comes to the other page, and away."""
    return f"paddle or {turn}: {other} · {leave}: go on"


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
    words = column([line(text, size, themes.TEXT) for text in lines], 0)
    if words.get_height() + padding > height and size > LEAST_MESSAGE_SIZE:
        return _message(text, size - 1, width, height)
    return plate(words, width, max(height, words.get_height() + padding))


@lru_cache(maxsize=4)
def _help(
    size: int,
    room: tuple[int, int],
    seed: int,
    keys: tuple[tuple[str, tuple[str, ...]], ...],
    foot: str,
) -> pygame.Surface:
    def build(size: int) -> pygame.Surface:
        gap = size // 2
        rows = [
            [row([key_cap(name, size) for name in names], gap // 2), line(label, size, themes.TEXT)]
            for label, names in keys
        ]
        title = line("KEYS", round(1.2 * size), themes.SCORE)
        listed = column(in_columns(rows, gap), gap // 2, centered=False)
        ends = (f"seed {seed}", *wrapped(foot, size, max(listed.get_width(), room[0] - 2 * size)))
        lines = [line(text, size, themes.FAINT_TEXT) for text in ends]
        return panel(column([title, listed, *lines], gap), size)

    return _fitting(build, size, room)


@lru_cache(maxsize=4)
def _rules(size: int, room: tuple[int, int], rules: tuple[Rule, ...], foot: str) -> pygame.Surface:
    def build(size: int) -> pygame.Surface:
        gap, width = size // 2, min(room[0] - 2 * size, 34 * size)
        blocks = [
            column(
                [
                    line(rule.title, size, themes.SCORE),
                    *(line(text, size, themes.TEXT) for text in wrapped(f"{rule.text}.", size, width)),
                ],
                0,
                centered=False,
            )
            for rule in rules
        ]
        title = line("HOW TO SCORE", round(1.2 * size), themes.SCORE)
        ends = [line(text, size, themes.FAINT_TEXT) for text in wrapped(foot, size, width)]
        return panel(column([title, column(blocks, gap, centered=False), *ends], gap), size)

    return _fitting(build, size, room)


def _fitting(build: Callable[[int], pygame.Surface], size: int, room: tuple[int, int]) -> pygame.Surface:
    """What is built at the greatest size at which it fits, from this one down."""
    image = build(size)
    while size > LEAST_HELP_SIZE and (image.get_width() > room[0] or image.get_height() > room[1]):
        size -= 1
        image = build(size)
    share = min(room[0] / image.get_width(), room[1] / image.get_height())
    if share >= 1.0:
        return image
    width, height = (max(round(share * side), 1) for side in image.get_size())
    return pygame.transform.smoothscale(image, (width, height))


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
