"""Key and button bindings: all actions, their default keys and buttons, and the player's changes.

Keys have the names of `keyboard.py`, gamepad buttons those of SDL, joystick buttons those of `gamepad.py`.
The settings hold only what differs from the defaults here; an empty tuple means that the player removed the
last key.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from silverball.app.settings import Settings

DeviceKind: TypeAlias = str
"""The kind of device that a name belongs to: "keys", "pad" (all gamepads), or the GUID of a joystick."""

RESERVED: dict[DeviceKind, tuple[str, ...]] = {"keys": ("escape",), "pad": ("guide",)}
"""Names that cannot be bound: Esc always goes back, and the guide button belongs to the system."""


class ActionBinding(NamedTuple):
    """An action and its default bindings.

    Attributes:
        action: Name of the action in the settings.
        label: Its displayed name.
        keys: Its default keys.
        pad: Its default gamepad buttons.
        is_required: Whether the menus cannot be operated without it.
        joystick: Its default joystick buttons: those of most old pads and arcade encoders.
    """

    action: str
    label: str
    keys: tuple[str, ...] = ()
    pad: tuple[str, ...] = ()
    is_required: bool = False
    joystick: tuple[str, ...] = ()

    def defaults(self, kind: DeviceKind) -> tuple[str, ...]:
        """Return its default keys or buttons."""
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
    ActionBinding("jitter", "NUDGE LEFT", ("z",), ("y", "x", "stick left"), joystick=("button 4",)),
    ActionBinding("nudge_right", "NUDGE RIGHT", ("x",), ("stick right",)),
    ActionBinding("nudge_up", "NUDGE UP", ("up",), ("dpup", "stick up"), joystick=("hat 1 up",)),
    ActionBinding("launch", "LAUNCH BALL", ("return",), ("dpdown",), joystick=("button 11", "hat 1 down")),
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
"""All actions that can be remapped. Esc is always "back" and is not among them."""

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
    "stick left": "STICK ←",
    "stick right": "STICK →",
    "stick up": "STICK ↑",
    "stick down": "STICK ↓",
}


def display_name(name: str, labels: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return a key or button as the display writes it.

    Args:
        name: Its name.
        labels: Labels of keys on the current layout, by name, where they differ from the name.
    """
    label = labels.get(name, name)
    return _SHORT.get(label, upper_label(label))


def upper_label(label: str) -> str:
    """Return a key label in capitals; a letter whose capital has two characters, like ß, is unchanged."""
    return label if len(label.upper()) > len(label) else label.upper()


def custom_bindings(settings: Settings, kind: DeviceKind) -> Mapping[str, tuple[str, ...]]:
    """Return the player's own bindings, by action."""
    if kind == "keys":
        return settings.keys
    return settings.pad if kind == "pad" else settings.joysticks.get(kind, {})


def with_bindings(settings: Settings, kind: DeviceKind, names: Mapping[str, tuple[str, ...]]) -> Settings:
    """Return settings with these bindings for a kind of device; empty ones restore the defaults."""
    if kind in ("keys", "pad"):
        return settings.changed(**{kind: dict(names)})
    others = {guid: bound for guid, bound in settings.joysticks.items() if guid != kind}
    return settings.changed(joysticks=others | ({kind: dict(names)} if names else {}))


def keys_for(settings: Settings, binding: ActionBinding) -> tuple[str, ...]:
    """Return the keys of an action."""
    return names_for(settings, binding, "keys")


def pad_buttons_for(settings: Settings, binding: ActionBinding) -> tuple[str, ...]:
    """Return the gamepad buttons of an action."""
    return names_for(settings, binding, "pad")


def names_for(settings: Settings, binding: ActionBinding, kind: DeviceKind) -> tuple[str, ...]:
    """Return the keys or buttons of an action."""
    return custom_bindings(settings, kind).get(binding.action, binding.defaults(kind))


def action_by_key(settings: Settings, actions: Sequence[ActionBinding] = ACTIONS) -> dict[str, str]:
    """Return the action of every key, by key name."""
    return action_by_name(settings, "keys", actions)


def action_by_pad(settings: Settings, actions: Sequence[ActionBinding] = ACTIONS) -> dict[str, str]:
    """Return the action of every gamepad button, by button name."""
    return action_by_name(settings, "pad", actions)


def action_by_name(
    settings: Settings, kind: DeviceKind, actions: Sequence[ActionBinding] = ACTIONS
) -> dict[str, str]:
    """Return the action of every key or button, by name."""
    by_name: dict[str, str] = {}
    custom = custom_bindings(settings, kind)
    # The player's bindings take precedence over defaults of other actions.
    for binding in sorted(actions, key=lambda binding: binding.action not in custom):
        for name in names_for(settings, binding, kind):
            by_name.setdefault(name, binding.action)
    return by_name


def find_owner(
    settings: Settings, actions: Sequence[ActionBinding], kind: DeviceKind, name: str
) -> ActionBinding | None:
    """Return the action to which a key or button is bound; None if it is free."""
    found = action_by_name(settings, kind, actions)
    return next((binding for binding in actions if binding.action == found.get(name)), None)


def with_assignment(
    settings: Settings, actions: Sequence[ActionBinding], kind: DeviceKind, action: str, names: Sequence[str]
) -> Settings:
    """Return settings in which an action has these keys or buttons, and no other action has any of them.

    Args:
        settings: The current settings.
        actions: All actions.
        kind: The kind of device that the names belong to.
        action: The name of the action.
        names: Its new keys or buttons.
    """
    changes: dict[str, tuple[str, ...]] = {}
    for binding in actions:
        before = names_for(settings, binding, kind)
        after = tuple(names) if binding.action == action else tuple(n for n in before if n not in names)
        if after != binding.defaults(kind):
            changes[binding.action] = after
    return with_bindings(settings, kind, changes)
