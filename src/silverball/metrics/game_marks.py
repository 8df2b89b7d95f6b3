"""The marks of a table: whether whole games by its rules are as long, and pay as much, as they should.

`measure_marks` lets every player play many games (`marked_games.py`) and compares their figures with what a
good table has; all with 95 % intervals. The result is a function of the table, the seed and the numbers of
games.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.game.game_batch import GameBatch
from silverball.metrics.game_traces import TICK_RATE
from silverball.metrics.marked_games import NEVER_RAN, MarkedGames, play_marked_games
from silverball.metrics.statistics import UNKNOWN, Estimate, mean, quotient, ratio, share
from silverball.table import Table

PLAYERS = ("idle", "random", "beginner", "reflex", "planner")
AIMED, MASHED = "planner", "random"  # the player who aims, and the one who does not
SHOTS = ("rollover", "target", "drop_target", "spinner", "hole", "passage")  # kinds of parts to shoot at
LONGEST = 600.0  # [s] after which a game is cut short
LONGEST_AIMED = 120.0  # [s] the same for the planner, whose games hardly end
STUCK = 5.0  # [s] a ball that stays longer within half a unit is stuck


class Mark(NamedTuple):
    """What a table should reach.

    Attributes:
        name: What it is.
        value: What was measured.
        low: The least that is good.
        high: The most that is good; infinite where there is no limit.
    """

    name: str
    value: Estimate
    low: float
    high: float = math.inf

    @property
    def is_met(self) -> bool:
        """Whether the measured value is good."""
        return self.low <= self.value.value <= self.high


class PlayerMarks(NamedTuple):
    """How games go under one player.

    Attributes:
        figures: By name.
        missions: The share of the games in which each mission was finished, by the name of its lamp.
        reached: The share of the games in which each mode ran and each counter grew, by its name.
        seeds: The seed of the first such game, of those that were reached.
        missed: The parts to shoot at that were hit in no game.
        games: What was noted.
    """

    figures: dict[str, Estimate]
    missions: dict[str, Estimate]
    reached: dict[str, Estimate]
    seeds: dict[str, int]
    missed: tuple[str, ...]
    games: MarkedGames


class Marks(NamedTuple):
    """The result of `measure_marks`."""

    marks: tuple[Mark, ...]
    players: dict[str, PlayerMarks]


def measure_marks(
    table: Table,
    games: int = 1000,
    aimed_games: int = 20,
    seed: int = 0,
    longest: float = LONGEST,
    players: tuple[str, ...] = PLAYERS,
    progress: Callable[[str, float], None] | None = None,
) -> Marks:
    """Measure the marks of a table.

    Args:
        table: A table, not a recipe.
        games: Games of each player but the planner.
        aimed_games: Games of the planner, which takes a thousand times as long.
        seed: Of the first game.
        longest: [s] after which a game is cut short; those of the planner after LONGEST_AIMED at the latest.
        players: Some of PLAYERS; marks that need others are left out.
        progress: Called with the name of the player and the share done, 0 to 1.
    """
    report = progress or (lambda what, done: None)
    names = GameBatch(table, 1).boards.names[0]
    found = {}
    for player in players:
        count = aimed_games if player == AIMED else games
        played = play_marked_games(
            table,
            player,
            count,
            seed,
            min(longest, LONGEST_AIMED) if player == AIMED else longest,
            progress=lambda done, player=player: report(player, done),  # type: ignore[misc]
        )
        found[player] = _player_marks(table, names, played, seed)
    return Marks(_marks(found), found)


def _player_marks(table: Table, names: tuple[str, ...], played: MarkedGames, seed: int) -> PlayerMarks:
    mark, games = played.mark, played.games
    lost = mark["by_outlane"] + mark["by_centre"]
    reached = _reached(table, played)
    figures = {
        "seconds_per_ball": ratio(mark["ticks"] / TICK_RATE, games["used"]),
        "points_per_minute": ratio(games["score"], played.minutes),
        "points_per_game": mean(games["score"]),
        "share_by_outlane": ratio(mark["by_outlane"], lost) if played.has_outlanes else UNKNOWN,
        "longest_stay": _exactly(float(mark["longest_stay"].max(initial=0)) / TICK_RATE),
        "cut_short": share(int((games["over"] == 0).sum()), len(games)),
    }
    return PlayerMarks(
        figures,
        _missions(table, played),
        {name: share(int(is_so.sum()), len(games)) for name, is_so in reached.items()},
        {name: seed + int(is_so.argmax()) for name, is_so in reached.items() if is_so.any()},
        _missed(table, names, played),
        played,
    )


def _reached(table: Table, played: MarkedGames) -> dict[str, NDArray[np.bool_]]:
    """Whether each mode has run, and each counter has grown, in each game."""
    ran = {mode.name: played.modes[:, number] != NEVER_RAN for number, mode in enumerate(table.mode)}
    return ran | {
        f"{counter.name} (counter)": played.counters[:, number] > counter.begins
        for number, counter in enumerate(table.counter)
    }


def _missions(table: Table, played: MarkedGames) -> dict[str, Estimate]:
    """How often the lamps were lit that last for a game, and of which a rule waits for the whole group."""
    groups = {name for rule in table.rule for name in rule.on_complete}
    return {
        lamp.name: share(int(played.lamps[:, number].sum()), len(played.lamps))
        for number, lamp in enumerate(table.lamp)
        if lamp.group in groups and lamp.lasts == "game"
    }


def _missed(table: Table, names: tuple[str, ...], played: MarkedGames) -> tuple[str, ...]:
    hits = dict(zip(names, played.hits.sum(axis=0).tolist(), strict=False))
    return tuple(
        one.part.name or one.path
        for one in table.parts()
        if one.path.split("[")[0] in SHOTS and hits[one.name] == 0
    )


def _marks(found: dict[str, PlayerMarks]) -> tuple[Mark, ...]:
    def figure(player: str, name: str) -> Estimate:
        return found[player].figures[name] if player in found else UNKNOWN

    aimed = quotient(figure(AIMED, "points_per_minute"), figure(MASHED, "points_per_minute"))
    marks = [
        Mark("idle: seconds a ball", figure("idle", "seconds_per_ball"), 8.0, 15.0),
        Mark("beginner: seconds a ball", figure("beginner", "seconds_per_ball"), 20.0, 45.0),
        Mark("points a minute, planner : random", aimed, 10.0),
        Mark("idle: balls lost by an outlane", figure("idle", "share_by_outlane"), 0.4, 0.6),
        Mark("random: balls lost by an outlane", figure("random", "share_by_outlane"), 0.4, 0.6),
    ]
    unaimed = [one.figures["longest_stay"].value for name, one in found.items() if name != AIMED]
    if unaimed:
        marks.append(Mark("longest stay in one place, not held [s]", _exactly(max(unaimed)), 0.0, STUCK))
    if AIMED in found:
        missed = len(found[AIMED].missed)
        marks.append(Mark("shots that the planner never made", _exactly(missed), 0.0, 0.0))
    for words, shares in (
        ("missions that no player finished", [one.missions for one in found.values()]),
        ("modes and counters that no player reached", [one.reached for one in found.values()]),
    ):
        if shares and shares[0]:
            never = sum(all(one[name].value == 0.0 for one in shares) for name in shares[0])
            marks.append(Mark(words, _exactly(never), 0.0, 0.0))
    return tuple(mark for mark in marks if not math.isnan(mark.value.value))


def _exactly(value: float) -> Estimate:
    return Estimate(value, value, value)
