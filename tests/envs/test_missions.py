"""Environments whose episodes are games by the rules of a table."""

from __future__ import annotations

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest

import silverball as sb
from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.envs.state import HAPPENINGS
from silverball.physics.records import Motion
from silverball.referee.game_records import FOREVER, NOT_RUNNING, Light, Own
from silverball.table import load_table

ID = "silverball/PinballMissions-v1"
COMET = load_table("silver_comet")
LEFT, RIGHT, LAUNCH = 1, 2, 4
COUNT = 12
BY_HAND = {"table": COMET, "rules": True, "balls": 3, "frame_skip": 4}


def held_for_a_while(seed: int, steps: int, codes: int = 4, count: int = COUNT) -> np.ndarray:
    """Buttons [step, env], each held for four steps."""
    return np.repeat(np.random.default_rng(seed).integers(0, codes, (steps // 4 + 1, count)), 4, 0)[:steps]


@pytest.fixture
def envs() -> PinballVectorEnv:
    return gym.make_vec(ID, COUNT, observation="dict")


@pytest.fixture
def env() -> PinballEnv:
    env = gym.make(ID, observation="dict", jitter=True)
    env.reset(seed=3)
    return env


def play(env: PinballEnv, steps: int, seed: int = 0) -> dict:
    """Some steps of a game; returns the last observation."""
    for action in held_for_a_while(seed, steps, count=1)[:, 0]:
        observation, *_, info = env.step(int(action))
    return observation | {"info": info}


def test_an_episode_is_the_game_that_a_batch_of_games_plays():
    envs = PinballVectorEnv(COUNT, "DISABLED", stall=None, **BY_HAND)
    envs.reset(seed=5)
    seeds = envs.batch.state["seed"].tolist()
    batch = sb.GameBatch(COMET, COUNT, seeds, tick_rate=60)
    for action in held_for_a_while(1, 700, codes=8):
        *_, infos = envs.step(np.where(envs._engine.episodes["over"], 0, action))
        bits = action[:, None] & np.array([LEFT, RIGHT, 0, LAUNCH]) != 0
        batch.step(bits, ticks=4)
        if (batch.games["over"] != 0).any():
            break
    assert batch.games["score"].max() > 10_000
    own = envs._engine.game_records
    plays_on = (own["balls"] == batch.games["balls"]) & (batch.games["over"] == 0)
    assert plays_on.sum() >= COUNT - 2, "the next ball is on the table at once, in a batch a tick later"
    assert own[plays_on].tobytes() == batch.games[plays_on].tobytes()
    worlds = [digest for digest, same in zip(envs.batch.digests(), plays_on, strict=True) if same]
    assert worlds == [digest for digest, same in zip(batch.digests(), plays_on, strict=True) if same]
    assert infos["score"].tolist() == own["score"].tolist()


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_a_vector_is_its_single_environments_bit_for_bit(mode):
    options = {"time_limit": 20.0, "reward": {"points": 0.001, "mode_started": 1.0, "counter bonus": 0.1}}
    envs = gym.make_vec(ID, 3, autoreset_mode=mode, threads=2, **options)
    singles = [gym.make(ID, **options) for _ in range(3)]
    observations, _ = envs.reset(seed=11)
    first = [env.reset(seed=11 + number)[0] for number, env in enumerate(singles)]
    assert observations.tobytes() == np.stack(first).tobytes()
    over, ends = np.zeros(3, bool), 0
    for action in held_for_a_while(2, 700, count=3):
        observations, rewards, terminated, truncated, infos = envs.step(action)
        for number, env in enumerate(singles):
            if over[number] and mode == "NEXT_STEP":
                observation, info = env.reset()
                reward, ended = 0.0, (False, False)
            else:
                observation, reward, *ended, info = env.step(int(action[number]))
            if any(ended) and mode == "SAME_STEP":
                assert infos["final_obs"][number].tobytes() == observation.tobytes()
                assert {name: infos["final_info"][name][number] for name in info} == info
                observation, info = env.reset()
            assert observations[number].tobytes() == observation.tobytes()
            assert (rewards[number], terminated[number], truncated[number]) == (reward, *ended)
            assert {name: infos[name][number] for name in info} == info
        over = terminated | truncated
        ends += over.sum()
    assert ends >= 6
    assert infos["score"].max() > 0


def test_a_saved_game_goes_on_bit_for_bit_here_and_in_a_copy(env):
    play(env, 400)
    assert env.observe()["lamps"].any()
    state, branch, sent = env.save_state(), copy.deepcopy(env), pickle.loads(pickle.dumps(env))
    first = play(env, 200, seed=8)
    for other in (branch, sent):
        assert str(play(other, 200, seed=8)) == str(first)
    env.restore_state(state)
    assert str(play(env, 200, seed=8)) == str(first)
    assert env.save_state() == branch.save_state()


def test_a_state_of_other_rules_is_refused(env):
    other = COMET.replace(rule=COMET.rule[:-1])
    with pytest.raises(sb.StateError, match="belongs to other boards"):
        gym.make(ID, table=other).restore_state(env.save_state())


def test_the_groups_show_the_record_of_the_game(envs):
    envs.reset(seed=1)
    names = envs.rule_names
    seen = {"blinking": 0, "running": 0, "counted": 0}
    for action in held_for_a_while(4, 400):
        observations, *_ = envs.step(action)
        games, ticks = envs._engine.game_records, envs.batch.state["tick"]
        assert (
            observations["lamps"][:, :, 0] == (games["lamp"][:, : len(names["lamps"])] != Light.OFF)
        ).all()
        blinks = games["lamp"][:, : len(names["lamps"])] == Light.BLINKING
        assert (observations["lamps"][:, :, 1] == blinks).all()
        for number, name in enumerate(names["modes"]):
            shown, ends = observations["modes"][:, number], games["mode_end"][:, number]
            assert (shown[:, 0] == (ends != NOT_RUNNING)).all()
            seconds = COMET.mode[number].seconds
            left = (ends - ticks) / 60.0 / seconds if seconds else np.where(ends == FOREVER, 1.0, 0.0)
            left = np.where(ends == NOT_RUNNING, 0.0, left)
            np.testing.assert_allclose(shown[:, 1], np.clip(left, 0.0, 1.0), atol=1e-6, err_msg=name)
        for number, counter in enumerate(COMET.counter):
            if counter.most < 1000:
                share = games["counter"][:, number] / counter.most
                np.testing.assert_allclose(observations["counters"][:, number, 0], share, atol=1e-6)
        seen["blinking"] += blinks.sum()
        seen["running"] += (games["mode_end"][:, : len(names["modes"])] != NOT_RUNNING).sum()
        seen["counted"] += games["counter"].any(axis=1).sum()
        play_group = observations["play"][:, 0]
        gold = COMET.arcade.gold
        np.testing.assert_allclose(play_group[:, 0], games["score"] / (games["score"] + gold), atol=1e-6)
        np.testing.assert_allclose(play_group[:, 1], games["used"] / 3, atol=1e-6)
        np.testing.assert_allclose(play_group[:, 2], games["balls"] / COMET.board.max_balls, atol=1e-6)
        np.testing.assert_allclose(observations["game"][:, 0, 1], (3 - games["used"]) / 3, atol=1e-6)
    assert min(seen.values()) > 100


def test_rewards_weigh_points_happenings_counters_and_modes():
    weights = {"points": 0.01, "ball_saved": 5.0, "counter bonus": 0.25, "mode skill": 7.0, "drained": -1.0}
    weighed = gym.make_vec(ID, COUNT, autoreset_mode="DISABLED", reward=weights, stall=None)
    called = []
    other = gym.make_vec(
        ID,
        COUNT,
        autoreset_mode="DISABLED",
        reward=lambda terms: called.append(terms) or terms["points"],
        stall=None,
    )
    weighed.reset(seed=2)
    other.reset(seed=2)
    before = np.zeros(COUNT, np.int64)
    bonus = list(weighed.rule_names["counters"]).index("bonus")
    total = dict.fromkeys(weights, 0.0)
    for action in held_for_a_while(7, 300):
        counted = weighed._engine.game_records["counter"][:, bonus].copy()
        _, rewards, terminated, _, infos = weighed.step(action)
        other.step(action)
        terms = called[-1]
        assert (terms["points"] == infos["score"] - before).all()
        grown = weighed._engine.game_records["counter"][:, bonus] - counted
        assert (terms["counter bonus"] == np.maximum(grown, 0)).all()
        expected = sum(weight * terms[name] for name, weight in weights.items())
        np.testing.assert_allclose(rewards, expected, atol=1e-9)
        before = infos["score"].copy()
        for name in weights:
            total[name] += terms[name].sum()
        if terminated.any():
            break
    assert all(value > 0 for value in total.values()), total
    assert infos["ball_saved"].sum() == total["ball_saved"]


def test_a_ball_is_launched_without_a_button_at_speeds_that_vary(envs):
    assert envs.single_action_space == gym.spaces.Discrete(4)
    observations, _ = envs.reset(seed=4)
    assert (observations["ball_places"][:, 0, 1] == 1.0).all(), "each first ball lies on the plunger"
    speeds = np.zeros(COUNT)
    for _ in range(60):
        observations, *_ = envs.step(np.zeros(COUNT, int))
        free = (observations["ball_places"][:, 0, 1] == 0.0) & (speeds == 0.0)
        speeds[free] = observations["balls"][free, 0, 3]
    assert (speeds > 0.2).all()
    assert len(np.unique(speeds)) > COUNT / 3


def test_with_a_launch_button_the_agent_launches_itself():
    env = PinballEnv(observation="dict", stall=4.0, **BY_HAND)
    assert env.get_action_meanings()[LAUNCH] == "LAUNCH"
    env.reset(seed=0)
    ends = [env.step(0)[2] for _ in range(61)]
    assert ends == [False] * 60 + [True], "a ball that is not launched stalls after four seconds"
    assert env._engine.episodes["stalled"][0] == 1
    env.reset(seed=0)
    for _ in range(18):
        env.step(LAUNCH)
    observation, *_ = env.step(0)
    assert observation["balls"][0, 3] > 0.0
    assert env._engine.batch.state["ball"]["motion"][0, 0] != Motion.CAPTURED


def test_nudges_swing_the_tilt_bob_and_a_tilt_ends_the_ball(env):
    assert env.get_action_meanings()[4] == "NUDGE_LEFT"
    while env.observe()["ball_places"][0, 1] == 1.0:
        env.step(0)
    warnings = 0.0
    for step in range(100):
        observation, *_, info = env.step(4 if step % 12 == 0 else 0)
        warnings = max(warnings, observation["play"][0, 4])
        if observation["play"][0, 5] == 1.0:
            break
    assert warnings > 0.0
    assert (observation["play"][0, 5], info["tilt"]) == (1.0, 1)
    for _ in range(600):
        *_, info = env.step(3)
        if info["ball"] == 2:
            break
    assert info["ball_lost"] == 1
    assert env.observe()["play"][0, 5] == 0.0


def test_a_game_has_its_balls_and_ends_with_the_last(envs):
    envs = gym.make_vec(ID, COUNT, autoreset_mode="SAME_STEP", balls=2)
    envs.reset(seed=0)
    ended = []
    for _ in range(1500):
        _, _, terminated, truncated, infos = envs.step(np.zeros(COUNT, int))
        assert not truncated.any()
        ended += [infos["final_info"]["ball_lost"][row] for row in np.flatnonzero(terminated)]
        if len(ended) >= COUNT:
            break
    assert len(ended) >= COUNT
    assert set(ended) == {2}


def test_lives_are_the_balls_that_are_left(env):
    assert env.lives() == 3
    while env.step(0)[4]["ball"] < 3:
        pass
    assert env.lives() == 1
    while not env.is_over:
        env.step(0)
    assert env.lives() == 0


@pytest.mark.slow
def test_a_rendered_picture_shows_the_lamps():
    env = gym.make(ID, render_mode="rgb_array")
    env.reset(seed=0)
    before = env.render()
    lamps = env._engine.game_records["lamp"][0]
    assert (env.render() == before).all()
    lamps[: len(COMET.lamp)] = Light.ON
    lit = env.render()
    assert (lit.astype(int) - before > 30).any(axis=2).sum() > 100


def test_infos_name_what_games_report():
    assert {*HAPPENINGS, "player_up"} == {kind.name.lower() for kind in sb.GameEventKind}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"create": "button"}, 'create must be "auto" with rules=True: the rules say when a ball comes'),
        ({"reward": {"counter bonnus": 1.0}}, "unknown term 'counter bonnus'; did you mean 'counter bonus'?"),
        (
            {"reward": {"tilt": 1.0}, "rules": False},
            "the term 'tilt' is one of games: set the option rules=True",
        ),
        ({"reward": {"points": 1.0, "modes": 1.0}}, "unknown term 'modes'"),
        ({"launch": "maybe"}, "launch must be 'button' or 'auto', got 'maybe'"),
        ({"rules": 1}, "rules must be True or False, got 1"),
    ],
    ids=str,
)
def test_what_cannot_be_is_refused_in_a_sentence(options, message):
    with pytest.raises(ValueError) as caught:
        gym.make(ID, **options)
    assert message in str(caught.value)


