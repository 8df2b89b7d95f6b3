"""Footprints of 3-D meshes: the outline that a mesh gives to a prism or a cylinder.

The axes of a mesh are those of the table (x up the table, y out of the board, z to the right), so from above
every vertex is a point (x, z) [u]. A ball hits the convex hull of these points. A prism takes the largest
triangle among the corners of the hull, a cylinder the smallest circle around it.

The size of a file is checked before it is opened; `meshfile.py` reads it.
"""

from __future__ import annotations

import itertools
import math
import os
import stat
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from silverball.errors import Problem, TableError
from silverball.plain import plain
from silverball.table.geometry import Floats
from silverball.table.meshfile import KINDS, MeshError, mesh_points

if TYPE_CHECKING:
    from silverball.table.model import Triangle
    from silverball.table.primitive import Point

MESH_LIMIT = 16 * 2**20  # [bytes] of a mesh file: 300,000 triangles of binary STL
CORNERS_LIMIT = 1000  # corners of a prism's footprint, so that the largest triangle is found in a second
HULL_LIMIT = 2**16  # corners of a hull: the most that points in single precision can have
MAX_COORDINATE = 1e6  # [u] from the origin; a point further out means that the file is damaged
MIN_WIDTH = 1e-3  # [u] a footprint narrower than this is flat
_DECIMALS = 6  # decimals of a footprint [u]; STL stores single precision


def triangle_footprint(path: Path) -> Triangle:
    """Return the largest triangle in the footprint of a mesh, (x, z) [u], counter-clockwise.

    Raises:
        TableError: The file is missing, damaged, too large or flat, or of an unknown kind.
    """
    hull = convex_hull(_points(path))
    if len(hull) > CORNERS_LIMIT:
        count = f"at least {len(hull):,} corners; a prism's may have at most {CORNERS_LIMIT:,}"
        message = f"has a footprint with {count}: simplify {plain(str(path))}"
        raise _unusable(str(path), message)
    corners = largest_triangle(hull)
    # + 0.0 turns −0.0 into 0.0.
    a, b, c = (tuple(float(value) + 0.0 for value in np.round(corner, _DECIMALS)) for corner in corners)
    return (a[0], a[1]), (b[0], b[1]), (c[0], c[1])


def circle_footprint(path: Path) -> tuple[float, float, float]:
    """Return the smallest circle around the footprint of a mesh: x, z and radius [u].

    Raises:
        TableError: The file is missing, damaged, too large or flat, or of an unknown kind.
    """
    x, z, radius = smallest_circle(_points(path))
    # + 0.0 turns −0.0 into 0.0.
    return round(x, _DECIMALS) + 0.0, round(z, _DECIMALS) + 0.0, round(radius, _DECIMALS)


def convex_hull(points: Floats) -> Floats:
    """Return the corners of the convex hull of points (x, z), counter-clockwise, shape [corner, 2].

    Andrew's monotone chain. Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two
    dimensions", Information Processing Letters 9 (1979).
    """
    hull = np.empty((0, 2))
    for begin in range(0, len(points), HULL_LIMIT):  # in chunks, to bound the memory
        hull = _chains(np.concatenate([hull, points[begin : begin + HULL_LIMIT]]))
        if len(hull) > HULL_LIMIT:
            break
    return hull


def _chains(points: Floats) -> Floats:
    """The two chains of corners, from low x to high x and back."""
    ordered = [(float(x), float(z)) for x, z in np.unique(points, axis=0)]
    chains: list[list[Point]] = []
    for direction in (ordered, ordered[::-1]):
        chain: list[Point] = []
        for point in direction:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], point) >= 0.0:
                chain.pop()
            chain.append(point)
        chains.append(chain[:-1])
    # The chains run clockwise, so the corners are reversed.
    return np.array((chains[0] + chains[1])[::-1], dtype=np.float64).reshape(-1, 2)


def largest_triangle(hull: Floats) -> Floats:
    """Return the largest triangle among the corners of a convex polygon, counter-clockwise, shape [3, 2].

    For two given corners the area has a single peak over the third, which advances with them: n² steps for n
    corners.
    """
    count = len(hull)
    best, found = -1.0, (0, 0, 0)
    for first in range(count - 2):
        third = first + 2
        for second in range(first + 1, count - 1):
            third = max(third, second + 1)
            area = _turn(hull[first], hull[second], hull[third])
            while third + 1 < count:
                further = _turn(hull[first], hull[second], hull[third + 1])
                if further < area:
                    break
                area, third = further, third + 1
            if area > best:
                best, found = area, (first, second, third)
    return hull[list(found)]


