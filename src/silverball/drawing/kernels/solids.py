"""Distances to solids: footprints extruded to a height, and the grid of nearby solids.

A footprint gives the distance a in the plane, the height the distance b = y − height above it. A body with an
edge rounded by r is

    d = |max(a + r, b + r, 0)| + min(max(a + r, b + r), 0) − r        (|…| of the two clipped components)

which never exceeds the true distance, so a ray that advances by it cannot pass through a body. Bodies on the
playfield have no underside; those of upper levels float above it.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.stage import (
    Cells,
    Corners,
    Material,
    Outline,
    Records,
    SolidRecord,
    StageRecord,
)
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.shapes import segment_distance, triangle_distance

CAP_SHARE = 0.9  # radius of a bumper's cap by that of the bumper
CAP_RISE = 0.42  # height of the cap by its radius
RING = 0.075  # [u] radius of the steel ring at the top of a bumper's body, for a ball of the usual size
FAR = 1e9  # [u]


@inlined
def extruded_distance(a: float, y: float, height: float, bevel: float) -> float:
    """Return the distance from a body of a height whose footprint is at distance a."""
    across = a + bevel
    up = y - height + bevel
    if across > 0.0 and up > 0.0:
        return sqrt(across * across + up * up) - bevel
    return max(across, up) - bevel


@internal
def footprint_distance(c: SolidRecord, x: float, z: float) -> float:
    """Return the distance from a solid's footprint in the plane; a polygon has none of its own."""
    if c.turns != 0:  # to the paddle's own frame (see physics/paddle.py)
        rx = x - c.x
        rz = c.side * (z - c.z)
        x, z = rx * c.cosine - rz * c.sine, rx * c.sine + rz * c.cosine
    if c.outline == Outline.CIRCLE:
        dx, dz = x - c.x, z - c.z
        around: float = sqrt(dx * dx + dz * dz) - c.radius
        return around
    if c.outline == Outline.TRIANGLE:
        outside, _, _ = triangle_distance(c, x, z)
        return outside
    if c.outline == Outline.TAPERED:
        return _tapered_distance(c, x, z)
    if c.outline == Outline.ARC:
        return _arc_distance(c, x, z)
    if c.outline == Outline.POLYGON:
        return FAR
    beside, _, _ = segment_distance(c, x, z)
    return beside


@inlined
def _tapered_distance(c: SolidRecord, x: float, z: float) -> float:
    """Distance from a tapered capsule from the origin to (0, length0), in a paddle's frame.

    With s = (r₀ − r₁)/L, c = √(1 − s²), t along and h across, w = t·c − h·s tells which of its two circles
    or its side is nearest.
    """
    sine = (c.radius - c.tip_radius) / c.length0
    cosine = sqrt(1.0 - sine * sine)
    h = abs(x)
    w = z * cosine - h * sine
    if w <= 0.0:
        gap: float = sqrt(x * x + z * z) - c.radius
    elif w >= cosine * c.length0:
        along = z - c.length0
        gap = sqrt(x * x + along * along) - c.tip_radius
    else:
        gap = h * cosine + z * sine - c.radius
    return gap


@inlined
def _arc_distance(c: SolidRecord, x: float, z: float) -> float:
    """Distance from an arc around (x, z) of the record; its length0 is the radius of its circle."""
    dx, dz = x - c.x, z - c.z
    rho = sqrt(dx * dx + dz * dz)
    if dx * c.inward_x + dz * c.inward_z >= rho * c.arc_cosine:
        gap: float = abs(rho - c.length0)
    else:  # past its ends
        first = (x - c.x0) ** 2 + (z - c.z0) ** 2
        second = (x - c.x1) ** 2 + (z - c.z1) ** 2
        gap = sqrt(min(first, second))
    return gap - c.radius


@internal
def is_in_polygon(corners: Corners, first: int, end: int, x: float, z: float) -> bool:
    """Return whether (x, z) is inside a polygon, by the number of sides that a ray from it crosses."""
    inside = False
    px, pz = corners[end - 1, 0], corners[end - 1, 1]
    for index in range(first, end):
        qx, qz = corners[index, 0], corners[index, 1]
        if (pz > z) != (qz > z) and x < px + (z - pz) / (qz - pz) * (qx - px):
            inside = not inside
        px, pz = qx, qz
    return inside


@internal
def _fill_distance(corners: Corners, c: SolidRecord, x: float, y: float, z: float) -> float:
    """Height above the fill of a closed wall; far away outside of it.

    The edges of the wall are solids too and at least as high, so no ray reaches the fill from the side, and
    stepping by the smaller of both distances cannot pass through it.
    """
    return y - c.height if is_in_polygon(corners, c.first, c.end, x, z) else FAR


