"""The environments fulfil Gymnasium's contract."""

from __future__ import annotations

import copy
import pickle
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import silverball.envs
from silverball.envs import IDS, PinballEnv

CLASSIC = "silverball/PinballClassic-v0"
FEW = {"boards": 3}


def options_of(id_: str) -> dict:
    return {} if id_ == CLASSIC else FEW


@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_checker_accepts_the_environment(id_):
    env = gym.make(id_, **options_of(id_))  # Gymnasium warns of ids that have a newer version
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env, skip_render_check=True)


@pytest.mark.parametrize(
    "options",
    [
        {"observation": "dict"},
        {"actions": "multibinary", "jitter": True},
        {"jitter": True, "create": "button", "balls": 3},
        {"reward": "time"},
        {"observation": "pixels", "stack": 1, "size": (40, 24)},
        {"observation": "pixels", "rgb": True, "stack": 2},
    ],
    ids=str,
)
def test_gymnasiums_checker_accepts_every_option(options):
    env = gym.make(CLASSIC, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env, skip_render_check=True)


def test_every_id_is_registered_with_an_entry_point_for_vectors():
    for id_ in IDS:
        assert gym.spec(id_).vector_entry_point == "silverball.envs.vector:PinballVectorEnv"


def test_gymnasiums_make_puts_no_wrapper_around_the_environment():
    assert type(gym.make(CLASSIC)) is PinballEnv


def test_flags_of_the_end_are_pythons_own_and_the_reward_a_float():
    env = gym.make(CLASSIC)
    env.reset(seed=0)
    _, reward, terminated, truncated, _ = env.step(np.int64(3))
    assert (type(reward), type(terminated), type(truncated)) == (float, bool, bool)


def test_a_step_before_the_first_reset_is_refused_in_words():
    with pytest.raises(gym.error.ResetNeeded, match="call reset before step"):
        gym.make(CLASSIC).step(0)


def test_a_step_after_the_end_is_refused():
    env = gym.make(CLASSIC, time_limit=1 / 60)
    env.reset(seed=0)
    assert env.step(0)[3]
    state = env.unwrapped.save_state()
    with pytest.raises(gym.error.ResetNeeded):
        env.step(0)
    assert env.unwrapped.save_state() == state, "nothing has moved"
    env.reset()
    assert env.step(0)[3]


@pytest.mark.parametrize("action", [-1, 4, 1.5, None, "left", [1, 0]])
def test_an_invalid_action_is_refused_with_a_message(action):
    env = gym.make(CLASSIC)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="action must be in"):
        env.step(action)


def test_multibinary_actions_are_the_bits_of_discrete_ones():
    one, other = gym.make(CLASSIC, jitter=True), gym.make(CLASSIC, jitter=True, actions="multibinary")
    one.reset(seed=3), other.reset(seed=3)
    for action in np.random.default_rng(0).integers(0, 8, 200):
        bits = (action >> np.arange(3)) & 1
        assert one.step(action)[0].tolist() == other.step(bits.astype(np.int8))[0].tolist()


def test_the_same_seed_gives_the_same_episodes_and_another_one_others():
    def boards_and_places(seed: int) -> list[tuple[int, list[float]]]:
        env = gym.make("silverball/Pinball-v0", **FEW)
        starts = [env.reset(seed=seed), *(env.reset() for _ in range(9))]
        return [(info["board"], observation.tolist()) for observation, info in starts]

    episodes = boards_and_places(0)
    assert boards_and_places(0) == episodes
    assert boards_and_places(1) != episodes
    assert {board for board, _ in episodes} == {0, 1, 2}
    assert len({tuple(place) for _, place in episodes}) == 10


def test_without_a_seed_two_environments_differ():
    first, second = (gym.make(CLASSIC).reset()[0] for _ in range(2))
    assert first.tolist() != second.tolist()


def test_other_boards_can_be_asked_for():
    _, info = gym.make("silverball/Pinball-v0", boards=1, board_seed=77).reset(seed=0)
    assert info["board"] == 77


