"""The records of worlds and tables, and the tuples that kernels pass to each other.

A *world* is one flat record with everything that changes. A *board* and its *colliders* are the compiled
table; they do not change. A *log* is the buffer of events of the last call; it is not part of the state.
Kernels pass records on by reference, read and write their fields, and exchange the NamedTuples below; the hot
loop allocates no arrays.

Units: u, s, rad; x up the table, z to the player's right. Angles are positive upwards for both paddles.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.forms import Response as Response, Shape as Shape  # noqa: PLC0414
from silverball.physics.kernel import SETTINGS

MAX_BALLS = 8
"""Balls in a WORLD record; a board uses the first `max_balls` of them."""

MAX_PADDLES = 8
"""Paddles in a WORLD record; a board uses the first `paddles` of them."""

PLAIN_BALLS = PLAIN_PADDLES = 2
"""The same in a PLAIN_WORLD record."""

MAX_PAIRS = MAX_BALLS * (MAX_BALLS - 1) // 2
"""Pairs of balls, in the order (0, 1), (0, 2), (1, 2), (0, 3), …: those of the first n balls come first."""

MAX_LEVELS = 8
"""Levels of a board; a ball is on one of them, a collider on any."""

MAX_SWITCHES = 62
"""Colliders of a board that can be away: bits of `off` in a world record."""

MAX_BANKS = 16
"""Banks of drop targets of a board."""

MAX_SPINNERS = 16
"""Spinners of a board."""

NO_CLOCK = 2**62
"""The tick of a clock that never comes."""

LOG_SIZE = 64
"""Events of one step that a world's log holds; later ones are counted as lost."""

LOG_LENGTH = LOG_SIZE + 2 * MAX_BALLS
"""Capacity of a log: the events of a step, and the balls created before it and after it."""

LOG_RESERVE = 8
"""Slots of a log that contacts leave free: a jam comes after many touches and must not be lost."""


# The buttons that are held in a tick, as bits; JITTER shoves the balls, the nudges the cabinet.
LEFT, RIGHT, JITTER, LAUNCH = 1, 2, 4, 8
NUDGE_LEFT, NUDGE_RIGHT, NUDGE_UP = 16, 32, 64
NUDGES = NUDGE_LEFT | NUDGE_RIGHT | NUDGE_UP
SHOVES = JITTER | NUDGES


class Part(IntEnum):
    """The first colliders of every board, and parts of the same numbers.

    The paddles are the `board.paddles` rows from `FIRST_PADDLE` on, the stationary shapes those from
    `board.shape_first` on.
    """

    LEFT_WALL = 0
    RIGHT_WALL = 1
    TOP_WALL = 2
    FIRST_PADDLE = 3
    LEFT_PADDLE = 3
    RIGHT_PADDLE = 4


# Special values in fields that hold rows or parts; plain integers, so that both have one type in kernels.
NOTHING = -1
GUTTER = -2
OTHER_BALL = -3
NULL_EVENT = -4  # the search stopped here without a contact and has to continue
ROLL_START = -5  # a slipping ball starts to roll


class Kind(IntEnum):
    """The kind of a collider."""

    WALL = 1
    SLANT_WALL = 2
    PADDLE = 3
    TRIANGULAR_PRISM = 4
    CYLINDER = 5
    OTHER = 6


class Device(IntEnum):
    """What a collider does apart from bouncing a ball."""

    NONE = 0
    DROP_TARGET = 1  # falls when it is hit
    GATE = 2  # is opened and closed by rules
    SENSOR = 3  # reports a ball
    PASSAGE = 4  # changes the level of a ball
    SPINNER = 5
    HOLE = 6
    DRAIN = 7  # a ball that falls into it is lost
    PLUNGER = 8


class KickProfile(IntEnum):
    """How the kick of a collider varies along it."""

    FLAT = 0
    PARABOLA = 1  # 1 − ξ² between the two ends of a capsule or arc, ξ = −1 … 1


class EventKind(IntEnum):
    """The kind of an event."""

    HIT = 1  # a ball met a part above hit_speed
    TOUCH = 2  # the same below hit_speed; or a passage threw a ball back
    BALL_HIT = 3  # two balls met above hit_speed
    BALL_TOUCH = 4
    GUTTER = 5  # a ball left the board
    CREATED = 6
    JITTER = 7
    JAM = 8  # a pinched ball was stopped and the paddles at it stalled
    PASS = 9  # a ball crossed a sensor
    SPIN = 10  # a spinner made a turn
    CAPTURED = 11  # a hole or a plunger holds a ball
    RELEASED = 12  # … and has sent it off
    RESET = 13  # a drop target has come back


