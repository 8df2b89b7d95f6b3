"""The arrays of one or many environments of the PinBall domain, and the calls of the kernels on them.

A single environment is an engine of one, a vector environment an engine of many; both use the same code, so
environment i of a vector is, bit for bit, the single environment with its seed.
"""

from __future__ import annotations

import hashlib
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs.domain.board_file import load_board
from silverball.envs.domain.board_table import TICK_RATE, point_of, table_of, unit_speed
from silverball.envs.domain.impulses import (
    EPISODE_OF_DOMAIN,
    RULES_OF_DOMAIN,
    SLOTS,
    Arena,
    begin_episodes,
    finish_steps,
    push_balls,
)
from silverball.envs.engine import announce_compilation
from silverball.envs.options import NO_LIMIT
from silverball.envs.state import ResetMode
from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.kernel import bind_types
from silverball.physics.records import records
from silverball.physics.step import run_worlds
from silverball.world import WorldBatch
from silverball.world.arguments import checked_int

SIGNATURE_SIZE = 16  # [B] start of a saved state: a hash of the board and the version


class DomainEngine:
    """The worlds and episodes of some environments on one board, with methods that step, reset and save.

    Attributes:
        board: The board.
        batch: The worlds.
        arena: The arrays that the kernels read and write.
    """

    def __init__(
        self,
        board: str | os.PathLike[str],
        max_steps: int | None,
        count: int,
        mode: ResetMode,
        threads: int,
    ) -> None:
        """Make `count` environments on a board, whose episodes are truncated after `max_steps`; None: never.

        Raises:
            TableError: There is no such board, or it has problems.
            ValueError: The limit is not an integer ≥ 1.
        """
        limit = NO_LIMIT if max_steps is None else checked_int("max_steps", max_steps, 1, 10**9)
        self.count, self.board = count, load_board(board)
        self.batch = WorldBatch(table_of(self.board), count, 0, TICK_RATE, threads)
        rules = records(1, RULES_OF_DOMAIN)
        rules["unit"], rules["max_steps"], rules["mode"] = unit_speed(self.board), limit, mode
        self.arena = Arena(
            episodes=records(count, EPISODE_OF_DOMAIN),
            rules=rules,
            starts=np.array([point_of(start) for start in self.board.starts]),
            blanks=self.batch.state[:1].copy(),
            actions=np.zeros(count, np.int64),
            masks=np.ones((4, count), np.bool_),
            rewards=np.zeros(count),
            observations=np.zeros((2, count, SLOTS), np.float32),
        )
        self._held = np.zeros((1, count, 3), np.bool_)
        self._arguments = (self.batch.lanes, self.batch.geometries, self.arena)
        announce_compilation("", finish_steps.__name__)
        self._run = bind_types(run_worlds, *self._arguments[:2], self._held, 0, count, 1, 1.0 / TICK_RATE)
        self._push = bind_types(push_balls, *self._arguments, 0, count)
        self._begin = bind_types(begin_episodes, *self._arguments, 0, count)
        self._finish = bind_types(finish_steps, *self._arguments, 0, count)  # the last one, see above
        self.set_unstarted()

    def step(self) -> None:
        """Make a step in all environments with the actions in the arena."""
        if self.batch.threads == 1 or self.count == 1:
            self._step_slice(0, self.count)
        else:
            self.batch.on_threads(self._step_slice, self.count)

    def _step_slice(self, first: int, end: int) -> None:
        """Make a step in the environments first … end − 1."""
        self._push(*self._arguments, first, end)
        self._run(*self._arguments[:2], self._held, first, end, 1, 1.0 / TICK_RATE)
        self._finish(*self._arguments, first, end)

    def reset(self, mask: NDArray[np.bool_] | bool = True) -> None:
        """Begin the next episode in the masked environments, and write all observations."""
        self.arena.masks[0] = mask
        self._begin(*self._arguments, 0, self.count)

    def observe(self) -> None:
        """Write the observations again, after states were changed."""
        self.reset(mask=False)

    @property
    def observations(self) -> NDArray[np.float32]:
        """The present observations, float32 [env, slot], as a new array."""
        rows: NDArray[np.float32] = self.arena.observations[0].copy()
        return rows

    # --- seeds and saved states

    @property
    def has_begun(self) -> NDArray[np.bool_]:
        """Whether an episode has begun since the environment was made or seeded, bool [env]."""
        begun: NDArray[np.bool_] = self.arena.episodes["number"] >= 0
        return begun

    def set_unstarted(self) -> None:
        """Mark all environments as never reset."""
        self.arena.episodes["over"] = 1
        self.arena.episodes["number"] = -1

    def seed(self, seeds: Any, where: Any = slice(None)) -> None:
        """Seed environments; their next episode is the first of the seed."""
        self.arena.episodes["seed"][where] = seeds
        self.arena.episodes["number"][where] = -1

    @property
    def signature(self) -> bytes:
        """The start of a saved state: it can only be restored where this is equal."""
        shared = (PHYSICS_VERSION, self.batch.boards.digests, self.board.starts, EPISODE_OF_DOMAIN.descr)
        return hashlib.sha256(repr(shared).encode()).digest()[:SIGNATURE_SIZE]

    def save(self, row: int) -> bytes:
        """Everything that determines what happens next in an environment."""
        world: bytes = self.batch.state[row].tobytes()
        return self.signature + world + bytes(self.arena.episodes[row].tobytes())

    def restore(self, state: Any, row: int) -> None:
        """Restore a saved state; `observe` writes its observation.

        Raises:
            StateError: It is not a state of an environment on the same board.
        """
        if not isinstance(state, bytes):
            raise StateError(f"state must be the bytes that save_state returned, got {type(state).__name__}")
        size = self.batch.state.itemsize
        expected = SIGNATURE_SIZE + size + EPISODE_OF_DOMAIN.itemsize
        if len(state) != expected or not state.startswith(self.signature):
            raise StateError(
                f"a state of this environment has {expected} bytes, of this version and of the board "
                f"{self.board.name!r}; got {len(state)} bytes"
            )
        world, episode = state[SIGNATURE_SIZE : SIGNATURE_SIZE + size], state[SIGNATURE_SIZE + size :]
        self.batch.state[row] = np.frombuffer(world, self.batch.state.dtype)[0]
        self.arena.episodes[row] = np.frombuffer(episode, EPISODE_OF_DOMAIN)[0]
