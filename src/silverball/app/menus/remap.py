"""How does a player choose other keys, or other buttons of a gamepad or joystick?

An action is chosen, then the key is pressed. A button is chosen for the kind of device on which it was
pressed: for all gamepads, whose buttons have common names, or for joysticks of one make. A key that does
something already is not taken in silence: the page says whose it is and asks. The keys without which no menu
could be worked cannot be taken away.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Literal, TypeAlias

from silverball.app.bindings import RESERVED, ActionLine, Kind, assigned, names_of, owner, with_chosen
from silverball.app.menus import page as layout
from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Button, Change, Command
from silverball.app.menus.desk import Desk, JoystickEntry, Page
from silverball.drawing.dotmatrix.canvas import Dots

PATIENCE = 8.0  # [s] to press the key; who has no keyboard at hand comes back by waiting

Sort: TypeAlias = Literal["keys", "pad"]
"""What a page is about: keys, or the buttons of gamepads and joysticks."""

TITLES = {"keys": "KEYS", "pad": "GAMEPAD"}
THING = {"keys": "KEY", "pad": "BUTTON"}


def remap_page(desk: Desk, kind: Sort) -> ChoicePage:
    """All actions with their keys, or with their buttons; then the joysticks are named too."""

    def reset() -> Change:
        desk.say("AS THEY WERE AT FIRST")
        settings = desk.settings
        for one in _kinds(desk, kind):
            settings = with_chosen(settings, one, {})
        return desk.use(settings)

    def action_item(line: ActionLine) -> Item:
        return Item(line.label, _listed(desk, line, kind), lambda: desk.open(action_page(desk, kind, line)))

    def joystick_item(joystick: JoystickEntry) -> Item:
        return Item(joystick.title.upper(), _size(joystick.buttons))

    def items() -> list[Item]:
        return [
            *(joystick_item(joystick) for joystick in desk.joysticks if kind == "pad"),
            *(action_item(line) for line in desk.actions if line.defaults(kind) or kind == "keys"),
            Item("RESET ALL", "AS THEY WERE AT FIRST", reset),
            Item("BACK", "ALSO: HOLD BOTH PADDLES", desk.back),
        ]

    return ChoicePage(kind, TITLES[kind], items)


def action_page(desk: Desk, kind: Sort, line: ActionLine) -> ChoicePage:
    """What can be done about the keys of one action."""

    def reset() -> Command | None:
        settings = desk.settings
        for one in _kinds(desk, kind):
            for name in line.defaults(one):
                other = owner(desk.settings, desk.actions, one, name)
                if other is not None and other.action != line.action and _is_last(desk, other, one, name):
                    desk.say(f"{other.label} NEEDS {desk.shown(name)}")
                    return None
            settings = assigned(settings, desk.actions, one, line.action, line.defaults(one))
        desk.say("AS IT WAS AT FIRST")
        return desk.use(settings)

    def items() -> list[Item]:
        hint = f"NOW {_listed(desk, line, kind)}"
        return [
            Item(f"NEW {THING[kind]}", hint, lambda: desk.open(CapturePage(kind, line, "new"))),
            Item("ONE MORE", hint, lambda: desk.open(CapturePage(kind, line, "more"))),
            Item("RESET", f"TO {_names(desk, line.defaults(kind)) or 'NONE'}", reset),
            Item("BACK", hint, desk.back),
        ]

    return ChoicePage(f"{kind} of an action", line.label, items)


class CapturePage(Page):
    """A page that waits for the key itself.

    Args:
        kind: Whether a key or a button is wanted.
        line: The action that gets it.
        way: Whether it takes the place of those that are there ("new") or joins them ("more").
    """

    name = "capture"
    repeats = False

    def __init__(self, kind: Sort, line: ActionLine, way: Literal["new", "more"]) -> None:
        self.kind = kind
        self._line = line
        self._way = way
        self._complaint = ""

    def press(self, button: Button, desk: Desk) -> Command | None:
        """A button that comes as a button is none that was asked for: go back."""
        desk.back()
        return None

    def tick(self, desk: Desk) -> Command | None:
        """Wait no longer than patience lasts."""
        if desk.now - self.shown_at > PATIENCE:
            desk.back()
        return None

    def capture(self, desk: Desk, name: str, kind: Kind) -> Command | None:
        """The key was pressed, or the button, on a device of this kind."""
        self.shown_at = desk.now
        if name in RESERVED.get(kind, ()):
            desk.back()
            return None
        if not name:
            self._complaint = f"THAT {THING[self.kind]} HAS NO NAME"
            return None
        other = owner(desk.settings, desk.actions, kind, name)
        if other is None or other.action == self._line.action:
            desk.back()
            return self._take(desk, name, kind)
        if _is_last(desk, other, kind, name):
            self._complaint = f"{desk.shown(name)} IS THE ONLY {THING[self.kind]} OF {other.label}"
            return None
        desk.back()
        desk.open(self._conflict(desk, name, kind, other))
        return None

    def draw(self, desk: Desk, seconds: float, below: Dots) -> Dots:
        """Which key is asked for, and how long still."""
        dots = Dots()
        layout.title(dots, self._line.label)
        if layout.blinks(seconds, 0.8):
            layout.middle(dots, f"PRESS A {THING[self.kind]}", seconds)
        if self._complaint:
            layout.foot(dots, (self._complaint,), seconds - self.shown_at, 255)
        else:
            layout.meter(dots, 30, layout.FOOT_Y, 100, 1.0 - (seconds - self.shown_at) / PATIENCE)
        return dots

    def signature(self) -> Hashable:
        """For what it waits."""
        return self.kind, self._line.action, self._way

    def _take(self, desk: Desk, name: str, kind: Kind) -> Command:
        kept = names_of(desk.settings, self._line, kind) if self._way == "more" else ()
        names = (*(one for one in kept if one != name), name)
        desk.say(f"{self._line.label}: {_names(desk, names)}")
        return desk.use(assigned(desk.settings, desk.actions, kind, self._line.action, names))

    def _conflict(self, desk: Desk, name: str, kind: Kind, other: ActionLine) -> ChoicePage:
        def take() -> Command:
            desk.back()
            return self._take(desk, name, kind)

        def again() -> None:
            desk.back()
            desk.open(CapturePage(self.kind, self._line, self._way))

        says = f"{desk.shown(name)} IS {other.label} NOW"
        items = [
            Item("TAKE IT", says, take),
            Item(f"OTHER {THING[self.kind]}", says, again),
            Item("LEAVE IT", says, desk.back),
        ]
        title = f"{desk.shown(name)} FOR {self._line.label}?"
        return ChoicePage("conflict", title, lambda: items)


def _size(buttons: int) -> str:
    return f"A JOYSTICK WITH {buttons} BUTTON{'' if buttons == 1 else 'S'}"


def _kinds(desk: Desk, sort: Sort) -> tuple[Kind, ...]:
    """Whose names a page is about: those of keys, or of gamepads and the joysticks that are plugged in."""
    return ("keys",) if sort == "keys" else ("pad", *(joystick.guid for joystick in desk.joysticks))


def _is_last(desk: Desk, line: ActionLine, kind: Kind, name: str) -> bool:
    """Whether the menus could not be worked if an action lost this key."""
    return line.needed and set(names_of(desk.settings, line, kind)) <= {name}


def _names(desk: Desk, names: tuple[str, ...]) -> str:
    return ", ".join(map(desk.shown, names))


def _listed(desk: Desk, line: ActionLine, sort: Sort) -> str:
    listed = (_names(desk, names_of(desk.settings, line, kind)) for kind in _kinds(desk, sort))
    return "; ".join(filter(None, listed)) or f"NO {THING[sort]}"
