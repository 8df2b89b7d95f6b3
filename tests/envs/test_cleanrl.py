"""Scripts for Gymnasium 0.29, such as CleanRL's, find returns and last observations where they look."""

from __future__ import annotations

import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import silverball.envs.cleanrl  # noqa: F401  (registers the ids)
from silverball.envs import IDS

ID = "cleanrl/PinballClassic-v1"
ENVS = 3


def vector(kind, **options):
    """A vector as such scripts make it, with a wrapper around each environment."""

    def one():
        return gym.wrappers.RecordEpisodeStatistics(gym.make(ID, **options))

    return kind([one] * ENVS)


@pytest.mark.parametrize("id_", [name.replace("silverball/", "cleanrl/") for name in IDS])
def test_every_id_is_there_and_passes_gymnasiums_checker(id_):
    env = gym.make(id_, **({} if "Classic" in id_ or "Missions" in id_ else {"boards": 2}))
    check_env(env.unwrapped, skip_render_check=True)
    assert env.spec.id == id_
    assert env.spec.max_episode_steps == env.unwrapped.options.max_steps


@pytest.mark.parametrize("kind", [gym.vector.SyncVectorEnv, gym.vector.AsyncVectorEnv])
def test_the_ends_of_episodes_are_told_as_by_gymnasium_0_29(kind):
    envs = vector(kind, time_limit=8.0)
    envs.reset(seed=4)
    returns, lengths = np.zeros(ENVS), np.zeros(ENVS, int)
    told, truncations = 0, 0
    for step in range(500):
        next_observations, rewards, terminated, truncated, infos = envs.step(np.full(ENVS, step % 4))
        returns += rewards
        lengths += 1
        seen = [None] * ENVS
        if "final_info" in infos:
            seen = list(infos["final_info"])
        for row in range(ENVS):
            info = seen[row]
            if not (terminated[row] or truncated[row]):
                assert not info
                continue
            assert info
            assert "episode" in info
            assert info["episode"]["r"] == pytest.approx(returns[row])
            assert info["episode"]["l"] in (lengths[row], lengths[row] - 1)  # the first step resets
            assert (infos["final_observation"][row] == next_observations[row]).all()
            truncations += truncated[row]
            told += 1
            returns[row], lengths[row] = 0.0, 0
    assert told > truncations > 0
    envs.close()


def test_options_and_the_plain_id_are_kept():
    told, plain = gym.make(ID, frame_skip=2), gym.make("silverball/PinballClassic-v1", frame_skip=2)
    assert told.unwrapped.options == plain.unwrapped.options
    assert told.reset(seed=1)[0].tolist() == plain.reset(seed=1)[0].tolist()
    for _ in range(50):
        one, other = told.step(3), plain.step(3)
        assert one[0].tolist() == other[0].tolist()
        assert one[1:4] == other[1:4]
        if one[2]:
            break
        assert one[4] == other[4]


def test_a_script_that_knows_only_the_name_can_make_it():
    name = "silverball.envs.cleanrl:" + ID
    program = f"import gymnasium; print(gymnasium.make({name!r}).reset(seed=0)[0].shape)"
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    shape = gym.make("silverball/PinballClassic-v1").observation_space.shape
    assert told.stdout.strip() == str(shape)
