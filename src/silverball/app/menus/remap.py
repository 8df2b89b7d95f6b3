"""How does a player choose other keys, or other gamepad buttons?

An action is chosen, then the key is pressed. A key that does something already is not taken in silence: the
page says whose it is and asks. The keys without which no menu could be worked cannot be taken away.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Literal

from silverball.app.menus import layout
from silverball.app.menus.actions import RESERVED, ActionLine, Kind, assigned, names_of, owner, shown
from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Button, Change, Command
from silverball.app.menus.desk import Desk, Page
from silverball.drawing.dots import Dots

PATIENCE = 8.0  # [s] to press the key; who has no keyboard at hand comes back by waiting

TITLES = {"keys": "KEYS", "pad": "GAMEPAD"}
THING = {"keys": "KEY", "pad": "BUTTON"}


def remap_page(desk: Desk, kind: Kind) -> ChoicePage:
    """All actions with their keys, or with their gamepad buttons."""

    def reset() -> Change:
        desk.say("AS THEY WERE AT FIRST")
        return desk.change(**{kind: {}})

    def action_item(line: ActionLine) -> Item:
        return Item(line.label, _listed(desk, line, kind), lambda: desk.open(action_page(desk, kind, line)))

    def items() -> list[Item]:
        return [
            *(action_item(line) for line in desk.actions if line.defaults(kind) or kind == "keys"),
            Item("RESET ALL", "AS THEY WERE AT FIRST", reset),
            Item("BACK", "ALSO: HOLD BOTH PADDLES", desk.back),
        ]

    return ChoicePage(kind, TITLES[kind], items)


def action_page(desk: Desk, kind: Kind, line: ActionLine) -> ChoicePage:
    """What can be done about the keys of one action."""

    def reset() -> Command | None:
        names = line.defaults(kind)
        others = [owner(desk.settings, desk.actions, kind, name) for name in names]
        for name, other in zip(names, others, strict=True):
            if other is not None and other.action != line.action and _is_last(desk, other, kind, name):
                desk.say(f"{other.label} NEEDS {shown(name)}")
                return None
        desk.say("AS IT WAS AT FIRST")
        return desk.use(assigned(desk.settings, desk.actions, kind, line.action, names))

    def items() -> list[Item]:
        hint = f"NOW {_listed(desk, line, kind)}"
        return [
            Item(f"NEW {THING[kind]}", hint, lambda: desk.open(CapturePage(kind, line, "new"))),
            Item("ONE MORE", hint, lambda: desk.open(CapturePage(kind, line, "more"))),
            Item("RESET", f"TO {_names(line.defaults(kind)) or 'NONE'}", reset),
            Item("BACK", hint, desk.back),
        ]

    return ChoicePage(f"{kind} of an action", line.label, items)


class CapturePage(Page):
    """A page that waits for the key itself.

    Args:
        kind: Whether a key or a gamepad button is wanted.
        line: The action that gets it.
        way: Whether it takes the place of those that are there ("new") or joins them ("more").
    """

    name = "capture"
    repeats = False

    def __init__(self, kind: Kind, line: ActionLine, way: Literal["new", "more"]) -> None:
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

    def capture(self, desk: Desk, name: str) -> Command | None:
        """The key was pressed."""
        self.shown_at = desk.now
        if name in RESERVED[self.kind]:
            desk.back()
            return None
        if not name:
            self._complaint = f"THAT {THING[self.kind]} HAS NO NAME"
            return None
        other = owner(desk.settings, desk.actions, self.kind, name)
        if other is None or other.action == self._line.action:
            desk.back()
            return self._take(desk, name)
        if _is_last(desk, other, self.kind, name):
            self._complaint = f"{shown(name)} IS THE ONLY {THING[self.kind]} OF {other.label}"
            return None
        desk.back()
        desk.open(self._conflict(desk, name, other))
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

    def _take(self, desk: Desk, name: str) -> Command:
        kept = names_of(desk.settings, self._line, self.kind) if self._way == "more" else ()
        names = (*(one for one in kept if one != name), name)
        desk.say(f"{self._line.label}: {_names(names)}")
        return desk.use(assigned(desk.settings, desk.actions, self.kind, self._line.action, names))

    def _conflict(self, desk: Desk, name: str, other: ActionLine) -> ChoicePage:
        def take() -> Command:
            desk.back()
            return self._take(desk, name)

        def again() -> None:
            desk.back()
            desk.open(CapturePage(self.kind, self._line, self._way))

        says = f"{shown(name)} IS {other.label} NOW"
        items = [
            Item("TAKE IT", says, take),
            Item(f"OTHER {THING[self.kind]}", says, again),
            Item("LEAVE IT", says, desk.back),
        ]
        return ChoicePage("conflict", f"{shown(name)} FOR {self._line.label}?", lambda: items)


def _is_last(desk: Desk, line: ActionLine, kind: Kind, name: str) -> bool:
    """Whether the menus could not be worked if an action lost this key."""
    return line.needed and set(names_of(desk.settings, line, kind)) <= {name}


def _names(names: tuple[str, ...]) -> str:
    return ", ".join(shown(name) for name in names)


def _listed(desk: Desk, line: ActionLine, kind: Kind) -> str:
    return _names(names_of(desk.settings, line, kind)) or f"NO {THING[kind]}"
