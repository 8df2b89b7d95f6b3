"""The adapter for Stable-Baselines3."""

from __future__ import annotations

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector.utils import batch_space

sb3 = pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed")

from stable_baselines3.common.atari_wrappers import AtariWrapper  # noqa: E402
from stable_baselines3.common.env_checker import check_env  # noqa: E402
from stable_baselines3.common.evaluation import evaluate_policy  # noqa: E402
from stable_baselines3.common.preprocessing import is_image_space  # noqa: E402
from stable_baselines3.common.vec_env import SubprocVecEnv  # noqa: E402

from silverball.envs import IDS, PinballVectorEnv  # noqa: E402
from silverball.envs.sb3 import SilverballVecEnv  # noqa: E402

OPTIONS = {"table": "classic", "time_limit": 6.0}


@pytest.mark.parametrize("id_", IDS)
def test_its_checker_accepts_the_environment(id_):
    env = gym.make(id_, **({} if "Classic" in id_ else {"boards": 2}))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env)


@pytest.mark.parametrize(
    "reward", ["score", {"points": 0.5, "drained": -2.0}, lambda terms: terms["touches"] - 1.0]
)
def test_a_step_equals_that_of_the_vector_environment_with_infos_of_ended_episodes(reward):
    options = {**OPTIONS, "reward": reward}
    envs, plain = SilverballVecEnv(5, seed=3, **options), PinballVectorEnv(5, "SameStep", **options)
    assert envs.reset().tolist() == plain.reset(seed=3)[0].tolist()
    random, lengths, returns = np.random.default_rng(0), np.zeros(5, int), np.zeros(5)
    truncated_ones = ended_ones = 0
    for _ in range(1500):
        actions = random.integers(0, 4, 5)
        observations, rewards, ended, told = envs.step(actions)
        expected, gained, terminated, truncated, infos = plain.step(actions)
        assert observations.tolist() == expected.tolist()
        assert rewards.dtype == np.float32
        assert rewards.tolist() == gained.astype(np.float32).tolist()
        assert ended.tolist() == (terminated | truncated).tolist()
        lengths += 1
        returns += gained
        for row, info in enumerate(told):
            if not ended[row]:
                assert info == {}
                continue
            assert info["terminal_observation"].tolist() == infos["final_obs"][row].tolist()
            assert info["TimeLimit.truncated"] is bool(truncated[row])
            assert (info["episode"]["l"], info["episode"]["r"]) == (lengths[row], pytest.approx(returns[row]))
            assert info["score"] == infos["final_info"]["score"][row]
            truncated_ones += truncated[row]
            lengths[row], returns[row] = 0, 0
            ended_ones += 1
    assert ended_ones > truncated_ones > 0


@pytest.mark.parametrize(
    ("options", "shape"),
    [
        ({"stack": 1}, (1, 40, 36)),
        ({"stack": 3}, (3, 40, 36)),
        ({"stack": 1, "rgb": True}, (40, 36, 3)),
        ({"stack": 2, "rgb": True}, (6, 40, 36)),
    ],
    ids=str,
)
def test_pictures_are_images(options, shape):
    options = {"table": "classic", "time_limit": 1.0, "observation": "pixels", "size": (40, 36), **options}
    envs, plain = SilverballVecEnv(3, seed=3, **options), PinballVectorEnv(3, "SameStep", **options)
    assert envs.observation_space.shape == shape
    assert is_image_space(envs.observation_space)

    plain.reset(seed=3)
    assert envs.reset().shape == (3, *shape)
    for _ in range(70):
        images, _, ended, told = envs.step(np.ones(3, int))
        expected, *_, infos = plain.step(np.ones(3, int))
        assert images in batch_space(envs.observation_space, 3)
        last = [told[row]["terminal_observation"] for row in np.flatnonzero(ended)]
        assert all(image in envs.observation_space for image in last)
        pairs = [*zip(images, expected, strict=True)]
        pairs += [*zip(last, infos["final_obs"][ended] if last else [], strict=True)]
        for image, pictures in pairs:
            if shape[-1] == 3:
                assert image.tolist() == pictures.tolist()
            elif pictures.ndim == 2:
                assert image.tolist() == [pictures.tolist()]
            elif pictures.ndim == 3:
                assert image.tolist() == pictures.tolist()
            else:
                assert image[-3:].tolist() == [pictures[-1, :, :, colour].tolist() for colour in range(3)]
                assert image[0].tolist() == pictures[0, :, :, 0].tolist()
    sb3.PPO("CnnPolicy", envs, n_steps=8, batch_size=8, n_epochs=1, device="cpu").learn(48)


