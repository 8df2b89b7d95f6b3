"""Thousands of games played together: a `WorldBatch` whose worlds have rules."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.errors import StateError
from silverball.game.builtin_rules import BUILTIN
from silverball.game.view import Mode
from silverball.physics.records import records
from silverball.referee.compile_rules import compile_rules
from silverball.referee.game_records import REPORT
from silverball.referee.run_games import GameRows, run_games
from silverball.table import Table
from silverball.world import Snapshot, WorldBatch
from silverball.world.arguments import Index, resolve_index
from silverball.world.batch import CHUNK


class GameSnapshot(NamedTuple):
    """Saved games, for `GameBatch.restore_games`.

    Attributes:
        worlds: Their worlds.
        games: Their GAME records.
        rules: A hash of the rules by which they were played.

    Examples:
        >>> import silverball as sb
        >>> batch = sb.GameBatch("classic", count=2)
        >>> saved = batch.save_games(0)
        >>> batch.restore_games(saved, 1)
        >>> saved.games["score"].tolist()
        [0]
    """

    worlds: Snapshot
    games: NDArray[Any]
    rules: str


class GameBatch(WorldBatch):
    """Thousands of games, each with its own world, by the rules of their tables.

    The rules run inside the loop that steps the worlds. Game i is, bit for bit, the `Game` with seed + i
    and the same buttons. A game that is over stands still.

    Attributes:
        games: GAME records, shape [world]: score, lamps, counters, modes (see
            `silverball.referee.game_records`).
        mode: The mode.
        serves: Whether the next ball of a game starts by itself when none is in play.
        books: The compiled rules.

    Examples:
        >>> import numpy as np, silverball as sb
        >>> batch = sb.GameBatch("classic", count=100)
        >>> batch.step(np.zeros((100, 4), bool), ticks=2400)
        >>> bool(batch.games["used"].min() >= 1)
        True
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str] | Sequence[Table],
        count: int = 1,
        seed: int | Sequence[int] = 0,
        tick_rate: int = 240,
        threads: int | None = None,
        *,
        mode: Mode | str = Mode.ARCADE,
    ) -> None:
        """Make `count` games, before their first ball.

        Args:
            table: One table for all worlds, or one each; as for `WorldBatch`.
            count: The number of games.
            seed: Game i gets seed + i; or one seed each.
            tick_rate: Ticks per second.
            threads: The number of threads that `step` may use; None: one for each core.
            mode: "arcade" or "free"; in free play games have the standard rules and do not end.

        Raises:
            ValueError: A count, seed, tick rate, mode, or the number of tables or seeds is invalid.
            TableError: A table cannot be used.
        """
        if mode not in set(Mode):
            raise ValueError(f"mode must be one of {', '.join(Mode)}, got {mode!r}")
        super().__init__(table, count, seed, tick_rate, threads)
        self.mode, self.serves = Mode(mode), True
        configs = [BUILTIN[self.mode].configure(one, tick_rate) for one in self.tables]
        edges = self.boards.board[["collider_first", "collider_end"]].tolist()
        colliders = [self.boards.collider[first:end] for first, end in edges]
        self.books = compile_rules(self.tables, colliders, configs, tick_rate)
        self.games: NDArray[Any] = records(self.count, self.books.blank.dtype)
        self.games[:] = self.books.blank[self.board_of]
        self._seen = np.zeros(self.count, np.int64)  # points of the hits that the games were told of

    def step_unchecked(self, held: NDArray[np.bool_], ticks: int) -> None:
        """Play every game, without the checks of `step`; see `WorldBatch.step_unchecked`."""
        if ticks > 1 and ticks > (chunk := CHUNK * self.threads // self.count or 1):
            self._step_in_chunks(held, ticks, chunk)
            return
        lanes, geometries = self.lanes, self.geometries

        def play(first: int, end: int) -> None:
            rows = self.game_rows()
            run_games(lanes, geometries, rows, held, first, end, ticks, 1.0 / self.tick_rate)

        self.on_threads(play, self.count * abs(ticks))

    def game_rows(self) -> GameRows:
        """The games with their rules and a report of its own, bundled for kernels; one for each slice."""
        books, report = self.books, records(1, REPORT)[0]
        return GameRows(
            self.games, self._seen, books.setups, books.book, self.boards.place, report, int(self.serves)
        )

    def save_games(self, index: Index = None) -> GameSnapshot:
        """Copy the state of some games, their worlds included, for `restore_games`.

        Args:
            index: Which games, as for `save`.
        """
        rows = resolve_index(index, self.count)
        return GameSnapshot(self.save(index), self.games[rows].copy(), self._rules_digest())

    def restore_games(self, snapshot: GameSnapshot, index: Index = None) -> None:
        """Restore saved games, bit for bit, as `restore` does with worlds.

        Args:
            snapshot: What `save_games` returned.
            index: Which games, as for `restore`.

        Raises:
            StateError: The games were played by other rules, at another tick rate or on another table.
            ValueError: The index is invalid or has another length.
        """
        if snapshot.rules != self._rules_digest():
            raise StateError(
                "the games were played by other rules; restore them in a batch with the same ones"
            )
        self.restore(snapshot.worlds, index)
        rows = resolve_index(index, self.count)
        self.games[rows] = snapshot.games
        self._seen[rows] = self._points_of_hits(rows)

    def game_digests(self) -> list[str]:
        """Return a digest of each game: of its world and of the state of its rules."""
        return [
            hashlib.sha256(digest.encode() + game.tobytes()).hexdigest()
            for digest, game in zip(self.digests(), self.games, strict=True)
        ]

    def _rules_digest(self) -> str:
        found = hashlib.sha256(self.books.setups.tobytes())
        for rows in self.books.book[1:]:
            found.update(rows.tobytes())
        return found.hexdigest()

    def _points_of_hits(self, rows: Any) -> NDArray[np.int64]:
        """Points of all hits that the tallies of some worlds have counted."""
        points = self.books.book.parts["points"]
        firsts = self.books.setups["part_first"][self.board_of[rows]]
        counts = self.books.setups["parts"][self.board_of[rows]]
        return np.array(
            [
                int(tally[:count] @ points[first : first + count])
                for tally, first, count in zip(self.tallies[rows], firsts, counts, strict=True)
            ],
            np.int64,
        )
