"""Boards, seeds and generators of a reset."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

import silverball as sb
from silverball.table import Table

CLASSIC = "silverball/PinballClassic-v0"
RANDOM = "silverball/Pinball-v0"
FEW = {"boards": 4}


def test_a_board_can_be_chosen_by_its_seed():
    env = gym.make(RANDOM, boards=4, board_seed=70)
    for board in (72, 70, np.int64(73)):
        observation, info = env.reset(seed=5, options={"board": board})
        assert info["board"] == board
        alone = gym.make(RANDOM, boards=1, board_seed=int(board)).reset(seed=5)[0]
        assert observation.tolist() == alone.tolist()


def test_a_chosen_board_is_for_one_episode_and_changes_no_other():
    def boards(options):
        env = gym.make(RANDOM, **FEW)
        return [
            env.reset(seed=3 if n == 0 else None, options=options if n == 2 else None)[1]["board"]
            for n in range(9)
        ]

    free, once = boards(None), boards({"board": 1})
    assert once == [*free[:2], 1, *free[3:]]


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_a_vector_takes_a_board_for_all_or_one_for_each(mode):
    envs = gym.make_vec(RANDOM, 3, boards=4, autoreset_mode=mode)
    assert envs.reset(seed=1, options={"board": 2})[1]["board"].tolist() == [2, 2, 2]
    assert envs.reset(options={"board": np.array([3, 0, 1])})[1]["board"].tolist() == [3, 0, 1]
    mask = np.array([False, True, False])
    info = envs.reset(options={"board": 2, "reset_mask": mask})[1]
    assert info["board"][1] == 2
    envs.step(np.zeros(3, int))
    assert envs.unwrapped.batch.board_of.tolist() == [3, 2, 1]


def test_a_table_of_a_list_can_be_chosen_by_its_number():
    tables = [sb.generate_table(seed=seed) for seed in range(3)]
    env = gym.make(RANDOM, table=tables)
    assert env.reset(seed=0, options={"board": 2})[1]["board"] == 2


@pytest.mark.parametrize("board", [4, -1, 1.0, "1", True, None, [1], 2**70])
def test_an_unknown_board_is_refused(board):
    env, envs = gym.make(RANDOM, **FEW), gym.make_vec(RANDOM, 2, **FEW)
    env.reset(seed=0), envs.reset(seed=0)
    before = env.unwrapped.save_state()
    if board is None:
        env.reset(options={"board": None})  # none is chosen
        return
    for one in (env, envs):
        with pytest.raises(ValueError, match="board must be"):
            one.reset(options={"board": board})
    assert env.unwrapped.save_state() == before
    with pytest.raises(ValueError, match="only table"):
        gym.make(CLASSIC).reset(options={"board": 0})


@pytest.mark.parametrize(
    "options", [{"seed": 1}, {"boards": 3}, {"reset_mask": np.ones(1, bool)}, {7: 7}], ids=str
)
def test_an_unknown_option_of_a_reset_is_refused(options):
    env = gym.make(CLASSIC)
    with pytest.raises(ValueError, match="unknown reset option"):
        env.reset(options=options)
    if "reset_mask" not in options:
        with pytest.raises(ValueError, match="unknown reset option"):
            gym.make_vec(CLASSIC, 1).reset(options=options)
    for wrong in ("board", 7, [("board", 1)]):
        with pytest.raises(TypeError, match="options must be a dict"):
            env.reset(options=wrong)
    env.reset(options={})


def test_a_generator_that_is_set_decides_what_follows():
    def episodes(make, number):
        env = make()
        env.reset(seed=1)
        env.unwrapped.np_random = np.random.default_rng(number)
        return [env.reset()[0].tolist() for _ in range(4)]

    for make in (lambda: gym.make(CLASSIC), lambda: gym.make_vec(CLASSIC, 3)):
        assert episodes(make, 7) == episodes(make, 7) != episodes(make, 8)


def test_a_generator_that_is_set_waits_for_each_environments_own_reset():
    envs = gym.make_vec(CLASSIC, 2)
    envs.reset(seed=1)
    expected = gym.make_vec(CLASSIC, 2)
    expected.reset(seed=1)
    envs.unwrapped.np_random = np.random.default_rng(3)
    first = {"reset_mask": np.array([True, False])}
    drawn, untouched = envs.reset(options=first)[0], expected.reset(options=first)[0]
    assert drawn[0].tolist() != untouched[0].tolist()
    assert drawn[1].tolist() == untouched[1].tolist()
    second = {"reset_mask": np.array([False, True])}
    assert envs.reset(options=second)[0][1].tolist() != expected.reset(options=second)[0][1].tolist()


def test_a_seed_comes_before_a_generator_that_was_set():
    env = gym.make(CLASSIC)
    env.unwrapped.np_random = np.random.default_rng(3)
    seeded = gym.make(CLASSIC)
    assert env.reset(seed=4)[0].tolist() == seeded.reset(seed=4)[0].tolist()
    assert env.reset()[0].tolist() == seeded.reset()[0].tolist()


def test_some_of_a_vector_can_have_a_board_and_the_others_draw_theirs():
    envs, free = gym.make_vec(RANDOM, 3, **FEW), gym.make_vec(RANDOM, 3, **FEW)
    drawn = free.reset(seed=1)[1]["board"]
    assert envs.reset(seed=1, options={"board": [3, None, 0]})[1]["board"].tolist() == [3, drawn[1], 0]
    for wrong in ([1, 2], [1, 2, 9], [1, 2, 0.5], np.zeros((3, 1)), "012"):
        with pytest.raises(ValueError, match="board must be"):
            envs.reset(options={"board": wrong})


def test_the_same_seed_and_board_give_the_same_episode_every_time():
    env = gym.make(RANDOM, **FEW)
    options = {"board": np.array(2)}
    first = env.reset(seed=9, options=options)[0].tolist()
    env.reset(), env.reset(options={"board": 1})
    assert env.reset(seed=9, options=options)[0].tolist() == first
    assert options == {"board": np.array(2)}, "what is given stays as it is"


def test_control_characters_in_a_table_name_are_escaped():
    tables = [Table(name="a\u202e\x1b[2J")]
    with pytest.raises(ValueError, match="is the only table") as raised:
        gym.make(RANDOM, table=tables[0]).reset(options={"board": 0})
    assert str(raised.value).isprintable()


@pytest.mark.parametrize("wrong", [5, None, np.random.RandomState(0), "default"])
def test_an_invalid_generator_is_refused(wrong):
    for env in (gym.make(CLASSIC), gym.make_vec(CLASSIC, 2)):
        with pytest.raises(TypeError, match=r"np_random must be a numpy\.random\.Generator"):
            env.unwrapped.np_random = wrong
