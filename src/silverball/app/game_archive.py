"""What is kept of a game, and when? The last game, its score, its replay as a file.

A score is written under the last initials as soon as a game is over, before any page shows it or asks for new
initials: whatever happens to the program meanwhile, what was shown is there. While another program holds the
file of the scores, it waits in a file beside it, and the player is told; as long as it is nowhere but in the
memory, it is called "not yet saved".
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.game.view import Mode
from silverball.table import dump_table

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog
    from silverball.game.game import Game
    from silverball.game.scores.store import Store
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


RETRY_SECONDS = 1.0  # between two tries to write what waits
REMIND_SECONDS = 10.0  # between two times that the player is told of a score that is not yet saved
LOST = "this score cannot be kept: the data folder cannot be written"
WAITS = "another program holds the scores: this one is kept in a file beside them until it can join them"
NOT_YET = "this score is not yet saved: another program holds the scores. It is tried again every second"
SAVED = "the score is now among the others"


class GameArchive:
    """Keeps games in the store.

    Args:
        store: Where.
        library: Learns of new scores.
    """

    def __init__(self, store: Store, library: Catalog) -> None:
        self._store, self._library = store, library
        self._score_waits = False  # and the player knows
        self._next_try = self._next_words = 0.0

    def pass_time(self, seconds: float) -> str:
        """Real time has gone on: try to write what waits for another program.

        Args:
            seconds: By a clock that never goes back [s].

        Returns:
            What to tell the player; empty if nothing.
        """
        if not self._store.has_pending or seconds < self._next_try:
            return ""
        self._next_try = seconds + RETRY_SECONDS
        is_saved = self._store.retry_pending()
        if is_saved:
            self._library.forget_scores()
        if not self._score_waits or (not is_saved and (self._store.is_spooled or seconds < self._next_words)):
            return ""
        self._next_words = seconds + REMIND_SECONDS
        self._score_waits = not is_saved
        return NOT_YET if not is_saved else SAVED if self._store.is_persistent else LOST

    def last_game(self, game: Game) -> None:
        """Keep a game as the one that was played last, if anything was played."""
        if game.world.created:
            self._store.save_last_game(game.replay.to_text())

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
        rank = self._store.high_score_rank(game.score, game.mode, key.digest)
        table = dump_table(recipe.resolved())
        number = self._store.add_score(
            initials, game.score, game.mode, key.title, key.digest, game.seed, text, table_text=table
        )
        self._library.forget_scores()
        self._score_waits = self._store.has_pending
        if self._score_waits:
            return Ended(rank, number, WAITS if self._store.is_spooled else NOT_YET)
        return Ended(rank, number, "" if self._store.is_persistent else LOST)

    def rename(self, ended: Ended, initials: str) -> None:
        """The player has given initials for a score."""
        if ended.score_id is not None:
            with suppress(SilverballError):  # another program may have removed the score meanwhile
                self._store.rename(ended.score_id, initials)
            self._library.forget_scores()
