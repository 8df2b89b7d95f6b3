"""The catalog of tables and scores: built-in tables, those in the user's folder, and their high scores.

The menus query the catalog while they draw, so it answers from memory. The store is read again only after a
new score, and table files only when they have changed (`table_files.py`).
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
    FIRST_REFRESH_WAIT,
    REFRESH_WAIT,
    Fingerprints,
    LoadedFile,
    TableFiles,
    first_problem,
    is_path,
)
from silverball.errors import SilverballError
from silverball.game.user_folder import TABLES, write_user_file
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table, generate_table, load_table, table_digest, table_names

if TYPE_CHECKING:
    from silverball.game.scores.store import Score, Store

REPLAYS = "replays"  # subfolder of the data folder for replay files
MAX_SCORES = 10


class ScoreKey(NamedTuple):
    """Key of a table's score list: a title for display, and the digest that identifies it."""

    title: str
    digest: str


class Catalog:
    """All tables to choose from, and their scores.

    Args:
        store: Holds the scores.
        folder: The data folder.
        given: Tables made in Python, by name.
    """

    def __init__(self, store: Store, folder: Path, given: dict[str, Table] | None = None) -> None:
        self._store, self._folder = store, folder
        self._given = dict(given or {})
        self._files = TableFiles(folder / TABLES)
        self._listed_version = -1  # of the files, in the last result of `entries`
        self._chosen = ""
        self._reported: Fingerprints = ()  # of the chosen file when it was last read or reported
        self._suspected: Fingerprints = ()  # of the chosen file when a problem was first found
        self._rows: dict[tuple[str, Mode], list[ScoreRow]] = {}
        self._lists: set[tuple[str, str]] | None = None  # (digest, mode) of every list that has scores

    def watch_file(self, name: str) -> None:
        """Watch the file of the chosen table, if it has one, in any folder."""
        self._chosen = name
        self._files.watch(name)

    def refresh(self, *, whole: bool) -> bool:
        """Check the files; return whether `entries` has changed since its last call.

        Args:
            whole: Whether to check the whole folder, or only the chosen file.
        """
        self._files.refresh(whole=whole)
        return self._files.version != self._listed_version

    def entries(self) -> list[TableEntry]:
        """Return all tables, and the files that cannot be used with their first problem."""
        self._files.refresh(FIRST_REFRESH_WAIT if self._listed_version < 0 else REFRESH_WAIT)
        self._listed_version = self._files.version
        built_in = [name for name in table_names() if name not in self._given]
        entries = [
            TableEntry(name, plain(table.name), _description(table), table.random is not None)
            for name, table in [*self._given.items(), *((name, load_table(name)) for name in built_in)]
        ]
        entries += [_file_entry(name, self._files.loaded(name)) for name in self._files.names]
        return _with_unique_titles(entries)

    def recipe(self, name: str) -> Table:
        """Return the table of a name, or read it from the file of a path.

        Raises:
            TableError: There is no such table, or it has problems.
        """
        if name in self._given:
            return self._given[name]
        if not is_path(name):
            return load_table(name)
        try:
            return self._files.read(name)
        finally:
            loaded = self._files.loaded(name)
            if name == self._chosen and loaded is not None:
                self._reported = loaded.fingerprints

    def chosen_file_change(self) -> LoadedFile | None:
        """Return the chosen file as read, once after every change; None if it has not changed.

        A file with a problem is reported only if it is still the same at the next check: it may have been
        half-written.
        """
        loaded = self._files.loaded(self._chosen)
        if self._chosen in self._given or loaded is None or loaded.fingerprints == self._reported:
            return None
        if loaded.problem and loaded.fingerprints != self._suspected:
            self._suspected = loaded.fingerprints
            return None
        self._reported = loaded.fingerprints
        return loaded

    def make_board(self, recipe: Table, seed: int) -> Table:
        """Return the board that a seed makes of a table."""
        return recipe if recipe.random is None else generate_table(seed, recipe)

    def score_key(self, recipe: Table) -> ScoreKey:
        """Return the key of a table's score list."""
        return ScoreKey(recipe.name, _digest(recipe))

    def scores(self, name: str, mode: Mode) -> list[ScoreRow]:
        """Return the high scores of a table in its current version, best first."""
        digest = self._digest_of(name)
        return self._best(digest, mode) if digest else []

    def best(self, key: ScoreKey, mode: Mode) -> int:
        """Return the best score of a list; 0 if it is empty."""
        rows = self._best(key.digest, mode)
        return rows[0].score if rows else 0

    def best_of_seed(self, name: str, mode: Mode, seed: int) -> list[ScoreRow]:
        """Return the scores of one seed of a table, best first: the list of a day."""
        digest = self._digest_of(name)
        scores = self._store.scores(mode, digest, limit=MAX_SCORES, seed=seed) if digest else []
        return [_row(score) for score in scores]

    def best_score(self, name: str, seed: int | None = None) -> Score | None:
        """Return the best arcade score on a table that has a replay, of all seeds or of one."""
        digest = self._digest_of(name)
        scores = self._store.scores(Mode.ARCADE, digest, seed=seed) if digest else []
        return next((one for one in scores if one.has_replay and not one.is_rejected), None)

    def rows(self, key: ScoreKey, mode: Mode) -> list[ScoreRow]:
        """Return a list of scores, best first."""
        return self._best(key.digest, mode)

    def rank(self, name: str) -> int:
        """Return the missions that all arcade games on a table have finished."""
        digest = self._digest_of(name)
        return self._store.rank(Mode.ARCADE, digest) if digest else 0

    def _digest_of(self, name: str) -> str:
        """Return the digest of a table; empty if it cannot be used or has not been read yet."""
        if is_path(name) and name not in self._given:
            loaded = self._files.loaded(name)
            return loaded.digest if loaded is not None else ""
        try:
            return _digest(self.recipe(name))
        except SilverballError:
            return ""

    def _best(self, digest: str, mode: Mode) -> list[ScoreRow]:
        if self._lists is None:
            self._lists = {(scores.table_digest, scores.mode) for scores in self._store.lists()}
        if (
            digest,
            str(mode),
        ) not in self._lists and not self._store.has_pending:  # otherwise a score may be pending
            return []
        if (digest, mode) not in self._rows:
            scores = self._store.scores(mode, digest, limit=MAX_SCORES)
            self._rows[digest, mode] = [_row(score) for score in scores]
        return self._rows[digest, mode]

    def clear_score_cache(self) -> None:
        """Drop the cached scores, after one was added or changed."""
        self._rows.clear()
        self._lists = None

    def save_replay_file(self, text: str, prefix: str, score: int) -> Path | None:
        """Save a replay as a file and return its path; None if it cannot be written."""
        name = f"{prefix}-{time.strftime('%Y-%m-%d-%H%M%S')}-{score}.replay"
        return write_user_file(text, name, self._folder / REPLAYS)


