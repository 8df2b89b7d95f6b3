"""Many worlds stepped together, on all cores: `WorldBatch`.

A batch holds one flat record per world. World i of a batch with seed s is, bit for bit, the single world with
seed s + i at the same tick rate. Slices of worlds run on threads (the kernels release the interpreter lock);
the number of threads never changes a result, because no world reads another.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from silverball.physics.balls import create_ball
from silverball.physics.kernel import kernel
from silverball.physics.records import LOG, BatchGeometry, Fault, Lanes, Outcome, records
from silverball.physics.step import ACTION_COLUMNS, run_worlds
from silverball.table import Table, generate_table, load_table
from silverball.world import saved_world
from silverball.world.arguments import Index, checked_int, checked_row, checked_seeds
from silverball.world.compile import Boards, blank_worlds, compile_tables
from silverball.world.events import Event, read_events
from silverball.world.snapshot import Snapshot, gather, scatter
from silverball.world.threads import cores, run_on_threads

SLICES_PER_THREAD = 4  # more slices than threads, so that one slow world does not hold up the rest
MIN_SLICE = 512  # world-ticks; a smaller slice costs more to schedule than to run
CHUNK = 2**19  # world-ticks per thread and call, some 50 ms; Python notices Ctrl-C between two calls


class WorldBatch:
    """Thousands of worlds, each with its own state and, if wanted, its own table.

    Attributes:
        count: The number of worlds.
        tick_rate: Ticks per second.
        threads: The number of threads that `step` may use.
        state: WORLD records, shape [world], or PLAIN_WORLD records if all boards are plain (two paddles, at
            most two balls, one level, no devices): everything that changes. A copied row, stepped with the
            same actions, has exactly the same future.
        tables: The concrete tables (random parts already generated); worlds on the same table share one.
        board_of: The number of each world's table in `tables`, int64 [world].
        tallies: Hits of every part since the batch was made, int64 [world, part]; statistics, not state.
            `part_numbers` gives the column of each part.
        boards: The compiled tables, for kernels (see `silverball.world.compile`).
        logs: LOG records, shape [world], for kernels; `events` reads them.

    Examples:
        >>> import numpy as np, silverball as sb
        >>> batch = sb.WorldBatch("classic", count=1000)
        >>> created = batch.create_balls()
        >>> actions = np.zeros((1000, 3), bool)
        >>> actions[:500, 0] = True  # the left button, in the first 500 worlds
        >>> batch.step(actions, ticks=240)
        >>> set(batch.state["tick"].tolist()), batch.state["score"].shape
        ({240}, (1000,))
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str] | Sequence[Table],
        count: int = 1,
        seed: int | Sequence[int] = 0,
        tick_rate: int = 240,
        threads: int | None = None,
    ) -> None:
        """Make `count` worlds.

        Args:
            table: One table for all worlds, or one each. From a recipe (a table with a `[random]` section)
                every world gets a board of its own, made with its own seed.
            count: The number of worlds, 1 to 4,194,304.
            seed: World i gets seed + i; or one seed each. 0 to 2⁶³ − 1.
            tick_rate: Ticks per second, 10 to 100,000. 60 is enough for agents, and four times as fast.
            threads: The number of threads that `step` may use; None: one for each core.

        Raises:
            ValueError: A count, seed, tick rate, or the number of tables or seeds is invalid.
            TableError: A file has problems, or a part has no extent. A table made in Python is otherwise
                not checked; `check_table` lists what is wrong with it.
        """
        count = checked_int("count", count, 1, 2**22)
        tick_rate = checked_int("tick_rate", tick_rate, 10, 100_000)
        threads = cores() if threads is None else checked_int("threads", threads, 1, 4096)
        seeds = checked_seeds(seed, count)
        tables, board_of = _finished_tables(table, seeds, count)
        boards = compile_tables(tables)
        state = blank_worlds(boards, board_of)
        state["seed"] = seeds
        self._set_attributes(tables, boards, state, board_of, tick_rate, threads)

    def _set_attributes(
        self,
        tables: tuple[Table, ...],
        boards: Boards,
        state: NDArray[Any],
        board_of: NDArray[np.int64],
        tick_rate: int,
        threads: int,
    ) -> None:
        """Set every attribute: worlds with these records [world], on these boards [world]."""
        self.count = len(state)
        self.tick_rate = tick_rate
        self.threads = threads
        self.tables = tables
        self.boards = boards
        self.board_of = board_of
        self.state = state
        self.logs: NDArray[Any] = records(self.count, LOG)
        self.tallies = np.zeros((self.count, max(len(names) for names in boards.names)), np.int64)

    def __repr__(self) -> str:
        return f"<WorldBatch of {self.count} at {self.tick_rate} ticks/s on {len(self.tables)} board(s)>"

    def __len__(self) -> int:
        """The number of worlds."""
        return self.count

    @property
    def lanes(self) -> Lanes:
        """The arrays that a step changes, bundled for kernels."""
        return Lanes(self.state, self.board_of, self.logs, self.tallies)

    @property
    def geometries(self) -> BatchGeometry:
        """The compiled boards of the worlds, bundled for kernels."""
        return BatchGeometry(self.boards.board, self.boards.collider, self.boards.grid)

    def step(self, actions: ArrayLike, ticks: int = 1) -> None:
        """Advance every world by a number of ticks.

        Ctrl-C ends a long call within a fraction of a second; all worlds are then at the end of the same
        tick, as after a shorter call.

        Args:
            actions: bool [world, 3], [world, 4] or [world, 7]: left, right, jitter, launch, and nudge
                left, right, up. The buttons are held for all ticks, the shoves come on the first. Or one such
                row for every tick, bool [ticks, world, 3], and so on. What a table does not have does
                nothing.
            ticks: The number of ticks, 0 or more.

        Raises:
            ValueError: The shape of the actions is wrong, or ticks is not an integer ≥ 0.
        """
        ticks = checked_int("ticks", ticks, 0, 2**40)
        action_rows = np.ascontiguousarray(actions, np.bool_)
        if action_rows.ndim == 2:
            action_rows = action_rows[None]
        columns = action_rows.shape[-1] if action_rows.shape[-1] in ACTION_COLUMNS else 3
        if action_rows.shape not in ((1, self.count, columns), (ticks, self.count, columns)):
            raise ValueError(
                f"actions must have the shape ({self.count}, 3) or ({ticks}, {self.count}, 3), "
                f"or 4 columns with the launch button, 7 with the nudges, got {np.shape(actions)}"
            )
        self.step_unchecked(action_rows, ticks)

    def step_unchecked(self, held: NDArray[np.bool_], ticks: int) -> None:
        """Advance every world, without the checks of `step`.

        Args:
            held: The actions, a C-contiguous bool array [1 or ticks, world, 3, 4 or 7].
            ticks: The number of ticks; a negative one continues the previous call: events are kept, and a
                single row does not shove again.
        """
        if ticks > 1 and ticks > (chunk := CHUNK * self.threads // self.count or 1):
            self._step_in_chunks(held, ticks, chunk)
            return
        lanes, geometries = self.lanes, self.geometries
        self.on_threads(
            lambda first, end: run_worlds(lanes, geometries, held, first, end, ticks, 1.0 / self.tick_rate),
            self.count * abs(ticks),
        )

    def _step_in_chunks(self, action_rows: NDArray[np.bool_], ticks: int, chunk: int) -> None:
        for start in range(0, ticks, chunk):
            end = min(start + chunk, ticks)
            rows = action_rows if len(action_rows) == 1 else action_rows[start:end]
            if len(rows) < len(action_rows) and len(rows) == 1:
                rows = rows.repeat(2, axis=0)  # a single row would be held, and its jitter ignored
            self.step_unchecked(rows, end - start if start == 0 else start - end)

    def on_threads(self, task: Callable[[int, int], None], work: int) -> None:
        """Call task(first, end) for slices of the worlds, on threads if there is enough work.

        An asynchronous exception, such as KeyboardInterrupt, is raised when all slices are done.

        Args:
            task: A function that releases the interpreter lock, called with the first world and one past
                the last.
            work: The cost of all worlds [world-ticks].
        """
        slices = min(self.count, self.threads * SLICES_PER_THREAD, work // MIN_SLICE)
        if self.threads == 1 or slices < 2:
            task(0, self.count)
            return
        edges = [self.count * number // slices for number in range(slices + 1)]
        run_on_threads(task, list(pairwise(edges)), self.threads)

    def create_balls(self, mask: ArrayLike | None = None) -> NDArray[np.bool_]:
        """Create a ball at rest, at a random free place, in every chosen world that can take one.

        Args:
            mask: Which worlds, bool [world]; None: all.

        Returns:
            Where a ball was created, bool [world]. A world that has `max_balls`, no free place or a fault
            is not changed.

        Raises:
            ValueError: The mask has another shape.

        Examples:
            >>> import silverball as sb
            >>> sb.WorldBatch("classic", count=3).create_balls([True, False, True]).tolist()
            [True, False, True]
        """
        wanted = np.ones(self.count, np.bool_) if mask is None else np.ascontiguousarray(mask, np.bool_)
        if wanted.shape != (self.count,):
            raise ValueError(f"mask must have the shape ({self.count},), got {wanted.shape}")
        outcomes = np.full(self.count, -1, np.int64)
        boards = self.boards
        _create_balls(
            self.state,
            boards.board,
            self.board_of,
            boards.collider,
            boards.place,
            self.logs,
            wanted,
            outcomes,
        )
        created: NDArray[np.bool_] = outcomes == Outcome.CREATED
        return created

    def events(self, index: int) -> tuple[Event, ...]:
        """Return what happened in one world, as `World.events` does.

        Args:
            index: The number of the world, 0 to count − 1; negative numbers count from the end.

        Raises:
            ValueError: There is no such world.

        Examples:
            >>> import numpy as np, silverball as sb
            >>> batch = sb.WorldBatch("classic", count=3)
            >>> created = batch.create_balls()
            >>> batch.step(np.zeros((3, 3), bool))
            >>> [event.kind for event in batch.events(2)]
            ['created']
        """
        row = checked_row(index, self.count)
        board = self.board_of[row]
        return read_events(self.logs[row], self.boards.names[board], self.tables[board].board.height)

    def save(self, index: Index = None) -> Snapshot:
        """Copy the state of some worlds, random generators included, for `restore`.

        Args:
            index: Which worlds: None (all), a number, a slice, a list of numbers, or a mask bool [world].

        Raises:
            ValueError: The index is invalid or out of range.
        """
        return gather(
            self.state, self.boards.digests, self.boards.plain, self.board_of, self.tick_rate, index
        )

    def restore(self, snapshot: Snapshot, index: Index = None) -> None:
        """Restore saved states, bit for bit; each world is then on the table it was saved on.

        Record i of the snapshot goes into the i-th chosen world, a single record into all of them:
        ``batch.restore(batch.save(7))`` makes every world a branch of world 7. Branches share the seed, so
        the same actions lead to the same future until ``batch.state["seed"]`` is changed. The events of these
        worlds are dropped, tallies stay. If an error is raised, nothing is changed. An impossible record
        stops its world with a named fault in the next step.

        Args:
            snapshot: What `save` of this or another batch returned.
            index: Which worlds: None (all), a number, a slice, a list of numbers, or a mask bool [world].

        Raises:
            StateError: The snapshot has another tick rate, or a table that this batch does not have.
            ValueError: The index is invalid, out of range, names a world twice, or has another length.

        Examples:
            >>> import silverball as sb
            >>> batch = sb.WorldBatch("classic", count=3)
            >>> batch.restore(batch.save(0))
            >>> len(set(batch.digests()))
            1
        """
        digests, board_of = self.boards.digests, self.board_of
        rows = scatter(snapshot, self.state, digests, board_of, self.tick_rate, index)
        for name in ("count", "carried", "done", "lost", "checksum"):
            self.logs[name][rows] = 0

    def digests(self) -> list[str]:
        """Return the digest of each world, as `World.digest` does; about half a microsecond each."""
        return saved_world.digests(self.state, self.boards.plain[self.board_of])

    def render(self, index: int = 0, height: int = 480, theme: str = "neon") -> NDArray[np.uint8]:
        """Draw one of the worlds as it is now, as `World.render` does.

        Args:
            index: Which world.
            height: Height of the picture [pixel]; the width follows from the table's shape.
            theme: "neon", "parlour" or "clear".

        Returns:
            RGB, uint8 `[height, width, 3]`; row 0 is the upper edge.

        Raises:
            IndexError: There is no such world.
            ValueError: The height is below 2, or the theme is unknown.
        """
        from silverball.drawing.renderer import render

        return render(self.tables[self.board_of[index]], self.state[index], self.tick_rate, height, theme)


@kernel
def _create_balls(
    worlds: Any,
    boards: Any,
    board_of: Any,
    colliders: Any,
    places: Any,
    logs: Any,
    wanted: Any,
    outcomes: Any,
) -> None:
    """Create a ball in each wanted world, and write an `Outcome` for each."""
    for index in range(len(worlds)):
        if wanted[index] and worlds[index].fault == Fault.NONE:
            board = boards[board_of[index]]
            outcomes[index] = create_ball(worlds[index], board, colliders, places, logs[index])


def _finished_tables(
    table: Table | str | os.PathLike[str] | Sequence[Table], seeds: list[int], count: int
) -> tuple[tuple[Table, ...], NDArray[np.int64]]:
    """The distinct finished tables of a batch, and the number of each world's table, int64 [world]."""
    if isinstance(table, str | os.PathLike):
        table = load_table(table)
    if isinstance(table, Table):
        if table.random is None:
            return (table,), np.zeros(count, np.int64)
        return tuple(generate_table(seed, table) for seed in seeds), np.arange(count, dtype=np.int64)
    given = tuple(table) if isinstance(table, Sequence) else ()
    tables = [t for t in given if isinstance(t, Table)]
    if not tables or len(tables) < len(given):
        got = type(table).__name__
        raise TypeError(f"table must be a Table, a built-in name, a path, or a list of Tables, got {got}")
    if len(tables) != count:
        raise ValueError(f"table must be one table or {count} of them, one for each world, got {len(tables)}")
    finished = [
        t if t.random is None else generate_table(seed, t) for t, seed in zip(tables, seeds, strict=True)
    ]
    distinct = list({id(t): t for t in finished}.values())  # worlds that share a table share its board
    number = {id(t): index for index, t in enumerate(distinct)}
    return tuple(distinct), np.array([number[id(t)] for t in finished], np.int64)
