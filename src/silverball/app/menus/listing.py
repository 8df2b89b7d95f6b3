"""A menu page as data: a title, rows to choose from, and help. Where there is room it is shown as a list.

A page returns a `Listing` of its present state. `list_view.py` of the backglass draws it and finds the row
under the mouse; `Menus` takes clicks beside the buttons. Pages without one (the attract mode, the transport
line) are shown as dots only.
"""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """A row of a list, or a cell of a grid.

    Attributes:
        label: What it is called.
        detail: Its value, or a few words about it; written at the right.
        can_choose: Whether a click does something.
        is_value: Whether it is a setting: it is changed by steps in both directions.
        is_marked: Whether it is set off from the others, such as the table chosen now.
    """

    label: str
    detail: str = ""
    can_choose: bool = True
    is_value: bool = False
    is_marked: bool = False


class Listing(NamedTuple):
    """A page as data.

    Attributes:
        title: Above the rows.
        rows: What can be chosen, or only read.
        chosen: The row that Space chooses; −1: none.
        hint: A sentence about that row.
        text: Large text between title and rows, such as the initials so far.
        columns: Cells beside each other; 1 for a list.
        is_editing: Whether the paddles change the value of the row.
    """

    title: str
    rows: tuple[Row, ...]
    chosen: int = -1
    hint: str = ""
    text: str = ""
    columns: int = 1
    is_editing: bool = False
