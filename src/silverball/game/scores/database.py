"""A database that never stops a game: one SQLite file, or memory where the file fails.

A write that has returned survives a killed program and a power failure; several programs may use the file at
once. The program continues whatever is wrong with the file:

* A damaged file, or one of another program, is quarantined under another name, and a new one is created.
* If the file cannot be written, or is newer than the program, a database in memory takes its place, with a
  copy of what can be read.
* While another program has locked the file, `Locked` is raised after a timeout, and nothing is changed.

`warning` says what happened, `is_persistent` whether data outlives this run.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeVar

from silverball.game.scores.sqlite_file import (
    NewerFile,
    Schema,
    UnfitFile,
    is_damage,
    is_lock,
    open_file,
    open_locked,
    open_read_only,
    prepare,
    reason_of,
    transaction,
)

BUSY_SECONDS = 5.0  # how long to wait for a lock; a write takes some milliseconds
BEGIN_SECONDS = 1.0  # how long a nonblocking database waits when it opens the file for the first time

_CALLER_ERRORS = (
    sqlite3.IntegrityError,
    sqlite3.ProgrammingError,
    sqlite3.DataError,
    sqlite3.NotSupportedError,
)
_Result = TypeVar("_Result")


class Locked(Exception):
    """Another program has locked the file; nothing was done.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(f"{path}: another program holds it")


