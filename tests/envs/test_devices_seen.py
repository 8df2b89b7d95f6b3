"""Environments on tables with a plunger, levels, drop targets and spinners."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.physics.records import MAX_LEVELS, Motion
from silverball.table import Table, load_table

CLASSIC = load_table("classic")
TABLE = Table.model_validate(
    {
        "name": "Devices",
        "board": {"max_balls": 3},
        "paddle": [
            *CLASSIC.paddle,
            {"side": "left", "pivot": (2.0, -3.5), "length": 1.5},
        ],
        "plunger": [{"position": (-6.0, 3.6), "launch": (6.0, 20.0), "charge": 1.0}],
        "drop_target": [{"start": (4.0, 3.2), "end": (4.0, 4.0), "bank": "top", "reset_after": 1.0}],
        "spinner": [{"start": (0.0, 3.0), "end": (0.0, 4.4)}],
        "passage": [{"start": (2.0, 3.0), "end": (2.0, 4.4), "from": 0, "to": 1}],
        "level": [{"number": 1}],
    }
)
LAUNCH = 4


@pytest.fixture
def env() -> PinballEnv:
    return PinballEnv(table=TABLE, observation="dict", balls=3, stall=None)


def test_a_table_with_a_plunger_has_a_button_for_it(env):
    assert env.action_space == gym.spaces.Discrete(8)
    assert env.get_action_meanings()[LAUNCH] == "LAUNCH"
    assert env.get_keys_to_action()["\r",] == LAUNCH
    assert PinballEnv(table=CLASSIC).action_space == gym.spaces.Discrete(4)
    assert PinballEnv(table=TABLE, jitter=True, create="button").get_action_meanings()[16] == "LAUNCH"


def test_every_observation_lies_in_its_space(env):
    observation, _ = env.reset(seed=1)
    random = np.random.default_rng(0)
    for _ in range(600):
        assert env.observation_space.contains(observation)
        observation, _, over, *_ = env.step(int(random.integers(8)))
        if over:
            break


def test_the_wait_on_the_plunger_its_charge_and_the_launch_are_shown(env):
    observation, _ = env.reset(seed=1)
    assert observation["ball_places"][0].tolist() == [0.0, 1.0]
    assert observation["plunger"].tolist() == [[0.0]]
    charges = [float(env.step(LAUNCH)[0]["plunger"][0, 0]) for _ in range(90)]
    assert charges[29] == pytest.approx(0.5, abs=0.02)
    assert charges == sorted(charges)
    assert charges[-1] == 1.0
    observation, *_ = env.step(0)
    assert observation["ball_places"][0, 1] == 0.0
    assert observation["balls"][0, 3] > 0.0


def test_a_third_paddle_moves_with_its_button_and_has_slots_of_its_own(env):
    env.reset(seed=1)
    for _ in range(20):
        observation, *_ = env.step(1)
    assert observation["paddles"].shape == (3, 3)
    assert observation["paddles"][:, 0].tolist() == [1.0, 0.0, 1.0]
    assert observation["paddles"][:, 2].tolist() == [1.0, 0.0, 1.0]


def test_levels_switches_and_spinners_are_shown_as_the_world_has_them(env):
    env.reset(seed=1)
    world = env._engine.batch.state[0]
    world["ball"]["level"][0] = 1
    world["off"] = 1
    world["spinner"]["speed"][0], world["spinner"]["tick"][0] = 20.0, world["tick"]
    observation = env.observe()
    assert observation["ball_places"][0, 0] == pytest.approx(1 / (MAX_LEVELS - 1))
    assert observation["switches"].tolist() == [[0.0]]
    height = TABLE.spinner[0].height
    assert observation["spinners"][0, 0] == pytest.approx(20.0 * height / TABLE.board.speed_cap, rel=1e-6)
    world["off"] = 0
    assert env.observe()["switches"].tolist() == [[1.0]]


@pytest.mark.parametrize("seed", [0, 5])
def test_a_vector_does_what_single_environments_do(seed):
    options = {"table": TABLE, "balls": 3, "create": "button"}
    vector = PinballVectorEnv(3, "Disabled", **options)
    singles = [PinballEnv(**options) for _ in range(3)]
    rows, _ = vector.reset(seed=seed)
    for number, one in enumerate(singles):
        assert one.reset(seed=seed + number)[0].tolist() == rows[number].tolist()
    random = np.random.default_rng(seed)
    for _ in range(500):
        actions = random.integers(0, 16, 3)
        rows, rewards, ended, *_ = vector.step(actions)
        for number, one in enumerate(singles):
            row, reward, over, *_ = one.step(actions[number])
            assert (row.tolist(), reward, over) == (rows[number].tolist(), rewards[number], ended[number])
        if ended.any():
            break
    assert (vector.batch.state["ball"]["motion"] != Motion.CAPTURED).any()


def test_a_saved_state_continues_bit_for_bit():
    one, other = (PinballEnv(table=TABLE, balls=3) for _ in range(2))
    one.reset(seed=3)
    other.reset(seed=9)
    for step in range(200):
        if step == 80:
            other.restore_state(one.save_state())
        action = LAUNCH if step % 90 < 60 else step // 7 % 4
        row, *_ = one.step(action)
        if step >= 80:
            assert other.step(action)[0].tolist() == row.tolist()


def test_a_table_with_the_right_paddle_first_shows_the_left_one_first():
    swapped = CLASSIC.model_copy(update={"paddle": CLASSIC.paddle[::-1]})
    alone = CLASSIC.model_copy(update={"paddle": CLASSIC.paddle[1:]})
    for table, expected in ((swapped, [[1.0, 0.0, 1.0], [0.0] * 3]), (alone, [[0.0] * 3, [0.0] * 3])):
        env = PinballEnv(table=table, observation="dict")
        env.reset(seed=0)
        for _ in range(20):
            observation, *_ = env.step(1)
        assert observation["paddles"].tolist() == expected
