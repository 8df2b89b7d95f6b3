"""The option `sight`: what is hidden, and what is not."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballEnv
from silverball.table import load_table

CLASSIC = "silverball/PinballClassic-v0"
BALLS, VELOCITIES, TURNS = slice(0, 5), [3, 4, 8, 9], [11, 14]


def rows_of(sight, seed: int = 7, steps: int = 400) -> np.ndarray:
    env = gym.make(CLASSIC, sight=sight)
    rows = [env.reset(seed=seed)[0]]
    for step in range(steps):
        observation, _, terminated, *_ = env.step(3 * (step % 3 == 0))
        rows.append(observation)
        if terminated:
            break
    return np.array(rows)


def test_a_ball_is_hidden_exactly_while_it_is_farther_from_both_paddles():
    everything, near = rows_of(None), rows_of(6.0)
    paddles = np.array([paddle.pivot for paddle in load_table("classic").paddle])
    places = everything[:, [1, 2]] * [10.0, 5.0]
    distance = np.linalg.norm(places[:, None] - paddles, axis=2).min(axis=1)
    is_seen = (everything[:, 0] == 1.0) & (distance <= 6.0)
    assert 10 < is_seen.sum() < len(is_seen) - 10
    assert (near[is_seen] == everything[is_seen]).all()
    assert not near[~is_seen, BALLS].any()
    assert (near[:, 10:] == everything[:, 10:]).all(), "nothing else is hidden"


def test_positions_without_velocities_are_those_of_the_full_observation():
    everything, still = rows_of(None), rows_of("positions")
    assert everything[:, TURNS].any()
    assert not still[:, VELOCITIES + TURNS].any()
    others = [column for column in range(everything.shape[1]) if column not in VELOCITIES + TURNS]
    assert (still[:, others] == everything[:, others]).all()


@pytest.mark.parametrize(
    "options", [{"sight": 6.0}, {"sight": "positions"}, {"sight": 6.0, "observation": "pixels"}], ids=str
)
def test_a_vector_sees_what_single_environments_see(options):
    envs = gym.make_vec(CLASSIC, 3, autoreset_mode="DISABLED", **options)
    singles = [gym.make(CLASSIC, **options) for _ in range(3)]
    rows, _ = envs.reset(seed=5)
    for number, single in enumerate(singles):
        assert (single.reset(seed=5 + number)[0] == rows[number]).all()
    for step in range(60):
        rows = envs.step(np.full(3, step % 4))[0]
        for number, single in enumerate(singles):
            assert (single.step(step % 4)[0] == rows[number]).all()


def test_pictures_do_not_show_a_hidden_ball_and_show_it_when_it_comes_near():
    options = {"observation": "pixels", "stack": 1}
    full, part = gym.make(CLASSIC, **options), gym.make(CLASSIC, sight=3.0, **options)
    state = gym.make(CLASSIC, sight=3.0)
    full.reset(seed=2), part.reset(seed=2), state.reset(seed=2)
    seen = []
    for _ in range(200):
        rows = [env.step(0)[0] for env in (full, part, state)]
        if state.unwrapped.is_over:
            break
        is_seen = rows[2][0] == 1.0
        assert (rows[0] == rows[1]).all() == is_seen
        seen.append(bool(is_seen))
    assert set(seen) == {False, True}


def test_the_play_is_the_same_whatever_is_seen():
    everything, near = (gym.make(CLASSIC, sight=sight) for sight in (None, 3.0))
    everything.reset(seed=2), near.reset(seed=2)
    for step in range(300):
        one, other = everything.step(step % 4), near.step(step % 4)
        assert one[1:] == other[1:]
        if one[2]:
            break


@pytest.mark.parametrize(
    ("sight", "message"),
    [
        (0.0, "above 0 u"),
        (-1.0, "0 to 100 u"),
        ("near", "got 'near'"),
        (True, "got (true|True)"),
        (np.nan, "nan"),
    ],
)
def test_an_impossible_sight_is_refused(sight, message):
    with pytest.raises(ValueError, match=f"^sight must be .*{message}"):
        PinballEnv(table="classic", sight=sight)


def test_pictures_without_velocities_are_refused_with_the_remedy():
    with pytest.raises(ValueError, match=r"^sight must be .*a picture shows no velocities; with stack=1"):
        PinballEnv(table="classic", sight="positions", observation="pixels")