def test_an_unknown_option_is_refused_with_a_hint():
    with pytest.raises(TypeError, match="did you mean 'frame_skip'"):
        PinballEnv(frame_skips=2)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("balls", 0, "1 to 1,000, got 0"),
        ("boards", True, "got (true|True)"),
        ("boards", 2.0, "got 2.0"),
        ("stall", 0.0, "None or above 0 s, got 0.0"),
        ("stall", np.nan, "got nan"),
        ("time_limit", "5", "got '5'"),
        ("observation", "ram", "'state', 'dict' or 'pixels', got 'ram'"),
        ("observation", None, "got None"),
        ("size", 84, r"\(height, width\), got 84"),
        ("size", (84, 2), "8 to 1,024, got 2"),
        ("stack", 99, "got 99"),
        ("tick_rate", 5, "got 5"),
        ("jitter", 1, "True or False, got 1"),
        ("rgb", None, "True or False, got None"),
        ("render_mode", "ansi", "or None, got 'ansi'"),
    ],
)
def test_an_invalid_value_of_an_option_is_refused_in_one_sentence(name, value, message):
    with pytest.raises(ValueError, match=f"^{name} must be .*{message}$"):
        PinballEnv(table="classic", **{name: value})


def test_one_error_reports_all_invalid_values():
    with pytest.raises(ValueError, match=r"^balls must be .*; rgb must be True or False, got 2$"):
        PinballEnv(balls=0, rgb=2)


def test_numbers_of_numpy_are_taken_and_become_pythons_own():
    options = PinballEnv(
        boards=np.int64(2), stall=np.float32(2.0), rgb=np.bool_(True), size=[20, np.int8(16)]
    ).options
    assert (options.boards, options.stall, options.rgb, options.size) == (2, 2.0, True, (20, 16))
    assert [type(value) for value in (options.boards, options.stall, options.rgb)] == [int, float, bool]


def test_dict_observations_are_the_columns_of_the_row():
    row, _ = gym.make(CLASSIC).reset(seed=5)
    named, _ = gym.make(CLASSIC, observation="dict").reset(seed=5)
    assert list(named) == ["balls", "paddles", "game", "triangular_prisms", "cylinders"]
    assert np.concatenate([part.reshape(-1) for part in named.values()]).tolist() == row.tolist()


@pytest.mark.parametrize("again", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_goes_on_like_its_original(again):
    env = gym.make(CLASSIC)
    env.reset(seed=11)
    for action in range(4):
        env.step(action)
    env.action_space.seed(3)
    twin = again(env)
    assert [twin.action_space.sample() for _ in range(9)] == [env.action_space.sample() for _ in range(9)]
    for _ in range(2000):
        one, other = env.step(3), twin.step(3)
        assert one[0].tolist() == other[0].tolist()
        assert one[1:] == other[1:]
        if one[2]:
            assert env.reset()[0].tolist() == twin.reset()[0].tolist()
            break
    else:
        pytest.fail("the episode did not end")


def test_the_table_can_be_rendered():
    env = gym.make(CLASSIC, render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    for _ in range(30):
        env.step(3)
    later = env.render()
    assert picture.shape == later.shape == (680, 330, 3)
    assert picture.dtype == np.uint8
    assert (picture != later).any()
    assert gym.make(CLASSIC).render() is None


def test_pictures_show_nothing_of_another_episode_or_branch():
    env, fresh = (gym.make(CLASSIC, render_mode="rgb_array") for _ in range(2))
    env.reset(seed=8)
    state, over = env.unwrapped.save_state(), False
    while not over:
        env.render()
        over = env.step(0)[2]
    env.render()
    env.reset(seed=5), fresh.reset(seed=5)
    for _ in range(40):
        env.step(3), fresh.step(3)
        assert (env.render() == fresh.render()).all()
    env.unwrapped.restore_state(state)
    again = gym.make(CLASSIC, render_mode="rgb_array").unwrapped
    again.restore_state(state)
    assert (env.render() == again.render()).all()


def test_tables_side_by_side_show_nothing_of_each_other():
    envs = gym.make_vec(CLASSIC, 3, render_mode="rgb_array")
    alone = gym.make(CLASSIC, render_mode="rgb_array")
    envs.reset(seed=4), alone.reset(seed=5)
    for _ in range(60):
        envs.step(np.zeros(3, int)), alone.step(0)
        assert (envs.render()[1] == alone.render()).all()


@pytest.mark.parametrize(
    ("options", "rate"),
    [({}, 60), ({"frame_skip": 4}, 15), ({"tick_rate": 240}, 240), ({"frame_skip": 500}, 1)],
)
def test_films_of_renderings_run_as_fast_as_the_table(options, rate):
    assert gym.make(CLASSIC, **options).metadata["render_fps"] == rate
    assert gym.make_vec(CLASSIC, 2, **options).metadata["render_fps"] == rate
    assert PinballEnv.metadata["render_fps"] == 60


def test_ids_can_be_made_by_the_name_of_the_module_too():
    assert silverball.envs.__name__ == "silverball.envs"
    assert isinstance(gym.make(f"silverball.envs:{CLASSIC}"), PinballEnv)
