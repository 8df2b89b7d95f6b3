"""Rhythms: how much a player makes who looks at nothing.

A rhythm presses the buttons for some steps and lets them go for some, for ever: both together, one of them,
or both in turn. All 200 are played on some balls; the ten best are played again on others, since the best of
200 is also the luckiest. An environment rewards seeing if the best of those ten makes hardly more than
buttons that are pressed at random.
"""

from __future__ import annotations

import csv
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.agents.trials import make_trial, play_trial
from silverball.metrics.statistics import Estimate, mean, quotient
from silverball.physics.records import LEFT, RIGHT

SIDES = ("both", "left", "right", "in turn")
UPS = (1, 2, 4, 8, 15)  # [step] for which buttons are held
DOWNS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 30)  # [step] for which they are not
FINALISTS = 10
SEARCH_SEED, FINAL_SEED = 0, 1_000_000


class Rhythm(NamedTuple):
    """Buttons that are held for `up` steps and let go for `down` steps, for ever."""

    sides: str
    up: int
    down: int

    def action(self, step: int) -> int:
        """The action at a step."""
        period = self.up + self.down
        is_up = step % period < self.up
        if self.sides == "in turn":
            is_other_up = (step + period // 2) % period < self.up
            return LEFT * is_up + RIGHT * is_other_up
        return {"both": LEFT | RIGHT, "left": LEFT, "right": RIGHT}[self.sides] * is_up

    def __str__(self) -> str:
        """In words."""
        return f"{self.sides}, {self.up} up, {self.down} down"


RHYTHMS = tuple(Rhythm(*one) for one in product(SIDES, UPS, DOWNS))


class Blind:
    """Plays a rhythm in all environments."""

    def __init__(self, rhythm: Rhythm, envs: Any) -> None:
        self._rhythm, self._count = rhythm, envs.num_envs

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]."""
        del observations
        return np.full(self._count, self._rhythm.action(step), np.int64)


class RandomPresses:
    """Draws an action for every step."""

    def __init__(self, envs: Any, seed: int = 0) -> None:
        self._actions, self._count = int(envs.single_action_space.n), envs.num_envs
        self._rng = np.random.default_rng(seed)

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]."""
        del observations, step
        actions: NDArray[np.int64] = self._rng.integers(0, self._actions, self._count)
        return actions


class Heard(NamedTuple):
    """What a rhythm, or None for random presses, came to: points a ball, seconds a ball."""

    rhythm: Rhythm | None
    is_final: bool
    balls: int
    points: Estimate
    seconds: Estimate


def search_rhythms(
    id_: str, balls: int, finals: int, advance: Callable[[str], None] = lambda _: None, **options: Any
) -> list[Heard]:
    """Play all rhythms, and the best ones again; random presses come first in both.

    Args:
        id_: The environment.
        balls: Balls of each rhythm in the search, on boards of the split "train".
        finals: Balls of the ten best, on boards of the split "test" and with other seeds.
        advance: Called with the name of what is played.
        options: Further options of the environment.
    """
    envs = make_trial(id_, balls, "train", zero_copy=True, **options)
    found = [_heard(None, envs, SEARCH_SEED, is_final=False)]
    for number, rhythm in enumerate(RHYTHMS):
        advance(f"{id_}: rhythm {number + 1} of {len(RHYTHMS)}")
        found.append(_heard(rhythm, envs, SEARCH_SEED, is_final=False))
    best = sorted(found[1:], key=lambda one: one.points.value, reverse=True)[:FINALISTS]
    envs = make_trial(id_, finals, "test", zero_copy=True, **options)
    advance(f"{id_}: random presses")
    found.append(_heard(None, envs, FINAL_SEED, is_final=True))
    for one in best:
        advance(f"{id_}: {one.rhythm}, again")
        found.append(_heard(one.rhythm, envs, FINAL_SEED, is_final=True))
    return found


def best_rhythm(found: list[Heard]) -> Heard:
    """The best rhythm of the finals."""
    finals = [one for one in found if one.is_final and one.rhythm is not None]
    return max(finals, key=lambda one: one.points.value)


def blind_share(found: list[Heard]) -> Estimate:
    """What the best rhythm makes, in parts of what random presses make."""
    random = next(one for one in found if one.is_final and one.rhythm is None)
    return quotient(best_rhythm(found).points, random.points)


def _heard(rhythm: Rhythm | None, envs: Any, seed: int, is_final: bool) -> Heard:
    trial = play_trial(lambda own: RandomPresses(own) if rhythm is None else Blind(rhythm, own), envs, seed)
    return Heard(rhythm, is_final, envs.num_envs, mean(trial.scores), mean(trial.seconds))


def write_csv(path: Path, id_: str, found: list[Heard]) -> None:
    """Write what each rhythm came to, and random presses; the finals last."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "round", "sides", "up", "down", "balls", "points", "low", "high", "seconds"])
        for one in found:
            rhythm = ("random", "", "") if one.rhythm is None else one.rhythm
            points = [round(number, 1) for number in one.points]
            part = "final" if one.is_final else "search"
            writer.writerow([id_, part, *rhythm, one.balls, *points, round(one.seconds.value, 2)])
