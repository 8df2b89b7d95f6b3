"""Observations: the slots of a state, their spaces, and views of raw rows and pictures.

A state observation is one row of 32-bit floats, ordered by group, then item, then slot. All values lie in
−1 … 1. Slots of absent parts (no second ball, no paddle on that side)
are 0.

Positions are in half board lengths and widths: x = 1 is the top, x = −1 the bottom, z = −1 the left border,
z = 1 the right one. Parts that are the same on all boards of a recipe (borders, slant walls) are left out.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.options import Options
from silverball.envs.state import BALL_COUNT


class BallSlot(IntEnum):
    """Slots of a ball."""

    ALIVE = 0
    X = 1
    Z = 2
    VX = 3
    VZ = 4


class PaddleSlot(IntEnum):
    """Slots of a paddle."""

    ANGLE = 0
    TURN = 1
    HELD = 2


class GameSlot(IntEnum):
    """Slots of the game."""

    PATIENCE = 0
    LEFT = 1


class PrismSlot(IntEnum):
    """Slots of a triangular prism: its corners, counter-clockwise."""

    X1 = 0
    Z1 = 1
    X2 = 2
    Z2 = 3
    X3 = 4
    Z3 = 5


class CylinderSlot(IntEnum):
    """Slots of a cylinder."""

    X = 0
    Z = 1
    RADIUS = 2


class Group(NamedTuple):
    """A group of items with the same slots.

    Attributes:
        name: Key in a dict observation.
        item: Name of one item.
        slots: The slots of an item.
        means: Least value (the greatest is 1) and meaning of each slot.
    """

    name: str
    item: str
    slots: type[IntEnum]
    means: tuple[tuple[float, str], ...]


GROUPS = (
    Group(
        "balls",
        "a ball",
        BallSlot,
        (
            (0.0, "1 while the ball is on the board; if 0, all five are 0"),
            (-1.0, "position up the table, in half board lengths"),
            (-1.0, "position to the right, in half board widths"),
            (-1.0, "velocity up the table, in speed caps"),
            (-1.0, "velocity to the right, in speed caps"),
        ),
    ),
    Group(
        "paddles",
        "the left, then the right paddle",
        PaddleSlot,
        (
            (0.0, "angle: 0 at rest, 1 up"),
            (-1.0, "angular velocity, in that of the faster stroke; lifting is positive"),
            (0.0, "1 while its button is held"),
        ),
    ),
    Group(
        "game",
        "the game",
        GameSlot,
        (
            (
                0.0,
                "remaining share of the time for a scoring hit: 1 just after one; at 0 the ball is stalled",
            ),
            (0.0, "balls of the episode that have not been created yet, as a share of all"),
        ),
    ),
    Group(
        "triangular_prisms",
        "a triangular prism",
        PrismSlot,
        (
            (-1.0, "first corner, up the table"),
            (-1.0, "first corner, to the right"),
            (-1.0, "second corner (counter-clockwise), up the table"),
            (-1.0, "second corner, to the right"),
            (-1.0, "third corner, up the table"),
            (-1.0, "third corner, to the right"),
        ),
    ),
    Group(
        "cylinders",
        "a cylinder",
        CylinderSlot,
        (
            (-1.0, "centre, up the table"),
            (-1.0, "centre, to the right"),
            (0.0, "radius, in half board widths"),
        ),
    ),
)
"""All groups, in the order of an observation."""

# First columns of the first three groups, the same for every table, and of the groups of the board.
BALLS = 0
PADDLES = BALLS + BALL_COUNT * len(BallSlot)
GAME = PADDLES + 2 * len(PaddleSlot)
LAYOUT = GAME + len(GameSlot)


class Field(NamedTuple):
    """A group in the observations of one pool: columns first … end − 1, shape [item, slot]."""

    group: Group
    first: int
    items: int

    @property
    def shape(self) -> tuple[int, int]:
        """[item, slot]."""
        return self.items, len(self.group.slots)

    @property
    def end(self) -> int:
        """One past the last column."""
        return self.first + self.items * len(self.group.slots)


def fields(prisms: int, cylinders: int) -> tuple[Field, ...]:
    """The fields of all groups for boards with at most this many prisms and cylinders."""
    found: list[Field] = []
    first = 0
    for group, items in zip(GROUPS, (BALL_COUNT, 2, 1, prisms, cylinders), strict=True):
        found.append(Field(group, first, items))
        first = found[-1].end
    return tuple(found)


def _bounds(field: Field) -> tuple[Any, Any]:
    """The least and the greatest values of a group, float32 [item, slot] each."""
    low = np.tile(np.array([least for least, _ in field.group.means], np.float32), (field.items, 1))
    return low, np.ones_like(low)


def observation_space(options: Options, layout: tuple[Field, ...]) -> spaces.Space[Any]:
    """The space of one environment's observations."""
    if options.observation == "pixels":
        return spaces.Box(0, 255, picture_shape(options), np.uint8)
    boxes = {field.group.name: spaces.Box(*_bounds(field)) for field in layout if field.items}
    if options.observation == "dict":
        return spaces.Dict(dict[str, spaces.Space[Any]](boxes))
    low = np.concatenate([box.low.reshape(-1) for box in boxes.values()])
    high = np.concatenate([box.high.reshape(-1) for box in boxes.values()])
    return spaces.Box(low, high)


def picture_shape(options: Options) -> tuple[int, ...]:
    """[stacked, row, column, channel], without a stack of one picture and a single channel."""
    stack = (options.stack,) if options.stack > 1 else ()
    return (*stack, *options.size, *((3,) if options.rgb else ()))


def as_observations(options: Options, layout: tuple[Field, ...], rows: NDArray[Any]) -> Any:
    """Raw rows [env, …] as a batch of observations; views of the rows."""
    count = len(rows)
    if options.observation == "pixels":
        return rows.reshape(count, *picture_shape(options))
    if options.observation == "state":
        return rows
    return {
        field.group.name: rows[:, field.first : field.end].reshape(count, *field.shape)
        for field in layout
        if field.items
    }


def as_observation(options: Options, layout: tuple[Field, ...], row: NDArray[Any]) -> Any:
    """One raw row as an observation; a view of the row."""
    batch = as_observations(options, layout, row[None])
    return {name: part[0] for name, part in batch.items()} if isinstance(batch, dict) else batch[0]