class Motion(IntEnum):
    """How a ball moves over the playfield."""

    SLIDING = 0  # without friction, as in the original
    ROLLING = 1
    SLIPPING = 2  # its lowest point moves over the playfield
    HELD = 3  # jammed; only within a tick
    CAPTURED = 4  # in a hole or on a plunger


class Fault(IntEnum):
    """The reason why a world has stopped."""

    NONE = 0
    NOT_FINITE = 1  # a position or speed is infinite or NaN
    OUTSIDE = 2  # a ball is beyond the borders
    TOO_FAST = 3  # a ball is faster than the cap allows
    INSIDE = 4  # a ball is inside a part or the other ball
    BEYOND_STOP = 5  # a paddle is beyond its stops


class Outcome(IntEnum):
    """The result of a request for a new ball."""

    CREATED = 0
    BOARD_FULL = 1
    NO_ROOM = 2


def _fields(record: np.dtype[Any]) -> list[tuple[str, np.dtype[Any]]]:
    """The fields of a record."""
    return [(name, record[name]) for name in record.names or ()]


PLAIN_BALL = np.dtype(
    [
        ("x", "f8"), ("z", "f8"),  # centre [u]
        ("vx", "f8"), ("vz", "f8"),  # velocity [u/s]
        ("spin_x", "f8"), ("spin_y", "f8"), ("spin_z", "f8"),  # [rad/s]; zero on a table without friction
        ("id", "i8"),  # 1, 2, 3, … in the order of creation; 0: no ball
        # The flight: since its last contact the ball has been on one parabola. Its state is always computed
        # from the start, so that rounding errors do not accumulate. The table in motion.py has the details.
        ("start_x", "f8"), ("start_z", "f8"), ("start_vx", "f8"), ("start_vz", "f8"),
        ("accel_x", "f8"), ("accel_z", "f8"),  # acceleration [u/s²]
        ("motion", "i8"),  # Motion
        ("roll_age", "f8"),  # age at which a slipping ball starts to roll [s]
        ("ticks", "i8"), ("offset", "f8"),  # ticks since it started, and the offset within its first tick [s]
        ("age", "f8"),  # at the start of the next tick [s]
        # The next contact with a stationary part; with NOTHING: there is none up to this age [s].
        ("contact_age", "f8"), ("contact_row", "i8"),
    ],
    align=True,
)  # fmt: skip
"""A ball of a plain world.

Numba takes a record for another one if it begins with all fields of that. BALL must not begin with these.
"""

BALL = np.dtype(
    [
        *_fields(PLAIN_BALL)[:8],
        ("level", "i8"),
        *_fields(PLAIN_BALL)[8:],
        # A captured ball: the row that holds it, and when that lets it go: the tick and the time in it [s].
        ("holder", "i8"), ("due_tick", "i8"), ("due_offset", "f8"),
        # The searches: the age from which the flight is searched for contacts; the last crossing; and, on
        # boards with sensors, the next contact that is not a crossing.
        ("search_age", "f8"), ("passed_age", "f8"), ("passed_row", "i8"),
        ("solid_age", "f8"), ("solid_row", "i8"),
    ],
    align=True,
)  # fmt: skip

PADDLE = np.dtype(
    [
        ("angle", "f8"),  # [rad]
        ("angle_commanded", "f8"),  # the stop that its button commands: rest or up [rad]
        ("angular_velocity", "f8"),  # at the end of the last tick [rad/s]
    ],
    align=True,
)

SPINNER = np.dtype(
    [
        ("angle", "f8"), ("speed", "f8"),  # at the last crossing [rad], [rad/s]
        ("tick", "i8"), ("offset", "f8"),  # when that was
        ("turns", "i8"),  # since then
    ],
    align=True,
)  # fmt: skip

HEADER = (
    ("tick", "i8"),
    ("seed", "i8"), ("draws", "i8"),  # the random generator: key and counter
    ("score", "i8"),
    ("created", "i8"), ("drained", "i8"),  # balls
    ("wall_hits", "i8"), ("slant_wall_hits", "i8"), ("paddle_hits", "i8"),
    ("triangular_prism_hits", "i8"), ("cylinder_hits", "i8"), ("ball_hits", "i8"),
    ("touches", "i8"),
    ("jams", "i8"),
    ("fault", "i8"),  # Fault
)  # fmt: skip
"""The first fields of every world record."""

