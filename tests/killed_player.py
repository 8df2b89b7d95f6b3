"""Players who play short games as fast as possible and say what was shown to them, until they are killed.

    python killed_player.py

loads the game once; then for every line `seed folder` that it reads it forks a player, says `pid N`, passes
on what the player is shown, and says `dead` when he is.
"""

from __future__ import annotations

import os
import random
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from silverball.game.scores.store import Store

MOST_TICKS = 240  # of a game: a second of play
LIST = ("arcade", "Classic", "d" * 64)


class Played(NamedTuple):
    """What a game came to."""

    seed: int
    score: int
    replay: str


def games(seed: int) -> Iterator[Played]:
    """Games with random presses, as many as one likes."""
    from silverball.game.game import Game

    draw = random.Random(seed)
    while True:
        number = draw.randrange(1, 2**31)
        game = Game("classic", number)
        while not game.is_over and game.tick < MOST_TICKS:
            if game.view.on_board == 0:
                game.create_ball()
            game.step(draw.random() < 0.5, draw.random() < 0.5, ticks=20)
        game.end()
        yield Played(number, game.score, game.replay.to_text())


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
            id = store.add_score("OLD", game.score, *LIST, game.seed, game.replay)
            show("score", id, game.score, game.seed)
            store.rename(id, initials(id))
            show("renamed", id)
            store.save_settings({"initials": initials(id), "count": count, "again": count})
            show("settings", count)


def add_scores(folder: Path, first: int, count: int) -> None:
    """Keep so many scores as fast as possible."""
    with Store(folder) as store:
        for score in range(first, first + count):
            id = store.add_score("OLD", score, *LIST, 0, "a replay\n" * 100)
            store.rename(id, initials(score))
        assert (store.warning, store.is_persistent) == ("", True)


def main() -> None:
    """Fork the players that are asked for."""
    next(games(0))  # loads the compiled physics, once for all of them
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
