"""The adapter for PufferLib, and that it writes into PufferLib's buffers."""

from __future__ import annotations

import contextlib
import tempfile

import numpy as np
import pytest

# PufferLib leaves a link named "resources" in the folder in which it is imported first.
with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
    pufferlib = pytest.importorskip("pufferlib", reason="PufferLib is not installed")
    pytest.importorskip("pufferlib.vector", reason="PufferLib is not complete")

from silverball.envs import PinballVectorEnv
from silverball.envs.puffer import SilverballPufferEnv

OPTIONS = {"table": "classic", "time_limit": 1.0}


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"reward": {"seconds": 2.0, "drained": -1.0}},
        {"observation": "pixels", "stack": 1},
        {"observation": "pixels", "stack": 2},
    ],
    ids=str,
)
def test_steps_are_those_of_the_vector_environment(more):
    envs = SilverballPufferEnv(3, seed=5, **OPTIONS, **more)
    plain = PinballVectorEnv(3, "SameStep", **OPTIONS, **more)
    assert envs.reset()[0].tolist() == plain.reset(seed=5 * 3)[0].tolist()
    told = []
    for actions in np.random.default_rng(0).integers(0, 4, (150, 3)):
        observations, rewards, terminals, truncations, infos = envs.step(actions)
        expected, gained, terminated, truncated, _ = plain.step(actions)
        assert observations is envs.observations
        assert observations.tolist() == expected.tolist()
        assert rewards.tolist() == gained.astype(np.float32).tolist()
        assert (terminals.tolist(), truncations.tolist()) == (terminated.tolist(), truncated.tolist())
        told += infos
    assert told
    assert all(info["episode_length"] <= 60 for info in told)


def test_its_vectors_run_them_side_by_side():
    envs = pufferlib.vector.make(
        SilverballPufferEnv,
        env_kwargs={"num_envs": 4, **OPTIONS},
        num_envs=3,
        backend=pufferlib.vector.Serial,
    )
    for seed in (0, 1):
        first, *_ = envs.reset(seed=seed)
        assert len({tuple(row) for row in first.tolist()}) == 12, "no two play the same"
    observations, *_ = envs.step(np.zeros(12, np.int32))
    assert observations.shape == (12, 63)
    envs.close()


@pytest.mark.parametrize(
    ("name", "hint"), [("frameskip", "frame_skip"), ("zero_copy", "always"), ("autoreset_mode", "always")]
)
def test_an_unknown_option_is_an_unexpected_keyword_argument(name, hint):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'.*{hint}"):
        SilverballPufferEnv(2, table="classic", **{name: 4})
