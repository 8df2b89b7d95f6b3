"""Which tables and scores can be chosen? Built-in tables, those in the user's folder, and who is best.

The menus ask while they draw, so everything is answered from memory; the store is read again only when a
score has come in.
"""

from __future__ import annotations

import time
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.menus import ScoreRow, TableEntry
from silverball.errors import SilverballError
from silverball.game.folder import keep
from silverball.game.news import Mode
from silverball.game.when import local
from silverball.table import Table, generate_table, load_table, table_digest, table_names

if TYPE_CHECKING:
    from silverball.game.store import Store

TABLES = "tables"  # the folder, in the data folder, for tables of one's own
REPLAYS = "replays"  # the same for replays that are kept as files
PLACES = 10


class Key(NamedTuple):
    """What a table's scores are listed under: what people read, and the digest that decides."""

    title: str
    digest: str


class Library:
    """The tables and their scores.

    Args:
        store: Where the scores are.
        folder: The data folder.
        given: Tables by name that were made in Python, or that a command names.
    """

    def __init__(self, store: Store, folder: Path, given: dict[str, Table] | None = None) -> None:
        self._store, self._folder = store, folder
        self._recipes: dict[str, Table] = dict(given or {})
        self._rows: dict[tuple[str, Mode], list[ScoreRow]] = {}

    def entries(self) -> list[TableEntry]:
        """All tables that can be chosen; a file that cannot be used is not among them."""
        own = sorted(str(path) for path in (self._folder / TABLES).glob("*.toml"))
        entries = []
        for name in dict.fromkeys([*self._recipes, *table_names(), *own]):
            try:
                table = self.recipe(name)
            except SilverballError:
                continue
            entries.append(TableEntry(name, table.name, _about(table), table.random is not None))
        return entries

    def recipe(self, name: str) -> Table:
        """The table of a name or a path.

        Raises:
            TableError: There is none, or it has problems.
        """
        if name not in self._recipes:
            self._recipes[name] = load_table(name)
        return self._recipes[name]

    def finished(self, recipe: Table, seed: int) -> Table:
        """The board that a seed makes of a table."""
        return recipe if recipe.random is None else generate_table(seed, recipe)

    def key(self, recipe: Table) -> Key:
        """What a table's scores are listed under."""
        return Key(recipe.name, _digest(recipe))

    def scores(self, name: str, mode: Mode) -> list[ScoreRow]:
        """The best scores of a table, best first."""
        if (name, mode) not in self._rows:
            try:
                digest = _digest(self.recipe(name))
            except SilverballError:
                return []
            self._rows[name, mode] = [
                ScoreRow(
                    score.initials,
                    score.score,
                    local(score.when, "%d.%m.%y"),
                    str(score.id) if score.has_replay else "",
                )
                for score in self._store.scores(mode, digest, limit=PLACES)
            ]
        return self._rows[name, mode]

    def best(self, name: str, mode: Mode) -> int:
        """The best score of a table; 0 if there is none."""
        rows = self.scores(name, mode)
        return rows[0].score if rows else 0

    def forget_scores(self) -> None:
        """A score has come in or was changed."""
        self._rows.clear()

    def keep_file(self, text: str, what: str, score: int) -> Path | None:
        """Keep a replay as a file of its own; where it is, or None where nothing can be written."""
        name = f"{what}-{time.strftime('%Y-%m-%d-%H%M%S')}-{score}.replay"
        return keep(text, name, self._folder / REPLAYS)


@lru_cache(maxsize=64)
def _digest(table: Table) -> str:
    return table_digest(table)


def _about(table: Table) -> str:
    if table.random is not None:
        return "another board every game"
    if table.board.rolling:
        return "a steel ball that rolls"
    return f"{len(table.triangular_prism)} prisms, {len(table.cylinder)} cylinders"
