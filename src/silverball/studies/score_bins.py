"""The distribution of scores in bins of about one percent, with a game for each.

The number of bins is fixed, so any number of games needs the same memory. The seed that is kept for a bin is
the lowest of its games: so the median game can be played again without a list of all games.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.statistics import NORMAL_95, UNKNOWN, Estimate

PARTS = 64  # bins from one power of two to the next
BINS = 64 * PARTS
NO_SEED = 2**63 - 1


class Game(NamedTuple):
    """One game of a study."""

    seed: int
    score: int


class ScoreBins:
    """Scores of games by bin.

    Attributes:
        counts: Games by bin.
        seeds: The lowest seed of each bin, or NO_SEED.
        best: The game with the most points, the one with the lowest seed of several; None without games.
    """

    def __init__(self) -> None:
        self.counts = np.zeros(BINS, np.int64)
        self.seeds = np.full(BINS, NO_SEED)
        self.best: Game | None = None

    def add(self, seeds: NDArray[np.int64], scores: NDArray[np.int64]) -> None:
        """Add games."""
        if len(scores) == 0:
            return
        bins = bin_of(scores)
        np.add.at(self.counts, bins, 1)
        np.minimum.at(self.seeds, bins, seeds)
        most = int(scores.max())
        game = Game(int(seeds[scores == most].min()), most)
        if self.best is None or (-game.score, game.seed) < (-self.best.score, self.best.seed):
            self.best = game

    def quantile(self, share: float) -> Estimate:
        """The score below which a share of the games lies, to about one percent.

        The interval holds the true one by the binomial distribution of the games below it.
        """
        count = int(self.counts.sum())
        if count == 0:
            return UNKNOWN
        wide = NORMAL_95 * (share * (1.0 - share) / count) ** 0.5
        places = (share, share - wide, share + wide)
        return Estimate(*(self._score_at(place * count) for place in places))

    def median_game(self) -> int | None:
        """The seed of a game with a median score; None without games."""
        count = int(self.counts.sum())
        return int(self.seeds[self._bin_at(0.5 * count)]) if count else None

    def even_bars(self, most: int) -> tuple[list[float], list[float]]:
        """A histogram for a logarithmic scale.

        Args:
            most: The greatest number of bars.

        Returns:
            The edges of the bars [points], and the share of the games in each; nothing if none has scored.
        """
        seen = np.nonzero(self.counts)[0]
        seen = seen[seen >= PARTS + 1]  # from one point on
        if len(seen) == 0:
            return [], []
        places = np.log2([middle_of(int(number)) + 1.0 for number in seen])
        parts = next(n for n in (16, 8, 4, 2, 1, 0.5, 0.25) if (places[-1] - places[0]) * n + 2 <= most)
        bars = np.floor(places * parts).astype(np.int64)
        counts = np.bincount(bars - bars[0], weights=self.counts[seen])
        edges = [max(2.0 ** (number / parts) - 1.0, 0.5) for number in range(bars[0], bars[-1] + 2)]
        return edges, (counts / self.counts.sum()).tolist()

    def _score_at(self, place: float) -> float:
        """The score of the game at a place in the order of scores; within a bin they are taken as even."""
        number = self._bin_at(place)
        before, low, high = int(self.counts[:number].sum()), edge_of(number), edge_of(number + 1)
        share = min(max((place - before) / int(self.counts[number]), 0.0), 1.0)
        return low if high - low <= 1.0 else low + share * (high - low)

    def _bin_at(self, place: float) -> int:
        sums = np.cumsum(self.counts)
        return int(np.searchsorted(sums, min(max(place, 0.5), float(sums[-1]))))


def bin_of(scores: NDArray[np.int64]) -> NDArray[np.int64]:
    """The bin of each score ≥ 0: exact by the parts of a floating point number."""
    fraction, power = np.frexp((scores + 1).astype(np.float64))
    found: NDArray[np.int64] = power.astype(np.int64) * PARTS + ((fraction - 0.5) * (2 * PARTS)).astype(
        np.int64
    )
    return found


def edge_of(number: int) -> float:
    """The least score of a bin."""
    power, part = divmod(number, PARTS)
    return float(np.ldexp(0.5 + part / (2 * PARTS), power)) - 1.0


def middle_of(number: int) -> float:
    """A score in the middle of a bin."""
    low, high = edge_of(number), edge_of(number + 1)
    return low if high - low <= 1.0 else 0.5 * (low + high)
