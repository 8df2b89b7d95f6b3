"""How do many worlds go on under a player, without a window?

One compiled loop keeps the wanted number of balls on every board, lets the player press, moves the world
and, if asked, has every tick audited for a ball inside anything. Players that decide now and then only do so
outside of it (batch_policies.py).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from silverball.physics.audit import deepest
from silverball.physics.balls import create_ball
from silverball.physics.kernel import kernel
from silverball.physics.records import BALL_COUNT, Fault, Lane, Playfield
from silverball.physics.step import step_world
from silverball.players.batch_policies import batch_policy, kernel_player
from silverball.players.simple import PlayerKind, pressed
from silverball.world import WorldBatch

CHUNK_TICKS = 2_000_000  # of all worlds together, between two calls of `progress`


class Played(NamedTuple):
    """What came of it, over all worlds of the batch.

    Attributes:
        seconds: Simulated in each world [s].
        wall_seconds: That it took [s], compilation excluded.
        created: Balls created.
        drained: Balls that left through the gutter.
        score: Points.
        hits: By the path of the part; of worlds with different boards by the same path.
        touches: Contacts below hit_speed.
        ball_hits: Of ball against ball.
        jams: Times at which a pinched ball was held.
        faults: Worlds that stopped at an impossible state.
        deepest: The deepest that any ball was inside anything [u]; NaN if not audited.
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


def play(
    batch: WorldBatch,
    player: str,
    seconds: float,
    balls: int = 1,
    audit: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Played:
    """Play all worlds of a batch on.

    Args:
        batch: The worlds.
        player: The name of the player who presses.
        seconds: To simulate in each world [s], rounded to whole ticks.
        balls: Balls to keep on the board, at most the table's max_balls; 0 creates none.
        audit: Whether to check every tick for a ball inside anything (about halves the speed).
        progress: Called now and then with the simulated seconds so far.

    Returns:
        The totals.

    Raises:
        PlayerError: No player has that name, or a registered one failed.
    """
    ticks = round(seconds * batch.tick_rate)
    depths = np.zeros(batch.count)
    policy, kind = batch_policy(player, batch), kernel_player(player)
    buttons = np.zeros((batch.count, 2), np.bool_) if policy is None else policy.buttons
    _run(batch, kind, 0, balls, audit, depths, buttons)  # compiles, moves nothing
    started = time.perf_counter()
    chunk = max(1, CHUNK_TICKS // batch.count) if policy is None else policy.every
    for done in range(0, ticks, chunk):
        if policy is not None:
            batch.create_balls((batch.state["ball"]["id"] != 0).sum(axis=1) < balls)
            policy.decide()
        _run(batch, kind, min(chunk, ticks - done), balls, audit, depths, buttons)
        if progress is not None:
            progress(min(done + chunk, ticks) / batch.tick_rate)
    wall = time.perf_counter() - started
    return _totals(batch, ticks / batch.tick_rate, wall, float(depths.max()) if audit else float("nan"))


def _run(
    batch: WorldBatch, kind: PlayerKind, ticks: int, balls: int, audit: bool, depths: Any, buttons: Any
) -> None:
    boards = batch.boards
    batch.on_threads(
        lambda first, end: play_worlds(
            batch.state, boards.board, batch.board_of, boards.collider, boards.grid, boards.place,
            batch.logs, batch.tallies, first, end, ticks, 1.0 / batch.tick_rate,
            int(kind), balls, audit, depths, buttons,
        ),
        batch.count * ticks,
    )  # fmt: skip


def _totals(batch: WorldBatch, seconds: float, wall: float, depth: float) -> Played:
    state = batch.state
    hits: dict[str, int] = {}
    for row, board in zip(batch.tallies, batch.board_of, strict=True):
        for name, count in zip(batch.boards.names[board], row.tolist(), strict=False):
            hits[name] = hits.get(name, 0) + count
    return Played(
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
    worlds: Any, boards: Any, board_of: Any, colliders: Any, grid: Any, places: Any, logs: Any, tallies: Any,
    first: int, end: int, ticks: int, tick: float, player: int, balls: int, audit: bool, depths: Any,
    buttons: Any,
) -> None:  # fmt: skip
    """Let a player play the worlds first … end − 1 for a number of ticks; most arguments as in `run_worlds`.

    `places` are the squares in which balls are created, `player` is a `PlayerKind`, `balls` how many to keep
    on the board. With `audit`, `depths` [world] is raised to the deepest that a ball was inside anything [u].
    A player who has decided before the call holds `buttons` [world, 2] in all ticks.
    """
    for index in range(first, end):
        world, log, tally = worlds[index], logs[index], tallies[index]
        board = boards[board_of[index]]
        for done in range(ticks):
            log.count, log.lost = 0, 0
            # Who has decided before this call did so after a ball had been created.
            if ball_count(world) < balls and (done > 0 or player != PlayerKind.DECIDED):
                create_ball(world, board, colliders, places, log)
            if player == PlayerKind.DECIDED:
                left, right = buttons[index, 0], buttons[index, 1]
            else:
                left, right = pressed(player, world, board, colliders, tick)
            step_world(Lane(world, log, tally), Playfield(board, colliders, grid), left, right, False, tick)
            if audit:
                depths[index] = max(depths[index], deepest(world, board, colliders))


@kernel
def ball_count(world: Any) -> int:
    """Balls on the board."""
    count = 0
    for slot in range(BALL_COUNT):
        if world.ball[slot].id != 0:
            count += 1
    return count
