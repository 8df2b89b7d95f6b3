"""Two agents with a paddle each: PettingZoo's interface."""

from __future__ import annotations

import importlib
import sys
import warnings

import gymnasium as gym
import numpy as np
import pytest

from silverball.errors import MissingExtra


def make(**options):
    pytest.importorskip("pettingzoo")
    from silverball.envs.two_agents import parallel_env

    return parallel_env(**options)


@pytest.mark.parametrize("options", [{}, {"observation": "dict", "balls": 2}], ids=str)
def test_pettingzoos_parallel_test_accepts_the_environment(options):
    env = make(**options)
    from pettingzoo.test import parallel_api_test

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(env, num_cycles=300)


def test_pettingzoos_seed_test_accepts_the_environment():
    make()
    from pettingzoo.test import parallel_seed_test

    from silverball.envs.two_agents import parallel_env

    parallel_seed_test(parallel_env)


def test_two_agents_play_what_one_plays_with_two_buttons():
    pair, alone = make(), gym.make("silverball/PinballClassic-v1")
    observations, _ = pair.reset(seed=4)
    row, _ = alone.reset(seed=4)
    rng, total = np.random.default_rng(0), 0.0
    while pair.agents:
        assert observations["left"].tolist() == observations["right"].tolist() == row.tolist()
        left, right = rng.integers(0, 2, 2)
        observations, rewards, terminations, truncations, infos = pair.step({"left": left, "right": right})
        row, reward, terminated, truncated, info = alone.step(left + 2 * right)
        assert rewards == {"left": reward, "right": reward}
        assert terminations == {"left": terminated, "right": terminated}
        assert truncations == {"left": truncated, "right": truncated}
        assert infos["left"] == infos["right"] == info
        total += reward
    assert terminated
    assert total > 0.0
    with pytest.raises(gym.error.ResetNeeded):
        pair.step({"left": 0, "right": 0})


def test_a_paddle_is_moved_by_its_agent_alone():
    env = make(sticky=0.0)
    observations, _ = env.reset(seed=0)
    for _ in range(3):
        observations, *_ = env.step({"left": 1, "right": 0})
    assert observations["left"][[10, 13]].tolist() == [1.0, 0.0], "the angles of both paddles"


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ({"left": 1}, r"'left' and 'right', got \['left'\]"),
        ({"left": 2, "right": 0}, r"of 'left' must be in Discrete\(2\), got 2"),
        ({"left": 0, "right": None}, "of 'right' must be in .*, got None"),
    ],
)
def test_wrong_actions_are_refused(actions, message):
    env = make()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        env.step(actions)


def test_a_third_button_is_refused():
    with pytest.raises(TypeError, match="'jitter': each agent has the button of its paddle"):
        make(jitter=True)


def test_without_pettingzoo_the_import_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "pettingzoo", None)
    monkeypatch.delitem(sys.modules, "silverball.envs.two_agents", raising=False)
    with pytest.raises(
        MissingExtra, match=r"two_agents needs an optional package: .*'silverball\[pettingzoo\]'"
    ):
        importlib.import_module("silverball.envs.two_agents")
