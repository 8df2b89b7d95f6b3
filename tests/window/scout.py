"""A scout finds the presses with which a game comes to what a player wants: a shot, a mission, a multiball.

It branches a game into hundreds, presses at random in each, and keeps the presses of one that gets there.
What follows may be hopeless (the ball is on its way out), so it goes back and tries another one. The presses
that it finds are those of a game from its first tick, so the game has a replay like any other.

A step is 4 ticks, in which the buttons do not change. At the end of a step a ball that was lost has been
replaced by the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.game.game import Game
from silverball.game.game_batch import GameBatch, GameSnapshot
from silverball.game.view import Phase
from silverball.referee.game_records import NOT_RUNNING
from silverball.table import Table

STEP = 4  # [tick]
STEPS_A_SECOND = 60
TRIALS = 384
LAUNCH_STEPS = 40  # within which the plunger is drawn back, and for which it is at most

NOTHING = (False, False, False)
Presses = list[tuple[bool, bool, bool]]  # left, right and launch button in each step


class Games(NamedTuple):
    """The games of a batch by the names of their table."""

    batch: GameBatch

    def counter(self, name: str) -> NDArray[np.int64]:
        return self.batch.games["counter"][:, self.batch.books.counters[0].index(name)]

    def lamp(self, name: str) -> NDArray[np.int64]:
        return self.batch.games["lamp"][:, self.batch.books.lamps[0].index(name)]

    def runs(self, mode: str) -> NDArray[np.bool_]:
        return self.batch.games["mode_end"][:, self.batch.books.modes[0].index(mode)] != NOT_RUNNING

    @property
    def in_play(self) -> NDArray[np.int64]:
        return self.batch.games["balls"]


class Goal(NamedTuple):
    """What is to be reached.

    Attributes:
        name: How it is called.
        is_reached: Says of all games whether they have reached it, given the games as they were before.
        seconds: Within which time [s].
        keeps: Whether no ball may be lost on the way.
    """

    name: str
    is_reached: Callable[[Games, Any], NDArray[np.bool_]]
    seconds: float = 12.0
    keeps: bool = True


class Found(NamedTuple):
    """A game that has reached a goal."""

    state: GameSnapshot
    presses: Presses


class Scout:
    """Somebody who tries out what may be pressed.

    Args:
        table: The table.
        seed: Of the game.
        trials: Games to try at once.
    """

    def __init__(self, table: Table, seed: int, trials: int = TRIALS) -> None:
        self.batch = GameBatch(table, trials, [seed] * trials)
        self.games = Games(self.batch)
        self._draw = np.random.default_rng(seed)
        self.tries = 0

    def find(self, goals: list[Goal], most_tries: int = 400) -> Presses:
        """The presses with which a game reaches all goals, one after the other."""
        ways: list[Iterator[Found]] = []
        self.batch.step_unchecked(np.zeros((1, self.batch.count, 4), np.bool_), STEP)  # the first ball comes
        found: list[Found] = [Found(self.batch.save_games(0), [NOTHING])]
        while len(found) <= len(goals):
            if len(ways) < len(found):
                ways.append(self._ways(found[-1].state, goals[len(found) - 1]))
            following = next(ways[-1], None)
            if following is not None:
                found.append(following)
                continue
            ways.pop()
            found.pop()
            assert found, f"no way to {goals[0].name}"
            assert self.tries < most_tries, "it takes too long"
        return [press for one in found for press in one.presses]

    def _ways(self, state: GameSnapshot, goal: Goal) -> Iterator[Found]:
        """Different ways from a state to a goal, the quickest first."""
        for _ in range(2):
            yield from self._trial(state, goal)

    def _trial(self, state: GameSnapshot, goal: Goal) -> list[Found]:
        batch, self.tries = self.batch, self.tries + 1
        batch.restore_games(state)
        before = batch.games[0].copy()
        steps = round(goal.seconds * STEPS_A_SECOND)
        plans = self._plans(steps)
        if batch.state["tick"][0] > STEP:
            plans[:, :, 3] = (
                False  # only the first ball is launched by hand; keys do nothing while others play
            )
        found: list[Found] = []
        places: set[bytes] = set()  # of the balls of those found
        running = np.ones(batch.count, np.bool_)
        for step in range(steps):
            batch.step_unchecked(plans[step][None], STEP)
            if goal.keeps:
                running &= batch.games["used"] == before["used"]
            else:
                running &= batch.games["over"] == 0
            reached = running & goal.is_reached(self.games, before)
            for trial in np.nonzero(reached)[0].tolist():
                running[trial] = False
                place = self.batch.state["ball"]["x"][trial].tobytes()
                if place in places:  # the same shot: another button made no difference
                    continue
                places.add(place)
                presses = [tuple(map(bool, plans[at, trial, [0, 1, 3]])) for at in range(step + 1)]
                found.append(Found(batch.save_games([trial]), presses))
            if len(found) >= 4 or not running.any():
                break
        return found[:4]

    def _plans(self, steps: int) -> NDArray[np.bool_]:
        """Random presses: buttons [step, trial, left, right, –, launch]."""
        draw, count = self._draw, self.batch.count
        plans = np.zeros((steps, count, 4), np.bool_)
        gap, hold = draw.uniform(0.2, 1.5, count), draw.uniform(0.05, 0.5, count)
        for side in (0, 1):
            is_down = draw.random(count) < 0.25
            left = np.zeros(count)
            for step in range(steps):
                turned = left <= 0.0
                is_down = np.where(turned, ~is_down, is_down)
                mean = np.where(is_down, hold, gap)
                left = np.where(turned, draw.exponential(mean) * STEPS_A_SECOND + 1.0, left - 1.0)
                plans[step, :, side] = is_down
        first = draw.integers(1, LAUNCH_STEPS, count)
        end = first + draw.integers(1, LAUNCH_STEPS, count)
        at = np.arange(steps)[:, None]
        plans[:, :, 3] = (first <= at) & (at < end)
        plans[:, 0, :2] = True  # both paddles up may hold a ball for long
        plans[:, 1, 0], plans[:, 2, 1] = True, True
        return plans


def counted(name: str, at_least: int | None = None, seconds: float = 12.0, keeps: bool = True) -> Goal:
    """A counter has grown, or has reached a value."""

    def is_reached(games: Games, before: Any) -> NDArray[np.bool_]:
        index = games.batch.books.counters[0].index(name)
        return games.counter(name) >= (before["counter"][index] + 1 if at_least is None else at_least)

    return Goal(f"{name} {at_least or '+1'}", is_reached, seconds, keeps)


def started(mode: str, seconds: float = 12.0, keeps: bool = True) -> Goal:
    """A mode runs."""
    return Goal(f"{mode} runs", lambda games, before: games.runs(mode), seconds, keeps)


def in_state(lamp: str, state: int, seconds: float = 12.0, keeps: bool = True) -> Goal:
    """A lamp is off (0), on (1) or blinking (2)."""
    return Goal(f"{lamp} is {state}", lambda games, before: games.lamp(lamp) == state, seconds, keeps)


def play_presses(game: Game, presses: Presses) -> None:
    """Press in a game what a scout has found."""
    for left, right, launch in presses:
        for _ in range(STEP):
            if game.phase is Phase.READY:
                game.create_ball()
            game.step(left, right, launch=launch)
