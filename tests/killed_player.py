"""Players who play short games as fast as possible and say what was shown to them, until they are killed.

    python killed_player.py

loads the game once, on a table without rules of its own, on one with, and on the one that new players meet;
then for every line `seed folder` that it reads it forks a player, says `pid N`, passes on what the player is
shown, and says `dead` when he is.
"""

from __future__ import annotations

import itertools
import os
import random
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from rule_tables import comet
from silverball.game.scores.store import Store
from silverball.table import Table, dump_table, load_table, table_digest

MOST_TICKS = 240  # of a game: a second of play
TABLES = (load_table("classic"), comet(), load_table("silver_comet"))


class Played(NamedTuple):
    """What a game came to; in a match, for one of its players."""

    table: Table
    seed: int
    score: int
    replay: str
    player: int = 1
    rank: int = 0

    @property
    def score_list(self) -> tuple[str, str, str]:
        """The list to which its score belongs."""
        return "arcade", self.table.name, table_digest(self.table)


def games(seed: int) -> Iterator[Played]:
    """Games with random presses, as many as one likes, on all tables in turn."""
    from silverball.game.game import Game

    draw = random.Random(seed)
    for count in itertools.count(seed):
        number, table = draw.randrange(1, 2**31), TABLES[count % len(TABLES)]
        game = Game(table, number, players=draw.choice((1, 1, 3)))
        while not game.is_over and game.tick < MOST_TICKS:
            if game.view.on_board == 0:
                game.create_ball()
            game.step(draw.random() < 0.5, draw.random() < 0.5, ticks=20, launch=draw.random() < 0.5)
        game.end()
        player = draw.randrange(game.players)
        rank = draw.randrange(4)  # nothing here proves it, but it must be kept
        yield Played(table, number, game.scores[player], game.replay.to_text(), player + 1, rank)


def initials(id: int) -> str:
    """What the player of a score enters."""
    return f"{id % 1000:03}"


def show(*words: object) -> None:
    """Say something in one piece."""
    os.write(sys.stdout.fileno(), (" ".join(map(str, words)) + "\n").encode())


def play(folder: Path, seed: int) -> None:
    """Play games and keep them; what was shown is said as it is shown."""
    with Store(folder) as store:
        assert store.warning == ""
        show("opened")
        for count, game in enumerate(games(seed)):
            store.save_last_game(f"{count}\n{game.replay}")
            show("last_game", count)
            text = dump_table(game.table)
            id = store.add_score(
                "OLD", game.score, *game.score_list, game.seed, game.replay,
                table_text=text, player=game.player, rank=game.rank,
            )  # fmt: skip
            show("score", id, game.score, game.seed, game.player, game.rank)
            store.rename(id, initials(id))
            show("renamed", id)
            store.save_settings({"initials": initials(id), "count": count, "again": count})
            show("settings", count)


def add_scores(folder: Path, first: int, count: int) -> None:
    """Keep so many scores as fast as possible."""
    with Store(folder) as store:
        for score in range(first, first + count):
            id = store.add_score("OLD", score, "arcade", "Classic", "d" * 64, 0, "a replay\n" * 100)
            store.rename(id, initials(score))
        assert (store.warning, store.is_persistent) == ("", True)


def main() -> None:
    """Fork the players that are asked for."""
    for _ in zip(TABLES, games(0), strict=False):
        pass  # loads the compiled physics and rules, once for all players
    show("ready")
    for line in sys.stdin:
        seed, folder = line.rstrip("\n").split(" ", 1)
        start, started = os.pipe()
        player = os.fork()
        if player == 0:
            try:
                os.read(start, 1)  # until it has been said who plays
                play(Path(folder), int(seed))
            finally:
                os._exit(1)
        show("pid", player)
        os.write(started, b"!")
        os.close(start)
        os.close(started)
        os.waitpid(player, 0)
        show("dead")


if __name__ == "__main__":
    main()
