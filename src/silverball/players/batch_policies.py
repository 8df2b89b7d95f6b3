"""Policies for batches: players that decide for all worlds in Python, outside of the compiled loops.

The planner and the trained player decide for a whole batch in one call and hold their buttons until the next
decision; a registered player decides in every tick. The simple players decide inside the loops themselves.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from silverball.game.game_batch import GameBatch
from silverball.players.aims import aim_rows
from silverball.players.planner import BRANCHES, PlannerState, plan_batch, ticks_per_decision as planner_ticks
from silverball.players.registry import BUILT_IN, CheckedPlayer, check_name
from silverball.players.simple import PlayerKind
from silverball.players.trained import (
    Games,
    MissionBatch,
    press_batch,
    ticks_per_decision as trained_ticks,
)
from silverball.world import World, WorldBatch
from silverball.world.saved_world import in_layout


class BatchPolicy(Protocol):
    """Decides for all worlds of a batch.

    Attributes:
        every: Ticks between two decisions.
        buttons: What is held until the next decision, bool [world, 2]: left, right; always the same array.
    """

    every: int
    buttons: NDArray[np.bool_]

    def decide(self) -> None:
        """Choose the buttons to hold until the next decision."""


class PlannerPolicy:
    """One planner for each world of a batch; those of a `GameBatch` aim at what is lit in their games."""

    def __init__(self, batch: WorldBatch, branches: int) -> None:
        self._batch, self.every = batch, planner_ticks(batch.tick_rate)
        self._state = PlannerState.of(batch.state, batch.tallies.shape[1], branches)
        self.buttons = self._state.buttons
        self._aims = aim_rows(batch.books) if isinstance(batch, GameBatch) else None

    def decide(self) -> None:
        """Choose the buttons to hold until the next decision."""
        if self._aims is not None and isinstance(self._batch, GameBatch):
            self._state.aim(self._batch.games, self._batch.board_of, self._aims)
        plan_batch(self._batch, self._state)


class TrainedPolicy:
    """The trained player for all worlds of a batch; in games that it has learnt it plays for the missions."""

    def __init__(self, batch: WorldBatch, games: Games | None) -> None:
        self._batch, self.every = batch, trained_ticks(batch.tick_rate)
        self.buttons = np.zeros((batch.count, 2), np.bool_)
        self._missions = None if games is None else MissionBatch(batch, games)

    def decide(self, charge: Any = 1.0) -> None:
        """Choose the buttons to hold until the next decision.

        Args:
            charge: How far the power supply of the coils is charged, where an environment has one: one
                number, or [world].
        """
        missions = self._missions
        if missions is None or len(missions.rows) < self._batch.count:
            held = None if missions is None else self.buttons[missions.rows]
            self.buttons[:] = press_batch(self._batch)
            if missions is not None:
                self.buttons[missions.rows] = held
        if missions is not None:
            missions.press(self.buttons, charge)


class RegisteredPolicy:
    """A registered player: one for the batch if it has a batch form, else one for each world.

    Args:
        name: Under which it was registered.
        batch: The worlds. A player gets the seed of its world, one for the batch that of the first world.

    Raises:
        PlayerError: The player cannot be created.
    """

    every = 1

    def __init__(self, name: str, batch: WorldBatch) -> None:
        self._batch = batch
        self.buttons = np.zeros((batch.count, 2), np.bool_)
        seeds = batch.state["seed"].tolist()
        player = CheckedPlayer(name, seeds[0])
        self._batch_player = player if player.has_batch_form else None
        self._players: list[tuple[CheckedPlayer, WorldView]] = []  # one for each world, without a batch form
        if not player.has_batch_form:
            players = [player, *(CheckedPlayer(name, seed) for seed in seeds[1:])]
            self._players = [(one, WorldView(batch, index)) for index, one in enumerate(players)]

    def decide(self) -> None:
        """Choose the buttons to hold in the next tick."""
        if self._batch_player is not None:
            self.buttons[:] = self._batch_player.press_batch(self._batch)
        for index, (player, view) in enumerate(self._players):
            self.buttons[index] = player.press(view.world())


class WorldView:
    """One world of a batch as a `World`: a copy, so that a player cannot move the world itself.

    Args:
        batch: The worlds.
        index: Which of them.
    """

    def __init__(self, batch: WorldBatch, index: int) -> None:
        self._batch, self._index = batch, index
        table = batch.tables[batch.board_of[index]]
        self._world = World(table, int(batch.state["seed"][index]), batch.tick_rate)

    def world(self) -> World:
        """The world as it is now, with the events of its last step and its hits; always the same object."""
        copy, index = self._world._batch, self._index
        copy.state[:] = in_layout(self._batch.state[index : index + 1], copy.state.dtype)
        copy.logs[0] = self._batch.logs[index]
        copy.tallies[0] = self._batch.tallies[index, : copy.tallies.shape[1]]
        return self._world


def batch_policy(
    player: str, batch: WorldBatch, branches: int = BRANCHES, games: Games | None = None
) -> BatchPolicy | None:
    """The policy of a player for all worlds of a batch; None for a simple player.

    Args:
        player: The name of a player.
        batch: The worlds.
        branches: Branches that the planner tries at a decision.
        games: The games that the worlds play, for the trained player; those of a `GameBatch` are known.

    Raises:
        PlayerError: No player has that name, or it cannot be created.
    """
    check_name(player)
    if player == "planner":
        return PlannerPolicy(batch, branches)
    if player == "trained":
        known = Games(batch.games, batch.books) if isinstance(batch, GameBatch) else games
        return TrainedPolicy(batch, known)
    return None if player in BUILT_IN else RegisteredPolicy(player, batch)


def kernel_player(player: str) -> PlayerKind:
    """The `PlayerKind` of a player in the compiled loops: its own if it is simple, else `DECIDED`."""
    return PlayerKind.__members__.get(player.upper(), PlayerKind.DECIDED)
