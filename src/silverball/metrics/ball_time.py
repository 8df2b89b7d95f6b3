"""How long does a ball live under a player, and how much does it score?

Each world gets one ball, which is watched until it is lost or the time is over. A ball lives only as long as
it scores: one without points for `STALL` seconds is counted as lost at that moment, so that nobody wins by
holding it. Balls that outlive the time are *censored*; the median is that of Kaplan and Meier, which takes
them for what they are, balls that lived at least so long.

Sources: E. L. Kaplan, P. Meier, "Nonparametric estimation from incomplete observations", J. Am. Stat. Assoc.
53 (1958); interval of the median: R. Brookmeyer, J. Crowley, "A confidence interval for the median survival
time", Biometrics 38 (1982), with the log-log transformation.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.records import BALL, Fault, records
from silverball.players.batch_policies import batch_policy, kernel_player
from silverball.players.planner import BRANCHES
from silverball.players.simple import PlayerKind, press_all
from silverball.world import WorldBatch

STALL = 15.0  # [s] without points after which a ball is counted as lost; the environments end it alike
NORMAL_95 = 1.959963984540054  # quantile of the normal distribution: 95 % lie within ± this


class End(IntEnum):
    """How a ball's life ended."""

    ALIVE = 0  # it has not: censored
    DRAINED = 1
    STALLED = 2  # no points for STALL seconds
    NOT_BORN = 3  # the board had no room


LIFE = np.dtype(
    [
        ("end", "i8"),  # End
        ("ticks", "i8"),  # of its life
        ("scored", "i8"), ("score", "i8"),  # the tick of its last points, and all its points
    ],
    align=True,
)  # fmt: skip


class BallTimes(NamedTuple):
    """What came of it, intervals being those of 95 %.

    Attributes:
        balls: How many were watched.
        drained: Lost through the gutter.
        stalled: Lost by scoring nothing for STALL seconds.
        alive: Alive at the end of the time.
        seconds: That each was watched at most [s].
        median: Of the life [s], with its interval; inf where it lies beyond the time.
        mean: Of the life up to the time [s], with its interval.
        score: Points of a ball up to the time, with its interval.
        score_per_minute: Points in a minute of life, with its interval.
        wall_seconds: That it took [s].
    """

    balls: int
    drained: int
    stalled: int
    alive: int
    seconds: float
    median: tuple[float, float, float]
    mean: tuple[float, float, float]
    score: tuple[float, float, float]
    score_per_minute: tuple[float, float, float]
    wall_seconds: float


def time_balls(
    batch: WorldBatch,
    player: str,
    seconds: float,
    progress: Callable[[float], None] | None = None,
    branches: int = BRANCHES,
) -> BallTimes:
    """Watch one ball in each world of a batch.

    Args:
        batch: The worlds, without points so far; a ball is created where none has been.
        player: The name of the player who presses.
        seconds: For which a ball is watched at most [s].
        progress: Called now and then with the simulated seconds so far.
        branches: That the planner tries at a decision.

    Returns:
        Lives and points of the balls.

    Raises:
        PlayerError: No player has that name, or a registered one failed.
    """
    lives = records(batch.count, LIFE)
    policy, kind = batch_policy(player, batch, branches), kernel_player(player)
    every = 1 if policy is None else policy.every
    actions = np.zeros((1, batch.count, 3), np.bool_)
    batch.create_balls(batch.state["created"] == 0)
    alive = batch.state["created"] > 0
    lives["end"][~alive] = End.NOT_BORN
    ticks = round(seconds * batch.tick_rate)
    started = time.perf_counter()
    for done in range(every, ticks + 1, every):
        if policy is None:
            _press(batch, kind, actions)
        else:
            policy.decide()
            actions[0, :, :2] = policy.buttons
        batch.run(actions, every)
        alive = note_lives(batch.state, lives, alive, every, round(STALL * batch.tick_rate))
        if progress is not None and done % batch.tick_rate < every:
            progress(done / batch.tick_rate)
        if not alive.any():
            break
    return _summary(lives, seconds, batch.tick_rate, time.perf_counter() - started)