def smallest_circle(points: Floats) -> tuple[float, float, float]:
    """Return the smallest circle around all points: x, z and radius [u].

    Two or three of the points define it. The point furthest outside is added to them, repeatedly; the circle
    grows each time, so this ends.
    Source: B. Gärtner, "Fast and robust smallest enclosing balls", ESA 1999 (the choice of the next point).
    """
    support: list[Point] = [(float(points[0, 0]), float(points[0, 1]))]
    circle = (*support[0], 0.0)
    while True:
        away = np.hypot(points[:, 0] - circle[0], points[:, 1] - circle[1])
        furthest = int(np.argmax(away))
        if away[furthest] <= circle[2] * (1.0 + 1e-12) + 1e-12:
            return circle
        grown, support = _circle_of_support(
            [*support, (float(points[furthest, 0]), float(points[furthest, 1]))]
        )
        if grown[2] <= circle[2]:  # no progress beyond rounding
            return circle
        circle = grown


def _points(path: Path) -> Floats:
    """The vertices of a mesh file from above, (x, z) [u], shape [vertex, 2]."""
    kind = path.suffix.lower().removeprefix(".")
    name = plain(str(path))
    if kind not in KINDS:
        raise _unusable(name, f"must be an STL, OBJ or GLB file, got {path.name!r}")
    try:
        status = os.stat(path)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise _unusable(name, f"cannot be read: {name} ({reason})") from error
    if not stat.S_ISREG(status.st_mode):
        raise _unusable(name, f"is not a regular file: {name}")
    if status.st_size > MESH_LIMIT:
        size = f"{status.st_size:,} bytes long, but the limit for a mesh is {MESH_LIMIT:,}"
        message = f"is {size}; simplify {name}"
        raise _unusable(name, message)
    try:
        content = path.read_bytes()
        vertices = mesh_points(content, kind)
    except OSError as error:
        raise _unusable(name, f"cannot be read: {name} ({error.strerror or error})") from error
    except MeshError as error:
        raise _unusable(name, f"cannot be used: {name} {error}") from error
    if not (np.abs(vertices) <= MAX_COORDINATE).all():  # also not for NaN
        bad = f"contains coordinates that are NaN or beyond ±{MAX_COORDINATE:,.0f} u"
        raise _unusable(name, f"{bad}; {name} is probably damaged")
    points = vertices[:, [0, 2]]
    if len(points) < 3 or _width(points) < MIN_WIDTH:
        raise _unusable(name, f"is flat or empty seen from above (along y): {name} has no footprint")
    return points


def _unusable(source: str, message: str) -> TableError:
    return TableError(source, [Problem("mesh", message)])


def _turn(a: Sequence[float] | Floats, b: Sequence[float] | Floats, c: Sequence[float] | Floats) -> float:
    """Twice the area of the triangle a, b, c; positive if it runs counter-clockwise."""
    return float((b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1]))


def _width(points: Floats) -> float:
    """[u] The width of points across their principal axis."""
    centred = points - points.mean(axis=0)
    across = np.linalg.svd(centred, full_matrices=False)[2][1]
    return float(np.ptp(centred @ across))


def _circle_of_support(points: list[Point]) -> tuple[tuple[float, float, float], list[Point]]:
    """The smallest circle around up to four points, and the two or three that define it."""
    pairs = [(_circle_of_two(p, q), [p, q]) for p, q in itertools.combinations(points, 2)]
    triples = [(_circle_of_three(p, q, r), [p, q, r]) for p, q, r in itertools.combinations(points, 3)]
    enclosing = [found for found in pairs + triples if all(_contains(found[0], point) for point in points)]
    return min(enclosing or triples or pairs, key=lambda found: found[0][2])


def _contains(circle: tuple[float, float, float], point: Point) -> bool:
    return math.dist(circle[:2], point) <= circle[2] * (1.0 + 1e-12) + 1e-12


def _circle_of_two(p: Point, q: Point) -> tuple[float, float, float]:
    return 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * math.dist(p, q)


def _circle_of_three(p: Point, q: Point, r: Point) -> tuple[float, float, float]:
    """The circle through three points; for collinear points the largest one through two of them."""
    ax, az, bx, bz = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]
    twice = 2.0 * (ax * bz - az * bx)
    if twice == 0.0:
        return max((_circle_of_two(*pair) for pair in ((p, q), (p, r), (q, r))), key=lambda c: c[2])
    a, b = ax * ax + az * az, bx * bx + bz * bz
    x, z = (bz * a - az * b) / twice, (ax * b - bx * a) / twice
    return p[0] + x, p[1] + z, math.hypot(x, z)
