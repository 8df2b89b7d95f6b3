"""The speed of the PinBall domain: one environment, many of them, and the published rules in NumPy."""

from __future__ import annotations

import time
from collections.abc import Callable

import gymnasium
import numpy as np

import silverball.envs  # noqa: F401  (registers)
from silverball.benchmarks.domain_rules import DomainRules
from silverball.benchmarks.speed import Figure
from silverball.envs.domain.board_file import load_board

ID = "silverball/PinBallDomain-v1"
MANY = 4096
STEPS = 5000  # of a single ball in a round
ROUNDS_OF_MANY = 20  # steps of many in a round
RULES_STEPS = 500  # in a round


def measure_domain(board: str, rounds: int, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Steps a second with random actions, medians of some rounds; `advance` is called before each part."""
    actions = np.random.default_rng(0).integers(0, 5, (ROUNDS_OF_MANY, MANY))
    single = actions.reshape(-1)[:STEPS].tolist()
    env = gymnasium.make(ID, board=board)
    envs = gymnasium.make_vec(ID, MANY, board=board)
    env.reset(seed=0), envs.reset(seed=0)
    rules = DomainRules(load_board(board))

    def play_one() -> int:
        for action in single:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(single)

    def play_many() -> int:
        for row in actions:
            envs.step(row)
        return actions.size

    def play_rules() -> int:
        for action in single[:RULES_STEPS]:
            if rules.step(action)[1]:
                rules.reset()
        return RULES_STEPS

    parts = {
        "one environment": play_one,
        f"{MANY} environments": play_many,
        "the published rules in NumPy": play_rules,
    }
    figures = []
    for name, play in parts.items():
        advance(name)
        figures.append(Figure(f"{board}, {name}", _rate(play, rounds), "steps/s"))
    return figures


def _rate(play: Callable[[], int], rounds: int) -> float:
    """The median rate of a function that returns its number of steps [1/s]; it is warmed up first."""
    play()
    rates = []
    for _ in range(rounds):
        start = time.perf_counter()
        rates.append(play() / (time.perf_counter() - start))
    return float(np.median(rates))
