"""What is kept of a game, and when? The last game, its score, its replay as a file.

A score is written under the last initials as soon as a game is over, before any page shows it or asks for new
initials: whatever happens to the program meanwhile, what was shown is there.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.game.news import Mode

if TYPE_CHECKING:
    from silverball.app.library import Library
    from silverball.game.game import Game
    from silverball.game.store import Store
    from silverball.table import Table


class Ended(NamedTuple):
    """What has become of a game that is over.

    Attributes:
        rank: The place of its score in the list, from 1; None if it has none.
        score_id: The number of its score in the store; None if it was not kept.
        words: What the player should be told; empty if nothing.
    """

    rank: int | None = None
    score_id: int | None = None
    words: str = ""


class Keeper:
    """Keeps games in the store.

    Args:
        store: Where.
        library: Learns of new scores.
    """

    def __init__(self, store: Store, library: Library) -> None:
        self._store, self._library = store, library

    def last_game(self, game: Game) -> None:
        """Keep a game as the one that was played last, if anything was played."""
        if game.world.created:
            self._store.keep_last_game(game.replay.to_text())

    def file(self, game: Game, why: str) -> Path | None:
        """Keep the replay of a game as a file; where it is, None if it cannot be written."""
        return self._library.keep_file(game.replay.to_text(), why, game.score)

    def ended(self, game: Game, recipe: Table, initials: str, *, counts: bool) -> Ended:
        """Keep a game that is over.

        Args:
            game: The game.
            recipe: What its board was made of; the list of its scores is that of the recipe.
            initials: Whose it is, for now.
            counts: Whether its score is for the scores.
        """
        self.last_game(game)
        if game.fault:
            path = self.file(game, "fault")
            where = f"A replay for a report is at {path}." if path else "Its replay is lost."
            return Ended(words=f"{game.fault}: this board had to stop. {where} R makes a new one")
        if game.mode is not Mode.ARCADE or not counts or game.score <= 0:
            return Ended()
        key, text = self._library.key(recipe), game.replay.to_text()
        rank = self._store.is_high(game.score, game.mode, key.digest)
        number = self._store.add_score(
            initials, game.score, game.mode, key.title, key.digest, game.seed, text
        )
        self._library.forget_scores()
        lost = "" if self._store.keeps else "this score cannot be kept: the data folder cannot be written"
        return Ended(rank, number, lost)

    def rename(self, ended: Ended, initials: str) -> None:
        """The player has given initials for a score."""
        if ended.score_id is not None:
            with suppress(SilverballError):  # another program may have removed the score meanwhile
                self._store.rename(ended.score_id, initials)
            self._library.forget_scores()
