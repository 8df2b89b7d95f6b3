"""Adapter for Stable-Baselines3: `SilverballVecEnv`, a `VecEnv` that steps many tables at once.

from stable_baselines3 import PPO
from silverball.envs.sb3 import SilverballVecEnv

PPO("MlpPolicy", SilverballVecEnv("silverball/PinballClassic-v0", 256)).learn(1_000_000)
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from silverball.envs.options import checked_reset_options, refuse_options
from silverball.envs.vector import PinballVectorEnv
from silverball.plain import plain

try:
    from stable_baselines3.common.vec_env import VecEnv
except ModuleNotFoundError:
    raise ModuleNotFoundError(
        "silverball.envs.sb3 needs Stable-Baselines3: install it with  pip install stable-baselines3"
    ) from None


class SilverballVecEnv(VecEnv):  # type: ignore[misc, unused-ignore]
    """Many pinball tables with the interface of Stable-Baselines3.

    An environment whose episode ends is reset in the same step. The `info` of the ended episode holds its
    last observation, how it ended, its return, length and counts of events; all other infos are empty.
    Pictures have the shapes of Stable-Baselines3's images: grey (stack, height, width), colour (3 × stack,
    height, width), or (height, width, 3) for a single one in colour.

    Args:
        env_id: The id of the environments, whose options hold unless others are given; or, as the only
            argument before `seed`, the number of environments with the default options.
        num_envs: The number of environments.
        seed: Seed of the first episodes: environment i gets seed + i; None: random.
        threads: How many threads a step may use; None: one for each core.
        render_mode: "rgb_array" or None.
        options: See `silverball.envs.options.OPTIONS`.

    Raises:
        TypeError: There is no number of environments, or two.
        ValueError: The id is not one of Silverball's.

    `set_options({"board": 12})`, or a list of such dicts, one for each environment, chooses the boards of the
    next `reset`.
    """

    def __init__(
        self,
        env_id: str | int | None = None,
        num_envs: int | None = None,
        seed: int | None = None,
        threads: int | None = None,
        render_mode: str | None = None,
        **options: Any,
    ) -> None:
        refuse_options(options, ("autoreset_mode",), "Stable-Baselines3 supports only SAME_STEP")
        env_id, num_envs = _id_and_number(env_id, num_envs)
        self.envs = _make(env_id, num_envs, {"threads": threads, "render_mode": render_mode, **options})
        self.render_mode = render_mode
        space: Any = self.envs.single_observation_space
        if self.envs.options.observation == "pixels":
            space = Box(0, 255, self._as_images(np.zeros((1, *space.shape), np.uint8)).shape[1:], np.uint8)
        super().__init__(num_envs, space, self.envs.single_action_space)
        self.metadata = self.envs.metadata
        self._first_seed = seed
        self._info = self.envs._engine.info
        self._returns, self._lengths = np.zeros(num_envs), np.zeros(num_envs, np.int64)
        self._actions: Any = None
        self._started = time.time()

    def reset(self) -> Any:
        """Begin an episode in every environment and return the observations."""
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
            {name: infos[name][number].item() for name in self._info} for number in range(self.num_envs)
        ]
        return self._as_images(observations)

    def step_async(self, actions: NDArray[Any]) -> None:
        """Store the actions of the next step."""
        self._actions = actions

    def step_wait(self) -> tuple[Any, NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        """Make the step.

        Returns:
            Observations, rewards float32 [env], which episodes ended [env], and a dict for each environment.
        """
        observations, rewards, terminated, truncated, vector_infos = self.envs.step(self._actions)
        self._returns += rewards
        self._lengths += 1
        ended = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for row in np.flatnonzero(ended):
            infos[row] = {
                "terminal_observation": self._as_image(vector_infos["final_obs"][row]),
                "TimeLimit.truncated": bool(truncated[row] and not terminated[row]),
                "episode": {
                    "r": float(self._returns[row]),
                    "l": int(self._lengths[row]),
                    "t": round(time.time() - self._started, 6),
                },
                **{name: vector_infos["final_info"][name][row].item() for name in self._info},
            }
        self._returns[ended], self._lengths[ended] = 0.0, 0
        return self._as_images(observations), rewards.astype(np.float32), ended, infos

    def close(self) -> None:
        """Do nothing: there are no resources to release."""
        self.envs.close()

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """All tables as the game draws them."""
        return self.envs.render() or [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of each of these environments; the spaces are those of one environment.

        Other attributes are those of the vector that they share.
        """
        owner = self if attr_name in ("observation_space", "action_space") else self.envs
        return [getattr(owner, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of the vector, for all environments.

        Raises:
            ValueError: The indices select only some of them.
        """
        if len(list(self._get_indices(indices))) < self.num_envs:
            raise ValueError(f"the environments share {attr_name!r}: set it for all of them, without indices")
        setattr(self.envs, attr_name, value)

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        """Call a method of the vector environment; its result for each of the selected environments.

        `save_state` and `restore_state` act on the selected ones; other methods act on all.

        Raises:
            ValueError: Another method is called for only some of the environments.
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
        """False for each: the environments have no wrappers."""
        return [False for _ in self._get_indices(indices)]

    def _as_images(self, observations: Any) -> Any:
        """Observations [env, …] in the shapes of Stable-Baselines3."""
        options = self.envs.options
        if options.observation != "pixels" or options.channels or options.rgb == (options.stack == 1):
            return observations
        if not options.rgb:
            return observations[:, None]
        count, stack, height, width, channels = observations.shape
        return np.moveaxis(observations, -1, 2).reshape(count, stack * channels, height, width)

    def _as_image(self, observation: Any) -> Any:
        return observation if isinstance(observation, dict) else self._as_images(observation[None])[0]

    def _get_indices(self, indices: Any) -> Iterable[int]:
        chosen: Iterable[int] = super()._get_indices(indices)
        return chosen


def _id_and_number(env_id: Any, num_envs: Any) -> tuple[str | None, Any]:
    """The arguments of `SilverballVecEnv`, of which the id may be left out."""
    if isinstance(env_id, str):
        if num_envs is None:
            raise TypeError(f"pass the number of environments too: SilverballVecEnv({env_id!r}, 256)")
        return env_id, num_envs
    if (env_id is None) == (num_envs is None):
        raise TypeError("pass SilverballVecEnv(id, number), or the number of environments alone")
    return None, num_envs if env_id is None else env_id


def _make(env_id: str | None, num_envs: int, options: dict[str, Any]) -> PinballVectorEnv:
    """The vector of an id, or with the default options."""
    if env_id is None:
        return PinballVectorEnv(num_envs, AutoresetMode.SAME_STEP, **options)
    module, _, name = env_id.rpartition(":")
    if module:
        importlib.import_module(module)
    if not str(gymnasium.spec(name).vector_entry_point).startswith("silverball."):
        raise ValueError(
            f"env_id must be the id of one of Silverball's pinball tables, got {plain(env_id)!r}"
        )
    mode = AutoresetMode.SAME_STEP
    made = gymnasium.make_vec(name, num_envs, "vector_entry_point", autoreset_mode=mode, **options).unwrapped
    if not isinstance(made, PinballVectorEnv):
        raise ValueError(f"{plain(env_id)} is not a pinball table, which this adapter is for")
    return made
