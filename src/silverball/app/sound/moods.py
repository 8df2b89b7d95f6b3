"""The mood of the music, read from a game: it grows with a mission and lifts its key in a multiball.

It stops when the last ball drains and when the table tilts, and begins again with the next ball. Nothing here
knows a table: a mission is a mode with a time that a rule starts, and how far it has come is what its rules
count.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from silverball.app.sound.music import LIFT, MAX_LEVEL, Mood
from silverball.game.view import Phase

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.table import Table

WAITING, PLAYING, MISSION = 2, 3, 4
"""Levels of the music before a ball is in play, with one, and in a mission, which adds two more layers."""

LONG_COMBO = 6
"""Hits in a row for one layer more, twice as many for two."""

DRAIN_PAUSE = 1.6
"""Silence after a drain [s]: the ball's fall and the bonus are heard alone."""


class Goal(NamedTuple):
    """What a rule counts until a mission is won.

    Attributes:
        counter: The name of the counter; empty if it is the lamps of a group.
        value: The value that wins.
        lamps: The lamps that must be lit.
    """

    counter: str
    value: int
    lamps: tuple[str, ...]


class Mission(NamedTuple):
    """A mode that is played for a time.

    Attributes:
        seconds: How long it runs at first [s].
        goals: What its rules count.
    """

    seconds: float
    goals: tuple[Goal, ...]


class MoodReader:
    """Reads the mood of a game on a table, frame by frame."""

    def __init__(self, table: Table) -> None:
        self._missions = missions_of(table)
        self._was_in_play = False
        self._pause = 0.0  # [s] of silence to come

    def read(self, game: GameCore, seconds: float) -> Mood | None:
        """Return the mood after some more seconds; None: there is no music."""
        view = game.view
        in_play = view.phase is Phase.PLAY
        if self._was_in_play and not in_play:
            self._pause = DRAIN_PAUSE
        self._was_in_play = in_play
        self._pause = 0.0 if in_play else max(self._pause - seconds, 0.0)
        if view.phase is Phase.OVER or view.tilted or self._pause > 0.0:
            return None
        if not in_play:
            return Mood(WAITING)
        if view.on_board > 1:
            return Mood(MAX_LEVEL, LIFT)
        progress = self._progress(game)
        if progress is not None:
            return Mood(min(MISSION + int(3.0 * progress), MAX_LEVEL))
        return Mood(min(PLAYING + view.combo // LONG_COMBO, MAX_LEVEL - 1))

    def _progress(self, game: GameCore) -> float | None:
        """How far the furthest mission is, 0 to 1, by what is counted or by its time; None: none runs."""
        if not self._missions:
            return None
        running = {name: left for name, left in game.modes.items() if name in self._missions}
        if not running:
            return None
        counters, lamps = game.counters, game.lamps
        shares = [0.0]
        for name, left in running.items():
            mission = self._missions[name]
            shares.append(1.0 - (left or 0.0) / mission.seconds)
            for goal in mission.goals:
                reached = (
                    counters[goal.counter] if goal.counter else sum(lamps[one] != "off" for one in goal.lamps)
                )
                shares.append(reached / goal.value)
        return min(max(shares), 1.0)


def missions_of(table: Table) -> dict[str, Mission]:
    """Return the missions of a table by their names.

    A goal of a mission is a value of a counter, or a group of lamps, whose completion stops the mission.
    """
    groups: dict[str, list[str]] = {}
    for lamp in table.lamp:
        groups.setdefault(lamp.group or lamp.name, []).append(lamp.name)
    missions = {}
    for mode in table.mode:
        if mode.seconds is None or not mode.is_shown:
            continue
        goals = []
        for rule in table.rule:
            if mode.name in rule.stop:
                goals += [Goal(name, value, ()) for name, value in rule.on_count.items()]
                goals += [Goal("", len(groups[name]), tuple(groups[name])) for name in rule.on_complete]
        missions[mode.name] = Mission(mode.seconds, tuple(goals))
    return missions
