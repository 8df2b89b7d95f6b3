"""Many environments of shots stepped together: `PinballShotsVectorEnv`.

Environment i equals, bit for bit, the single environment with the seed of environment i.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from silverball.envs.options import checked_render_mode, checked_reset_options
from silverball.envs.shots.goal_rewards import GoalRewards
from silverball.envs.shots.shot_engine import LEFT_AND_RIGHT, ShotEngine
from silverball.envs.vector_arguments import checked_mask, checked_mode, draw_missing, refuse_ended, seeds_of
from silverball.envs.viewer import Viewer
from silverball.world.arguments import checked_int
from silverball.world.threads import cores


class PinballShotsVectorEnv(GoalRewards, VectorEnv[Any, Any, NDArray[Any]]):
    """Many tables, each with a goal of its own, that step together.

    Args:
        num_envs: The number of environments.
        shots: The names of the parts that goals may name; None: those of the built-in table.
        autoreset_mode: When an environment begins its next episode: `AutoresetMode.NEXT_STEP`, `SAME_STEP` or
            `DISABLED`, or their names or values as text.
        threads: How many threads a step may use; None: one for each core. Results do not depend on it.
        render_mode: "rgb_array" or None.
        options: As of `PinballShotsEnv`.

    Raises:
        TypeError: An option is unknown.
        ValueError: An option has an invalid value, or a shot names no part.
        TableError: The table has problems, or there is no such table.

    Examples:
        >>> import gymnasium as gym
        >>> import numpy as np
        >>> import silverball.envs
        >>> envs = gym.make_vec("silverball/PinballShots-v1", num_envs=100)
        >>> observations, infos = envs.reset(seed=7)
        >>> observations["desired_goal"].shape
        (100, 8)
    """

    def __init__(
        self,
        num_envs: int = 1,
        shots: Sequence[str] | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: str | None = None,
        **options: Any,
    ) -> None:
        self.num_envs = checked_int("num_envs", num_envs, 1, 2**22)
        self.autoreset_mode = checked_mode(autoreset_mode)
        self.render_mode = checked_render_mode(render_mode, ("rgb_array",))
        threads = cores() if threads is None else checked_int("threads", threads, 1, 4096)
        self._engine = ShotEngine(options, shots, self.num_envs, threads)
        self.metadata = {
            "render_modes": ["rgb_array"], "render_fps": self._engine.options.frames_per_second,
            "autoreset_mode": self.autoreset_mode,
        }  # fmt: skip
        self.single_observation_space, self.single_action_space = self._engine.spaces()
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._drawn = np.full(self.num_envs, -1, np.int64)
        self._viewer: Viewer | None = None

    @property
    def shots(self) -> tuple[str, ...]:
        """The names of the shots, in the order of a goal's slots."""
        return self._engine.names

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: Environment i gets seed + i, or the i-th seed of a list. None continues the current seed.
            options: ``{"reset_mask": mask}``, bool [env], begins episodes only in these environments;
                ``{"goal": "heart"}`` sets the goal, or a list with one for each, None for a drawn one.

        Raises:
            ValueError: The mask or a list has the wrong length, the mask is empty, a seed is not an
                integer ≥ 0, there is no such shot, or an option is unknown.
            TypeError: The mask is not a boolean array.
        """
        given = checked_reset_options(options, ("reset_mask", "goal"))
        mask, engine = checked_mask(given.get("reset_mask"), self.num_envs), self._engine.engine
        goals, seeds = self._goals(given.get("goal")), seeds_of(seed, self.num_envs)
        super().reset(seed=int(seed) if isinstance(seed, (int, np.integer)) else None)
        draw_missing(seeds, mask & ~engine.has_begun, self.np_random)
        where = mask & (seeds >= 0)
        engine.seed(seeds[where], where)
        self._engine.reset(mask, goals)
        return self._engine.observations(), self._infos(mask)

    def step(
        self, actions: Any
    ) -> tuple[
        dict[str, NDArray[Any]], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Hold each environment's buttons for one step.

        Args:
            actions: int [env]; 0: nothing, 1: left, 2: right, 3: both.

        Returns:
            Observations, rewards, terminations, truncations, each [env], and `infos`. With SAME_STEP also
            `final_obs` and `final_info` of episodes that have ended.

        Raises:
            ValueError: The actions have the wrong shape, or one is not one of these numbers.
            ResetNeeded: An episode is over and was not reset.
        """
        mode, was_over = self.autoreset_mode, self._engine.over != 0
        if mode is AutoresetMode.DISABLED or not self._engine.engine.has_begun.all():
            refuse_ended(self._engine.over)
        self._engine.engine.actions[:] = self._checked(actions)
        terminated, truncated = self._engine.step()
        ended, infos = terminated | truncated, self._infos(np.ones(self.num_envs, np.bool_))
        rewards = np.where(was_over, 0.0, infos["is_success"].astype(np.float64))
        if mode is AutoresetMode.NEXT_STEP and was_over.any():
            self._engine.reset(was_over, self._drawn)
            infos = self._infos(np.ones(self.num_envs, np.bool_))
        if mode is AutoresetMode.SAME_STEP and ended.any():
            last, final = self._engine.observations(), np.full(self.num_envs, None, object)
            for row in np.flatnonzero(ended):
                final[row] = {name: rows[row] for name, rows in last.items()}
            final_info = self._infos(ended)
            self._engine.reset(ended, self._drawn)
            infos = self._infos(np.ones(self.num_envs, np.bool_))
            infos["final_obs"], infos["_final_obs"] = final, ended
            infos["final_info"], infos["_final_info"] = final_info, ended.copy()
        return self._engine.observations(), rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """All tables as the game draws them, RGB [row, column, 3] each; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._viewer is None:
            self._viewer = Viewer(self._engine.engine.batch)
        return tuple(self._viewer.picture(index) for index in range(self.num_envs))

    def save_state(self, index: int) -> bytes:
        """Everything that determines what happens next in an environment, as a single one saves it."""
        return self._engine.save(checked_int("index", index, 0, self.num_envs - 1))

    def restore_state(self, state: bytes, index: int) -> dict[str, NDArray[Any]]:
        """Restore a saved state into an environment; returns the observations.

        Raises:
            StateError: It is not a state of an environment with the same options.
            ValueError: There is no such environment.
        """
        self._engine.restore(state, checked_int("index", index, 0, self.num_envs - 1))
        return self._engine.observations()

    def _checked(self, actions: Any) -> NDArray[Any]:
        given = np.asarray(actions)
        if given.shape != (self.num_envs,) or given.dtype.kind not in "iu":
            raise ValueError(
                f"actions must be integers of the shape ({self.num_envs},), got {given.dtype} {given.shape}"
            )
        lowest, highest = given.min(), given.max()
        if lowest < 0 or highest >= LEFT_AND_RIGHT:
            raise ValueError(
                f"every action must be from 0 to {LEFT_AND_RIGHT - 1}, got {lowest} to {highest}"
            )
        return given

    def _goals(self, goal: Any) -> NDArray[np.int64]:
        """The goals of the next episodes, int64 [env]; −1: drawn."""
        each = list(goal) if isinstance(goal, (list, tuple, np.ndarray)) else [goal] * self.num_envs
        if len(each) != self.num_envs:
            raise ValueError(f"goal must be one shot or {self.num_envs} of them, got {len(each)}")
        return np.array([self._engine.goal_number(one) for one in each], np.int64)

    def _infos(self, mask: NDArray[np.bool_]) -> dict[str, Any]:
        """The infos of the masked environments, with Gymnasium's masks."""
        infos: dict[str, Any] = {}
        for name, values in self._engine.infos().items():
            infos[name], infos[f"_{name}"] = np.where(mask, values, 0).astype(values.dtype), mask.copy()
        return infos
