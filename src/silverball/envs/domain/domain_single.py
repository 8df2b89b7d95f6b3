"""The PinBall domain for one agent: `PinBallDomainEnv`, a `gymnasium.Env`."""

from __future__ import annotations

import os
from operator import index
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.domain.arena import DomainEngine
from silverball.envs.domain.board_table import SPEED_LIMIT, TICK_RATE
from silverball.envs.domain.impulses import Push
from silverball.envs.options import SEED_RANGE, checked_render_mode, checked_reset_options, checked_seed
from silverball.envs.state import ResetMode
from silverball.envs.viewer import RendersOne, Viewer

SIZE = (480, 460)  # [pixel] width and height of a picture
MAX_STEPS = 10_000
"""The steps after which an episode is truncated by default. Source: chosen; the papers have no limit."""


def observation_space_of_domain() -> Any:
    """The space of x and y, 0 to 1, and their velocities.

    A bounce may turn a diagonal velocity into one component, so these reach √2 times the limit.
    """
    fastest = np.nextafter(np.float32(SPEED_LIMIT * 2.0**0.5), np.float32(9.0))  # not rounded downwards
    low, high = np.array([0.0, 0.0, -fastest, -fastest]), np.array([1.0, 1.0, fastest, fastest])
    return spaces.Box(low.astype(np.float32), high.astype(np.float32))


class PinBallDomainEnv(RendersOne, gymnasium.Env[NDArray[np.float32], np.int64]):
    """The PinBall domain of Konidaris and Barto; docs/environments.md describes it.

    Args:
        board: The name of a built-in board, or the path of a `.cfg` file.
        max_steps: The steps after which an episode is truncated; None: never.
        render_mode: "human" (a window, at the speed of play), "rgb_array" or None.

    Raises:
        TableError: There is no such board, or it has problems.
        ValueError: The limit or the render mode is invalid.

    Examples:
        >>> import gymnasium as gym
        >>> import silverball.envs
        >>> env = gym.make("silverball/PinBallDomain-v1", board="open")
        >>> observation, info = env.reset(seed=0)
        >>> observation, reward, terminated, truncated, info = env.step(0)  # an impulse to the right
        >>> reward, round(float(observation[2]), 3)
        (-5.0, 0.199)
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": TICK_RATE}  # noqa: RUF012  (Gymnasium's own)

    def __init__(
        self,
        board: str | os.PathLike[str] = "open",
        max_steps: int | None = MAX_STEPS,
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode, ("human", "rgb_array"))
        self.board, self.max_steps = board, max_steps
        self._engine = DomainEngine(board, max_steps, 1, ResetMode.DISABLED, threads=1)
        self.observation_space = observation_space_of_domain()
        self.action_space = spaces.Discrete(len(Push))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode: the first one of `seed`, or without it the next one of the current seed.

        Args:
            seed: Determines the starts of the episodes that follow, where a board has several.
            options: None; there are no options.

        Returns:
            The observation, and `info` with the steps so far and whether the ball is in the target.

        Raises:
            ValueError: The seed is not an integer ≥ 0, or an option is given.
        """
        checked_reset_options(options, ())
        number = None if seed is None else checked_seed(seed)
        super().reset(seed=None if seed is None else int(seed))
        if number is not None:
            self._engine.seed(number)
        elif not self._engine.has_begun.all():
            self._engine.seed(self.np_random.integers(SEED_RANGE, dtype=np.uint64).astype(np.int64))
        self._engine.reset()
        self._show()
        return self._engine.observations[0], self._info()

    def step(self, action: Any) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Give the ball an impulse, and let it roll for a step.

        Args:
            action: 0: to the right (+x), 1: down (+y), 2: to the left, 3: up, 4: none.

        Returns:
            Observation, reward, terminated (the ball is in the target), truncated, and `info`.

        Raises:
            ResetNeeded: The episode is over, or has never begun.
            ValueError: The action is not one of these numbers.
        """
        arena = self._engine.arena
        try:
            number = index(action)
        except TypeError:
            number = -1
        if not 0 <= number < len(Push):
            raise ValueError(f"action must be an integer from 0 to {len(Push) - 1}, got {action!r}")
        if arena.episodes["over"][0]:
            raise gymnasium.error.ResetNeeded("the episode is over or has not begun: call reset before step")
        arena.actions[0] = number
        self._engine.step()
        self._show()
        _, terminated, truncated, _ = arena.masks[:, 0].tolist()
        return self._engine.observations[0], float(arena.rewards[0]), terminated, truncated, self._info()

    def _new_viewer(self) -> Viewer:
        return Viewer(self._engine.batch, size=SIZE)

    def get_action_meanings(self) -> list[str]:
        """The names of the actions in capitals."""
        return [push.name for push in Push]

    def save_state(self) -> bytes:
        """Everything that determines what happens next, for `restore_state` in this or another process."""
        return self._engine.save(0)

    def restore_state(self, state: bytes) -> None:
        """Restore a saved state, bit for bit; `observe` returns its observation.

        Raises:
            StateError: It is not a state of an environment on the same board.
        """
        self._engine.restore(state, 0)

    def observe(self) -> NDArray[np.float32]:
        """The observation of the current state, as a new array."""
        self._engine.observe()
        row: NDArray[np.float32] = self._engine.observations[0]
        return row

    def __reduce__(self) -> tuple[Any, ...]:
        """Make `copy` and `pickle` rebuild the environment."""
        kept = ("_np_random", "_np_random_seed", "action_space", "observation_space", "spec")
        attributes = {name: value for name, value in vars(self).items() if name in kept}
        arguments = (self.board, self.max_steps, self.render_mode)
        return _rebuild_domain, (type(self), arguments, self.save_state(), attributes)

    def _show(self) -> None:
        if self.render_mode == "human":
            self.render()

    def _info(self) -> dict[str, Any]:
        episode = self._engine.arena.episodes[0]
        return {"steps": int(episode["steps"]), "in_target": bool(episode["in_target"])}


def _rebuild_domain(
    make: type[PinBallDomainEnv], arguments: tuple[Any, ...], state: bytes, attributes: dict[str, Any]
) -> PinBallDomainEnv:
    env = make(*arguments)
    env.restore_state(state)
    vars(env).update(attributes)
    return env
