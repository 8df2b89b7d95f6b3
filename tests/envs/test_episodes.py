"""How episodes end, and their rewards."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballEnv, PinballVectorEnv

CLASSIC = "silverball/PinballClassic-v0"


def played(env, action=0, limit=100_000) -> tuple[list[float], bool, bool, dict]:
    """An episode of one action: rewards, terminated, truncated, the last info."""
    rewards = []
    for _ in range(limit):
        _, reward, terminated, truncated, info = env.step(action)
        rewards.append(reward)
        if terminated or truncated:
            return rewards, terminated, truncated, info
    raise AssertionError("the episode did not end")


def test_one_ball_ends_the_episode_in_the_gutter():
    env = gym.make(CLASSIC)
    env.reset(seed=1)
    _, terminated, truncated, info = played(env)
    assert (terminated, truncated) == (True, False)
    assert (info["created"], info["drained"], info["stalled"]) == (1, 1, False)


def test_a_game_of_three_ends_with_the_third_ball():
    env = gym.make(CLASSIC, balls=3)
    env.reset(seed=1)
    *_, info = played(env)
    assert (info["created"], info["drained"]) == (3, 3)


def test_the_score_is_the_sum_of_the_rewards_at_a_hundred_points_each():
    env = gym.make(CLASSIC, balls=3)
    for seed in range(5):
        env.reset(seed=seed)
        rewards, *_, info = played(env)
        assert sum(rewards) == pytest.approx(info["score"] / 100)
        assert info["score"] > 0


def test_ball_time_is_the_sum_of_the_rewards_in_seconds():
    env = gym.make(CLASSIC, reward="time")
    env.reset(seed=1)
    rewards, *_ = played(env)
    assert sum(rewards) == pytest.approx((len(rewards) - 1) / 60), (
        "the step that drains the ball is worth nothing"
    )


def test_a_longer_step_holds_the_buttons_for_more_ticks():
    env = gym.make(CLASSIC, frame_skip=4)
    env.reset(seed=1)
    env.step(0)
    assert env.unwrapped._engine.batch.state["tick"][0] == 4


def test_the_time_limit_truncates():
    env = gym.make(CLASSIC, time_limit=0.5)
    env.reset(seed=1)
    rewards, terminated, truncated, info = played(env)
    assert (len(rewards), terminated, truncated) == (30, False, True)
    assert not info["stalled"]


def test_holding_both_paddles_up_forever_ends_as_stalled():
    """On boards where the ball comes to lie on the paddles, it is over after the time to stall."""
    count, wait = 200, 15 * 60
    envs = PinballVectorEnv(count, "Disabled", table="classic", time_limit=None)
    envs.reset(seed=0)
    last_hit, stalls, ends = np.zeros(count, int), 0, 0
    for step in range(1, 3 * wait):
        _, rewards, terminated, truncated, infos = envs.step(np.full(count, 3))
        last_hit[rewards > 0] = step
        stalled = terminated & infos["stalled"]
        assert not truncated.any()
        assert (step - last_hit[stalled] == wait).all()
        assert (step - last_hit <= wait).all()
        stalls, ends = stalls + stalled.sum(), ends + terminated.sum()
        if terminated.any():
            envs.reset(options={"reset_mask": terminated})
            last_hit[terminated] = step
    assert ends > stalls > 0


def test_without_a_stall_the_same_balls_lie_there_until_the_time_limit():
    env = gym.make(CLASSIC, stall=None, time_limit=40.0)
    ends = set()
    for seed in range(30):
        env.reset(seed=seed)
        _, terminated, _, info = played(env, action=3)
        ends.add((terminated, info["stalled"]))
    assert ends == {(True, False), (False, False)}


def test_a_button_brings_the_balls_one_after_the_other_and_two_at_once():
    env = gym.make(CLASSIC, create="button", balls=3)
    observation, info = env.reset(seed=0)
    assert info["created"] == 0
    assert observation[0] == 0.0
    assert [env.step(4)[4]["created"] for _ in range(3)] == [1, 2, 2], "two at most are on the board"
    _rewards, terminated, _, info = played(env, action=4)
    assert terminated
    assert (info["created"], info["drained"]) == (3, 3)


def test_never_creating_a_ball_ends_as_stalled():
    env = gym.make(CLASSIC, create="button")
    env.reset(seed=0)
    rewards, terminated, _, info = played(env)
    assert (len(rewards), terminated, info["stalled"]) == (15 * 60, True, True)


def test_jitter_shoves_the_ball():
    quiet, shoved = gym.make(CLASSIC, jitter=True), gym.make(CLASSIC, jitter=True)
    quiet.reset(seed=0), shoved.reset(seed=0)
    assert quiet.step(0)[0].tolist() != shoved.step(4)[0].tolist()


def test_a_world_that_has_stopped_with_a_fault_is_truncated():
    env = PinballEnv(table="classic")
    env.reset(seed=0)
    env._engine.batch.state["ball"]["x"][0, 0] = np.nan
    assert env.step(0)[2:4] == (False, True)
