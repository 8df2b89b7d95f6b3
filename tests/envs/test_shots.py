"""Goal-conditioned shots: the conventions of goal environments, and what counts as a shot."""

from __future__ import annotations

import copy
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env

from silverball.envs.shots.targets import SHOTS, parts_of
from silverball.errors import StateError
from silverball.table import expand, load_table

ID = "silverball/PinballShots-v1"


def low(state: np.ndarray) -> np.ndarray:
    """Raise both paddles for a low, falling ball."""
    return np.where((state[..., 1] < -0.6) & (state[..., 3] < 0), 3, 0)


def episodes(env, count: int, seed: int = 0):
    """Play episodes of the low rule; yields the last step of each, and the goal."""
    for number in range(count):
        observation, _ = env.reset(seed=seed if number == 0 else None)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(int(low(observation["observation"])))
            over = terminated or truncated
        yield observation, reward, terminated, truncated, info


def test_gymnasiums_checker_accepts_the_environment():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(ID), skip_render_check=True)


def test_the_space_has_the_keys_of_goal_environments():
    """As Gymnasium-Robotics' GoalEnv demands on reset."""
    env = gym.make(ID)
    assert isinstance(env.observation_space, spaces.Dict)
    assert set(env.observation_space.spaces) == {"observation", "achieved_goal", "desired_goal"}
    goals = [env.observation_space[name] for name in ("achieved_goal", "desired_goal")]
    assert goals[0] == goals[1]
    assert goals[0].shape == (len(SHOTS["classic"]),)


def test_every_step_agrees_with_the_functions_of_goals():
    env = gym.make(ID, recharge=0.0).unwrapped
    seen = set()
    for number in range(40):
        observation, _ = env.reset(seed=number)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(int(low(observation["observation"])))
            achieved, desired = observation["achieved_goal"], observation["desired_goal"]
            assert reward == env.compute_reward(achieved, desired, info)
            assert terminated == env.compute_terminated(achieved, desired, info)
            assert truncated == env.compute_truncated(achieved, desired, info)
            assert info["is_success"] == (reward == 1.0)
            over = terminated or truncated
        seen.add((reward, info["lost"]))
    assert seen == {(0.0, True), (0.0, False), (1.0, False)}


def test_the_functions_take_many_goals_at_once():
    env = gym.make(ID).unwrapped
    achieved = np.eye(8)[[3, 4, 0]]
    achieved[2] = 0.0
    desired = np.eye(8)[[3, 3, 3]]
    infos = [{"lost": False, "out_of_time": late} for late in (False, False, True)]
    assert env.compute_reward(achieved, desired, infos).tolist() == [1.0, 0.0, 0.0]
    assert env.compute_terminated(achieved, desired, infos).tolist() == [True, True, False]
    assert env.compute_truncated(achieved, desired, infos).tolist() == [False, False, True]
    assert env.compute_reward(achieved, achieved, infos).tolist() == [1.0, 1.0, 0.0], "relabelled"


def test_a_shot_is_the_first_named_part_after_a_paddle():
    env = gym.make(ID, recharge=0.0).unwrapped
    engine = env._engine.engine
    names = expand(load_table("classic")).names
    shot_of, made = parts_of(load_table("classic"), env.shots), 0
    for number in range(30):
        observation, _ = env.reset(seed=number)
        hits, over = [], False
        while not over:
            observation, _, terminated, truncated, info = env.step(int(low(observation["observation"])))
            hits += [event for event in engine.batch.events(0) if event.kind in ("hit", "touch")]
            over = terminated or truncated
        paddles = [at for at, event in enumerate(hits) if event.part.startswith("paddle")]
        after = hits[paddles[0] :] if paddles else []
        shots = [shot_of[names.index(event.part)] for event in after if event.kind == "hit"]
        first = next((shot for shot in shots if shot >= 0), -1)
        assert info["shot"] == first
        assert info["struck"] == bool(paddles)
        made += first >= 0
    assert made >= 10


def test_every_episode_starts_with_a_ball_above_a_paddle_and_any_goal():
    envs = gym.make_vec(ID, 400)
    observations, _ = envs.reset(seed=1)
    state = observations["observation"]
    assert (state[:, 0] == 1.0).all()
    assert not state[:, 3:5].any()
    assert ((state[:, 1] * 10.0 > -6.5) & (state[:, 1] * 10.0 < -4.0)).all()
    assert 120 < (state[:, 2] > 0.0).sum() < 280, "above both"
    assert (observations["desired_goal"].sum(axis=0) > 25).all()
    assert not observations["achieved_goal"].any()


