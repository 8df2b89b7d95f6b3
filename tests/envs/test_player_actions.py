"""Players of the game as agents, and the episodes that are recorded of them."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import PinballVectorEnv
from silverball.envs.player_actions import PlayerActions
from silverball.errors import SilverballError
from silverball.export.episodes import Recording
from silverball.players.batch_policies import WorldView
from silverball.players.registry import make_player

CLASSIC = "silverball/PinballClassic-v0"
SHORT = {"time_limit": 2.0}


def test_a_simple_player_presses_in_an_environment_what_it_presses_in_a_game():
    envs = PinballVectorEnv(4, table="classic")
    envs.reset(seed=3)
    actions = PlayerActions(envs, "reflex")
    player = make_player("reflex")
    pressed = set()
    for _ in range(300):
        chosen = actions.choose()
        left, right = player.press(WorldView(envs.batch, 1).world())
        assert chosen[1] == left + 2 * right
        pressed.update(chosen.tolist())
        envs.step(chosen)
    assert len(pressed) > 1


def test_a_player_without_a_hand_for_it_launches_the_balls_of_a_plunger():
    envs = PinballVectorEnv(8, table="silver_comet")
    envs.reset(seed=0)
    launch = envs.button_names.index("launch")
    actions = PlayerActions(envs, "idle")
    held = []
    for _ in range(300):
        chosen = actions.choose()
        held.append((chosen >> launch) & 1)
        assert not (chosen & ~(1 << launch)).any()
        envs.step(chosen)
    assert 0.05 < np.mean(held) < 0.95


@pytest.mark.parametrize(
    ("player", "options"),
    [
        ("reflex", SHORT),
        ("random", {**SHORT, "observation": "dict", "table": "random", "boards": 3}),
        ("planner", {"time_limit": 1.0, "frame_skip": 4}),
        ("trained", {**SHORT, "actions": "multibinary"}),
        ("reflex", {**SHORT, "observation": "pixels", "size": (40, 32), "frame_skip": 4}),
    ],
)
def test_an_episode_is_what_its_seed_and_its_actions_make_of_an_environment(player, options):
    for episode in Recording(CLASSIC, options, player, 11).episodes(3):
        env = gym.make(CLASSIC, **options)
        observation, info = env.reset(seed=episode.seed)
        assert_shown(observation, episode.observations, 0)
        steps = len(episode.rewards)
        assert len(episode.actions) == steps > 10
        for step, action in enumerate(episode.actions):
            observation, reward, terminated, truncated, info = env.step(action)
            assert_shown(observation, episode.observations, step + 1)
            assert (reward, terminated, truncated) == (
                episode.rewards[step], episode.terminated[step], episode.truncated[step],
            )  # fmt: skip
            assert terminated or truncated or step < steps - 1
        assert terminated or truncated
        assert {name: counts[-1] for name, counts in episode.counts.items()} == info


def assert_shown(observation, recorded, step):
    if isinstance(observation, dict):
        for name, value in observation.items():
            assert (recorded[name][step] == value).all(), name
    else:
        assert (recorded[step] == observation).all()


@pytest.mark.parametrize("player", ["random", "planner", "trained"])
def test_an_episode_does_not_depend_on_those_that_are_played_beside_it(player):
    together, alone = (Recording(CLASSIC, SHORT, player, 5) for _ in range(2))
    assert together.side_by_side > 4
    alone.side_by_side = 1
    assert together.digest(4) == alone.digest(4)
    assert together.digest(4) != together.digest(3)


def test_what_cannot_be_recorded_is_refused_in_a_sentence():
    for id_, options, player, words in (
        ("CartPole-v1", {}, "reflex", "'CartPole-v1' is no environment: choose one of silverball/Pinball-v0"),
        (CLASSIC, {"frame_skip": "x"}, "reflex", "frame_skip must be an integer"),
        (CLASSIC, {"fram_skip": 4}, "reflex", "did you mean 'frame_skip'?"),
        (CLASSIC, {}, "reflx", "no player is called 'reflx'"),
    ):
        with pytest.raises(SilverballError) as raised:
            Recording(id_, options, player, 0)
        assert words in str(raised.value)
        assert "\n" not in str(raised.value)
