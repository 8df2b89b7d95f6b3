"""Trials: a contestant plays one episode in each of many environments.

On random boards environment i plays the board with the number i of a split, so a trial of 1000 environments
on "test" is one ball on each board of it. Other seeds give other balls, and other chance in sticky actions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import gymnasium
import numpy as np
from numpy.typing import NDArray

from silverball.envs import IDS
from silverball.envs.protocol import SPLITS, load_source


class Contestant(Protocol):
    """Chooses the actions of all environments of a trial."""

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env] at this step of the episodes, the first one is 0."""


Entrant = Callable[[Any], Contestant]
"""Makes a contestant for a vector of environments, a `PinballVectorEnv`."""


class Trial(NamedTuple):
    """What a contestant came to in each environment.

    Attributes:
        scores: Points of the episode [env].
        seconds: How long it lasted [s], [env].
        strokes: Strokes of both paddles [env].
    """

    scores: NDArray[np.int64]
    seconds: NDArray[np.float64]
    strokes: NDArray[np.int64]


def has_boards(id_: str) -> bool:
    """Whether an environment plays random boards, so that it has splits."""
    return load_source(IDS[id_]["table"]).random is not None


def make_trial(id_: str, balls: int, split: str, **options: Any) -> Any:
    """The environments of a trial: a vector that resets an environment in the step that ends its episode."""
    given = dict(options)
    if has_boards(id_):
        first, boards = SPLITS[split]
        given |= {"boards": min(balls, boards), "board_seed": first}
        given["own_boards"] = balls <= boards
    return gymnasium.make_vec(id_, balls, autoreset_mode="SAME_STEP", **given).unwrapped


def play_trial(
    entrant: Entrant, envs: Any, seed: int, advance: Callable[[float], None] | None = None
) -> Trial:
    """Let a contestant play one episode in each environment.

    Args:
        entrant: Makes the contestant.
        envs: From `make_trial`.
        seed: Environment i plays the first episode of seed + i.
        advance: Called after every step with the share of episodes that are over.
    """
    count, length = envs.num_envs, envs.options.step_seconds
    observations, _ = envs.reset(seed=seed)
    contestant = entrant(envs)
    scores, strokes = np.zeros(count, np.int64), np.zeros(count, np.int64)
    seconds, playing, held = np.zeros(count), np.ones(count, bool), np.zeros(count, np.int64)
    step = 0
    while playing.any():
        actions = contestant.act(observations, step)
        observations, _, terminated, truncated, infos = envs.step(actions)
        step += 1
        over = terminated | truncated
        executed = infos.get("action", actions)
        begun = executed & ~held
        strokes += np.where(playing & ~over, (begun & 1) + (begun >> 1 & 1), 0)
        held = np.where(over, 0, executed)
        ended = playing & over
        if ended.any():
            scores[ended] = infos["final_info"]["score"][ended]
            seconds[ended] = step * length
            playing &= ~ended
        if advance is not None:
            advance(1.0 - float(playing.mean()))
    return Trial(scores, seconds, strokes)
