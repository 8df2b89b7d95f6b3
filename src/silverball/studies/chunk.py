"""Plays one chunk of a study: a pure function from a table, a player and seeds to arrays.

The arrays are columns of whole numbers and a few of floats, the same bits on every machine and on any number
of threads:

    game.*   a value for each game, in the order of seeds
    ball.*   a value for each ball: a turn, from its start until no ball is left
    event.*  a value for each event, if asked
    sum.*    sums over the games: maps [x, z], hits by part, points by cause; `name.*` names their rows,
             `square.*` and `product.*` are for their intervals
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.game.game_batch import GameBatch
from silverball.game.tally import BONUS, OTHER, part_labels
from silverball.metrics.game_traces import BEGINNER, CELLS, REMEMBERED_TICKS, TICK_RATE
from silverball.metrics.watching_kernel import (
    BALL_ROW,
    DRAIN_BINS,
    EVENT_ROW,
    MOST_BALLS,
    MOST_EVENTS,
    WATCH,
    Sheet,
    WatchOptions,
    watch_games,
)
from silverball.physics.records import Fault, records
from silverball.players.batch_policies import BatchPolicy, batch_policy
from silverball.players.simple import PlayerKind
from silverball.studies.study_plan import Chunk
from silverball.table import Table, generate_table

Columns: TypeAlias = Mapping[str, NDArray[Any]]

TO_THE_END = 2**40  # decisions: all of a game
BALLS_A_GAME = 4  # for which there is room in a sheet before it is emptied
EVENT_BLOCKS = 64  # decisions for whose events there is room at least
MAPS = ("place", "speed", "shots", "stays")
GAME_COLUMNS = (
    "ticks", "longest_stay", "stay_x", "stay_z", "balls", "drained", "drained_left", "samples",
    "samples_left", "hits", "strikes", "fast",
)  # fmt: skip


def run_chunk(chunk: Chunk, threads: int | None = None) -> Columns:
    """Play the games of a chunk.

    Args:
        chunk: What to play.
        threads: Threads to use; None: one for each core. The result does not depend on it.

    Returns:
        The columns, by name.
    """
    boards: Table | list[Table] = chunk.table
    if chunk.table.random is not None:
        seeds = range(chunk.first_seed, chunk.first_seed + chunk.games)
        boards = [generate_table(seed, chunk.table) for seed in seeds]
    batch = GameBatch(boards, chunk.games, chunk.first_seed, TICK_RATE, threads)
    watching = Watching(batch, chunk)
    watching.play()
    return watching.columns()


class Watching:
    """The games of a chunk while they are watched.

    Args:
        batch: The games, before their first ball.
        chunk: What they are.
    """

    def __init__(self, batch: GameBatch, chunk: Chunk) -> None:
        self._batch, self._chunk = batch, chunk
        self._policy: BatchPolicy | None = None
        kind = BEGINNER
        if chunk.player != "beginner":
            self._policy = batch_policy(chunk.player, batch)
            kind = int(PlayerKind.__members__.get(chunk.player.upper(), PlayerKind.DECIDED))
        count = batch.count
        self.watch: NDArray[Any] = records(count, WATCH)
        self.watch["lost_tick"] = -1
        self.parts = part_names(batch)
        modes = batch.tables[0].mode
        self._options = WatchOptions(
            kind,
            round(chunk.longest * TICK_RATE),
            int(chunk.keeps_events),
            np.array([mode.is_shown for mode in modes], np.int64),
            _slots(batch, self.parts),
            np.zeros((count, 2), np.bool_) if self._policy is None else self._policy.buttons,
            np.zeros((count, 2, REMEMBERED_TICKS), np.bool_),
        )
        causes = len(self.parts) + len(modes) + 2  # and the bonus, and others
        self._points = np.zeros((count, causes), np.int64)
        self._written: list[Written] = []

    def play(self) -> None:
        """Play all games to their ends."""
        batch = self._batch
        work = batch.count * TICK_RATE
        while True:
            if self._policy is not None:
                self._policy.decide()
            batch.on_threads(self._play_slice, work)
            if self.watch["is_closed"].all():
                return

    def _play_slice(self, first: int, end: int) -> None:
        written = Written(self._batch, end - first, self._points, self._options)
        blocks = TO_THE_END if self._policy is None else 1
        batch = self._batch
        rows = batch.game_rows()
        while not watch_games(
            batch.lanes,
            batch.geometries,
            rows,
            self._options,
            self.watch,
            written.sheet,
            (first, end),
            blocks,
        ):
            written.empty()
        written.empty()
        self._written.append(written)

    def columns(self) -> dict[str, NDArray[Any]]:
        """What was noted, by name."""
        batch, watch = self._batch, self.watch
        found: dict[str, NDArray[Any]] = {
            "game.seed": batch.state["seed"].copy(),
            "game.score": batch.games["score"].copy(),
            "game.is_over": (batch.games["over"] != 0).astype(np.int64),
            "game.fault": (batch.state["fault"] != Fault.NONE).astype(np.int64),
        }
        found |= {f"game.{name}": watch[name].copy() for name in GAME_COLUMNS}
        for kind, dtype, order in (
            ("ball", BALL_ROW, ("game", "ball")),
            ("event", EVENT_ROW, ("game", "ball", "tick")),
        ):
            rows = np.concatenate([np.empty(0, dtype), *(one for w in self._written for one in w.rows[kind])])
            rows = rows[np.lexsort([rows[name] for name in reversed(order)])]
            if kind == "ball" or self._chunk.keeps_events:
                found |= {f"{kind}.{name}": rows[name].copy() for name in dtype.names or ()}
        return found | self._sums()

    def _sums(self) -> dict[str, NDArray[Any]]:
        sheets = [one.sheet for one in self._written]
        found: dict[str, NDArray[Any]] = {}
        for name in ("place", "speed", "shots", "drains", "first"):
            found[f"sum.{name}"] = np.sum([getattr(sheet, name) for sheet in sheets], axis=0)
        found["sum.stays"] = np.max([sheet.stays for sheet in sheets], axis=0)
        count = self._batch.count
        score, ticks = self._batch.games["score"], self.watch["ticks"]
        points = self._points
        points[:, -1] += score - points.sum(axis=1)  # not all may have been reported
        table = self._batch.tables[0]
        labels = part_labels(table)
        names = [*(labels.get(name, name) for name in self.parts), *(mode.name for mode in table.mode)]
        names += [BONUS, OTHER]
        causes = list(dict.fromkeys(names))
        together = np.zeros((count, len(causes)), np.int64)
        for number, name in enumerate(names):
            together[:, causes.index(name)] += points[:, number]
        hits = np.zeros((count, len(self.parts)), np.int64)
        slots = self._options.slots[self._batch.board_of]
        np.add.at(hits, (np.arange(count)[:, None], slots), self._batch.tallies)
        found["name.parts"], found["name.causes"] = np.array(self.parts), np.array(causes)
        return found | products("hits", hits, ticks) | products("points", together, score)


def products(name: str, above: NDArray[np.int64], below: NDArray[np.int64]) -> dict[str, NDArray[Any]]:
    """Sums over games for ratios by `statistics.ratio_of_sums`: a, a² and a·b for each column of `above`.

    Args:
        name: Of the sums.
        above: Numerators [game, column].
        below: Denominators [game].
    """
    a, b = above.astype(np.float64), below.astype(np.float64)[:, None]
    return {
        f"sum.{name}": above.sum(axis=0),
        f"square.{name}": (a * a).sum(axis=0),
        f"product.{name}": (a * b).sum(axis=0),
    }


class Written:
    """What a slice of games has written: a sheet that is emptied into rows when it is full.

    Args:
        batch: The games.
        count: Of the slice.
        points: Points of all games by cause.
        options: How they are watched.
    """

    def __init__(
        self, batch: GameBatch, count: int, points: NDArray[np.int64], options: WatchOptions
    ) -> None:
        board = batch.tables[0].board
        shape = (int(CELLS * board.length) + 1, int(CELLS * board.width) + 1)
        place, speed, shots, stays = (np.zeros(shape, np.int64) for _ in MAPS)
        events = EVENT_BLOCKS * MOST_EVENTS if options.keeps_events else 0
        self.sheet = Sheet(
            np.zeros(2, np.int64),
            records(BALLS_A_GAME * count + MOST_BALLS, BALL_ROW),
            records(events, EVENT_ROW),
            place,
            speed,
            shots,
            stays,
            np.zeros(DRAIN_BINS, np.int64),
            np.zeros(points.shape[1] - len(options.shown_modes) - 2, np.int64),
            points,
        )
        self.rows: dict[str, list[NDArray[Any]]] = {"ball": [], "event": []}

    def empty(self) -> None:
        """Take the rows out of the sheet."""
        sheet = self.sheet
        for number, (kind, array) in enumerate((("ball", sheet.balls), ("event", sheet.events))):
            self.rows[kind].append(array[: sheet.counts[number]].copy())
        sheet.counts[:] = 0


def part_names(batch: GameBatch) -> list[str]:
    """The names of the parts of all boards of a batch, those of the first board first."""
    return list(dict.fromkeys(name for names in batch.boards.names for name in names))


def _slots(batch: GameBatch, parts: list[str]) -> NDArray[np.int64]:
    """The place of each part of each board among the names of all, [board, part]."""
    place = {name: number for number, name in enumerate(parts)}
    found = np.zeros((len(batch.boards.names), batch.tallies.shape[1]), np.int64)
    for row, names in zip(found, batch.boards.names, strict=True):
        row[: len(names)] = [place[name] for name in names]
    return found
