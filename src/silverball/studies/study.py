"""A study that is played, or has been: its folder, and its figures folded from the chunks in their order.

The figures are always folded in the order of the chunks, whatever the order in which these are done. So a
study that was stopped and went on, or that was played on many machines, has the same figures bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.statistics import Estimate, Moments
from silverball.studies.chunk import Columns
from silverball.studies.result_folder import ResultFolder
from silverball.studies.run import Runner, finish, play_here
from silverball.studies.study_plan import Plan, checked_plan
from silverball.studies.summary import COLUMNS, RATIOS, ArmSummary, game_values


class Study:
    """A study in a folder.

    Args:
        plan: What is played.
        path: The folder; what is already in it is not played again.

    Attributes:
        plan: What is played.
        folder: Where the results are.
        arms: The figures of each arm so far.

    Raises:
        StateError: The folder is of another study.
        OutputError: It cannot be written.
    """

    def __init__(self, plan: Plan, path: Path) -> None:
        self.plan = checked_plan(plan)
        self.folder = ResultFolder(path, plan)
        self.arms = [ArmSummary() for _ in plan.arms]
        self._pairs = [Moments(2 * len(COLUMNS)) for _ in plan.arms]
        self._chunks = plan.chunks()
        self._next = next(self._chunks, None)
        self._base_values: NDArray[np.float64] | None = None  # of the first arm, for the same seeds
        self._catch_up()

    @property
    def is_done(self) -> bool:
        """Whether all chunks are done."""
        return self._next is None

    @property
    def done_share(self) -> float:
        """The share of the games that the figures are of."""
        return sum(arm.games for arm in self.arms) / (self.plan.games * len(self.arms))

    def run(self, runner: Runner = play_here, progress: Callable[[], None] | None = None) -> None:
        """Play what is missing.

        Args:
            runner: What plays the chunks.
            progress: Called after every chunk.
        """

        def done(number: int, columns: Columns) -> None:
            if self._next is not None and number == self._next.number:
                self._fold(columns)
            self._catch_up()
            if progress is not None:
                progress()

        finish(self.folder, runner, done)
        self._catch_up()

    def difference(self, arm: int, figure: str) -> Estimate:
        """A figure of RATIOS of an arm, minus that of the first one, over games of the same seeds."""
        above, below = (COLUMNS.index(name) for name in RATIOS[figure])
        count = len(COLUMNS)
        return self._pairs[arm].ratio_difference((count + above, count + below), (above, below))

    def _catch_up(self) -> None:
        """Fold the chunks that are done, as far as none before them is missing."""
        while self._next is not None and self.folder.has(self._next.number):
            self._fold(self.folder.read(self._next.number))

    def _fold(self, columns: Columns) -> None:
        assert self._next is not None
        arm = self._next.arm
        self.arms[arm].add(columns)
        if len(self.arms) > 1:
            values = game_values(columns)
            if arm == 0:
                self._base_values = values
            assert self._base_values is not None
            self._pairs[arm].add(np.concatenate([self._base_values, values], axis=1))
        self._next = next(self._chunks, None)
