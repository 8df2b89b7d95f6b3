"""How is a file of records opened and written, and what happens where that fails?

`Database` holds one SQLite file. What `write` has done when it returns survives a killed program and a power
failure; several programs may use the file at once. Whatever is wrong with it, the program goes on:

* a damaged file, or one of another program, is set aside under another name and a new one begun;
* where the file cannot be written, or is newer than the program, a database in memory stands in for it, with
  a copy of what can be read;
* while another program holds it, `Held` is raised after some patience, and nothing was done: ask again later.

`trouble` says what happened, `keeps` whether anything will last. Which records there are is said by a
`Schema`; there is nothing here about scores or settings.
"""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

BUSY_SECONDS = 5.0  # how long another program may hold the file; a write takes some milliseconds
BEGIN_SECONDS = 1.0  # the same where nobody is to wait, while the file is opened for the first time
LOG_LIMIT = 1_000_000  # [bytes] of the log beside the file, once it was longer

_REASONS = {
    sqlite3.SQLITE_FULL: "the disk is full",
    sqlite3.SQLITE_READONLY: "writing is not allowed",
    sqlite3.SQLITE_CANTOPEN: "it cannot be opened or made",
    sqlite3.SQLITE_PERM: "access is not allowed",
    sqlite3.SQLITE_IOERR: "reading or writing fails",
}
_HELD = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_PROTOCOL)
_DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_OURS = (sqlite3.IntegrityError, sqlite3.ProgrammingError, sqlite3.DataError, sqlite3.NotSupportedError)
_Result = TypeVar("_Result")


class Schema(NamedTuple):
    """Which records a file holds.

    Attributes:
        application: Marks a file as ours (see "application ID" on https://sqlite.org/fileformat.html).
        migrations: The statements that make a file of version i + 1 of one of version i. Only ever add some.
        tables: The columns of every table of the present version, in order.
    """

    application: int
    migrations: tuple[tuple[str, ...], ...]
    tables: dict[str, tuple[str, ...]]

    @property
    def version(self) -> int:
        """The present version of the file."""
        return len(self.migrations)


