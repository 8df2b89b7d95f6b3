"""Which tables and scores can be chosen? Built-in tables, those in the user's folder, and who is best.

The menus ask while they draw, so everything is answered from memory; the store is read again only when a
score has come in, and the files only when they have changed (`table_files.py`).
"""

from __future__ import annotations

import shlex
import time
from collections import Counter
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.menus import ScoreRow, TableEntry
from silverball.app.table_files import (
    FIRST_GLANCE,
    GLANCE,
    Reading,
    Stamp,
    TableFiles,
    first_problem,
    is_path,
)
from silverball.errors import SilverballError
from silverball.game.user_folder import write_user_file
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table, generate_table, load_table, table_digest, table_names

if TYPE_CHECKING:
    from silverball.game.scores.store import Store

TABLES = "tables"  # the folder, in the data folder, for tables of one's own
REPLAYS = "replays"  # the same for replays that are kept as files
PLACES = 10


class Key(NamedTuple):
    """What a table's scores are listed under: what people read, and the digest that decides."""

    title: str
    digest: str


class Catalog:
    """The tables and their scores.

    Args:
        store: Where the scores are.
        folder: The data folder.
        given: Tables by name that were made in Python.
    """

    def __init__(self, store: Store, folder: Path, given: dict[str, Table] | None = None) -> None:
        self._store, self._folder = store, folder
        self._given = dict(given or {})
        self._files = TableFiles(folder / TABLES)
        self._seen = -1  # the version of the files that was told last
        self._chosen = ""
        self._told: Stamp = ()  # of the chosen file when it was asked for or told of last
        self._doubted: Stamp = ()  # of that file when it was first found broken
        self._rows: dict[tuple[str, Mode], list[ScoreRow]] = {}
        self._lists: set[tuple[str, str]] | None = None  # digests and modes that have scores

    def choose(self, name: str) -> None:
        """Watch the file of the chosen table, if it has one, wherever it lies."""
        self._chosen = name
        self._files.choose(name)

    def look(self, *, whole: bool) -> bool:
        """Whether there is something else to choose from than when `entries` was asked last.

        Args:
            whole: Whether the folder is looked through; else only the file that was chosen.
        """
        self._files.look(whole=whole)
        return self._files.version != self._seen

    def entries(self) -> list[TableEntry]:
        """All tables that can be chosen, and the files that cannot be used, with their first problem."""
        self._files.look(FIRST_GLANCE if self._seen < 0 else GLANCE)
        self._seen = self._files.version
        built_in = [name for name in table_names() if name not in self._given]
        entries = [
            TableEntry(name, plain(table.name), _about(table), table.random is not None)
            for name, table in [*self._given.items(), *((name, load_table(name)) for name in built_in)]
        ]
        entries += [_of_file(name, self._files.reading(name)) for name in self._files.names]
        return _told_apart(entries)

    def recipe(self, name: str) -> Table:
        """The table of a name, or of a path as the file is now.

        Raises:
            TableError: There is none, or it has problems.
        """
        if name in self._given:
            return self._given[name]
        if not is_path(name):
            return load_table(name)
        try:
            return self._files.read(name)
        finally:
            reading = self._files.reading(name)
            if name == self._chosen and reading is not None:
                self._told = reading.stamp

    def news(self) -> Reading | None:
        """What the chosen file says now, once after every change; None if there is nothing new.

        A file that cannot be used is told of only at the second look: perhaps it was being written.
        """
        reading = self._files.reading(self._chosen)
        if self._chosen in self._given or reading is None or reading.stamp == self._told:
            return None
        if reading.problem and reading.stamp != self._doubted:
            self._doubted = reading.stamp
            return None
        self._told = reading.stamp
        return reading

    def finished(self, recipe: Table, seed: int) -> Table:
        """The board that a seed makes of a table."""
        return recipe if recipe.random is None else generate_table(seed, recipe)

    def key(self, recipe: Table) -> Key:
        """What a table's scores are listed under."""
        return Key(recipe.name, _digest(recipe))

    def scores(self, name: str, mode: Mode) -> list[ScoreRow]:
        """The best scores of a table as it is now, best first."""
        digest = self._digest_of(name)
        return self._best(digest, mode) if digest else []

    def best(self, key: Key, mode: Mode) -> int:
        """The best score in a list; 0 if there is none."""
        rows = self._best(key.digest, mode)
        return rows[0].score if rows else 0

    def _digest_of(self, name: str) -> str:
        """The digest of a table; empty if it cannot be used or was not read yet."""
        if is_path(name) and name not in self._given:
            reading = self._files.reading(name)
            return reading.digest if reading is not None else ""
        try:
            return _digest(self.recipe(name))
        except SilverballError:
            return ""

    def _best(self, digest: str, mode: Mode) -> list[ScoreRow]:
        if self._lists is None:
            self._lists = {(one.table_digest, one.mode) for one in self._store.lists()}
        if (digest, str(mode)) not in self._lists and not self._store.has_pending:  # else one may be waiting
            return []
        if (digest, mode) not in self._rows:
            self._rows[digest, mode] = [
                ScoreRow(
                    score.initials,
                    score.score,
                    score.played("%d.%m.%y"),
                    str(score.id) if score.has_replay else "",
                )
                for score in self._store.scores(mode, digest, limit=PLACES)
            ]
        return self._rows[digest, mode]

    def forget_scores(self) -> None:
        """A score has come in or was changed."""
        self._rows.clear()
        self._lists = None

    def keep_file(self, text: str, what: str, score: int) -> Path | None:
        """Keep a replay as a file of its own; where it is, or None where nothing can be written."""
        name = f"{what}-{time.strftime('%Y-%m-%d-%H%M%S')}-{score}.replay"
        return write_user_file(text, name, self._folder / REPLAYS)


