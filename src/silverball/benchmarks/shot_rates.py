"""How often the wanted part is hit next: success rates of simple players in `PinballShots-v1`.

The best press is found by playing an episode again and again with the same seed, a press at every step, of
either paddle or both, short or long: what a player could reach who foresees everything, also sticky actions,
and presses once.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import silverball.envs  # noqa: F401  (registers)
from silverball.benchmarks.speed import Figure

ID = "silverball/PinballShots-v1"
STEPS = 75  # of an episode in which a press is tried: five seconds
HOLDS = (2, 6)  # [step] the lengths of the presses that are tried
LOW = -0.6  # the x below which a falling ball is near the paddles, in half board lengths

Policy = Callable[[dict[str, NDArray[Any]]], NDArray[np.int64]]


def measure_shots(table: str, episodes: int, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Success rates and their 95 % half widths [%]; `advance` is called with the name of each player."""
    rng = np.random.default_rng(0)
    players: dict[str, Callable[[], float]] = {
        "nothing": lambda: success_rate(table, episodes, lambda seen: np.zeros(episodes, np.int64)),
        "random": lambda: success_rate(table, episodes, lambda seen: rng.integers(0, 4, episodes)),
        "both paddles for a low, falling ball": lambda: success_rate(table, episodes, reflex),
        "the best press": lambda: best_press_rate(table, episodes),
    }
    figures = []
    for name, play in players.items():
        advance(name)
        rate = play()
        error = 1.96 * (rate * (1.0 - rate) / episodes) ** 0.5
        figures += [Figure(name, 100.0 * rate, "%"), Figure(f"{name}, ± 95 %", 100.0 * error, "%")]
    return figures


def reflex(seen: dict[str, NDArray[Any]]) -> NDArray[np.int64]:
    """Raise both paddles for a low, falling ball."""
    state = seen["observation"]
    return np.where((state[:, 1] < LOW) & (state[:, 3] < 0.0), 3, 0)


def success_rate(table: str, episodes: int, policy: Policy) -> float:
    """The share of one episode in each of `episodes` environments in which the wanted part is hit next."""
    envs: Any = gymnasium.make_vec(ID, episodes, table=table)
    seen, _ = envs.reset(seed=0)
    active, made = np.ones(episodes, bool), np.zeros(episodes, bool)
    while active.any():
        seen, rewards, terminated, truncated, _ = envs.step(policy(seen))
        made |= active & (rewards > 0.0)
        active &= ~(terminated | truncated)
    return float(made.mean())


def best_press_rate(table: str, episodes: int) -> float:
    """The share of the first `episodes` seeds for which one press hits the wanted part next."""
    presses = np.array(list(product((1, 2, 3), range(STEPS), HOLDS)))
    buttons, begins, holds = presses.T
    envs: Any = gymnasium.make_vec(ID, len(presses), table=table)
    made = 0
    for seed in range(episodes):
        envs.reset(seed=[seed] * len(presses))
        active, is_made = np.ones(len(presses), bool), False
        step = 0
        while active.any() and not is_made:
            held = (begins <= step) & (step < begins + holds)
            _, rewards, terminated, truncated, _ = envs.step(np.where(held, buttons, 0))
            is_made = bool((active & (rewards > 0.0)).any())
            active &= ~(terminated | truncated)
            step += 1
        made += is_made
    return made / episodes
