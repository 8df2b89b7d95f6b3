"""The vector environment for Stable-Baselines3, which has an interface of its own: `SilverballVecEnv`.

from stable_baselines3 import PPO
from silverball.envs.sb3 import SilverballVecEnv

PPO("MlpPolicy", SilverballVecEnv(256)).learn(1_000_000)
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from silverball.envs.options import checked_reset_options, refuse_options
from silverball.envs.spaces import INFO
from silverball.envs.vector import PinballVectorEnv

try:
    from stable_baselines3.common.vec_env import VecEnv
except ModuleNotFoundError:
    raise ModuleNotFoundError(
        "silverball.envs.sb3 needs Stable-Baselines3: install it with  pip install stable-baselines3"
    ) from None


class SilverballVecEnv(VecEnv):  # type: ignore[misc, unused-ignore]
    """Many pinball tables as Stable-Baselines3 wants them.

    An episode that ends begins anew in the same step. Its last observation, how it ended, its return, length
    and counts of events are in its `info`; the infos of all others are empty. Pictures are what
    Stable-Baselines3 knows as images: in grey (stack, height, width), in colour (3 × stack, height, width) or
    (height, width, 3) where only one is shown.

    Args:
        num_envs: How many.
        seed: Of the first episodes: environment i gets seed + i; None: random.
        threads: How many threads a step may use; None: one for each core.
        render_mode: "rgb_array" or None.
        options: See `silverball.envs.options.OPTIONS`.

    `set_options({"board": 12})`, or a list of such dicts, one for each environment, chooses the boards of the
    next `reset`.
    """

    def __init__(
        self,
        num_envs: int,
        seed: int | None = None,
        threads: int | None = None,
        render_mode: str | None = None,
        **options: Any,
    ) -> None:
        refuse_options(options, ("autoreset_mode",), "Stable-Baselines3 knows SAME_STEP alone")
        self.envs = PinballVectorEnv(
            num_envs, AutoresetMode.SAME_STEP, threads=threads, render_mode=render_mode, **options
        )
        self.render_mode = render_mode
        space: Any = self.envs.single_observation_space
        if self.envs.options.observation == "pixels":
            space = Box(0, 255, self._shown(np.zeros((1, *space.shape), np.uint8)).shape[1:], np.uint8)
        super().__init__(num_envs, space, self.envs.single_action_space)
        self.metadata = self.envs.metadata
        self._first_seed = seed
        self._returns, self._lengths = np.zeros(num_envs), np.zeros(num_envs, np.int64)
        self._actions: Any = None
        self._started = time.time()

    def reset(self) -> Any:
        """Begin an episode in every environment; its observations."""
        seeds = [seed for seed in self._seeds if seed is not None]
        seed: Any = seeds if len(seeds) == self.num_envs else self._first_seed
        given = [checked_reset_options(one, ("board",)) for one in self._options]
        boards: Any = [one.get("board") for one in given]
        chosen = {"board": boards} if any(board is not None for board in boards) else None
        observations, infos = self.envs.reset(seed=seed, options=chosen)
        self._first_seed = None
        self._reset_seeds()
        self._reset_options()
        self._returns[:], self._lengths[:] = 0.0, 0
        self.reset_infos = [
            {name: infos[name][number].item() for name in INFO} for number in range(self.num_envs)
        ]
        return self._shown(observations)

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take the actions of the next step."""
        self._actions = actions

    def step_wait(self) -> tuple[Any, NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        """Make the step: observations, rewards, which episodes ended, and a dict for each environment."""
        observations, rewards, terminated, truncated, infos = self.envs.step(self._actions)
        self._returns += rewards
        self._lengths += 1
        ended = terminated | truncated
        told: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for row in np.flatnonzero(ended):
            told[row] = {
                "terminal_observation": self._shown_one(infos["final_obs"][row]),
                "TimeLimit.truncated": bool(truncated[row] and not terminated[row]),
                "episode": {
                    "r": float(self._returns[row]),
                    "l": int(self._lengths[row]),
                    "t": round(time.time() - self._started, 6),
                },
                **{name: infos["final_info"][name][row].item() for name in INFO},
            }
        self._returns[ended], self._lengths[ended] = 0.0, 0
        return self._shown(observations), rewards.astype(np.float32), ended, told

    def close(self) -> None:
        """Nothing is open."""
        self.envs.close()

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """All tables as the window draws them."""
        return self.envs.render() or [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute, which all environments share."""
        return [getattr(self.envs, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute, which all environments share."""
        if len(list(self._get_indices(indices))) < self.num_envs:
            raise ValueError(f"the environments share {attr_name!r}: set it for all of them, without indices")
        setattr(self.envs, attr_name, value)

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        """Call a method of the vector environment; its result for each of the chosen environments.

        `save_state` and `restore_state` act on the chosen ones alone; others need all of them.
        """
        chosen = list(self._get_indices(indices))
        if method_name == "save_state":
            return [row.tobytes() for row in self.envs.save_state(chosen)]
        if method_name == "restore_state":
            named["index"] = chosen
        elif len(chosen) < self.num_envs:
            raise ValueError(f"{method_name!r} acts on all environments: call it without indices")
        return [getattr(self.envs, method_name)(*arguments, **named)] * len(chosen)

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """No environment is wrapped in anything."""
        return [False for _ in self._get_indices(indices)]

    def _shown(self, observations: Any) -> Any:
        """Observations [env, …] as Stable-Baselines3 wants them."""
        options = self.envs.options
        if options.observation != "pixels" or options.rgb == (options.stack == 1):
            return observations
        if not options.rgb:
            return observations[:, None]
        count, stack, height, width, channels = observations.shape
        return np.moveaxis(observations, -1, 2).reshape(count, stack * channels, height, width)

    def _shown_one(self, observation: Any) -> Any:
        return observation if isinstance(observation, dict) else self._shown(observation[None])[0]

    def _get_indices(self, indices: Any) -> Iterable[int]:
        chosen: Iterable[int] = super()._get_indices(indices)
        return chosen
