"""Rewards by name, by weights of a step's terms, and by a callable."""

from __future__ import annotations

import copy
import math
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.envs.rewards import REWARDS, TERMS

CLASSIC = "silverball/PinballClassic-v0"
SHORT = {"table": "classic", "balls": 2, "time_limit": 3.0}
ALL = {name: 10.0**-place for place, name in enumerate(TERMS)}
MODES = tuple(AutoresetMode)


def shaped(terms):
    """A reward that weights cannot express; works with floats and with arrays."""
    return 0.01 * terms["points"] - 2.0 * terms["drained"] ** 2 + 0.5 * np.sqrt(terms["wall_hits"]) - 0.001


class Scaled:
    """A callable object with state."""

    def __init__(self, factor):
        self.factor = factor

    def __call__(self, terms):
        return self.factor * shaped(terms)


def rewards_of(reward, steps=4000, **options):
    """The rewards of random play, and the infos before and after each step."""
    env = PinballEnv(
        **{**SHORT, "table": "random", "boards": 3, "time_limit": 30.0, **options}, reward=reward
    )
    _, info = env.reset(seed=4)
    random, seen = np.random.default_rng(3), []
    for _ in range(steps):
        _, value, terminated, truncated, after = env.step(int(random.integers(4)))
        seen.append((value, info, after))
        info = env.reset()[1] if terminated or truncated else after
    return seen


@pytest.mark.parametrize("name", REWARDS)
def test_a_named_reward_is_its_weights_bit_for_bit(name):
    named, weighed = rewards_of(name), rewards_of(REWARDS[name])
    assert [value for value, _, _ in named] == [value for value, _, _ in weighed]
    assert len({value for value, _, _ in named}) > 1


@pytest.mark.parametrize("term", TERMS)
def test_a_term_is_what_it_says(term):
    """The growth of a count is the difference of two infos; the others follow from their definitions."""
    seen = rewards_of({term: 2.0}, stall=5.0)
    expected = {
        "points": lambda before, after: after["score"] - before["score"],
        # A ball that comes by itself after another has drained was not there at the end of the tick.
        "seconds": lambda before, after: (before["created"] > after["drained"]) / 60,
        "stalled": lambda before, after: after["stalled"],
    }.get(term, lambda before, after: after[term] - before[term])
    assert [value for value, _, _ in seen] == [2.0 * expected(before, after) for _, before, after in seen]
    occurs = term not in ("ball_hits", "touches", "jams")  # these are rare, or need two balls
    assert not occurs or any(value != 0 for value, _, _ in seen)


@pytest.mark.parametrize("reward", [ALL, shaped], ids=["weights", "callable"])
@pytest.mark.parametrize("mode", MODES)
def test_a_vector_rewards_as_single_environments_do(mode, reward):
    options = {"table": "random", "boards": 3, "balls": 2, "time_limit": 6.0, "reward": reward}
    native = PinballVectorEnv(4, mode, **options)
    singles = SyncVectorEnv([lambda: PinballEnv(**options)] * 4, autoreset_mode=mode)
    native.reset(seed=1)
    singles.reset(seed=1)
    random, rewards = np.random.default_rng(0), []
    for _ in range(1200):
        actions = random.integers(0, 4, 4)
        mine, theirs = native.step(actions), singles.step(actions)
        assert mine[1].dtype == np.float64
        assert mine[1].tolist() == theirs[1].tolist()
        rewards.append(mine[1])
        over = mine[2] | mine[3]
        if mode is AutoresetMode.DISABLED and over.any():
            native.reset(options={"reset_mask": over})
            singles.reset(options={"reset_mask": over.copy()})
    assert len(np.unique(rewards)) > 3


def test_threads_do_not_change_a_weighed_reward(monkeypatch):
    monkeypatch.setattr("silverball.envs.engine.MIN_SLICE_WORK", 1)
    actions = np.random.default_rng(0).integers(0, 4, (200, 150))

    def rewards(threads):
        envs = PinballVectorEnv(150, threads=threads, reward=ALL, **SHORT)
        envs.reset(seed=0)
        return [envs.step(row)[1].tolist() for row in actions]

    assert rewards(1) == rewards(3)


