"""How are random boards soaked, round after round?

A round makes a batch of worlds on boards nobody has seen yet, with everything random derived from the soak's
seed and the number of the round, and drives (`driver.py`) and watches (`watch.py`) them for some minutes. So
each round, and each world of it, can be run again alone. Every fourth world is a quiet one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import field
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator
from pydantic.dataclasses import dataclass

from silverball.physics.records import records
from silverball.soak.checks import WATCH, Found, soak_worlds
from silverball.soak.driver import ACTION, DRIVER
from silverball.soak.hostile import hostile_table
from silverball.soak.json_file import STRICT, Amount, Count
from silverball.soak.regions import Grounds, survey
from silverball.table import Table, generate_table, table_digest
from silverball.world import WorldBatch
from silverball.world.compile import Boards, compile_tables

# Simulated in each world of a round [s], and worlds that share a board. Making a board takes as long as some
# 20,000 frames on it; of hostile ones, which are quicker made, each world gets its own.
ROUND_SECONDS, HOSTILE_SECONDS = 600.0, 200.0
WORLDS_A_BOARD = 4
QUIET_EVERY = 4  # every so many worlds one is quiet
CHUNK_TICKS = 1_000_000  # of all worlds together, between two calls of `progress`

KINDS = tuple(kind for kind in Found if kind != Found.NOTHING)

ROLLING_EVERY = 4  # on every fourth random board balls roll
ROLLING = {"friction": 0.2, "rolling": True}


class Options(NamedTuple):
    """What a soak is made of.

    Attributes:
        recipe: The table: a recipe gives random boards; a finished table is soaked itself; not used by
            hostile soaks.
        seed: Of everything random.
        worlds: In a round.
        tick_rate: Frames per second.
        hostile: Whether to soak boards that break every rule (see `hostile.py`).
    """

    recipe: Table
    seed: int
    worlds: int
    tick_rate: int
    hostile: bool

    def described(self) -> dict[str, Any]:
        """The options as plain values: soaks with equal ones do the same."""
        table = "" if self.hostile else table_digest(self.recipe)
        return {"table": table} | {key: getattr(self, key) for key in self._fields[1:]}

    @property
    def round_ticks(self) -> int:
        """Frames of each world in a round."""
        return round((HOSTILE_SECONDS if self.hostile else ROUND_SECONDS) * self.tick_rate)

    @property
    def worlds_a_board(self) -> int:
        """Worlds of a round that share a board."""
        return 1 if self.hostile else WORLDS_A_BOARD


class Place(NamedTuple):
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
    """What came of some rounds.

    Attributes:
        frames: Ticks of all worlds together.
        boards: Boards made.
        created: Balls created.
        drained: Balls that left through the gutter.
        hits: Of balls on parts and on each other.
        jams: Times at which a pinched ball was held.
        deepest: The deepest that any ball was inside anything [u].
        found: How many findings of each kind; every world ends at its first.
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
        """Add those of further rounds."""
        for name in ("frames", "boards", "created", "drained", "hits", "jams"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.deepest = max(self.deepest, other.deepest)
        for kind, count in other.found.items():
            self.found[kind] += count


class Soaked:
    """Worlds that are driven and watched.

    Attributes:
        batch: The worlds.
        tables: The table of each world.
        true: The tables compiled once more, for the watch alone: whatever happens to the boards that the
            solver reads, the watch knows where the parts are.
        grounds: The maps of the boards.
        watches: WATCH records, shape [world].
        drivers: DRIVER records, shape [world].
        actions: ACTION records, shape [world]: what was last done to each world.
    """

    def __init__(
        self,
        tables: Sequence[Table],
        seeds: Sequence[int],
        tick_rate: int,
        hostile: bool,
        wild: Sequence[bool] = (),
    ) -> None:
        self.batch = WorldBatch(tables, len(tables), seeds, tick_rate)
        self.tables, self.hostile = tables, hostile
        self.true: Boards = compile_tables(self.batch.tables)
        self.grounds: Grounds = survey(self.true.board, self.true.collider)
        self.watches: NDArray[Any] = records(len(tables), WATCH)
        self.drivers: NDArray[Any] = records(len(tables), DRIVER)
        self.actions: NDArray[Any] = records(len(tables), ACTION)
        self.wild = np.array(wild or [True] * len(tables))

    def run(self, ticks: int) -> None:
        """Soak all worlds for a number of ticks."""
        batch, true = self.batch, self.true
        batch.on_threads(
            lambda first, end: soak_worlds(
                batch.state, batch.boards.board, batch.board_of, batch.boards.collider, batch.boards.grid,
                batch.boards.place,
                batch.logs, batch.tallies, true.board, true.collider, self.grounds.site, self.grounds.mark,
                self.watches, self.drivers, self.actions, self.wild, first, end, ticks, 1.0 / batch.tick_rate,
                self.hostile,
            ),
            batch.count * ticks,
        )  # fmt: skip

    def totals(self) -> Totals:
        """What came of it."""
        state = self.batch.state
        hits = ("wall", "slant_wall", "paddle", "triangular_prism", "cylinder", "ball")
        return Totals(
            int(self.watches["frames"].sum()),
            len(self.batch.tables),
            int(state["created"].sum()),
            int(state["drained"].sum()),
            sum(int(state[f"{name}_hits"].sum()) for name in hits),
            int(state["jams"].sum()),
            float(self.watches["deepest"].max()),
            {kind.name.lower(): int((self.watches["found"] == kind).sum()) for kind in KINDS},
        )


def soaked_round(options: Options, number: int, only: int | None = None) -> Soaked:
    """The worlds of a round at its start, or only one of them."""
    worlds = range(options.worlds) if only is None else range(only, only + 1)
    board_of = {world: world // options.worlds_a_board for world in worlds}
    boards = {board: _board(options, number, board) for board in sorted(set(board_of.values()))}
    return Soaked(
        [boards[board_of[world]] for world in worlds],
        [_seed(options.seed, number, f"world {world}") for world in worlds],
        options.tick_rate,
        options.hostile,
        [world % QUIET_EVERY != 0 for world in worlds],
    )


def play_round(
    options: Options, number: int, progress: Callable[[int], None] | None = None
) -> tuple[Totals, list[Place]]:
    """Run a round.

    Args:
        options: What the soak is made of.
        number: Which round, from 0.
        progress: Called now and then with the frames of this round so far.

    Returns:
        What came of it, and where findings were made.
    """
    soaked = soaked_round(options, number)
    chunk = max(1, CHUNK_TICKS // options.worlds)
    for done in range(0, options.round_ticks, chunk):
        soaked.run(min(chunk, options.round_ticks - done))
        if progress is not None:
            progress(int(soaked.watches["frames"].sum()))
    places = [
        Place(number, int(world), int(soaked.watches["frames"][world]))
        for world in np.nonzero(soaked.watches["found"])[0]
    ]
    return soaked.totals(), places


def _board(options: Options, number: int, board: int) -> Table:
    seed = _seed(options.seed, number, f"board {board}")
    if options.hostile:
        return hostile_table(seed)
    if options.recipe.random is None:
        return options.recipe
    table = generate_table(seed, options.recipe)
    if board % ROLLING_EVERY:
        return table
    return table.model_copy(update={"board": table.board.model_copy(update=ROLLING)})


def _seed(seed: int, number: int, of: str) -> int:
    """The seed of a world or a board, a whole number below 2⁶³."""
    digest = hashlib.sha256(f"soak {seed}, round {number}, {of}".encode()).digest()
    return int.from_bytes(digest[:8], "little") >> 1
