"""Which actions have keys and buttons of gamepads and joysticks, and which ones are they now?

Keys go by the names of `keyboard.py`, gamepad buttons by those of SDL, joystick buttons by those of
`gamepad.py`. The settings hold only what differs from the defaults here; an empty tuple there means that the
player took the last key away.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from silverball.app.settings import Settings

Kind: TypeAlias = str
"""Whose names are meant: "keys", "pad" (all gamepads), or the GUID of a joystick."""

RESERVED: dict[Kind, tuple[str, ...]] = {"keys": ("escape",), "pad": ("guide",)}
"""What cannot be chosen: Esc always goes back, and the guide button belongs to the system."""


class ActionBinding(NamedTuple):
    """One action.

    Attributes:
        action: Its name in the settings.
        label: What the player reads.
        keys: Its keys if nothing else was chosen.
        pad: Its gamepad buttons if nothing else was chosen.
        needed: Whether the menus could not be worked without it.
        joystick: Its buttons on a joystick if nothing else was chosen: those of most old pads and encoders.
    """

    action: str
    label: str
    keys: tuple[str, ...] = ()
    pad: tuple[str, ...] = ()
    needed: bool = False
    joystick: tuple[str, ...] = ()

    def defaults(self, kind: Kind) -> tuple[str, ...]:
        """Its keys or its buttons if nothing else was chosen."""
        return self.keys if kind == "keys" else self.pad if kind == "pad" else self.joystick


ACTIONS = (
    ActionBinding(
        "left",
        "LEFT PADDLE",
        ("a", "left", "left shift"),
        ("leftshoulder", "dpleft", "lefttrigger"),
        True,
        ("button 3", "button 5", "button 7", "hat 1 left", "axis 1 -"),
    ),
    ActionBinding(
        "right",
        "RIGHT PADDLE",
        ("d", "right", "right shift"),
        ("rightshoulder", "b", "righttrigger"),
        True,
        ("button 2", "button 6", "button 8", "hat 1 right", "axis 1 +"),
    ),
    ActionBinding("create", "NEW BALL", ("space",), ("a",), True, ("button 1",)),
    ActionBinding("jitter", "JITTER", ("z",), ("y", "x", "dpup"), joystick=("button 4", "hat 1 up")),
    ActionBinding("pause", "PAUSE", ("p",), ("start",), joystick=("button 10",)),
    ActionBinding("new_board", "NEW BOARD", ("r",)),
    ActionBinding("mute", "MUTE", ("m",)),
    ActionBinding("help", "HELP", ("f1",)),
    ActionBinding("debug", "DEBUG VIEW", ("f3",)),
    ActionBinding("full_screen", "FULL SCREEN", ("f11",)),
    ActionBinding("slower", "SLOWER", (",",)),
    ActionBinding("faster", "FASTER", (".",)),
    ActionBinding("single_tick", "SINGLE TICK", ("n",)),
    ActionBinding("back", "BACK", (), ("back",), joystick=("button 9",)),
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
    ";": "SEMICOLON",
    ":": "COLON",
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


def shown(name: str, labels: Mapping[str, str] = MappingProxyType({})) -> str:
    """A key or button as the display writes it.

    Args:
        name: Its name.
        labels: What stands on keys on the layout in use, where it is not their name.
    """
    label = labels.get(name, name)
    return _SHORT.get(label, capital(label))


def capital(label: str) -> str:
    """What stands on a key, in capitals; a letter whose capital would be two, as ß, stays as it is."""
    return label if len(label.upper()) > len(label) else label.upper()


def chosen(settings: Settings, kind: Kind) -> Mapping[str, tuple[str, ...]]:
    """What a player has chosen, by action."""
    if kind == "keys":
        return settings.keys
    return settings.pad if kind == "pad" else settings.joysticks.get(kind, {})


def with_bindings(settings: Settings, kind: Kind, names: Mapping[str, tuple[str, ...]]) -> Settings:
    """The settings with this choice instead; without any names, as it was at first."""
    if kind in ("keys", "pad"):
        return settings.changed(**{kind: dict(names)})
    others = {guid: its for guid, its in settings.joysticks.items() if guid != kind}
    return settings.changed(joysticks=others | ({kind: dict(names)} if names else {}))


def keys_for(settings: Settings, line: ActionBinding) -> tuple[str, ...]:
    """The keys of an action."""
    return names_for(settings, line, "keys")


def pad_buttons_for(settings: Settings, line: ActionBinding) -> tuple[str, ...]:
    """The gamepad buttons of an action."""
    return names_for(settings, line, "pad")


def names_for(settings: Settings, line: ActionBinding, kind: Kind) -> tuple[str, ...]:
    """The keys or the buttons of an action."""
    return chosen(settings, kind).get(line.action, line.defaults(kind))


def action_by_key(settings: Settings, actions: Sequence[ActionBinding] = ACTIONS) -> dict[str, str]:
    """What every key does: actions by names of keys."""
    return action_by_name(settings, "keys", actions)


def action_by_pad(settings: Settings, actions: Sequence[ActionBinding] = ACTIONS) -> dict[str, str]:
    """What every gamepad button does: actions by names of buttons."""
    return action_by_name(settings, "pad", actions)


def action_by_name(
    settings: Settings, kind: Kind, actions: Sequence[ActionBinding] = ACTIONS
) -> dict[str, str]:
    """What every key or button does: actions by their names."""
    by_name: dict[str, str] = {}
    mine = chosen(settings, kind)
    # What a player chose counts more than a default, whichever stands first.
    for line in sorted(actions, key=lambda line: line.action not in mine):
        for name in names_for(settings, line, kind):
            by_name.setdefault(name, line.action)
    return by_name


def owner(
    settings: Settings, actions: Sequence[ActionBinding], kind: Kind, name: str
) -> ActionBinding | None:
    """The action to which a key or button belongs; None if it is free."""
    found = action_by_name(settings, kind, actions)
    return next((line for line in actions if line.action == found.get(name)), None)


def assigned(
    settings: Settings, actions: Sequence[ActionBinding], kind: Kind, action: str, names: Sequence[str]
) -> Settings:
    """The settings in which an action has these keys or buttons, and no other action has any of them.

    Args:
        settings: As they are.
        actions: All actions.
        kind: Whose names are meant.
        action: The name of the action.
        names: What it gets.
    """
    differing: dict[str, tuple[str, ...]] = {}
    for line in actions:
        kept = names_for(settings, line, kind)
        mine = tuple(names) if line.action == action else tuple(n for n in kept if n not in names)
        if mine != line.defaults(kind):
            differing[line.action] = mine
    return with_bindings(settings, kind, differing)
