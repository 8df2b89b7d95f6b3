"""The points of hits before multipliers: those that the rules were told of, and those in lost events."""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.game.mechanisms import SCORING, points_by_part

if TYPE_CHECKING:
    from silverball.world import Event, World


class HitPoints:
    """Counts the points of the hits in a world that were passed to the rules.

    A log of events has room for some hits only, but the world counts all of them by part. So the points of
    hits without an event are what the world has counted beyond those passed on.

    Args:
        world: The world.

    Attributes:
        by_part: The points of each part that gives any, by its name in events.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self.by_part = points_by_part(world.table)
        self._passed = 0

    def catch_up(self) -> None:
        """Take all hits that the world has counted as passed on, as after a jump to another moment."""
        self._passed = self._counted()

    def pass_on(self, events: tuple[Event, ...], lost: int) -> None:
        """Take the hits among some events as passed on, and points without an event."""
        self._passed += lost + self._points_in(events)

    def lost(self, events: tuple[Event, ...]) -> int:
        """Points of the hits that did not fit into the log beside these events."""
        if not self._world.events_lost:
            return 0
        return max(self._counted() - self._passed - self._points_in(events), 0)

    def _points_in(self, events: tuple[Event, ...]) -> int:
        return sum(self.by_part.get(event.part, 0) for event in events if event.kind in SCORING)

    def _counted(self) -> int:
        return sum(self.by_part.get(part, 0) * count for part, count in self._world.hits.items())