class Database:
    """One file of records, or memory in its place. It belongs to the thread that made it.

    Args:
        path: The file. It is created if there is none, with its folder.
        schema: The records of the file.
        nonblocking: Never wait for a lock, except for `BEGIN_SECONDS` at the beginning.

    Attributes:
        path: The file.
        warning: What the user should know, a line for each problem; empty if there was none.
        is_persistent: Whether what is written now will be there after this run.
        has_read: Whether the records of earlier runs could be read.
    """

    def __init__(self, path: Path, schema: Schema, *, nonblocking: bool = False) -> None:
        self.path = path
        self.warning = ""
        self.is_persistent = self.has_read = True
        self._schema = schema
        self._timeout = BEGIN_SECONDS if nonblocking else BUSY_SECONDS
        self._connection: sqlite3.Connection | None = None  # None: the file has been locked so far
        self._open()
        if nonblocking or self._connection is None:
            self._stop_waiting()

    @property
    def is_open(self) -> bool:
        """Whether the file could be opened; if not, another program has locked it since the beginning."""
        return self._connection is not None

    def close(self) -> None:
        """Close the file. All writes are on the disk before."""
        if self._connection is not None:
            self._connection.close()

    def read(self, query: str, values: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
        """All rows of a query.

        Raises:
            Locked: Another program has locked the file so that it cannot even be read.
        """
        try:
            return self._run(lambda connection: connection.execute(query, values).fetchall())
        except Locked:
            if self._connection is not None:
                raise
            return self._read_locked(query, values)

    def write(self, work: Callable[[sqlite3.Connection], _Result]) -> _Result:
        """Run something in a transaction; when this returns, it is on the disk.

        Raises:
            Locked: Another program has locked the file; nothing was done.
        """

        def in_transaction(connection: sqlite3.Connection) -> _Result:
            with transaction(connection):
                return work(connection)

        return self._run(in_transaction)

    def _run(self, work: Callable[[sqlite3.Connection], _Result]) -> _Result:
        """Run something in the file; if that fails, in a new file; if that fails too, in memory."""
        self._check_file()
        was_reopened = False
        while True:
            if self._connection is None:
                raise Locked(self.path)
            try:
                return work(self._connection)
            except sqlite3.DatabaseError as error:
                if not self.is_persistent or isinstance(error, _CALLER_ERRORS):
                    raise
                if is_lock(error):
                    self._stop_waiting()
                    raise Locked(self.path) from None
                if is_damage(error) and not was_reopened:
                    was_reopened = True
                    self._open()
                else:
                    broken = self._connection
                    self._connection = self._in_memory(reason_of(error), broken)
                    broken.close()

    def _read_locked(self, query: str, values: tuple[Any, ...]) -> list[tuple[Any, ...]]:
        """All rows of a query in a file that cannot be opened for writing because it is locked."""
        reader = open_locked(self.path, self._schema)
        if reader is None:
            raise Locked(self.path)
        with closing(reader):
            try:
                return reader.execute(query, values).fetchall()
            except sqlite3.DatabaseError:
                raise Locked(self.path) from None

    def _stop_waiting(self) -> None:
        """Do not wait for locks any more: after one timeout the caller retries later."""
        if self._timeout:
            self._timeout = 0.0
            if self._connection is not None:
                self._connection.execute("PRAGMA busy_timeout = 0").fetchall()

    def _check_file(self) -> None:
        """Open the file again if it was removed or replaced: writes to the old one would be lost silently."""
        if self._connection is None:
            self._open()
        elif self.is_persistent and self._file_identity() != self._identity:
            self._warn(f"{self.path} was removed or replaced while the program ran; the new one is used now")
            self._open()

    def _file_identity(self) -> tuple[int, int] | None:
        try:
            status = self.path.stat()
        except OSError:
            return None
        return status.st_dev, status.st_ino

    def _open(self) -> None:
        """Open the file; without a connection afterwards if it is locked."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None
        with suppress(Locked):
            self._connection = self._connect()
        self._identity = self._file_identity()

    def _connect(self) -> sqlite3.Connection:
        """A connection to the file, to a new one if it is unfit, or else to memory."""
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            try:
                return open_file(self.path, self._schema, self._timeout)
            except UnfitFile as unfit:
                return self._quarantine(str(unfit))
        except NewerFile as newer:
            return self._in_memory(str(newer), None)
        except (sqlite3.DatabaseError, OSError, UnfitFile) as error:
            if isinstance(error, sqlite3.DatabaseError) and is_lock(error):
                raise Locked(self.path) from None
            reason = reason_of(error)
        readable = open_read_only(self.path, BEGIN_SECONDS)
        try:
            return self._in_memory(reason, readable)
        finally:
            if readable is not None:
                readable.close()

    def _quarantine(self, problem: str) -> sqlite3.Connection:
        """Rename an unfit file and begin a new one."""
        lock_path = self.path.with_suffix(".mending")
        with closing(sqlite3.connect(lock_path, timeout=self._timeout)) as lock:
            lock.execute("BEGIN EXCLUSIVE")  # two programs may find the damage at the same time
            with suppress(UnfitFile):
                return open_file(self.path, self._schema, self._timeout)
            stem = f"{self.path.stem}-set-aside-{datetime.now(UTC):%Y-%m-%d-%H%M%S-%f}"
            for ending in ("-wal", "-shm", ""):  # the file itself last: an interruption only repeats this
                with suppress(FileNotFoundError):
                    old = self.path.with_name(self.path.name + ending)
                    old.rename(self.path.with_name(stem + self.path.suffix + ending))
            self._warn(
                f"{self.path} {problem}; it is now called {stem}{self.path.suffix}, and a new one begins"
            )
            return open_file(self.path, self._schema, self._timeout)

    def _in_memory(self, reason: str, readable: sqlite3.Connection | None) -> sqlite3.Connection:
        """A database in memory for this run, with a copy of what can be read."""
        self.is_persistent, self.has_read = False, readable is not None
        self._warn(
            f"{self.path}: {reason}, so nothing of this run is kept; "
            "fix that, or set SILVERBALL_DATA to another folder"
        )
        memory = sqlite3.connect(":memory:", isolation_level=None)
        prepare(memory, self._schema)
        if readable is not None:
            for table, columns in self._schema.tables.items():
                with suppress(sqlite3.DatabaseError):
                    existing = {row[1] for row in readable.execute(f"PRAGMA table_info({table})")}
                    known = [column for column in columns if column in existing]  # an older file has fewer
                    rows = readable.execute(f"SELECT {', '.join(known)} FROM {table}")
                    names, placeholders = ", ".join(known), ", ".join("?" * len(known))
                    memory.executemany(
                        f"INSERT OR IGNORE INTO {table} ({names}) VALUES ({placeholders})", rows
                    )
        return memory

    def _warn(self, sentence: str) -> None:
        self.warning = f"{self.warning}\n{sentence}".strip()