def file_name(name: str) -> str:
    """The file of a table as a player is to read it."""
    return plain(Path(name).name)


def file_in_words(name: str) -> str:
    """The same in a sentence."""
    file = file_name(name)
    return f"'{file}'" if " " in file else file


def trouble_words(name: str, problem: str) -> str:
    """What is wrong with a table that cannot be played, and how to learn all of it, as one sentence."""
    told = plain(problem)
    if not is_path(name):
        return told
    command = f"silverball check {plain(shlex.quote(name))}"
    return f"{file_in_words(name)} cannot be played: {told} (all of it: {command})"


def trouble_of(name: str, error: SilverballError) -> str:
    """The same from the error that reading the table has raised."""
    return trouble_words(name, first_problem(error))


def _of_file(name: str, reading: Reading | None) -> TableEntry:
    """A file in the list; one that cannot be used goes by its name on the disk."""
    if reading is None:
        return TableEntry(name, file_name(name), "is being read")
    if reading.table is None:
        return TableEntry(name, file_name(name), problem=plain(reading.problem))
    table = reading.table
    title = plain(table.name).strip() or file_name(name)
    return TableEntry(name, title, _about(table), table.random is not None)


def _told_apart(entries: list[TableEntry]) -> list[TableEntry]:
    """The entries, those of equal titles with the names of their files as well."""
    count = Counter(entry.title.upper() for entry in entries)
    return [
        entry._replace(title=f"{entry.title} ({file_name(entry.name)})")
        if count[entry.title.upper()] > 1 and is_path(entry.name) and entry.title != file_name(entry.name)
        else entry
        for entry in entries
    ]


@lru_cache(maxsize=64)
def _digest(table: Table) -> str:
    return table_digest(table)


def _about(table: Table) -> str:
    if table.random is not None:
        return "another board every game"
    if table.board.rolling:
        return "a steel ball that rolls"
    return f"{len(table.triangular_prism)} prisms, {len(table.cylinder)} cylinders"