PLAIN_WORLD = np.dtype(
    [
        *HEADER,
        ("paddle", PADDLE, (PLAIN_PADDLES,)),
        ("ball", PLAIN_BALL, (PLAIN_BALLS,)),
    ],
    align=True,
)  # fmt: skip
"""The record of a world on a *plain* board: two paddles, at most two balls, one
level, no devices, nothing one-way, no arcs, the standard rules.

It is a seventh as long as WORLD. Kernels are compiled for either type of record when they first meet it; see
`for_devices.py` for what they leave out.
"""

STILL_WORLD = np.dtype(
    [
        *HEADER,
        ("off", "i8"),  # a bit for each switch: the collider is away
        ("next_clock", "i8"),  # the tick in which a device acts by itself next, or NO_CLOCK
        ("launch_held", "i8"),  # ticks for which the launch button has been held
        ("banks_due", "i8"),  # a bit for each bank that is to come back
        ("paddle", PADDLE, (MAX_PADDLES,)),
        ("ball", BALL, (MAX_BALLS,)),  # behind what is read most, so that the first balls lie close to it
        ("spinner", SPINNER, (MAX_SPINNERS,)),
        ("bank_tick", "i8", (MAX_BANKS,)), ("bank_offset", "f8", (MAX_BANKS,)),  # when they are due
    ],
    align=True,
)  # fmt: skip
"""The bytes of a world whose cabinet is at rest: those of a WORLD record up to its cabinet."""

WORLD = np.dtype(
    [
        *_fields(STILL_WORLD),
        # The cabinet after a nudge: its place [u] and velocity [u/s], all 0 at rest (see cabinet.py). They
        # come last, so that the bytes of a world at rest are the same without them.
        ("cabinet_x", "f8"), ("cabinet_z", "f8"), ("cabinet_vx", "f8"), ("cabinet_vz", "f8"),
    ],
    align=True,
)  # fmt: skip

BOARD = np.dtype(
    [
        ("accel_x", "f8"), ("accel_z", "f8"), ("gravity", "f8"),  # of a sliding ball; size [u/s²]
        ("ball_radius", "f8"), ("curvature", "f8"),  # [u]; 1 / ball_radius [1/u]
        ("ball_restitution", "f8"),
        ("speed_cap", "f8"), ("hit_speed", "f8"), ("jitter", "f8"), ("nudge", "f8"),
        ("gutter", "f8"),  # x of the gutter line [u]
        ("half_length", "f8"), ("half_width", "f8"),
        ("friction", "f8"),  # coefficient
        ("normal_accel", "f8"),  # acceleration onto the playfield [u/s²]; 0: it has no friction, balls slide
        ("max_accel", "f8"),  # bound on the acceleration of any flight [u/s²]
        ("max_balls", "i8"),
        # Each level: acceleration of a sliding ball [u/s²], its size, and the one onto the level. Where
        # that is 0, balls slide.
        ("level_x", "f8", (MAX_LEVELS,)), ("level_z", "f8", (MAX_LEVELS,)),
        ("level_size", "f8", (MAX_LEVELS,)), ("level_normal", "f8", (MAX_LEVELS,)),
        # Devices: rows that balls cross, all switches, rows of plungers and spinners, and of each bank its
        # switches and the time after which it comes back [s].
        ("sensors", "i8"), ("switches", "i8"), ("plungers", "i8"), ("plunger_row", "i8"),
        ("spinners", "i8"), ("spinner_row", "i8", (MAX_SPINNERS,)),
        ("banks", "i8"), ("bank_switches", "i8", (MAX_BANKS,)), ("bank_time", "f8", (MAX_BANKS,)),
        ("low_z", "f8"), ("high_z", "f8"), ("top_x", "f8"),  # limits of a ball's centre at the borders [u]
        ("paddle_top", "f8"),  # no paddle can touch a ball whose centre is above this x [u]
        ("collider_first", "i8"), ("collider_end", "i8"),  # this board's rows of the colliders
        ("paddles", "i8"), ("shape_first", "i8"),  # their number; the row of the first stationary shape
        # The grid (see broad_phase.py): this board's first cell, cells along x and z, and cells per u.
        ("grid_first", "i8"), ("grid_rows", "i8"), ("grid_columns", "i8"), ("grid_scale", "f8"),
        ("skin", "f8"),  # a cell lists all parts that a ball can touch within this travel [u]
        ("search_time", "f8"),  # the longest search for contacts [s]
        ("place_first", "i8"), ("place_end", "i8"),  # this board's rows of the places
        ("place_size", "f8"),  # side of a place's square [u]
        ("place_lowest", "f8"),  # no ball is created below this x [u]
    ],
    align=True,
)  # fmt: skip

