"""The records of the score file: its schema, the statements that write it, and scores read from its rows.

Other programs can change the file, and SQLite stores a text where a number is expected. So no type is
trusted: a value that does not fit is replaced by a harmless one, and `Score.damage` says which it was.
"""

from __future__ import annotations

import json
import sqlite3
from datetime import UTC, datetime
from typing import Any, NamedTuple

from silverball.game.scores.pending import NewScore, Pending
from silverball.game.scores.sqlite_file import Schema

_MIGRATIONS = (
    (
        """
        CREATE TABLE list (
            id INTEGER PRIMARY KEY,
            mode TEXT NOT NULL,
            table_digest TEXT NOT NULL,  -- of the table as chosen: of a recipe, not of its board
            table_name TEXT NOT NULL,
            UNIQUE (mode, table_digest)
        )
        """,
        """
        CREATE TABLE score (
            id INTEGER PRIMARY KEY AUTOINCREMENT,  -- numbers of removed scores are not reused
            list INTEGER NOT NULL REFERENCES list,
            initials TEXT NOT NULL,
            score INTEGER NOT NULL CHECK (typeof(score) = 'integer'),
            seed INTEGER NOT NULL CHECK (typeof(seed) = 'integer'),
            played INTEGER NOT NULL CHECK (typeof(played) = 'integer' AND played BETWEEN 0 AND 253402300799),
            verified INTEGER CHECK (verified IN (0, 1)),  -- NULL: not verified yet
            why TEXT NOT NULL DEFAULT '',
            replay TEXT  -- NULL: missing
        )
        """,
        "CREATE INDEX best ON score (list, score DESC, id)",
        "CREATE INDEX replays ON score (list, score DESC, id) WHERE replay IS NOT NULL",
        "CREATE TABLE setting (name TEXT PRIMARY KEY, value TEXT NOT NULL)",  # value: JSON
        "CREATE TABLE last_game (id INTEGER PRIMARY KEY CHECK (id = 1), replay TEXT NOT NULL)",
    ),
    (
        "ALTER TABLE list ADD COLUMN table_text TEXT NOT NULL DEFAULT ''",  # '': not available
        "CREATE TABLE taken_in (token TEXT PRIMARY KEY, score INTEGER NOT NULL)",  # see `pending`
        "DROP INDEX IF EXISTS replays",  # every score has one now
    ),
    (
        "ALTER TABLE score ADD COLUMN player INTEGER NOT NULL DEFAULT 1",  # whose it is, in a match
        "ALTER TABLE score ADD COLUMN rank INTEGER NOT NULL DEFAULT 0",  # missions finished in the game
        "CREATE INDEX daily ON score (list, seed)",
    ),
)
SCHEMA = Schema(
    application=int.from_bytes(b"Silv", "big"),
    migrations=_MIGRATIONS,
    tables={
        "list": ("id", "mode", "table_digest", "table_name", "table_text"),
        "score": (
            "id",
            "list",
            "initials",
            "score",
            "seed",
            "played",
            "verified",
            "why",
            "replay",
            "player",
            "rank",
        ),
        "setting": ("name", "value"),
        "last_game": ("id", "replay"),
        "taken_in": ("token", "score"),
    },
)

COLUMNS = (
    "score.id, initials, score, mode, table_name, table_digest, seed, played, verified, why,"
    " replay IS NOT NULL, player, rank"
)
REJECTED = (
    "(verified IS 0 OR typeof(score) != 'integer' OR typeof(seed) != 'integer'"
    " OR typeof(played) != 'integer' OR typeof(initials) != 'text' OR typeof(player) != 'integer'"
    " OR typeof(rank) != 'integer')"
)
"""In SQL: whether a row ranks below all others, because it failed verification or is damaged."""

_EPOCH = datetime.fromtimestamp(0, UTC)
_TYPES = {int: "an integer", float: "a decimal number", str: "text", bytes: "bytes", type(None): "missing"}


