"""Targets, which stand, and drop targets, which fall when they are hit."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Line, Solid
from silverball.table.model import (
    SINCE_2,
    Falloff,
    HitSpeed,
    Points,
    Restitution,
    SineCosine,
    Thickness,
    libm,
)
from silverball.table.primitive import Finish, Primitive
from silverball.table.quantity import Quantity


class Target(Line, Solid):
    """A target that stands: a hit gives its points, and it gives way a little."""

    thickness: Thickness = 0.08
    """[u] from the line between the ends to the surface, on both sides and around the ends."""
    hit_speed: Annotated[HitSpeed, SINCE_2] = 1.0
    """[u/s] an impact above it is a hit, below it a touch."""
    restitution: Restitution = 0.4
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.027
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    points: Points = 250
    """Points for a hit."""

    own_finish = Finish.TARGET

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one capsule."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.CAPSULE,
                (self.start, self.end),
                self.thickness,
                surface=self.surface(),
                finish=self.shown_finish,
                levels=self.all_levels,
            ),
        )


class DropTarget(Target):
    """A target that falls when it is hit; the targets of one bank come back together.

    They come back some time after the last of the bank has fallen, and never while a ball is in the way.
    """

    bank: Annotated[str, Field(max_length=80)] = ""
    """The bank to which it belongs; without one it is a bank of its own."""
    reset_after: Annotated[float, Quantity(0.05, 600.0, "s")] = 1.0
    """[s] from the fall of the last one of the bank to its return; of a bank the longest time counts."""
    restitution: Restitution = 0.35
    """Restitution at a slow contact."""
    points: Points = 500
    """Points for a hit."""

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one capsule with a switch."""
        return tuple(
            primitive._replace(bank=self.bank, reset_after=self.reset_after)
            for primitive in super().primitives(board, sine_cosine)
        )
