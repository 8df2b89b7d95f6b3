"""Posts: small round obstacles with a rubber ring."""

from __future__ import annotations

from typing import Annotated

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Solid
from silverball.table.model import Falloff, Place, Restitution, SineCosine, libm
from silverball.table.primitive import Finish, Primitive
from silverball.table.quantity import Quantity


class Post(Solid):
    """A small round obstacle, with a rubber ring unless its finish says otherwise."""

    center: Place
    """[u] the centre, [x, z]."""
    radius: Annotated[float, Quantity(0.02, 2.0, "u")] = 0.12
    """[u] from the centre to the surface."""
    restitution: Restitution = 0.9
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.005
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""

    own_finish = Finish.RUBBER

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one circle."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.CIRCLE,
                (self.center,),
                self.radius,
                surface=self.surface(),
                finish=self.shown_finish,
                levels=self.all_levels,
            ),
        )
