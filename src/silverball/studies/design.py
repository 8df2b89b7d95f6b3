"""Design by search: looks for numbers of a table with which it plays as wished.

The search is CMA-ES with margin (Hamano et al., 2022), as the package `cmaes` has it: few games for each
table, whole numbers and limits among the variables, and no more than a ranking of the tables is needed, so
noise does little harm. Every table of the search plays the same seeds; what it finds is judged by games of
other seeds, because the best of many is partly the luckiest.

A table that `check` refuses is never played and never written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from silverball.errors import MissingExtra, SilverballError
from silverball.metrics.statistics import Estimate
from silverball.studies.chunk import Columns
from silverball.studies.goals import Range, Target
from silverball.studies.run import Runner, play_here
from silverball.studies.study_plan import Arm, Plan
from silverball.studies.summary import ArmSummary
from silverball.studies.table_change import changed
from silverball.table import Table

KEPT = 10  # the tables that are kept
REFUSED = 1e6  # the miss of a table that cannot be played
SPREAD = 0.3  # of the first tables, as a share of the ranges
HELD_OUT = 10**12  # added to the seed of games that judge what was found
JUDGED_GAMES = 5  # times as many games as in the search
JUDGED_SETS = 3  # sets of games of other seeds, which all have to reach the target


class Wish(NamedTuple):
    """What is looked for.

    Attributes:
        table: The table or recipe to begin with.
        player: Who plays.
        targets: What has to be reached.
        ranges: What may be changed.
        games: Games of each table of the search.
        tables: Tables that are tried at most.
        seed: Of the search and of the first game.
    """

    table: Table
    player: str
    targets: tuple[Target, ...]
    ranges: tuple[Range, ...]
    games: int
    tables: int
    seed: int = 0


class Tried(NamedTuple):
    """A table that was tried.

    Attributes:
        number: Of all tables of the search, from 1.
        values: Its numbers, by path.
        table: The table itself; None if it cannot be played.
        figures: How it plays.
        miss: How far away it is: the greatest miss of a target; at most 1 is reached.
    """

    number: int
    values: tuple[tuple[str, float], ...]
    table: Table | None
    figures: Mapping[str, Estimate]
    miss: float


class Judged(NamedTuple):
    """A table that was found, and how it plays games of other seeds.

    Attributes:
        tried: What the search knows of it.
        sets: Its figures in each set of games.
        together: Its figures in all of them.
    """

    tried: Tried
    sets: tuple[Mapping[str, Estimate], ...]
    together: Mapping[str, Estimate]

    def reaches(self, targets: Sequence[Target]) -> bool:
        """Whether every target is reached in every set of games."""
        return all(target.miss(figures) <= 1.0 for figures in self.sets for target in targets)

    def miss(self, targets: Sequence[Target]) -> float:
        """How far away it is in all games together."""
        return max(target.miss(self.together) for target in targets)


Progress = Callable[[Tried], None]


def search(
    wish: Wish, runner: Runner = play_here, progress: Progress | None = None, enough: int = KEPT
) -> list[Tried]:
    """Look for tables; returns all that were tried, in their order.

    It ends when `enough` tables have reached the targets, or after `wish.tables`.

    Args:
        wish: What is looked for.
        runner: What plays the chunks of games.
        progress: Called with every table that was tried.
        enough: Tables that are wanted.

    Raises:
        MissingExtra: The package cmaes is not installed.
        SilverballError: A path does not exist.
    """
    require_cmaes()
    for varied in wish.ranges:
        check_range(wish.table, varied)
    optimizer = _optimizer(wish)
    tried: list[Tried] = []
    while len(tried) < wish.tables and sum(one.miss <= 1.0 for one in tried) < enough:
        asked = [optimizer.ask() for _ in range(optimizer.population_size)]
        found = _played(wish, [point for point, _ in asked], len(tried), runner)
        for one in found:
            tried.append(one)
            if progress is not None:
                progress(one)
        misses = [_ranked(one.miss) for one in found]
        optimizer.tell([(place, miss) for (_, place), miss in zip(asked, misses, strict=True)])
    return tried


def judge(wish: Wish, tried: Sequence[Tried], runner: Runner = play_here) -> list[Judged]:
    """Play the best tables of a search in games of other seeds; returns them, the best first.

    Args:
        wish: What is looked for.
        tried: What `search` returned.
        runner: What plays the chunks of games.
    """
    best = sorted((one for one in tried if one.table is not None), key=lambda one: one.miss)
    chosen = list({dict_key(one): one for one in reversed(best[: 2 * KEPT])}.values())[::-1][:KEPT]
    if not chosen:
        return []
    arms = [Arm(str(one.number), _table(one), wish.player) for one in chosen]
    games = JUDGED_GAMES * wish.games
    sets = [
        _summaries(Plan(tuple(arms), games, wish.seed + HELD_OUT + number * games), runner)
        for number in range(JUDGED_SETS)
    ]
    judged = []
    for index, one in enumerate(chosen):
        together = ArmSummary()
        for _, chunks in (row[index] for row in sets):
            for columns in chunks:
                together.add(columns)
        figures = tuple(row[index][0].figures() for row in sets)
        judged.append(Judged(one, figures, together.figures()))
    return sorted(judged, key=lambda one: (not one.reaches(wish.targets), one.miss(wish.targets)))


def dict_key(one: Tried) -> tuple[tuple[str, float], ...]:
    """What tells tables of a search apart."""
    return one.values


def require_cmaes() -> None:
    """Check that the search is installed.

    Raises:
        MissingExtra: It is not.
    """
    try:
        import cmaes  # noqa: F401
    except ImportError:
        raise MissingExtra("silverball design", "design") from None


def check_range(table: Table, one: Range) -> None:
    """Refuse a path that leads to nothing; a value that cannot be played is no mistake.

    Raises:
        SilverballError: There is no such number in the table, or no value of the range can be played.
    """
    reasons = []
    for share in (0.5, 0.0, 1.0, 0.25, 0.75):
        try:
            changed(table, one.path, one.at(share))
        except SilverballError as error:
            reasons.append(error)
        else:
            return
    raise reasons[0]


def _optimizer(wish: Wish) -> Any:
    """The search, on a cube whose edges are the ranges."""
    from cmaes import CMAwM

    count = max(2, len(wish.ranges))  # it needs two; the second one of a single number does nothing
    steps = np.zeros(count)
    for index, one in enumerate(wish.ranges):
        if one.is_whole:
            steps[index] = 1.0 / (one.high - one.low)
    bounds = np.tile([0.0, 1.0], (count, 1))
    return CMAwM(np.full(count, 0.5), SPREAD, bounds, steps, seed=wish.seed % 2**32)


def _played(wish: Wish, points: list[Any], before: int, runner: Runner) -> list[Tried]:
    """Play the tables at these points."""
    tables: list[tuple[tuple[tuple[str, float], ...], Table | None]] = []
    for point in points:
        values = tuple((one.path, one.at(float(x))) for one, x in zip(wish.ranges, point, strict=False))
        tables.append((values, _with_values(wish.table, values)))
    arms = [
        Arm(str(index), table, wish.player) for index, (_, table) in enumerate(tables) if table is not None
    ]
    summaries = iter(_summaries(Plan(tuple(arms), wish.games, wish.seed), runner) if arms else [])
    found = []
    for number, (values, table) in enumerate(tables, before + 1):
        figures: Mapping[str, Estimate] = {} if table is None else next(summaries)[0].figures()
        miss = math.inf if table is None else max(target.miss(figures) for target in wish.targets)
        found.append(Tried(number, values, table, figures, miss))
    return found


def _with_values(table: Table, values: tuple[tuple[str, float], ...]) -> Table | None:
    """The table with other numbers; None if it cannot be played."""
    try:
        for path, value in values:
            table = changed(table, path, value)
    except SilverballError:
        return None
    return table


def _summaries(plan: Plan, runner: Runner) -> list[tuple[ArmSummary, list[Columns]]]:
    """The figures of each arm of a plan, and its chunks, in order, so that no bit depends on the runner."""
    chunks = list(plan.chunks())
    columns = dict(runner(chunks))
    found: list[tuple[ArmSummary, list[Columns]]] = [(ArmSummary(), []) for _ in plan.arms]
    for chunk in chunks:
        summary, kept = found[chunk.arm]
        summary.add(columns[chunk.number])
        kept.append(columns[chunk.number])
    return found


def _table(one: Tried) -> Table:
    assert one.table is not None
    return one.table


def _ranked(miss: float) -> float:
    return miss if math.isfinite(miss) else REFUSED
