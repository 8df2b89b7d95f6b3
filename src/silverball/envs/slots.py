"""What stands where in a state observation? The one table that the code, the spaces and the documents read.

A state observation is one row of 32-bit floats: group after group, in each group item after item, in each
item slot after slot. All values lie in −1 … 1. Whatever is absent (no second ball, no paddle on that side)
is zeros.

Places are shares of half the board: x = 1 is the top, x = −1 the bottom, z = −1 the left border, z = 1 the
right one. What stands still and is the same on all boards of a recipe (borders, slant walls) is not shown.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from silverball.physics.records import BALL_COUNT


class BallSlot(IntEnum):
    """What is shown of a ball."""

    ALIVE = 0
    X = 1
    Z = 2
    VX = 3
    VZ = 4


class PaddleSlot(IntEnum):
    """What is shown of a paddle."""

    ANGLE = 0
    TURN = 1
    HELD = 2


class GameSlot(IntEnum):
    """What is shown of the game."""

    PATIENCE = 0
    LEFT = 1


class PrismSlot(IntEnum):
    """What is shown of a triangular prism: its corners, counter-clockwise."""

    X1 = 0
    Z1 = 1
    X2 = 2
    Z2 = 3
    X3 = 4
    Z3 = 5


class CylinderSlot(IntEnum):
    """What is shown of a cylinder."""

    X = 0
    Z = 1
    RADIUS = 2


class Group(NamedTuple):
    """A run of slots.

    Attributes:
        name: Its key in a dict observation.
        item: What one item of it is.
        slots: The slots of an item.
        means: For each slot: the least value it can have (the greatest is 1), and what it means.
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
            (0.0, "1 while the ball is on the board; if 0, all five are"),
            (-1.0, "place up the table, in half board lengths"),
            (-1.0, "place to the right, in half board widths"),
            (-1.0, "speed up the table, in speed caps"),
            (-1.0, "speed to the right, in speed caps"),
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
                "what is left of the time for a scoring hit: 1 just after one, at 0 the ball is stalled",
            ),
            (0.0, "balls still to come after those on the board, as a share of the game's"),
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
"""The table."""

# Where the first three groups begin: they are the same on every table. The boards' groups follow.
BALLS = 0
PADDLES = BALLS + BALL_COUNT * len(BallSlot)
GAME = PADDLES + 2 * len(PaddleSlot)
LAYOUT = GAME + len(GameSlot)


class Field(NamedTuple):
    """A group as it lies in the observations of one recipe: columns first … end − 1, shape [item, slot]."""

    group: Group
    first: int
    items: int

    @property
    def shape(self) -> tuple[int, int]:
        """Items and slots."""
        return self.items, len(self.group.slots)

    @property
    def end(self) -> int:
        """One past the last column."""
        return self.first + self.items * len(self.group.slots)


def fields(prisms: int, cylinders: int) -> tuple[Field, ...]:
    """Where every group lies for boards with so many prisms and cylinders."""
    found: list[Field] = []
    first = 0
    for group, items in zip(GROUPS, (BALL_COUNT, 2, 1, prisms, cylinders), strict=True):
        found.append(Field(group, first, items))
        first = found[-1].end
    return tuple(found)


def bounds(field: Field) -> tuple[Any, Any]:
    """The least and the greatest values of a group, float32 [item, slot] each."""
    low = np.tile(np.array([least for least, _ in field.group.means], np.float32), (field.items, 1))
    return low, np.ones_like(low)


def slot_table(layout: tuple[Field, ...]) -> str:
    """The table in Markdown, a row for each slot."""
    rows = ["| group | columns | slot | range | meaning |", "| --- | --- | --- | --- | --- |"]
    for field in layout:
        count = len(field.group.slots)
        for slot, (least, meaning) in zip(field.group.slots, field.group.means, strict=True):
            first = field.first + slot
            columns = str(first)
            if field.items > 1:
                columns += "".join(f", {first + item * count}" for item in range(1, field.items))
            rows.append(
                f"| `{field.group.name}` | {columns} | `{slot.name.lower()}` | {least:g} … 1 | {meaning} |"
            )
    return "\n".join(rows)
