"""Returns above which the v0 ids count as solved: those of the trained player.

This player decides fifteen times per second and reads the worlds instead of observations. `PinballPixels-v0`
is played on the boards of `Pinball-v0`, so its threshold is the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

from silverball.benchmarks.speed import Figure
from silverball.envs import IDS
from silverball.metrics.statistics import mean
from silverball.players.batch_policies import batch_policy

FIRST_IDS = [id_ for id_ in IDS if id_.endswith("-v0")]


def measure_thresholds(episodes: int, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Mean return and its 95 % half width in every environment; `advance` is called with its id."""
    figures = []
    for id_ in FIRST_IDS:
        advance(id_)
        value, error = mean_return(id_, episodes)
        figures += [Figure(id_, value, "return"), Figure(f"{id_}, ± 95 %", error, "return")]
    return figures


def mean_return(id_: str, episodes: int) -> tuple[float, float]:
    """Mean return of the trained player over one episode in each of `episodes` environments, and ± 95 %."""
    envs: Any = gymnasium.make_vec(id_, episodes, observation="state")
    envs.reset(seed=0)
    player = batch_policy("trained", envs.unwrapped.batch)
    assert player is not None
    returns, active, step = np.zeros(episodes), np.ones(episodes, bool), 0
    while active.any():
        if step % player.every == 0:
            player.decide()
        _, rewards, terminated, truncated, _ = envs.step(player.buttons @ np.array([1, 2]))
        returns[active] += rewards[active]
        active &= ~(terminated | truncated)
        step += 1
    found = mean(returns)
    return found.value, found.high - found.value
