"""What is a scene made of? The records, numbers and colours that the drawing's kernels pass around.

Lengths [u], x up the table, y out of the board from the playfield on, z to the player's right. Colours are
linear light, not the screen's values.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = tuple[float, float, float]
"""x, y, z [u], or a direction."""

Box: TypeAlias = tuple[int, int, int, int]
"""Left, top, right and bottom [pixel] of a rectangle; right and bottom are excluded."""

FLOOR, RAIL, APRON, ROOM = -1, -2, -3, -4
"""Numbers of what a ray can meet apart from the table's parts, which are numbered from 0."""

CELL = 0.5  # [u] side of a cell at least
MAX_CELLS = 128  # along the longer side
NEAR = 1.0  # [u] a cell lists all parts within this distance of any of its points, for marching
HALO = 2.4  # [u] no part lights up anything farther away than this, for shading
LIGHT = (
    0.75,
    0.66143782776614768,
)  # towards the lamp: x and y of a unit vector; z is 0, so that both sides are lit alike


class Form(IntEnum):
    """What a part is built as."""

    ABSENT = 0
    WALL = 1  # a bar with a round top
    CORNER = 2  # the filled corner behind a slant wall
    PRISM = 3
    CYLINDER = 4
    PADDLE = 5


class Ink(IntEnum):
    """The rows of a scene's colours."""

    ROOM = 0
    FLOOR_LOW = 1
    FLOOR_MIDDLE = 2
    FLOOR_HIGH = 3
    RAY = 4
    GLOW = 5
    ORNAMENT = 6
    ORNAMENT_2 = 7
    HEART = 8
    RAIL = 9
    WALL = 10
    APRON = 11
    LABEL = 12
    STRIP = 13
    STRIP_2 = 14
    PADDLE_EDGE = 15
    CAP = 16
    STEEL = 17
    SKY = 18
    SKY_LOW = 19


class Art(IntEnum):
    """What is painted onto the playfield."""

    COSMOS = 0  # rays, clouds of stars, planets
    WOOD = 1  # veneer with a compass rose
    PLAIN = 2  # a calm ground with few lines


class Frame(IntEnum):
    """What rails and slant walls are made of."""

    METAL = 0
    WOOD = 1


SOLID = np.dtype(
    [
        ("form", "i8"),
        ("height", "f8"), ("bevel", "f8"),  # [u] of the top, and of its rounded edge
        ("red", "f8"), ("green", "f8"), ("blue", "f8"),
        ("sine", "f8"), ("cosine", "f8"), ("side", "f8"),  # of a paddle: its angle; +1 left, −1 right
        ("glow", "f8"),  # how strongly it lights up what is around it
    ],
    align=True,
)  # fmt: skip

STAGE = np.dtype(
    [
        ("half_length", "f8"), ("half_width", "f8"), ("thickness", "f8"), ("rail", "f8"),
        ("rail_height", "f8"), ("apron_height", "f8"), ("apron_top", "f8"), ("top", "f8"), ("unit", "f8"),
        ("art", "i8"), ("frame", "i8"),
        ("exposure", "f8"), ("key", "f8"), ("fill", "f8"), ("lacquer", "f8"), ("halo", "f8"),
        ("cap_ground", "f8"),
        ("light_x", "f8"), ("light_y", "f8"),
        ("low_x", "f8"), ("low_z", "f8"), ("cell_scale", "f8"), ("rows", "i8"), ("columns", "i8"),
        # The camera, see camera.py
        ("eye_x", "f8"), ("eye_y", "f8"), ("sine", "f8"), ("cosine", "f8"), ("focal", "f8"),
        ("across", "f8"), ("down", "f8"),
        ("pixel", "f8"),  # [u] about the size of a pixel on the board
    ],
    align=True,
)  # fmt: skip


class Scene(NamedTuple):
    """A table, ready to be marched.

    Attributes:
        stage: One STAGE record.
        solids: SOLID records, shape [part].
        shapes: COLLIDER records, shape [part].
        inks: Linear colours, float64 [Ink, 3].
        near: Which parts to march in each cell: where its list begins, then the lists, int32.
        lit: The same for the parts that light up a cell.
        label: Brightness of the lettering on the apron, float32 [row, column].
    """

    stage: NDArray[Any]
    solids: NDArray[Any]
    shapes: NDArray[Any]
    inks: NDArray[np.float64]
    near: NDArray[np.int32]
    lit: NDArray[np.int32]
    label: NDArray[np.float32]
