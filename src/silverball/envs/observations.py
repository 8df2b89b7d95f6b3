"""Observations: the slots of a state, their spaces, and views of raw rows and pictures.

A state observation is one row of 32-bit floats, ordered by group, then item, then slot. All values lie in
−1 … 1. There are slots for at least two balls and two paddles; those of absent ones are 0.

Positions are in half board lengths and widths: x = 1 is the top, x = −1 the bottom, z = −1 the left border,
z = 1 the right one. Parts that are the same on all boards of a recipe (borders, slant walls) are left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.options import Options


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


class PlaceSlot(IntEnum):
    """Slots of a ball on tables with levels, holes or plungers."""

    LEVEL = 0
    HELD = 1


class SwitchSlot(IntEnum):
    """Slots of a drop target or a gate."""

    PRESENT = 0


class SpinnerSlot(IntEnum):
    """Slots of a spinner."""

    SPEED = 0


class PlungerSlot(IntEnum):
    """Slots of the plunger."""

    CHARGE = 0


class SupplySlot(IntEnum):
    """Slots of the power supply of the coils."""

    CHARGE = 0


class PlaySlot(IntEnum):
    """Slots of a game by the rules of its table."""

    SCORE = 0
    BALL = 1
    IN_PLAY = 2
    SAVED = 3
    WARNINGS = 4
    TILTED = 5
    EXTRA_BALLS = 6
    LOCKED = 7
    COMBO = 8


class LampSlot(IntEnum):
    """Slots of a lamp."""

    LIT = 0
    BLINKING = 1


class CounterSlot(IntEnum):
    """Slots of a counter."""

    VALUE = 0


class ModeSlot(IntEnum):
    """Slots of a mode."""

    RUNNING = 0
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
        "a paddle: the left one, the right one, then the others in the order of the table",
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
        "ball_places",
        "a ball; on tables with levels, holes or plungers",
        PlaceSlot,
        (
            (0.0, "the level of the ball, as a share of the highest possible one"),
            (0.0, "1 while a hole or a plunger holds it"),
        ),
    ),
    Group(
        "switches",
        "a drop target or a gate that rules open, in the order of the table",
        SwitchSlot,
        ((0.0, "1 while it stands in the way of balls; 0 if it has fallen or is open"),),
    ),
    Group(
        "spinners",
        "a spinner, in the order of the table",
        SpinnerSlot,
        ((-1.0, "speed of the blade's edge, in speed caps; positive to the left of start → end"),),
    ),
    Group(
        "plunger",
        "the plunger, on tables that have one",
        PlungerSlot,
        ((0.0, "how far it is pulled back: 1 launches at the greatest speed"),),
    ),
    Group(
        "supply",
        "the power supply of the coils, with `recharge`",
        SupplySlot,
        ((0.0, "how far it is charged: only at 1 a paddle can be lifted"),),
    ),
    Group(
        "play",
        "the arcade game, with `rules=True`",
        PlaySlot,
        (
            (0.0, "the score s as s / (s + g), where g are the points of the gold medal, or 100,000 without"),
            (0.0, "the number of the present ball, as a share of all"),
            (0.0, "balls in play, as a share of the most that the table holds"),
            (0.0, "time in which a lost ball comes back, in that of the ball save; the most of all balls"),
            (0.0, "warnings of this ball, as a share of those before a tilt"),
            (0.0, "1 while the table is tilted: paddles are dead, and no rule acts"),
            (0.0, "extra balls e, as e / (e + 1)"),
            (0.0, "locked balls n, as n / (n + 1)"),
            (0.0, "what a combo pays: 0 once, 1 the greatest factor"),
        ),
    ),
    Group(
        "lamps",
        "a lamp, in the order of the table; with `rules=True`",
        LampSlot,
        ((0.0, "1 while it is lit, on or blinking"), (0.0, "1 while it is blinking")),
    ),
    Group(
        "counters",
        "a counter, in the order of the table; with `rules=True`",
        CounterSlot,
        (
            (
                0.0,
                "its value, as a share of the greatest one that it can have or that rules wait for; "
                "of others v / (v + 10 a), where a is the most that a rule adds",
            ),
        ),
    ),
    Group(
        "modes",
        "a mode, in the order of the table; with `rules=True`",
        ModeSlot,
        (
            (0.0, "1 while it runs"),
            (0.0, "its time left, as a share of its time, at most 1; 1 without an end"),
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

LEAST_BALLS = LEAST_PADDLES = 2
"""Balls and paddles that every observation has slots for."""


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


def fields(items: Mapping[str, int]) -> tuple[Field, ...]:
    """The fields of all groups, for boards with at most this many items of each; a group may have none."""
    found: list[Field] = []
    first = 0
    for group in GROUPS:
        found.append(Field(group, first, items.get(group.name, 0)))
        first = found[-1].end
    return tuple(found)


def with_items(layout: tuple[Field, ...], name: str, items: int) -> tuple[Field, ...]:
    """The fields with this many items of one group; the columns behind it move."""
    return fields({field.group.name: field.items for field in layout} | {name: items})


def field_named(layout: tuple[Field, ...], name: str) -> Field:
    """The field of the group with this name."""
    return next(field for field in layout if field.group.name == name)


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
    """The shape of a picture observation.

    [stacked, row, column, channel], without a stack of one picture and a single channel; or with `channels`
    [row, column] and one axis, first or last, for all channels of all pictures.
    """
    depth = options.stack * (3 if options.rgb else 1)
    if options.channels is not None:
        return (depth, *options.size) if options.channels == "first" else (*options.size, depth)
    stack = (options.stack,) if options.stack > 1 else ()
    return (*stack, *options.size, *((3,) if options.rgb else ()))


def _as_pictures(options: Options, rows: NDArray[Any]) -> NDArray[Any]:
    """Rows [env, …] of pictures in their shape; views, but for an axis of both pictures and colours."""
    if options.channels is None:
        return rows.reshape(len(rows), *picture_shape(options))
    height, width = options.size
    colors = 3 if options.rgb else 1
    pictures = np.moveaxis(rows.reshape(len(rows), options.stack, height, width, colors), 4, 2)
    if options.channels == "first":
        return pictures.reshape(len(rows), -1, height, width)
    return pictures.transpose(0, 3, 4, 1, 2).reshape(len(rows), height, width, -1)


def as_observations(options: Options, layout: tuple[Field, ...], rows: NDArray[Any]) -> Any:
    """Raw rows [env, …] as a batch of observations; views of the rows."""
    count = len(rows)
    if options.observation == "pixels":
        return _as_pictures(options, rows)
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
