"""The slots of an observation hold what their descriptions say."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import GROUPS, PinballEnv
from silverball.envs.observations import fields
from silverball.table import generate_table, load_table
from silverball.world import World

TABLE = load_table("classic")
BOARD = TABLE.board


@pytest.fixture
def env() -> PinballEnv:
    env = PinballEnv("rgb_array", table="classic", balls=3, jitter=True, observation="dict")
    env.reset(seed=4)
    return env


def test_the_table_names_every_slot_once_and_says_what_each_means():
    for group in GROUPS:
        assert len(group.means) == len(group.slots)
        assert [slot.value for slot in group.slots] == list(range(len(group.slots)))
    layout = fields({"balls": 2, "paddles": 2, "game": 1, "triangular_prisms": 4, "cylinders": 3})
    shown = [field.first for field in layout if field.items]
    assert shown == [0, 10, 16, 18, 42]  # as trained policies know them
    assert [field.first for field in layout[1:]] == [field.end for field in layout[:-1]]


def test_balls_have_the_values_of_the_world(env):
    world = env.unwrapped._engine.batch.state[0]
    for action in [0, 3, 1, 4, 2, 0] * 20:
        observation, *_ = env.step(action)
        for ball, (alive, x, z, vx, vz) in zip(world["ball"][:2], observation["balls"], strict=True):
            there = ball["id"] != 0
            assert alive == there
            shown = np.array(
                [x * BOARD.length / 2, z * BOARD.width / 2, vx * BOARD.speed_cap, vz * BOARD.speed_cap]
            )
            real = [ball[name] if there else 0.0 for name in ("x", "z", "vx", "vz")]
            np.testing.assert_allclose(shown, real, atol=2e-6)  # 32-bit floats of up to 22


def test_paddles_are_shown_from_rest_to_up(env):
    still, *_ = env.step(0)
    assert still["paddles"].tolist() == [[0, 0, 0], [0, 0, 0]]
    paddle = TABLE.paddle[0]
    lifting, *_ = env.step(1)
    assert lifting["paddles"][0] == pytest.approx([1 / 60 / paddle.stroke, 1, 1])
    assert lifting["paddles"][1].tolist() == [0, 0, 0]
    for _ in range(math.ceil(60 * paddle.stroke)):
        up, *_ = env.step(1)
    assert up["paddles"][0].tolist() == [1, 0, 1]
    falling, *_ = env.step(0)
    assert falling["paddles"][0] == pytest.approx([1 - 1 / 60 / paddle.return_stroke, -1, 0])


def test_patience_runs_out_and_comes_back_with_a_scoring_hit(env):
    patience, score = 1.0, 0
    gained = 0
    for _ in range(600):
        observation, _, over, _, info = env.step(0)
        if over or info["created"] > 1:
            break
        now = float(observation["game"][0, 0])
        if info["score"] > score:
            assert now == 1.0
            gained += 1
        else:
            assert now == pytest.approx(patience - 1 / (15 * 60), abs=1e-6)
        patience, score = now, info["score"]
    assert gained


def test_balls_to_come_are_shown_as_a_share(env):
    shares = []
    for _ in range(6000):
        observation, _, over, _, info = env.step(0)
        shares.append((info["created"], float(observation["game"][0, 1])))
        if over:
            break
    assert sorted(set(shares)) == [(1, pytest.approx(2 / 3)), (2, pytest.approx(1 / 3)), (3, 0.0)]


def test_obstacles_are_shown_where_the_table_has_them():
    env = gym.make("silverball/Pinball-v0", boards=3, observation="dict")
    observation, info = env.reset(seed=1)
    seen = set()
    for _ in range(20):
        table = generate_table(info["board"])
        seen.add(info["board"])
        half = np.array([BOARD.length / 2, BOARD.width / 2])
        corners = np.array([prism.corners() for prism in table.triangular_prism]) / half
        np.testing.assert_allclose(observation["triangular_prisms"].reshape(-1, 3, 2), corners, atol=1e-6)
        circles = np.array([cylinder.circle() for cylinder in table.cylinder]) / [*half, BOARD.width / 2]
        np.testing.assert_allclose(observation["cylinders"], circles, atol=1e-6)
        observation, info = env.reset()
    assert seen == {0, 1, 2}


def test_absent_parts_are_zeros():
    table = TABLE.model_copy(update={"paddle": TABLE.paddle[:1], "cylinder": (), "triangular_prism": ()})
    observation, _ = PinballEnv(table=table).reset(seed=0)
    assert len(observation) == 18
    assert observation[5:10].tolist() == [0.0] * 5
    assert observation[13:16].tolist() == [0.0] * 3


def test_the_world_of_an_environment_equals_a_world_with_the_same_seed():
    env = PinballEnv(table="classic")
    env.reset(seed=2)
    record = env._engine.batch.state[0]
    world = World(TABLE, int(record["seed"]), 60)
    world.create_ball()
    random = np.random.default_rng(0)
    for _ in range(600):
        action = int(random.integers(4))
        *_, over, _, info = env.step(action)
        world.step(left=bool(action & 1), right=bool(action & 2))
        assert (info["score"], info["touches"]) == (world.score, int(world.records[0]["touches"]))
        assert record.tobytes() == world.records[0].tobytes()
        if over:
            break
    assert world.tick > 60
