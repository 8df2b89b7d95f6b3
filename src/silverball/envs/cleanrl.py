"""Adapter for CleanRL and other scripts written for Gymnasium 0.29: such scripts see their returns.

    python ppo.py --env-id silverball.envs.cleanrl:cleanrl/PinballClassic-v1

Importing this module registers every id of Silverball a second time, with `cleanrl/` in front. Such scripts
read the return of an episode and its last observation from `infos["final_info"]` and
`infos["final_observation"]` of a vector. Gymnasium 1.0 and later give other things or none there: then the
scripts print no returns, and DQN fails at the first truncation (KeyError). Here a step that ends an episode
adds both to its info, in a form that `SyncVectorEnv` and `AsyncVectorEnv` pass on as Gymnasium 0.29 did.
"""

from __future__ import annotations

import time
from collections import UserDict
from typing import Any, SupportsFloat

import gymnasium

from silverball.envs import IDS

NAMESPACE = "cleanrl"


class TellsEpisodes(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Adds the return, length and last observation of an episode to the info of the step that ends it."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        super().__init__(env)
        self._return, self._length, self._started = 0.0, 0, time.perf_counter()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode."""
        self._return, self._length, self._started = 0.0, 0, time.perf_counter()
        return self.env.reset(seed=seed, options=options)

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Make a step; its info also has `final_info` and `final_observation` if it ends the episode."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._return += float(reward)
        self._length += 1
        if terminated or truncated:
            seconds = round(time.perf_counter() - self._started, 6)
            episode = {"r": self._return, "l": self._length, "t": seconds}
            # Gymnasium's vectors would take a dict apart into arrays.
            info["final_info"] = UserDict(info | {"episode": episode})
            info["final_observation"] = observation
        return observation, reward, terminated, truncated, info


def make(env_id: str, **options: Any) -> TellsEpisodes:
    """The environment of an id of Silverball, with these options, that tells its episodes."""
    return TellsEpisodes(gymnasium.make(env_id, **options))


for _id in IDS:
    _own = f"{NAMESPACE}/{_id.partition('/')[2]}"
    if _own not in gymnasium.registry:
        gymnasium.register(
            _own,
            entry_point="silverball.envs.cleanrl:make",
            kwargs={"env_id": _id},
            disable_env_checker=True,
            order_enforce=False,
        )
