"""Records, numbers and colours of a scene, shared by all kernels of the drawing.

Lengths [u], x up the table, y out of the board from the playfield on, z to the player's right. Colours are
linear light, not the screen's values.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

RAYS = 22  # of the playfield
EMBLEM_AT = -0.05  # x where the rays meet, as a fraction of the board's length
EMBLEM_SIZE = 0.105  # radius of the emblem, as a fraction of the board's width
RING_AT = 0.27  # [u] from a cylinder to the ring of light around it

Vector: TypeAlias = tuple[float, float, float]
"""x, y, z [u], or a direction."""

Box: TypeAlias = tuple[int, int, int, int]
"""Left, top, right and bottom [pixel] of a rectangle; right and bottom are excluded."""

# Arguments of kernels, whose types Numba checks; to mypy they are Any.
StageRecord: TypeAlias = Any  # a STAGE record
SolidRecord: TypeAlias = Any  # a SOLID record
InsertRecord: TypeAlias = Any  # an INSERT record
Records: TypeAlias = Any  # an array of records, shape [solid], or [1] for a stage
Corners: TypeAlias = Any  # corners of polygons (x, z) [u], float64 [corner, 2]
Inks: TypeAlias = Any  # linear colours, float64 [Ink, 3]
Pixels: TypeAlias = Any  # RGB, uint8 or float32 [row, column, 3]
Heights: TypeAlias = Any  # [u] above the playfield, float32 [row, column]
Spots: TypeAlias = Any  # place, radius [u] and colour, float64 [spot, 7]
Boxes: TypeAlias = Any  # numbers by lamp, int64, see `relight`
Cells: TypeAlias = Any  # a grid of parts, int32, see `list_cells`

FLOOR, RAIL, APRON, ROOM = -1, -2, -3, -4
"""Numbers of what a ray can meet apart from the solids, which are numbered from 0."""

CELL = 0.5  # [u] least side of a cell
MAX_CELLS = 128  # along the longer side
NEAR = 1.0  # [u] solids within this distance are listed in a cell, for marching
NEAR_IF_MANY = 0.5  # [u] the same in a scene of more than `MANY` solids, whose lists would be long
MANY = 100
HALO = 2.4  # [u] parts light up nothing farther away than this, for shading
LIGHT = (0.75, 0.66143782776614768)
"""Direction to the lamp: x and y of a unit vector; z is 0, so that both sides are lit alike."""


class Outline(IntEnum):
    """The footprint of a solid, or how else it is bounded."""

    ABSENT = 0
    CIRCLE = 1
    CAPSULE = 2  # a segment with a radius
    TRIANGLE = 3
    TAPERED = 4  # a capsule with two radii
    ARC = 5  # with a radius
    POLYGON = 6  # the area within a closed wall, whose edges are solids of their own
    PLATE = 7  # a thin plate that turns about a horizontal axis above a segment


class Material(IntEnum):
    """How a surface is built and painted."""

    PLAIN = 0  # one colour, such as the filled corner behind a slant wall
    BAR = 1  # a bar of metal or wood with a tube of light at its foot
    ACRYLIC = 2  # lit from inside, bright at its edges
    BUMPER = 3  # a lit body, a steel ring, a cap with a star
    PADDLE = 4  # a plate with a rubber around it and a bolt
    STEEL = 5
    TIMBER = 6
    PLASTIC = 7  # a printed plate
    RUBBER = 8
    TARGET = 9  # a coloured face with a white edge
    INSERT = 10  # a lens in the playfield
    PIT = 11  # a hole in the playfield with a steel rim
    BLADE = 12  # a plate with a coloured stripe on either side
    MOUTH = 13  # arrows in the playfield


class Lens(IntEnum):
    """The shape of an insert."""

    ROUND = 0
    SQUARE = 1
    BAR = 2
    TRIANGLE = 3
    ARROW = 4
    STAR = 5


class Ink(IntEnum):
    """Rows of a scene's colours."""

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
    """The painting on the playfield."""

    COSMOS = 0  # rays, clouds of stars, planets
    WOOD = 1  # veneer with a compass rose
    PLAIN = 2  # a calm ground with few lines


class Frame(IntEnum):
    """The material of rails and slant walls."""

    METAL = 0
    WOOD = 1


