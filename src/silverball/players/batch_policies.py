"""Which players decide now and then only, outside of the compiled loops, and how often?

The planner and the trained player choose for all worlds of a batch in one call, and hold what they have
chosen until the next one. The others choose in every tick, in the loops themselves.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from silverball.players.planner import BRANCHES, Notes, beat_of, plan_batch
from silverball.players.simple import PlayerKind
from silverball.players.trained import hold_of, press_batch
from silverball.world import WorldBatch


class Deciding(Protocol):
    """A player that decides for the worlds of a batch.

    Attributes:
        every: Ticks between two decisions.
        buttons: What it holds, bool [world, 2]: left, right; always the same array.
    """

    every: int
    buttons: NDArray[np.bool_]

    def decide(self) -> None:
        """Choose what to hold until the next decision."""


class Planning:
    """The planners of a batch."""

    def __init__(self, batch: WorldBatch, branches: int) -> None:
        self._batch, self.every = batch, beat_of(batch.tick_rate)
        self._notes = Notes(batch.count, batch.tallies.shape[1], branches)
        self.buttons = self._notes.buttons

    def decide(self) -> None:
        """Choose what to hold until the next decision."""
        plan_batch(self._batch, self._notes)


class Trusting:
    """The trained players of a batch."""

    def __init__(self, batch: WorldBatch) -> None:
        self._batch, self.every = batch, hold_of(batch.tick_rate)
        self.buttons = np.zeros((batch.count, 2), np.bool_)

    def decide(self) -> None:
        """Choose what to hold until the next decision."""
        self.buttons[:] = press_batch(self._batch)


def deciding(player: PlayerKind, batch: WorldBatch, branches: int = BRANCHES) -> Deciding | None:
    """The player, for all worlds of a batch; None: it decides in every tick. A planner tries `branches`."""
    if player == PlayerKind.PLANNER:
        return Planning(batch, branches)
    return Trusting(batch) if player == PlayerKind.TRAINED else None
