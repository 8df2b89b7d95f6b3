"""What the step moves and what it moves through: the records, and the small tuples that kernels pass around.

A *world* is one flat record with everything that changes. A *board* and its *colliders* are the table,
compiled; they do not change. A *log* is the buffer of events of the last call; it is not part of the state.
Kernels load records into the NamedTuples below once and store them once: scalars in, tuples out, no views
and no allocation in the hot loop.

Units: u, s, rad; x up the table, z to the player's right. Angles of paddles are mirrored alike (up is
positive).
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.kernel import SETTINGS

BALL_COUNT = 2
"""Balls in a world record; a table may allow one or two (`max_balls`)."""

LOG_SIZE = 64
"""Events that the log of one world holds; later ones are counted as lost."""


LOG_RESERVE = 8
"""Of these, the slots that contacts leave free: a jam comes after many touches and must not be lost."""


class Part(IntEnum):
    """The first colliders of every board; the table's other parts follow from `FIRST_SHAPE` on."""

    LEFT_WALL = 0
    RIGHT_WALL = 1
    TOP_WALL = 2
    LEFT_PADDLE = 3
    RIGHT_PADDLE = 4
    FIRST_SHAPE = 5


# What a ball can meet besides parts. Plain integers: they share a tuple's field with part numbers.
NOTHING = -1
GUTTER = -2
OTHER_BALL = -3
PAUSE = -4  # a null event: the search was safe up to here


class Kind(IntEnum):
    """What a collider is."""

    ABSENT = 0  # a paddle that the table does not have
    WALL = 1
    SLANT_WALL = 2
    PADDLE = 3
    TRIANGULAR_PRISM = 4
    CYLINDER = 5


class EventKind(IntEnum):
    """What happened."""

    HIT = 1  # a ball met a part above hit_speed
    TOUCH = 2  # the same below hit_speed
    BALL_HIT = 3  # two balls met above hit_speed
    BALL_TOUCH = 4
    GUTTER = 5  # a ball left the board
    CREATED = 6
    JITTER = 7
    JAM = 8  # a pinched ball was held, the paddles at it stalled


class Fault(IntEnum):
    """Why a world has stopped."""

    NONE = 0
    NOT_FINITE = 1  # a position or speed is not a number
    OUTSIDE = 2  # a ball is beyond the borders
    TOO_FAST = 3  # a ball is faster than the cap allows


class Outcome(IntEnum):
    """What came of the wish for a new ball."""

    CREATED = 0
    BOARD_FULL = 1
    NO_ROOM = 2


BALL = np.dtype(
    [
        ("x", "f8"), ("z", "f8"),  # centre [u]
        ("vx", "f8"), ("vz", "f8"),  # velocity [u/s]
        ("spin_x", "f8"), ("spin_y", "f8"), ("spin_z", "f8"),  # [rad/s]; zero while balls do not roll
        ("id", "i8"),  # 1, 2, 3, … in the order of creation; 0: no ball
    ],
    align=True,
)  # fmt: skip

PADDLE = np.dtype(
    [
        ("angle", "f8"),  # where it is [rad]
        ("angle_commanded", "f8"),  # where the button wants it: rest or up [rad]
        ("angular_velocity", "f8"),  # at the end of the last tick [rad/s]
    ],
    align=True,
)

WORLD = np.dtype(
    [
        ("ball", BALL, (BALL_COUNT,)),
        ("paddle", PADDLE, (2,)),  # left, right
        ("tick", "i8"),
        ("seed", "i8"), ("draws", "i8"),  # the random generator: key and counter
        ("score", "i8"),
        ("created", "i8"), ("drained", "i8"),  # balls
        ("wall_hits", "i8"), ("slant_wall_hits", "i8"), ("paddle_hits", "i8"),
        ("triangular_prism_hits", "i8"), ("cylinder_hits", "i8"), ("ball_hits", "i8"),
        ("touches", "i8"),
        ("jams", "i8"),
        ("fault", "i8"),  # Fault
    ],
    align=True,
)  # fmt: skip

BOARD = np.dtype(
    [
        ("pull_x", "f8"), ("pull_z", "f8"),  # acceleration of a free ball [u/s²]
        ("ball_radius", "f8"), ("ball_restitution", "f8"),
        ("speed_cap", "f8"), ("hit_speed", "f8"), ("jitter", "f8"),
        ("gutter", "f8"),  # x of the gutter line [u]
        ("half_length", "f8"), ("half_width", "f8"),
        ("max_balls", "i8"),
        ("collider_first", "i8"), ("collider_end", "i8"),  # this board's rows of the colliders
        ("place_first", "i8"), ("place_end", "i8"),  # this board's rows of the places
        ("place_size", "f8"),  # side of a place's square [u]
        ("place_lowest", "f8"),  # no ball is created below this x [u]
    ],
    align=True,
)  # fmt: skip

COLLIDER = np.dtype(
    [
        ("kind", "i8"),
        # Reach: a circle around (x, z) that holds the whole part. A wall keeps its coordinate in x or z.
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
        # Surface
        ("restitution", "f8"), ("restitution_falloff", "f8"), ("speed_factor", "f8"), ("points", "i8"),
        # Motion, paddles only: the side is +1 left, −1 right; angles [rad], speeds [rad/s]
        ("side", "f8"), ("angle_rest", "f8"), ("angle_up", "f8"),
        ("lift_speed", "f8"), ("return_speed", "f8"),
    ],
    align=True,
)  # fmt: skip

EVENT = np.dtype(
    [
        ("kind", "i8"),  # EventKind
        ("part", "i8"),  # the collider's number on its board, or NOTHING, GUTTER, OTHER_BALL
        ("ball", "i8"),  # id
        ("tick", "i8"),
        ("offset", "f8"),  # time within the tick [s]
        ("x", "f8"), ("z", "f8"),  # the ball's centre [u]
        ("normal_x", "f8"), ("normal_z", "f8"),  # unit, from the part to the ball
        ("speed", "f8"),  # of the approach along the normal, relative to the surface [u/s]
    ],
    align=True,
)  # fmt: skip

LOG = np.dtype([("count", "i8"), ("lost", "i8"), ("event", EVENT, (LOG_SIZE,))], align=True)


def records(count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """An array of zeroed records. Without the JIT, `record.field` takes one of NumPy's record arrays."""
    array = np.zeros(count, dtype)
    return array.view(np.recarray) if SETTINGS.DISABLE_JIT else array


class Ball(NamedTuple):
    """A ball in flight: centre [u], velocity [u/s], id (0: there is none)."""

    x: float
    z: float
    vx: float
    vz: float
    id: int


class Paddle(NamedTuple):
    """A paddle in motion: angle [rad], angular velocity [rad/s], time until it reaches its stop [s]."""

    angle: float
    turn: float
    stop_in: float


class Contact(NamedTuple):
    """The next contact of a ball: time from now [s], part met, unit normal from the part to the ball."""

    time: float
    part: int
    nx: float
    nz: float
