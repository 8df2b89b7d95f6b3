"""Which key or gamepad button asks for what, and which paddles are held?

The table of all actions, with the keys they have at first, is `menus/actions.py`; the settings hold what a
player has changed. Which key a name means on the layout in use is told by `keyboard.py`.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple

import pygame

from silverball.app.menus import ACTIONS, ActionBinding, Button, action_by_key, action_by_name, keys_for
from silverball.app.settings import Settings


class Action(StrEnum):
    """What a key or a gamepad button can ask for."""

    LEFT = "left"
    RIGHT = "right"
    CREATE = "create"
    JITTER = "jitter"
    PAUSE = "pause"
    NEW_BOARD = "new_board"
    MUTE = "mute"
    HELP = "help"
    DEBUG = "debug"
    FULL_SCREEN = "full_screen"
    SLOWER = "slower"
    FASTER = "faster"
    SINGLE_TICK = "single_tick"
    BACK = "back"


PADDLES = (Action.LEFT, Action.RIGHT)
MENU_BUTTONS = {
    Action.LEFT: Button.LEFT,
    Action.RIGHT: Button.RIGHT,
    Action.CREATE: Button.START,
    Action.BACK: Button.BACK,
    Action.PAUSE: Button.BACK,
}
"""What the actions mean while a menu is open."""
MENU_KEYS = {"up": Button.LEFT, "down": Button.RIGHT, "return": Button.START, "enter": Button.START}
"""What else works a menu, for hands that are used to it, where the key has nothing else to do."""

_COMMANDS = pygame.KMOD_CTRL | pygame.KMOD_ALT | pygame.KMOD_META


class Controls:
    """The keys and buttons as a player has chosen them."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._of_key = action_by_key(settings) | {"escape": "back"}
        self._of_button: dict[str, dict[str, str]] = {}  # by the kind of device
        self.labels: Mapping[str, str] = {}  # of keys on the layout in use

    def shown_keys(self, action: Action) -> tuple[str, ...]:
        """What stands on the keys that ask for something, on the layout in use."""
        return tuple(self.labels.get(name, name) for name in self.keys(action))

    def keys(self, action: Action) -> tuple[str, ...]:
        """The names of the keys that ask for something."""
        return keys_for(self._settings, _LINES[action])

    @property
    def key_names(self) -> frozenset[str]:
        """The names of all keys that ask for something."""
        return frozenset(self._of_key)

    def of_key(self, name: str, modifiers: int = 0) -> Action | None:
        """What a key asks for; None if nothing, or if it is a shortcut of the desktop (Ctrl, Alt, Meta)."""
        action = self._of_key.get(name)
        if action is None or (modifiers & _COMMANDS and action not in PADDLES):
            return None
        return Action(action)

    def of_pad(self, name: str, kind: str = "pad") -> Action | None:
        """What a button asks for; the kind is "pad" or the GUID of a joystick."""
        if kind not in self._of_button:
            self._of_button[kind] = action_by_name(self._settings, kind)
        action = self._of_button[kind].get(name)
        return None if action is None else Action(action)


def is_command(modifiers: int) -> bool:
    """Whether a key is a shortcut of the desktop."""
    return bool(modifiers & _COMMANDS)


def says_something(key: int) -> bool:
    """Whether an unused key deserves an answer: a letter or a digit does, Caps Lock does not."""
    return pygame.K_SPACE < key <= sys.maxunicode and key != pygame.K_DELETE


class Held(NamedTuple):
    """The paddle buttons over the ticks of one beat: left and right.

    Attributes:
        first: In the first tick, in which also counts what was tapped since the last beat.
        rest: In all later ticks.
    """

    first: tuple[bool, bool]
    rest: tuple[bool, bool]


class PaddleButtons:
    """The paddle buttons that are down, and those that were down since the last tick, however briefly.

    A button is told by its source, for example "key a" or "pad 0 leftshoulder": two keys may hold one paddle.
    """

    def __init__(self) -> None:
        self._down: dict[str, Action] = {}
        self._tapped: set[Action] = set()

    def press(self, source: str, side: Action) -> None:
        """A button for a paddle went down."""
        self._down[source] = side
        self._tapped.add(side)

    def release(self, source: str) -> None:
        """A button came up."""
        self._down.pop(source, None)

    def release_all(self) -> None:
        """The window no longer hears the buttons."""
        self._down.clear()
        self._tapped.clear()

    def forget_taps(self) -> None:
        """No play is going on: only what is held when it goes on will count."""
        self._tapped.clear()

    @property
    def held(self) -> tuple[bool, bool]:
        """Left and right, as they are held now."""
        down = self._down.values()
        return Action.LEFT in down, Action.RIGHT in down

    def take(self) -> Held:
        """What is held now; taps count once."""
        left, right = self.held
        first = (left or Action.LEFT in self._tapped, right or Action.RIGHT in self._tapped)
        self._tapped.clear()
        return Held(first, (left, right))


_LINES: dict[str, ActionBinding] = {line.action: line for line in ACTIONS}
