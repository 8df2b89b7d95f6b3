"""The store of played games: scores with their replays, the last game and the settings.

It is one SQLite file, `silverball.sqlite3` in the data folder. What a method has written when it returns
survives a killed program and a power failure. Several programs may use the file at once; a `Store` belongs to
the thread that made it. Playing never depends on the file: if it cannot be written, the store continues in
memory with a copy of what can be read, and `warning` says so in one sentence. While another program holds the
file, new data is spooled to another file (see `pending`) and imported later.

Scores are ranked in *lists*, one for each mode and table as chosen. All boards of a recipe share the list of
the recipe, because hardly anyone plays the same random board twice; the seed of a score identifies
its board and recreates it. A changed table is another table with another digest, so it begins a new list; the
old one stays. The list holds the text of its table, so that a score can be proven after the file of the table
has been deleted. A score that failed verification ranks below all others of its list; one that was not
verified yet ranks by its points.

A score is never dropped, and neither is its replay, because without a replay it cannot be proven: a minute of
play takes about 3 kB. A write waits for the disk for a few milliseconds: write when a game is over or a menu
is open, not while a ball rolls.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from silverball.errors import SilverballError
from silverball.game.replay.recording import has_custom_rules
from silverball.game.scores import score_records
from silverball.game.scores.pending import NewScore
from silverball.game.scores.score_records import (
    COLUMNS,
    REJECTED,
    SCHEMA,
    Score,
    ScoreList,
    score_of,
    text_of,
)
from silverball.game.scores.spooled_store import FILE, SpooledStore, no_such_score

__all__ = ["FILE", "PLACES", "SCHEMA", "Score", "ScoreList", "Store"]

PLACES = 10  # length of a list on display; a score in it is a high score
_SELECT = f"SELECT {COLUMNS} FROM score JOIN list ON list.id = score.list WHERE"


class Store(SpooledStore):
    """The store of played games.

    Args:
        folder: The folder of the file; None: the data folder of the user.
        nonblocking: Never wait for another program that holds the file, for use in a window: reads then
            return the last result. Otherwise wait for it, and fail after a timeout.
    """

    def __init__(self, folder: Path | None = None, *, nonblocking: bool = False) -> None:
        super().__init__(folder, SCHEMA, nonblocking=nonblocking)

    def add_score(
        self,
        initials: str,
        score: int,
        mode: str,
        table_name: str,
        table_digest: str,
        seed: int,
        replay_text: str,
        when: datetime | None = None,
        table_text: str = "",
        player: int = 1,
        rank: int = 0,
    ) -> int:
        """Add a score with its replay; returns when it is on the disk.

        Add it under the last initials before asking for new ones, then `rename` it, so that it survives
        whatever happens meanwhile.

        Args:
            initials: The initials of the player.
            score: Points.
            mode: The mode of the game.
            table_name: The name of the table as chosen; the list takes the name given last.
            table_digest: The digest of that table; for a recipe that of the recipe, so that all its boards
                share a list.
            seed: The seed of the world and, if the table is a recipe, of the board.
            replay_text: The replay.
            when: The time at which the game ended; None: now.
            table_text: The table as a table file. Without it only scores on built-in tables can be proven.
            player: Which player of a match has it, from 1.
            rank: The missions that were finished in the game; see `rank`.

        Returns:
            Its number; a temporary one beyond 63 bits if the score is pending.

        Raises:
            SilverballError: The game was scored by custom rules, so its score cannot be compared.
        """
        if has_custom_rules(replay_text):
            raise SilverballError("a game with custom rules cannot enter the score lists")
        played = int((when or datetime.now(UTC)).timestamp())
        name = table_name.encode("utf-8", "replace").decode("utf-8")  # a path may not be valid UTF-8
        new = NewScore.model_construct(
            initials=initials, score=score, mode=str(mode), table_name=name, table_digest=table_digest,
            table_text=table_text, seed=seed, replay=replay_text, played=played, player=player, rank=rank,
        )  # fmt: skip
        return self._write(
            lambda connection: score_records.add(connection, new), lambda: self._add_pending(new)
        )

    def rename(self, id: int, initials: str) -> None:
        """Change the initials of a score.

        Raises:
            SilverballError: There is no score of that number.
        """
        self.retry_pending()
        new = self._pending_score(id)
        if new is not None:
            new.initials = initials
            self._spool.write()
        else:
            statement = "UPDATE score SET initials = ? WHERE id = ?"
            self._change(id, statement, (initials,), lambda: self._rename_pending(id, initials))

    def save_verdicts(self, verdicts: dict[int, tuple[bool | None, str]]) -> None:
        """Save the results of verification, by the numbers of the scores: whether proven, and why not.

        Scores that were removed meanwhile are ignored.

        Raises:
            SilverballError: Another program holds the file.
        """
        rows = [(verified, why, self._file_id(id)) for id, (verified, why) in verdicts.items()]
        statement = "UPDATE score SET verified = ?, why = ? WHERE id = ?"
        self._write(lambda connection: connection.executemany(statement, rows))

    def remove(self, id: int) -> None:
        """Remove a score and its replay.

        Raises:
            SilverballError: There is no score of that number, or another program holds the file.
        """
        self._change(id, "DELETE FROM score WHERE id = ?", ())

    def lists(self) -> list[ScoreList]:
        """All lists, those with the most scores first."""
        rows = self._read(
            "SELECT mode, table_name, table_digest, count(*), list.id"
            " FROM score JOIN list ON list.id = score.list GROUP BY list.id ORDER BY count(*) DESC, list.id"
        )
        return [
            ScoreList(text_of(mode), text_of(name), text_of(digest), length, id)
            for mode, name, digest, length, id in rows
        ]

    def table_text(self, list_id: int) -> str:
        """The table of a list as a table file; empty if it is not available."""
        rows = self._read("SELECT table_text FROM list WHERE id = ?", (list_id,))
        return text_of(rows[0][0]) if rows else ""

    def scores(
        self,
        mode: str | None = None,
        table_digest: str | None = None,
        table_name: str | None = None,
        limit: int = PLACES,
        list_id: int | None = None,
        seed: int | None = None,
    ) -> list[Score]:
        """The best scores, best first; of equal ones the earlier ranks higher, rejected ones come last.

        Args:
            mode: Only scores of this mode.
            table_digest: Only scores on this table; mode and digest together name a list.
            table_name: Only scores on tables of this name, whatever they contain.
            limit: The most scores to return; -1: all.
            list_id: Only scores of the list with this number.
            seed: Only scores of this seed; that of a day makes a daily list (`daily_seed`).
        """
        wanted = {"mode": mode, "table_digest": table_digest, "table_name": table_name}
        words = {column: str(value) for column, value in wanted.items() if value is not None}
        numbers = {"list.id": list_id, "seed": seed}
        exact = words | {column: value for column, value in numbers.items() if value is not None}
        which = " AND ".join(f"{column} = ?" for column in exact)
        rows = self._read(
            f"{_SELECT} {which or 'true'} ORDER BY {REJECTED}, score DESC, score.id LIMIT ?",
            (*exact.values(), limit),
        )
        found = [self._with_pending_initials(score_of(row)) for row in rows]
        if list_id is None:
            found += [one for one in self._pending_scores() if exact.items() <= one._asdict().items()]
        found.sort(key=lambda one: one.order)
        return found[:limit] if limit >= 0 else found

    def score(self, id: int) -> Score:
        """One score.

        Raises:
            SilverballError: There is no score of that number.
        """
        for one in self._pending_scores():
            if one.id == id:
                return one
        rows = self._read(f"{_SELECT} score.id = ?", (self._file_id(id),), is_required=True)
        if not rows:
            raise no_such_score(id)
        return self._with_pending_initials(score_of(rows[0]))

    def rank(self, mode: str, table_digest: str) -> int:
        """The player's rank on a table, kept for ever: the missions that all games of its list have finished.

        It is the sum of what the scores claim, and each claim is proven by the replay of its score; rejected
        scores do not count.
        """
        rows = self._read(
            "SELECT total(rank) FROM score JOIN list ON list.id = score.list"
            f" WHERE mode = ? AND table_digest = ? AND NOT {REJECTED} AND rank > 0",
            (str(mode), table_digest),
        )
        pending = [
            one for one in self._pending_scores() if (one.mode, one.table_digest) == (mode, table_digest)
        ]
        return int(rows[0][0] if rows else 0) + sum(one.rank for one in pending)

    def high_score_rank(
        self, score: int, mode: str, table_digest: str, seed: int | None = None
    ) -> int | None:
        """The rank, from 1, that a score would have in the list that is shown; None if it is not in it.

        Zero points are not a high score; rejected scores do not count. With a seed, the list of that seed.
        """
        shown = self.scores(mode, table_digest, seed=seed)
        better = sum(one.score >= score and not one.is_rejected for one in shown)
        return better + 1 if score > 0 and better < PLACES else None

    def replay(self, id: int) -> str:
        """The replay of a score.

        Raises:
            SilverballError: There is no score of that number, or its replay is missing.
        """
        new = self._pending_score(id)
        if new is not None:
            return new.replay
        rows = self._read("SELECT replay FROM score WHERE id = ?", (self._file_id(id),), is_required=True)
        if not rows:
            raise no_such_score(id)
        if rows[0][0] is None:
            raise SilverballError(f"score {id}: its replay was not kept")
        return text_of(rows[0][0])

    def save_last_game(self, replay_text: str) -> None:
        """Save the replay of the last game, in place of the one before."""

        def spool() -> None:
            self._spool.pending.last_game = replay_text
            self._spool.write()

        self._write(lambda connection: score_records.save_last_game(connection, replay_text), spool)

    def last_game(self) -> str | None:
        """The replay of the last game; None if there was none."""
        if self._spool.pending.last_game is not None:
            return self._spool.pending.last_game
        rows = self._read("SELECT replay FROM last_game")
        return text_of(rows[0][0]) if rows else None

    def settings(self) -> dict[str, Any]:
        """The saved settings by name; damaged values are left out."""
        values = {}
        for name, value in self._read("SELECT name, value FROM setting ORDER BY name"):
            with suppress(ValueError, RecursionError, TypeError):
                values[text_of(name)] = json.loads(value)
        return values | self._spool.pending.settings

    def save_settings(self, values: dict[str, Any]) -> None:
        """Save settings, all of them or none; others stay as they are.

        Args:
            values: JSON values by name.
        """

        def spool() -> None:
            self._spool.pending.settings |= json.loads(json.dumps(values))
            self._spool.write()

        self._write(lambda connection: score_records.save_settings(connection, values), spool)

    def _change(
        self, id: int, statement: str, values: tuple[Any, ...], spool: Callable[[], int] | None = None
    ) -> None:
        """Run a statement that must change the score of a number."""
        row = (*values, self._file_id(id))
        if self._write(lambda connection: connection.execute(statement, row).rowcount, spool) == 0:
            raise no_such_score(id)