def test_tables_of_a_list_must_have_the_same_lamps():
    other = COMET.replace(rule=(), lamp=(), counter=(), mode=())
    with pytest.raises(ValueError, match="must have the same lamps"):
        gym.make(ID, table=[COMET, other])


def test_the_score_of_a_table_is_its_own_however_many_threads_play():
    results = []
    for threads in (1, 3):
        envs = gym.make_vec(ID, 1000, threads=threads, frame_skip=8)
        observations, _ = envs.reset(seed=9)
        for action in held_for_a_while(3, 40, count=1000):
            observations, rewards, *_ = envs.step(action)
        results.append((observations.tobytes(), rewards.tobytes(), envs.save_state().tobytes()))
    assert results[0] == results[1]


def test_a_combo_of_the_machine_is_shown(env):
    record = env._engine.game_records[0]
    assert env.observe()["play"][0, 8] == 0.0
    record["combo"], record["combo_tick"] = 3, env._engine.batch.state["tick"][0]
    setup = env._engine.games.books.setups[0]
    shown = env.observe()["play"][0, 8]
    factor = min(1 + 2 // setup["combo_step"], setup["combo_limit"]) if setup["combo_ticks"] > 0 else 1
    assert shown == pytest.approx((factor - 1) / (setup["combo_limit"] - 1))
    assert Own.COMBO == 0


@pytest.mark.slow
def test_a_table_without_rules_of_its_own_is_played_by_the_standard_ones():
    options = {"table": "classic", "rules": True, "balls": 3, "frame_skip": 4, "stall": None}
    envs = PinballVectorEnv(COUNT, "DISABLED", observation="dict", **options)
    envs.reset(seed=6)
    batch = sb.GameBatch("classic", COUNT, envs.batch.state["seed"].tolist(), tick_rate=60)
    combos = 0.0
    for action in held_for_a_while(1, 300):
        observations, *_ = envs.step(np.where(envs._engine.episodes["over"], 0, action))
        batch.step(action[:, None] & np.array([LEFT, RIGHT, 0]) != 0, ticks=4)
        combos = max(combos, observations["play"][:, 0, 8].max())
        if (batch.games["over"] != 0).any():
            break
    assert combos > 0.0
    own = envs._engine.game_records
    plays_on = (own["balls"] == batch.games["balls"]) & (batch.games["over"] == 0)
    assert plays_on.sum() >= COUNT - 2
    assert own[plays_on].tobytes() == batch.games[plays_on].tobytes()
