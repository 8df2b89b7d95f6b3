"""Gymnasium's wrappers work with every environment."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import wrappers
from gymnasium.wrappers import vector as vectors

from silverball.envs import IDS

CLASSIC = "silverball/PinballClassic-v0"
FEW = {"boards": 4}


def options_of(id_: str) -> dict:
    return {} if id_ == CLASSIC else FEW


WRAPPERS = {
    "time_aware": wrappers.TimeAwareObservation,
    "statistics": wrappers.RecordEpisodeStatistics,
    "stack": lambda env: wrappers.FrameStackObservation(env, 3),
    "normalize": wrappers.NormalizeObservation,
    "normalize_reward": wrappers.NormalizeReward,
    "sticky": lambda env: wrappers.StickyAction(env, 0.25),
    "limit": lambda env: wrappers.TimeLimit(env, 30),
    "flatten": wrappers.FlattenObservation,
    "rescale": lambda env: wrappers.RescaleObservation(env, np.float32(0), np.float32(1)),
    "reward": lambda env: wrappers.TransformReward(env, np.sign),
    "clip": lambda env: wrappers.ClipReward(env, -1, 1),
    "delay": lambda env: wrappers.DelayObservation(env, 2),
    "max_skip": lambda env: wrappers.MaxAndSkipObservation(env, 4),
    "autoreset": wrappers.Autoreset,
    "order": wrappers.OrderEnforcing,
    "checker": wrappers.PassiveEnvChecker,
    "dtype": lambda env: wrappers.DtypeObservation(env, np.float64),
    "reshape": lambda env: wrappers.ReshapeObservation(env, (1, *env.observation_space.shape)),
    "see_itself": wrappers.AddRenderObservation,
    "gray": lambda env: wrappers.GrayscaleObservation(wrappers.AddRenderObservation(env)),
    "collect": wrappers.RenderCollection,
}
VECTORS = {
    "statistics": vectors.RecordEpisodeStatistics,
    "normalize": vectors.NormalizeObservation,
    "normalize_reward": vectors.NormalizeReward,
    "flatten": vectors.FlattenObservation,
    "rescale": lambda envs: vectors.RescaleObservation(envs, np.float32(0), np.float32(1)),
    "reward": lambda envs: vectors.TransformReward(envs, np.sign),
    "clip": lambda envs: vectors.ClipReward(envs, -1, 1),
    "dtype": lambda envs: vectors.DtypeObservation(envs, np.float64),
    "infos": vectors.DictInfoToList,
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("wrap", WRAPPERS.values(), ids=WRAPPERS)
@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_wrappers_go_around_every_environment(id_, wrap):
    env = wrap(gym.make(id_, render_mode="rgb_array", **options_of(id_)))
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    for _ in range(20):
        observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        assert np.isfinite(reward)
        if terminated or truncated:
            env.reset()


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("wrap", VECTORS.values(), ids=VECTORS)
@pytest.mark.parametrize("actions", ["discrete", "multibinary"])
@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_wrappers_go_around_every_vector(id_, actions, wrap):
    envs = wrap(gym.make_vec(id_, 3, actions=actions, time_limit=0.2, **options_of(id_)))
    observations, _ = envs.reset(seed=0)
    assert envs.observation_space.contains(observations)
    for _ in range(20):
        observations, rewards, *_ = envs.step(envs.action_space.sample())
        assert envs.observation_space.contains(observations)
        assert np.isfinite(rewards).all()
