"""Ball time: how long a ball lives under a player, and how much it scores.

Each world gets one ball, which is watched until it is lost or the time is over. A ball without points for
`STALL` seconds counts as lost at that moment, so holding it does not pay. Balls that outlive the time are
*censored*; the median takes them as balls that lived at least that long (`statistics.median_life`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.statistics import Estimate, mean, median_life, ratio
from silverball.physics.records import Fault, records
from silverball.players.batch_policies import batch_policy, kernel_player
from silverball.players.planner import BRANCHES
from silverball.players.simple import PlayerKind, press_all, press_launch
from silverball.world import WorldBatch

STALL = 15.0  # [s] without points after which a ball counts as lost; as the environments end an episode


class End(IntEnum):
    """How a ball's life ended."""

    ALIVE = 0  # it has not ended: censored
    DRAINED = 1
    STALLED = 2  # no points for STALL seconds
    NOT_BORN = 3  # the board had no free place


LIFE = np.dtype(
    [
        ("end", "i8"),  # End
        ("ticks", "i8"),  # length of its life
        ("scored", "i8"), ("score", "i8"),  # the tick of its last points, and all its points
    ],
    align=True,
)  # fmt: skip


class BallTimes(NamedTuple):
    """Lives and points of balls.

    Attributes:
        balls: Balls watched.
        drained: Balls lost through the gutter.
        stalled: Balls lost by scoring nothing for STALL seconds.
        alive: Balls alive at the end of the time.
        seconds: Longest time for which a ball was watched [s].
        median: Median life [s]; inf where it lies beyond the time.
        mean: Mean life up to the time [s].
        score: Points of a ball up to the time.
        score_per_minute: Points per minute of life.
        wall_seconds: Real time that it took [s].
    """

    balls: int
    drained: int
    stalled: int
    alive: int
    seconds: float
    median: Estimate
    mean: Estimate
    score: Estimate
    score_per_minute: Estimate
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
        batch: Worlds without points; a ball is created where there has been none.
        player: The name of the player.
        seconds: Longest time for which a ball is watched [s].
        progress: Called from time to time with the simulated seconds so far.
        branches: Branches that the planner tries at a decision.

    Returns:
        Lives and points of the balls.

    Raises:
        PlayerError: No player has that name, or a registered one failed.
    """
    lives = records(batch.count, LIFE)
    policy, kind = batch_policy(player, batch, branches), kernel_player(player)
    every = 1 if policy is None else policy.every
    has_plunger = bool(batch.boards.board["plungers"].any())
    actions = np.zeros((1, batch.count, 4 if has_plunger else 3), np.bool_)
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
        if has_plunger:
            boards, tick = batch.boards.board, 1.0 / batch.tick_rate
            press_launch(batch.state, boards, batch.board_of, tick, actions)
        batch.step_unchecked(actions, every)
        alive = update_lives(batch.state, lives, alive, every, round(STALL * batch.tick_rate))
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


def update_lives(
    state: Any, lives: Any, alive: NDArray[np.bool_], ticks: int, stall: int
) -> NDArray[np.bool_]:
    """Record the effect of the last ticks on the balls; return which of them are alive, bool [ball].

    A ball that counts as lost is removed from its board.
    """
    lives["ticks"][alive] += ticks
    scored = alive & (state["score"] != lives["score"])
    lives["score"][scored], lives["scored"][scored] = state["score"][scored], lives["ticks"][scored]
    lost = alive & ((state["drained"] > 0) | (state["fault"] != Fault.NONE))
    stalled = alive & ~lost & (lives["ticks"] - lives["scored"] >= stall)
    lives["end"][lost], lives["end"][stalled] = End.DRAINED, End.STALLED
    state["ball"][stalled] = np.zeros((), state["ball"].dtype)
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
        mean(times),
        mean(points),
        ratio(points, times / 60.0),
        wall,
    )
