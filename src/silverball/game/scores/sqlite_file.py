"""SQLite files of one schema: opening, checking and migrating them, and reading those that cannot be written.

This module knows nothing of scores; a `Schema` describes the records of a file.
"""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

INTEGER_LIMIT = 2**63  # the integers of SQLite are below it, and at least its negative
WAL_LIMIT = 1_000_000  # [bytes] the write-ahead log is cut to this size
RETRY_INTERVAL = 0.01  # [s] between two attempts to open a file that another program has locked

_REASONS = {
    sqlite3.SQLITE_FULL: "the disk is full",
    sqlite3.SQLITE_READONLY: "writing is not allowed",
    sqlite3.SQLITE_CANTOPEN: "it cannot be opened or created",
    sqlite3.SQLITE_PERM: "access is not allowed",
    sqlite3.SQLITE_IOERR: "reading or writing fails",
}
_LOCKED = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_PROTOCOL)
_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


class Schema(NamedTuple):
    """The records of a file.

    Attributes:
        application: The application ID that marks a file as ours, see https://sqlite.org/fileformat.html.
        migrations: For each version i, the statements that bring a file of version i to version i + 1. Only
            ever append.
        tables: The columns of every table of the present version, in order.
    """

    application: int
    migrations: tuple[tuple[str, ...], ...]
    tables: dict[str, tuple[str, ...]]

    @property
    def version(self) -> int:
        """The present version of the file."""
        return len(self.migrations)


class UnfitFile(Exception):
    """A file is damaged or belongs to another program; the message says which, as the end of a sentence."""


class NewerFile(Exception):
    """A file has a version that this program does not know."""


def open_file(path: Path, schema: Schema, timeout: float) -> sqlite3.Connection:
    """Open a file for writing, create it if there is none, and migrate it to the present version.

    Args:
        path: The file.
        schema: Its records.
        timeout: How long to wait for another program that has locked it, now and later [s].

    Raises:
        UnfitFile, NewerFile: It is damaged, belongs to another program, or is newer than this program.
        sqlite3.DatabaseError: It cannot be opened or written.
    """
    deadline = time.monotonic() + timeout
    while True:
        connection = sqlite3.connect(path, timeout=timeout, isolation_level=None)
        try:
            prepare(connection, schema)
            return connection
        except sqlite3.DatabaseError as error:
            connection.close()
            if is_damage(error):
                raise UnfitFile(f"is damaged ({error})") from None
            # SQLite itself does not wait for a lock when it creates the write-ahead log.
            if not is_lock(error) or time.monotonic() >= deadline:
                raise
            time.sleep(RETRY_INTERVAL)
        except BaseException:
            connection.close()
            raise


def prepare(connection: sqlite3.Connection, schema: Schema) -> None:
    """Check that a database is ours and undamaged, and migrate it to the present version.

    Raises:
        UnfitFile, NewerFile: It is not ours, is damaged, or is newer than this program.
        sqlite3.DatabaseError: It cannot be written.
    """
    connection.text_factory = _decoded
    connection.execute("PRAGMA synchronous = FULL")  # a commit survives a power failure
    connection.execute("PRAGMA fullfsync = ON")  # macOS: flush the cache of the disk too
    if not _is_empty(connection):
        _check_owner(connection, schema)
        ((found,),) = connection.execute("PRAGMA quick_check(1)").fetchall()
        if found != "ok":
            raise UnfitFile(f"is damaged ({' '.join(str(found).split())})")
    connection.execute("PRAGMA journal_mode = WAL").fetchall()
    connection.execute(f"PRAGMA journal_size_limit = {WAL_LIMIT}")
    with transaction(connection):
        if not _is_empty(connection):
            _check_owner(connection, schema)  # another program may have created it meanwhile
        version = _pragma(connection, "user_version")
        for statements in schema.migrations[version:]:
            for statement in statements:
                connection.execute(statement)
        for table, columns in schema.tables.items():
            try:
                connection.execute(f"SELECT {', '.join(columns)} FROM {table} LIMIT 0")
            except sqlite3.OperationalError as error:
                raise UnfitFile(f"is damaged ({error})") from None
        # Written even if unchanged: a file that cannot be written must show now, not after the game.
        connection.execute(f"PRAGMA application_id = {schema.application}")
        connection.execute(f"PRAGMA user_version = {schema.version}")


def open_read_only(path: Path, timeout: float = 0.0) -> sqlite3.Connection | None:
    """Open a file that cannot be written, for reading; None if it cannot be read either.

    As a last resort the locks of other programs are ignored.
    """
    for mode in ("mode=ro", "mode=ro&immutable=1"):
        connection = _connect_read_only(path, mode, timeout)
        if connection is not None:
            return connection
    return None


def open_locked(path: Path, schema: Schema) -> sqlite3.Connection | None:
    """Open a file for reading that another program has locked for writing.

    Returns:
        The connection; None if the file cannot be read or is not of the present version of the schema.
    """
    connection = _connect_read_only(path, "mode=ro", 0.0)
    if connection is not None:
        with suppress(sqlite3.DatabaseError):
            found = _pragma(connection, "application_id"), _pragma(connection, "user_version")
            if found == (schema.application, schema.version):
                return connection
        connection.close()
    return None


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """Run a transaction. It takes the lock at its beginning, so that no other program writes in between."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            with suppress(sqlite3.DatabaseError):
                connection.execute("ROLLBACK")
        raise


def is_damage(error: sqlite3.Error) -> bool:
    """Whether an error means that the file is damaged."""
    return _code(error) in _DAMAGED


def is_lock(error: sqlite3.Error) -> bool:
    """Whether an error means that another program has locked the file."""
    return _code(error) in _LOCKED


def reason_of(error: Exception) -> str:
    """An error as a phrase for the user."""
    if isinstance(error, sqlite3.Error):
        return _REASONS.get(_code(error), str(error))
    if isinstance(error, OSError):
        where = f" ({error.filename})" if error.filename else ""
        return f"{(error.strerror or str(error)).lower()}{where}"
    return f"it {error}"


def _connect_read_only(path: Path, mode: str, timeout: float) -> sqlite3.Connection | None:
    with suppress(sqlite3.DatabaseError):
        connection = sqlite3.connect(f"{path.absolute().as_uri()}?{mode}", timeout=timeout, uri=True)
        connection.text_factory = _decoded
        try:
            connection.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchall()
            return connection
        except sqlite3.DatabaseError:
            connection.close()
    return None


def _check_owner(connection: sqlite3.Connection, schema: Schema) -> None:
    if _pragma(connection, "application_id") != schema.application:
        raise UnfitFile("is a database of another program")
    version = _pragma(connection, "user_version")
    if version < 1:
        raise UnfitFile(f"is damaged (its version is {version})")
    if version > schema.version:
        raise NewerFile(
            f"it was written by a newer Silverball (version {version} of the file, "
            f"this one knows up to {schema.version})"
        )


def _is_empty(connection: sqlite3.Connection) -> bool:
    return not connection.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchall()


def _pragma(connection: sqlite3.Connection, name: str) -> int:
    return int(connection.execute(f"PRAGMA {name}").fetchone()[0])


def _decoded(text: bytes) -> str:
    return text.decode("utf-8", "replace")  # a damaged character must not hide the rest


def _code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF  # the low byte of an extended result code
