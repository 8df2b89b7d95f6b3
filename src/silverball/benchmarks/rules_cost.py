"""What the rules of games cost: a batch of games against bare worlds that are in the same situation.

A third batch has games in which no rule listens to anything: what these take longer than bare worlds is the
price of having games, and the rest that of what rules do. At the start of a round the other batches become
copies of the games. Copying leaves some of them in the caches, so a frame follows that is not timed; then all
play the same frames with the same buttons, in every order once, as each frame finds what the one before it
has left. Times are processor times of one thread, and a ratio is taken within a frame.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial
from itertools import permutations

import numpy as np

from silverball.benchmarks.speed import FRAME_RATE, HOLD, Figure
from silverball.game.game_batch import GameBatch
from silverball.table import Table
from silverball.world import WorldBatch

SPREAD = 120  # frames of new games before a round, so that they differ
ORDERS = tuple(permutations(range(3)))  # in which the batches play the timed frames of a round
ROUNDS_A_GAME = 100  # after which games begin anew, long before most are over


def measure_rules(
    table: Table,
    worlds: int,
    rounds: int,
    tick_rate: int = 240,
    advance: Callable[[str], None] = lambda _: None,
) -> list[Figure]:
    """Time a frame of games and of bare worlds.

    Args:
        table: Their table.
        worlds: Games in the batch.
        rounds: Rounds of a frame that is not timed and one in each of the `ORDERS`.
        tick_rate: Ticks per second.
        advance: Called with the name of what is measured next.
    """
    advance(f"{worlds} games on {table.name}")
    bare = WorldBatch(table, worlds, 1, tick_rate, 1)
    silent, games = (GameBatch(table, worlds, 1, tick_rate, 1) for _ in range(2))
    silent.books.book.triggers[:] = 0  # the rules of each trigger end where they begin
    every: tuple[WorldBatch, ...] = (bare, silent, games)
    fresh, random, ticks = games.save_games(), np.random.default_rng(0), tick_rate // FRAME_RATE
    held = np.zeros((1, worlds, 4), bool)
    took: list[list[float]] = []
    in_play: list[float] = []
    frame = 0

    def hold() -> None:
        nonlocal frame
        if frame % HOLD == 0:
            held[0, :, [0, 1, 3]] = random.random((3, worlds)) < 0.5
        frame += 1

    for number in range(rounds):
        if number % ROUNDS_A_GAME == 0:
            games.restore_games(fresh)
            for _ in range(SPREAD):
                hold()
                games.step_unchecked(held, ticks)
        for other in (bare, silent):
            other.state[:], other.logs[:] = games.state, games.logs
        silent.games[:] = games.games
        in_play.append(float((games.state["ball"]["id"] != 0).any(axis=1).mean()))
        for turn, order in enumerate((ORDERS[0], *ORDERS)):
            hold()
            times = [0.0] * len(every)
            for kind in order:
                times[kind] = timed(partial(every[kind].step_unchecked, held, ticks))
            if turn > 0:
                took.append(times)
    plain, idle, ruled = (1e9 / worlds * statistics.median(times) for times in zip(*took, strict=True))
    having, all_of_it = (
        100.0 * (statistics.median(times[kind] / times[0] for times in took) - 1.0) for kind in (1, 2)
    )
    return [
        Figure("a frame without rules", plain, "ns"),
        Figure("a frame of games in which no rule listens", idle, "ns"),
        Figure("a frame with rules", ruled, "ns"),
        Figure("a frame takes longer with rules by", all_of_it, "%"),
        Figure("a frame takes longer by, if no rule listens", having, "%"),
        Figure("games with a ball in play", 100.0 * statistics.mean(in_play), "%"),
    ]


def timed(call: Callable[[], None]) -> float:
    """Processor time that a call takes in this thread [s]."""
    started = time.thread_time()
    call()
    return time.thread_time() - started
