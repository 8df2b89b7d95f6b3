"""Levels above the playfield, and the passages between them."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from silverball.physics.forms import Response, Shape
from silverball.table.kinds.board import LEVELS, Board
from silverball.table.kinds.part import LevelNumber, Line, Scored
from silverball.table.model import Model, Name, Points, SineCosine, libm
from silverball.table.primitive import Finish, Point, Primitive, Surface
from silverball.table.quantity import Count, FixedList, Quantity, refuse

_GRAVITY = FixedList(Quantity(-100.0, 100.0, "u/s²"), 2, "[gx, gz]")


class Level(Model):
    """A level above the playfield, for example of a ramp: parts and balls on different levels do not meet."""

    name: Name = ""
    """A name for people and rules."""
    number: Annotated[int, Count(1, LEVELS - 1)]
    """The number by which parts name it; the playfield is level 0."""
    gravity: Annotated[Point, _GRAVITY] | None = None
    """[u/s²] acceleration of a sliding ball on it, [gx, gz]; by default as on the playfield."""


class Passage(Line, Scored):
    """A line at which a ball changes its level: where a ramp begins or ends.

    A ball that crosses it to the left of start → end changes from one level to the other; a ball that crosses
    it to the right changes back. The line counts up to a ball's radius beyond both ends; between two rails
    let it end a radius before them. Where something is in the way on the other level, a ball is thrown back.
    """

    from_level: Annotated[LevelNumber, Field(alias="from")]
    """The level to the right of start → end, from which a ball comes."""
    to_level: Annotated[LevelNumber, Field(alias="to")]
    """The level to the left of start → end, to which it goes."""
    points: Points = 0
    """Points for a crossing that changes the level."""

    @model_validator(mode="after")
    def _changes_levels(self) -> Self:
        if self.level or self.levels is not None:
            refuse("must not have `level` or `levels`: it is on its two levels, `from` and `to`")
        if self.from_level == self.to_level:
            refuse(f"must lead to another level, got from = {self.from_level} and to = {self.to_level}")
        return self

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one line that a ball passes; it is on both of its levels."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.LINE,
                (self.start, self.end),
                response=Response.PASS,
                surface=Surface(points=self.worth),
                finish=Finish.RAMP,
                levels=tuple(sorted({self.from_level, self.to_level})),
                passage=(self.from_level, self.to_level),
            ),
        )
