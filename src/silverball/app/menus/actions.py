"""Which actions have keys and gamepad buttons, and which ones are they now?

Keys go by the names of `pygame.key.name`, gamepad buttons by those of SDL. The settings hold only what
differs from the defaults here; an empty tuple there means that the player took the last key away.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple, TypeAlias

from silverball.app.settings import Settings

Kind: TypeAlias = Literal["keys", "pad"]

RESERVED = {"keys": ("escape",), "pad": ("guide",)}
"""What cannot be chosen: Esc always goes back, and the guide button belongs to the system."""


class ActionLine(NamedTuple):
    """One action.

    Attributes:
        action: Its name in the settings.
        label: What the player reads.
        keys: Its keys if nothing else was chosen.
        pad: Its gamepad buttons if nothing else was chosen.
        needed: Whether the menus could not be worked without it.
    """

    action: str
    label: str
    keys: tuple[str, ...] = ()
    pad: tuple[str, ...] = ()
    needed: bool = False

    def defaults(self, kind: Kind) -> tuple[str, ...]:
        """Its keys or its gamepad buttons if nothing else was chosen."""
        return self.keys if kind == "keys" else self.pad


ACTIONS = (
    ActionLine(
        "left", "LEFT PADDLE", ("a", "left", "left shift"), ("leftshoulder", "dpleft", "lefttrigger"), True
    ),
    ActionLine(
        "right", "RIGHT PADDLE", ("d", "right", "right shift"), ("rightshoulder", "b", "righttrigger"), True
    ),
    ActionLine("create", "NEW BALL", ("space",), ("a",), True),
    ActionLine("jitter", "JITTER", ("z",), ("y", "x", "dpup")),
    ActionLine("pause", "PAUSE", ("p",), ("start",)),
    ActionLine("new_board", "NEW BOARD", ("r",)),
    ActionLine("mute", "MUTE", ("m",)),
    ActionLine("help", "HELP", ("f1",)),
    ActionLine("debug", "DEBUG VIEW", ("f3",)),
    ActionLine("full_screen", "FULL SCREEN", ("f11",)),
    ActionLine("slower", "SLOWER", (",",)),
    ActionLine("faster", "FASTER", (".",)),
    ActionLine("single_tick", "SINGLE TICK", ("n",)),
    ActionLine("back", "BACK", (), ("back",)),
)
"""All actions that can be given other keys. Esc is always "back" and is not among them."""

_SHORT = {
    "left": "←",
    "right": "→",
    "up": "↑",
    "down": "↓",
    "left shift": "L SHIFT",
    "right shift": "R SHIFT",
    ",": "COMMA",
    ".": "PERIOD",
    "left ctrl": "L CTRL",
    "right ctrl": "R CTRL",
    "left alt": "L ALT",
    "right alt": "R ALT",
    "leftshoulder": "LB",
    "rightshoulder": "RB",
    "lefttrigger": "LT",
    "righttrigger": "RT",
    "leftstick": "L STICK",
    "rightstick": "R STICK",
    "dpleft": "PAD ←",
    "dpright": "PAD →",
    "dpup": "PAD ↑",
    "dpdown": "PAD ↓",
}


def shown(name: str) -> str:
    """A key or gamepad button as the display writes it."""
    return _SHORT.get(name, name.upper())


def keys_of(settings: Settings, line: ActionLine) -> tuple[str, ...]:
    """The keys of an action."""
    return settings.keys.get(line.action, line.keys)


def pad_of(settings: Settings, line: ActionLine) -> tuple[str, ...]:
    """The gamepad buttons of an action."""
    return settings.pad.get(line.action, line.pad)


def names_of(settings: Settings, line: ActionLine, kind: Kind) -> tuple[str, ...]:
    """The keys or the gamepad buttons of an action."""
    return keys_of(settings, line) if kind == "keys" else pad_of(settings, line)


def action_by_key(settings: Settings, actions: Sequence[ActionLine] = ACTIONS) -> dict[str, str]:
    """What every key does: actions by names of keys."""
    return _by_name(actions, settings.keys, lambda line: line.keys)


def action_by_pad(settings: Settings, actions: Sequence[ActionLine] = ACTIONS) -> dict[str, str]:
    """What every gamepad button does: actions by names of buttons."""
    return _by_name(actions, settings.pad, lambda line: line.pad)


def owner(settings: Settings, actions: Sequence[ActionLine], kind: Kind, name: str) -> ActionLine | None:
    """The action to which a key or gamepad button belongs; None if it is free."""
    found = action_by_key(settings, actions) if kind == "keys" else action_by_pad(settings, actions)
    return next((line for line in actions if line.action == found.get(name)), None)


def assigned(
    settings: Settings, actions: Sequence[ActionLine], kind: Kind, action: str, names: Sequence[str]
) -> Settings:
    """The settings in which an action has these keys or gamepad buttons, and no other action has any of them.

    Args:
        settings: As they are.
        actions: All actions.
        kind: Whether keys or gamepad buttons are meant.
        action: The name of the action.
        names: What it gets.
    """
    chosen: dict[str, tuple[str, ...]] = {}
    for line in actions:
        kept = names_of(settings, line, kind)
        mine = tuple(names) if line.action == action else tuple(n for n in kept if n not in names)
        if mine != line.defaults(kind):
            chosen[line.action] = mine
    return settings.changed(**{kind: chosen})


def _by_name(
    actions: Sequence[ActionLine],
    chosen: Mapping[str, tuple[str, ...]],
    defaults: Callable[[ActionLine], tuple[str, ...]],
) -> dict[str, str]:
    by_name: dict[str, str] = {}
    # What a player chose counts more than a default, whichever stands first.
    for line in actions:
        for name in chosen.get(line.action, ()):
            by_name.setdefault(name, line.action)
    for line in actions:
        if line.action not in chosen:
            for name in defaults(line):
                by_name.setdefault(name, line.action)
    return by_name
