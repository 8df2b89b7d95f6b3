"""How is one thing chosen among several? One is shown, the paddles turn to the others, Space takes it.

An item either does something (`Item.choose`) or holds a value (`Item.value`). Space on a value lets the
paddles change it, Space again keeps it, and "back" brings the old one again.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import Any, NamedTuple

from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots


class Value(NamedTuple):
    """A setting that is changed by steps.

    Attributes:
        field: Its name in the settings.
        choices: Its values, the least first.
        shown: They as the player reads them.
        wraps: Whether the first follows the last.
        hints: What there is to say about each of them.
    """

    field: str
    choices: tuple[Any, ...]
    shown: tuple[str, ...]
    wraps: bool = True
    hints: tuple[str, ...] = ()

    def place(self, context: MenuContext) -> int:
        """Which value is set; the first one if it is none of them."""
        value = getattr(context.settings, self.field)
        return self.choices.index(value) if value in self.choices else 0

    def stepped(self, context: MenuContext, step: int) -> Command | None:
        """Set the next value (+1) or the one before (-1)."""
        last = len(self.choices) - 1
        index = self.place(context) + step
        index = index % (last + 1) if self.wraps else min(max(index, 0), last)
        return None if index == self.place(context) else context.change(**{self.field: self.choices[index]})


class Item(NamedTuple):
    """One thing to choose.

    Attributes:
        label: What stands in the middle.
        hint: What it is or does.
        choose: What Space does; it may open or leave pages.
        value: The setting that Space lets the paddles change.
        key: What tells it from others on a page to which items come while it is open.
        does: What Space does, in a word.
    """

    label: str
    hint: str = ""
    choose: Callable[[], Command | None] | None = None
    value: Value | None = None
    key: str = ""
    does: str = "CHOOSE"


class ChoicePage(Page):
    """A page of items.

    Args:
        name: What tells it from other pages.
        title: What stands above.
        items: What can be chosen now; asked anew whenever it is needed, since settings change.
        start: The item that is shown first.
        back: What "back" does instead of showing the page below.
        quiet: Whether the program may play by itself while this page, or one opened from it, is open.
    """

    def __init__(
        self,
        name: str,
        title: str | Callable[[], str],
        items: Callable[[], Sequence[Item]],
        start: int = 0,
        back: Callable[[], Command | None] | None = None,
        quiet: bool = True,
    ) -> None:
        self.name = name
        self.quiet = quiet
        self.index = start
        self._key: str | None = None  # of the item that is shown, None before any was
        self._title = title
        self._items = items
        self._back = back
        self._kept: Any = None  # the value before it was changed
        self._is_editing = False
        self._moved_at = -1.0
        self._direction = 0

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn, choose, or go back."""
        items = self._listed()
        if self._is_editing:
            value = items[self.index].value
            if value is not None:
                return self._edit(button, context, value)
        if button is Button.BACK:
            return self._leave(context)
        if button is Button.START:
            return self._choose(items[self.index], context)
        step = -1 if button is Button.LEFT else 1
        self.index = (self.index + step) % len(items)
        self._key = items[self.index].key
        self.shown_at, self._moved_at, self._direction = context.now, context.now, step
        return None

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """The title, the item, and what there is to say about it."""
        dots = Dots()
        items = self._listed()
        index = self.index
        item = items[index]
        since = seconds - self.shown_at
        heading = self._title if isinstance(self._title, str) else self._title()
        if self._is_editing and item.value is not None:
            _draw_value(dots, item, context, since)
            return dots
        page_layout.title(dots, heading, index, len(items), since)
        shift = page_layout.slide(seconds - self._moved_at, self._direction) if self._moved_at >= 0.0 else 0
        page_layout.middle(dots, item.label, since, shift)
        if len(items) > 1:
            page_layout.arrows(dots, seconds)
        page_layout.foot(dots, self._help(item, context), since)
        return dots

    def signature(self) -> Hashable:
        """Which item, and whether its value is being changed."""
        return self.index, self._is_editing

    def _help(self, item: Item, context: MenuContext) -> tuple[str, ...]:
        key = context.key("create")
        if item.value is None:
            return (item.hint, "" if item.choose is None else f"{key}: {item.does}   ◄ ►: NEXT")
        return f"IS {item.value.shown[item.value.place(context)]} – {key}: CHANGE", item.hint

    def _listed(self) -> Sequence[Item]:
        """The items; the one that was shown stays shown where others have come or gone before it."""
        items = self._items()
        self.index = min(self.index, len(items) - 1)
        if self._key != items[self.index].key:
            keys = [item.key for item in items]
            self.index = keys.index(self._key) if self._key is not None and self._key in keys else self.index
        self._key = items[self.index].key
        return items

    def _choose(self, item: Item, context: MenuContext) -> Command | None:
        if item.value is not None:
            self._is_editing = True
            self._kept = getattr(context.settings, item.value.field)
            self.shown_at = context.now
            return None
        return item.choose() if item.choose is not None else None

    def _edit(self, button: Button, context: MenuContext, value: Value) -> Command | None:
        self.shown_at = context.now
        if button is Button.START:
            self._is_editing = False
            return None
        if button is Button.BACK:
            self._is_editing = False
            return context.change(**{value.field: self._kept})
        return value.stepped(context, -1 if button is Button.LEFT else 1)

    def _leave(self, context: MenuContext) -> Command | None:
        if self._back is not None:
            return self._back()
        context.back()
        return None


def _draw_value(dots: Dots, item: Item, context: MenuContext, since: float) -> None:
    value = item.value
    assert value is not None
    index = value.place(context)
    page_layout.title(dots, item.label, seconds=since)
    page_layout.middle(dots, value.shown[index], since)
    page_layout.arrows(dots, since, strong=True)
    if value.wraps:
        page_layout.foot(
            dots,
            (value.hints[index] if value.hints else "", f"◄ ►: CHANGE   {context.key('create')}: KEEP"),
            since,
        )
    else:
        # A scale shows how far it is set.
        last = len(value.choices) - 1
        page_layout.meter(
            dots, page_layout.MARGIN, page_layout.FOOT_Y, WIDTH - 2 * page_layout.MARGIN, index / max(last, 1)
        )