COLLIDER = np.dtype(
    [
        # Motion, paddles only: angles [rad], speeds [rad/s], the bit of the button, angular accelerations
        # [rad/s²] (0: constant speed); a circle in which a ball's centre must be to touch the paddle, at any
        # angle.
        ("angle_rest", "f8"), ("angle_up", "f8"), ("lift_speed", "f8"), ("return_speed", "f8"),
        ("button", "i8"), ("lift_accel", "f8"), ("return_accel", "f8"),
        ("sweep_x", "f8"), ("sweep_z", "f8"), ("sweep_reach", "f8"),
        ("kind", "i8"),
        # Shape, Response, the levels (bit n: level n), the switch (a bit of WORLD.off; 0: always there).
        ("form", "i8"), ("response", "i8"), ("levels", "i8"), ("switch", "i8"),
        # Bounding circle around (x, z). A wall has its coordinate in x or z.
        ("x", "f8"), ("z", "f8"), ("reach", "f8"),
        # Shape: a circle or a rounded segment of this radius, or a triangle with corners 0, 1, 2
        # (counter-clockwise) and sides 01, 12, 20 with unit directions along_* and lengths. A paddle's lie in
        # its own frame (see paddle.py).
        ("radius", "f8"),
        ("x0", "f8"), ("z0", "f8"), ("x1", "f8"), ("z1", "f8"), ("x2", "f8"), ("z2", "f8"),
        ("along_x0", "f8"), ("along_z0", "f8"), ("along_x1", "f8"), ("along_z1", "f8"),
        ("along_x2", "f8"), ("along_z2", "f8"),
        ("length0", "f8"), ("length1", "f8"), ("length2", "f8"),
        ("inward_x", "f8"), ("inward_z", "f8"),  # walls: the unit normal into the board
        ("part", "i8"),  # its number on the board
        ("role", "i8"), ("number", "i8"),  # Device, and which spinner or bank of the board
        # Surface
        ("restitution", "f8"), ("restitution_falloff", "f8"), ("speed_factor", "f8"), ("points", "i8"),
        # Paddles: the side is +1 left, −1 right; sine and cosine of the angles at the stops
        ("side", "f8"), ("sine_rest", "f8"), ("cosine_rest", "f8"), ("sine_up", "f8"), ("cosine_up", "f8"),
        # Tapered capsules: `radius` is that of the base, length0 leads to the tip (see shapes.py).
        ("tip_radius", "f8"), ("taper_sine", "f8"), ("taper_cosine", "f8"),
        # Arcs: ends 0 and 1, where along_* are the tangents towards the middle; centre 2, from which the
        # middle lies in the direction `inward`; radius of the circle; 1 if it is more than half of it.
        ("arc_radius", "f8"), ("arc_is_major", "i8"),
        # Surface: coefficient of friction, [u/s] a contact above it is a hit, [u/s] kick, KickProfile
        ("friction", "f8"), ("hit_speed", "f8"), ("kick", "f8"), ("kick_profile", "i8"),
        ("one_way", "i8"),  # 1: only a ball that comes from the side of `inward` meets it
        ("recoil", "f8"),  # paddles: how far it gives way (see bounce.py)
        # Passages: the levels to the right and to the left of corner 0 → corner 1.
        ("level_right", "i8"), ("level_left", "i8"),
        # Spinners: damping [1/s], speed that it takes [u/s], half of the blade's height [u]
        ("damping", "f8"), ("drag", "f8"), ("blade", "f8"),
        # Holes: speed up to which they capture [u/s], time [s], and where, how, on which level they let go.
        # Plungers that launch by themselves let go so too, faster by up to the share `exit_gain`.
        ("capture_speed", "f8"), ("hold_time", "f8"), ("exit_x", "f8"), ("exit_z", "f8"),
        ("exit_vx", "f8"), ("exit_vz", "f8"), ("exit_spread", "f8"), ("exit_level", "i8"),
        ("exit_gain", "f8"),
        # Plungers: speeds [u/s], the time for the greatest one [s], the unit direction
        ("launch_least", "f8"), ("launch_greatest", "f8"), ("charge_time", "f8"),
        ("launch_x", "f8"), ("launch_z", "f8"),
    ],
    align=True,
)  # fmt: skip

EVENT = np.dtype(
    [
        ("kind", "i8"),  # EventKind
        ("part", "i8"),  # the part's number on its board, or NOTHING, GUTTER, OTHER_BALL
        ("ball", "i8"),  # id
        ("tick", "i8"),
        ("offset", "f8"),  # time within the tick [s]
        ("x", "f8"), ("z", "f8"),  # the ball's centre [u]
        ("normal_x", "f8"), ("normal_z", "f8"),  # unit, from the part to the ball
        ("speed", "f8"),  # approach along the normal, relative to the surface [u/s]
    ],
    align=True,
)  # fmt: skip

