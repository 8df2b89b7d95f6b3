"""TorchRL makes the environments by their names."""

from __future__ import annotations

import pytest

pytest.importorskip("torchrl", reason="TorchRL is not installed")

from torchrl.envs import GymEnv
from torchrl.envs.utils import check_env_specs

from silverball.envs import IDS


@pytest.mark.parametrize(
    "options", [{}, {"frame_skip": 4}, {"actions": "multibinary"}, {"observation": "dict"}], ids=str
)
@pytest.mark.parametrize("id_", IDS)
def test_its_checker_accepts_the_environment(id_, options):
    env = GymEnv(id_, **options, **({} if "Classic" in id_ else {"boards": 2}))
    check_env_specs(env)
    assert env.rollout(20).batch_size == (20,)