SOLID = np.dtype(
    [
        ("outline", "i8"), ("material", "i8"),
        ("group", "i8"),  # solids of one part follow each other and have one number; they glow as one
        # The footprint, in the fields of a COLLIDER (see physics/records.py)
        ("x", "f8"), ("z", "f8"), ("reach", "f8"),  # a circle around it; a paddle's is around its pivot
        ("cull", "f8"), ("top", "f8"),  # [u] radius around (x, z) and height beyond which no surface is
        ("radius", "f8"), ("tip_radius", "f8"),
        ("x0", "f8"), ("z0", "f8"), ("x1", "f8"), ("z1", "f8"), ("x2", "f8"), ("z2", "f8"),
        ("along_x0", "f8"), ("along_z0", "f8"), ("along_x1", "f8"), ("along_z1", "f8"),
        ("along_x2", "f8"), ("along_z2", "f8"),
        ("length0", "f8"), ("length1", "f8"), ("length2", "f8"),
        ("inward_x", "f8"), ("inward_z", "f8"),  # normal of a segment; unit direction to an arc's middle
        ("arc_cosine", "f8"),  # of half the angle of an arc
        ("first", "i8"), ("end", "i8"),  # corners of a polygon among the scene's corners
        # The body above it
        ("base", "f8"), ("height", "f8"), ("bevel", "f8"),  # [u] its underside, its top, its rounded edge
        ("turns", "i8"),  # 1: the footprint is in the frame of a paddle that turns about (x, z)
        ("sine", "f8"), ("cosine", "f8"), ("side", "f8"),  # of its angle; +1 left, −1 right
        ("bolt", "f8"),  # [u] size of the bolt over its pivot
        ("low", "f8"), ("high", "f8"), ("thin", "f8"),  # [u] a plate: from its axis; half its thickness
        # The look
        ("red", "f8"), ("green", "f8"), ("blue", "f8"),
        ("glow", "f8"),  # strength of the light on its surroundings
        ("tube", "f8"),  # strength of the tube of light at its foot
    ],
    align=True,
)  # fmt: skip

INSERT = np.dtype(
    [
        ("shape", "i8"),  # Lens
        ("is_painted", "i8"),  # 0: another light of the lens before it
        ("x", "f8"), ("z", "f8"), ("size", "f8"),  # [u] its middle and its radius
        ("sine", "f8"), ("cosine", "f8"),  # where it points: x and z of a unit vector
        ("red", "f8"), ("green", "f8"), ("blue", "f8"),
    ],
    align=True,
)  # fmt: skip
"""The lens of a lamp in the playfield, with the colour of its light."""

STAGE = np.dtype(
    [
        ("half_length", "f8"), ("half_width", "f8"), ("thickness", "f8"), ("rail", "f8"),
        ("rail_height", "f8"), ("apron_height", "f8"), ("apron_top", "f8"), ("top", "f8"), ("unit", "f8"),
        ("near", "f8"),  # [u] solids farther away than this are not listed, for marching
        ("art", "i8"), ("frame", "i8"),
        ("has_lamps", "i8"),  # whether lamps stand for the inserts that are else painted
        ("exposure", "f8"), ("key", "f8"), ("fill", "f8"), ("lacquer", "f8"), ("halo", "f8"),
        ("cap_ground", "f8"),
        ("light_x", "f8"), ("light_y", "f8"),
        ("low_x", "f8"), ("low_z", "f8"), ("cell_scale", "f8"), ("rows", "i8"), ("columns", "i8"),
        # The camera, see camera.py
        ("eye_x", "f8"), ("eye_y", "f8"), ("sine", "f8"), ("cosine", "f8"), ("focal", "f8"),
        ("across", "f8"), ("down", "f8"),
        ("pixel", "f8"),  # [u] size of a pixel in the middle of the board
    ],
    align=True,
)  # fmt: skip


class Scene(NamedTuple):
    """A table as arrays, for ray marching.

    Attributes:
        stage: One STAGE record.
        solids: SOLID records, shape [solid].
        corners: The corners of polygons (x, z) [u], float64 [corner, 2].
        inks: Linear colours, float64 [Ink, 3].
        near: The grid of the solids to march in each cell, see `list_cells`.
        lit: The grid of the solids that light up a cell.
        label: Brightness of the lettering on the apron, float32 [row, column].
        inserts: INSERT records, shape [light].
    """

    stage: NDArray[Any]
    solids: NDArray[Any]
    corners: NDArray[np.float64]
    inks: NDArray[np.float64]
    near: NDArray[np.int32]
    lit: NDArray[np.int32]
    label: NDArray[np.float32]
    inserts: NDArray[Any]
