"""What stands in the file of the scores, and how is it written there?"""

from __future__ import annotations

import json
import sqlite3
from typing import Any

from silverball.game.scores.database import Schema
from silverball.game.scores.pending import NewScore, Waiting

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
    (
        "ALTER TABLE list ADD COLUMN table_text TEXT NOT NULL DEFAULT ''",  # '': not at hand
        "CREATE TABLE taken_in (token TEXT PRIMARY KEY, score INTEGER NOT NULL)",  # see `waiting`
        "DROP INDEX IF EXISTS replays",  # there is one for every score now
    ),
)
SCHEMA = Schema(
    application=int.from_bytes(b"Silv", "big"),
    migrations=_MIGRATIONS,
    tables={
        "list": ("id", "mode", "table_digest", "table_name", "table_text"),
        "score": ("id", "list", "initials", "score", "seed", "played", "verified", "why", "replay"),
        "setting": ("name", "value"),
        "last_game": ("id", "replay"),
        "taken_in": ("token", "score"),
    },
)


def add(connection: sqlite3.Connection, one: NewScore) -> int:
    """Add a score; its number."""
    connection.execute(
        "INSERT INTO list (mode, table_digest, table_name, table_text) VALUES (?, ?, ?, ?)"
        " ON CONFLICT DO UPDATE SET table_name = excluded.table_name,"
        " table_text = iif(excluded.table_text = '', table_text, excluded.table_text)",
        (one.mode, one.table_digest, one.table_name, one.table_text),
    )
    cursor = connection.execute(
        "INSERT INTO score (list, initials, score, seed, played, replay)"
        " SELECT id, ?, ?, ?, ?, ? FROM list WHERE mode = ? AND table_digest = ? LIMIT 1",
        (one.initials, one.score, one.seed, one.played, one.replay, one.mode, one.table_digest),
    )
    return int(cursor.lastrowid or 0)


def take_in(connection: sqlite3.Connection, waiting: Waiting) -> dict[str, int]:
    """Keep what has waited; a score that was taken in before only gets its initials.

    Returns:
        The numbers of the scores by their tokens.
    """
    numbers = {}
    for one in waiting.scores:
        rows = connection.execute("SELECT score FROM taken_in WHERE token = ?", (one.token,)).fetchall()
        if rows:
            ((number,),) = rows
            connection.execute("UPDATE score SET initials = ? WHERE id = ?", (one.initials, number))
        else:
            number = add(connection, one)
            connection.execute("INSERT INTO taken_in (token, score) VALUES (?, ?)", (one.token, number))
        numbers[one.token] = int(number)
    renamed = [(initials, id) for id, initials in waiting.initials.items()]
    connection.executemany("UPDATE score SET initials = ? WHERE id = ?", renamed)
    if waiting.last_game is not None:
        keep_last_game(connection, waiting.last_game)
    keep_settings(connection, waiting.settings)
    return numbers


def keep_last_game(connection: sqlite3.Connection, replay_text: str) -> None:
    """Keep the replay of the game that was played last, in place of the one before."""
    connection.execute(
        "INSERT INTO last_game (id, replay) VALUES (1, ?)"
        " ON CONFLICT (id) DO UPDATE SET replay = excluded.replay",
        (replay_text,),
    )


def keep_settings(connection: sqlite3.Connection, values: dict[str, Any]) -> None:
    """Keep settings; those that are not named stay as they are."""
    connection.executemany(
        "INSERT INTO setting (name, value) VALUES (?, ?)"
        " ON CONFLICT (name) DO UPDATE SET value = excluded.value",
        [(name, json.dumps(value)) for name, value in values.items()],
    )
