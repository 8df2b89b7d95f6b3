"""How the picture stands on the screen of a cabinet: upright, or turned because the screen lies on its side.

In a cabinet the backglass has a screen of its own, if there is a second one.
"""

from __future__ import annotations

from enum import StrEnum

Size = tuple[int, int]


class CabinetMode(StrEnum):
    """Whether the game runs in a cabinet, and to which side of its screen the top of the table points."""

    OFF = "off"
    UPRIGHT = "upright"
    LEFT = "left"
    RIGHT = "right"

    @property
    def is_turned(self) -> bool:
        """Whether the picture is turned by a quarter."""
        return self in (CabinetMode.LEFT, CabinetMode.RIGHT)

    def turned(self, size: Size) -> Size:
        """Return the size of the upright picture for that of the window, and the other way round."""
        return (size[1], size[0]) if self.is_turned else size

    def to_upright(self, position: Size, window_size: Size) -> Size:
        """Return where a position in the window is in the upright picture [pixel]."""
        (x, y), (width, height) = position, window_size
        if self is CabinetMode.LEFT:
            return height - 1 - y, x
        return (y, width - 1 - x) if self is CabinetMode.RIGHT else position
