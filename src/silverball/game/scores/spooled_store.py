"""A store that spools writes and caches reads while another program holds its file."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self, TypeVar

from silverball.errors import SilverballError
from silverball.game.scores import database, score_records
from silverball.game.scores.database import Database, Locked
from silverball.game.scores.pending import NewScore, Pending, Spool
from silverball.game.scores.score_records import Score
from silverball.game.scores.sqlite_file import INTEGER_LIMIT, Schema
from silverball.game.user_folder import data_folder

FILE = "silverball.sqlite3"
CACHE_SIZE = 64  # query results that are reused while the file cannot be read
NEW_IN_SPOOL = "new scores and settings are saved to a temporary file meanwhile"
CLOSE_RETRY_INTERVAL = 0.05  # [s] between two attempts to write at the end
_PROBE = "SELECT 1 FROM setting LIMIT 1"  # fails if the file cannot be read
_Result = TypeVar("_Result")


class SpooledStore:
    """The file of a store, with a spool for the time during which another program holds it.

    Args:
        folder: The folder of the file; None: the data folder of the user.
        schema: The records of the file.
        nonblocking: Never wait for another program, for use in a window: reads then return the last
            result. Otherwise wait for it, and fail after a timeout.
    """

    def __init__(self, folder: Path | None, schema: Schema, *, nonblocking: bool) -> None:
        self._folder = folder or data_folder()
        self._nonblocking = nonblocking
        self._database = Database(self._folder / FILE, schema, nonblocking=nonblocking)
        self._spool = Spool(self._folder)
        self._has_imported = False  # the spools of other programs
        self._temporary_ids: dict[str, int] = {}  # ids given to pending scores, by token
        self._ids: dict[int, int] = {}  # maps temporary ids to ids in the file
        self._cache: dict[Any, list[tuple[Any, ...]]] = {}
        self._has_missed_read = False
        self._spool_warning = ""
        self._is_closed = False
        self.retry_pending()

    @property
    def path(self) -> Path:
        """The file."""
        return self._database.path

    @property
    def warning(self) -> str:
        """What the player should know, a line for each problem; empty if there is none."""
        locked = ""
        if not self._database.is_open:
            locked = f"{self.path}: another program holds it; {NEW_IN_SPOOL}"
        return "\n".join(filter(None, (self._database.warning, self._spool_warning, locked)))

    @property
    def is_persistent(self) -> bool:
        """Whether what is written now will be there after this run."""
        return self._database.is_persistent and self._spool.is_written

    @property
    def has_pending(self) -> bool:
        """Whether something waits for another program to release the file.

        While it does, call `retry_pending` from time to time.
        """
        return not self._has_imported or self._has_missed_read or not self._spool.pending.is_empty

    @property
    def is_unreadable(self) -> bool:
        """Whether another program has held the file since the beginning so that it cannot even be read."""
        if self._database.is_open:
            return False
        try:
            self._database.read(_PROBE)
        except Locked:
            return True
        return False

    @property
    def has_read(self) -> bool:
        """Whether the records of earlier runs could be read."""
        return self._database.has_read and not self.is_unreadable

    @property
    def is_spooled(self) -> bool:
        """Whether all pending data is on the disk, in the spool file."""
        return self._spool.is_written

    @property
    def exit_warning(self) -> str:
        """A warning about pending data for the end of the program; empty if there is none."""
        if self._spool.pending.is_empty:
            return ""
        held = f"{self.path}: another program holds it"
        if self._spool.is_written:
            return (
                f"{held}; your latest scores are saved in {self._spool.path.name} "
                "and will be imported at the next start"
            )
        return f"{held}, and no other file can be written: what was played last is lost"

    def retry_pending(self) -> bool:
        """Write pending data into the file, if no other program holds it any more.

        Returns:
            Whether nothing is pending now.
        """
        if not self.has_pending:
            return True
        try:
            if not self._has_imported:
                self._import_other_spools()
            if not self._spool.pending.is_empty:
                file_ids = self._import(self._spool.pending)
                self._ids |= {self._temporary_ids[token]: id for token, id in file_ids.items()}
                self._spool.clear(keep_file=not self._database.is_persistent)
            self._database.read(_PROBE)
        except Locked:
            if not self._spool.is_written:
                self._spool.write()
            return False
        self._has_missed_read = False
        return True

    def __enter__(self) -> Self:
        """The store itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """Close the file.

        Pending data stays in the spool file for the next start. If even that file could not be written, the
        store retries for some seconds.
        """
        if self._is_closed:
            return
        self._is_closed = True
        deadline = time.monotonic() + database.BUSY_SECONDS
        while not self.retry_pending():
            if self._spool.is_written or time.monotonic() > deadline:
                break
            time.sleep(CLOSE_RETRY_INTERVAL)
        self._database.close()

    def _write(
        self,
        work: Callable[[sqlite3.Connection], _Result],
        spool: Callable[[], _Result] | None = None,
    ) -> _Result:
        """Run something in a transaction of the file.

        Args:
            work: What to run.
            spool: What to do while another program holds the file; without it, that is an error.
        """
        try:
            if not self.retry_pending():  # keeps the order of writes
                raise Locked(self.path)
            return self._database.write(work)
        except Locked as locked:
            if spool is None:
                raise _locked_error(locked) from None
            return spool()

    def _read(
        self, query: str, values: tuple[Any, ...] = (), *, is_required: bool = False
    ) -> list[tuple[Any, ...]]:
        """All rows of a query; while the file cannot be read, those of the last time.

        Args:
            query: SQL.
            values: The values of its placeholders.
            is_required: Whether a query that was never answered is an error; otherwise the result is empty.
        """
        key = (query, values)
        try:
            rows = self._database.read(query, values)
        except Locked as locked:
            self._has_missed_read = True
            if not self._nonblocking or (is_required and key not in self._cache):
                raise _locked_error(locked) from None
            return self._cache.get(key, [])
        if self._nonblocking:
            self._cache.pop(key, None)
            self._cache[key] = rows
            if len(self._cache) > CACHE_SIZE:
                del self._cache[next(iter(self._cache))]
        return rows

    def _add_pending(self, new: NewScore) -> int:
        """Spool a score; returns its temporary id, which is beyond those of the file."""
        id = INTEGER_LIMIT + len(self._temporary_ids)
        self._temporary_ids[new.token] = id
        self._spool.pending.scores.append(new)
        self._spool.write()
        return id

    def _rename_pending(self, id: int, initials: str) -> int:
        """Spool the initials of a score in the file; returns how many scores that changes."""
        self._spool.pending.initials[self._file_id(id)] = initials
        self._spool.write()
        return 1

    def _pending_score(self, id: int) -> NewScore | None:
        scores = self._spool.pending.scores
        return next((new for new in scores if self._temporary_ids[new.token] == id), None)

    def _pending_scores(self) -> list[Score]:
        return [
            Score(
                self._temporary_ids[new.token], new.initials, new.score, new.mode, new.table_name,
                new.table_digest, new.seed, datetime.fromtimestamp(new.played, UTC), None, "", True, "",
                new.player, new.rank,
            )
            for new in self._spool.pending.scores
        ]  # fmt: skip

    def _with_pending_initials(self, score: Score) -> Score:
        initials = self._spool.pending.initials.get(score.id)
        return score if initials is None else score._replace(initials=initials)

    def _import_other_spools(self) -> None:
        """Import the spools of other programs.

        Raises:
            Locked: Another program holds the file.
        """
        if not self._database.is_open:
            self._database.write(lambda connection: None)
        for path, pending in self._spool.claim_others() if self._database.is_persistent else ():
            if pending is None:
                quarantined = path.with_name(path.name.replace("waiting", "set-aside"))
                path.rename(quarantined)
                self._spool_warning = f"{quarantined}: this cannot be read, so its scores are not shown"
                continue
            self._import(pending)
            if self._database.is_persistent:
                with suppress(OSError):
                    path.unlink()
        self._has_imported = True

    def _import(self, pending: Pending) -> dict[str, int]:
        return self._database.write(lambda connection: score_records.import_pending(connection, pending))

    def _file_id(self, id: int) -> int:
        """The id of a score in the file.

        Raises:
            SilverballError: No score can have this id.
        """
        id = self._ids.get(id, id)
        if not -INTEGER_LIMIT <= id < INTEGER_LIMIT:
            raise no_such_score(id)
        return id


def no_such_score(id: int) -> SilverballError:
    """The error for an id that no score has."""
    return SilverballError(f"there is no score {id}; `silverball scores` lists them with their numbers")


def _locked_error(locked: Locked) -> SilverballError:
    return SilverballError(f"{locked}; try again when it has ended")
