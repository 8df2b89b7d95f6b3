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
from silverball.game.scores.daily import day_of
from silverball.game.view import Mode
from silverball.table import dump_table

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog
    from silverball.game.game import Game
    from silverball.game.scores.store import Store
    from silverball.table import Table


class SavedScore(NamedTuple):
    """A score of a finished game.

    Attributes:
        player: Whose it is, from 1.
        score: Points.
        rank: Its rank in the high scores, from 1; None if it has none.
        id: Its id in the store.
        rank_today: Its rank in the list of a daily board; None if it has none.
    """

    player: int
    score: int
    rank: int | None
    id: int
    rank_today: int | None = None


class GameResult(NamedTuple):
    """The outcome of saving a finished game.

    Attributes:
        scores: The scores that were saved, in the order of the players.
        message: Message for the player; empty if there is none.
    """

    scores: tuple[SavedScore, ...] = ()
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
        scores = self._save_scores(game, recipe, initials)
        self._catalog.clear_score_cache()
        self._is_score_pending = self._store.has_pending
        if self._is_score_pending:
            return GameResult(scores, PENDING if self._store.is_spooled else NOT_YET_SAVED)
        return GameResult(scores, "" if self._store.is_persistent else LOST)

    def _save_scores(self, game: Game, recipe: Table, initials: str) -> tuple[SavedScore, ...]:
        """Save the scores of all players, the best first, so that each rank counts those before it."""
        store, key, text = self._store, self._catalog.score_key(recipe), game.replay.to_text()
        table, seed = dump_table(recipe.resolved()), game.seed
        saved = []
        for player, score in sorted(enumerate(game.scores, 1), key=lambda one: -one[1]):
            if score <= 0:
                continue
            rank = store.high_score_rank(score, game.mode, key.digest)
            today = None
            if day_of(seed) is not None:
                today = store.high_score_rank(score, game.mode, key.digest, seed)
            id = store.add_score(
                initials, score, game.mode, key.title, key.digest, seed, text,
                table_text=table, player=player, rank=game.ranks[player - 1],
            )  # fmt: skip
            saved.append(SavedScore(player, score, rank, id, today))
        return tuple(sorted(saved))

    def rename(self, result: GameResult, initials: str, player: int = 0) -> None:
        """Assign initials to the score of a player of a game; 0: the only one."""
        for one in result.scores:
            if player in (0, one.player):
                with suppress(SilverballError):  # another program may have removed the score
                    self._store.rename(one.id, initials)
                self._catalog.clear_score_cache()
