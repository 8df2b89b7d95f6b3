"""Boards that differ in their physics: `vary`, and lists of tables that differ only in physics."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec

import silverball as sb
from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.envs.variation import BOARD_KEYS, KEYS, PART_KEYS
from silverball.table.kinds.board import Board

CLASSIC = sb.load_table("classic")
VARY = {"board.gravity": (7.0, 13.0), "paddle.stroke": (0.09, 0.14), "cylinder.restitution": (0.6, 1.0)}


def played(env: PinballEnv, seed: int, steps: int = 200) -> list[list[float]]:
    """The observations of some steps, both paddles moving."""
    found = [env.reset(seed=seed)[0].tolist()]
    for step in range(steps):
        observation, _, over, *_ = env.step(3 * (step // 9 % 2))
        found.append(observation.tolist())
        if over:
            break
    return found


def test_the_worlds_of_a_vector_have_their_own_physics_and_equal_tables_with_these_numbers():
    envs = PinballVectorEnv(6, table=CLASSIC, vary=VARY, boards=6, own_boards=True)
    observations, infos = envs.reset(seed=3)
    assert infos["board"].tolist() == [*range(6)]
    numbers = envs.varied
    assert all(len(set(values)) == 6 for values in numbers.values())
    alone = []
    for row in range(6):
        values = {key: float(numbers[key][row]) for key in VARY}
        table = CLASSIC.replace(
            board={"gravity": values["board.gravity"]},
            paddle=[one.replace(stroke=values["paddle.stroke"]) for one in CLASSIC.paddle],
            cylinder=[one.replace(restitution=values["cylinder.restitution"]) for one in CLASSIC.cylinder],
        )
        assert envs.batch.tables[row] == table
        alone.append(PinballEnv(table=table))
    random = np.random.default_rng(0)
    for env, row in zip(alone, range(6), strict=True):
        env.reset(seed=3 + row)
    paddle_turns = slice(11, 15, 3)  # in the speed of the fastest stroke of all boards
    for _ in range(200):
        actions = random.integers(0, 4, 6)
        observations, rewards, terminated, _, _ = envs.step(actions)
        assert envs.observation_space.contains(observations)
        for row in np.flatnonzero([not env.is_over for env in alone]):
            observation, reward, over, *_ = alone[row].step(actions[row])
            other = observations[row].copy()
            other[paddle_turns] = observation[paddle_turns]
            assert other.tolist() == observation.tolist()
            assert (rewards[row], terminated[row]) == (reward, over)


def test_a_number_lies_in_its_range_follows_from_seed_and_key_and_fills_the_range():
    options = {"table": "classic", "boards": 60, "own_boards": True}
    envs = PinballVectorEnv(60, vary=VARY, **options)
    envs.reset(seed=0)
    for key, (least, greatest) in VARY.items():
        shares = (envs.varied[key] - least) / (greatest - least)
        assert 0.0 <= shares.min() < 0.1
        assert 0.9 < shares.max() < 1.0
        assert abs(shares.mean() - 0.5) < 4.0 * 12**-0.5 / 60**0.5
    gravity = PinballVectorEnv(60, vary={"board.gravity": (7.0, 13.0)}, **options)
    gravity.reset(seed=9)
    assert gravity.varied["board.gravity"].tolist() == envs.varied["board.gravity"].tolist()
    shifted = PinballVectorEnv(59, vary=VARY, **{**options, "boards": 59}, board_seed=1)
    shifted.reset(seed=0)
    assert shifted.varied["paddle.stroke"].tolist() == envs.varied["paddle.stroke"][1:].tolist()


def test_without_own_boards_an_episode_draws_its_physics_and_a_reset_can_choose_them():
    env = PinballEnv(table="classic", vary=VARY, boards=4)
    drawn = set()
    env.reset(seed=0)
    for _ in range(30):
        _, info = env.reset()
        drawn.add((info["board"], env.varied["board.gravity"]))
    assert [board for board, _ in sorted(drawn)] == [0, 1, 2, 3]
    _, info = env.reset(options={"board": 2})
    assert (2, env.varied["board.gravity"]) in drawn
    assert info["board"] == 2
    copy = pickle.loads(pickle.dumps(env))
    assert copy.varied == env.varied


@pytest.mark.parametrize(
    "table", ["random", [CLASSIC, CLASSIC.replace(name="Other")]], ids=["recipe", "list"]
)
def test_recipes_and_lists_vary_too(table):
    env = PinballEnv(table=table, vary={"board.gravity": (1.0, 2.0)}, boards=2)
    gravities = {one.board.gravity for one in env._engine.batch.tables}
    assert len(gravities) == 2
    assert all(1.0 <= gravity <= 2.0 for gravity in gravities)


def test_less_gravity_makes_longer_balls():
    ends = []
    for gravity in (6.0, 14.0):
        envs = PinballVectorEnv(200, table="classic", vary={"board.gravity": (gravity, gravity)}, boards=1)
        envs.reset(seed=0)
        ends.append(sum(envs.step(np.zeros(200, int))[2].sum() for _ in range(1500)))
    assert ends[1] > 1.2 * ends[0] > 100


def test_a_list_may_differ_in_physics_but_not_in_places():
    light = CLASSIC.replace(board={"gravity": 5.0})
    envs = PinballVectorEnv(4, table=[CLASSIC, light], own_boards=True)
    assert [table.board.gravity for table in envs.batch.tables] == [CLASSIC.board.gravity, 5.0]
    longer = CLASSIC.replace(paddle=[one.replace(length=2.0) for one in CLASSIC.paddle])
    with pytest.raises(ValueError, match=r"different \[paddle\] .* equal but for physics"):
        PinballEnv(table=[CLASSIC, longer])


def test_a_varied_spec_goes_through_json():
    env = gym.make("silverball/PinballClassic-v0", vary=VARY, boards=3)
    again = gym.make(EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.options == env.unwrapped.options
    assert again.reset(seed=5)[0].tolist() == env.reset(seed=5)[0].tolist()
    assert again.unwrapped.varied == env.unwrapped.varied


def test_states_move_between_environments_that_vary_alike_and_to_no_others():
    envs = PinballVectorEnv(2, table="classic", vary=VARY, boards=3)
    envs.reset(seed=0)
    state = envs.save_state(0)
    alone = PinballEnv(table="classic", vary=VARY, boards=3)
    alone.restore_state(state.tobytes())
    assert alone.varied == {key: numbers[0] for key, numbers in envs.varied.items()}
    with pytest.raises(sb.StateError):
        PinballEnv(table="classic", boards=3).restore_state(state.tobytes())


def test_the_numbers_are_the_same_on_every_machine():
    """They come from a published hash: `printf '7 board.gravity' | sha256sum`."""
    env = PinballEnv(table="classic", vary={"board.gravity": (7.0, 13.0)}, boards=1, board_seed=7)
    env.reset(seed=0)
    share = int("600064433f0f", 16) / 16**12
    assert env.varied == {"board.gravity": 7.0 + 6.0 * share}


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        (4, "vary must be a dict"),
        ({"board.gravty": (1, 2)}, "did you mean 'board.gravity'"),
        ({"board.length": (10, 20)}, "unknown key 'board.length'"),
        ({"board.gravity": 3}, r"must be \(least, greatest\), got 3"),
        ({"board.gravity": (1, 2, 3)}, r"must be \(least, greatest\)"),
        ({"board.gravity": ("1", "2")}, r"must be \(least, greatest\)"),
        ({"board.gravity": (5, 1)}, "finite and ascending"),
        ({"board.gravity": (0, float("inf"))}, "finite and ascending"),
        ({"board.gravity": (5, 1000)}, "board.gravity must be 0 to 100 u/s², got 1000"),
        ({"paddle.stroke": (0.02, 0.1)}, "must stay below the speed cap"),
        ({"gate.friction": (0, 1)}, "Classic has no gate"),
    ],
    ids=str,
)
def test_what_cannot_vary_is_refused_with_a_sentence(vary, message):
    with pytest.raises(ValueError, match=message) as error:
        PinballEnv(table="classic", vary=vary)
    assert "\n" not in str(error.value)


def test_every_key_is_a_number_of_the_table_file():
    assert set(BOARD_KEYS) < set(Board.model_fields)
    assert {key.partition(".")[2] for key in KEYS if not key.startswith("board.")} == set(PART_KEYS)