def test_seeds_count_at_the_next_reset():
    envs = SilverballVecEnv(2, **OPTIONS)
    envs.seed(5)
    first = envs.reset()
    assert envs.reset().tolist() != first.tolist()
    envs.seed(5)
    assert envs.reset().tolist() == first.tolist()


def test_ppo_learns_on_states_and_on_pictures():
    for options in ({}, {"observation": "dict"}, {"observation": "pixels", "size": (36, 36)}):
        envs = SilverballVecEnv(4, seed=0, table="classic", time_limit=2.0, **options)
        policy = {"pixels": "CnnPolicy", "dict": "MultiInputPolicy"}.get(
            options.get("observation"), "MlpPolicy"
        )
        model = sb3.PPO(policy, envs, n_steps=32, batch_size=32, n_epochs=1, device="cpu")
        model.learn(1024)
        assert model.num_timesteps >= 1024
        assert len(model.ep_info_buffer) > 0, "returns of episodes are logged"
        mean, _ = evaluate_policy(model, envs, n_eval_episodes=4, warn=False)
        assert mean >= 0.0


def test_attributes_and_methods_are_reached_through_it():
    envs = SilverballVecEnv(3, seed=0, **OPTIONS)
    envs.reset()
    assert envs.get_attr("num_envs", [0, 2]) == [3, 3]
    first, last = envs.env_method("save_state", indices=[0, 2])
    envs.env_method("restore_state", first, indices=[2])
    assert envs.env_method("save_state", indices=[2]) == [first] != [last]
    assert envs.env_method("observe")[0].shape == (3, 63)
    with pytest.raises(ValueError, match="without indices"):
        envs.env_method("observe", indices=[1])
    envs.set_attr("spec", None)
    with pytest.raises(ValueError, match="share"):
        envs.set_attr("spec", None, indices=[0])
    assert envs.env_is_wrapped(gym.Wrapper) == [False] * 3


def test_pictures_for_people_come_from_all_environments():
    envs = SilverballVecEnv(2, seed=0, render_mode="rgb_array", **OPTIONS)
    envs.reset()
    assert [picture.shape for picture in envs.get_images()] == [(680, 330, 3)] * 2


def test_boards_can_be_chosen_for_the_next_reset():
    envs = SilverballVecEnv(3, seed=0, table="random", boards=4)
    free = SilverballVecEnv(3, seed=0, table="random", boards=4)
    free.reset(), free.reset(), free.reset()
    drawn = [info["board"] for info in free.reset_infos]
    envs.set_options({"board": 2})
    envs.reset()
    assert [info["board"] for info in envs.reset_infos] == [2, 2, 2]
    envs.set_options([{"board": 3}, {}, {"board": 0}])
    envs.reset()
    assert [info["board"] for info in envs.reset_infos][::2] == [3, 0]
    envs.reset()
    assert [info["board"] for info in envs.reset_infos] == drawn, "it is for one reset"
    envs.set_options({"bord": 2})
    with pytest.raises(ValueError, match="unknown reset option 'bord'"):
        envs.reset()


@pytest.mark.parametrize(("name", "hint"), [("frameskip", "frame_skip"), ("autoreset_mode", "SAME_STEP")])
def test_an_unknown_option_is_an_unexpected_keyword_argument(name, hint):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'.*{hint}"):
        SilverballVecEnv(2, table="classic", **{name: 4})


