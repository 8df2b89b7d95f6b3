"""The player's actions, the current key bindings, and which paddle buttons are held.

All actions and their default keys are in `bindings.py`; the settings hold the player's changes; `keyboard.py`
resolves key names on the current layout.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple

import pygame

from silverball.app.bindings import ACTIONS, ActionBinding, action_by_key, action_by_name, keys_for
from silverball.app.menus import Button
from silverball.app.settings import Settings


class Action(StrEnum):
    """The actions of keys and gamepad buttons."""

    LEFT = "left"
    RIGHT = "right"
    CREATE = "create"
    JITTER = "jitter"
    NUDGE_RIGHT = "nudge_right"
    NUDGE_UP = "nudge_up"
    LAUNCH = "launch"
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
HELD = (*PADDLES, Action.LAUNCH)
"""The actions whose buttons are held in play; all others act when they are pressed."""
NUDGES = {Action.JITTER: "left", Action.NUDGE_RIGHT: "right", Action.NUDGE_UP: "up"}
"""Where an action nudges the table; on a table without nudge each of them is the jitter."""
MENU_BUTTONS = {
    Action.LEFT: Button.LEFT,
    Action.RIGHT: Button.RIGHT,
    Action.CREATE: Button.START,
    Action.LAUNCH: Button.START,
    Action.BACK: Button.BACK,
    Action.PAUSE: Button.BACK,
}
"""The menu button of an action while a menu is open."""
MENU_KEYS = {"up": Button.LEFT, "down": Button.RIGHT, "return": Button.START, "enter": Button.START}
"""Further keys for the menus, where the key has no other action than a nudge."""

_SHORTCUT_MODIFIERS = pygame.KMOD_CTRL | pygame.KMOD_ALT | pygame.KMOD_META


class Controls:
    """The current bindings of keys and buttons."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._action_by_key = action_by_key(settings) | {"escape": "back"}
        self._action_by_button: dict[str, dict[str, str]] = {}  # by kind of device
        self.labels: Mapping[str, str] = {}  # of keys on the current layout, by name

    def key_labels(self, action: Action) -> tuple[str, ...]:
        """Return the labels of the keys of an action on the current layout."""
        return tuple(self.labels.get(name, name) for name in self.keys(action))

    def keys(self, action: Action) -> tuple[str, ...]:
        """Return the names of the keys of an action."""
        return keys_for(self._settings, _BINDINGS[action])

    @property
    def key_names(self) -> frozenset[str]:
        """The names of all bound keys."""
        return frozenset(self._action_by_key)

    def action_of_key(self, name: str, modifiers: int = 0) -> Action | None:
        """Return the action of a key; None without one, and for desktop shortcuts (Ctrl, Alt, Meta)."""
        action = self._action_by_key.get(name)
        if action is None or (modifiers & _SHORTCUT_MODIFIERS and action not in PADDLES):
            return None
        return Action(action)

    def action_of_button(self, name: str, kind: str = "pad") -> Action | None:
        """Return the action of a button; the kind is "pad" or the GUID of a joystick."""
        if kind not in self._action_by_button:
            self._action_by_button[kind] = action_by_name(self._settings, kind)
        action = self._action_by_button[kind].get(name)
        return None if action is None else Action(action)


def is_shortcut(modifiers: int) -> bool:
    """Return whether the modifiers make a key a shortcut of the desktop."""
    return bool(modifiers & _SHORTCUT_MODIFIERS)


def is_printable(key: int) -> bool:
    """Return whether a key types a character, like a letter or a digit, unlike Caps Lock."""
    return pygame.K_SPACE < key <= sys.maxunicode and key != pygame.K_DELETE


class PaddleInput(NamedTuple):
    """The held buttons over the ticks of one input poll.

    Attributes:
        first: Paddle buttons (left, right) held in the first tick, including taps since the last poll.
        rest: Paddle buttons held in all later ticks.
        launch: Whether the launch button is held in the first tick, and in all later ones.
    """

    first: tuple[bool, bool]
    rest: tuple[bool, bool]
    launch: tuple[bool, bool] = (False, False)

    @property
    def later(self) -> PaddleInput:
        """The buttons after the first tick."""
        return PaddleInput(self.rest, self.rest, (self.launch[1], self.launch[1]))


class PaddleButtons:
    """The buttons of `HELD` that are down, and those tapped since the last tick, however briefly.

    A button is identified by its source, for example "key a" or "pad 0 leftshoulder": two keys may hold one
    paddle.
    """

    def __init__(self) -> None:
        self._down: dict[str, Action] = {}
        self._tapped: set[Action] = set()

    def press(self, source: str, side: Action) -> None:
        """Handle a button that went down."""
        self._down[source] = side
        self._tapped.add(side)

    def release(self, source: str) -> None:
        """Handle a button that came up."""
        self._down.pop(source, None)

    def release_all(self) -> None:
        """Release all buttons, because the window has lost the focus."""
        self._down.clear()
        self._tapped.clear()

    def forget_taps(self) -> None:
        """Drop the taps, because no game is running."""
        self._tapped.clear()

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether the left and the right paddle button are held."""
        down = self._down.values()
        return Action.LEFT in down, Action.RIGHT in down

    def poll(self) -> PaddleInput:
        """Return what is held now, and consume the taps."""
        left, right = self.held
        first = (left or Action.LEFT in self._tapped, right or Action.RIGHT in self._tapped)
        is_launch_held = Action.LAUNCH in self._down.values()
        launch = (is_launch_held or Action.LAUNCH in self._tapped, is_launch_held)
        self._tapped.clear()
        return PaddleInput(first, (left, right), launch)


_BINDINGS: dict[str, ActionBinding] = {binding.action: binding for binding in ACTIONS}
