"""Distances between parts, and between points and parts, for many at once.

Every part is a convex core of up to three points, inflated by a radius: a cylinder is one point, a slant wall
two, a prism or a paddle three (radius 0). Fewer points are repeated, so that the parts of a table fit in one
array. Points are (x, z) [u]; corners run counter-clockwise with z to the right and x up.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from silverball.table.kinds import Board, Paddle
    from silverball.table.model import Outline
    from silverball.table.primitive import Point

Floats: TypeAlias = NDArray[np.float64]
Bools: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.signedinteger[Any]]

CHUNK = 4096  # pairs of shapes, or of balls and shapes, measured at once, to bound the memory


class Shapes(NamedTuple):
    """Some parts as cores and radii.

    Attributes:
        core: The core points [u], shape [shape, 3, 2].
        radius: The radius around each core [u], shape [shape].
    """

    core: Floats
    radius: Floats

    @classmethod
    def of(cls, outlines: list[Outline]) -> Shapes:
        """Make the shapes of a list of outlines."""
        core = np.array([points for points, _ in outlines], dtype=np.float64).reshape(-1, 3, 2)
        return cls(core, np.array([radius for _, radius in outlines], dtype=np.float64))

    def bounds(self) -> tuple[Floats, Floats]:
        """Return a bounding circle of each shape: centres [shape, 2] and radii [shape], in [u]."""
        center = 0.5 * (self.core.max(axis=1) + self.core.min(axis=1))
        spread = np.sqrt(((self.core - center[:, None, :]) ** 2).sum(axis=2).max(axis=1))
        return center, spread + self.radius


def paddle_cores(paddle: Paddle, angles: Floats) -> Floats:
    """Return the corners of a paddle at many angles [deg], shape [angle, 3, 2], as `Paddle.corners` does."""
    turn = np.radians(angles)
    sine, cosine = np.sin(turn)[:, None], np.cos(turn)[:, None]
    across, along = np.array(paddle.local_corners()).T
    x = paddle.pivot[0] + (across * cosine + along * sine)
    z = paddle.pivot[1] + paddle.direction * (along * cosine - across * sine)
    corners = np.stack([x, z], axis=-1)
    return corners if paddle.direction > 0.0 else corners[:, ::-1, :]


def offsets(points: Floats, core: Floats) -> Floats:
    """Return the vector from the nearest point of a core to a point; zero inside a triangle.

    Args:
        points: Points [u], shape [..., 2].
        core: Cores [u], shape [..., 3, 2], whose leading axes broadcast with those of the points.

    Returns:
        Vectors [u], shape [..., 2].
    """
    start = core
    edge = core[..., [1, 2, 0], :] - start
    from_start = points[..., None, :] - start
    square = (edge**2).sum(axis=-1)
    along = (from_start * edge).sum(axis=-1) / np.where(square > 0.0, square, 1.0)
    away = from_start - np.clip(along, 0.0, 1.0)[..., None] * edge
    nearest = np.argmin((away**2).sum(axis=-1), axis=-1)
    best = np.take_along_axis(away, nearest[..., None, None], axis=-2)[..., 0, :]
    # Inside a counter-clockwise triangle, a point lies to the left of every edge.
    left = edge[..., 1] * from_start[..., 0] - edge[..., 0] * from_start[..., 1]
    inside = np.asarray(np.all(left > 0.0, axis=-1))  # never in a flat core
    return np.where(inside[..., None], 0.0, best)


def distances(points: Floats, core: Floats) -> Floats:
    """Return the distances from points to cores [u], broadcast as in `offsets`; zero inside a triangle."""
    away: Floats = np.sqrt((offsets(points, core) ** 2).sum(axis=-1))
    return away


def core_distances(first: Floats, second: Floats) -> Floats:
    """Return the distances between cores [u], shape [..., 3, 2] each, broadcast; zero where they meet."""
    first, second = np.broadcast_arrays(first, second)
    ends = np.minimum(
        distances(first, second[..., None, :, :]).min(axis=-1),
        distances(second, first[..., None, :, :]).min(axis=-1),
    )
    return np.where(_edges_cross(first, second), 0.0, ends)


def near_pairs(shapes: Shapes, widest: float) -> tuple[Indices, Indices, Floats]:
    """Find the pairs of shapes with less than a given gap [u] between them.

    The pairs are measured in chunks: 700 shapes with large bounding circles make 250,000 pairs.

    Returns:
        The first and the second shape of each pair [pair], and the gap [u] [pair].
    """
    center, bound = shapes.bounds()
    apart = np.sqrt(((center[:, None] - center[None]) ** 2).sum(axis=-1)) - bound[:, None] - bound[None]
    first, second = np.nonzero(np.triu(apart < widest, 1))
    gap = np.empty(len(first))
    for begin in range(0, len(first), CHUNK):
        one, other = first[begin : begin + CHUNK], second[begin : begin + CHUNK]
        between = core_distances(shapes.core[one], shapes.core[other])
        gap[begin : begin + CHUNK] = between - (shapes.radius[one] + shapes.radius[other])
    near = gap < widest
    return first[near], second[near], gap[near]


def clear_of(balls: Floats, ball_radius: float, shapes: Shapes, slack: float) -> Bools:
    """Return whether balls overlap no shape by more than a slack [u], bool [ball]."""
    center, bound = shapes.bounds()
    is_clear = np.ones(len(balls), dtype=bool)
    for begin in range(0, len(balls), CHUNK):
        some = balls[begin : begin + CHUNK]
        reach = bound + ball_radius
        away = ((some[:, None, 0] - center[:, 0]) ** 2) + ((some[:, None, 1] - center[:, 1]) ** 2)
        ball, shape = np.nonzero(away < reach**2)
        for few in np.array_split(np.arange(len(ball)), len(ball) // CHUNK + 1):
            gap = distances(some[ball[few]], shapes.core[shape[few]]) - shapes.radius[shape[few]]
            is_clear[begin + ball[few][gap - ball_radius <= -slack]] = False
    return is_clear


def _edges_cross(first: Floats, second: Floats) -> Bools:
    """Whether an edge of one core properly crosses an edge of the other."""
    a, b = first[..., :, None, :], first[..., [1, 2, 0], :][..., :, None, :]
    c, d = second[..., None, :, :], second[..., [1, 2, 0], :][..., None, :, :]
    apart_ab = side_of(a, b, c) * side_of(a, b, d)
    apart_cd = side_of(c, d, a) * side_of(c, d, b)
    return np.asarray(np.any((apart_ab < 0.0) & (apart_cd < 0.0), axis=(-1, -2)))


def side_of(start: Floats, end: Floats, point: Floats) -> Floats:
    """Return a positive number for points to the left of the line from start to end, else a negative one."""
    edge, away = end - start, point - start
    side: Floats = edge[..., 1] * away[..., 0] - edge[..., 0] * away[..., 1]
    return side


def outward_normals(core: Floats) -> Floats:
    """Return the unit normals of the three edges, shape [shape, 3, 2]; zero for an edge without length.

    A core of two points has its edge in both directions, so that both sides have a normal.
    """
    edge = core[:, [1, 2, 0], :] - core
    length = np.sqrt((edge**2).sum(axis=-1))
    normal = np.stack([-edge[..., 1], edge[..., 0]], axis=-1)
    return normal / np.where(length > 0.0, length, 1.0)[..., None]


def border_gaps(points: Floats, board: Board) -> Floats:
    """Return the gaps from points to the left, right and top border [u], shape [..., 3]; negative behind."""
    half_width = 0.5 * board.width - board.wall_thickness
    top = 0.5 * board.length - board.wall_thickness
    x, z = points[..., 0], points[..., 1]
    return np.stack([half_width + z, half_width - z, top - x], axis=-1)


BORDER_NAMES = ("the left border", "the right border", "the top border")
BORDER_NORMALS: tuple[Point, ...] = ((0.0, 1.0), (0.0, -1.0), (-1.0, 0.0))
