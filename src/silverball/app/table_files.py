"""What do the table files say now? Read again when they have changed, in a thread, so that no frame waits.

A file is looked at by its marks (time, size, number on the disk), and so are the meshes that it names. Files
that cannot be used are kept too, with their first problem: they are shown, not passed over.
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

from silverball.errors import Problem, SilverballError, TableError
from silverball.table import Table, load_table, table_digest
from silverball.table.file import SIZE_LIMIT

ENDING = ".toml"
REFRESH_WAIT = 0.01  # [s] that a look waits for what is read: a table of a hundred parts is ready by then
READ_PAUSE = 0.02  # [s] between two of many files, in which the game has Python to itself
FIRST_REFRESH_WAIT = 0.5  # [s] the same before the first picture: some fifty tables

Mark: TypeAlias = tuple[str, int, int, int, int, int]
Stamp: TypeAlias = tuple[Mark, ...]


class FileReading(NamedTuple):
    """What a file said when it was read last.

    Attributes:
        stamp: The marks of the file and of its meshes just before.
        table: The table; None if it cannot be used.
        digest: Of the table; empty without one.
        problem: Why it cannot be used, the first reason with its place; empty if it can.
    """

    stamp: Stamp
    table: Table | None = None
    digest: str = ""
    problem: str = ""


class TableFiles:
    """The table files of a folder, and one more that was chosen wherever it lies.

    Args:
        folder: The folder; it need not be there.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._chosen = ""
        self._names: tuple[str, ...] = ()
        self._readings: dict[str, FileReading] = {}
        self._thread = threading.Thread()
        self._stale: deque[str] = deque()  # to be read; the thread takes them from the left
        self._versions = itertools.count(1)  # of two threads none takes the same
        self.version = 0
        """Another number whenever something else can be said of the files."""

    @property
    def names(self) -> tuple[str, ...]:
        """The paths of all files, the chosen one first if it lies elsewhere."""
        return self._names

    def reading(self, name: str) -> FileReading | None:
        """What a file said when it was read last; None if it was not read yet."""
        return self._readings.get(name)

    def choose(self, name: str) -> None:
        """Watch this file too, if it is one."""
        self._chosen = name if is_path(name) else ""

    def look(self, wait: float = REFRESH_WAIT, *, whole: bool = True) -> None:
        """Look which files there are and which have changed, and have those read.

        Args:
            wait: How long to wait for it at most [s]; what takes longer is seen at a later look.
            whole: Whether the folder is looked through; else only the chosen file.
        """
        if self._chosen and self._differs(self._chosen) and [self._chosen] != list(self._stale)[:1]:
            self._stale.appendleft(self._chosen)  # it is what the player waits for
        if not self._thread.is_alive():
            if whole:
                self._list()
                self._stale.extend(
                    name for name in self._names if name != self._chosen and self._differs(name)
                )
            if not self._stale:
                return
            self._thread = threading.Thread(target=self._read_all, daemon=True)
            self._thread.start()
        self._thread.join(wait)

    def read(self, name: str) -> Table:
        """The table in a file as it is at this moment.

        Raises:
            SilverballError: It cannot be used.
        """
        reading, error = _read(name)
        self._note(name, reading)
        if error is not None:
            raise error
        assert reading.table is not None
        return reading.table

    def _list(self) -> None:
        """Note which files there are; hidden ones are an editor's and half-written."""
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
            self._readings = {name: one for name, one in self._readings.items() if name in names}
            self.version = next(self._versions)

    def _differs(self, name: str) -> bool:
        """Whether a file was not read yet, or has changed since."""
        before = self._readings.get(name)
        return before is None or _stamp(name, before.stamp) != before.stamp

    def _read_all(self) -> None:
        start = time.monotonic()
        while self._stale:
            name = self._stale.popleft()
            self._note(name, _read(name)[0])
            if time.monotonic() - start > FIRST_REFRESH_WAIT:
                time.sleep(READ_PAUSE)

    def _note(self, name: str, reading: FileReading) -> None:
        self._readings[name] = reading
        self.version = next(self._versions)


def is_path(name: str) -> bool:
    """Whether a table of this name is a file."""
    return name.endswith(ENDING) or os.sep in name or (os.altsep is not None and os.altsep in name)


def first_problem(error: SilverballError) -> str:
    """The first thing that is wrong, with its place, as one line."""
    if isinstance(error, TableError) and error.problems:
        return " ".join(str(error.problems[0]).split())
    return " ".join(str(error).split())


def _read(name: str) -> tuple[FileReading, SilverballError | None]:
    """Read a file; the stamp is taken first, so that a change meanwhile is found at the next look."""
    mark = _mark(name)
    stamp = (mark, *(_mark(mesh) for mesh in _meshes(name)))
    error: SilverballError
    try:
        table = load_table(name)
        return FileReading(stamp, table, table_digest(table)), None
    except SilverballError as problem:
        error = problem
    except Exception as problem:  # whatever is in a file of somebody's, the game and its menu go on
        error = TableError(name, [Problem("", f"cannot be read ({type(problem).__name__}: {problem})")])
    return FileReading(stamp, problem=first_problem(error)), error


def _meshes(name: str) -> list[str]:
    """The paths of the meshes that a file names, if it can be read at all."""
    try:
        status = os.stat(name)
        if not stat.S_ISREG(status.st_mode) or status.st_size > SIZE_LIMIT:
            return []
        with open(name, "rb") as file:
            data = tomllib.load(file)
    except (OSError, ValueError, RecursionError):
        return []
    parts = [
        part
        for kind in ("triangular_prism", "cylinder")
        for part in (data[kind] if isinstance(data.get(kind), list) else ())
        if isinstance(part, dict)
    ]
    meshes = [part["mesh"] for part in parts if isinstance(part.get("mesh"), str)]
    return [str(Path(name).parent / mesh) for mesh in dict.fromkeys(meshes)]


def _stamp(name: str, before: Stamp) -> Stamp:
    """The marks of a file now, and those of the meshes that it had before."""
    return (_mark(name), *(_mark(path) for path, *_ in before[1:]))


def _mark(path: str) -> Mark:
    """What tells that a file was changed, replaced, removed or can no longer be reached."""
    try:
        status = os.stat(path)
    except (OSError, ValueError) as error:
        return path, getattr(error, "errno", None) or -1, 0, 0, 0, 0
    return path, status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino, status.st_mode
