"""Features of a game by the rules of a table: balls, paddles, lamps, counters and modes as numbers.

They are what the missions network of the trained player sees (`missions.py`). Obstacles are not among them:
the network has learnt one table. All come from the records of the world and of the game, by operations that
give the same bits on every machine.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.physics.records import Colliders, Motion
from silverball.players.features import Raw, Rows, raw_features
from silverball.referee.game_records import NOT_RUNNING, Light

BALLS_SEEN = 2  # the free balls that are lowest
OF_BALL = 18  # features of a ball
HAS_FREE_BALL = 0  # the feature that is 1 if any ball is neither on the plunger nor in a hole
OF_PADDLES = len(Raw) - Raw.LEFT_ANGLE
OF_PLAY = 9
PADDLES_AT = -7.0  # x of the pivots of the paddles [u]
PIVOTS = (-2.095, 1.345)  # z of the left one and of the right one [u]
LINE = -7.6  # x at which a ball is met by a paddle [u]
LOW = -4.0  # x below which a ball will soon be at the paddles [u]
FAR = 1e9
SAVE_SECONDS, MODE_SECONDS = 8.0, 60.0  # times that are shown as 1 [s]
HALF_POINTS, HALF_COUNT = 1e6, 10.0  # a score and a count that are shown as one half


def feature_count(lamps: int, counters: int, modes: int, switches: int) -> int:
    """The number of features on a table with so many of each."""
    return BALLS_SEEN * OF_BALL + OF_PADDLES + OF_PLAY + 2 * lamps + counters + 2 * modes + switches + 1


def mission_features(
    state: Any,
    games: Any,
    boards: Any,
    colliders: Colliders,
    sizes: tuple[int, ...],
    rate: int,
    charge: Any = 1.0,
) -> Rows:
    """The features of some games of one table.

    Args:
        state: World records [game].
        games: GAME records [game].
        boards: The BOARD record of each [game].
        colliders: COLLIDER records of all boards.
        sizes: Lamps, counters, modes and switches of the table.
        rate: Ticks per second.
        charge: How far the power supply of the coils is charged: one number, or [game].

    Returns:
        Features [game, feature].
    """
    lamps, counters, modes, switches = sizes
    ticks = state["tick"][:, None]
    ends = games["mode_end"][:, :modes]
    lit = games["lamp"][:, :lamps]
    counts = games["counter"][:, :counters]
    standing = 1 - (state["off"][:, None] >> np.arange(switches) & 1)
    left = np.minimum((ends - ticks) / (MODE_SECONDS * rate), 1.0)
    parts = (
        *_balls(state, boards),
        raw_features(state, boards, colliders)[:, Raw.LEFT_ANGLE :],
        _play(games, ticks, rate),
        lit != Light.OFF,
        lit == Light.BLINKING,
        counts / (counts + HALF_COUNT),
        ends != NOT_RUNNING,
        np.where(ends != NOT_RUNNING, np.maximum(left, 0.0), 0.0),
        standing,
        np.broadcast_to(charge, len(state))[:, None],
    )
    return np.concatenate(parts, axis=1, dtype=np.float64)


def _play(games: Any, ticks: NDArray[np.int64], rate: int) -> Rows:
    """The features of the balls in play and of the score [game, OF_PLAY]."""
    ball = games["ball"]
    in_play = np.arange(ball.shape[1]) < games["balls"][:, None]
    safe = np.where(in_play & (ball["saves"] != 0), ball["safe_until"] - ticks, 0).max(axis=1)
    score, extra, locked, balls = games["score"], games["extra_balls"], games["locked"], games["balls"]
    columns = (
        score / (score + HALF_POINTS),
        games["used"] / 4.0,
        balls / 4.0,
        balls > 1,
        np.clip(safe / (SAVE_SECONDS * rate), 0.0, 1.0),
        games["tilted"] != 0,
        extra / (extra + 1.0),
        locked / (locked + 1.0),
        games["warnings"] / 2.0,
    )
    return np.stack(columns, axis=1).astype(np.float64)


def _balls(state: Any, boards: Any) -> list[Rows]:
    """The features of the free balls that are lowest, each [game, OF_BALL]; those of an absent one are 0."""
    ball = state["ball"]
    slots = int(boards["max_balls"].max())
    ball = ball[:, :slots]
    is_free = (ball["id"] != 0) & (ball["motion"] != Motion.CAPTURED)
    order = np.where(is_free, ball["x"], FAR).argsort(axis=1, kind="stable")
    rows = np.arange(len(state))
    gravity = boards["gravity"]
    found = []
    for number in range(BALLS_SEEN):
        if number >= slots:
            found.append(np.zeros((len(state), OF_BALL)))
            continue
        slot = order[:, number]
        own = ball[rows, slot]
        found.append(_ball(own, gravity) * is_free[rows, slot][:, None])
    return found


def _ball(ball: Any, gravity: Any) -> Rows:
    """The features of one ball of each game [game, OF_BALL]: first where it is, then where it will be."""
    x, z, vx, vz = ball["x"], ball["z"], ball["vx"], ball["vz"]
    height = x - LINE
    # The time until it falls to the line of the paddles, if nothing is in its way, and where it will be then.
    root = np.sqrt(np.maximum(vx * vx + 2.0 * gravity * height, 0.0))
    seconds = np.where(height > 0.0, (vx + root) / gravity, 0.0)
    there = z + vz * seconds
    low = x < LOW
    columns = (
        np.ones(len(x)),
        x / 10.0,
        z / 5.0,
        vx / 20.0,
        vz / 20.0,
        ball["level"] != 0,
        low,
        np.clip((x - PADDLES_AT) / 2.0, -1.0, 1.5),
        np.clip((z - PIVOTS[0]) / 1.5, -1.5, 2.5),
        np.clip((PIVOTS[1] - z) / 1.5, -1.5, 2.5),
        np.clip(vx / 6.0, -1.5, 1.5) * low,
        np.clip(vz / 6.0, -1.5, 1.5) * low,
        np.clip(seconds, 0.0, 2.0),
        np.clip(seconds / 0.25, 0.0, 2.0),
        np.clip((there - PIVOTS[0]) / 1.5, -2.0, 3.0),
        np.clip((PIVOTS[1] - there) / 1.5, -2.0, 3.0),
        np.clip(x - PADDLES_AT, -1.5, 0.5) * low,
        np.clip(vz, -1.5, 1.5) * low,
    )
    return np.stack(columns, axis=1).astype(np.float64)