@pytest.mark.parametrize("actions", ["discrete", "multibinary"])
@pytest.mark.parametrize("make", [gym.make, None], ids=["single", "vector"])
def test_ppo_learns_with_either_kind_of_actions(actions, make):
    options = {"table": "classic", "actions": actions}
    envs = make("silverball/PinballClassic-v0", **options) if make else SilverballVecEnv(4, **options)
    sb3.PPO("MlpPolicy", envs, n_steps=32, batch_size=32, n_epochs=1, device="cpu").learn(128)


@pytest.mark.parametrize("id_", IDS)
@pytest.mark.parametrize("balls", [1, 3])
def test_its_wrappers_for_atari_go_around_every_environment(id_, balls):
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    options = {"observation": "pixels", "rgb": True, "stack": 1, "balls": balls}
    boards = {} if "Classic" in id_ else {"boards": 2}
    env = AtariWrapper(gym.make(id_, **options, **boards))
    observation, _ = env.reset(seed=0)
    lives = []
    for _ in range(600):
        observation, _, terminated, truncated, _ = env.step(0)
        assert observation.shape == (84, 84, 1)
        if terminated or truncated:
            lives.append(env.unwrapped.ale.lives())
            env.reset()
    assert lives[:balls] == list(range(balls))[::-1], "each ball is a life"


def test_processes_of_its_own_import_by_the_long_name():
    envs = SubprocVecEnv(
        [lambda: gym.make("silverball.envs:silverball/PinballClassic-v0")] * 2, start_method="spawn"
    )
    try:
        assert envs.reset().shape == (2, 63)
    finally:
        envs.close()


def test_an_id_brings_its_options():
    by_id = SilverballVecEnv("silverball/PinballClassic-v0", 3, seed=2)
    given = SilverballVecEnv(num_envs=3, seed=2, table="classic")
    assert by_id.reset().tolist() == given.reset().tolist()
    assert by_id.envs.spec.id == "silverball/PinballClassic-v0"
    long = SilverballVecEnv("silverball.envs:silverball/PinballPixels-v0", 2, boards=1, size=(20, 16))
    assert long.observation_space.shape == (4, 20, 16)


@pytest.mark.parametrize("given", [(), ("silverball/PinballClassic-v0",), (4, 4)], ids=str)
def test_a_missing_or_second_number_is_refused(given):
    with pytest.raises(TypeError, match="pass"):
        SilverballVecEnv(*given)


def test_the_id_of_another_environment_is_refused():
    with pytest.raises(ValueError, match="one of Silverball's pinball tables, got 'CartPole-v1'"):
        SilverballVecEnv("CartPole-v1", 2)
    with pytest.raises(gym.error.NameNotFound):
        SilverballVecEnv("silverball/Pinnball-v1", 2)


def test_the_spaces_of_the_attributes_are_those_of_one_environment():
    envs = SilverballVecEnv(3, table="classic", observation="pixels", size=(20, 16))
    assert envs.get_attr("observation_space") == [envs.observation_space] * 3
    assert envs.get_attr("action_space", [0, 2]) == [gym.spaces.Discrete(4)] * 2


@pytest.mark.parametrize("rgb", [False, True])
@pytest.mark.parametrize(("stack", "channels"), [(1, "first"), (1, "last"), (4, "first"), (3, "last")])
def test_a_policy_for_images_learns_through_gymnasiums_make(stack, channels, rgb):
    options = {"size": (36, 40), "stack": stack, "channels": channels, "rgb": rgb, "time_limit": 0.3}
    env = gym.make("silverball/PinballPixels-v0", boards=1, **options)
    assert is_image_space(env.observation_space)
    sb3.PPO("CnnPolicy", env, n_steps=8, batch_size=8, n_epochs=1, device="cpu").learn(24)
    envs = SilverballVecEnv("silverball/PinballPixels-v0", 2, boards=1, **options)
    assert envs.observation_space == env.observation_space
    assert envs.reset() in batch_space(env.observation_space, 2)
