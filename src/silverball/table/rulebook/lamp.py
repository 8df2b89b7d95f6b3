"""Lamps: what the table has painted in front of a shot, and rules light."""

from __future__ import annotations

from typing import Annotated, Literal

from silverball.table.model import SINCE_2, Model, Name, Place
from silverball.table.quantity import Quantity
from silverball.table.rulebook.names import OwnName, Span

LampShape = Literal["round", "square", "bar", "triangle", "arrow", "star"]
LampColor = Literal[
    "auto", "mode", "white", "yellow", "orange", "red", "pink", "violet", "blue", "cyan", "green"
]


class Lamp(Model):
    """A lamp: off, on or blinking. On and blinking are both called *lit*.

    Lamps of one group are named together by the name of the group, in the order of the file: lit, rotated,
    and complete when all of them are on.
    """

    name: OwnName
    """The name by which rules speak of it; no other lamp and no group has it."""
    group: Name = ""
    """The group to which it belongs, if any."""
    center: Place | None = None
    """[u] where it lies on the playfield, [x, z]; without it the lamp is on the display only."""
    shape: Annotated[LampShape, SINCE_2] = "round"
    """The lens in the playfield."""
    size: Annotated[float, Quantity(0.05, 2.0, "u"), SINCE_2] = 0.22
    """[u] the radius of the lens: no point of it is farther from its center."""
    angle: Annotated[float, Quantity(-180.0, 180.0, "deg"), SINCE_2] = 90.0
    """[deg] to where an arrow, a triangle or a star points, and how a bar lies; 90 is up the table."""
    color: Annotated[LampColor, SINCE_2] = "auto"
    """Its light; "auto" is a color of the theme, the same for all lamps of a group; "mode" is that of the
    first mode that runs and has a color, or else white."""
    begins: Literal["off", "on", "blinking"] = "off"
    """Its state at the start of a game, and of each ball if it lasts for a ball."""
    lasts: Span = "ball"
    """Whether it keeps its state until the ball is lost, or until the game is over."""
