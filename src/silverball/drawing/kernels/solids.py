"""Distances to parts: the footprints of the physics extruded to a height, and the grid of nearby parts.

A footprint gives the distance a in the plane, the height the distance b = y − height above it. A body with an
edge rounded by r is

    d = |max(a + r, b + r, 0)| + min(max(a + r, b + r), 0) − r        (|…| of the two clipped components)

which never exceeds the true distance, so a ray that advances by it cannot pass through a body. Bodies have no
underside: they continue below the playfield.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.stage import Cells, Form, Records, ShapeRecord, SolidRecord, StageRecord
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.shapes import distance as shape_distance, triangle_distance

CAP_SHARE = 0.9  # radius of a cylinder's cap by that of the cylinder
CAP_RISE = 0.42  # height of the cap by its radius
RING = 0.075  # [u] radius of the steel ring at the top of a cylinder's body, for a ball of the usual size


@inlined
def extruded_distance(a: float, y: float, height: float, bevel: float) -> float:
    """Return the distance from a body of a height whose footprint is at distance a."""
    across = a + bevel
    up = y - height + bevel
    if across > 0.0 and up > 0.0:
        return sqrt(across * across + up * up) - bevel
    return max(across, up) - bevel


@internal
def footprint_distance(solid: SolidRecord, c: ShapeRecord, x: float, z: float) -> float:
    """Return the distance from a part's footprint in the plane, as the physics computes it."""
    if solid.form == Form.PADDLE:  # in its own frame (see physics/paddle.py)
        rx = x - c.x
        rz = solid.side * (z - c.z)
        gap, _, _ = triangle_distance(
            c, rx * solid.cosine - rz * solid.sine, rx * solid.sine + rz * solid.cosine
        )
        return gap
    gap, _, _ = shape_distance(c, x, z)
    return gap


@internal
def part_distance(solid: SolidRecord, c: ShapeRecord, x: float, y: float, z: float) -> float:
    """Return the distance of a point from a part."""
    a = footprint_distance(solid, c, x, z)
    d = extruded_distance(a, y, solid.height, solid.bevel)
    if solid.form == Form.CYLINDER:
        d = min(d, _cap_distance(solid, c, a, y))
    elif solid.form == Form.PADDLE:  # the bolt it turns on
        d = min(d, _bolt_distance(solid, c, x, y, z))
    return d


@inlined
def _cap_distance(solid: SolidRecord, c: ShapeRecord, a: float, y: float) -> float:
    """Distance from a cylinder's cap, a slice of a sphere, and the steel ring around it."""
    unit = solid.height / 0.38
    rho = a + c.radius
    ring_across = rho - (c.radius - RING * unit)
    ring_up = y - solid.height
    ring = sqrt(ring_across * ring_across + ring_up * ring_up) - RING * unit
    wide = CAP_SHARE * c.radius
    rise = min(CAP_RISE * wide, 0.45 * unit)
    sphere = (wide * wide + rise * rise) / (2.0 * rise)
    up = y - (solid.height + rise - sphere)
    cap = max(sqrt(rho * rho + up * up) - sphere, solid.height - y)
    crown: float = min(ring, cap)
    return crown


@inlined
def _bolt_distance(solid: SolidRecord, c: ShapeRecord, x: float, y: float, z: float) -> float:
    """Distance from the flat dome over the pivot of a paddle."""
    size = min(0.36 * (c.x2 - c.x0), 0.3 * solid.height / 0.33)
    rx = x - c.x - 0.42 * size * solid.sine
    rz = z - c.z - 0.42 * size * solid.cosine * solid.side
    up = 2.0 * (y - solid.height)
    bolt: float = 0.5 * (sqrt(rx * rx + rz * rz + up * up) - size)
    return bolt


@inlined
def rail_footprint(s: StageRecord, x: float, z: float) -> float:
    """Distance in the plane from the frame around the board: negative inside its wood."""
    inner_x = max(x - (s.half_length - s.thickness), -s.half_length - x)
    inner_z = abs(z) - (s.half_width - s.thickness)
    if inner_x > 0.0 and inner_z > 0.0:
        inner = sqrt(inner_x * inner_x + inner_z * inner_z)
    else:
        inner = max(inner_x, inner_z)
    outer = max(abs(x) - (s.half_length + s.rail), abs(z) - (s.half_width + s.rail))
    frame: float = max(-inner, outer)
    return frame


@inlined
def rail_distance(s: StageRecord, x: float, y: float, z: float) -> float:
    """Distance from the frame around the board."""
    return extruded_distance(rail_footprint(s, x, z), y, s.rail_height, 0.18 * s.rail)


@inlined
def apron_distance(s: StageRecord, x: float, y: float, z: float) -> float:
    """Distance from the plate below the gutter, between the rails; its edge is bevelled."""
    a = max(x - s.apron_top, -s.half_length - x, abs(z) - s.half_width)
    b = y - s.apron_height
    plate: float = max(a, b, 0.7071 * (a + b + 0.16 * s.unit))
    return plate


def list_cells(
    stage: NDArray[Any], solids: NDArray[Any], shapes: NDArray[Any], distance: float
) -> NDArray[np.int32]:
    """Return the grid of the parts within a distance [u] of any point of each cell.

    One int32 array: for each cell, and once more for the end, where its list begins; then the lists.
    """
    cells = int(stage[0]["rows"] * stage[0]["columns"])
    lists = np.zeros(cells + 1 + 8 * cells, np.int32)
    need = fill_cells(stage, solids, shapes, distance, lists)
    if need > len(lists):
        lists = np.zeros(need, np.int32)
        fill_cells(stage, solids, shapes, distance, lists)
    return lists[:need]


@kernel
def fill_cells(stage: Records, solids: Records, shapes: Records, distance: float, lists: Cells) -> Any:
    """Write the lists as far as they fit; return the length that they need."""
    s = stage[0]
    cells = s.rows * s.columns
    side = 1.0 / s.cell_scale
    reach = distance + 0.7072 * side  # half a cell's diagonal, rounded up
    end = cells + 1
    for cell in range(cells):
        x = s.low_x + (cell // s.columns + 0.5) * side
        z = s.low_z + (cell % s.columns + 0.5) * side
        lists[cell] = end
        for index in range(len(solids)):
            if (
                solids[index].form != Form.ABSENT
                and footprint_distance(solids[index], shapes[index], x, z) < reach
            ):
                if end < len(lists):
                    lists[end] = index
                end += 1
    lists[cells] = end
    return end


@inlined
def cell_at(s: StageRecord, x: float, z: float) -> Any:
    """Return the number of the cell that contains (x, z), or of the nearest cell."""
    row = int((x - s.low_x) * s.cell_scale)
    column = int((z - s.low_z) * s.cell_scale)
    return min(max(row, 0), s.rows - 1) * s.columns + min(max(column, 0), s.columns - 1)