class Score(NamedTuple):
    """One score of a list.

    Attributes:
        id: Its number; numbers are not reused.
        initials: The initials of the player.
        score: Points.
        mode: The mode of the game, see `silverball.game.view.Mode`.
        table_name: The name of the table as chosen; for a random board the name of its recipe.
        table_digest: The digest of that table.
        seed: The seed of the world and, if the table is a recipe, of the board.
        when: The time at which the game ended, UTC.
        verified: The result of the last verification, see `verify_score`; None if there was none. It is only
            a note in the file, which other programs can change; only verifying again proves a score.
        why: The reason why it was not proven.
        has_replay: Whether the file holds its replay.
        damage: What is wrong with its record; empty if nothing is.
        player: Which player of a match has it, from 1.
        rank: The missions that were finished in the game; see `Store.rank`.
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
    damage: str = ""
    player: int = 1
    rank: int = 0

    @property
    def is_rejected(self) -> bool:
        """Whether it ranks below all others, because it failed verification or is damaged."""
        return self.verified is False

    @property
    def order(self) -> tuple[bool, int, int]:
        """Sort key: the best score has the smallest; of equal scores the earlier ranks higher."""
        return self.is_rejected, -self.score, self.id

    def played(self, form: str) -> str:
        """The time of the game as text, in local time if the calendar allows.

        Args:
            form: A format of `strftime`.
        """
        try:
            return f"{self.when.astimezone():{form}}"
        except (OverflowError, ValueError, OSError):
            return f"{self.when:{form}}"


class ScoreList(NamedTuple):
    """One list of scores.

    Attributes:
        mode: The mode of its games.
        table_name: The name of its table.
        table_digest: The digest of its table.
        length: How many scores it has.
        id: Its number in the file.
    """

    mode: str
    table_name: str
    table_digest: str
    length: int
    id: int


def score_of(row: tuple[Any, ...]) -> Score:
    """Make a score from a row of `COLUMNS`."""
    id, initials, score, mode, table_name, table_digest, seed, played, verified, why, has_replay, *more = row
    player, rank = more
    damage = [
        f"its {name} is {_TYPES[type(value)]}"
        for name, value, kind in (
            ("score", score, int),
            ("seed", seed, int),
            ("date", played, int),
            ("place in the match", player, int),
            ("rank", rank, int),
            ("player", initials, str),
            ("mode", mode, str),
            ("table's name", table_name, str),
            ("table's digest", table_digest, str),
        )
        if type(value) is not kind
    ]
    when = _EPOCH
    if type(played) is int:
        try:
            when = datetime.fromtimestamp(played, UTC)
        except (OverflowError, ValueError, OSError):
            damage.append("its date is beyond the calendar")
    was_proven = None if verified is None or verified not in (0, 1) else bool(verified)
    problem = f"its record is damaged: {', '.join(damage)}" if damage else ""
    return Score(
        id,
        text_of(initials),
        score if type(score) is int else 0,
        text_of(mode),
        text_of(table_name),
        text_of(table_digest),
        seed if type(seed) is int else 0,
        when,
        False if problem else was_proven,
        problem or text_of(why),
        bool(has_replay),
        problem,
        player if type(player) is int else 1,
        rank if type(rank) is int else 0,
    )


def text_of(value: Any) -> str:
    """A value that should be text, converted to text."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return "" if value is None else str(value)


def add(connection: sqlite3.Connection, one: NewScore) -> int:
    """Add a score; returns its number."""
    connection.execute(
        "INSERT INTO list (mode, table_digest, table_name, table_text) VALUES (?, ?, ?, ?)"
        " ON CONFLICT DO UPDATE SET table_name = excluded.table_name,"
        " table_text = iif(excluded.table_text = '', table_text, excluded.table_text)",
        (one.mode, one.table_digest, one.table_name, one.table_text),
    )
    cursor = connection.execute(
        "INSERT INTO score (list, initials, score, seed, played, replay, player, rank)"
        " SELECT id, ?, ?, ?, ?, ?, ?, ? FROM list WHERE mode = ? AND table_digest = ? LIMIT 1",
        (
            one.initials,
            one.score,
            one.seed,
            one.played,
            one.replay,
            one.player,
            one.rank,
            one.mode,
            one.table_digest,
        ),
    )
    return int(cursor.lastrowid or 0)


def import_pending(connection: sqlite3.Connection, pending: Pending) -> dict[str, int]:
    """Import pending data; of a score that was imported before, only the initials are updated.

    Returns:
        The ids of the scores by their tokens.
    """
    numbers = {}
    for one in pending.scores:
        rows = connection.execute("SELECT score FROM taken_in WHERE token = ?", (one.token,)).fetchall()
        if rows:
            ((number,),) = rows
            connection.execute("UPDATE score SET initials = ? WHERE id = ?", (one.initials, number))
        else:
            number = add(connection, one)
            connection.execute("INSERT INTO taken_in (token, score) VALUES (?, ?)", (one.token, number))
        numbers[one.token] = int(number)
    renamed = [(initials, id) for id, initials in pending.initials.items()]
    connection.executemany("UPDATE score SET initials = ? WHERE id = ?", renamed)
    if pending.last_game is not None:
        save_last_game(connection, pending.last_game)
    save_settings(connection, pending.settings)
    return numbers


def save_last_game(connection: sqlite3.Connection, replay_text: str) -> None:
    """Save the replay of the last game, in place of the one before."""
    connection.execute(
        "INSERT INTO last_game (id, replay) VALUES (1, ?)"
        " ON CONFLICT (id) DO UPDATE SET replay = excluded.replay",
        (replay_text,),
    )


def save_settings(connection: sqlite3.Connection, values: dict[str, Any]) -> None:
    """Save settings; others stay as they are."""
    connection.executemany(
        "INSERT INTO setting (name, value) VALUES (?, ?)"
        " ON CONFLICT (name) DO UPDATE SET value = excluded.value",
        [(name, json.dumps(value)) for name, value in values.items()],
    )