class Database:
    """One file of records, or the memory in its place.

    It belongs to the thread that made it.

    Args:
        path: The file; it is made if there is none, with its folder.
        schema: What is in it.
        at_once: Never wait for another program that holds the file, but for `BEGIN_SECONDS` at the beginning.

    Attributes:
        trouble: What the user should know, one line for each thing that went wrong; empty if nothing did.
        keeps: Whether what is written now will be there after this run.
        has_read: Whether what was kept before could be read.
    """

    def __init__(self, path: Path, schema: Schema, *, at_once: bool = False) -> None:
        self.path = path
        self.trouble = ""
        self.keeps = self.has_read = True
        self._schema = schema
        self._patience = BEGIN_SECONDS if at_once else BUSY_SECONDS
        self._connection: sqlite3.Connection | None = None  # None: another program has held it so far
        self._begin_again()
        self._lose_patience(at_once or self._connection is None)

    @property
    def is_open(self) -> bool:
        """Whether the file could be opened; if not, another program has held it since the beginning."""
        return self._connection is not None

    def close(self) -> None:
        """Close the file; nothing is written by this that was not safe before."""
        if self._connection is not None:
            self._connection.close()

    def read(self, query: str, values: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
        """All rows that a query gives.

        Raises:
            Held: Another program holds the file so that it cannot even be read.
        """
        try:
            return self._do(lambda connection: connection.execute(query, values).fetchall())
        except Held:
            if self._connection is not None:
                raise
            return self._look(query, values)

    def write(self, work: Callable[[sqlite3.Connection], _Result]) -> _Result:
        """Do something all or not at all; when this returns it is safe on the disk.

        Raises:
            Held: Another program holds the file; nothing was done.
        """

        def whole(connection: sqlite3.Connection) -> _Result:
            with _transaction(connection):
                return work(connection)

        return self._do(whole)

    # ── what if it fails ────────────────────────────────────────────────────────────────────────────────

    def _do(self, work: Callable[[sqlite3.Connection], _Result]) -> _Result:
        """Do it in the file; if that fails in a new file; and if that fails too in memory."""
        self._see_that_the_file_is_there()
        begun_anew = False
        while True:
            if self._connection is None:
                raise Held(self.path)
            try:
                return work(self._connection)
            except sqlite3.DatabaseError as error:
                if not self.keeps or isinstance(error, _OURS):
                    raise
                if _is_held(error):
                    self._lose_patience(True)
                    raise Held(self.path) from None
                if _is_damage(error) and not begun_anew:
                    begun_anew = True
                    self._begin_again()
                else:
                    broken = self._connection
                    self._connection = self._in_memory(_reason(error), broken)
                    broken.close()

    def _begin_again(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None
        with suppress(Held):
            self._connection = self._begin()
        self._file = self._which_file()

    def _lose_patience(self, has_lost_it: bool) -> None:
        """Whoever has waited once for another program does not wait again, but asks."""
        if has_lost_it and self._patience:
            self._patience = 0.0
            if self._connection is not None:
                self._connection.execute("PRAGMA busy_timeout = 0").fetchall()

    def _look(self, query: str, values: tuple[Any, ...]) -> list[tuple[Any, ...]]:
        """All rows that a query gives in a file that another program does not let us write."""
        reader = _open_to_read(self.path, self._schema)
        if reader is None:
            raise Held(self.path)
        with closing(reader):
            try:
                return reader.execute(query, values).fetchall()
            except sqlite3.DatabaseError:
                raise Held(self.path) from None

    def _see_that_the_file_is_there(self) -> None:
        """What is written into a file that somebody removed or replaced would be lost without a word."""
        if self._connection is None:
            self._begin_again()
        elif self.keeps and self._which_file() != self._file:
            self._tell(f"{self.path} was removed or replaced while the program ran; the new one is used now")
            self._begin_again()

    def _which_file(self) -> tuple[int, int] | None:
        try:
            status = self.path.stat()
        except OSError:
            return None
        return status.st_dev, status.st_ino

    # ── beginning ───────────────────────────────────────────────────────────────────────────────────────

    def _begin(self) -> sqlite3.Connection:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            try:
                return _open(self.path, self._schema, self._patience)
            except _Unfit as unfit:
                return self._begin_new(str(unfit))
        except _Newer as newer:
            return self._in_memory(str(newer), None)
        except (sqlite3.DatabaseError, OSError, _Unfit) as error:
            if isinstance(error, sqlite3.DatabaseError) and _is_held(error):
                raise Held(self.path) from None
            reason = _reason(error)
        readable = _open_to_read(self.path)
        try:
            return self._in_memory(reason, readable)
        finally:
            if readable is not None:
                readable.close()

    def _begin_new(self, what: str) -> sqlite3.Connection:
        """Set a file aside that cannot be used, under another name, and begin a new one."""
        with closing(sqlite3.connect(self.path.with_suffix(".mending"), self._patience)) as lock:
            lock.execute("BEGIN EXCLUSIVE")  # two programs may find the damage at the same time
            with suppress(_Unfit):
                return _open(self.path, self._schema, self._patience)
            stem = f"{self.path.stem}-set-aside-{datetime.now(UTC):%Y-%m-%d-%H%M%S-%f}"
            for ending in ("-wal", "-shm", ""):  # the file last: if this is cut short it begins anew
                with suppress(FileNotFoundError):
                    old = self.path.with_name(self.path.name + ending)
                    old.rename(self.path.with_name(stem + self.path.suffix + ending))
            self._tell(f"{self.path} {what}; it is now called {stem}{self.path.suffix}, and a new one begins")
            return _open(self.path, self._schema, self._patience)

    def _in_memory(self, reason: str, readable: sqlite3.Connection | None) -> sqlite3.Connection:
        """A stand-in for this run, with what can be read."""
        self.keeps, self.has_read = False, readable is not None
        self._tell(
            f"{self.path}: {reason}, so nothing of this run is kept; "
            "see to that, or name another folder in SILVERBALL_DATA"
        )
        memory = sqlite3.connect(":memory:", isolation_level=None)
        _prepare(memory, self._schema)
        if readable is not None:
            for table, columns in self._schema.tables.items():
                with suppress(sqlite3.DatabaseError):
                    there = {row[1] for row in readable.execute(f"PRAGMA table_info({table})")}
                    known = [column for column in columns if column in there]  # an older file has fewer
                    rows = readable.execute(f"SELECT {', '.join(known)} FROM {table}")
                    names, marks = ", ".join(known), ", ".join("?" * len(known))
                    memory.executemany(f"INSERT OR IGNORE INTO {table} ({names}) VALUES ({marks})", rows)
        return memory

    def _tell(self, sentence: str) -> None:
        self.trouble = f"{self.trouble}\n{sentence}".strip()


class Held(Exception):
    """Another program holds the file; nothing was done.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(f"{path}: another program holds it")


class _Unfit(Exception):
    """A file is not, or not any more, a database of ours; the message says what it is."""


class _Newer(Exception):
    """A file is of a version that this program does not know."""


def _open(path: Path, schema: Schema, patience: float) -> sqlite3.Connection:
    """A connection to a file that is sound and ours, made if there is none.

    Args:
        path: The file.
        schema: What is in it.
        patience: How long another program may hold it, then and later [s].

    Raises:
        _Unfit, _Newer: It is not.
        sqlite3.DatabaseError: It cannot be opened or written.
    """
    deadline = time.monotonic() + patience
    while True:
        connection = sqlite3.connect(path, patience, isolation_level=None)
        try:
            _prepare(connection, schema)
            return connection
        except sqlite3.DatabaseError as error:
            connection.close()
            if _is_damage(error):
                raise _Unfit(f"is damaged ({error})") from None
            # To begin a log does not wait for other programs by itself.
            if not _is_held(error) or time.monotonic() >= deadline:
                raise
            time.sleep(0.01)
        except BaseException:
            connection.close()
            raise


def _prepare(connection: sqlite3.Connection, schema: Schema) -> None:
    """See that a database is sound and ours, and bring it to the present version."""
    connection.text_factory = _text
    connection.execute("PRAGMA synchronous = FULL")  # what was shown survives a power failure
    connection.execute("PRAGMA fullfsync = ON")  # macOS: also out of the cache of the disk
    if not _is_empty(connection):
        _see_whose_it_is(connection, schema)
        ((found,),) = connection.execute("PRAGMA quick_check(1)").fetchall()
        if found != "ok":
            raise _Unfit(f"is damaged ({' '.join(str(found).split())})")
    connection.execute("PRAGMA journal_mode = WAL").fetchall()
    connection.execute(f"PRAGMA journal_size_limit = {LOG_LIMIT}")
    with _transaction(connection):
        if not _is_empty(connection):
            _see_whose_it_is(connection, schema)  # another program may have been quicker
        version = _number(connection, "user_version")
        for statements in schema.migrations[version:]:
            for statement in statements:
                connection.execute(statement)
        for table, columns in schema.tables.items():
            try:
                connection.execute(f"SELECT {', '.join(columns)} FROM {table} LIMIT 0")
            except sqlite3.OperationalError as error:
                raise _Unfit(f"is damaged ({error})") from None
        # Written even if it is so already: better to hear now that nothing can be kept than after the game.
        connection.execute(f"PRAGMA application_id = {schema.application}")
        connection.execute(f"PRAGMA user_version = {schema.version}")


def _see_whose_it_is(connection: sqlite3.Connection, schema: Schema) -> None:
    if _number(connection, "application_id") != schema.application:
        raise _Unfit("is a database of another program")
    version = _number(connection, "user_version")
    if version < 1:
        raise _Unfit(f"is damaged (it says that it is of version {version})")
    if version > schema.version:
        raise _Newer(
            f"it was written by a newer Silverball (version {version} of the file, "
            f"this one knows up to {schema.version})"
        )


def _is_empty(connection: sqlite3.Connection) -> bool:
    return not connection.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchall()


def _number(connection: sqlite3.Connection, pragma: str) -> int:
    return int(connection.execute(f"PRAGMA {pragma}").fetchone()[0])


def _text(text: bytes) -> str:
    return text.decode("utf-8", "replace")  # a damaged letter must not hide the rest


def _open_to_read(path: Path, held: Schema | None = None) -> sqlite3.Connection | None:
    """A connection to a file that can be read, if it can; not even the files beside it need be writable.

    Args:
        path: The file.
        held: What it must hold if another program writes to it; its locks are heeded then.
    """
    for how in ("mode=ro",) if held else ("mode=ro", "mode=ro&immutable=1"):
        with suppress(sqlite3.DatabaseError):
            connection = sqlite3.connect(
                f"{path.absolute().as_uri()}?{how}", 0.0 if held else BEGIN_SECONDS, uri=True
            )
            connection.text_factory = _text
            try:
                connection.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchall()
                if held is None or _marks(connection) == (held.application, held.version):
                    return connection
            except sqlite3.DatabaseError:
                connection.close()
                continue
            connection.close()
    return None


def _marks(connection: sqlite3.Connection) -> tuple[int, int]:
    return _number(connection, "application_id"), _number(connection, "user_version")


@contextmanager
def _transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """All or nothing; others wait from the beginning, so that nobody finds the file changed in the middle."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            with suppress(sqlite3.DatabaseError):
                connection.execute("ROLLBACK")
        raise


def _code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF  # the rest only says more exactly what


def _is_damage(error: sqlite3.Error) -> bool:
    return _code(error) in _DAMAGE


def _is_held(error: sqlite3.Error) -> bool:
    return _code(error) in _HELD


def _reason(error: Exception) -> str:
    """What to tell a user of an error."""
    if isinstance(error, sqlite3.Error):
        return _REASONS.get(_code(error), str(error))
    if isinstance(error, OSError):
        where = f" ({error.filename})" if error.filename else ""
        return f"{(error.strerror or str(error)).lower()}{where}"
    return f"it {error}"
