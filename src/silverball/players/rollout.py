"""Rollouts: a player plays many worlds without a window, in one compiled loop.

The loop keeps the wanted number of balls on every board, lets the player press buttons, steps the world and,
if asked, audits every tick for a ball inside anything. Players that decide in Python do so between its calls
(`batch_policies.py`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from silverball.physics.audit import deepest
from silverball.physics.balls import create_ball
from silverball.physics.event_log import clear_log
from silverball.physics.kernel import kernel
from silverball.physics.records import (
    BatchGeometry,
    BoardGeometry,
    Fault,
    Lane,
    Lanes,
    Places,
    WorldRecord,
)
from silverball.physics.step import button_bits, step_world
from silverball.players.batch_policies import batch_policy, kernel_player
from silverball.players.simple import PlayerKind, launch_bit, pressed
from silverball.world import WorldBatch

CHUNK_TICKS = 2_000_000  # ticks of all worlds together between two calls of `progress`


class RolloutTotals(NamedTuple):
    """The totals over all worlds of a batch.

    Attributes:
        seconds: Simulated time of each world [s].
        wall_seconds: Real time that it took [s], compilation excluded.
        created: Balls created.
        drained: Balls that left through the gutter.
        score: Points.
        hits: Hits by the name of the part; those of different boards are added by name.
        touches: Contacts below hit_speed.
        ball_hits: Hits of ball against ball.
        jams: Number of times a jammed ball was frozen.
        faults: Worlds that stopped at an impossible state.
        deepest: The greatest depth of any ball inside anything [u]; NaN if not audited.
    """

    seconds: float
    wall_seconds: float
    created: int
    drained: int
    score: int
    hits: dict[str, int]
    touches: int
    ball_hits: int
    jams: int
    faults: int
    deepest: float


class Rollout(NamedTuple):
    """How worlds are played; see `play`.

    Attributes:
        player: A `PlayerKind`.
        balls: Balls to keep on the board.
        audit: Whether to audit every tick.
        places: The squares of all boards in which balls are created.
        depths: Raised to the greatest depth of a ball inside anything [u], if audited [world].
        buttons: Held in all ticks for a player that has DECIDED, bool [world, 2]: left, right.
    """

    player: int
    balls: int
    audit: bool
    places: Places
    depths: Any
    buttons: Any


def play(
    batch: WorldBatch,
    player: str,
    seconds: float,
    balls: int = 1,
    audit: bool = False,
    progress: Callable[[float], None] | None = None,
) -> RolloutTotals:
    """Let a player play all worlds of a batch.

    Args:
        batch: The worlds.
        player: The name of the player.
        seconds: Simulated time of each world [s], rounded to whole ticks.
        balls: Balls to keep on the board, at most the table's max_balls; 0 creates none.
        audit: Whether to check every tick for a ball inside anything (halves the speed).
        progress: Called from time to time with the simulated seconds so far.

    Returns:
        The totals.

    Raises:
        PlayerError: No player has that name, or a registered one failed.
    """
    ticks = round(seconds * batch.tick_rate)
    policy = batch_policy(player, batch)
    buttons = np.zeros((batch.count, 2), np.bool_) if policy is None else policy.buttons
    depths = np.zeros(batch.count)
    kind, places = int(kernel_player(player)), batch.boards.place
    rollout = Rollout(kind, balls, audit, places, depths, buttons)
    _run(batch, rollout, 0)  # compiles, moves nothing
    started = time.perf_counter()
    chunk = max(1, CHUNK_TICKS // batch.count) if policy is None else policy.every
    for done in range(0, ticks, chunk):
        if policy is not None:
            batch.create_balls((batch.state["ball"]["id"] != 0).sum(axis=1) < balls)
            policy.decide()
        _run(batch, rollout, min(chunk, ticks - done))
        if progress is not None:
            progress(min(done + chunk, ticks) / batch.tick_rate)
    wall = time.perf_counter() - started
    return _totals(batch, ticks / batch.tick_rate, wall, float(depths.max()) if audit else float("nan"))


def _run(batch: WorldBatch, rollout: Rollout, ticks: int) -> None:
    lanes, geometries, tick = batch.lanes, batch.geometries, 1.0 / batch.tick_rate
    batch.on_threads(
        lambda first, end: play_worlds(lanes, geometries, rollout, first, end, ticks, tick),
        batch.count * ticks,
    )


def _totals(batch: WorldBatch, seconds: float, wall: float, depth: float) -> RolloutTotals:
    state = batch.state
    hits: dict[str, int] = {}
    for row, board in zip(batch.tallies, batch.board_of, strict=True):
        for name, count in zip(batch.boards.names[board], row.tolist(), strict=False):
            hits[name] = hits.get(name, 0) + count
    return RolloutTotals(
        seconds,
        wall,
        int(state["created"].sum()),
        int(state["drained"].sum()),
        int(state["score"].sum()),
        hits,
        int(state["touches"].sum()),
        int(state["ball_hits"].sum()),
        int(state["jams"].sum()),
        int((state["fault"] != Fault.NONE).sum()),
        depth,
    )


@kernel
def play_worlds(
    lanes: Lanes, geometries: BatchGeometry, rollout: Rollout, first: int, end: int, ticks: int, tick: float
) -> None:
    """Let a player play the worlds first … end − 1 for a number of ticks of length `tick` [s]."""
    colliders = geometries.colliders
    has_decided = rollout.player == PlayerKind.DECIDED
    for index in range(first, end):
        world, log = lanes.worlds[index], lanes.logs[index]
        board = geometries.boards[lanes.board_of[index]]
        lane = Lane(world, log, lanes.tallies[index], log)
        geometry = BoardGeometry(board, colliders, geometries.grid)
        for done in range(ticks):
            clear_log(log)
            # Before a decision `play` has created the balls, so that the player could see them.
            if ball_count(world) < rollout.balls and (done > 0 or not has_decided):
                create_ball(world, board, colliders, rollout.places, log)
            if has_decided:
                left, right = rollout.buttons[index, 0], rollout.buttons[index, 1]
            else:
                left, right = pressed(rollout.player, world, board, colliders, tick)
            step_world(lane, geometry, button_bits(left, right) | launch_bit(world, board, tick), tick)
            if rollout.audit:
                rollout.depths[index] = max(rollout.depths[index], deepest(world, board, colliders))


@kernel
def ball_count(world: WorldRecord) -> int:
    """The number of balls on the board."""
    count = 0
    for slot in range(len(world.ball)):
        if world.ball[slot].id != 0:
            count += 1
    return count