def test_a_callable_can_keep_its_arrays():
    kept = []
    envs = PinballVectorEnv(3, reward=lambda terms: kept.append(terms) or terms["seconds"], **SHORT)
    envs.reset(seed=0)
    rewards = [envs.step(np.zeros(3, int))[1] for _ in range(20)]
    assert [terms["seconds"].tolist() for terms in kept] == [row.tolist() for row in rewards]
    assert set(kept[0]) == set(TERMS)


@pytest.mark.parametrize("reward", [ALL, shaped, Scaled(3.0)])
@pytest.mark.parametrize("again", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_rewards_as_its_original_does(again, reward):
    for make in (PinballEnv, lambda **options: PinballVectorEnv(2, **options)):
        env = make(reward=reward, **SHORT)
        env.reset(seed=2)
        twin = again(env)
        for _ in range(100):
            action = env.action_space.sample()
            assert np.array_equal(env.step(action)[1], twin.step(action)[1])


def test_weights_that_are_changed_afterwards_change_nothing():
    weights = {"seconds": 1.0}
    env = PinballEnv(reward=weights, **SHORT)
    weights["seconds"] = 5.0
    env.reset(seed=0)
    assert copy.deepcopy(env).step(0)[1] == env.step(0)[1] == 1 / 60


@pytest.mark.parametrize("reward", [{"points": 1, "drained": np.float32(-1)}, shaped, f"{__name__}:shaped"])
def test_a_spec_with_a_reward_goes_through_json(reward):
    env = gym.make(CLASSIC, reward=reward)
    spec = gym.envs.registration.EnvSpec.from_json(env.spec.to_json())
    twins = gym.make(spec), gym.make(env.spec), gym.make_vec(CLASSIC, 1, reward=reward)
    for one in (env, *twins):
        one.reset(seed=3)
    for _ in range(60):
        value = env.step(2)[1]
        assert [float(np.squeeze(twin.step([2] if twin is twins[2] else 2)[1])) for twin in twins] == [
            value
        ] * 3


@pytest.mark.parametrize("reward", [lambda terms: terms["points"], Scaled(1.0)])
def test_a_callable_that_cannot_be_imported_makes_an_environment_again_but_no_json(reward):
    for env in (gym.make(CLASSIC, reward=reward), gym.make_vec(CLASSIC, 2, reward=reward)):
        with pytest.raises(ValueError, match="reward is a callable that cannot be imported; use a function"):
            env.spec.to_json()
    gym.make(gym.make(CLASSIC, reward=reward).spec).reset(seed=0)


@pytest.mark.parametrize(
    ("reward", "message"),
    [
        ("points", "reward must be 'score' or 'time', weights"),
        (None, "got None"),
        (7, "got 7"),
        ({}, "at least one"),
        ({"drain": -1.0}, "unknown term 'drain'; did you mean 'drained'"),
        ({3: 1.0}, "unknown term 3"),
        ({"points": "1"}, "weight of 'points' must be a finite number, got '1'"),
        ({"points": True}, "finite number, got True"),
        ({"points": math.nan}, "finite number, got nan"),
        ("no_such_module:f", "'no_such_module:f' cannot be imported"),
        ("math:no_such_name", "cannot be imported"),
        (":f", "cannot be imported"),
        ("math:pi", "must lead to a callable, got float"),
    ],
)
def test_what_is_not_a_reward_is_refused(reward, message):
    for make in (PinballEnv, PinballVectorEnv):
        with pytest.raises(ValueError, match=message):
            make(reward=reward, table="classic")


@pytest.mark.parametrize("value", [None, "1", math.nan, math.inf, [1.0, 2.0]])
def test_a_single_callable_must_return_a_finite_number(value):
    env = PinballEnv(reward=lambda terms: value, **SHORT)
    env.reset(seed=0)
    if value == "1":
        assert env.step(0)[1] == 1.0
        return
    with pytest.raises(ValueError, match="reward callable must return a finite number"):
        env.step(0)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (None, "must return the shape|must return numbers"),
        (1.0, r"shape \(2,\), got \(\)"),
        (np.zeros(3), r"got \(3,\)"),
        (["a", "b"], "must return numbers"),
        ([0.0, math.nan], "finite numbers, got nan"),
    ],
)
def test_a_vectors_callable_must_return_a_finite_number_for_each(value, message):
    envs = PinballVectorEnv(2, reward=lambda terms: value, **SHORT)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        envs.step(np.zeros(2, int))
