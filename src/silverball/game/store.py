"""What is kept of the games that were played? Scores with their replays, the last game and the settings.

One SQLite file, `silverball.sqlite3` in the data folder. What a method has written when it returns survives
a killed program and a power failure. Several programs may use the file at once; a `Store` belongs to the
thread that made it. Playing never depends on the file: where it cannot be written, the store goes on in
memory with a copy of what can be read, and `trouble` says so in one sentence.

A **list** is what scores are ranked in: one for each mode and table as it was chosen. All boards of a recipe
share the list of the recipe, since hardly anybody plays the same random board twice and a list of one score
is none; the seed beside each score says which board it was and brings it back. A table that was changed is
another table (its digest tells), so its list begins anew; the old one stays.

Size: a score takes about 50 bytes and is never dropped; replays are kept for the `REPLAYS` best of a list.
Ten thousand scores on three tables with replays of 6 kB take 1.6 MB. A write waits for the disk, a few
milliseconds: write when a game is over or a menu is open, not while a ball rolls.
"""

from __future__ import annotations

import json
import sqlite3
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, Self

from silverball.errors import SilverballError
from silverball.game.database import Database, Schema
from silverball.game.folder import data_folder

FILE = "silverball.sqlite3"
PLACES = 10  # of a list that is shown; who comes into it has a high score
REPLAYS = 20  # kept of a list; more than are shown, for places move up when a score is removed

_MIGRATIONS = (
    (
        """
        CREATE TABLE list (
            id INTEGER PRIMARY KEY,
            mode TEXT NOT NULL,
            table_digest TEXT NOT NULL,  -- of the table as it was chosen: of a recipe, not of its board
            table_name TEXT NOT NULL,
            UNIQUE (mode, table_digest)
        )
        """,
        """
        CREATE TABLE score (
            id INTEGER PRIMARY KEY AUTOINCREMENT,  -- the number of a removed score is never given again
            list INTEGER NOT NULL REFERENCES list,
            initials TEXT NOT NULL,
            score INTEGER NOT NULL CHECK (typeof(score) = 'integer'),
            seed INTEGER NOT NULL CHECK (typeof(seed) = 'integer'),
            played INTEGER NOT NULL CHECK (typeof(played) = 'integer' AND played BETWEEN 0 AND 253402300799),
            verified INTEGER CHECK (verified IN (0, 1)),  -- NULL: not played back yet
            why TEXT NOT NULL DEFAULT '',
            replay TEXT  -- NULL: not kept
        )
        """,
        "CREATE INDEX best ON score (list, score DESC, id)",
        "CREATE INDEX replays ON score (list, score DESC, id) WHERE replay IS NOT NULL",
        "CREATE TABLE setting (name TEXT PRIMARY KEY, value TEXT NOT NULL)",  # value: JSON
        "CREATE TABLE last_game (id INTEGER PRIMARY KEY CHECK (id = 1), replay TEXT NOT NULL)",
    ),
)
SCHEMA = Schema(
    application=int.from_bytes(b"Silv", "big"),
    migrations=_MIGRATIONS,
    tables={
        "list": ("id", "mode", "table_digest", "table_name"),
        "score": ("id", "list", "initials", "score", "seed", "played", "verified", "why", "replay"),
        "setting": ("name", "value"),
        "last_game": ("id", "replay"),
    },
)
_LOOK = (
    "SELECT score.id, initials, score, mode, table_name, table_digest, seed, played, verified, why,"
    " replay IS NOT NULL FROM score JOIN list ON list.id = score.list WHERE"
)


class Score(NamedTuple):
    """One line of a list.

    Attributes:
        id: Its number, which no other score ever has.
        initials: Of the player.
        score: Points.
        mode: Which game, see `silverball.game.news.Mode`.
        table_name: The name of the table as it was chosen; of a random board that of its recipe.
        table_digest: The digest of that table.
        seed: Of the world and, if the table is a recipe, of the board.
        when: When the game ended, UTC.
        verified: Whether its replay reaches this score; None if nobody has tried.
        why: Why it does not.
        has_replay: Whether its replay is kept.
    """

    id: int
    initials: str
    score: int
    mode: str
    table_name: str
    table_digest: str
    seed: int
    when: datetime
    verified: bool | None
    why: str
    has_replay: bool


