"""Plays one game of a study again and records it, so that it can be watched."""

from __future__ import annotations

from collections.abc import Callable

from silverball.errors import NoRoom, SilverballError
from silverball.game.game import Game
from silverball.game.game_batch import GameBatch
from silverball.game.replay.format import Replay
from silverball.game.view import Phase
from silverball.metrics.game_traces import TICK_RATE
from silverball.metrics.marked_games import STEP, Buttons
from silverball.players.planner import BRANCHES
from silverball.table import Table, generate_table


def replay_of(
    table: Table,
    player: str,
    seed: int,
    longest: float,
    progress: Callable[[float], None] = lambda share: None,
) -> Replay:
    """The replay of the game that a study played with a seed.

    Args:
        table: The table or recipe of the arm.
        player: The name of the player.
        seed: The seed.
        longest: [s] after which the game was cut short.
        progress: Called from time to time with the share of the longest time that is played.

    Raises:
        SilverballError: The two did not play the same game.
    """
    board = table if table.random is None else generate_table(seed, table)
    batch = GameBatch(board, 1, seed, TICK_RATE, threads=1)
    game = Game(board, seed, "arcade", TICK_RATE)
    buttons = Buttons(batch, player, BRANCHES)
    blocks = round(longest * TICK_RATE / STEP)
    for block in range(blocks):
        held = buttons.held()
        left, right, _, launch = held[0, 0].tolist()
        batch.step_unchecked(held, STEP)
        for _ in range(STEP):
            if game.phase is Phase.READY:
                serve(game)
            game.step(left, right, launch=launch)
        if game.is_over:
            break
        if block % TICK_RATE == 0:
            progress(block / blocks)
    score = int(batch.games["score"][0])
    if game.score != score:
        raise SilverballError(f"seed {seed}: the recorded game has {game.score} points, expected {score}")
    return game.replay


def serve(game: Game) -> None:
    """Start the next ball, if there is room for it."""
    try:
        game.create_ball()
    except NoRoom:
        return
