"""How does a player choose other keys, or other buttons of a gamepad or joystick?

An action is chosen, then the key is pressed. A button is chosen for the kind of device on which it was
pressed: for all gamepads, whose buttons have common names, or for joysticks of one make. A key that does
something already is not taken in silence: the page says whose it is and asks. The keys without which no menu
could be worked cannot be taken away.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Literal, TypeAlias

from silverball.app.bindings import RESERVED, ActionBinding, Kind, assigned, names_for, owner, with_bindings
from silverball.app.menus import page_layout
from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Button, Change, Command
from silverball.app.menus.context import JoystickEntry, MenuContext, Page
from silverball.drawing.dotmatrix.canvas import Dots

PATIENCE = 8.0  # [s] to press the key; who has no keyboard at hand comes back by waiting

Sort: TypeAlias = Literal["keys", "pad"]
"""What a page is about: keys, or the buttons of gamepads and joysticks."""

TITLES = {"keys": "KEYS", "pad": "GAMEPAD"}
THING = {"keys": "KEY", "pad": "BUTTON"}


def remap_page(context: MenuContext, kind: Sort) -> ChoicePage:
    """All actions with their keys, or with their buttons; then the joysticks are named too."""

    def reset() -> Change:
        context.say("AS THEY WERE AT FIRST")
        settings = context.settings
        for one in _kinds(context, kind):
            settings = with_bindings(settings, one, {})
        return context.use(settings)

    def action_item(line: ActionBinding) -> Item:
        return Item(
            line.label, _listed(context, line, kind), lambda: context.open(action_page(context, kind, line))
        )

    def joystick_item(joystick: JoystickEntry) -> Item:
        return Item(joystick.title.upper(), _size(joystick.buttons))

    def items() -> list[Item]:
        return [
            *(joystick_item(joystick) for joystick in context.joysticks if kind == "pad"),
            *(action_item(line) for line in context.actions if line.defaults(kind) or kind == "keys"),
            Item("RESET ALL", "AS THEY WERE AT FIRST", reset),
            Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back),
        ]

    return ChoicePage(kind, TITLES[kind], items)


def action_page(context: MenuContext, kind: Sort, line: ActionBinding) -> ChoicePage:
    """What can be done about the keys of one action."""

    def reset() -> Command | None:
        settings = context.settings
        for one in _kinds(context, kind):
            for name in line.defaults(one):
                other = owner(context.settings, context.actions, one, name)
                if other is not None and other.action != line.action and _is_last(context, other, one, name):
                    context.say(f"{other.label} NEEDS {context.shown(name)}")
                    return None
            settings = assigned(settings, context.actions, one, line.action, line.defaults(one))
        context.say("AS IT WAS AT FIRST")
        return context.use(settings)

    def items() -> list[Item]:
        hint = f"NOW {_listed(context, line, kind)}"
        return [
            Item(f"NEW {THING[kind]}", hint, lambda: context.open(CapturePage(kind, line, "new"))),
            Item("ONE MORE", hint, lambda: context.open(CapturePage(kind, line, "more"))),
            Item("RESET", f"TO {_names(context, line.defaults(kind)) or 'NONE'}", reset),
            Item("BACK", hint, context.back),
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

    def __init__(self, kind: Sort, line: ActionBinding, way: Literal["new", "more"]) -> None:
        self.kind = kind
        self._line = line
        self._way = way
        self._complaint = ""

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """A button that comes as a button is none that was asked for: go back."""
        context.back()
        return None

    def tick(self, context: MenuContext) -> Command | None:
        """Wait no longer than patience lasts."""
        if context.now - self.shown_at > PATIENCE:
            context.back()
        return None

    def capture(self, context: MenuContext, name: str, kind: Kind) -> Command | None:
        """The key was pressed, or the button, on a device of this kind."""
        self.shown_at = context.now
        if name in RESERVED.get(kind, ()):
            context.back()
            return None
        if not name:
            self._complaint = f"THAT {THING[self.kind]} HAS NO NAME"
            return None
        other = owner(context.settings, context.actions, kind, name)
        if other is None or other.action == self._line.action:
            context.back()
            return self._take(context, name, kind)
        if _is_last(context, other, kind, name):
            self._complaint = f"{context.shown(name)} IS THE ONLY {THING[self.kind]} OF {other.label}"
            return None
        context.back()
        context.open(self._conflict(context, name, kind, other))
        return None

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Which key is asked for, and how long still."""
        dots = Dots()
        page_layout.title(dots, self._line.label)
        if page_layout.blinks(seconds, 0.8):
            page_layout.middle(dots, f"PRESS A {THING[self.kind]}", seconds)
        if self._complaint:
            page_layout.foot(dots, (self._complaint,), seconds - self.shown_at, 255)
        else:
            page_layout.meter(dots, 30, page_layout.FOOT_Y, 100, 1.0 - (seconds - self.shown_at) / PATIENCE)
        return dots

    def signature(self) -> Hashable:
        """For what it waits."""
        return self.kind, self._line.action, self._way

    def _take(self, context: MenuContext, name: str, kind: Kind) -> Command:
        kept = names_for(context.settings, self._line, kind) if self._way == "more" else ()
        names = (*(one for one in kept if one != name), name)
        context.say(f"{self._line.label}: {_names(context, names)}")
        return context.use(assigned(context.settings, context.actions, kind, self._line.action, names))

    def _conflict(self, context: MenuContext, name: str, kind: Kind, other: ActionBinding) -> ChoicePage:
        def take() -> Command:
            context.back()
            return self._take(context, name, kind)

        def again() -> None:
            context.back()
            context.open(CapturePage(self.kind, self._line, self._way))

        says = f"{context.shown(name)} IS {other.label} NOW"
        items = [
            Item("TAKE IT", says, take),
            Item(f"OTHER {THING[self.kind]}", says, again),
            Item("LEAVE IT", says, context.back),
        ]
        title = f"{context.shown(name)} FOR {self._line.label}?"
        return ChoicePage("conflict", title, lambda: items)


def _size(buttons: int) -> str:
    return f"A JOYSTICK WITH {buttons} BUTTON{'' if buttons == 1 else 'S'}"


def _kinds(context: MenuContext, sort: Sort) -> tuple[Kind, ...]:
    """Whose names a page is about: those of keys, or of gamepads and the joysticks that are plugged in."""
    return ("keys",) if sort == "keys" else ("pad", *(joystick.guid for joystick in context.joysticks))


def _is_last(context: MenuContext, line: ActionBinding, kind: Kind, name: str) -> bool:
    """Whether the menus could not be worked if an action lost this key."""
    return line.needed and set(names_for(context.settings, line, kind)) <= {name}


def _names(context: MenuContext, names: tuple[str, ...]) -> str:
    return ", ".join(map(context.shown, names))


def _listed(context: MenuContext, line: ActionBinding, sort: Sort) -> str:
    listed = (_names(context, names_for(context.settings, line, kind)) for kind in _kinds(context, sort))
    return "; ".join(filter(None, listed)) or f"NO {THING[sort]}"
