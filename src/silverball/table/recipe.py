"""Recipes: which obstacles to place at random for each seed."""

from __future__ import annotations

from typing import Annotated

from pydantic import field_validator

from silverball.table.kinds.cylinder import CylinderSurface
from silverball.table.kinds.triangular_prism import PrismSurface
from silverball.table.model import Model
from silverball.table.primitive import Point
from silverball.table.quantity import POINT, Count, FixedList, Interval, Quantity, refuse, shown


class RandomRecipe(Model):
    """Which obstacles to place at random for each seed, and the rules for placing them."""

    triangular_prisms: Annotated[int, Count(0, 32, "prisms")] = 4
    """Number of triangular prisms."""
    cylinders: Annotated[int, Count(0, 32, "cylinders")] = 3
    """Number of cylinders."""
    prism_size: Annotated[tuple[float, float], Interval(Quantity(0.2, 5.0, "u"))] = (0.8, 1.0)
    """[u] circumradius of a prism, [least, greatest]."""
    cylinder_radius: Annotated[tuple[float, float], Interval(Quantity(0.1, 5.0, "u"))] = (0.5, 0.7)
    """[u] radius of a cylinder, [least, greatest]."""
    area: Annotated[tuple[Point, Point], FixedList(POINT, 2, "[[x, z], [x, z]]")] = ((-2.0, -4.0), (8.5, 4.0))
    """[u] the rectangle for the centres: its lower left and its upper right corner."""
    gap: Annotated[float, Quantity(0.0, 10.0, "u")] = 0.9
    """[u] least free space between the bounding circles of two obstacles; more than a ball."""
    wall_gap: Annotated[float, Quantity(0.0, 10.0, "u")] = 0.9
    """[u] the same from a bounding circle to the surface of any wall and to the turning paddles."""
    rotation: Annotated[tuple[float, float], Interval(Quantity(0.0, 360.0, "deg"))] = (10.0, 80.0)
    """[deg] rotation of a prism, [least, greatest]; every edge also stays 10° off both axes."""
    prism: PrismSurface = PrismSurface()
    """How the prisms bounce a ball."""
    cylinder: CylinderSurface = CylinderSurface()
    """How the cylinders bounce a ball."""

    @field_validator("area")
    @classmethod
    def _has_inside(cls, area: tuple[Point, Point]) -> tuple[Point, Point]:
        (low_x, low_z), (high_x, high_z) = area
        if low_x > high_x or low_z > high_z:
            refuse(
                "must be written [[lower x, left z], [upper x, right z]], "
                f"got {shown([list(point) for point in area])}"
            )
        return area
