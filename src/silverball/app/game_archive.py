"""Saves games in the store: the last game, the score, and the replay as a file.

A score is saved with the last initials as soon as a game is over, before a page shows it or asks for
initials, so that a crash cannot lose a score that was shown. While another program locks the score file, the
score is spooled to a file beside it, and a message says so. A score that is only in memory is called "not yet
saved".
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


class GameResult(NamedTuple):
    """The outcome of saving a finished game.

    Attributes:
        rank: The rank of its score, from 1; None if it has none.
        score_id: The id of its score in the store; None if it was not saved.
        message: Message for the player; empty if there is none.
    """

    rank: int | None = None
    score_id: int | None = None
    message: str = ""


RETRY_SECONDS = 1.0  # between two attempts to write pending data
REMIND_SECONDS = 10.0  # between two messages about a score that is not yet saved
LOST = "this score cannot be saved: the data folder cannot be written"
PENDING = "another program has locked the scores: this one is saved in a separate file for now"
NOT_YET_SAVED = "this score is not yet saved: another program has locked the scores. Retrying every second"
SAVED = "the score has been added to the high scores"


class GameArchive:
    """Saves games in the store.

    Args:
        store: Store that games are saved in.
        catalog: Catalog whose cached scores are dropped after a new one.
    """

    def __init__(self, store: Store, catalog: Catalog) -> None:
        self._store, self._catalog = store, catalog
        self._is_score_pending = False  # and a message has said so
        self._next_retry = self._next_reminder = 0.0

    def retry_pending(self, seconds: float) -> str:
        """Try to write data that another program has delayed by its lock.

        Args:
            seconds: Time of a monotonic clock [s].

        Returns:
            A message for the player; empty if there is none.
        """
        if not self._store.has_pending or seconds < self._next_retry:
            return ""
        self._next_retry = seconds + RETRY_SECONDS
        is_saved = self._store.retry_pending()
        if is_saved:
            self._catalog.clear_score_cache()
        if not self._is_score_pending or (
            not is_saved and (self._store.is_spooled or seconds < self._next_reminder)
        ):
            return ""
        self._next_reminder = seconds + REMIND_SECONDS
        self._is_score_pending = not is_saved
        return NOT_YET_SAVED if not is_saved else SAVED if self._store.is_persistent else LOST

    def save_last_game(self, game: Game) -> None:
        """Save a game as the last one, if a ball was created."""
        if game.world.created:
            self._store.save_last_game(game.replay.to_text())

    def save_replay_file(self, game: Game, name: str) -> Path | None:
        """Save the replay of a game as a file and return its path; None if it cannot be written."""
        return self._catalog.save_replay_file(game.replay.to_text(), name, game.score)

    def save_finished_game(self, game: Game, recipe: Table, initials: str, *, is_ranked: bool) -> GameResult:
        """Save a game that is over.

        Args:
            game: The game.
            recipe: The table that its board was made from; its score list gets the score.
            initials: Initials of the player, until new ones are entered.
            is_ranked: Whether its score may enter the high scores.
        """
        self.save_last_game(game)
        if game.fault:
            path = self.save_replay_file(game, "fault")
            where = f"A replay for a report is at {path}." if path else "Its replay is lost."
            return GameResult(message=f"{game.fault}: this board had to stop. {where} R makes a new one")
        if game.mode is not Mode.ARCADE or not is_ranked or game.score <= 0:
            return GameResult()
        key, text = self._catalog.score_key(recipe), game.replay.to_text()
        rank = self._store.high_score_rank(game.score, game.mode, key.digest)
        table = dump_table(recipe.resolved())
        number = self._store.add_score(
            initials, game.score, game.mode, key.title, key.digest, game.seed, text, table_text=table
        )
        self._catalog.clear_score_cache()
        self._is_score_pending = self._store.has_pending
        if self._is_score_pending:
            return GameResult(rank, number, PENDING if self._store.is_spooled else NOT_YET_SAVED)
        return GameResult(rank, number, "" if self._store.is_persistent else LOST)

    def rename(self, result: GameResult, initials: str) -> None:
        """Assign initials to the score of a game."""
        if result.score_id is not None:
            with suppress(SilverballError):  # another program may have removed the score
                self._store.rename(result.score_id, initials)
            self._catalog.clear_score_cache()