def _press(batch: WorldBatch, kind: PlayerKind, actions: NDArray[np.bool_]) -> None:
    """Let a simple player choose the next tick's actions of all worlds."""
    boards = batch.boards
    press_all(
        int(kind), batch.state, boards.board, batch.board_of, boards.collider, 1.0 / batch.tick_rate,
        actions,
    )  # fmt: skip


def note_lives(state: Any, lives: Any, alive: NDArray[np.bool_], ticks: int, stall: int) -> NDArray[np.bool_]:
    """Write down what the last ticks did to the balls; which of them are alive, bool [ball].

    A ball that is counted as lost is taken off its board, so that nobody plays on with it.
    """
    lives["ticks"][alive] += ticks
    scored = alive & (state["score"] != lives["score"])
    lives["score"][scored], lives["scored"][scored] = state["score"][scored], lives["ticks"][scored]
    lost = alive & ((state["drained"] > 0) | (state["fault"] != Fault.NONE))
    stalled = alive & ~lost & (lives["ticks"] - lives["scored"] >= stall)
    lives["end"][lost], lives["end"][stalled] = End.DRAINED, End.STALLED
    state["ball"][stalled] = np.zeros((), BALL)
    still: NDArray[np.bool_] = alive & ~lost & ~stalled
    return still


def _summary(lives: Any, seconds: float, tick_rate: int, wall: float) -> BallTimes:
    born = lives[lives["end"] != End.NOT_BORN]
    times = born["ticks"] / tick_rate
    ended = born["end"] != End.ALIVE
    points = born["score"].astype(np.float64)
    drained, stalled, alive = (
        int((born["end"] == end).sum()) for end in (End.DRAINED, End.STALLED, End.ALIVE)
    )
    return BallTimes(
        len(born),
        drained,
        stalled,
        alive,
        seconds,
        median_life(times, ended),
        _mean(times),
        _mean(points),
        _ratio(points, times / 60.0),
        wall,
    )


def median_life(times: NDArray[np.float64], ended: NDArray[np.bool_]) -> tuple[float, float, float]:
    """The median of Kaplan and Meier with its interval of 95 %.

    Args:
        times: For how long each was seen alive [s], shape [ball].
        ended: Whether its life ended then; else it was censored, shape [ball].

    Returns:
        The median, and the interval's ends [s]; inf where the curve does not come down so far.
    """
    survival, variance = 1.0, 0.0
    found = [math.inf, math.inf, math.inf]  # median, low, high
    for moment in np.unique(times[ended]):
        at_risk = int((times >= moment).sum())
        deaths = int((times[ended] == moment).sum())
        survival *= 1.0 - deaths / at_risk
        low = high = 0.0
        if survival > 0.0:
            variance += deaths / (at_risk * (at_risk - deaths))
            spread = NORMAL_95 * math.sqrt(variance) / abs(math.log(survival))
            low, high = survival ** math.exp(spread), survival ** math.exp(-spread)
        for place, share in enumerate((survival, low, high)):
            if share <= 0.5 and found[place] == math.inf:
                found[place] = float(moment)
    return found[0], found[1], found[2]


def _mean(values: NDArray[np.float64]) -> tuple[float, float, float]:
    """The mean with its interval by the normal distribution."""
    mean = float(values.mean())
    error = NORMAL_95 * float(values.std(ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else math.inf
    return mean, mean - error, mean + error


def _ratio(above: NDArray[np.float64], below: NDArray[np.float64]) -> tuple[float, float, float]:
    """The ratio of two sums with its interval: the error of a ratio to first order."""
    ratio = float(above.sum() / below.sum())
    _, low, high = _mean((above - ratio * below) / below.mean())
    return ratio, ratio + low, ratio + high
