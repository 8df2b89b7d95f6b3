"""Environments on tables with more balls than two."""

from __future__ import annotations

import numpy as np
import pytest

from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.table import load_table

CLASSIC = load_table("classic")
TABLE = CLASSIC.replace(board=CLASSIC.board.replace(max_balls=5))
OPTIONS = {"table": TABLE, "balls": 5, "create": "button"}
CREATE = 4


def test_a_ball_of_every_slot_is_shown_where_it_is():
    env = PinballEnv(**OPTIONS, observation="dict")
    observation, _ = env.reset(seed=3)
    assert observation["balls"].shape == (5, 5)
    for step in range(40):
        observation, *_ = env.step(CREATE if step % 4 == 0 else 0)
    balls = env._engine.batch.state[0]["ball"]
    assert (balls["id"] != 0).sum() >= 4
    half = np.array([TABLE.board.length, TABLE.board.width]) / 2
    for ball, shown in zip(balls[:5], observation["balls"], strict=True):
        assert shown[0] == (ball["id"] != 0)
        if shown[0]:
            np.testing.assert_allclose(shown[1:3] * half, [ball["x"], ball["z"]], atol=2e-6)


def test_the_slots_after_the_balls_keep_their_order():
    layout = [field.group.name for field in PinballEnv(**OPTIONS)._engine.pool.fields]
    two_balls = [field.group.name for field in PinballEnv(table=CLASSIC)._engine.pool.fields]
    assert layout == two_balls
    row, _ = PinballEnv(**OPTIONS).reset(seed=1)
    two, _ = PinballEnv(table=CLASSIC, balls=5, create="button").reset(seed=1)
    assert row[25:].tolist() == two[10:].tolist()


@pytest.mark.parametrize("seed", [0, 7])
def test_a_vector_shows_what_single_environments_show(seed):
    vector = PinballVectorEnv(3, "Disabled", **OPTIONS)
    singles = [PinballEnv(**OPTIONS) for _ in range(3)]
    rows, _ = vector.reset(seed=seed)
    for number, env in enumerate(singles):
        assert env.reset(seed=seed + number)[0].tolist() == rows[number].tolist()
    random = np.random.default_rng(seed)
    for _ in range(300):
        actions = random.integers(0, 8, 3)
        rows, rewards, ended, *_ = vector.step(actions)
        for number, env in enumerate(singles):
            row, reward, over, *_ = env.step(actions[number])
            assert (row.tolist(), reward, over) == (rows[number].tolist(), rewards[number], ended[number])
        if ended.any():
            break
