"""A player who plays short games as fast as possible and says what was shown to him, until he is killed.

Imported by the server that the tests fork players from, so that each of them begins to play at once.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple

from silverball.game.store import Store

try:
    from silverball.game.game import Game
except ImportError:  # pragma: no cover
    Game = None  # type: ignore[assignment,misc]

MOST_TICKS = 240  # of a game: a second of play
BOARD = ("arcade", "random", "d" * 64)


class Played(NamedTuple):
    """What a game came to."""

    seed: int
    score: int
    replay: str


def games(seed: int) -> Iterator[Played]:
    """Games with random presses, as many as one likes."""
    draw = random.Random(seed)
    while True:
        number = draw.randrange(1, 2**31)
        if Game is None:
            yield Played(number, number, f"replay {number}\n" + "a line\n" * draw.randrange(500))
            continue
        game = Game("classic", number)
        while not game.is_over and game.tick < MOST_TICKS:
            if game.face.on_board == 0:
                game.create_ball()
            game.advance(draw.random() < 0.5, draw.random() < 0.5, ticks=20)
        game.end()
        yield Played(number, game.score, game.replay.to_text())


def initials(id: int) -> str:
    """What the player of a score enters."""
    return f"{id % 1000:03}"


def play(folder: Path, seed: int, shown: Connection) -> None:
    """Play games and keep them; what was shown is sent as it is shown."""
    with Store(folder) as store:
        assert store.trouble == ""
        shown.send(("opened",))
        for count, game in enumerate(games(seed)):
            store.keep_last_game(f"{count}\n{game.replay}")
            shown.send(("last game", count))
            id = store.add_score("OLD", game.score, *BOARD, game.seed, game.replay)
            shown.send(("score", id, game.score, game.seed))
            store.rename(id, initials(id))
            shown.send(("renamed", id))
            store.keep_settings({"initials": initials(id), "count": count, "again": count})
            shown.send(("settings", count))


def add_scores(folder: Path, first: int, count: int) -> None:
    """Keep so many scores as fast as possible."""
    with Store(folder) as store:
        for score in range(first, first + count):
            id = store.add_score("OLD", score, *BOARD, 0, "a replay\n" * 100)
            store.rename(id, initials(score))
        assert (store.trouble, store.keeps) == ("", True)


if Game is not None:
    next(games(0))  # loads the compiled physics, once for all players
