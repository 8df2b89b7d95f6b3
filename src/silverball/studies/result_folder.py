"""The folder of a study: its plan, and a file for each chunk that is done.

    plan.json          what is played, by which code
    chunks/000012.npz  the columns of a chunk (see chunk.py)

Every file is written whole or not at all, and its bytes follow from the plan alone. So a study may be stopped
at any moment, by Ctrl-C or by SIGKILL, and the same command goes on: it plays the chunks that are missing.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import OutputError, StateError
from silverball.studies.chunk import Columns
from silverball.studies.study_plan import Chunk, Plan
from silverball.wholefile import Unreadable, is_missing, read_text, write_whole

PLAN, CHUNKS = "plan.json", "chunks"
PLAN_LIMIT = 2**24  # [bytes]
TEMPORARY = ".silverball-*"  # what a killed process may leave; see `write_whole`


class ResultFolder:
    """Reads and writes the results of a plan.

    Args:
        path: The folder; it and its plan are created.
        plan: The plan.

    Raises:
        StateError: The folder is of another plan, or not of a study.
        OutputError: The folder cannot be written.
    """

    def __init__(self, path: Path, plan: Plan) -> None:
        self.path, self.plan = path, plan
        described = json.dumps(plan.as_dict(), indent=1) + "\n"
        try:
            path.mkdir(parents=True, exist_ok=True)
            if not is_missing(path / PLAN):
                self._check(described)
            (path / CHUNKS).mkdir(exist_ok=True)
        except OSError as error:
            raise unwritable(path, error) from None
        if not is_missing(path / PLAN):
            return
        if any((path / CHUNKS).iterdir()):
            raise StateError(f"{path}: this folder has chunks without a plan; give another --out")
        write_text(path / PLAN, described)

    def missing(self) -> Iterator[Chunk]:
        """The chunks that are not done, in the order of their numbers."""
        return (chunk for chunk in self.plan.chunks() if not self.has(chunk.number))

    def has(self, number: int) -> bool:
        """Whether a chunk is done."""
        return self._file(number).is_file()

    def write(self, number: int, columns: Columns) -> None:
        """Write the columns of a chunk; once this returns, the chunk is done.

        Raises:
            OutputError: The file cannot be written; what is done stays.
        """
        arrays: dict[str, Any] = dict(columns)
        write_file(self._file(number), lambda place: np.savez_compressed(place, **arrays))

    def read(self, number: int) -> dict[str, NDArray[Any]]:
        """The columns of a chunk.

        Raises:
            StateError: The chunk is not done, or its file is damaged.
        """
        path = self._file(number)
        try:
            with np.load(path, allow_pickle=False) as arrays:
                return {name: arrays[name] for name in arrays.files}
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            raise StateError(
                f"{path}: this is not a whole chunk of a study: remove it, and give the same command again"
            ) from None

    def sweep(self) -> None:
        """Remove what killed processes have left behind; only when no other process writes here."""
        for left in (*self.path.glob(TEMPORARY), *(self.path / CHUNKS).glob(TEMPORARY)):
            left.unlink(missing_ok=True)

    def _file(self, number: int) -> Path:
        return self.path / CHUNKS / f"{number:06}.npz"

    def _check(self, described: str) -> None:
        """Refuse the folder of another plan."""
        path = self.path / PLAN
        try:
            found = json.loads(read_text(path, PLAN_LIMIT, "the plan of a study"))
        except (Unreadable, ValueError, RecursionError) as error:
            raise StateError(
                f"{path}: this is not the plan of a study ({error}); give another --out"
            ) from None
        wanted = json.loads(described)
        if not isinstance(found, dict):
            raise StateError(f"{path}: this is not the plan of a study; give another --out")
        for key, value in wanted.items():
            if found.get(key) != value:
                raise StateError(
                    f"{path}: this study was begun with other {WORDS.get(key, key)}; give the same command, "
                    "or another --out"
                )


WORDS = {"arms": "tables or players", "code": "code", "physics": "physics", "chunk_games": "sizes of chunks"}


def write_text(path: Path, text: str) -> None:
    """Write a text file whole or not at all.

    Raises:
        OutputError: It cannot be written.
    """
    write_file(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))


def write_file(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file of a study whole or not at all.

    Raises:
        OutputError: It cannot be written.
    """
    try:
        write_whole(path, write)
    except OSError as error:
        raise unwritable(path, error) from None


def unwritable(path: Path, error: OSError) -> OutputError:
    """The error that says that a file of a study cannot be written, and what to do."""
    return OutputError(
        f"{path}: cannot be written ({error.strerror or error}); what is done stays: make room, or give "
        "another --out, and give the same command again"
    )
