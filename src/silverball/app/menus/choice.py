"""Pages on which one item is chosen: the paddles turn through the items, and Space chooses.

An item either performs an action (`Item.choose`) or holds a setting (`Item.value`). Space on a setting makes
the paddles change it, Space again confirms the new value, and "back" restores the old one.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import Any, NamedTuple

from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page
from silverball.app.menus.listing import Listing, Row
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots


class Value(NamedTuple):
    """A setting that is changed in steps.

    Attributes:
        field: Its name in the settings.
        choices: Its values, in ascending order.
        labels: The displayed values.
        wraps: Whether the first value follows the last.
        hints: A hint for each value.
    """

    field: str
    choices: tuple[Any, ...]
    labels: tuple[str, ...]
    wraps: bool = True
    hints: tuple[str, ...] = ()

    def current_index(self, context: MenuContext) -> int:
        """Return the index of the current value; 0 if it is not among the choices."""
        value = getattr(context.settings.current, self.field)
        return self.choices.index(value) if value in self.choices else 0

    def step(self, context: MenuContext, step: int) -> None:
        """Set the next value (+1) or the previous one (-1)."""
        last = len(self.choices) - 1
        index = self.current_index(context) + step
        index = index % (last + 1) if self.wraps else min(max(index, 0), last)
        if index != self.current_index(context):
            context.settings.change(**{self.field: self.choices[index]})


class Item(NamedTuple):
    """An item of a page.

    Attributes:
        label: Text in the middle of the page.
        hint: A short description at the bottom.
        choose: Called by Space; it may open or close pages.
        value: The setting that Space makes editable.
        key: Identifier of the item, on a page whose items change while it is open.
        verb: Label of what Space does, in a word or two.
    """

    label: str
    hint: str = ""
    choose: Callable[[], Command | None] | None = None
    value: Value | None = None
    key: str = ""
    verb: str = "CHOOSE"


class ChoicePage(Page):
    """A page of items.

    Args:
        name: Identifies it.
        title: Shown above the items.
        items: Returns the current items; called on every use, since settings change.
        start: Index of the item shown first.
        back: Called by "back" instead of showing the page below.
        allows_attract: See `Page`.
    """

    def __init__(
        self,
        name: str,
        title: str | Callable[[], str],
        items: Callable[[], Sequence[Item]],
        start: int = 0,
        back: Callable[[], Command | None] | None = None,
        allows_attract: bool = True,
    ) -> None:
        self.name = name
        self.allows_attract = allows_attract
        self.index = start
        self._key: str | None = None  # of the visible item; None at first
        self._title = title
        self._items = items
        self._back = back
        self._old_value: Any = None  # of the setting that is being edited
        self._is_editing = False
        self._moved_at = -1.0
        self._direction = 0

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn to the next item, choose, or go back."""
        items = self._current_items()
        if self._is_editing:
            value = items[self.index].value
            if value is not None:
                return self._edit(button, context, value)
        if button is Button.BACK:
            return self._leave(context)
        if button is Button.START:
            return self._choose(items[self.index], context)
        step = -1 if button is Button.LEFT else 1
        self._select((self.index + step) % len(items), items, context)
        self._moved_at, self._direction = context.now, step
        return None

    def _select(self, index: int, items: Sequence[Item], context: MenuContext) -> None:
        self.index, self._key = index, items[index].key
        self.shown_at = context.now

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the title, the visible item, and its hint."""
        dots = Dots()
        items = self._current_items()
        index = self.index
        item = items[index]
        elapsed = seconds - self.shown_at
        heading = self._title if isinstance(self._title, str) else self._title()
        if self._is_editing and item.value is not None:
            _draw_value(dots, item, context, elapsed)
            return dots
        page_layout.title(dots, heading, index, len(items), elapsed)
        shift = page_layout.slide(seconds - self._moved_at, self._direction) if self._moved_at >= 0.0 else 0
        page_layout.middle(dots, item.label, elapsed, shift)
        if len(items) > 1:
            page_layout.arrows(dots, seconds)
        page_layout.foot(dots, self._help(item, context), elapsed)
        return dots

    def listing(self, context: MenuContext) -> Listing:
        """Return all items, settings with their values."""
        items = self._current_items()
        item = items[self.index]
        title = self._title if isinstance(self._title, str) else self._title()
        hint = ""  # the list shows it beside the label
        if item.value is not None:
            hints = item.value.hints
            hint = hints[item.value.current_index(context)] if hints else item.hint
        return Listing(
            title,
            tuple(_row(item, context) for item in items),
            self.index,
            hint,
            is_editing=self._is_editing,
        )

    def point(self, index: int, context: MenuContext) -> bool:
        """Select the item under the mouse pointer; return whether it is another one."""
        items = self._current_items()
        if not 0 <= index < len(items) or index == self.index:
            return False
        self._is_editing = False  # what the paddles have set so far stays
        self._select(index, items, context)
        return True

    def click(self, index: int, context: MenuContext, step: int) -> Command | None:
        """Choose an item, or change its setting by a step."""
        self.point(index, context)
        items = self._current_items()
        if index != self.index:
            return None
        item = items[index]
        if item.value is not None:
            item.value.step(context, step)
            return None
        return item.choose() if item.choose is not None else None

    def signature(self) -> Hashable:
        """Return which item is visible, and whether its value is being edited."""
        return self.index, self._is_editing

    def _help(self, item: Item, context: MenuContext) -> tuple[str, ...]:
        key = context.key_label("create")
        if item.value is None:
            return (item.hint, "" if item.choose is None else f"{key}: {item.verb}   ◄ ►: NEXT")
        return f"IS {item.value.labels[item.value.current_index(context)]} – {key}: CHANGE", item.hint

    def _current_items(self) -> Sequence[Item]:
        """Return the items; the visible one stays visible if items before it appear or disappear."""
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
            self._old_value = getattr(context.settings.current, item.value.field)
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
            context.settings.change(**{value.field: self._old_value})
        else:
            value.step(context, -1 if button is Button.LEFT else 1)
        return None

    def _leave(self, context: MenuContext) -> Command | None:
        if self._back is not None:
            return self._back()
        context.back()
        return None


def _row(item: Item, context: MenuContext) -> Row:
    if item.value is None:
        return Row(item.label, item.hint, item.choose is not None)
    return Row(item.label, item.value.labels[item.value.current_index(context)], is_value=True)


def _draw_value(dots: Dots, item: Item, context: MenuContext, elapsed: float) -> None:
    value = item.value
    assert value is not None
    index = value.current_index(context)
    page_layout.title(dots, item.label, seconds=elapsed)
    page_layout.middle(dots, value.labels[index], elapsed)
    page_layout.arrows(dots, elapsed, strong=True)
    if value.wraps:
        page_layout.foot(
            dots,
            (
                value.hints[index] if value.hints else "",
                f"◄ ►: CHANGE   {context.key_label('create')}: CONFIRM",
            ),
            elapsed,
        )
    else:
        # A meter shows the value on its scale.
        last = len(value.choices) - 1
        page_layout.meter(
            dots, page_layout.MARGIN, page_layout.FOOT_Y, WIDTH - 2 * page_layout.MARGIN, index / max(last, 1)
        )
