"""Many environments of the PinBall domain stepped together: `PinBallDomainVectorEnv`.

Environment i equals, bit for bit, the single environment with the seed of environment i.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from silverball.envs.domain.arena import DomainEngine
from silverball.envs.domain.board_table import TICK_RATE
from silverball.envs.domain.domain_single import MAX_STEPS, SIZE, observation_space_of_domain
from silverball.envs.domain.impulses import Push
from silverball.envs.options import checked_render_mode, checked_reset_options
from silverball.envs.vector_arguments import (
    RESET_MODES,
    checked_mask,
    checked_mode,
    draw_missing,
    refuse_ended,
    seeds_of,
)
from silverball.envs.viewer import Viewer
from silverball.world.arguments import checked_int
from silverball.world.threads import cores


class PinBallDomainVectorEnv(VectorEnv[NDArray[np.float32], NDArray[np.int64], NDArray[Any]]):
    """Many boards of the PinBall domain that step together.

    Args:
        num_envs: The number of environments.
        board: The name of a built-in board, or the path of a `.cfg` file.
        max_steps: The steps after which an episode is truncated; None: never.
        autoreset_mode: When an environment begins its next episode: `AutoresetMode.NEXT_STEP`, `SAME_STEP` or
            `DISABLED`, or their names or values as text.
        threads: How many threads a step may use; None: one for each core. Results do not depend on it.
        render_mode: "rgb_array" or None.

    Raises:
        TableError: There is no such board, or it has problems.
        ValueError: A number or a mode is invalid.

    Examples:
        >>> import gymnasium as gym
        >>> import numpy as np
        >>> import silverball.envs
        >>> envs = gym.make_vec("silverball/PinBallDomain-v1", num_envs=100)
        >>> observations, infos = envs.reset(seed=7)
        >>> observations, rewards, *_ = envs.step(np.full(100, 4))  # no impulse
        >>> observations.shape, rewards[0]
        ((100, 4), np.float64(-1.0))
    """

    def __init__(
        self,
        num_envs: int = 1,
        board: str | os.PathLike[str] = "open",
        max_steps: int | None = MAX_STEPS,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.num_envs = checked_int("num_envs", num_envs, 1, 2**22)
        self.autoreset_mode = checked_mode(autoreset_mode)
        self.render_mode = checked_render_mode(render_mode, ("rgb_array",))
        self.metadata = {
            "render_modes": ["rgb_array"], "render_fps": TICK_RATE, "autoreset_mode": self.autoreset_mode,
        }  # fmt: skip
        threads = cores() if threads is None else checked_int("threads", threads, 1, 4096)
        mode = RESET_MODES[self.autoreset_mode]
        self._engine = DomainEngine(board, max_steps, self.num_envs, mode, threads)
        self.single_observation_space = observation_space_of_domain()
        self.single_action_space = spaces.Discrete(len(Push))
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._viewer: Viewer | None = None

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: Environment i gets seed + i, or the i-th seed of a list. None continues the current seed.
            options: ``{"reset_mask": mask}``, bool [env], begins episodes only in these environments.

        Returns:
            The observations, and `infos` with the steps so far and whether balls are in the target.

        Raises:
            ValueError: The mask or the list of seeds has the wrong length, the mask is empty, a seed is not
                an integer ≥ 0, or an option is unknown.
            TypeError: The mask is not a boolean array.
        """
        given = checked_reset_options(options, ("reset_mask",))
        mask = checked_mask(given.get("reset_mask"), self.num_envs)
        seeds = seeds_of(seed, self.num_envs)
        super().reset(seed=int(seed) if isinstance(seed, (int, np.integer)) else None)
        draw_missing(seeds, mask & ~self._engine.has_begun, self.np_random)
        where = mask & (seeds >= 0)
        self._engine.seed(seeds[where], where)
        self._engine.reset(mask)
        return self._engine.observations, self._infos(mask)

    def step(
        self, actions: Any
    ) -> tuple[
        NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Give each ball an impulse, and let them roll for a step.

        Args:
            actions: int [env]; 0: to the right (+x), 1: down (+y), 2: to the left, 3: up, 4: none.

        Returns:
            Observations, rewards, terminations, truncations, each [env], and `infos`. With SAME_STEP also
            `final_obs` and `final_info` of episodes that have ended.

        Raises:
            ValueError: The actions have the wrong shape, or one is not one of these numbers.
            ResetNeeded: An episode is over and was not reset.
        """
        engine, arena = self._engine, self._engine.arena
        given = np.asarray(actions)
        if given.shape != (self.num_envs,) or given.dtype.kind not in "iu":
            raise ValueError(
                f"actions must be integers of the shape ({self.num_envs},), got {given.dtype} {given.shape}"
            )
        lowest, highest = given.min(), given.max()
        if lowest < 0 or highest >= len(Push):
            raise ValueError(f"every action must be from 0 to {len(Push) - 1}, got {lowest} to {highest}")
        if self.autoreset_mode is AutoresetMode.DISABLED or not engine.has_begun.all():
            refuse_ended(arena.episodes["over"])
        arena.actions[:] = given
        before = self._infos(None)
        engine.step()
        infos = self._infos(None)
        _, terminated, truncated, ended = arena.masks.copy()
        if self.autoreset_mode is AutoresetMode.SAME_STEP and ended.any():
            final = np.full(self.num_envs, None, object)
            for row in np.flatnonzero(ended):
                final[row] = arena.observations[1, row].copy()
            steps = np.where(ended, before["steps"] + 1, 0)
            infos["final_obs"], infos["_final_obs"] = final, ended
            infos["final_info"] = {
                "steps": steps, "_steps": ended.copy(),
                "in_target": terminated.copy(), "_in_target": ended.copy(),
            }  # fmt: skip
            infos["_final_info"] = ended.copy()
        return engine.observations, arena.rewards.copy(), terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """All boards as the game draws them, RGB [row, column, 3] each; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._viewer is None:
            self._viewer = Viewer(self._engine.batch, size=SIZE)
        return tuple(self._viewer.picture(index) for index in range(self.num_envs))

    def save_state(self, index: int) -> bytes:
        """Everything that determines what happens next in an environment, as a single one saves it."""
        return self._engine.save(checked_int("index", index, 0, self.num_envs - 1))

    def restore_state(self, state: bytes, index: int | None = None) -> None:
        """Restore a saved state into an environment, or into all of them; `observe` returns observations.

        Raises:
            StateError: It is not a state of an environment on the same board.
            ValueError: There is no such environment.
        """
        rows = range(self.num_envs) if index is None else [checked_int("index", index, 0, self.num_envs - 1)]
        for row in rows:
            self._engine.restore(state, row)

    def observe(self) -> NDArray[np.float32]:
        """The observations of the current states."""
        self._engine.observe()
        return self._engine.observations

    def _infos(self, mask: NDArray[np.bool_] | None) -> dict[str, Any]:
        """The steps of the episodes, and which balls are in the target."""
        episodes = self._engine.arena.episodes
        every = np.ones(self.num_envs, np.bool_) if mask is None else mask
        steps, in_target = np.where(every, episodes["steps"], 0), every & (episodes["in_target"] != 0)
        return {"steps": steps, "_steps": every.copy(), "in_target": in_target, "_in_target": every.copy()}