def _row(score: Score) -> ScoreRow:
    key = str(score.id) if score.has_replay else ""
    return ScoreRow(score.initials, score.score, score.played("%d.%m.%y"), key)


def file_name(name: str) -> str:
    """Return the displayed file name of a table."""
    return plain(Path(name).name)


def quoted_file_name(name: str) -> str:
    """Return the file name for a sentence, in quotes if it has spaces."""
    file = file_name(name)
    return f"'{file}'" if " " in file else file


def table_problem_text(name: str, problem: str) -> str:
    """Return one sentence that says why a table cannot be played, and how to see all problems."""
    text = plain(problem)
    if not is_path(name):
        return text
    command = f"silverball check {plain(shlex.quote(name))}"
    return f"{quoted_file_name(name)} cannot be played: {text} (all problems: {command})"


def table_error_text(name: str, error: SilverballError) -> str:
    """Return `table_problem_text` for the error that reading the table raised."""
    return table_problem_text(name, first_problem(error))


def _file_entry(name: str, loaded: LoadedFile | None) -> TableEntry:
    """Return the entry of a file; one that cannot be used has its file name as title."""
    if loaded is None:
        return TableEntry(name, file_name(name), "is being read")
    if loaded.table is None:
        return TableEntry(name, file_name(name), problem=plain(loaded.problem))
    table = loaded.table
    title = plain(table.name).strip() or file_name(name)
    return TableEntry(name, title, _description(table), table.random is not None)


def _with_unique_titles(entries: list[TableEntry]) -> list[TableEntry]:
    """Return the entries with file names appended to titles that are not unique."""
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


def _description(table: Table) -> str:
    if table.random is not None:
        return "a new board every game"
    if table.board.rolling:
        return "a rolling steel ball"
    if table.format == 1:
        return f"{len(table.triangular_prism)} prisms, {len(table.cylinder)} cylinders"
    parts = [type(part) for _, _, part in table.parts()]
    return f"{len(parts)} parts of {len(set(parts))} kinds"
