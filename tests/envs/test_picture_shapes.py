"""The axes of picture observations: `channels` moves them, and nothing else."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballEnv, PinballVectorEnv

SHAPES = [
    (1, False, "first", (1, 20, 16)),
    (1, False, "last", (20, 16, 1)),
    (3, False, "first", (3, 20, 16)),
    (3, False, "last", (20, 16, 3)),
    (1, True, "first", (3, 20, 16)),
    (1, True, "last", (20, 16, 3)),
    (2, True, "first", (6, 20, 16)),
    (2, True, "last", (20, 16, 6)),
]


def channels_first(pictures: np.ndarray, stack: int, rgb: bool) -> np.ndarray:
    """The channels of pictures in the shape without `channels`, one by one, the oldest picture first."""
    each = pictures if stack > 1 else pictures[None]
    return np.array([one[..., color] if rgb else one for one in each for color in range(3 if rgb else 1)])


@pytest.mark.parametrize(("stack", "rgb", "channels", "shape"), SHAPES)
def test_the_channels_are_those_of_the_plain_pictures(stack, rgb, channels, shape):
    options = {"table": "classic", "observation": "pixels", "size": (20, 16), "stack": stack, "rgb": rgb}
    env, plain = PinballEnv(channels=channels, **options), PinballEnv(**options)
    assert env.observation_space.shape == shape
    pairs = [(env.reset(seed=1)[0], plain.reset(seed=1)[0])]
    pairs += [(env.step(step % 4)[0], plain.step(step % 4)[0]) for step in range(40)]
    assert not all((one == pairs[0][0]).all() for one, _ in pairs)
    for observation, other in pairs:
        assert observation in env.observation_space
        expected = channels_first(other, stack, rgb)
        axis = 0 if channels == "first" else -1
        assert (np.moveaxis(observation, axis, 0) == expected).all()


@pytest.mark.parametrize("zero_copy", [False, True])
@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
@pytest.mark.parametrize(("stack", "rgb", "channels", "shape"), SHAPES)
def test_a_vector_equals_single_environments(stack, rgb, channels, shape, mode, zero_copy):
    options = {"table": "classic", "observation": "pixels", "size": (20, 16), "stack": stack, "rgb": rgb}
    options |= {"channels": channels, "time_limit": 0.3}
    envs = PinballVectorEnv(3, mode, zero_copy, **options)
    alone = [PinballEnv(**options) for _ in range(3)]
    observations, _ = envs.reset(seed=5)
    firsts = [env.reset(seed=5 + number)[0] for number, env in enumerate(alone)]
    assert (observations == np.array(firsts)).all()
    for step in range(18):  # the episode ends in the last step
        observations, _, _, truncated, infos = envs.step(np.full(3, step % 4))
        steps = [env.step(step % 4)[0] for env in alone]
        last = step == 17
        assert truncated.all() == last
        if last and mode == "SAME_STEP":
            observations = np.stack(list(infos["final_obs"]))
        assert (observations == np.array(steps)).all()


def test_a_buffer_of_a_trainer_is_written_to_only_if_it_has_the_order_of_the_pictures():
    options = {"table": "classic", "observation": "pixels", "size": (20, 16), "stack": 1, "zero_copy": True}
    for rgb, channels, fits in [(False, "first", True), (True, "last", True), (True, "first", False)]:
        envs = PinballVectorEnv(2, rgb=rgb, channels=channels, **options)
        plain = PinballVectorEnv(2, rgb=rgb, channels=channels, **options)
        buffer = np.zeros(envs.observation_space.shape, np.uint8)
        ends = np.zeros((2, 2), bool)
        assert envs.write_to(buffer, ends[0], ends[1]) is fits
        envs.reset(seed=0)
        expected, _ = plain.reset(seed=0)
        assert (buffer == expected).all() == fits


def test_lives_are_the_balls_left_in_single_and_vector():
    with pytest.raises(KeyError):
        PinballEnv(table="classic", balls=3).reset(seed=0)[1]["lives"]
    env = gym.make("silverball/PinballClassic-v0", balls=3, lives=True)
    envs = gym.make_vec("silverball/PinballClassic-v0", 2, balls=3, lives=True, autoreset_mode="SAME_STEP")
    _, info = env.reset(seed=0)
    _, infos = envs.reset(seed=0)
    seen, over = [info["lives"]], False
    assert infos["lives"].tolist() == [3, 3]
    while not over:
        _, _, over, _, info = env.step(0)
        _, _, ended, _, infos = envs.step(np.zeros(2, int))
        now = infos["final_info"]["lives"] if ended[0] else infos["lives"]
        assert (info["lives"], info["lives"]) == (now[0], env.unwrapped.lives())
        seen.append(info["lives"])
    assert sorted(set(seen), reverse=True) == [3, 2, 1, 0]
    assert infos["lives"][0] == 3  # of the next episode
