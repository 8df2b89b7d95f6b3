"""What is loaded of the physics, and the request of the player that waits for the rest.

Worlds have one of two layouts, and each has compiled code of its own (`physics/for_devices.py`). A game
starts at once if the code for its table is loaded; otherwise the window loads or compiles it in a thread
first.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from silverball.table import Table

ANY_LAYOUT = ""


class Request(NamedTuple):
    """Something that starts as soon as the code for a table is loaded.

    Attributes:
        table: The table.
        start: Starts it.
    """

    table: Table
    start: Callable[[], None]


class Loading:
    """The layouts that are loaded, and the request that waits.

    Attributes:
        waiting: The request that waits, if any.
    """

    def __init__(self) -> None:
        self.waiting: Request | None = None
        self._loaded: set[str] = set()

    @property
    def is_ready(self) -> bool:
        """Whether something is loaded, and nothing waits."""
        return bool(self._loaded) and self.waiting is None

    def has(self, table: Table) -> bool:
        """Whether the code for a table is loaded."""
        if not self._loaded or ANY_LAYOUT in self._loaded:
            return bool(self._loaded)
        return layout_of(table) in self._loaded

    def add(self, layout: str) -> Request | None:
        """Note that a layout is loaded; return the request that waited."""
        self._loaded.add(layout)
        request, self.waiting = self.waiting, None
        return request


def layout_of(table: Table) -> str:
    """The name of the layout of a world on a table, "full" or "plain"."""
    from silverball.world.compile import compile_tables
    from silverball.world.single_step import layout_name

    return layout_name(compile_tables([table]).layout)
