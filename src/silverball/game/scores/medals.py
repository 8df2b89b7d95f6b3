"""Medals: what a score is worth on a table that states how many points a medal takes.

Nothing is stored: a medal follows from the table and a score, and a score is proven by its replay.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from silverball.table import Table


class Medal(StrEnum):
    """The medals, in the order of their worth."""

    BRONZE = "bronze"
    SILVER = "silver"
    GOLD = "gold"


def medal_points(table: Table) -> dict[Medal, int]:
    """The points that each medal takes on a table; empty if it has none.

    Examples:
        >>> import silverball as sb
        >>> medal_points(sb.load_table("classic"))
        {}
    """
    points = {medal: int(getattr(table.arcade, medal)) for medal in Medal}
    return points if all(points.values()) else {}


def medal_of(table: Table, score: int) -> Medal | None:
    """The best medal that a score earns; None if it earns none."""
    return max(
        (medal for medal, points in medal_points(table).items() if score >= points),
        key=list(Medal).index,
        default=None,
    )


def next_medal(table: Table, score: int) -> tuple[Medal, int] | None:
    """The next medal and the points that it takes; None if there is none to win."""
    return next(((medal, points) for medal, points in medal_points(table).items() if score < points), None)
