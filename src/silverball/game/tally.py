"""What made the points of a game: their sum for each cause, from the events that the game reports.

A cause is the mode that ran (a mission, a multiball), or else the part that was hit; points that the rules
give as a ball is lost are its bonus.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from silverball.game.view import GameEvent, GameEventKind
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.table import Table

BONUS, OTHER = "bonus", "rules"
TOGETHER = frozenset(
    ("paddle", "cylinder", "triangular_prism", "slant_wall", "wall", "post", "slingshot", "drop_target")
)
"""Kinds whose parts are counted together; others, such as lanes and spinners, have names of their own."""


class Cause(NamedTuple):
    """Something that has made points.

    Attributes:
        name: The name of the mode or the part, the kind of parts without names, "bonus" or "rules".
        points: Points so far.
    """

    name: str
    points: int


class Tally:
    """The points of every player by their causes.

    Args:
        table: The table that is played.
        players: How many players take turns.

    Examples:
        >>> import silverball as sb
        >>> tally = Tally(sb.load_table("classic"))
        >>> tally.add([sb.GameEvent(sb.GameEventKind.SCORED, 10, 100, "cylinder[0]")])
        >>> tally.causes()
        [Cause(name='cylinders', points=100)]
    """

    def __init__(self, table: Table, players: int = 1) -> None:
        self._labels = part_labels(table)
        self._unshown = {mode.name for mode in table.mode if not mode.is_shown}
        self._points: list[dict[str, int]] = [{} for _ in range(players)]
        self._up = 0
        self._modes: list[str] = []  # that run, in the order in which they have started
        self._lost_at = -1  # the tick in which a ball was lost last
        self._bonus = 0  # that has not been taken

    def add(self, events: Iterable[GameEvent]) -> None:
        """Add events, each once and in their order."""
        for event in events:
            kind = event.kind
            if kind is GameEventKind.SCORED:
                self._add_points(event)
            elif kind is GameEventKind.MODE_STARTED and event.part not in self._unshown:
                self._modes = [*(name for name in self._modes if name != event.part), event.part]
            elif kind is GameEventKind.MODE_ENDED:
                self._modes = [name for name in self._modes if name != event.part]
            elif kind is GameEventKind.BALL_LOST:
                self._lost_at = event.tick
            elif kind is GameEventKind.PLAYER_UP:
                self._up, self._modes = event.value - 1, []

    def take_bonus(self) -> int:
        """The bonus of balls that were lost since the last call."""
        bonus, self._bonus = self._bonus, 0
        return bonus

    def causes(self, player: int = 1) -> list[Cause]:
        """What has made the points of a player (from 1), the most first."""
        found = [Cause(name, points) for name, points in self._points[player - 1].items()]
        return sorted(found, key=lambda cause: -cause.points)

    def _add_points(self, event: GameEvent) -> None:
        if event.tick == self._lost_at:
            name = BONUS
            self._bonus += event.value
        elif self._modes:
            name = plain(self._modes[-1])
        else:
            name = self._labels.get(event.part, OTHER)
        points = self._points[self._up]
        points[name] = points.get(name, 0) + event.value


def part_labels(table: Table) -> dict[str, str]:
    """What people call each part, by its name in events: its name in the file, or its kind in the plural."""
    labels = {}
    for path, in_events, part in table.parts():
        kind, name = path.partition("[")[0], getattr(part, "name", None)
        is_alone = bool(name) and kind not in TOGETHER
        labels[in_events] = plain(str(name)) if is_alone else f"{kind.replace('_', ' ')}s"
    return labels
