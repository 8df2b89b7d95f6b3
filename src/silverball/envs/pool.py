"""Which boards do the episodes draw from? A pool, made before the first step and shared by all environments.

A board takes some 50 ms to make and check, a step a tenth of a microsecond; so episodes draw a board from a
pool instead of making one. All boards of a pool have the same borders, slant walls and paddles: they come
from one recipe and differ by their obstacles.
"""

from __future__ import annotations

import os
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.envs.slots import Field, fields
from silverball.physics.layout import LOG, WORLD, Kind, Part, records
from silverball.table import Table, generate_table, load_table
from silverball.world import WorldBatch
from silverball.world.compile import Boards, compile_tables


class Pool(NamedTuple):
    """Boards, compiled, with what environments need of them.

    Attributes:
        tables: The finished tables.
        seeds: The seed of each board, int64 [board]; −1 for a table that was not made from a seed.
        boards: The compiled tables.
        blanks: WORLD records of worlds in which nothing has happened yet, one for each board.
        layouts: The groups of each board's obstacles in an observation, float32 [board, column].
        fields: Where all groups of an observation lie.
    """

    tables: tuple[Table, ...]
    seeds: NDArray[np.int64]
    boards: Boards
    blanks: NDArray[Any]
    layouts: NDArray[np.float32]
    fields: tuple[Field, ...]

    @property
    def columns(self) -> int:
        """Columns of a state observation."""
        return self.fields[-1].end


def pool_of(table: Table | str | os.PathLike[str], count: int, board_seed: int) -> Pool:
    """The pool of a recipe, or of one table.

    Args:
        table: A built-in name, a path, or a table.
        count: How many boards, if it is a recipe.
        board_seed: The seed of the first board; the others follow.

    Raises:
        TableError: There is no such table, or it has problems.
        TypeError: It is something else.
    """
    if isinstance(table, (str, os.PathLike)):
        table = load_table(table)
    if not isinstance(table, Table):
        raise TypeError(f"table must be a built-in name, a path or a Table, got {type(table).__name__}")
    return _made(table, count, board_seed) if table.random is not None else _made(table, 1, -1)


@lru_cache(maxsize=8)
def _made(table: Table, count: int, board_seed: int) -> Pool:
    seeds = np.arange(board_seed, board_seed + count)
    tables = (table,) if table.random is None else tuple(generate_table(int(s), table) for s in seeds)
    boards = compile_tables(tables)
    layout = fields(len(tables[0].triangular_prism), len(tables[0].cylinder))
    blanks = records(len(tables), WORLD)
    for part, side in ((Part.LEFT_PADDLE, 0), (Part.RIGHT_PADDLE, 1)):
        rest = boards.collider["angle_rest"][boards.board["collider_first"] + part]
        blanks["paddle"]["angle"][:, side] = rest
        blanks["paddle"]["angle_commanded"][:, side] = rest
    return Pool(tables, seeds, boards, blanks, _layouts(boards, layout), layout)


def _layouts(boards: Boards, layout: tuple[Field, ...]) -> NDArray[np.float32]:
    """The obstacles of each board as they stand in an observation."""
    prisms, cylinders = layout[-2:]
    shown = np.zeros((len(boards.board), cylinders.end - prisms.first), np.float32)
    for row, board in zip(shown, boards.board, strict=True):
        parts = boards.collider[board["collider_first"] : board["collider_end"]]
        up, across = board["half_length"], board["half_width"]
        corners = parts[parts["kind"] == Kind.TRIANGULAR_PRISM]
        for corner in range(3):
            row[2 * corner : prisms.end - prisms.first : 6] = corners[f"x{corner}"] / up
            row[2 * corner + 1 : prisms.end - prisms.first : 6] = corners[f"z{corner}"] / across
        round_ones = parts[parts["kind"] == Kind.CYLINDER]
        rest = row[prisms.end - prisms.first :]
        rest[0::3], rest[1::3] = round_ones["x"] / up, round_ones["z"] / across
        rest[2::3] = round_ones["radius"] / across
    return shown


class PooledBatch(WorldBatch):
    """A batch of worlds that may change boards: each plays on any board of the pool."""

    def __init__(
        self, pool: Pool, count: int, tick_rate: int, threads: int, state: Any, board_of: NDArray[np.int64]
    ) -> None:
        """Worlds in these records, WORLD [world], on these boards [world]."""
        self.count = count
        self.tick_rate = tick_rate
        self.threads = threads
        self.tables = pool.tables
        self.boards = pool.boards
        self.board_of = board_of
        self.state = state
        self.logs = records(count, LOG)
        self.tallies = np.zeros((count, max(len(names) for names in pool.boards.names)), np.int64)
