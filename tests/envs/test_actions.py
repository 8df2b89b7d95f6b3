"""Actions of a step, and what Atari wrappers and `play` ask about them."""

from __future__ import annotations

import itertools

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils import play as playing

CLASSIC = "silverball/PinballClassic-v0"


TYPES = [bool, np.int8, np.uint8, np.int64, np.uint64, np.float16, np.float32, np.float64]


@pytest.mark.parametrize("kind", TYPES, ids=lambda kind: kind.__name__)
def test_bits_of_any_type_are_the_same_action(kind):
    env, same = (gym.make(CLASSIC, actions="multibinary", jitter=True) for _ in range(2))
    envs = gym.make_vec(CLASSIC, 2, actions="multibinary", jitter=True)
    env.reset(seed=0), same.reset(seed=0), envs.reset(seed=0)
    for bits in itertools.product((0, 1), repeat=3):
        action = np.array(bits, kind)
        assert env.action_space.contains(action)
        expected = same.step(np.array(bits, np.int8))[0].tolist()
        assert env.step(action)[0].tolist() == expected
        assert envs.step(np.array([bits, bits], kind))[0][0].tolist() == expected


@pytest.mark.parametrize("kind", [kind for kind in TYPES if np.issubdtype(kind, np.integer)])
def test_whole_numbers_of_any_width_are_the_same_action(kind):
    env, envs = gym.make(CLASSIC), gym.make_vec(CLASSIC, 4)
    env.reset(seed=0), envs.reset(seed=0)
    env.step(kind(3)), env.step(np.array(3, kind))
    envs.step(np.arange(4, dtype=kind))


@pytest.mark.parametrize("space", ["discrete", "multibinary"])
@pytest.mark.parametrize("seed", range(3))
def test_what_the_space_takes_the_step_takes(space, seed):
    env, envs = gym.make(CLASSIC, actions=space, create="button"), gym.make_vec(CLASSIC, 3, actions=space)
    env.reset(seed=0), envs.reset(seed=0)
    env.action_space.seed(seed), envs.action_space.seed(seed)
    for _ in range(20):
        for one, of in ((env.action_space.sample(), env), (envs.action_space.sample(), envs)):
            as_list = one.tolist() if isinstance(one, np.ndarray) else int(one)
            for action in (one, as_list):
                assert of.action_space.contains(action)
                of.step(action)
        if env.unwrapped.is_over:
            env.reset()


@pytest.mark.parametrize(
    "action",
    [
        [0.5, 0],
        [2.0, 0],
        [-1.0, 0],
        [np.nan, 0],
        [np.inf, 0],
        [0, 1, 0],
        [[0, 1]],
        ["a", "b"],
        None,
        [None, 1],
    ],
)
def test_bits_that_are_none_are_refused(action):
    env, envs = gym.make(CLASSIC, actions="multibinary"), gym.make_vec(CLASSIC, 1, actions="multibinary")
    env.reset(seed=0), envs.reset(seed=0)
    before = env.unwrapped.save_state()
    with pytest.raises(ValueError, match="action"):
        env.step(action)
    with pytest.raises(ValueError, match=r"action|bit"):
        envs.step([action])
    assert env.unwrapped.save_state() == before


@pytest.mark.parametrize(
    "kind", [*(kind.__name__ for kind in TYPES), "complex64", "object", "float128", "U1", "m8[s]"]
)
def test_a_step_takes_the_rows_that_the_space_takes_and_no_others(kind):
    env, envs = gym.make(CLASSIC, actions="multibinary"), gym.make_vec(CLASSIC, 1, actions="multibinary")
    env.reset(seed=0), envs.reset(seed=0)
    taken = 0
    for row in itertools.product((0, 1, 2), repeat=2):
        action = np.array(row).astype(kind)
        if env.action_space.contains(action):
            env.step(action), envs.step(action[None])
            taken += 1
            continue
        with pytest.raises(ValueError, match="action must be in MultiBinary"):
            env.step(action)
        with pytest.raises(ValueError, match="every bit of the actions must be 0 or 1"):
            envs.step(action[None])
    assert taken == {"U1": 0, "bool": 9}.get(kind, taken)
    assert taken or kind in ("U1", "m8[s]")


