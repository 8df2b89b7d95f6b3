"""Tables on which a game ends soon."""

from __future__ import annotations

from silverball.table import Board, Cylinder, Table


def leaky() -> Table:
    """A table that drains every ball within seconds: no paddles, and a row of cylinders that score."""
    return Table(
        name="Leaky",
        board=Board(gravity=40.0),
        cylinder=tuple(Cylinder(center=(-2.0, z), radius=1.15) for z in (-3.2, 0.0, 3.2)),
    )
