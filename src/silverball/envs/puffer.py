"""Adapter for PufferLib: `SilverballPufferEnv`, which writes directly into the trainer's buffers.

import pufferlib.vector
from silverball.envs.puffer import SilverballPufferEnv

envs = pufferlib.vector.make(SilverballPufferEnv, env_kwargs={"num_envs": 1024})
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from silverball.envs.options import refuse_options
from silverball.envs.vector import PinballVectorEnv

try:
    import pufferlib
except ModuleNotFoundError:
    raise ModuleNotFoundError(
        "silverball.envs.puffer needs PufferLib: install it with  pip install pufferlib"
    ) from None

Step = tuple[Any, NDArray[Any], NDArray[Any], NDArray[Any], list[dict[str, float]]]


class SilverballPufferEnv(pufferlib.PufferEnv):  # type: ignore[misc, unused-ignore]
    """Many pinball tables with the interface of PufferLib; the step that ends an episode resets it.

    Args:
        num_envs: The number of environments.
        buf: The trainer's buffers; None: new ones.
        seed: Seed of the first episodes: environment i gets seed × num_envs + i, so workers with
            consecutive seeds play different episodes.
        threads: How many threads a step may use; PufferLib's workers are processes, so one.
        options: See `silverball.envs.options.OPTIONS`; observations cannot be "dict".
    """

    def __init__(
        self, num_envs: int = 1, buf: Any = None, seed: int = 0, threads: int = 1, **options: Any
    ) -> None:
        if options.get("observation") == "dict" or options.get("actions") == "multibinary":
            raise ValueError("PufferLib needs observation='state' or 'pixels' and actions='discrete'")
        refuse_options(options, ("autoreset_mode", "zero_copy"), "the adapter sets it for PufferLib")
        self.envs = PinballVectorEnv(num_envs, AutoresetMode.SAME_STEP, True, threads, **options)
        self.single_observation_space = self.envs.single_observation_space
        self.single_action_space = self.envs.single_action_space
        self.num_agents = num_envs
        super().__init__(buf)
        self.seed = seed
        self._is_direct = self.envs.write_to(self.observations, self.terminals, self.truncations)
        self._returns, self._lengths = np.zeros(num_envs), np.zeros(num_envs, np.int64)

    def reset(self, seed: int | None = None) -> tuple[Any, list[dict[str, float]]]:
        """Begin an episode in every environment."""
        first = (self.seed if seed is None else seed) * self.envs.num_envs
        observations, _ = self.envs.reset(seed=first)
        if not self._is_direct:
            self.observations[:] = observations
        self.rewards[:], self.terminals[:], self.truncations[:] = 0.0, False, False
        self._returns[:], self._lengths[:] = 0.0, 0
        return self.observations, []

    def step(self, actions: NDArray[Any]) -> Step:
        """Make a step; if episodes ended in it, the only info holds their means."""
        observations, rewards, terminated, truncated, infos = self.envs.step(actions)
        self.actions[:] = actions
        self.rewards[:] = rewards
        if not self._is_direct:
            self.observations[:] = observations
            self.terminals[:], self.truncations[:] = terminated, truncated
        self._returns += rewards
        self._lengths += 1
        ended = terminated | truncated
        ended_infos: list[dict[str, float]] = []
        if ended.any():
            ended_infos.append(
                {
                    "episode_return": float(self._returns[ended].mean()),
                    "episode_length": float(self._lengths[ended].mean()),
                    "score": float(infos["final_info"]["score"][ended].mean()),
                }
            )
            self._returns[ended], self._lengths[ended] = 0.0, 0
        return self.observations, self.rewards, self.terminals, self.truncations, ended_infos

    def close(self) -> None:
        """Do nothing: there are no resources to release."""
        self.envs.close()
