"""Rounds of a soak: batches of worlds on new random boards, driven and watched for some minutes.

Everything random is derived from the soak's seed and the number of the round, so each round, and each world
of it, can be run again alone. `driver.py` presses the buttons, `checks.py` watches. Every fourth world is
quiet.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Callable, Sequence
from dataclasses import field
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator
from pydantic.dataclasses import dataclass

from silverball.physics.records import records
from silverball.soak.checks import WATCH, Found, ReferenceBoard, Watches, soak_worlds
from silverball.soak.driver import Drivers
from silverball.soak.hostile import hostile_table
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.json_file import STRICT, Amount, Count
from silverball.soak.near_rows import NearBoard, near_rows
from silverball.soak.part_boards import part_table
from silverball.soak.regions import region_map
from silverball.table import Table, check_table, generate_table, table_digest
from silverball.world import WorldBatch
from silverball.world.compile import compile_tables

# Simulated in each world of a round [s], and worlds that share a board. Making a board takes as long as some
# 20,000 frames on it; hostile boards are made faster, so each world gets its own.
ROUND_SECONDS, HOSTILE_SECONDS = 600.0, 200.0
WORLDS_PER_BOARD = 4
QUIET_EVERY = 4  # one of every four worlds is quiet
CHUNK_TICKS = 1_000_000  # ticks of all worlds together between two calls of `progress`

KINDS = tuple(kind for kind in Found if kind != Found.NOTHING)

ROLLING_EVERY = 4  # on every fourth random board balls roll
ROLLING = {"friction": 0.2, "rolling": True}


class Options(NamedTuple):
    """The options of a soak.

    Attributes:
        recipe: A recipe gives random boards, a finished table is soaked itself; unused by hostile soaks.
        seed: Of everything random.
        worlds: Worlds in a round.
        tick_rate: Ticks per second.
        hostile: Whether to soak boards that break every rule (see `hostile.py`).
        parts: Whether every other board is made of all kinds of parts (see `part_boards.py`).
    """

    recipe: Table
    seed: int
    worlds: int
    tick_rate: int
    hostile: bool
    parts: bool = False

    def as_dict(self) -> dict[str, Any]:
        """The options as plain values: soaks with equal ones do the same."""
        table = "" if self.hostile else table_digest(self.recipe)
        return {"table": table} | {key: getattr(self, key) for key in self._fields[1:]}

    @property
    def round_ticks(self) -> int:
        """Ticks of each world in a round."""
        return round((HOSTILE_SECONDS if self.hostile else ROUND_SECONDS) * self.tick_rate)

    @property
    def worlds_per_board(self) -> int:
        """Worlds of a round that share a board."""
        return 1 if self.hostile else WORLDS_PER_BOARD


class FindingPlace(NamedTuple):
    """Where a finding was made: the round, the world in it, and the tick after which it shows."""

    round: int
    world: int
    tick: int


def _of_every_kind(found: dict[str, int]) -> dict[str, int]:
    if set(found) != {kind.name.lower() for kind in KINDS}:
        raise ValueError("must count every kind of finding and no other")
    return found


@dataclass(config=STRICT)
class Totals:
    """The totals of some rounds.

    Attributes:
        frames: Ticks of all worlds together.
        boards: Boards made.
        created: Balls created.
        drained: Balls that left through the gutter.
        hits: Of balls on parts and on each other.
        jams: Number of times a jammed ball was frozen.
        deepest: The greatest depth of any ball inside anything [u].
        found: Findings of each kind; a world ends at its first.
    """

    frames: Count = 0
    boards: Count = 0
    created: Count = 0
    drained: Count = 0
    hits: Count = 0
    jams: Count = 0
    deepest: Amount = 0.0
    found: Annotated[dict[str, Count], AfterValidator(_of_every_kind)] = field(
        default_factory=lambda: {kind.name.lower(): 0 for kind in KINDS}
    )

    def add(self, other: Totals) -> None:
        """Add the totals of further rounds."""
        for name in ("frames", "boards", "created", "drained", "hits", "jams"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.deepest = max(self.deepest, other.deepest)
        for kind, count in other.found.items():
            self.found[kind] += count


class SoakBatch:
    """Worlds that are driven and watched.

    Args:
        tables: The table of each world.
        seeds: The seed of each world.
        tick_rate: Ticks per second.
        hostile: Whether the check of each table was not made, or may have warned, or the same for all.
        wild: Whether each world is wild rather than quiet; empty: all are.

    Attributes:
        batch: The worlds.
        tables: The table of each world.
        drivers: What drives them.
        watches: What watches them, with the tables compiled again for the checks alone: damage to the boards
            that the solver reads does not affect the checks.
    """

    def __init__(
        self,
        tables: Sequence[Table],
        seeds: Sequence[int],
        tick_rate: int,
        hostile: bool | Sequence[bool],
        wild: Sequence[bool] = (),
    ) -> None:
        self.batch = batch = WorldBatch(tables, len(tables), seeds, tick_rate)
        self.tables = tables
        self.drivers = Drivers.of(np.array(wild or [True] * len(tables)), batch.boards.place)
        boards = compile_tables(batch.tables)
        self.watches = Watches(
            boards.board,
            boards.collider,
            *region_map(boards.board, boards.collider),
            near_rows(boards.board, boards.collider),
            records(len(tables), WATCH),
            np.array([hostile] * len(tables) if isinstance(hostile, bool) else hostile)[_first_of(batch)],
        )

    def truth(self, world: int) -> ReferenceBoard:
        """What the checks know of the table of a world."""
        watches, board = self.watches, self.batch.board_of[world]
        return ReferenceBoard(
            watches.boards[board],
            watches.colliders,
            watches.headers[board],
            watches.labels,
            NearBoard(watches.near.headers[board], watches.near.starts, watches.near.rows),
            watches.hostile[board],
        )

    def run(self, ticks: int) -> None:
        """Soak all worlds for a number of ticks."""
        batch, tick = self.batch, 1.0 / self.batch.tick_rate
        lanes, geometries = batch.lanes, batch.geometries
        batch.on_threads(
            lambda first, end: soak_worlds(
                lanes, geometries, self.drivers, self.watches, first, end, ticks, tick
            ),
            batch.count * ticks,
        )

    def totals(self) -> Totals:
        """The totals so far."""
        state, watches = self.batch.state, self.watches.states
        return Totals(
            int(watches["frames"].sum()),
            len(self.batch.tables),
            int(state["created"].sum()),
            int(state["drained"].sum()),
            int(self.batch.tallies.sum() + state["ball_hits"].sum()),
            int(state["jams"].sum()),
            float(watches["deepest"].max()),
            {kind.name.lower(): int((watches["found"] == kind).sum()) for kind in KINDS},
        )


def round_batch(options: Options, number: int, only: int | None = None) -> SoakBatch:
    """The worlds of a round at its start, or only one of them."""
    worlds = range(options.worlds) if only is None else range(only, only + 1)
    board_of = {world: world // options.worlds_per_board for world in worlds}
    boards = {board: _board(options, number, board) for board in sorted(set(board_of.values()))}
    is_warned = options.recipe.random is None and has_problems(options.recipe)
    return SoakBatch(
        [boards[board_of[world]] for world in worlds],
        [_seed(options.seed, number, f"world {world}") for world in worlds],
        options.tick_rate,
        [options.hostile or is_warned or _has_parts(options, board_of[world]) for world in worlds],
        [world % QUIET_EVERY != 0 for world in worlds],
    )


def play_round(
    options: Options,
    number: int,
    progress: Callable[[int], None] | None = None,
    threads: int | None = None,
) -> tuple[Totals, list[FindingPlace]]:
    """Run a round.

    Args:
        options: The options of the soak.
        number: Which round, from 0.
        progress: Called from time to time with the frames of this round so far.
        threads: Threads to use; None: one for each core.

    Returns:
        The totals, and where findings were made.
    """
    soaked = round_batch(options, number)
    if threads is not None:
        soaked.batch.threads = threads
    chunk = max(1, CHUNK_TICKS // options.worlds)
    for done in range(0, options.round_ticks, chunk):
        soaked.run(min(chunk, options.round_ticks - done))
        if progress is not None:
            progress(int(soaked.watches.states["frames"].sum()))
    places = [
        FindingPlace(number, int(world), int(soaked.watches.states["frames"][world]))
        for world in np.nonzero(soaked.watches.states["found"])[0]
    ]
    return soaked.totals(), places


@functools.lru_cache(maxsize=8)
def has_problems(table: Table) -> bool:
    """Whether the check of a table has problems, warnings among them: a ball may lie still on it."""
    return check_table(table) != []


def _board(options: Options, number: int, board: int) -> Table:
    seed = _seed(options.seed, number, f"board {board}")
    has_parts = _has_parts(options, board)
    if options.hostile:
        return hostile_part_table(seed) if has_parts else hostile_table(seed)
    if has_parts:
        return part_table(seed)
    if options.recipe.random is None:
        return options.recipe
    table = generate_table(seed, options.recipe)
    if board % ROLLING_EVERY:
        return table
    return table.model_copy(update={"board": table.board.model_copy(update=ROLLING)})


def _has_parts(options: Options, board: int) -> bool:
    """Whether a board of a round is made of all kinds of parts; the check may have warned of it."""
    return options.parts and board % 2 != 0


def _first_of(batch: WorldBatch) -> NDArray[np.int64]:
    """The first world on each board of a batch."""
    return np.unique(batch.board_of, return_index=True)[1]


def _seed(seed: int, number: int, of: str) -> int:
    """The seed of a world or a board, an integer from 0 to 2⁶³ − 1."""
    digest = hashlib.sha256(f"soak {seed}, round {number}, {of}".encode()).digest()
    return int.from_bytes(digest[:8], "little") >> 1