@pytest.mark.parametrize("actions", ["discrete", "multibinary"])
@pytest.mark.parametrize("action", [[[0], [0, 1]], [0, [1]], {}, object(), float("nan"), np.zeros((2, 2, 2))])
def test_what_is_no_action_at_all_is_refused_in_our_words(actions, action):
    env, envs = gym.make(CLASSIC, actions=actions), gym.make_vec(CLASSIC, 2, actions=actions)
    env.reset(seed=0), envs.reset(seed=0)
    with pytest.raises(ValueError, match="action must be in"):
        env.step(action)
    with pytest.raises(ValueError, match="actions must"):
        envs.step(action)


@pytest.mark.parametrize("action", [np.zeros(2), np.array([0.0, 1.0], np.float32)])
def test_floats_are_no_numbers_of_actions(action):
    for actions in ("discrete", "multibinary"):
        envs = gym.make_vec(CLASSIC, 2, actions=actions)
        envs.reset(seed=0)
        with pytest.raises(ValueError, match="actions must be integers"):
            envs.step(action)


@pytest.mark.parametrize(
    "options", [{}, {"jitter": True}, {"create": "button"}, {"jitter": True, "create": "button"}], ids=str
)
def test_every_action_has_a_meaning_and_keys(options):
    env = gym.make(CLASSIC, **options).unwrapped
    meanings, keys = env.get_action_meanings(), env.get_keys_to_action()
    assert len(meanings) == len(set(meanings)) == env.action_space.n
    assert meanings[:4] == ["NOOP", "LEFT", "RIGHT", "LEFT+RIGHT"]
    assert sorted(keys.values()) == list(range(1, env.action_space.n)), "play takes 0 when no key is held"
    for pressed, action in keys.items():
        held = [name for name in ("LEFT", "RIGHT", "JITTER", "CREATE") if name in meanings[action].split("+")]
        letters = {"a": "LEFT", "d": "RIGHT", "z": "JITTER", " ": "CREATE"}
        assert [letters[key] for key in pressed] == held


def test_keys_of_multibinary_actions_are_bits():
    env = gym.make(CLASSIC, actions="multibinary").unwrapped
    assert {keys: action.tolist() for keys, action in env.get_keys_to_action().items()} == {
        ("a",): [1, 0], ("d",): [0, 1], ("a", "d"): [1, 1],
    }  # fmt: skip


def test_lives_are_the_balls_that_are_not_in_the_gutter():
    env = gym.make(CLASSIC, balls=3, stall=None).unwrapped
    env.reset(seed=0)
    over = False
    while not over:
        *_, over, _, info = env.step(0)
        assert env.ale.lives() == 3 - info["drained"]
    assert env.ale.lives() == 0


@pytest.mark.parametrize(
    "options", [{}, {"jitter": True, "create": "button"}, {"actions": "multibinary", "jitter": True}], ids=str
)
def test_a_person_can_play_it_with_gymnasiums_own_program(options, monkeypatch):
    import pygame

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gym.make(CLASSIC, render_mode="rgb_array", **options)
    keys = {4: (pygame.KEYDOWN, pygame.K_a), 8: (pygame.KEYDOWN, pygame.K_d), 12: (pygame.KEYUP, pygame.K_a)}
    held = []

    def watch(before, after, action, *rest):
        held.append(int(np.dot(action, 1 << np.arange(np.size(action)))) if np.ndim(action) else action)
        kind, key = keys.get(len(held), (pygame.USEREVENT, 0))
        pygame.event.post(pygame.event.Event(pygame.QUIT if len(held) == 16 else kind, key=key))

    playing.play(env, callback=watch, fps=1000, seed=1)
    assert held == [0] * 4 + [1] * 4 + [3] * 4 + [2] * 4
