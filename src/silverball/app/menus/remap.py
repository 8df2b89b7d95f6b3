"""Pages on which the player remaps keys, or buttons of gamepads and joysticks.

The player chooses an action and presses the key. A button is bound for the kind of device on which it was
pressed: for all gamepads, whose buttons have common names, or for all joysticks of one make. If a key is
already bound to another action, the page asks for confirmation. The last key of an action that the menus need
cannot be removed.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Literal, TypeAlias

from silverball.app.bindings import (
    RESERVED,
    ActionBinding,
    DeviceKind,
    find_owner,
    names_for,
    with_assignment,
    with_bindings,
)
from silverball.app.menus import page_layout
from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import JoystickEntry, MenuContext, Page
from silverball.app.menus.listing import Listing, Row
from silverball.drawing.dotmatrix.canvas import Dots

CAPTURE_TIMEOUT = 8.0  # [s] to press the key; afterwards the page goes back, also without a keyboard

PageKind: TypeAlias = Literal["keys", "pad"]
"""Whether a page is about keys, or about buttons of gamepads and joysticks."""

TITLES = {"keys": "KEYS", "pad": "GAMEPAD"}
INPUT_NOUN = {"keys": "KEY", "pad": "BUTTON"}


def remap_page(context: MenuContext, kind: PageKind) -> ChoicePage:
    """All actions with their keys, or with their buttons, and all connected joysticks."""

    def reset() -> None:
        context.show_message("DEFAULTS RESTORED")
        settings = context.settings.current
        for one in _kinds(context, kind):
            settings = with_bindings(settings, one, {})
        context.settings.replace(settings)

    def action_item(binding: ActionBinding) -> Item:
        return Item(
            binding.label,
            _binding_names(context, binding, kind),
            lambda: context.open(action_page(context, kind, binding)),
        )

    def joystick_item(joystick: JoystickEntry) -> Item:
        return Item(joystick.title.upper(), _joystick_hint(joystick.buttons))

    def items() -> list[Item]:
        return [
            *(joystick_item(joystick) for joystick in context.joysticks if kind == "pad"),
            *(
                action_item(binding)
                for binding in context.actions
                if binding.defaults(kind) or kind == "keys"
            ),
            Item("RESET ALL", "RESTORE ALL DEFAULTS", reset),
            Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back),
        ]

    return ChoicePage(kind, TITLES[kind], items)


def action_page(context: MenuContext, kind: PageKind, binding: ActionBinding) -> ChoicePage:
    """The keys or buttons of one action."""

    def reset() -> None:
        settings = context.settings.current
        for one in _kinds(context, kind):
            for name in binding.defaults(one):
                other = find_owner(context.settings.current, context.actions, one, name)
                if (
                    other is not None
                    and other.action != binding.action
                    and _is_last(context, other, one, name)
                ):
                    context.show_message(f"{other.label} NEEDS {context.button_label(name)}")
                    return
            settings = with_assignment(settings, context.actions, one, binding.action, binding.defaults(one))
        context.show_message("DEFAULT RESTORED")
        context.settings.replace(settings)

    def items() -> list[Item]:
        hint = f"NOW {_binding_names(context, binding, kind)}"
        return [
            Item(
                f"NEW {INPUT_NOUN[kind]}", hint, lambda: context.open(CapturePage(kind, binding, "replace"))
            ),
            Item("ONE MORE", hint, lambda: context.open(CapturePage(kind, binding, "add"))),
            Item("RESET", f"TO {_names(context, binding.defaults(kind)) or 'NONE'}", reset),
            Item("BACK", hint, context.back),
        ]

    return ChoicePage(f"{kind} of an action", binding.label, items)


class CapturePage(Page):
    """A page that waits for the key or button to bind.

    Args:
        kind: Whether to wait for a key or for a button.
        binding: The action to bind.
        change: Whether the key replaces the existing ones ("replace") or is added to them ("add").
    """

    name = "capture"
    repeats = False

    def __init__(self, kind: PageKind, binding: ActionBinding, change: Literal["replace", "add"]) -> None:
        self.kind = kind
        self._binding = binding
        self._change = change
        self._problem = ""

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Go back: buttons that can be captured do not reach this method."""
        context.back()
        return None

    def tick(self, context: MenuContext) -> Command | None:
        """Go back after a timeout."""
        if context.now - self.shown_at > CAPTURE_TIMEOUT:
            context.back()
        return None

    def capture(self, context: MenuContext, name: str, kind: DeviceKind) -> Command | None:
        """Bind the key or button that was pressed on a device of this kind."""
        self.shown_at = context.now
        if name in RESERVED.get(kind, ()):
            context.back()
            return None
        if not name:
            self._problem = f"THAT {INPUT_NOUN[self.kind]} HAS NO NAME"
            return None
        other = find_owner(context.settings.current, context.actions, kind, name)
        if other is None or other.action == self._binding.action:
            context.back()
            self._bind(context, name, kind)
            return None
        if _is_last(context, other, kind, name):
            self._problem = (
                f"{context.button_label(name)} IS THE ONLY {INPUT_NOUN[self.kind]} OF {other.label}"
            )
            return None
        context.back()
        context.open(self._conflict(context, name, kind, other))
        return None

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw which key is asked for, and the time left."""
        dots = Dots()
        page_layout.title(dots, self._binding.label)
        if page_layout.is_blink_on(seconds, 0.8):
            page_layout.middle(dots, f"PRESS A {INPUT_NOUN[self.kind]}", seconds)
        if self._problem:
            page_layout.foot(dots, (self._problem,), seconds - self.shown_at, 255)
        else:
            page_layout.meter(
                dots, 30, page_layout.FOOT_Y, 100, 1.0 - (seconds - self.shown_at) / CAPTURE_TIMEOUT
            )
        return dots

    def listing(self, context: MenuContext) -> Listing:
        """Return what is asked for."""
        asked = f"PRESS A {INPUT_NOUN[self.kind]}"
        return Listing(self._binding.label, (Row("CANCEL"),), hint=self._problem, text=asked)

    def click(self, index: int, context: MenuContext, step: int) -> Command | None:
        """Go back."""
        context.back()
        return None

    def signature(self) -> Hashable:
        """Return the kind, the action and the change that the page waits for."""
        return self.kind, self._binding.action, self._change

    def _bind(self, context: MenuContext, name: str, kind: DeviceKind) -> None:
        before = names_for(context.settings.current, self._binding, kind) if self._change == "add" else ()
        names = (*(one for one in before if one != name), name)
        context.show_message(f"{self._binding.label}: {_names(context, names)}")
        context.settings.replace(
            with_assignment(context.settings.current, context.actions, kind, self._binding.action, names)
        )

    def _conflict(
        self, context: MenuContext, name: str, kind: DeviceKind, other: ActionBinding
    ) -> ChoicePage:
        def take() -> None:
            context.back()
            self._bind(context, name, kind)

        def again() -> None:
            context.back()
            context.open(CapturePage(self.kind, self._binding, self._change))

        hint = f"{context.button_label(name)} IS {other.label} NOW"
        items = [
            Item("TAKE IT", hint, take),
            Item(f"OTHER {INPUT_NOUN[self.kind]}", hint, again),
            Item("LEAVE IT", hint, context.back),
        ]
        title = f"{context.button_label(name)} FOR {self._binding.label}?"
        return ChoicePage("conflict", title, lambda: items)


def _joystick_hint(buttons: int) -> str:
    return f"A JOYSTICK WITH {buttons} BUTTON{'' if buttons == 1 else 'S'}"


def _kinds(context: MenuContext, page_kind: PageKind) -> tuple[DeviceKind, ...]:
    """Return the kinds of devices of a page: the keyboard, or gamepads and all connected joysticks."""
    return ("keys",) if page_kind == "keys" else ("pad", *(joystick.guid for joystick in context.joysticks))


def _is_last(context: MenuContext, binding: ActionBinding, kind: DeviceKind, name: str) -> bool:
    """Return whether the menus need this key: it is the last one of a required action."""
    return binding.is_required and set(names_for(context.settings.current, binding, kind)) <= {name}


def _names(context: MenuContext, names: tuple[str, ...]) -> str:
    return ", ".join(map(context.button_label, names))


def _binding_names(context: MenuContext, binding: ActionBinding, page_kind: PageKind) -> str:
    listed = (
        _names(context, names_for(context.settings.current, binding, kind))
        for kind in _kinds(context, page_kind)
    )
    return "; ".join(filter(None, listed)) or f"NO {INPUT_NOUN[page_kind]}"
