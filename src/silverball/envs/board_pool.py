"""The pool of boards that episodes draw from, made before the first step and shared by all environments.

Generating and checking a board takes 10 ms or more, a step a tenth of a microsecond, so episodes draw their
boards from a pool. All boards of a pool have the same borders and paddles, so that observations have the same
meaning on each: they come from one recipe, from a list of tables whose `board` and `paddle` differ at most in
their physics, or from one table whose physics vary (`variation.py`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from operator import index
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.envs.observations import (
    LEAST_BALLS,
    LEAST_PADDLES,
    CylinderSlot,
    Field,
    PrismSlot,
    field_named,
    fields,
)
from silverball.envs.protocol import TableSource, load_source
from silverball.envs.variation import Ranges, check_ends, numbers_of, with_numbers, without_physics
from silverball.physics.records import Device
from silverball.plain import plain
from silverball.table import Table, expand, generate_table
from silverball.table.standard_rules import rules_of
from silverball.world import WorldBatch
from silverball.world.compile import Boards, blank_worlds, compile_tables

SHOWN_KINDS = {"triangular_prisms": "triangular_prism", "cylinders": "cylinder"}
"""The groups of parts that recipes place at random, and the kind of each."""


class Pool(NamedTuple):
    """Compiled boards, with the data that environments need about them.

    Attributes:
        tables: The finished tables.
        seeds: The seed of each board, int64 [board]; for a list of tables its index; for one table −1.
        boards: The compiled tables.
        blanks: Records of new worlds, one for each board.
        layouts: The columns of an observation that describe the obstacles, float32 [board, column].
        fields: The groups of an observation and their columns.
        has_plunger: Whether the boards have a plunger, and so a launch button.
        has_nudge: Whether the cabinet of the boards can be nudged.
        varied: The numbers that vary, by their keys, float64 [board] each.
    """

    tables: tuple[Table, ...]
    seeds: NDArray[np.int64]
    boards: Boards
    blanks: NDArray[Any]
    layouts: NDArray[np.float32]
    fields: tuple[Field, ...]
    has_plunger: bool
    has_nudge: bool
    varied: Mapping[str, NDArray[np.float64]]

    def board_of_seed(self, seed: Any) -> int:
        """The index of the board with this seed, or at this position of a list of tables.

        Raises:
            ValueError: There is no such board.
        """
        if self.seeds[0] < 0:
            name = plain(self.tables[0].name)
            raise ValueError(f"board cannot be chosen: {name} is the only table, got {seed!r}")
        try:
            number = -1 if isinstance(seed, bool) else index(seed)
        except TypeError:  # not an integer
            number = -1
        found = np.flatnonzero(self.seeds == number)
        if not len(found):
            raise ValueError(
                f"board must be an integer from {self.seeds[0]} to {self.seeds[-1]}, got {seed!r}; "
                "for other boards of a recipe set the options boards and board_seed"
            )
        return int(found[0])

    @property
    def columns(self) -> int:
        """The number of columns of a state observation."""
        return self.fields[-1].end


def make_pool(
    table: TableSource | Sequence[TableSource],
    count: int,
    board_seed: int,
    ranges: Ranges = (),
    has_rules: bool = False,
) -> Pool:
    """The pool of a recipe, of one table, or of a list of tables.

    Args:
        table: A table source, or a list of sources of finished tables.
        count: The number of boards, if it is a recipe or if its physics vary.
        board_seed: The seed of the first board; the others follow.
        ranges: The physics that vary.
        has_rules: Whether the episodes are games by the rules of the tables, which observations show.

    Raises:
        TableError: There is no such table, or it has problems.
        TypeError: It is not a table source.
        ValueError: The tables of a list differ in their boards or paddles, one is a recipe, or the physics
            cannot vary like this.
    """
    if isinstance(table, (list, tuple)):
        return _list_pool(tuple(load_source(one) for one in table), ranges, has_rules)
    one = load_source(table)  # type: ignore[arg-type]
    if one.random is None and not ranges:
        return _pool((one,), [-1], (), has_rules)
    return _seeded_pool(one, count, board_seed, ranges, has_rules)


@lru_cache(maxsize=8)
def _seeded_pool(table: Table, count: int, board_seed: int, ranges: Ranges, has_rules: bool) -> Pool:
    """The pool of a recipe, or of copies of a table with other physics."""
    seeds = range(board_seed, board_seed + count)
    tables = [table if table.random is None else generate_table(seed, table) for seed in seeds]
    return _pool(tuple(tables), seeds, ranges, has_rules)


@lru_cache(maxsize=8)
def _list_pool(tables: tuple[Table, ...], ranges: Ranges, has_rules: bool) -> Pool:
    if not tables:
        raise ValueError("the list of tables must have at least one, got an empty list")
    for number, table in enumerate(tables):
        which = f"table {number} of the list ({plain(table.name)})"
        if table.random is not None:
            raise ValueError(f"{which} is a recipe: draw boards from it with generate_table(seed, recipe)")
        for part in ("board", "paddle", "plunger"):
            if without_physics(table, part) != without_physics(tables[0], part):
                raise ValueError(
                    f"{which} has a different [{part}] than the first one; they must be equal but for physics"
                )
    return _pool(tables, range(len(tables)), ranges, has_rules)


def _pool(tables: tuple[Table, ...], seeds: Sequence[int], ranges: Ranges, has_rules: bool) -> Pool:
    if ranges:
        check_ends(tables[0], ranges)
    numbers = [numbers_of(seed, ranges) for seed in seeds]
    tables = tuple(with_numbers(table, own) for table, own in zip(tables, numbers, strict=True))
    varied = {key: np.array([own[key] for own in numbers]) for key, _, _ in ranges}
    boards = compile_tables(tables)
    items = {"balls": max(LEAST_BALLS, int(boards.board["max_balls"].max())), "game": 1}
    items["paddles"] = max(LEAST_PADDLES, _paddle_slots(tables[0]))
    items["switches"] = int(boards.board["switches"].max())
    items["spinners"] = int(boards.board["spinners"].max())
    items["plunger"] = int(boards.board["plungers"].max() > 0)
    if np.isin(boards.collider["role"], (Device.PASSAGE, Device.HOLE, Device.PLUNGER)).any():
        items["ball_places"] = items["balls"]
    if has_rules:
        rules = rules_of(tables[0])
        items |= {"play": 1, "lamps": len(rules.lamp), "counters": len(rules.counter)}
        items["modes"] = len(rules.mode)
    for group, kind in SHOWN_KINDS.items():
        items[group] = max(len(getattr(table, kind)) for table in tables)
    layout = fields(items)
    blanks = blank_worlds(boards, np.arange(len(tables)))
    layouts, has_plunger = _layouts(boards, layout), items["plunger"] > 0
    has_nudge = bool(boards.board["nudge"].any())
    numbered = np.array(seeds, np.int64)
    return Pool(tables, numbered, boards, blanks, layouts, layout, has_plunger, has_nudge, varied)


def _layouts(boards: Boards, layout: tuple[Field, ...]) -> NDArray[np.float32]:
    """The columns that describe the obstacles, float32 [board, column]; unused ones are 0."""
    prisms, cylinders = (field_named(layout, name) for name in SHOWN_KINDS)
    shown = np.zeros((len(boards.board), cylinders.end - prisms.first), np.float32)
    for row, board, names in zip(shown, boards.board, boards.names, strict=True):
        half_length, half_width = board["half_length"], board["half_width"]
        prism_parts = _rows_of(boards, board, names, "triangular_prism")
        first = row[: len(prism_parts) * len(PrismSlot)]
        for corner in range(3):
            first[2 * corner :: 6] = prism_parts[f"x{corner}"] / half_length
            first[2 * corner + 1 :: 6] = prism_parts[f"z{corner}"] / half_width
        cylinder_parts = _rows_of(boards, board, names, "cylinder")
        rest = row[prisms.end - prisms.first :][: len(cylinder_parts) * len(CylinderSlot)]
        rest[0::3], rest[1::3] = cylinder_parts["x"] / half_length, cylinder_parts["z"] / half_width
        rest[2::3] = cylinder_parts["radius"] / half_width
    return shown


def _paddle_slots(table: Table) -> int:
    """Slots of the paddles: one of each button, and one of each further paddle."""
    sides = [primitive.mover.button for row in expand(table).rows if (primitive := row.primitive).mover]
    return len(sides) + (2 - len(set(sides)))


def _rows_of(boards: Boards, board: Any, names: tuple[str, ...], kind: str) -> Any:
    """The COLLIDER records of the parts of a board whose name begins with a kind."""
    rows = boards.collider[board["collider_first"] : board["collider_end"]]
    numbers = [number for number, name in enumerate(names) if name.startswith(f"{kind}[")]
    return rows[np.isin(rows["part"], numbers)]


class PooledBatch(WorldBatch):
    """A batch of worlds that play on any board of a pool and change boards between episodes."""

    def __init__(
        self, pool: Pool, tick_rate: int, threads: int, state: Any, board_of: NDArray[np.int64]
    ) -> None:
        """Use these world records and boards [world]; the caller changes both."""
        self._set_attributes(pool.tables, pool.boards, state, board_of, tick_rate, threads)
