"""The table files of a folder, read again in a thread when they have changed, so that no frame waits.

Changes are detected by file attributes (time, size, inode), also of the meshes that a file names. Files that
cannot be used are listed too, with their first problem.
"""

from __future__ import annotations

import itertools
import os
import stat
import threading
import time
import tomllib
from collections import deque
from pathlib import Path
from typing import NamedTuple, TypeAlias

from silverball.background_thread import BackgroundThread
from silverball.errors import Problem, SilverballError, TableError
from silverball.table import Table, load_table, table_digest
from silverball.table.file import SIZE_LIMIT

ENDING = ".toml"
REFRESH_WAIT = 0.01  # [s] a check waits for the reading thread: enough for a table of a hundred parts
READ_PAUSE = 0.02  # [s] between two of many files, in which the game gets Python's lock
FIRST_REFRESH_WAIT = 0.5  # [s] the same before the first frame: enough for about fifty tables

Fingerprint: TypeAlias = tuple[str, int, int, int, int, int]
Fingerprints: TypeAlias = tuple[Fingerprint, ...]


class LoadedFile(NamedTuple):
    """A table file as last read.

    Attributes:
        fingerprints: Fingerprints of the file and of its meshes, taken just before.
        table: The table; None if it cannot be used.
        digest: Digest of the table; empty without a table.
        problem: The first problem with its place; empty if the table can be used.
    """

    fingerprints: Fingerprints
    table: Table | None = None
    digest: str = ""
    problem: str = ""


class TableFiles:
    """The table files of a folder, and the chosen file, which may be in another folder.

    Args:
        folder: The folder; it may not exist.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._chosen = ""
        self._names: tuple[str, ...] = ()
        self._loaded: dict[str, LoadedFile] = {}
        self._thread = threading.Thread()
        self._stale: deque[str] = deque()  # files to read; the thread takes them from the left
        self._versions = itertools.count(1)  # shared by two threads, each number is unique
        self.version = 0
        """Changes whenever any file has changed."""

    @property
    def names(self) -> tuple[str, ...]:
        """The paths of all files, the chosen one first if it is in another folder."""
        return self._names

    def loaded(self, name: str) -> LoadedFile | None:
        """Return a file as last read; None if it has not been read yet."""
        return self._loaded.get(name)

    def watch(self, name: str) -> None:
        """Watch this file too, if the name is a path."""
        self._chosen = name if is_path(name) else ""

    def refresh(self, wait: float = REFRESH_WAIT, *, whole: bool = True) -> None:
        """Find new and changed files, and read them in the thread.

        Args:
            wait: Longest wait for the thread [s]; the next calls report what takes longer.
            whole: Whether to check the whole folder, or only the chosen file.
        """
        if self._chosen and self._differs(self._chosen) and [self._chosen] != list(self._stale)[:1]:
            self._stale.appendleft(self._chosen)  # the player is waiting for it
        if not self._thread.is_alive():
            if whole:
                self._list()
                self._stale.extend(
                    name for name in self._names if name != self._chosen and self._differs(name)
                )
            if not self._stale:
                return
            self._thread = BackgroundThread(self._read_all, "table files")
            self._thread.start()
        self._thread.join(wait)

    def read(self, name: str) -> Table:
        """Read the table in a file now.

        Raises:
            SilverballError: It cannot be used.
        """
        loaded, error = _read(name)
        self._set(name, loaded)
        if error is not None:
            raise error
        assert loaded.table is not None
        return loaded.table

    def _list(self) -> None:
        """List the files, except hidden ones, which editors write temporarily."""
        try:
            found = sorted(
                entry.name
                for entry in os.scandir(self._folder)
                if entry.name.lower().endswith(ENDING) and not entry.name.startswith(".")
            )
        except OSError:
            found = []
        names = [str(self._folder / name) for name in found]
        if self._chosen:
            folder, file = os.path.split(self._chosen)
            if file in found and os.path.realpath(folder) == os.path.realpath(self._folder):
                names[found.index(file)] = self._chosen
            else:
                names.insert(0, self._chosen)
        if tuple(names) != self._names:
            self._names = tuple(names)
            self._loaded = {name: loaded for name, loaded in self._loaded.items() if name in names}
            self.version = next(self._versions)

    def _differs(self, name: str) -> bool:
        """Return whether a file has not been read yet, or has changed since."""
        before = self._loaded.get(name)
        return before is None or _fingerprints(name, before.fingerprints) != before.fingerprints

    def _read_all(self) -> None:
        start = time.monotonic()
        while self._stale:
            name = self._stale.popleft()
            self._set(name, _read(name)[0])
            if time.monotonic() - start > FIRST_REFRESH_WAIT:
                time.sleep(READ_PAUSE)

    def _set(self, name: str, loaded: LoadedFile) -> None:
        self._loaded[name] = loaded
        self.version = next(self._versions)


def is_path(name: str) -> bool:
    """Return whether a table name is a path."""
    return name.endswith(ENDING) or os.sep in name or (os.altsep is not None and os.altsep in name)


def first_problem(error: SilverballError) -> str:
    """Return the first problem, with its place, as one line."""
    if isinstance(error, TableError) and error.problems:
        return " ".join(str(error.problems[0]).split())
    return " ".join(str(error).split())


def _read(name: str) -> tuple[LoadedFile, SilverballError | None]:
    """Read a file; fingerprints are taken first, so that a change meanwhile is found by the next check."""
    fingerprint = _fingerprint(name)
    fingerprints = (fingerprint, *(_fingerprint(mesh) for mesh in _meshes(name)))
    error: SilverballError
    try:
        table = load_table(name)
        return LoadedFile(fingerprints, table, table_digest(table)), None
    except SilverballError as problem:
        error = problem
    except Exception as problem:  # no content of a file may stop the game
        error = TableError(name, [Problem("", f"cannot be read ({type(problem).__name__}: {problem})")])
    return LoadedFile(fingerprints, problem=first_problem(error)), error


def _meshes(name: str) -> list[str]:
    """Return the paths of the meshes that a file names, if it can be read."""
    try:
        status = os.stat(name)
        if not stat.S_ISREG(status.st_mode) or status.st_size > SIZE_LIMIT:
            return []
        with open(name, "rb") as file:
            data = tomllib.load(file)
    except (OSError, ValueError, RecursionError):
        return []
    sections = [section for section in data.values() if isinstance(section, list)]
    parts = [part for section in sections for part in section if isinstance(part, dict)]
    meshes = [part["mesh"] for part in parts if isinstance(part.get("mesh"), str)]
    return [str(Path(name).parent / mesh) for mesh in dict.fromkeys(meshes)]


def _fingerprints(name: str, before: Fingerprints) -> Fingerprints:
    """Return the fingerprints of a file now, and of the meshes that it had before."""
    return (_fingerprint(name), *(_fingerprint(path) for path, *_ in before[1:]))


def _fingerprint(path: str) -> Fingerprint:
    """Return a value that differs after a file was changed, replaced, removed or made inaccessible."""
    try:
        status = os.stat(path)
    except (OSError, ValueError) as error:
        return path, getattr(error, "errno", None) or -1, 0, 0, 0, 0
    return path, status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino, status.st_mode
