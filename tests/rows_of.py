"""Collider rows and balls in flight for tests of the physics below the level of a world."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numba

from silverball.physics.flight import time_to_shape
from silverball.physics.paddle import contact_with_paddle
from silverball.physics.records import BALL, COLLIDER, NOTHING, Contact, records
from silverball.table import Board
from silverball.table.primitive import Primitive
from silverball.world.rows import set_row

RADIUS = 0.25
BOARD = Board()


def row_of(primitive: Primitive, board: Board = BOARD) -> Any:
    """The COLLIDER record of a primitive."""
    rows = records(1, COLLIDER)
    set_row(rows[0], primitive, board)
    return rows[0]


def ball_at(x: float, z: float, vx: float = 0.0, vz: float = 0.0, accel: tuple[float, float] = (0, 0)) -> Any:
    """A BALL record at the start of a flight."""
    ball = records(1, BALL)[0]
    ball["x"], ball["z"], ball["vx"], ball["vz"], ball["id"] = x, z, vx, vz, 1
    ball["start_x"], ball["start_z"], ball["start_vx"], ball["start_vz"] = x, z, vx, vz
    ball["accel_x"], ball["accel_z"] = accel
    return ball


@numba.njit(error_model="numpy")
def first_touch(c, ball, radius, limit):  # pragma: no cover  (compiled)
    """The time at which a ball first touches a shape, and whether it does before the limit."""
    time, is_hit = 0.0, False
    while time < limit and not is_hit:
        time, is_hit = time_to_shape(c, ball, radius, time, limit)
    return time, is_hit


@numba.njit(error_model="numpy")
def first_meeting(c, sweep, ball, radius, limit):  # pragma: no cover  (compiled)
    """The first contact of a ball with a paddle, as row 3, in a tick."""
    speed = sqrt(ball.vx * ball.vx + ball.vz * ball.vz)
    best, start = Contact(limit, NOTHING, 0.0, 0.0), 0.0
    while True:
        contact = contact_with_paddle(c, 3, sweep, ball, radius, speed, start, best)
        if contact[1] == 3 or contact[0] >= limit:
            return contact
        start = contact[0]
