"""Features: the ball and the paddles as numbers for the small network of the trained player.

The raw features are ten numbers that every table has (`Raw`), in the units of the environments' state
observation, so training and play use the same. They do not include obstacles. Without
obstacles a table is symmetric, so a ball on the right is mirrored to the left, and the action is mirrored
back: only half of the game has to be learned.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.physics.records import LEFT as LEFT_BUTTON, RIGHT as RIGHT_BUTTON, Colliders, Part

Rows = NDArray[np.float64]


class Raw(IntEnum):
    """The raw features: of the lowest ball, of the left paddle, of the right one."""

    X = 0
    Z = 1
    VX = 2
    VZ = 3
    LEFT_ANGLE = 4
    LEFT_TURN = 5
    LEFT_HELD = 6
    RIGHT_ANGLE = 7
    RIGHT_TURN = 8
    RIGHT_HELD = 9


COLUMNS = (1, 2, 3, 4, 10, 11, 12, 13, 14, 15)
"""The columns of the raw features in the environments' state observation of a single ball."""

LEFT, RIGHT = slice(Raw.LEFT_ANGLE, Raw.LEFT_HELD + 1), slice(Raw.RIGHT_ANGLE, Raw.RIGHT_HELD + 1)
PADDLES_AT = -0.65  # x of the paddles on the built-in tables, in half board lengths
PIVOT = 0.3  # z of the middle of a paddle, in half board widths
ZOOM = 4.0  # magnification of places near the paddles
LOW = -0.4  # x below which a ball will soon be at the paddles
ENCODED = len(Raw) + 8
MIRRORED = np.array([0, 2, 1, 3])  # the mirror images of the actions none, left, right, both


def raw_features(state: Any, boards: Any, colliders: Colliders) -> Rows:
    """The raw features of some worlds, of the first paddle of each button; those of a missing one are 0.

    Args:
        state: World records [world].
        boards: The BOARD record of each [world].
        colliders: COLLIDER records of all boards.

    Returns:
        Features [world, Raw].
    """
    raw = np.zeros((len(state), len(Raw)))
    balls = state["ball"]
    alive = balls["id"] != 0
    lowest = np.where(alive, balls["x"], np.inf).argmin(axis=1)
    ball = balls[np.arange(len(state)), lowest]
    sizes = ((Raw.X, "x", "half_length"), (Raw.Z, "z", "half_width"))
    for slot, name, size in (*sizes, (Raw.VX, "vx", "speed_cap"), (Raw.VZ, "vz", "speed_cap")):
        raw[:, slot] = np.where(alive.any(axis=1), ball[name] / boards[size], 0.0)
    for button, first in ((LEFT_BUTTON, Raw.LEFT_ANGLE), (RIGHT_BUTTON, Raw.RIGHT_ANGLE)):
        number = first_paddles(boards, colliders, button)
        has_paddle = number >= 0
        row = np.where(has_paddle, Part.FIRST_PADDLE + number, 0)
        collider = colliders[boards["collider_first"] + row]
        paddle = state["paddle"][np.arange(len(state)), number * has_paddle]
        swing = (collider["angle_up"] - collider["angle_rest"]) * has_paddle
        is_present = swing > 0.0
        fastest = np.maximum(collider["lift_speed"], collider["return_speed"])
        turned = paddle["angle"] - collider["angle_rest"]
        raw[:, first] = np.divide(turned, swing, out=np.zeros(len(state)), where=is_present)
        raw[:, first + 1] = np.divide(
            paddle["angular_velocity"], fastest, out=np.zeros(len(state)), where=is_present
        )
        raw[:, first + 2] = is_present & (paddle["angle_commanded"] == collider["angle_up"])
    return raw


def first_paddles(boards: Any, colliders: Colliders, button: int) -> NDArray[np.int64]:
    """The number of the first paddle of a button on each board [world]; −1: it has none.

    Of several paddles of one button the first is the main one; the others move with it.
    """
    found = np.full(len(boards), -1)
    for number in reversed(range(int(boards["paddles"].max()))):
        row = boards["collider_first"] + Part.FIRST_PADDLE + np.minimum(number, boards["paddles"] - 1)
        has_it = (number < boards["paddles"]) & (colliders["button"][row] == button)
        found[has_it] = number
    return found


def encode(raw: Rows) -> tuple[Rows, NDArray[np.bool_]]:
    """The input of the network.

    Args:
        raw: Features [row, Raw].

    Returns:
        Features [row, ENCODED]: the raw ones, then places near the paddles magnified; and which rows are
        mirrored, bool [row].
    """
    is_mirrored: NDArray[np.bool_] = raw[:, Raw.Z] > 0.0
    encoded = np.zeros((len(raw), ENCODED))
    encoded[:, : len(Raw)] = raw
    encoded[:, (Raw.Z, Raw.VZ)] *= np.where(is_mirrored, -1.0, 1.0)[:, None]
    encoded[:, LEFT] = np.where(is_mirrored[:, None], raw[:, RIGHT], raw[:, LEFT])
    encoded[:, RIGHT] = np.where(is_mirrored[:, None], raw[:, LEFT], raw[:, RIGHT])
    x, z, vx, vz = encoded[:, Raw.X], encoded[:, Raw.Z], encoded[:, Raw.VX], encoded[:, Raw.VZ]
    is_low = x < LOW
    zoomed = (
        np.clip(ZOOM * (x - PADDLES_AT), -1.2, 1.2),
        np.clip(2.0 * z, -1.2, 1.2),
        np.clip(ZOOM * (z + PIVOT), -1.5, 1.5),
        np.clip(ZOOM * (z - PIVOT), -1.5, 1.5),
        is_low,
        3.0 * vx,
        3.0 * vz,
        3.0 * vx * is_low,
    )
    for number, values in enumerate(zoomed):
        encoded[:, len(Raw) + number] = values
    return encoded, is_mirrored
