"""A restored state continues exactly as the original did."""

from __future__ import annotations

import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballEnv, PinballVectorEnv
from silverball.envs.engine import SIGNATURE_SIZE
from silverball.envs.state import PICTURE_STATE
from silverball.errors import StateError

OPTIONS = [
    {"table": "classic", "jitter": True},
    {"boards": 3, "balls": 3},
    {"table": "classic", "observation": "pixels", "size": (20, 12), "stack": 3},
    {"table": "classic", "observation": "dict", "create": "button"},
]


def as_lists(observation):
    if isinstance(observation, dict):
        return {name: part.tolist() for name, part in observation.items()}
    return observation.tolist()


def steps(env, count: int, seed: int) -> list:
    """What comes of random actions."""
    results = []
    for action in np.random.default_rng(seed).integers(0, env.action_space.n, count):
        observation, *rest = env.step(action)
        results.append((as_lists(observation), *rest))
        if rest[1] or rest[2]:
            observation, info = env.reset()
            results.append((as_lists(observation), info))
    return results


@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_a_restored_environment_goes_on_bit_for_bit(options):
    env = PinballEnv(**options)
    env.reset(seed=3)
    for round_ in range(5):
        steps(env, 50, round_)
        state = env.save_state()
        seen = as_lists(env.observe())
        future = steps(env, 300, 100 + round_)
        env.restore_state(state)
        assert as_lists(env.observe()) == seen, "the observation is valid at once"
        assert env.save_state() == state
        assert steps(env, 300, 100 + round_) == future
        fresh = PinballEnv(**options)
        fresh.restore_state(state)
        assert steps(fresh, 300, 100 + round_) == future, "in another environment too"


def test_pictures_after_a_restore_are_those_from_before_without_observing():
    options = OPTIONS[2]
    env, twin = PinballEnv(**options), PinballEnv(**options)
    env.reset(seed=3), twin.reset(seed=8)
    steps(env, 30, 0)
    twin.restore_state(env.save_state())
    assert steps(twin, 10, 1) == steps(env, 10, 1)


def test_a_state_is_the_same_in_another_process():
    script = (
        "from silverball.envs import PinballEnv; import sys; env = PinballEnv(table='classic');"
        "env.restore_state(bytes.fromhex(sys.argv[1]));"
        "print([env.step(a % 4)[0].tobytes().hex() for a in range(50)][-1])"
    )
    env = PinballEnv(table="classic")
    env.reset(seed=3)
    steps(env, 10, 0)
    state = env.save_state()
    (last,) = [env.step(a % 4)[0].tobytes().hex() for a in range(50)][-1:]
    run = [sys.executable, "-c", script, state.hex()]
    assert subprocess.run(run, capture_output=True, text=True, check=True).stdout.strip() == last


def test_one_state_branches_into_a_vector_and_a_row_goes_back():
    env = PinballEnv(table="classic")
    env.reset(seed=3)
    steps(env, 20, 0)
    envs = PinballVectorEnv(4, "Disabled", table="classic")
    envs.restore_state(env.save_state())
    assert [row.tolist() for row in envs.observe()] == [env.observe().tolist()] * 4
    observations, *_ = envs.step(np.arange(4))
    assert observations[2].tolist() == env.step(2)[0].tolist()
    assert envs.save_state(2)[0].tobytes() == env.save_state()
    env.restore_state(envs.save_state()[1].tobytes())
    assert env.observe().tolist() == observations[1].tolist()


def test_a_vector_goes_back_and_on_bit_for_bit():
    envs = gym.make_vec("silverball/Pinball-v0", 6, boards=2, time_limit=1.0)
    envs.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, 4, (150, 6))
    for action in actions[:50]:
        envs.step(action)
    states = envs.save_state()
    future = [envs.step(action)[0].tolist() for action in actions]
    envs.restore_state(states)
    assert [envs.step(action)[0].tolist() for action in actions] == future
    envs.restore_state(states[[1, 0]], [0, 1])
    swapped = envs.observe()
    envs.restore_state(states)
    assert swapped[[1, 0]].tolist() == envs.observe()[:2].tolist()


@pytest.mark.parametrize(
    ("state", "message"),
    [(b"abc", "bytes, as save_state made it"), ("text", "got str"), (None, "got NoneType")],
)
def test_an_invalid_state_is_refused(state, message):
    env = PinballEnv(table="classic")
    env.reset(seed=0)
    before = env.save_state()
    with pytest.raises(StateError, match=message):
        env.restore_state(state)
    assert env.save_state() == before


def test_a_state_of_other_boards_or_another_rate_is_refused():
    env = PinballEnv(table="classic")
    env.reset(seed=0)
    for other in ({"table": "rolling"}, {"table": "classic", "tick_rate": 240}):
        with pytest.raises(StateError, match="other boards"):
            PinballEnv(**other).restore_state(env.save_state())
        with pytest.raises(StateError, match="other boards"):
            PinballVectorEnv(2, **other).restore_state(env.save_state())


@pytest.mark.parametrize("options", [{"table": "classic"}, OPTIONS[1], OPTIONS[2]], ids=str)
@pytest.mark.parametrize("number", [-1, 3, 10**9])
def test_a_state_with_an_unknown_board_is_refused(options, number):
    env, envs = PinballEnv(**options), PinballVectorEnv(2, **options)
    env.reset(seed=0), envs.reset(seed=0)
    places = [SIGNATURE_SIZE]
    if "observation" in options:
        places.append(len(env.save_state()) - 3 * PICTURE_STATE.itemsize)  # the board of the first scene
    for place in places:
        state = bytearray(env.save_state())
        state[place : place + 8] = np.int64(number).tobytes()
        for one in (env, envs):
            before = bytes(np.asarray(one.save_state()))
            with pytest.raises(StateError, match="other boards"):
                one.restore_state(bytes(state))
            assert bytes(np.asarray(one.save_state())) == before


def test_a_state_from_before_the_first_reset_has_no_seed_yet():
    blank = PinballEnv(table="classic").save_state()
    starts = []
    for _ in range(2):
        env = PinballEnv(table="classic")
        env.restore_state(blank)
        starts.append(env.reset()[0].tolist())
        env.reset(seed=0)
        starts.append(env.save_state())
    assert starts[0] != starts[2]
    assert starts[1] == starts[3]


def test_a_wrong_number_of_states_is_refused():
    envs = PinballVectorEnv(3, table="classic")
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"one state or 3 of them.*got 2"):
        envs.restore_state(envs.save_state([0, 1]))
