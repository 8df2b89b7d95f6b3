"""Shots for one agent: `PinballShotsEnv`, a `gymnasium.Env` with goals."""

from __future__ import annotations

from collections.abc import Sequence
from operator import index
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from silverball.envs.options import SEED_RANGE, checked_render_mode, checked_reset_options, checked_seed
from silverball.envs.shots.goal_rewards import GoalRewards
from silverball.envs.shots.shot_engine import LEFT_AND_RIGHT, ShotEngine
from silverball.envs.viewer import RendersOne, Viewer

ALL = np.ones(1, np.bool_)


class PinballShotsEnv(GoalRewards, RendersOne, gymnasium.Env[Any, Any]):
    """Hit the named part next; docs/environments.md describes it.

    Args:
        shots: The names of the parts that goals may name; None: those of the built-in table.
        render_mode: "human" (a window, at the speed of play), "rgb_array" or None.
        options: Those of `silverball.envs.options.OPTIONS` but for reward, stall, balls, create, observation,
            jitter, rules and lives; `table` must be a finished table.

    Raises:
        TypeError: An option is unknown.
        ValueError: An option has an invalid value, or a shot names no part.
        TableError: The table has problems, or there is no such table.

    Examples:
        >>> import gymnasium as gym
        >>> import silverball.envs
        >>> env = gym.make("silverball/PinballShots-v1")
        >>> observation, info = env.reset(seed=7, options={"goal": "heart"})
        >>> env.unwrapped.shots[int(observation["desired_goal"].argmax())]
        'heart'
        >>> observation, reward, terminated, truncated, info = env.step(3)
        >>> reward == env.unwrapped.compute_reward(
        ...     observation["achieved_goal"], observation["desired_goal"], info)
        True
    """

    def __init__(
        self, shots: Sequence[str] | None = None, render_mode: str | None = None, **options: Any
    ) -> None:
        self.render_mode = checked_render_mode(render_mode, ("human", "rgb_array"))
        self._given = {"shots": shots, **options}
        self._engine = ShotEngine(options, shots, 1, threads=1)
        self.metadata = {**self.metadata, "render_fps": self._engine.options.frames_per_second}
        self.observation_space, self.action_space = self._engine.spaces()

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 15}  # noqa: RUF012  (Gymnasium's own)

    @property
    def shots(self) -> tuple[str, ...]:
        """The names of the shots, in the order of a goal's slots."""
        return self._engine.names

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
        """Begin an episode: the first one of `seed`, or without it the next one of the current seed.

        Args:
            seed: Determines goals, starting places and everything random of the episodes that follow.
            options: ``{"goal": "heart"}`` sets the goal, by the name of a shot or its number.

        Raises:
            ValueError: The seed is not an integer ≥ 0, an option is unknown, or there is no such shot.
        """
        goal = self._engine.goal_number(checked_reset_options(options, ("goal",)).get("goal"))
        number = None if seed is None else checked_seed(seed)
        super().reset(seed=None if seed is None else int(seed))
        engine = self._engine.engine
        if number is not None:
            engine.seed(number)
        elif not engine.has_begun.all():
            engine.seed(self.np_random.integers(SEED_RANGE, dtype=np.uint64).astype(np.int64))
        self._engine.reset(ALL, np.array([goal]))
        self._show()
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[dict[str, NDArray[Any]], float, bool, bool, dict[str, Any]]:
        """Hold the action's buttons for one step.

        Args:
            action: 0: nothing, 1: left, 2: right, 3: both.

        Returns:
            Observation, reward, terminated (a shot is made, or the ball lost), truncated, and `info`.

        Raises:
            ResetNeeded: The episode is over, or has never begun.
            ValueError: The action is not one of these numbers.
        """
        try:
            number = index(action)
        except TypeError:
            number = -1
        if not 0 <= number < LEFT_AND_RIGHT:
            raise ValueError(f"action must be an integer from 0 to {LEFT_AND_RIGHT - 1}, got {action!r}")
        if self._engine.over[0]:
            raise gymnasium.error.ResetNeeded("the episode is over or has not begun: call reset before step")
        self._engine.engine.actions[0] = number
        terminated, truncated = self._engine.step()
        self._show()
        info = self._info()
        reward = 1.0 if info["is_success"] else 0.0
        return self._observation(), reward, bool(terminated[0]), bool(truncated[0]), info

    def _new_viewer(self) -> Viewer:
        return Viewer(self._engine.engine.batch)

    def save_state(self) -> bytes:
        """Everything that determines what happens next, for `restore_state` in this or another process."""
        return self._engine.save(0)

    def restore_state(self, state: bytes) -> dict[str, NDArray[Any]]:
        """Restore a saved state, bit for bit; returns its observation.

        Raises:
            StateError: It is not a state of an environment with the same options.
        """
        self._engine.restore(state, 0)
        return self._observation()

    def __reduce__(self) -> tuple[Any, ...]:
        """Make `copy` and `pickle` rebuild the environment."""
        kept = ("_np_random", "_np_random_seed", "action_space", "observation_space", "spec")
        attributes = {name: value for name, value in vars(self).items() if name in kept}
        return _rebuild_shots, (type(self), self.render_mode, self._given, self.save_state(), attributes)

    def _observation(self) -> dict[str, NDArray[Any]]:
        return {name: rows[0] for name, rows in self._engine.observations().items()}

    def _info(self) -> dict[str, Any]:
        return {name: values[0].item() for name, values in self._engine.infos().items()}

    def _show(self) -> None:
        if self.render_mode == "human":
            self.render()


def _rebuild_shots(
    make: type[PinballShotsEnv],
    render_mode: str | None,
    given: dict[str, Any],
    state: bytes,
    attributes: dict[str, Any],
) -> PinballShotsEnv:
    env = make(render_mode=render_mode, **given)
    env._engine.restore(state, 0)
    vars(env).update(attributes)
    return env