@internal
def solid_distance(corners: Corners, c: SolidRecord, x: float, y: float, z: float) -> float:
    """Return the distance of a point from a solid."""
    if c.outline == Outline.POLYGON:
        d = _fill_distance(corners, c, x, y, z)
    elif c.outline == Outline.PLATE:
        return _plate_distance(c, x, y, z)
    else:
        a = footprint_distance(c, x, z)
        d = extruded_distance(a, y, c.height, c.bevel)
        if c.material == Material.BUMPER:
            d = min(d, _cap_distance(c, a, y))
        elif c.bolt > 0.0:
            d = min(d, _bolt_distance(c, x, y, z))
    if c.base > 0.0:  # it has an underside
        d = max(d, c.base - y)
    return d


@inlined
def _plate_distance(c: SolidRecord, x: float, y: float, z: float) -> float:
    """Distance from a thin plate that is turned about a horizontal axis, at its height above a segment."""
    dx, dz = x - c.x0, z - c.z0
    foot = dx * c.along_x0 + dz * c.along_z0
    across, up = dx * c.inward_x + dz * c.inward_z, y - c.height
    p = abs(across * c.cosine + up * c.sine) - c.thin
    q = up * c.cosine - across * c.sine
    q = max(c.low - q, q - c.high)
    t = max(-foot, foot - c.length0)
    inside = min(max(p, q, t), 0.0)
    p, q, t = max(p, 0.0), max(q, 0.0), max(t, 0.0)
    gap: float = sqrt(p * p + q * q + t * t) + inside
    return gap


@inlined
def _cap_distance(c: SolidRecord, a: float, y: float) -> float:
    """Distance from a bumper's cap, a slice of a sphere, and the steel ring around it."""
    unit = (c.height - c.base) / 0.38
    rho = a + c.radius
    ring_across = rho - (c.radius - RING * unit)
    ring_up = y - c.height
    ring = sqrt(ring_across * ring_across + ring_up * ring_up) - RING * unit
    wide = CAP_SHARE * c.radius
    rise = min(CAP_RISE * wide, 0.45 * unit)
    sphere = (wide * wide + rise * rise) / (2.0 * rise)
    up = y - (c.height + rise - sphere)
    cap = max(sqrt(rho * rho + up * up) - sphere, c.height - y)
    crown: float = min(ring, cap)
    return crown


@inlined
def _bolt_distance(c: SolidRecord, x: float, y: float, z: float) -> float:
    """Distance from the flat dome over the pivot of a paddle."""
    rx = x - c.x - 0.42 * c.bolt * c.sine
    rz = z - c.z - 0.42 * c.bolt * c.cosine * c.side
    up = 2.0 * (y - c.height)
    bolt: float = 0.5 * (sqrt(rx * rx + rz * rz + up * up) - c.bolt)
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
    stage: NDArray[Any], solids: NDArray[Any], distance: float, glowing: bool
) -> NDArray[np.int32]:
    """Return the grid of the solids within a distance [u] of any point of each cell.

    One int32 array: for each cell, and once more for the end, where its list begins; then the lists.

    Args:
        stage: One STAGE record.
        solids: SOLID records.
        distance: How near to a point of the cell they are [u].
        glowing: Whether to list those that light up their surroundings, instead of all.
    """
    cells = int(stage[0]["rows"] * stage[0]["columns"])
    lists = np.zeros(cells + 1 + 8 * cells, np.int32)
    need = fill_cells(stage, solids, distance, glowing, lists)
    if need > len(lists):
        lists = np.zeros(need, np.int32)
        fill_cells(stage, solids, distance, glowing, lists)
    return lists[:need]


@kernel
def fill_cells(stage: Records, solids: Records, distance: float, glowing: bool, lists: Cells) -> Any:
    """Write the lists as far as they fit; return the length that they need."""
    s = stage[0]
    cells = s.rows * s.columns
    side = 1.0 / s.cell_scale
    half = 0.7072 * side  # half a cell's diagonal, rounded up
    end = cells + 1
    for cell in range(cells):
        x = s.low_x + (cell // s.columns + 0.5) * side
        z = s.low_z + (cell % s.columns + 0.5) * side
        lists[cell] = end
        for index in range(len(solids)):
            if _is_listed(solids[index], x, z, distance + half, half, glowing):
                if end < len(lists):
                    lists[end] = index
                end += 1
    lists[cells] = end
    return end


@internal
def _is_listed(c: SolidRecord, x: float, z: float, reach: float, half: float, glowing: bool) -> bool:
    if c.outline == Outline.ABSENT:
        return False
    if glowing and c.glow == 0.0 and c.tube == 0.0:
        return False
    if c.outline == Outline.POLYGON:  # its box
        return abs(x - c.x) < c.x1 + half and abs(z - c.z) < c.z1 + half
    return footprint_distance(c, x, z) < reach


@inlined
def cell_at(s: StageRecord, x: float, z: float) -> Any:
    """Return the number of the cell that contains (x, z), or of the nearest cell."""
    row = int((x - s.low_x) * s.cell_scale)
    column = int((z - s.low_z) * s.cell_scale)
    return min(max(row, 0), s.rows - 1) * s.columns + min(max(column, 0), s.columns - 1)
