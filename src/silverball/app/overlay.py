"""Text on top of the table: short messages, and the help pages with the scoring rules and all keys.

Every panel is composed once per size and then only blitted. Beside a table with a backglass the help is shown
there instead.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import pygame

from silverball.app.bindings import ACTIONS, upper_label
from silverball.app.controls import Action, Controls
from silverball.app.scoring import Rule
from silverball.app.widgets import column, in_columns, key_cap, panel, plate, row, side_by_side
from silverball.drawing import themes
from silverball.drawing.text import line, wrapped
from silverball.plain import plain

TEXT_SIZE = 0.5  # [u] of ordinary text
MIN_TEXT_SIZE = 11  # [pixel]
MIN_MESSAGE_SIZE = 8  # [pixel]; a longer message outgrows its area instead of shrinking further
MIN_HELP_SIZE = 7  # [pixel]; a larger help is scaled down as an image
HELP_SHARE = 0.94  # share of the table's area that the help may cover
HELP_PAGES = 2
KEYS_SHAPE, MAX_KEY_COLUMNS = 0.9, 3  # width by height of a column of keys, and how many there are at most
WIDE_SHAPE = 1.3  # width by height from which on the rules are in two columns
SCORING_PAGE = 0  # how to score; the other page lists the keys
DIM = (0, 0, 0, 120)  # over the table behind the help


def text_size(scale: float) -> int:
    """Return the size of ordinary text [pixel]; `scale` is in pixels per table unit."""
    return max(round(TEXT_SIZE * scale), MIN_TEXT_SIZE)


def draw_message(target: pygame.Surface, apron: pygame.Rect, scale: float, text: str, opacity: float) -> None:
    """Draw a short message on the apron, where it hides nothing; a long one extends upwards."""
    image = _message(text, text_size(scale), target.get_width(), target.get_height() - apron.top)
    image.set_alpha(round(255 * min(max(opacity, 0.0), 1.0)))
    target.blit(image, image.get_rect(midbottom=(target.get_width() // 2, target.get_height())))


class Help(NamedTuple):
    """What the help says.

    Attributes:
        page: The visible page.
        seed: The seed of the board.
        controls: The current keys.
        rules: How to score.
    """

    page: int
    seed: int
    controls: Controls
    rules: Sequence[Rule]


def draw_help(target: pygame.Surface, scale: float, help_: Help) -> None:
    """Draw a page of the help over a darkened table."""
    dim(target)
    available = (round(HELP_SHARE * target.get_width()), round(HELP_SHARE * target.get_height()))
    _place(target, help_image(help_, text_size(scale), available), 0.5)


def help_image(
    help_: Help, size: int, available: tuple[int, int], *, has_frame: bool = True
) -> pygame.Surface:
    """Return a page of the help: how to score, or all keys and the seed.

    Args:
        help_: What it says.
        size: Size of the text [pixel], which is smaller where that would not fit.
        available: Width and height that it may have [pixel].
        has_frame: Whether it is a panel of its own.
    """
    controls, padding = help_.controls, size if has_frame else 0
    turn_key, leave_key = _first_key(controls, Action.CREATE), _first_key(controls, Action.HELP)
    if help_.page == SCORING_PAGE:
        return _rules(size, available, tuple(help_.rules), _foot(turn_key, "keys", leave_key), padding)
    keys = []
    for binding in ACTIONS:
        names = controls.key_labels(Action(binding.action))
        names = ("escape", *names) if binding.action == "back" else names
        if names:
            keys.append((binding.label.lower(), tuple(map(_cap_label, names))))
    foot = _foot(turn_key, "how to score", leave_key)
    return _keys(size, available, (help_.seed, tuple(keys)), foot, padding)


def _first_key(controls: Controls, action: Action) -> str:
    names = controls.key_labels(action)
    return _cap_label(names[0]) if names else "Esc"


def _foot(turn_key: str, other_page: str, leave_key: str) -> str:
    """Return how to turn to the other page, and how to leave."""
    return f"paddle or {turn_key}: {other_page} · {leave_key}: close"


def small_text_size(scale: float) -> int:
    """Return the size of debug figures [pixel]; `scale` is in pixels per table unit."""
    return max(round(0.7 * text_size(scale)), 9)


def _cap_label(name: str) -> str:
    """Return the text on a key cap; "<" and ">" are the arrow keys."""
    short = {"left": "<", "right": ">", "escape": "Esc"}
    return short.get(name, upper_label(name) if len(name) < 3 or name[1:].isdigit() else name.capitalize())


@lru_cache(maxsize=16)
def _message(text: str, size: int, width: int, height: int) -> pygame.Surface:
    padding = size // 2
    lines = wrapped(text, size, width - 2 * padding)
    words = column([line(text, size, themes.TEXT) for text in lines], 0)
    if words.get_height() + padding > height and size > MIN_MESSAGE_SIZE:
        return _message(text, size - 1, width, height)
    return plate(words, width, max(height, words.get_height() + padding))


@lru_cache(maxsize=4)
def _keys(
    size: int,
    available: tuple[int, int],
    seed_and_keys: tuple[int, tuple[tuple[str, tuple[str, ...]], ...]],
    foot: str,
    padding: int,
) -> pygame.Surface:
    seed, keys = seed_and_keys

    def build(size: int) -> pygame.Surface:
        gap = size // 2
        rows = [
            [row([key_cap(name, size) for name in names], gap // 2), line(label, size, themes.TEXT)]
            for label, names in keys
        ]
        title = line("KEYS", round(1.2 * size), themes.SCORE)
        count = min(max(round(available[0] / (KEYS_SHAPE * available[1])), 1), MAX_KEY_COLUMNS)
        length = -(-len(rows) // count)
        columns = [in_columns(rows[first : first + length], gap) for first in range(0, len(rows), length)]
        listed = side_by_side([column(lines, gap // 2, centered=False) for lines in columns], 3 * gap)
        ends = (f"seed {seed}", *wrapped(foot, size, max(listed.get_width(), available[0] - 2 * size)))
        lines = [line(text, size, themes.FAINT_TEXT) for text in ends]
        return _framed(column([title, listed, *lines], gap), size, padding)

    return _fitting(build, size, available)


@lru_cache(maxsize=4)
def _rules(
    size: int, available: tuple[int, int], rules: tuple[Rule, ...], foot: str, padding: int
) -> pygame.Surface:
    def build(size: int) -> pygame.Surface:
        gap, count = size // 2, 1 + (available[0] > WIDE_SHAPE * available[1])
        width = min((available[0] - 2 * size) // count, 34 * size)
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
        body = side_by_side(
            _in_halves(blocks, gap) if count > 1 else [column(blocks, gap, centered=False)], size
        )
        return _framed(column([title, body, *ends], gap), size, padding)

    return _fitting(build, size, available)


def _in_halves(blocks: Sequence[pygame.Surface], gap: int) -> list[pygame.Surface]:
    """Place blocks in two columns of about the same height."""
    heights = [block.get_height() + gap for block in blocks]
    cut = min(range(1, len(blocks) + 1), key=lambda end: abs(2 * sum(heights[:end]) - sum(heights)))
    return [column(part, gap, centered=False) for part in (blocks[:cut], blocks[cut:]) if part]


def _framed(content: pygame.Surface, size: int, padding: int) -> pygame.Surface:
    return panel(content, size) if padding else content


def _fitting(build: Callable[[int], pygame.Surface], size: int, available: tuple[int, int]) -> pygame.Surface:
    """Build an image at the greatest text size at which it fits, from `size` down."""
    image = build(size)
    while size > MIN_HELP_SIZE and (image.get_width() > available[0] or image.get_height() > available[1]):
        size -= 1
        image = build(size)
    share = min(available[0] / image.get_width(), available[1] / image.get_height())
    if share >= 1.0:
        return image
    width, height = (max(round(share * side), 1) for side in image.get_size())
    return pygame.transform.smoothscale(image, (width, height))


def dim(target: pygame.Surface) -> None:
    """Darken what is behind the help."""
    target.blit(_veil(target.get_size()), (0, 0))


@lru_cache(maxsize=2)
def _veil(size: tuple[int, int]) -> pygame.Surface:
    veil = pygame.Surface(size, pygame.SRCALPHA)
    veil.fill(DIM)
    return veil


def _place(target: pygame.Surface, image: pygame.Surface, height: float, opacity: float = 1.0) -> None:
    """Draw an image in the middle, at a height from 0 (top) to 1 (bottom)."""
    image.set_alpha(round(255 * min(max(opacity, 0.0), 1.0)))
    middle = (target.get_width() // 2, round(height * target.get_height()))
    target.blit(image, image.get_rect(center=middle))


MIN_SECONDS = 2.2
MAX_SECONDS_IN_PLAY = 2.5  # [s] while a ball needs the player's attention
SECONDS_PER_LETTER = 0.045  # for a slow reader
FADE_SECONDS = 0.4


class Messages:
    """The message on screen; a new one replaces it, and showing the same one again has no effect."""

    def __init__(self) -> None:
        self.text = ""
        self._left = 0.0

    def show(self, text: str) -> None:
        """Show a message, with a capital (unless it begins with a file name) and a full stop."""
        text = plain(text, keep="\n")
        if "." not in text.split(" ", 1)[0]:
            text = text[:1].upper() + text[1:]
        text = text if text.endswith((".", "!", "?", "…")) else f"{text}."
        if text == self.text and self._left > 0.0:
            return
        self.text = text
        self._left = MIN_SECONDS + SECONDS_PER_LETTER * len(text)

    def clear(self) -> None:
        """Remove the message."""
        self._left = 0.0

    def update(self, seconds: float, *, in_play: bool = False) -> None:
        """Advance by real time [s]; messages end sooner while a ball is in play."""
        most = MAX_SECONDS_IN_PLAY if in_play else self._left
        self._left = max(0.0, min(self._left, most) - seconds)

    @property
    def opacity(self) -> float:
        """The opacity of the message: 1, fading to 0."""
        return min(1.0, self._left / FADE_SECONDS)
