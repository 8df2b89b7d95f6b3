"""Measure the returns from which the environments for agents count as solved: those of the trained player.

    python benchmarks/thresholds.py --episodes 2000

It decides fifteen times a second and sees the worlds themselves; `PinballPixels-v0` is played on the same
boards as `Pinball-v0`, so that its threshold is the same.
"""

from __future__ import annotations

import argparse

import gymnasium
import numpy as np

from silverball.envs import IDS
from silverball.players.batch_policies import batch_policy


def mean_return(id_: str, episodes: int) -> tuple[float, float]:
    """The mean return of the trained player over one episode in each of so many environments, and ± 95 %."""
    envs = gymnasium.make_vec(id_, episodes, observation="state")
    envs.reset(seed=0)
    player = batch_policy("trained", envs.unwrapped.batch)
    assert player is not None
    returns, plays, step = np.zeros(episodes), np.ones(episodes, bool), 0
    while plays.any():
        if step % player.every == 0:
            player.decide()
        _, rewards, terminated, truncated, _ = envs.step(player.buttons @ np.array([1, 2]))
        returns[plays] += rewards[plays]
        plays &= ~(terminated | truncated)
        step += 1
    return float(returns.mean()), float(1.96 * returns.std() / episodes**0.5)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--episodes", type=int, default=2000, help="of each environment")
    chosen = parser.parse_args()
    for id_ in IDS:
        mean, error = mean_return(id_, chosen.episodes)
        print(f"{id_:30} {mean:7.1f} ± {error:.1f}")