def test_a_goal_can_be_asked_for():
    env, envs = gym.make(ID), gym.make_vec(ID, 3)
    goals = SHOTS["classic"]
    observation, _ = env.reset(seed=0, options={"goal": "heart"})
    assert goals[observation["desired_goal"].argmax()] == "heart"
    observations, _ = envs.reset(seed=0, options={"goal": ["top", 0, None]})
    assert observations["desired_goal"][:2].argmax(axis=1).tolist() == [goals.index("top"), 0]
    drawn = gym.make(ID).reset(seed=2)[0]["desired_goal"]
    assert (observations["desired_goal"][2] == drawn).all()
    with pytest.raises(ValueError, match=r"goal must be one of 'left side', .*, or its number, got 'hart'"):
        env.reset(options={"goal": "hart"})


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_a_vector_is_its_single_environments_bit_for_bit(mode):
    envs = gym.make_vec(ID, 6, autoreset_mode=mode, threads=2, time_limit=2.0)
    singles = [gym.make(ID, time_limit=2.0) for _ in range(6)]
    rows, _ = envs.reset(seed=4)
    for number, single in enumerate(singles):
        assert_same(single.reset(seed=4 + number)[0], rows, number)
    over, ends, rng = np.zeros(6, bool), 0, np.random.default_rng(2)
    for _ in range(200):
        actions = np.where(rng.random(6) < 0.9, low(rows["observation"]), rng.integers(0, 4, 6))
        if mode == "DISABLED" and over.any():
            rows, _ = envs.reset(options={"reset_mask": over})
            for number in np.flatnonzero(over):
                assert_same(singles[number].reset()[0], rows, number)
        rows, rewards, terminated, truncated, infos = envs.step(actions)
        for number, single in enumerate(singles):
            if mode == "NEXT_STEP" and over[number]:
                assert_same(single.reset()[0], rows, number)
                assert (rewards[number], terminated[number], truncated[number]) == (0.0, False, False)
                continue
            row, *result, info = single.step(actions[number])
            assert result == [rewards[number], terminated[number], truncated[number]]
            ended = result[1] or result[2]
            if mode == "SAME_STEP" and ended:
                assert (infos["final_obs"][number]["observation"] == row["observation"]).all()
                assert {name: infos["final_info"][name][number] for name in info} == info
                row = single.reset()[0]
            elif mode != "SAME_STEP":
                assert {name: infos[name][number] for name in info} == info
            assert_same(row, rows, number)
        over = terminated | truncated
        ends += int(over.sum())
    assert ends > 20


def assert_same(row: dict, rows: dict, number: int) -> None:
    assert {name: part.tolist() for name, part in row.items()} == {
        name: part[number].tolist() for name, part in rows.items()
    }


def test_a_copy_and_a_saved_state_go_on_alike():
    env = gym.make(ID)
    env.reset(seed=5)
    for _ in range(4):
        env.step(0)
    twin, other = copy.deepcopy(env), gym.make(ID).unwrapped
    other.restore_state(env.unwrapped.save_state())
    over = False
    while not over:
        steps = [one.step(3) for one in (env, twin, other)]
        for name in ("observation", "achieved_goal", "desired_goal"):
            assert steps[0][0][name].tolist() == steps[1][0][name].tolist() == steps[2][0][name].tolist()
        assert steps[0][1:] == steps[1][1:] == steps[2][1:]
        over = steps[0][2] or steps[0][3]
    assert env.reset()[0]["desired_goal"].tolist() == twin.reset()[0]["desired_goal"].tolist()
    with pytest.raises(StateError, match="bytes"):
        other.restore_state(b"short")


def test_a_ball_may_be_cut_off_by_the_time_limit():
    env = gym.make(ID, time_limit=0.2)
    env.reset(seed=0)
    steps = [env.step(0) for _ in range(3)]
    assert [step[3] for step in steps] == [False, False, True]
    assert steps[-1][4]["out_of_time"]
    with pytest.raises(gym.error.ResetNeeded):
        env.step(0)


def test_shots_of_ones_own_are_judged():
    env = gym.make(ID, shots=["left slingshot", "right slingshot", "cylinder[3]"])
    assert {info["shot"] for *_, info in episodes(env, 20)} > {-1}
    assert env.observation_space["desired_goal"].shape == (3,)


@pytest.mark.parametrize("table", SHOTS)
def test_every_table_has_the_parts_that_its_shots_name(table):
    shots = parts_of(load_table(table), SHOTS[table])
    assert sorted(shots[shots >= 0].tolist()) == list(range(len(SHOTS[table])))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"shots": ["heart", "heat"]}, ValueError, "Classic has no part 'heat'; did you mean 'heart'"),
        ({"shots": ["heart", "cylinder[3]"]}, ValueError, "'cylinder.3.' is named twice"),
        ({"shots": ["heart"]}, ValueError, "2 to 64 names of parts, got 1"),
        ({"shots": "heart"}, TypeError, "list of names of parts, got 'heart'"),
        ({"table": "parts"}, ValueError, "only 'classic' and 'silver_comet' have shots by default"),
        ({"table": "random", "shots": ["a", "b"]}, ValueError, "one finished table"),
        ({"balls": 3}, TypeError, "unexpected keyword argument 'balls': shots set it themselves"),
        ({"frame_skips": 3}, TypeError, "did you mean 'frame_skip'"),
        ({"actions": "multibinary"}, ValueError, "actions must be 'discrete'"),
    ],
    ids=str,
)
def test_impossible_options_are_refused(options, error, message):
    with pytest.raises(error, match=message):
        gym.make(ID, **options)


def test_hindsight_replay_of_stable_baselines3_learns_from_it():
    sb3 = pytest.importorskip("stable_baselines3")
    env = gym.make(ID)
    model = sb3.DQN(
        "MultiInputPolicy", env, replay_buffer_class=sb3.HerReplayBuffer, learning_starts=200, seed=0
    )
    model.learn(300)
    relabelled = model.replay_buffer.sample(256)
    assert relabelled.rewards.max() == 1.0, "shots that were made count as wanted ones"


@pytest.mark.slow
def test_shots_of_a_table_with_devices_can_be_made():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(ID, table="silver_comet"), skip_render_check=True)
    envs = gym.make_vec(ID, 300, table="silver_comet", autoreset_mode="SAME_STEP")
    observations, _ = envs.reset(seed=0)
    made = set()
    for _ in range(200):
        observations, *_, infos = envs.step(low(observations["observation"]))
        if "final_info" in infos:
            made |= set(infos["final_info"]["shot"][infos["_final_info"]].tolist())
    assert made == set(range(-1, len(SHOTS["silver_comet"])))
