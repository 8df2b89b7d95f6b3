"""One table in motion: `World`, which most callers use.

A world is a `WorldBatch` of one; there is no second code path. Time advances in ticks of 1/tick_rate seconds.
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
from silverball.physics.records import (
    HEADER,
    JITTER,
    LAUNCH,
    LEFT,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGE_UP,
    RIGHT,
    BoardGeometry,
    Device,
    Fault,
    Motion,
    Outcome,
    Part,
)
from silverball.physics.switches import set_switch
from silverball.physics.tolerances import FREE_GAP, MIN_ADVANCE_GAP
from silverball.physics.validation import validate_world
from silverball.table import Table, expand
from silverball.world import saved_world
from silverball.world.arguments import checked_int
from silverball.world.batch import WorldBatch
from silverball.world.events import BallState, Event, PaddleState, read_balls, read_events, read_paddles
from silverball.world.single_step import SingleStepper

BALL_FIELDS = ("x", "z", "vx", "vz", "spin_x", "spin_y", "spin_z")
PLACE_FIELDS = ("x", "z", "id", "motion")
CHUNK_TICKS = 2**12  # ticks per call, some milliseconds; Python notices Ctrl-C between two calls
COUNTS = tuple(name for name, _ in HEADER)
NUDGE_BITS = {"left": NUDGE_LEFT, "right": NUDGE_RIGHT, "up": NUDGE_UP}


class World:
    """One table in motion.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the world's seed.
        seed: The seed of everything random in this world, 0 to 2⁶³ − 1. The same table, seed and inputs give
            the same bits, on every machine.
        tick_rate: Ticks per second, 10 to 100,000. Paddles react once a tick; 60 is enough for studies.

    Attributes:
        table: The finished table.
        tick_rate: Ticks per second.

    Raises:
        TableError: The table cannot be loaded, or a part has no extent.
        ValueError: The seed or the tick rate is invalid.

    Examples:
        >>> import silverball as sb
        >>> world = sb.World("classic", seed=7)
        >>> ball = world.create_ball()
        >>> world.step(left=True, ticks=24)
        >>> world.time, [event.kind for event in world.events]
        (0.1, ['created'])
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
        self._paddle_count = int(self._board["paddles"])
        batch = self._batch
        self._stepper = SingleStepper(
            batch.boards, batch.state, batch.logs, batch.tallies, 1.0 / self.tick_rate
        )
        self._static = (self._board, self._batch.boards.collider)

    def __repr__(self) -> str:
        return (
            f"<World {self.table.name!r} seed {self.seed}: {self.time:g} s, balls {len(self.balls)}, "
            f"score {self.score}>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Support `copy` and `pickle`: a copy is rebuilt, because the records are views into arrays."""
        arguments = (self.table, self.seed, self.tick_rate, self.save(), self._batch.tallies.copy())
        return _rebuild, arguments

    def copy(self) -> World:
        """Make an independent world in the same state.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic")
            >>> other = world.copy()
            >>> other.step()
            >>> world.tick, other.tick
            (0, 1)
        """
        rebuild, arguments = self.__reduce__()
        world: World = rebuild(*arguments)
        return world

    def step(
        self,
        left: bool = False,
        right: bool = False,
        jitter: bool = False,
        ticks: int = 1,
        launch: bool = False,
        *,
        nudge: str | None = None,
    ) -> None:
        """Advance the world by a number of ticks.

        Ctrl-C ends a long call within a fraction of a second; the world is then at the end of a tick, as
        after a shorter call.

        Args:
            left: Whether the left button is held, in all ticks.
            right: Whether the right button is held, in all ticks.
            jitter: Whether to shove the balls once, at the start of the first tick.
            ticks: The number of ticks, 0 or more.
            launch: Whether the launch button is held, in all ticks.
            nudge: Where the cabinet is pushed at the start of the first tick: "left", "right", "up" or None.

        Raises:
            FaultError: The state of the world has become impossible, and it has stopped.
            ValueError: The number of ticks is not an integer ≥ 0, or the cabinet cannot be nudged so.
        """
        buttons = (LEFT if left else 0) + (RIGHT if right else 0) + (JITTER if jitter else 0)
        if launch:
            buttons += LAUNCH
        if nudge is not None:
            buttons += self._nudge_bit(nudge)
        if ticks.__class__ is not int or not 0 <= ticks <= CHUNK_TICKS:
            ticks = checked_int("ticks", ticks, 0, 2**40)
            ticks = self._step_in_chunks(buttons, ticks)
        if self._stepper.step(buttons, ticks):
            self._raise_fault()

    def _nudge_bit(self, nudge: str) -> int:
        if nudge not in NUDGE_BITS:
            raise ValueError(f"nudge must be {', '.join(NUDGE_BITS)} or None, got {nudge!r}")
        if not self.has_nudge:
            raise ValueError(
                f"the table {self.table.name!r} cannot be nudged: give [board] nudge, in u/s, or use jitter"
            )
        return NUDGE_BITS[nudge]

    @property
    def has_nudge(self) -> bool:
        """Whether the cabinet can be nudged; else there is the jitter."""
        return bool(self._board["nudge"] != 0.0)

    @property
    def cabinet(self) -> tuple[float, float]:
        """How far the cabinet has swung from its place at rest after a nudge: x and z [u].

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("silver_comet")
            >>> world.step(nudge="right", ticks=10)
            >>> world.cabinet[0], world.cabinet[1] > 0.05
            (0.0, True)
        """
        if not self.has_nudge:
            return 0.0, 0.0
        return float(self._record["cabinet_x"]), float(self._record["cabinet_z"])

    def create_ball(
        self, position: Sequence[float] | None = None, velocity: Sequence[float] = (0.0, 0.0)
    ) -> BallState:
        """Create a ball.

        Args:
            position: Centre (x, z), or (x, y, z) at the board's height [u]; None: a random free place above
                the paddles, at rest.
            velocity: (vx, vz), or (vx, 0, vz) [u/s]; needs a position.

        Returns:
            The new ball.

        Raises:
            BoardFull: The board already holds `max_balls`; nothing is changed.
            FaultError: The world has stopped.
            NoRoom: No place is free, or the given one overlaps something; nothing is changed.
            ValueError: A position or velocity is not two finite numbers, or is faster than the speed cap.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic")
            >>> world.create_ball(position=(9.0, 0.0), velocity=(0.0, -3.0)).velocity
            (0.0, 0.0, -3.0)
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
                "wait until a ball has left, or remove an obstacle"
            )
        return self._newest()

    @property
    def balls(self) -> tuple[BallState, ...]:
        """The balls on the board, at most `max_balls`; see `BallState`."""
        return read_balls(self._record, self._height)

    @property
    def paddles(self) -> tuple[PaddleState, ...]:
        """The paddles in their order, the left and the right one first; see `PaddleState`."""
        return read_paddles(self._record, self._paddle_count)

    @property
    def events(self) -> tuple[Event, ...]:
        """The events since the end of the step before the last one, in order.

        These are the balls created before the last step, what happened in that step, and the balls created
        since. So a loop that reads after each step sees every event once. A step holds at most 64 events,
        see `events_lost`.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic", seed=7)
            >>> ball = world.create_ball(position=(0.0, 1.0))
            >>> world.step(jitter=True)
            >>> [event.kind for event in world.events]
            ['created', 'jitter']
        """
        return read_events(self._log, self._names, self._height)

    @property
    def events_lost(self) -> int:
        """The number of events of the last step that did not fit into the log."""
        return int(self._log["lost"])

    @property
    def time(self) -> float:
        """Simulated time since the world was made [s]."""
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
        """The number of balls created so far."""
        return int(self._record["created"])

    @property
    def drained(self) -> int:
        """The number of balls that have left through the gutter."""
        return int(self._record["drained"])

    @property
    def jams(self) -> int:
        """Number of times a jammed ball was stopped; see the event "jam"."""
        return int(self._record["jams"])

    @property
    def hits(self) -> dict[str, int]:
        """Hits of every part since this World was made, by the part's name; `restore` does not change them.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic")
            >>> ball = world.create_ball(position=(9.0, 0.0), velocity=(5.0, 0.0))
            >>> world.step(ticks=60)
            >>> world.hits["board.top"]
            1
        """
        return dict(zip(self._names, self._batch.tallies[0].tolist(), strict=True))

    @property
    def fault(self) -> str | None:
        """Why the world has stopped, or None while it can move.

        "not_finite" (a value is not a finite number), "outside" (a ball is beyond the borders), "too_fast" (a
        ball exceeds the speed cap), "inside" (a ball is inside something), or "beyond_stop" (a paddle).
        """
        fault = Fault(int(self._record["fault"]))
        return None if fault == Fault.NONE else fault.name.lower()

    def render(self, height: int = 480, theme: str = "neon") -> NDArray[np.uint8]:
        """Draw the world as it is now, in full quality and without a display.

        The first picture of a table at a size is baked, which takes a second or two (ten more on a machine
        that has not compiled the drawing yet). Later ones take a millisecond, and the baked picture is kept
        on disk. A `Renderer` draws the flashes, sparks and trails of play too, and in any size.

        Args:
            height: Height of the picture [pixel]; the width follows from the table's shape.
            theme: "neon", "parlour" or "clear".

        Returns:
            RGB, uint8 `[height, width, 3]`; row 0 is the upper edge.

        Raises:
            ValueError: The height is below 2, or the theme is unknown.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic")
            >>> world.render(height=160).shape
            (160, 100, 3)
        """
        from silverball.drawing.renderer import render

        return render(self.table, self._record, self.tick_rate, height, theme)

    def save(self) -> bytes:
        """Return the whole state, random generator included, as bytes for `restore`.

        Examples:
            >>> import silverball as sb
            >>> world = sb.World("classic")
            >>> state = world.save()
            >>> world.step(ticks=100)
            >>> world.restore(state)
            >>> world.tick
            0
        """
        return saved_world.pack(self._record, self._batch.boards.digests[0], self.tick_rate)

    def restore(self, state: bytes) -> None:
        """Restore a saved state, bit for bit.

        The events are dropped. Overlapping balls in an edited state are moved apart equally. If an error
        is raised, nothing is changed.

        Raises:
            StateError: The state is damaged, impossible, or of another table or tick rate.
        """
        record = saved_world.unpack(
            state, self._batch.boards.digests[0], self.tick_rate, self._batch.boards.layout
        )
        before = self._record.copy()
        self._batch.state[0] = record
        try:
            self._check_state()
        except StateError:
            self._batch.state[0] = before
            raise
        self._batch.logs[0] = 0

    def digest(self) -> str:
        """Return a SHA-256 of the state and the physics version: equal digests mean equal worlds."""
        return saved_world.digest(self._record)

    @property
    def records(self) -> tuple[Any, Any, Any]:
        """The records that kernels read: WORLD or PLAIN_WORLD, BOARD, and the COLLIDER rows of its parts."""
        return self._record, *self._static

    @property
    def grid(self) -> NDArray[np.int32]:
        """The grid of the board, for kernels that simulate copies of the record."""
        return self._batch.boards.grid

    def open_gate(self, name: str, is_open: bool = True) -> bool:
        """Open or close a held gate, as rules do.

        Args:
            name: The name of the part: the one in the table, or the one in events, as "gate[0]".
            is_open: Whether balls can pass.

        Returns:
            Whether the gate is as wanted now; it does not close on a ball that is in the way.

        Raises:
            ValueError: There is no held gate of this name.
        """
        expansion = expand(self.table)
        number = expansion.named.get(name, expansion.numbers.get(name, -1))
        rows = self._batch.boards.collider
        switches = int(rows["switch"][(rows["part"] == number) & (rows["role"] == Device.GATE)].sum())
        if switches == 0:
            gates = {
                part.name
                for part in expansion.parts
                if any(primitive.is_gate for primitive in part.primitives)
            }
            raise ValueError(f"name must be that of a held gate, {sorted(gates)}, got {name!r}")
        geometry = BoardGeometry(*self._static, self._batch.boards.grid)
        return bool(set_switch(self._record, geometry, switches, is_open))

    def _step_in_chunks(self, buttons: int, ticks: int) -> int:
        """Play all but the last chunk of a step; return the remaining ticks for `run_held`."""
        sign = 1
        while ticks > CHUNK_TICKS and not self._stepper.step(buttons, sign * CHUNK_TICKS):
            ticks, sign = ticks - CHUNK_TICKS, -1
        return sign * ticks

    def clearance(self, x: float, z: float, level: int = 0) -> float:
        """Return the smallest gap [u] between a ball centred at (x, z) on a level and any part on it.

        Paddles are taken at their present angles, other balls are ignored. Negative inside a part.
        """
        return float(clearance(self._record, *self._static, x, z, level)[0])

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
        gap, part = clearance(self._record, *self._static, x, z, 0)
        if gap < FREE_GAP:
            raise NoRoom(
                f"a ball at ({x:g}, {z:g}) would overlap {self._names[part]} by {max(-gap, 0.0):.3g} u; "
                "place it elsewhere"
            )
        if clearance_of_balls(self._record, self._board, x, z, 0) < FREE_GAP:
            raise NoRoom(f"a ball at ({x:g}, {z:g}) would overlap the other ball; place it elsewhere")
        put_ball(self._record, self._board, self._log, slot, x, z, vx, vz)
        return self._newest()

    def _check_state(self) -> None:
        record = self._record
        balls = record["ball"]
        if record["fault"] not in Fault.__members__.values():
            raise StateError(f"the state has an unknown fault, number {record['fault']}")
        if record["fault"]:
            return  # a stopped world does not move, so its state need not be possible
        if any((record[name] < 0).any() for name in COUNTS):
            raise StateError("the state holds a negative count")
        rows = [*balls[list(BALL_FIELDS)].tolist(), *record["paddle"].tolist()]
        if not all(math.isfinite(number) for row in rows for number in row):
            raise StateError("the state holds a number that is not finite")
        ids = balls["id"][balls["id"] != 0]
        if (ids < 0).any() or (ids > record["created"]).any() or len(set(ids.tolist())) < len(ids):
            raise StateError("the state holds balls with ids that no created ball has")
        if not validate_world(self._record, self._board):
            raise StateError("the state holds a ball that is outside of the board, too fast, or not a number")
        if len(ids) > self.table.board.max_balls:
            raise StateError("the state holds more balls than the table allows")
        paddles = self._batch.boards.collider[Part.FIRST_PADDLE : int(self._board["shape_first"])]
        low = np.minimum(paddles["angle_rest"], paddles["angle_up"])
        high = np.maximum(paddles["angle_rest"], paddles["angle_up"])
        angles = record["paddle"]["angle"][: self._paddle_count]
        if not ((low <= angles) & (angles <= high)).all():
            raise StateError("the state holds a paddle beyond its stops")
        if not separate_balls(self._record, *self._static):
            raise StateError(
                "the state holds two overlapping balls; moving them apart would press one into a part"
            )
        levels = balls["level"].tolist() if "level" in balls.dtype.names else [0] * len(balls)
        for (x, z, id_, motion), level in zip(balls[list(PLACE_FIELDS)].tolist(), levels, strict=True):
            if not id_ or motion == Motion.CAPTURED:
                continue
            gap, part = clearance(self._record, *self._static, x, z, level)
            if gap < -MIN_ADVANCE_GAP:
                raise StateError(f"the state holds a ball {-gap:.3g} u deep inside {self._names[part]}")


def _rebuild(table: Table, seed: int, tick_rate: int, state: bytes, tallies: NDArray[np.int64]) -> World:
    world = World(table, seed, tick_rate)
    world.restore(state)
    world._batch.tallies[:] = tallies
    return world


def _pair(name: str, value: Any, middle: float) -> tuple[float, float]:
    """Return (x, z) from two finite numbers, or from three with y = `middle`."""
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
