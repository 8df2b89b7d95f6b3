"""Gates: walls that balls pass in one direction, or that rules open."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Line, Solid
from silverball.table.model import Restitution, SineCosine, Thickness, libm
from silverball.table.primitive import Finish, Point, Primitive
from silverball.table.quantity import refuse

DIRECTIONS: dict[str, Point] = {
    "up": (1.0, 0.0),
    "down": (-1.0, 0.0),
    "left": (0.0, -1.0),
    "right": (0.0, 1.0),
}
"""The directions (x, z) on the board."""

LEAST_SINE = 1e-3  # of the angle between a gate and the direction in which balls pass it


class Gate(Line, Solid):
    """A one-way gate, which balls pass freely in one direction; or a held one, which only rules open."""

    passes: Literal["up", "down", "left", "right"] | None = None
    """The direction in which balls pass it: straight through, to the side that this word names."""
    held: Annotated[bool, Field(strict=True)] = False
    """Whether it stays closed until a rule opens it by its name; it has no `passes` then."""
    thickness: Thickness = 0.05
    """[u] from the line between the ends to the surface, on both sides and around the ends."""
    restitution: Restitution = 0.3
    """Restitution at a slow contact."""

    own_finish = Finish.GATE

    @model_validator(mode="after")
    def _one_way_or_held(self) -> Self:
        if self.held == (self.passes is not None):
            refuse('needs `passes`, for example "up", or `held = true` and a `name`, and not both')
        if self.held and not self.name:
            refuse("must have a `name`, by which rules open it")
        if self.passes is not None and abs(self._across(self.passes)) < LEAST_SINE:
            refuse(f'must not lie along the direction in which balls pass it, "{self.passes}"')
        return self

    def _across(self, direction: str) -> float:
        """The part of a direction to the left of start → end."""
        normal, towards = self.left_normal, DIRECTIONS[direction]
        return normal[0] * towards[0] + normal[1] * towards[1]

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one capsule, one-way or with a switch."""
        del board, sine_cosine
        one_way = None
        if self.passes is not None:
            x, z = self.left_normal
            one_way = (x, z) if self._across(self.passes) > 0.0 else (0.0 - x, 0.0 - z)
        return (
            Primitive(
                Shape.CAPSULE,
                (self.start, self.end),
                self.thickness,
                surface=self.surface(),
                finish=self.shown_finish,
                levels=self.all_levels,
                one_way=one_way,
                is_gate=self.held,
            ),
        )
