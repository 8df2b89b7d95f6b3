"""The benchmark's protocol: splits of the boards, levels, and what the v1 ids have in common.

A result on the benchmark is one policy trained on the split "train" with one of the budgets, and one ball on
each board of the split "test", which no policy has seen. See docs/benchmark.md.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Final, Literal, NamedTuple, TypeAlias

import tomli_w

from silverball.table import Table, load_table, parse_table

TableSource: TypeAlias = Table | str | os.PathLike[str] | Mapping[str, Any]
"""A table, the name of a built-in one, a path, or the keys of a table file."""


class Split(NamedTuple):
    """Boards of a recipe: those with the seeds first, first + 1, … and so on."""

    first: int
    boards: int


SPLITS: Final = {"train": Split(0, 200), "test": Split(1_000_000, 1000)}
"""The boards to train on, and those to report results on."""

BUDGETS: Final = {"10M": 10_000_000, "100M": 100_000_000}
"""Steps of training, added up over all environments. A step is a decision, fifteen of them a second."""

SEEDS: Final = 5
"""Trainings whose results are reported together: the seeds 0 … 4."""

BENCHMARK: Final[dict[str, Any]] = {"frame_skip": 4, "sticky": 0.25, "recharge": 0.8}
"""The options of all v1 ids: fifteen decisions a second, sticky actions, one stroke at a time.

Source: `silverball bench blind`; docs/benchmark.md says what it measures.
"""

Level: TypeAlias = Literal["easy", "normal", "hard"]

GRAVITY: Final = {"easy": 0.75, "normal": 1.0, "hard": 1.5}
"""The factor of gravity at each level."""


def load_source(table: TableSource) -> Table:
    """The table of any source.

    Raises:
        TableError: There is no such table, or it has problems.
        TypeError: It is not a table source.
    """
    if isinstance(table, (str, os.PathLike)):
        return load_table(table)
    if isinstance(table, Mapping):
        try:
            text = tomli_w.dumps(table)
        except TypeError as error:
            raise TypeError(f"table has a value that a table file cannot hold: {error}") from None
        return parse_table(text, "table")
    if not isinstance(table, Table):
        raise TypeError(
            "table must be a built-in name, a path, a Table, a dict or a list of them, "
            f"got {type(table).__name__}"
        )
    return table


def at_level(table: TableSource | Sequence[TableSource], level: Level) -> Any:
    """A table source, or each of a list of them, at a level; the same object for "normal".

    "easy" has less gravity and no triangular prisms, "hard" more gravity, so that the ball is faster.

    Raises:
        TableError: There is no such table, or it has problems, or it cannot be played at this level.
        TypeError: It is not a table source.
    """
    if level == "normal":
        return table
    if isinstance(table, (list, tuple)):
        return [at_level(one, level) for one in table]
    own = load_source(table)  # type: ignore[arg-type]
    changes: dict[str, Any] = {"board": {"gravity": own.board.gravity * GRAVITY[level]}}
    if level == "easy" and own.random is not None:
        changes["random"] = {"triangular_prisms": 0}
    elif level == "easy":
        changes["triangular_prism"] = []
    return own.replace(**changes)