SWEEP = np.dtype(
    [
        ("angle", "f8"), ("omega", "f8"), ("stop", "f8"), ("alpha", "f8"),  # see `PaddleSweep`
        ("stop_time", "f8"),  # when in the tick it reaches its stop [s], or NEVER
    ],
    align=True,
)  # fmt: skip

LOG = np.dtype(
    [
        ("count", "i8"), ("lost", "i8"),
        ("carried", "i8"),  # the first events: balls created before the last step
        ("done", "i8"),  # events at the end of the last step; later ones are balls created since
        ("checksum", "i8"),  # of the flights and angles that the last call left
        ("event", EVENT, (LOG_LENGTH,)),
        # Scratch of a tick: the paddles' motion; for each ball its events since its last jam, its jams, and
        # where it was before the tick [u]; for each pair of balls the contacts between them since a jam of
        # either.
        ("sweep", SWEEP, (MAX_PADDLES,)),
        ("ball_events", "i8", (MAX_BALLS,)), ("ball_jams", "i8", (MAX_BALLS,)),
        ("before_x", "f8", (MAX_BALLS,)), ("before_z", "f8", (MAX_BALLS,)),
        ("pair_events", "i8", (MAX_PAIRS,)),
    ],
    align=True,
)  # fmt: skip


# The arguments of kernels: rows of arrays of these types, and whole arrays. mypy cannot know them.
WorldRecord: TypeAlias = Any  # a WORLD or PLAIN_WORLD record
BallRecord: TypeAlias = Any  # a BALL or PLAIN_BALL record
PaddleRecord: TypeAlias = Any  # a PADDLE record
BoardRecord: TypeAlias = Any  # a BOARD record
ColliderRecord: TypeAlias = Any  # a COLLIDER record
SpinnerRecord: TypeAlias = Any  # a SPINNER record
SweepRecord: TypeAlias = Any  # a SWEEP record
LogRecord: TypeAlias = Any  # a LOG record
Colliders: TypeAlias = Any  # COLLIDER records [collider] of all boards
Grid: TypeAlias = Any  # i4 [number]: the grids of all boards
Places: TypeAlias = Any  # f8 [place, 2]: centres (x, z) [u] of the squares in which balls may be created
Tally: TypeAlias = Any  # i8 [part]: hits of each part of one board


def records(count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Create zeroed records; without the JIT a record array, as kernels need for `record.field`."""
    array = np.zeros(count, dtype)
    return array.view(np.recarray) if SETTINGS.DISABLE_JIT else array


class BallMotion(NamedTuple):
    """A ball's motion at one moment: centre [u] and velocity [u/s]."""

    x: float
    z: float
    vx: float
    vz: float


class PaddleSweep(NamedTuple):
    """A paddle's motion in one tick.

    Attributes:
        angle: Its angle at the start of the tick [rad].
        omega: Its angular velocity at the start of the tick [rad/s].
        stop: The angle at which it stops [rad].
        alpha: Its angular acceleration towards the stop [rad/s²]; 0: it turns at constant speed.
    """

    angle: float
    omega: float
    stop: float
    alpha: float


class Contact(NamedTuple):
    """A contact: its time [s], the row of the collider met, the unit normal from it to the ball."""

    time: float
    row: int
    nx: float
    nz: float


class BoardGeometry(NamedTuple):
    """One board as the step reads it, with the colliders and grids of all boards."""

    board: BoardRecord
    colliders: Colliders
    grid: Grid


class Lane(NamedTuple):
    """One world of a batch with its log and tally: all that a step writes.

    `scratch` is a log whose scratch fields are used. Worlds that are stepped one after the other share it, so
    that it stays in the cache.
    """

    world: WorldRecord
    log: LogRecord
    tally: Tally
    scratch: LogRecord


class BatchGeometry(NamedTuple):
    """All boards of a batch: BOARD records [board], with their colliders and grids."""

    boards: Any
    colliders: Colliders
    grid: Grid


class Lanes(NamedTuple):
    """The worlds of a batch with their logs and tallies: all that a step writes.

    Attributes:
        worlds: WORLD records [world].
        board_of: The board of each world [world].
        logs: LOG records [world].
        tallies: Hits of each part [world, part].
    """

    worlds: Any
    board_of: Any
    logs: Any
    tallies: Any
