"""An id gives what it gave when results on it were published: its table, boards, observations and rewards."""

from __future__ import annotations

import gymnasium as gym
import pytest

from envs.make_env_digests import REMEDY, of_one, read, runs
from silverball.envs import IDS

RECORDED = read()


def test_every_id_is_recorded():
    assert RECORDED.keys() == IDS.keys(), REMEDY


@pytest.mark.parametrize("id_", RECORDED)
def test_an_id_gives_what_it_gave(id_):
    assert runs(id_) == RECORDED[id_], REMEDY


def test_a_digest_notices_another_seed_reward_and_stall():
    id_ = "silverball/PinballClassic-v0"
    others = [
        of_one(gym.make(id_), seed=1),
        of_one(gym.make(id_, reward={"points": 0.02}), seed=0),
        of_one(gym.make(id_, stall=1.0), seed=0),
        of_one(gym.make(id_, balls=3), seed=0),
    ]
    assert len({RECORDED[id_]["defaults"], *others}) == 5
    assert of_one(gym.make(id_), seed=0) == RECORDED[id_]["defaults"]
