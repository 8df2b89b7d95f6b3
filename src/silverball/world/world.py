"""One table in motion: `World`, the face that most callers use.

A World is a `WorldBatch` of one; there is no second code path. Time moves in ticks of 1/tick_rate seconds.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import BoardFull, FaultError, NoRoom, StateError
from silverball.physics.balls import (
    clearance,
    clearance_of_balls,
    create_ball,
    empty_slot,
    put_ball,
    separate_balls,
)
from silverball.physics.records import WORLD, Fault, Outcome
from silverball.physics.tolerances import FREE_GAP, MIN_ADVANCE_GAP
from silverball.physics.validation import validate_world
from silverball.table import Table
from silverball.world import saved_world as states
from silverball.world.batch import WorldBatch, checked_int
from silverball.world.events import BallState, Event, PaddleState, read_balls, read_events, read_paddles
from silverball.world.single_step import JITTER, LEFT, RIGHT, SingleStepper

MEASURES = ("x", "z", "vx", "vz", "spin_x", "spin_y", "spin_z")
PIECE_TICKS = 2**12  # of a long step: Python hears of Ctrl-C between two pieces, which take some milliseconds
COUNTS = tuple(name for name in WORLD.names or () if name not in ("ball", "paddle"))


class World:
    """One table in motion.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the world's seed.
        seed: Of everything random in this world, 0 to 2⁶³ − 1. The same table, seed and inputs give the
            same bits.
        tick_rate: Ticks per second. 240 plays finely; 60 is enough for studies.

    Example:
        >>> import silverball as sb
        >>> world = sb.World("classic", seed=7)
        >>> ball = world.create_ball()
        >>> world.step(left=True, ticks=24)
        >>> world.time
        0.1
    """

    def __init__(self, table: Table | str | os.PathLike[str], seed: int = 0, tick_rate: int = 240) -> None:
        self._batch = WorldBatch(table, 1, seed, tick_rate, threads=1)
        self.table: Table = self._batch.tables[0]
        self.tick_rate = self._batch.tick_rate
        self._record = self._batch.state[0]
        self._log = self._batch.logs[0]
        self._board = self._batch.boards.board[0]
        self._names = self._batch.boards.names[0]
        self._height = self.table.board.height
        batch = self._batch
        self._alone = SingleStepper(
            batch.boards, batch.state, batch.board_of, batch.logs, batch.tallies, 1.0 / self.tick_rate
        )
        self._static = (self._board, self._batch.boards.collider)

    def __repr__(self) -> str:
        return (
            f"<World {self.table.name!r} seed {self.seed}: {self.time:g} s, balls {len(self.balls)}, "
            f"score {self.score}>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """How `copy` and `pickle` make another: the records are views into arrays and must be made anew."""
        made = (self.table, self.seed, self.tick_rate, self.save(), self._batch.tallies.copy())
        return _made_again, made

    def copy(self) -> World:
        """Another world in the same state, which goes its own way from here."""
        make, made = self.__reduce__()
        world: World = make(*made)
        return world

    # --- what moves it
    # -------------------------------------------------------------------------------------------

    def step(self, left: bool = False, right: bool = False, jitter: bool = False, ticks: int = 1) -> None:
        """Move on with the paddle buttons held or not.

        Ctrl-C ends a long call within a fraction of a second. The world then stands at the end of one of the
        ticks, as after a shorter call: `tick` says of which, and `events` are those of the ticks played.

        Args:
            left: Whether the left button is held, in all ticks.
            right: The same of the right one.
            jitter: Whether to shove the balls once, on the first tick.
            ticks: How many ticks.

        Raises:
            FaultError: The world's state has become impossible and it has stopped.
            ValueError: The number of ticks is not a whole number of at least 0.
        """
        buttons = (LEFT if left else 0) + (RIGHT if right else 0) + (JITTER if jitter else 0)
        if ticks.__class__ is not int or not 0 <= ticks <= PIECE_TICKS:
            ticks = checked_int("ticks", ticks, 0, 2**40)
            ticks = self._play_pieces(buttons, ticks)
        if self._alone.step(buttons, ticks):
            self._raise_fault()

    def create_ball(
        self, position: Sequence[float] | None = None, velocity: Sequence[float] = (0.0, 0.0)
    ) -> BallState:
        """Put one more ball on the board.

        Args:
            position: Centre (x, z), or (x, y, z) at the board's height [u]; None: some free place, at rest.
            velocity: (vx, vz), or (vx, 0, vz) [u/s], for a given position.

        Returns:
            The new ball.

        Raises:
            BoardFull: The board already holds `max_balls`; nothing has changed.
            FaultError: The world has stopped.
            NoRoom: No place is free, or the given one overlaps something; nothing has changed.
            ValueError: A position or velocity that is not two finite numbers, or faster than the speed cap.
        """
        if self._record["fault"]:
            self._raise_fault()
        if position is not None:
            return self._put_ball(position, velocity)
        if any(velocity):
            raise ValueError(f"a velocity needs a position too, got velocity {tuple(velocity)} alone")
        outcome = create_ball(self._record, *self._static, self._batch.boards.place, self._log)
        if outcome == Outcome.BOARD_FULL:
            self._raise_full()
        if outcome == Outcome.NO_ROOM:
            raise NoRoom(
                f"the board {self.table.name!r} has no free place for a ball above the paddles; "
                "wait until a ball has left, or take an obstacle away"
            )
        return self._newest()

    # --- what it shows
    # -------------------------------------------------------------------------------------------

    @property
    def balls(self) -> tuple[BallState, ...]:
        """The balls on the board."""
        return read_balls(self._record, self._height)

    @property
    def paddles(self) -> tuple[PaddleState, PaddleState]:
        """The left and the right paddle."""
        return read_paddles(self._record)

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened in the last step, in order; at most 64 events, see `events_lost`."""
        return read_events(self._log, self._names, self._height)

    @property
    def events_lost(self) -> int:
        """Events of the last step that did not fit into the log."""
        return int(self._log["lost"])

    @property
    def time(self) -> float:
        """Time since the world was made [s]."""
        return self.tick / self.tick_rate

    @property
    def tick(self) -> int:
        """Ticks since the world was made."""
        return int(self._record["tick"])

    @property
    def score(self) -> int:
        """Points of all hits so far."""
        return int(self._record["score"])

    @property
    def seed(self) -> int:
        """The seed of everything random in this world."""
        return int(self._record["seed"])

    @property
    def created(self) -> int:
        """Balls created so far."""
        return int(self._record["created"])

    @property
    def drained(self) -> int:
        """Balls that have left through the gutter."""
        return int(self._record["drained"])

    @property
    def jams(self) -> int:
        """How often a pinched ball had to be held."""
        return int(self._record["jams"])

    @property
    def hits(self) -> dict[str, int]:
        """Hits of every part by its path in the table, since this World was made; `restore` leaves them."""
        return dict(zip(self._names, self._batch.tallies[0].tolist(), strict=True))

    @property
    def fault(self) -> str | None:
        """Why the world has stopped, or None: the name of a `Fault`, such as "not_finite" or "inside"."""
        fault = Fault(int(self._record["fault"]))
        return None if fault == Fault.NONE else fault.name.lower()

    # --- saving
    # --------------------------------------------------------------------------------------------------

    def save(self) -> bytes:
        """The whole state, random generator included, as bytes for `restore`."""
        return states.pack(self._record, self._batch.boards.digests[0], self.tick_rate)

    def restore(self, state: bytes) -> None:
        """Go back to a saved state, bit for bit.

        Two overlapping balls in a state from outside are moved apart equally. On any error nothing has
        changed.

        Raises:
            StateError: The state is damaged, impossible, or of another table or tick rate.
        """
        record = states.unpack(state, self._batch.boards.digests[0], self.tick_rate)
        before = self._record.copy()
        self._batch.state[0] = record
        try:
            self._check_state()
        except StateError:
            self._batch.state[0] = before
            raise
        self._batch.logs[0] = 0

    def digest(self) -> str:
        """A hash of the state: equal digests mean equal worlds."""
        return states.digest(self._record)

    @property
    def records(self) -> tuple[Any, Any, Any]:
        """The world's record, its board's and the colliders: what kernels of players and drawings read."""
        return self._record, *self._static

    @property
    def grid(self) -> NDArray[np.int32]:
        """The grid of the board, which a kernel needs that plays copies of the record on."""
        return self._batch.boards.grid

    def _play_pieces(self, buttons: int, ticks: int) -> int:
        """Play all but the last piece of a step; what is left to be played, as `run_worlds` wants it."""
        sign = 1
        while ticks > PIECE_TICKS and not self._alone.step(buttons, sign * PIECE_TICKS):
            ticks, sign = ticks - PIECE_TICKS, -1
        return sign * ticks

    # --- helpers
    # -------------------------------------------------------------------------------------------------

    def clearance(self, x: float, z: float) -> float:
        """The smallest gap [u] between a ball centred at (x, z) and any part, paddles as they stand now."""
        return float(clearance(self._record, *self._static, x, z)[0])

    def _newest(self) -> BallState:
        return max(self.balls, key=lambda ball: ball.id)

    def _raise_full(self) -> None:
        limit = self.table.board.max_balls
        raise BoardFull(
            f"the board already holds {limit} ball{'s' * (limit > 1)}, its max_balls; "
            "wait until one has left through the gutter"
        )

    def _raise_fault(self) -> None:
        fault = self.fault or ""
        raise FaultError(
            f"the world (table {self.table.name!r}, seed {self.seed}) stopped at tick {self.tick} "
            f"with the fault {fault!r}; please report it with the bytes in this error's `state`",
            fault,
            self.save(),
        )

    def _put_ball(self, position: Sequence[float], velocity: Sequence[float]) -> BallState:
        x, z = _pair("position", position, self._height)
        vx, vz = _pair("velocity", velocity, 0.0)
        cap = self.table.board.speed_cap
        if math.hypot(vx, vz) > cap:
            raise ValueError(
                f"velocity must be at most the speed cap of {cap} u/s, got {math.hypot(vx, vz):.6g} u/s"
            )
        slot = empty_slot(self._record, self._board)
        if slot < 0:
            self._raise_full()
        board = self.table.board
        if x <= board.gutter + board.ball_radius:
            raise NoRoom(f"a ball at x = {x:g} would be in the gutter (x = {board.gutter:g}); place it above")
        gap, part = clearance(self._record, *self._static, x, z)
        if gap < FREE_GAP:
            raise NoRoom(
                f"a ball at ({x:g}, {z:g}) would overlap {self._names[part]} by {max(-gap, 0.0):.3g} u; "
                "place it elsewhere"
            )
        if clearance_of_balls(self._record, self._board, x, z) < FREE_GAP:
            raise NoRoom(f"a ball at ({x:g}, {z:g}) would overlap the other ball; place it elsewhere")
        put_ball(self._record, self._board, self._log, slot, x, z, vx, vz)
        return self._newest()

    def _check_state(self) -> None:
        record = self._record
        balls = record["ball"]
        if record["fault"] not in Fault.__members__.values():
            raise StateError(f"the state has a fault of an unknown number, {record['fault']}")
        if record["fault"]:
            return  # a stopped world may be looked at; it does not move
        if any((record[name] < 0).any() for name in COUNTS):
            raise StateError("the state holds a negative count")
        rows = [*balls[list(MEASURES)].tolist(), *record["paddle"].tolist()]
        if not all(math.isfinite(number) for row in rows for number in row):
            raise StateError("the state holds a number that is not finite")
        ids = balls["id"][balls["id"] != 0]
        if (ids < 0).any() or (ids > record["created"]).any() or len(set(ids.tolist())) < len(ids):
            raise StateError("the state holds balls whose ids are not those of balls that were created")
        if not validate_world(self._record, self._board):
            raise StateError("the state holds a ball that is outside of the board, too fast, or not a number")
        if len(ids) > self.table.board.max_balls:
            raise StateError("the state holds more balls than the table allows")
        first = self._batch.boards.collider[3:5]
        low = np.minimum(first["angle_rest"], first["angle_up"])
        high = np.maximum(first["angle_rest"], first["angle_up"])
        angles = record["paddle"]["angle"]
        if not ((low <= angles) & (angles <= high)).all():
            raise StateError("the state holds a paddle beyond its stops")
        if not separate_balls(self._record, *self._static):
            raise StateError(
                "the state holds two overlapping balls that cannot be parted without pressing one into a part"
            )
        for x, z, id_ in balls[["x", "z", "id"]].tolist():
            gap, part = clearance(self._record, *self._static, x, z)
            if id_ and gap < -MIN_ADVANCE_GAP:
                raise StateError(f"the state holds a ball {-gap:.3g} u deep inside {self._names[part]}")


def _made_again(table: Table, seed: int, tick_rate: int, state: bytes, tallies: NDArray[np.int64]) -> World:
    world = World(table, seed, tick_rate)
    world.restore(state)
    world._batch.tallies[:] = tallies
    return world


def _pair(name: str, value: Any, middle: float) -> tuple[float, float]:
    """Two finite numbers of (x, z), or of (x, y, z) with the only y there is."""
    try:
        numbers = [float(number) for number in value]
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be two numbers (x, z), got {value!r}") from None
    if len(numbers) == 3 and numbers[1] == middle:
        del numbers[1]
    if len(numbers) != 2 or not all(map(math.isfinite, numbers)):
        raise ValueError(
            f"{name} must be two finite numbers (x, z), or three with y = {middle:g}, got {value!r}"
        )
    return numbers[0] + 0.0, numbers[1] + 0.0  # −0.0 becomes 0.0: equal places have equal digests
