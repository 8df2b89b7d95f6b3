"""The figures of an arm of a study, folded from its chunks one after the other.

A summary has the same size after ten games and after a billion. Folding the same chunks in the same order
gives the same bits.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.game_traces import CELLS, TICK_RATE
from silverball.metrics.marked_games import STEP
from silverball.metrics.statistics import Estimate, Moments, RatioSums, Survival, share, survival
from silverball.metrics.watching_kernel import SPEED_UNIT
from silverball.studies.chunk import Columns
from silverball.studies.score_bins import ScoreBins

STUCK = 5.0  # [s] a ball that stays longer within half a unit is stuck
ADDED = (
    "sum.place", "sum.speed", "sum.shots", "sum.drains", "sum.first", "sum.hits", "square.hits",
    "product.hits", "sum.points", "square.points", "product.points",
)  # fmt: skip
COLUMNS = (
    "one", "score", "minutes", "seconds", "lost", "hits", "strikes", "samples", "samples_left", "fast",
    "drained", "drained_left",
)  # fmt: skip
"""The values of each game of which ratios are estimated."""

RATIOS: dict[str, tuple[str, str]] = {
    "seconds_per_ball": ("seconds", "lost"),
    "points_per_minute": ("score", "minutes"),
    "points_per_ball": ("score", "lost"),
    "points_per_game": ("score", "one"),
    "hits_per_second": ("hits", "seconds"),
    "strikes_per_minute": ("strikes", "minutes"),
    "share_above_half_cap": ("fast", "samples"),
    "share_time_left": ("samples_left", "samples"),
    "share_lost_left": ("drained_left", "drained"),
}
"""Figures that are ratios of two columns; so is their difference between two arms."""


class Stay(NamedTuple):
    """The longest stay of a ball in one place: how long [s], where [u], and in the game of which seed."""

    seconds: float
    x: float
    z: float
    seed: int


class Row(NamedTuple):
    """A figure of a part or a cause of points."""

    name: str
    total: int
    figure: Estimate


class ArmSummary:
    """What has happened in the games of an arm.

    Attributes:
        games: Games.
        lost: Balls lost.
        cut: Balls in play when their game was cut short.
        scores: The scores of games.
        ball_scores: The scores of balls.
        sums: Sums of the chunks by name: maps [x, z], and rows by `parts` and `causes`.
        parts: The names of the parts.
        causes: The names of what made points.
        stay: The longest stay.
    """

    def __init__(self) -> None:
        self.games, self.over, self.faults, self.stuck = 0, 0, 0, 0
        self.moments = Moments(len(COLUMNS))
        self.deaths, self.censored = np.zeros(0, np.int64), np.zeros(0, np.int64)
        self.scores, self.ball_scores = ScoreBins(), ScoreBins()
        self.sums: dict[str, NDArray[Any]] = {}
        self.stays = np.zeros((0, 0), np.int64)
        self.parts: list[str] = []
        self.causes: list[str] = []
        self.below: dict[str, tuple[float, float]] = {}  # Σ and Σ² of the ticks and the points of games
        self.stay = Stay(0.0, 0.0, 0.0, 0)

    def add(self, columns: Columns) -> None:
        """Fold a chunk."""
        seeds, score = columns["game.seed"], columns["game.score"]
        self.games += len(seeds)
        self.over += int(columns["game.is_over"].sum())
        self.faults += int(columns["game.fault"].sum())
        self.stuck += int((columns["game.longest_stay"] > STUCK * TICK_RATE).sum())
        self.moments.add(game_values(columns))
        self.scores.add(seeds, score)
        self.ball_scores.add(columns["ball.game"], columns["ball.score"])
        lives, is_lost = columns["ball.ticks"] // STEP, columns["ball.is_lost"] != 0
        self.deaths = _added(self.deaths, np.bincount(lives[is_lost]))
        self.censored = _added(self.censored, np.bincount(lives[~is_lost]))
        self._add_sums(columns)
        longest = int(columns["game.longest_stay"].argmax())
        stay = float(columns["game.longest_stay"][longest]) / TICK_RATE
        if stay > self.stay.seconds:
            x, z = float(columns["game.stay_x"][longest]), float(columns["game.stay_z"][longest])
            self.stay = Stay(stay, x, z, int(seeds[longest]))

    def _add_sums(self, columns: Columns) -> None:
        # Boards of a recipe may have different parts; rows are matched by their names.
        parts, causes = columns["name.parts"].tolist(), columns["name.causes"].tolist()
        self.parts += [name for name in parts if name not in self.parts]
        self.causes += [name for name in causes if name not in self.causes]
        for name in ADDED:
            values, what = columns[name], name.partition(".")[2]
            if what in ("hits", "first"):
                values = _matched(values, parts, self.parts)
            elif what == "points":
                values = _matched(values, causes, self.causes)
            self.sums[name] = _added(self.sums[name], values) if name in self.sums else values.copy()
        stays = columns["sum.stays"]
        self.stays = stays.copy() if self.stays.size == 0 else np.maximum(self.stays, stays)
        for name in ("ticks", "score"):
            values = columns[f"game.{name}"].astype(np.float64)
            total, square = self.below.get(name, (0.0, 0.0))
            self.below[name] = total + float(values.sum()), square + float((values * values).sum())

    @property
    def lost(self) -> int:
        """Balls lost."""
        return int(self.deaths.sum())

    @property
    def cut(self) -> int:
        """Balls in play when their game was cut short."""
        return int(self.censored.sum())

    def survival(self) -> Survival:
        """How long balls live [s]."""
        empty = np.zeros(max(len(self.deaths), len(self.censored)), np.int64)
        moments = np.arange(len(empty)) * (STEP / TICK_RATE)
        return survival(moments, _added(self.deaths, empty), _added(self.censored, empty))

    def figures(self) -> dict[str, Estimate]:
        """The figures by name; docs/studies.md says what each is."""
        if self.games == 0:
            return {}
        found = {name: self.moments.ratio(*_pair(name)) for name in RATIOS}
        return {
            "seconds_per_ball": found.pop("seconds_per_ball"),
            "median_ball": self.survival().median(),
            **found,
            "median_score": self.scores.quantile(0.5),
            "share_stuck": share(self.stuck, self.games),
            "share_cut_short": share(self.games - self.over, self.games),
        }

    def hits(self) -> list[Row]:
        """Hits a minute in play of each part."""
        return self._rows("hits", self.parts, "ticks", 60.0 * TICK_RATE)

    def causes_of_points(self) -> list[Row]:
        """The share of all points that each cause has made, those with points, the most first."""
        rows = self._rows("points", self.causes, "score", 1.0)
        return sorted((row for row in rows if row.total), key=lambda row: -row.total)

    def first_met(self) -> list[Row]:
        """What struck balls meet first: the share of each part, the most first."""
        counts = self.sums["sum.first"] if self.sums else np.zeros(0, np.int64)
        total = int(counts.sum())
        rows = [
            Row(name, int(count), share(int(count), total))
            for name, count in zip(self.parts, counts.tolist(), strict=True)
            if count
        ]
        return sorted(rows, key=lambda row: -row.total)

    def mean_speed(self) -> NDArray[np.float64]:
        """The mean speed in each cell [u/s], [x, z]; NaN where no ball was."""
        place, speed = self.sums["sum.place"], self.sums["sum.speed"]
        with np.errstate(invalid="ignore"):
            found: NDArray[np.float64] = speed / SPEED_UNIT / np.where(place > 0, place, np.nan)
        return found

    def longest_stays(self, count: int = 3) -> list[tuple[float, float, float]]:
        """The cells with the longest stays: x, z of their middle [u] and the stay [s]."""
        order = np.argsort(self.stays, axis=None, kind="stable")[::-1][:count]
        rows, columns = np.unravel_index(order, self.stays.shape)
        half_x, half_z = ((size - 1) / CELLS / 2.0 for size in self.stays.shape)
        return [
            ((i + 0.5) / CELLS - half_x, (j + 0.5) / CELLS - half_z, float(self.stays[i, j]) / TICK_RATE)
            for i, j in zip(rows.tolist(), columns.tolist(), strict=True)
        ]

    def _rows(self, name: str, labels: list[str], below: str, unit: float) -> list[Row]:
        """The ratio of each row of a sum to the ticks or the points of the games, times a unit."""
        total, total_square = self.below.get(below, (0.0, 0.0))
        rows = []
        for number, label in enumerate(labels):
            count, square, product = (
                float(self.sums[f"{kind}.{name}"][number]) for kind in ("sum", "square", "product")
            )
            found = RatioSums(self.games, count, total, square, product, total_square).estimate()
            rows.append(Row(label, int(count), Estimate(*(unit * value for value in found))))
        return rows


def game_values(columns: Columns) -> NDArray[np.float64]:
    """The COLUMNS of each game of a chunk, [game, column]."""
    seconds = columns["game.ticks"] / TICK_RATE
    is_lost = columns["ball.is_lost"] != 0
    place = columns["ball.game"][is_lost] - columns["game.seed"][0]
    lost = np.bincount(place, minlength=len(seconds))
    named: dict[str, NDArray[Any]] = {
        "one": np.ones(len(seconds)), "score": columns["game.score"], "minutes": seconds / 60.0,
        "seconds": seconds, "lost": lost,
    }  # fmt: skip
    values = [named[name] if name in named else columns[f"game.{name}"] for name in COLUMNS]
    found: NDArray[np.float64] = np.stack(values, axis=1).astype(np.float64)
    return found


def _pair(name: str) -> tuple[int, int]:
    above, below = RATIOS[name]
    return COLUMNS.index(above), COLUMNS.index(below)


def _added(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    """The sum of two arrays; a shorter list is filled with zeros."""
    if a.shape == b.shape:
        total: NDArray[Any] = a + b
        return total
    found = np.zeros(max(len(a), len(b)), a.dtype)
    found[: len(a)] += a
    found[: len(b)] += b
    return found


def _matched(values: NDArray[Any], names: list[str], wanted: list[str]) -> NDArray[Any]:
    """Values by name in another order; 0 where there is none."""
    place = {name: number for number, name in enumerate(names)}
    return np.array([values[place[name]] if name in place else 0 for name in wanted], values.dtype)
