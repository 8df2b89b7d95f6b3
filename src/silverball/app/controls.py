"""Which key does what, and which paddles are held? One table of keys drives the game and its help.

Keys go by what is printed on them, not by their place on the keyboard; only where that is no Latin character,
as on a Greek or Cyrillic keyboard, their place counts.
"""

from __future__ import annotations

import sys
import unicodedata
from enum import Enum, auto
from typing import NamedTuple

import pygame


class Action(Enum):
    """What a key can ask for."""

    LEFT = auto()
    RIGHT = auto()
    JITTER = auto()
    CREATE = auto()
    PAUSE = auto()
    NEW_BOARD = auto()
    SAME_BOARD = auto()
    MUTE = auto()
    HELP = auto()
    FRAME_RATE = auto()
    FULL_SCREEN = auto()
    QUIT = auto()


class Binding(NamedTuple):
    """One line of the help.

    Attributes:
        action: What is asked for.
        keys: Any of these pygame keys asks for it.
        shown: The labels on the key caps; "<" and ">" stand for arrows.
        does: What it does, in a few words.
        with_shift: Only together with shift.
    """

    action: Action
    keys: tuple[int, ...]
    shown: tuple[str, ...]
    does: str
    with_shift: bool = False


BINDINGS = (
    Binding(
        Action.LEFT, (pygame.K_a, pygame.K_LEFT, pygame.K_LSHIFT), ("A", "<", "left Shift"), "left paddle"
    ),
    Binding(
        Action.RIGHT, (pygame.K_d, pygame.K_RIGHT, pygame.K_RSHIFT), ("D", ">", "right Shift"), "right paddle"
    ),
    Binding(Action.CREATE, (pygame.K_SPACE,), ("Space",), "new ball"),
    Binding(Action.JITTER, (pygame.K_z,), ("Z",), "shove the balls"),
    Binding(Action.PAUSE, (pygame.K_p,), ("P",), "pause"),
    Binding(Action.SAME_BOARD, (pygame.K_r,), ("Shift", "R"), "same board again", with_shift=True),
    Binding(Action.NEW_BOARD, (pygame.K_r,), ("R",), "new board"),
    Binding(Action.MUTE, (pygame.K_m,), ("M",), "mute (sounds come later)"),
    Binding(Action.HELP, (pygame.K_F1,), ("F1",), "these keys"),
    Binding(Action.FRAME_RATE, (pygame.K_F3,), ("F3",), "frames per second"),
    Binding(Action.FULL_SCREEN, (pygame.K_F11,), ("F11",), "full screen"),
    Binding(Action.QUIT, (pygame.K_ESCAPE,), ("Esc",), "go back, or end"),
)
"""All keys, in the order of the help. Where a key stands twice, the first line that fits is meant."""

_LAST_ASCII = 127
_COMMANDS = pygame.KMOD_CTRL | pygame.KMOD_ALT | pygame.KMOD_META


def meant(key: int, scancode: int) -> int:
    """The key to go by: itself, or the letter at its place on a Latin keyboard if it bears none itself.

    Args:
        key: What is printed on it, as pygame's number.
        scancode: Where it lies, as SDL's number; its letters run from A to Z without a gap.
    """
    if is_latin(key) or not pygame.KSCAN_A <= scancode <= pygame.KSCAN_Z:
        return key
    return pygame.K_a + scancode - pygame.KSCAN_A


def is_latin(key: int) -> bool:
    """Whether a key bears a character that Latin keyboards have, or none at all as Shift and F1."""
    return key <= _LAST_ASCII or key > sys.maxunicode or unicodedata.name(chr(key), "").startswith("LATIN")


def action_of(key: int, modifiers: int = 0) -> Action | None:
    """What a key asks for; None if nothing, or if it is a shortcut of the desktop (Ctrl, Alt, Meta)."""
    if modifiers & _COMMANDS and key not in _PADDLE_KEYS:
        return None
    for binding in BINDINGS:
        if key in binding.keys and (not binding.with_shift or modifiers & pygame.KMOD_SHIFT):
            return binding.action
    return None


def says_something(key: int) -> bool:
    """Whether an unused key deserves an answer: a letter or a digit does, Caps Lock does not."""
    return pygame.K_SPACE <= key <= sys.maxunicode and key != pygame.K_DELETE


class Held(NamedTuple):
    """The paddle buttons over the ticks of one frame: left and right.

    Attributes:
        first: In the first tick, in which also counts what was tapped since the last frame.
        rest: In all later ticks.
    """

    first: tuple[bool, bool]
    rest: tuple[bool, bool]


class Buttons:
    """The paddle keys that are down, and those that were down since the last tick, however briefly."""

    def __init__(self) -> None:
        self._down: set[int] = set()
        self._tapped: set[Action] = set()

    def press(self, key: int) -> None:
        """A key went down."""
        for action, keys in _PADDLES.items():
            if key in keys:
                self._down.add(key)
                self._tapped.add(action)

    def release(self, key: int) -> None:
        """A key came up."""
        self._down.discard(key)

    def release_all(self) -> None:
        """The window no longer hears the keys."""
        self._down.clear()
        self._tapped.clear()

    def forget_taps(self) -> None:
        """No play is going on: only what is held when it goes on will count."""
        self._tapped.clear()

    def take(self) -> Held:
        """What is held now; taps count once."""
        held = Held(
            (self._counts(Action.LEFT, True), self._counts(Action.RIGHT, True)),
            (self._counts(Action.LEFT, False), self._counts(Action.RIGHT, False)),
        )
        self._tapped.clear()
        return held

    def _counts(self, action: Action, with_taps: bool) -> bool:
        return not self._down.isdisjoint(_PADDLES[action]) or (with_taps and action in self._tapped)


_PADDLES: dict[Action, frozenset[int]] = {
    binding.action: frozenset(binding.keys)
    for binding in BINDINGS
    if binding.action in (Action.LEFT, Action.RIGHT)
}
_PADDLE_KEYS = frozenset().union(*_PADDLES.values())