class ScoreList(NamedTuple):
    """One list of scores: its mode, its table and how many scores there are."""

    mode: str
    table_name: str
    table_digest: str
    length: int


class Store:
    """What is kept of the games that were played.

    Args:
        folder: Where the file is or will be; None: the user's data folder.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._database = Database((folder or data_folder()) / FILE, SCHEMA)

    @property
    def path(self) -> Path:
        """The file."""
        return self._database.path

    @property
    def trouble(self) -> str:
        """What the player should know, one line for each thing that went wrong; empty if nothing did."""
        return self._database.trouble

    @property
    def keeps(self) -> bool:
        """Whether what is written now will be there after this run."""
        return self._database.keeps

    def __enter__(self) -> Self:
        """The store itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """Close the file; nothing is written by this that was not safe before."""
        self._database.close()

    # ── scores ──────────────────────────────────────────────────────────────────────────────────────────

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
    ) -> int:
        """Keep a score, with its replay if it is among the best; returns when it is safe on the disk.

        Save it under the last initials before asking for new ones, then `rename` it: so it is there
        whatever happens meanwhile.

        Args:
            initials: Of the player.
            score: Points.
            mode: Which game.
            table_name: The name of the table as it was chosen; the list goes by the last one it was given.
            table_digest: Its digest; of a recipe that of the recipe, so that all its boards share a list.
            seed: Of the world and, if the table is a recipe, of the board.
            replay_text: The replay.
            when: When the game ended; None: now.

        Returns:
            Its number.
        """
        played = int((when or datetime.now(UTC)).timestamp())
        name = table_name.encode("utf-8", "replace").decode("utf-8")  # a path may have bytes that are no text

        def add(connection: sqlite3.Connection) -> int:
            connection.execute(
                "INSERT INTO list (mode, table_digest, table_name) VALUES (?, ?, ?)"
                " ON CONFLICT DO UPDATE SET table_name = excluded.table_name",
                (str(mode), table_digest, name),
            )
            ((number,),) = connection.execute(
                "SELECT id FROM list WHERE mode = ? AND table_digest = ?", (str(mode), table_digest)
            ).fetchall()
            best = "FROM score WHERE list = ? AND replay IS NOT NULL"
            ((better,),) = connection.execute(
                f"SELECT count(*) {best} AND score >= ?", (number, score)
            ).fetchall()
            replay = replay_text if better < REPLAYS else None
            cursor = connection.execute(
                "INSERT INTO score (list, initials, score, seed, played, replay) VALUES (?, ?, ?, ?, ?, ?)",
                (number, initials, score, seed, played, replay),
            )
            connection.execute(
                "UPDATE score SET replay = NULL WHERE id IN"
                f" (SELECT id {best} ORDER BY score DESC, id LIMIT -1 OFFSET ?)",
                (number, REPLAYS),
            )
            return int(cursor.lastrowid or 0)

        return self._database.write(add)

    def rename(self, id: int, initials: str) -> None:
        """Put other initials to a score.

        Raises:
            SilverballError: There is no score of that number.
        """
        self._change(id, "UPDATE score SET initials = ? WHERE id = ?", (initials, id))

    def mark(self, id: int, verified: bool | None, why: str = "") -> None:
        """Write down whether the replay of a score reaches it, and why not.

        Raises:
            SilverballError: There is no score of that number.
        """
        self._change(id, "UPDATE score SET verified = ?, why = ? WHERE id = ?", (verified, why, id))

    def remove(self, id: int) -> None:
        """Remove a score and its replay.

        Raises:
            SilverballError: There is no score of that number.
        """
        self._change(id, "DELETE FROM score WHERE id = ?", (id,))

    def lists(self) -> list[ScoreList]:
        """All lists, those with the most scores first."""
        rows = self._database.read(
            "SELECT mode, table_name, table_digest, count(*) FROM score JOIN list ON list.id = score.list"
            " GROUP BY list ORDER BY count(*) DESC, list"
        )
        return [ScoreList(*row) for row in rows]

    def scores(
        self,
        mode: str | None = None,
        table_digest: str | None = None,
        table_name: str | None = None,
        limit: int = PLACES,
    ) -> list[Score]:
        """The best scores, best first; of equal ones the earlier is the better.

        Args:
            mode: Of this mode only.
            table_digest: Of this table only: this is the one that says which list.
            table_name: Of tables of this name only, whatever they contain.
            limit: How many at most; -1: all.
        """
        wanted = {"mode": mode, "table_digest": table_digest, "table_name": table_name}
        wanted = {column: value for column, value in wanted.items() if value is not None}
        which = " AND ".join(f"{column} = ?" for column in wanted) or "true"
        # One list is read from its index; several are sorted.
        rows = self._database.read(
            f"{_LOOK} {which} ORDER BY score DESC, score.id LIMIT ?", (*map(str, wanted.values()), limit)
        )
        return [_score(row) for row in rows]

    def score(self, id: int) -> Score:
        """One score.

        Raises:
            SilverballError: There is no score of that number.
        """
        rows = self._database.read(f"{_LOOK} score.id = ?", (id,))
        if not rows:
            raise _no_such(id)
        return _score(rows[0])

    def is_high(self, score: int, mode: str, table_digest: str) -> int | None:
        """The place, from 1, that a score would have in the list that is shown; None if it is not in it.

        No points are no high score.
        """
        ((better,),) = self._database.read(
            "SELECT count(*) FROM (SELECT 1 FROM score WHERE score >= ? AND list ="
            " (SELECT id FROM list WHERE mode = ? AND table_digest = ?) LIMIT ?)",
            (score, str(mode), table_digest, PLACES),
        )
        return int(better) + 1 if score > 0 and better < PLACES else None

    def replay(self, id: int) -> str:
        """The replay of a score.

        Raises:
            SilverballError: There is no score of that number, or its replay was not kept.
        """
        rows = self._database.read("SELECT replay FROM score WHERE id = ?", (id,))
        if not rows:
            raise _no_such(id)
        if rows[0][0] is None:
            raise SilverballError(
                f"score {id}: its replay was not kept, only those of the {REPLAYS} best of a list are"
            )
        return str(rows[0][0])

    # ── the last game, settings ─────────────────────────────────────────────────────────────────────────

    def keep_last_game(self, replay_text: str) -> None:
        """Keep the replay of the game that was played last, in place of the one before."""
        self._database.write(
            lambda connection: connection.execute(
                "INSERT INTO last_game (id, replay) VALUES (1, ?)"
                " ON CONFLICT (id) DO UPDATE SET replay = excluded.replay",
                (replay_text,),
            )
        )

    def last_game(self) -> str | None:
        """The replay of the game that was played last; None if there was none."""
        rows = self._database.read("SELECT replay FROM last_game")
        return str(rows[0][0]) if rows else None

    def settings(self) -> dict[str, Any]:
        """What was kept of the settings; values that are damaged are left out."""
        values = {}
        for name, value in self._database.read("SELECT name, value FROM setting ORDER BY name"):
            with suppress(ValueError, RecursionError):
                values[str(name)] = json.loads(value)
        return values

    def keep_settings(self, values: dict[str, Any]) -> None:
        """Keep settings, all of them or none; those that are not named stay as they are.

        Args:
            values: By name; anything that JSON can hold.
        """
        rows = [(name, json.dumps(value)) for name, value in values.items()]
        self._database.write(
            lambda connection: connection.executemany(
                "INSERT INTO setting (name, value) VALUES (?, ?)"
                " ON CONFLICT (name) DO UPDATE SET value = excluded.value",
                rows,
            )
        )

    def _change(self, id: int, statement: str, values: tuple[Any, ...]) -> None:
        if self._database.write(lambda connection: connection.execute(statement, values).rowcount) == 0:
            raise _no_such(id)


def _score(row: tuple[Any, ...]) -> Score:
    id, initials, score, mode, table_name, table_digest, seed, played, verified, why, has_replay = row
    return Score(
        id,
        initials,
        score,
        mode,
        table_name,
        table_digest,
        seed,
        datetime.fromtimestamp(played, UTC),
        None if verified is None else bool(verified),
        why,
        bool(has_replay),
    )


def _no_such(id: int) -> SilverballError:
    return SilverballError(f"there is no score {id}; `silverball scores` lists them with their numbers")
