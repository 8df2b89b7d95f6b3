"""Sticky actions repeat the last action, the coils share a supply, and both are part of the state."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import BENCHMARK, IDS
from silverball.envs.observations import field_named

CLASSIC = "silverball/PinballClassic-v1"
MODES = ("NEXT_STEP", "SAME_STEP", "DISABLED")


def play(env, steps, seed=0):
    """Random actions; the observations, the executed actions and the chosen ones."""
    rng = np.random.default_rng(seed)
    seen, executed, chosen = [], [], []
    for _ in range(steps):
        action = int(rng.integers(0, 4))
        observation, _, terminated, truncated, info = env.step(action)
        seen.append(observation)
        executed.append(info["action"])
        chosen.append(action)
        if terminated or truncated:
            break
    return np.array(seen), np.array(executed), np.array(chosen)


def test_sticky_actions_repeat_as_often_as_the_option_says():
    envs = gym.make_vec("silverball/PinballClassic-v0", 400, frame_skip=4, sticky=0.25)
    envs.reset(seed=0)
    repeated, last = [], np.zeros(400, int)
    for step in range(100):
        action = np.full(400, step % 4)
        over = envs.step(action)[4]["action"]
        begins = envs.unwrapped._engine.episodes["steps"] == 0
        differs = (last != action) & ~begins
        repeated += (over == last)[differs].tolist()
        assert np.isin(over[~begins], (step % 4, (step - 1) % 4, (step - 2) % 4, (step - 3) % 4)).all()
        last = over
    share, count = np.mean(repeated), len(repeated)
    assert abs(share - 0.25) < 4.0 * np.sqrt(0.25 * 0.75 / count)


def test_without_sticky_and_recharge_every_action_is_executed():
    env = gym.make(CLASSIC, sticky=1e-12, recharge=0.0)  # both are as good as off
    env.reset(seed=0)
    _, executed, chosen = play(env, 100)
    assert (executed == chosen).all()


def test_the_info_of_v0_has_no_executed_action():
    env = gym.make("silverball/PinballClassic-v0")
    assert "action" not in env.reset(seed=0)[1]


def strokes_of(env, actions):
    """The steps in which each paddle is lifted, and which."""
    strokes, held = [], 0
    for step, action in enumerate(actions):
        bits = env.step(action)[4]["action"]
        strokes += [(step, button) for button in (1, 2) if bits & ~held & button]
        held = bits
    return strokes


def test_a_stroke_waits_until_the_supply_is_charged():
    env = gym.make(CLASSIC, sticky=0.0, time_limit=None, stall=None, balls=50)
    env.reset(seed=0)
    strokes = strokes_of(env, [step % 2 for step in range(200)])
    assert len(strokes) > 5
    gaps = np.diff([step for step, _ in strokes]) * 4 / 60
    assert gaps.min() >= BENCHMARK["recharge"] - 1e-9
    assert gaps.max() <= BENCHMARK["recharge"] + 2 * 4 / 60


def test_both_paddles_share_the_supply_and_chance_chooses_one_of_them():
    env = gym.make(CLASSIC, sticky=0.0, time_limit=None, stall=None, balls=200)
    env.reset(seed=0)
    strokes = strokes_of(env, [3, *(0,) * 14] * 100)
    steps, sides = np.array(strokes).T
    assert len(set(steps.tolist())) == len(steps) == 100
    assert abs((sides == 1).sum() - 50) < 4 * 5  # four standard deviations


def test_a_held_paddle_stays_up_while_the_other_one_strikes():
    env = gym.make(CLASSIC, sticky=0.0, stall=None, balls=50)
    env.reset(seed=0)
    assert env.step(1)[4]["action"] == 1
    executed = [env.step(3)[4]["action"] for _ in range(20)]
    wait = round(BENCHMARK["recharge"] * 15) - 1
    assert executed == [1] * wait + [3] * (20 - wait)


def test_the_charge_is_seen():
    env = gym.make(CLASSIC, sticky=0.0, observation="dict", stall=None, balls=50)
    observation, _ = env.reset(seed=0)
    assert observation["supply"].tolist() == [[1.0]]
    charges = [env.step(action)[0]["supply"][0, 0] for action in (2, *(0,) * 20)]
    expected = np.minimum(1.0, np.arange(4, 4 * 22, 4) / (BENCHMARK["recharge"] * 60))
    np.testing.assert_allclose(charges, expected, rtol=1e-6)
    assert field_named(env.unwrapped._engine.pool.fields, "supply").items == 1


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("id_", [CLASSIC, "silverball/PinballPixels-v1"])
def test_a_vector_is_many_single_environments_bit_for_bit(id_, mode):
    options = {"boards": 4} if "Pixels" in id_ else {}
    envs = gym.make_vec(id_, 3, autoreset_mode=mode, threads=1, **options)
    singles = [gym.make(id_, **options) for _ in range(3)]
    observations, _ = envs.reset(seed=7)
    for number, single in enumerate(singles):
        np.testing.assert_array_equal(single.reset(seed=7 + number)[0], observations[number])
    rng, alive = np.random.default_rng(0), np.ones(3, bool)
    for _ in range(300):
        actions = rng.integers(0, 4, 3)
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        for number in np.flatnonzero(alive):
            seen, reward, *ends, info = singles[number].step(actions[number])
            assert (reward, *ends) == (rewards[number], terminated[number], truncated[number])
            is_reset = any(ends) and mode == "SAME_STEP"
            own = infos["final_obs"][number] if is_reset else observations[number]
            np.testing.assert_array_equal(seen, own)
            of_all = infos["final_info"] if is_reset else infos
            assert info["action"] == of_all["action"][number]
        alive &= ~(terminated | truncated)
        if not alive.any() or (mode == "DISABLED" and not alive.all()):
            break
    assert not alive.all()


def test_chance_and_charge_are_saved_and_restored():
    env, other = gym.make(CLASSIC), gym.make(CLASSIC)
    env.reset(seed=3)
    play(env, 10)
    state = env.unwrapped.save_state()
    other.reset(seed=99)
    other.unwrapped.restore_state(state)
    for mine, others in zip(play(env, 50, 1), play(other, 50, 1), strict=True):
        np.testing.assert_array_equal(mine, others)


def test_a_state_does_not_fit_an_environment_without_a_supply():
    env, plain = gym.make(CLASSIC), gym.make("silverball/PinballClassic-v0")
    env.reset(seed=0)
    with pytest.raises(Exception, match="a state of this environment has"):
        plain.unwrapped.restore_state(env.unwrapped.save_state())


def test_an_episode_begins_with_a_full_supply_and_nothing_held():
    env = gym.make(CLASSIC, sticky=0.9)
    env.reset(seed=0)
    while not env.unwrapped.is_over:
        env.step(3)
    observation, info = env.reset()
    assert info["action"] == 0
    first = field_named(env.unwrapped._engine.pool.fields, "supply").first
    assert observation[first] == 1.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"sticky": 1.0}, "sticky must be 0 to 0.99"),
        ({"recharge": -0.1}, "recharge must be 0 to 60 s"),
        ({"boards": "tests"}, "'train' or 'test', got 'tests'"),
        ({"boards": "test", "board_seed": 5}, "board_seed must be 0 with boards='test'"),
        ({"level": "extreme"}, "level must be 'easy', 'normal' or 'hard'"),
    ],
)
def test_a_wrong_option_is_refused(given, message):
    with pytest.raises(ValueError, match=message):
        gym.make("silverball/Pinball-v1", **given)


def test_the_splits_share_no_board_and_levels_differ_in_what_they_say():
    train = gym.make("silverball/Pinball-v1").unwrapped._engine.pool
    assert train.seeds.tolist() == list(range(200))
    easy, hard = (
        gym.make(CLASSIC, level=level).unwrapped._engine.pool.tables[0] for level in ("easy", "hard")
    )
    normal = gym.make(CLASSIC).unwrapped._engine.pool.tables[0]
    assert easy.board.gravity < normal.board.gravity < hard.board.gravity
    assert not easy.triangular_prism
    assert hard.triangular_prism == normal.triangular_prism
    assert easy.cylinder == normal.cylinder


def test_every_v1_id_of_one_player_is_sticky_and_has_a_supply():
    of_v1 = {name: given for name, given in IDS.items() if name.endswith("-v1")}
    assert len(of_v1) >= 3
    for given in of_v1.values():
        assert (given["sticky"], given["recharge"]) == (BENCHMARK["sticky"], BENCHMARK["recharge"])
