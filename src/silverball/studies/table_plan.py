"""A table drawn as lines, seen from above, for the maps of a report; what is below it shines through.

Drawings are SVG in units of the table: the left edge of the board is 0, its upper edge is 0.
"""

from __future__ import annotations

import base64
import io
import math
from html import escape

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.game_traces import CELLS
from silverball.physics.forms import Shape
from silverball.table import Table
from silverball.table.expand import expand
from silverball.table.outlines import path
from silverball.table.primitive import Point, Primitive

# The colours of maps, from few to many: dark blue to yellow. Source: J. R. Nuñez, C. R. Anderton,
# R. S. Renslow, "Optimizing colormaps with consideration for color vision deficiency" (2018), cividis.
COLORS = np.array(
    [(0, 34, 78), (33, 59, 110), (76, 85, 108), (108, 109, 114), (142, 137, 120), (178, 167, 111),
     (218, 200, 89), (254, 232, 56)], np.float64,
)  # fmt: skip
PAINTED = (Shape.CIRCLE, Shape.CAPSULE, Shape.ARC, Shape.TRIANGLE, Shape.TAPERED)


class TableMap:
    """Draws maps of one table.

    Args:
        table: The table; of a recipe, its parts that are not random.
    """

    def __init__(self, table: Table) -> None:
        bare = table.model_copy(update={"random": None})
        self._width, self._length = bare.board.width, bare.board.length
        self._parts = "".join(
            self._shape(one, row.name) for row in expand(bare).parts for one in row.primitives
        )

    def draw(self, label: str, below: str = "", above: str = "") -> str:
        """The table with other drawings below and above it.

        Args:
            label: What it shows, for those who cannot see it.
            below: SVG.
            above: SVG.
        """
        width, length = self._width, self._length
        return (
            f'<svg class="table" viewBox="-0.2 -0.2 {width + 0.4:g} {length + 0.4:g}" role="img" '
            f'aria-label="{escape(label)}"><rect class="floor" width="{width:g}" height="{length:g}"/>'
            f'{below}<g class="parts">{self._parts}</g>'
            f'<path class="border" d="M0 {length:g}V0H{width:g}V{length:g}"/>{above}</svg>'
        )

    def heat(self, values: NDArray[np.float64], top: float | None = None) -> str:
        """A map of a value in each cell, [x, z]: transparent where it is 0 or NaN.

        Args:
            values: The values, 0 or more.
            top: The value with the last colour; None: exceeded by one cell in a hundred.
        """
        known = np.nan_to_num(values, nan=0.0)
        seen = known[known > 0.0]
        if len(seen) == 0:
            return ""
        most = float(np.quantile(seen, 0.99)) if top is None else top
        share = np.clip(known / most, 0.0, 1.0)
        place = share * (len(COLORS) - 1)
        low = np.minimum(place.astype(np.int64), len(COLORS) - 2)
        part = (place - low)[..., None]
        rgb = COLORS[low] * (1.0 - part) + COLORS[low + 1] * part
        alpha = np.where(known > 0.0, 235.0, 0.0)
        pixels = np.dstack([rgb, alpha]).round().astype(np.uint8)[::-1]
        rows, columns = values.shape
        return (
            f'<image class="heat" x="0" y="{self._length - rows / CELLS:g}" width="{columns / CELLS:g}" '
            f'height="{rows / CELLS:g}" preserveAspectRatio="none" href="{png(pixels)}"/>'
        )

    def ring(self, x: float, z: float, label: str) -> str:
        """A circle around a place [u], with a label."""
        at = self._at((x, z))
        return (
            f'<circle class="ring" cx="{at[0]:.2f}" cy="{at[1]:.2f}" r="0.5"><title>{escape(label)}</title>'
            "</circle>"
        )

    def _at(self, point: Point) -> Point:
        """A point of the table as (across, down)."""
        return point[1] + 0.5 * self._width, 0.5 * self._length - point[0]

    def _shape(self, one: Primitive, name: str) -> str:
        title = f"<title>{escape(name)}</title>"
        points = placed(one)
        if one.shape == Shape.PLANE:
            return ""
        if one.shape in (Shape.CIRCLE, Shape.DISC):
            x, y = self._at(points[0])
            kind = "" if one.shape == Shape.CIRCLE else ' class="sensor"'
            return f'<circle{kind} cx="{x:.3f}" cy="{y:.3f}" r="{one.radius:g}">{title}</circle>'
        if one.shape == Shape.TRIANGLE:
            return f'<polygon points="{self._listed(points)}">{title}</polygon>'
        if one.shape == Shape.TAPERED:
            return f'<polygon points="{self._listed(hull(points, one))}">{title}</polygon>'
        if one.shape == Shape.LINE:
            return f'<polyline class="sensor" points="{self._listed(points)}">{title}</polyline>'
        along = path(one)
        width = max(2.0 * one.radius, 0.06)
        style = f'class="wall" style="stroke-width:{width:g}"'
        return f'<polyline {style} points="{self._listed(along)}">{title}</polyline>'

    def _listed(self, points: list[Point]) -> str:
        return " ".join("{:.3f},{:.3f}".format(*self._at(point)) for point in points)


def placed(one: Primitive) -> list[Point]:
    """The points of a primitive on the board; of a paddle at rest."""
    if one.mover is None:
        return list(one.points)
    sine, cosine = math.sin(one.mover.rest_angle), math.cos(one.mover.rest_angle)
    x, z = one.mover.pivot
    return [
        (x + across * cosine + along * sine, z + one.mover.direction * (along * cosine - across * sine))
        for across, along in one.points
    ]


def hull(points: list[Point], one: Primitive) -> list[Point]:
    """The outline of a tapered capsule: half a circle around each end."""
    (x, z), (tip_x, tip_z) = points
    ahead = math.atan2(tip_x - x, tip_z - z)
    found = []
    for middle, radius, first in (((tip_x, tip_z), one.tip_radius, -90.0), ((x, z), one.radius, 90.0)):
        for step in range(13):
            angle = ahead + math.radians(first + 15.0 * step)
            found.append((middle[0] + radius * math.sin(angle), middle[1] + radius * math.cos(angle)))
    return found


def png(pixels: NDArray[np.uint8]) -> str:
    """A picture, uint8 [row, column, 3 or 4], as an address that holds it."""
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).save(file, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
