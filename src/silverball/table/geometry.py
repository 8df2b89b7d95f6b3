"""Distances between parts, and between points and parts, for many at once.

Every solid primitive is cut into convex pieces: a core of up to three points, inflated by a radius. A circle
is one point, a capsule two, a triangle three; fewer points are repeated, so that all pieces fit in one array.
An arc is a chain of capsules that lies within `ARC_TOLERANCE` of it; a tapered capsule is two circles and the
two triangles between them. Closed chains are solid inside; their interiors are `Polygon`s.

Points are (x, z) [u]; corners run counter-clockwise with z to the right and x up.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.forms import Response, Shape
from silverball.table.primitive import Point, Primitive

if TYPE_CHECKING:
    from silverball.table.kinds import Board

Floats: TypeAlias = NDArray[np.float64]
Bools: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.signedinteger[Any]]
Triangle: TypeAlias = tuple[Point, Point, Point]

CHUNK = 4096  # pairs of pieces, or of balls and pieces, measured at once, to bound the memory
COMPARED_AT_ONCE = 2**19  # boxes, or pairs of boxes, that are compared at once, to bound the memory
ARC_TOLERANCE = 1e-3  # [u] between an arc and its chain; far below the clearances that are checked
MAX_ARC_STEP = math.pi / 4.0  # [rad] of an arc in one piece of its chain
MAX_LEVEL = 62  # the levels of a piece are the bits of one integer


class Piece(NamedTuple):
    """A convex piece of a primitive.

    Attributes:
        core: Three points; fewer are repeated.
        radius: The radius around the core [u].
        outer: For a piece of an arc, the unit direction away from the arc's centre; else zero.
        passes: The unit direction in which balls pass a one-way piece; else zero.
    """

    core: Triangle
    radius: float
    outer: Point = (0.0, 0.0)
    passes: Point = (0.0, 0.0)


def is_solid(primitive: Primitive) -> bool:
    """Return whether balls bounce off a primitive that is not a border."""
    return primitive.response is Response.BOUNCE and primitive.shape is not Shape.PLANE


def pieces_of(primitive: Primitive) -> list[Piece]:
    """Cut a primitive into convex pieces; sensors and holes count as the area in which they act."""
    match primitive.shape:
        case Shape.CIRCLE | Shape.DISC:
            (center,) = primitive.points
            return [Piece((center, center, center), primitive.radius)]
        case Shape.CAPSULE | Shape.LINE:
            start, end = primitive.points
            passes = primitive.one_way or (0.0, 0.0)
            return [Piece((start, end, end), primitive.radius, passes=passes)]
        case Shape.TRIANGLE:
            a, b, c = primitive.points
            return [Piece((a, b, c), primitive.radius)]
        case Shape.ARC:
            return _arc_pieces(primitive)
        case Shape.TAPERED:
            return _tapered_pieces(primitive)
        case Shape.PLANE:
            return []
    raise ValueError(f"a shape without pieces: {primitive.shape!r}")


def arc_edges(primitive: Primitive) -> int:
    """Return the number of edges of the chain that stands for an arc."""
    arc = primitive.arc
    step = min(MAX_ARC_STEP, 4.0 * math.asin(min(1.0, math.sqrt(ARC_TOLERANCE / (2.0 * arc.radius)))))
    return max(1, math.ceil(2.0 * arc.half_angle / step))


def arc_points(primitive: Primitive) -> list[Point]:
    """Return points on an arc, from its start to its end, whose chain lies within the tolerance."""
    arc, count = primitive.arc, arc_edges(primitive)
    turn = math.copysign(arc.half_angle, primitive.bulge)
    inner = np.linspace(-turn, turn, count + 1)[1:-1]
    sine, cosine = np.sin(inner), np.cos(inner)
    x = arc.center[0] + arc.radius * (arc.middle[0] * cosine + arc.middle[1] * sine)
    z = arc.center[1] + arc.radius * (arc.middle[1] * cosine - arc.middle[0] * sine)
    return [primitive.points[0], *zip(x.tolist(), z.tolist(), strict=True), primitive.points[1]]


def _arc_pieces(primitive: Primitive) -> list[Piece]:
    (center_x, center_z), points = primitive.arc.center, arc_points(primitive)
    pieces = []
    for start, end in pairwise(points):
        x, z = 0.5 * (start[0] + end[0]) - center_x, 0.5 * (start[1] + end[1]) - center_z
        length = math.hypot(x, z) or 1.0
        pieces.append(Piece((start, end, end), primitive.radius, (x / length, z / length)))
    return pieces


def _tapered_pieces(primitive: Primitive) -> list[Piece]:
    """Two circles, and the quadrilateral between their common outer tangents as two triangles.

    They touch the circles where the outward normal leans towards the thinner end by asin((r₀ − r₁)/L).
    """
    base, tip = primitive.points
    along_x, along_z = tip[0] - base[0], tip[1] - base[1]
    length = math.hypot(along_x, along_z)
    pieces = [
        Piece((base, base, base), primitive.radius),
        Piece((tip, tip, tip), primitive.tip_radius),
    ]
    lean = (primitive.radius - primitive.tip_radius) / length if length > 0.0 else 1.0
    if abs(lean) >= 1.0:  # one circle lies within the other
        return pieces
    along_x, along_z, rise = along_x / length, along_z / length, math.sqrt(1.0 - lean * lean)

    def at(center: Point, radius: float, side: float) -> Point:
        normal_x, normal_z = lean * along_x + side * rise * along_z, lean * along_z - side * rise * along_x
        return center[0] + radius * normal_x, center[1] + radius * normal_z

    left_base, right_base = at(base, primitive.radius, 1.0), at(base, primitive.radius, -1.0)
    left_tip, right_tip = at(tip, primitive.tip_radius, 1.0), at(tip, primitive.tip_radius, -1.0)
    pieces.append(Piece((right_base, right_tip, left_base), 0.0))
    pieces.append(Piece((left_base, right_tip, left_tip), 0.0))
    return pieces


class Polygon(NamedTuple):
    """The inside of a closed chain: its corners [corner, 2], the part that it belongs to, its levels."""

    corners: Floats
    part: int
    levels: int

    def contains(self, points: Floats) -> Bools:
        """Return whether points [point, 2] lie inside, by the parity of the crossings of a ray."""
        inside = np.zeros(len(points), dtype=bool)
        low, high = self.corners.min(axis=0), self.corners.max(axis=0)
        near = np.nonzero(((points >= low) & (points <= high)).all(axis=1))[0]
        start, end = self.corners, np.roll(self.corners, -1, axis=0)
        rise = end[:, 0] - start[:, 0]
        slope = (end[:, 1] - start[:, 1]) / np.where(rise == 0.0, 1.0, rise)
        at_once = max(1, COMPARED_AT_ONCE // len(start))
        for begin in range(0, len(near), at_once):
            some = near[begin : begin + at_once]
            x, z = points[some, 0, None], points[some, 1, None]
            spans = (start[:, 0] > x) != (end[:, 0] > x)
            right = z < start[:, 1] + (x - start[:, 0]) * slope
            inside[some] = (spans & right).sum(axis=1) % 2 == 1
        return inside


def closed_corners(primitives: Sequence[Primitive]) -> Floats | None:
    """Return the corners of the chain that some primitives make, or None if it is open or no chain."""
    links = [p for p in primitives if p.shape in (Shape.CAPSULE, Shape.ARC) and is_solid(p)]
    if len(links) < 2 or links[-1].points[1] != links[0].points[0]:
        return None
    if any(one.points[1] != other.points[0] for one, other in pairwise(links)):
        return None
    corners: list[Point] = []
    for link in links:
        corners += arc_points(link)[:-1] if link.shape is Shape.ARC else link.points[:1]
    return np.array(corners, dtype=np.float64) if len(corners) > 2 else None


def level_mask(levels: Iterable[int]) -> int:
    """Return levels as the bits of an integer."""
    return sum(1 << level for level in set(levels) if 0 <= level <= MAX_LEVEL)


class Pieces(NamedTuple):
    """The convex pieces of some parts.

    Attributes:
        core: The core points [u], shape [piece, 3, 2].
        radius: The radius around each core [u], shape [piece].
        part: The index of the part that each piece belongs to, shape [piece].
        levels: The levels of each piece as bits, shape [piece].
        outer: The direction away from the centre of an arc, or zero, shape [piece, 2].
        passes: The direction in which balls pass a one-way piece, or zero, shape [piece, 2].
    """

    core: Floats
    radius: Floats
    part: Indices
    levels: Indices
    outer: Floats
    passes: Floats

    @classmethod
    def of(cls, bodies: Iterable[Iterable[Primitive]]) -> Pieces:
        """Cut the primitives of some parts into pieces."""
        return cls.of_pieces(
            [
                (piece, part, level_mask(primitive.levels))
                for part, primitives in enumerate(bodies)
                for primitive in primitives
                for piece in pieces_of(primitive)
            ]
        )

    @classmethod
    def of_pieces(cls, found: Sequence[tuple[Piece, int, int]]) -> Pieces:
        """Gather pieces, each with the index of its part and its levels as bits."""
        return cls(
            np.array([piece.core for piece, _, _ in found], dtype=np.float64).reshape(-1, 3, 2),
            np.array([piece.radius for piece, _, _ in found], dtype=np.float64),
            np.array([part for _, part, _ in found], dtype=np.int64),
            np.array([levels for _, _, levels in found], dtype=np.int64),
            np.array([piece.outer for piece, _, _ in found], dtype=np.float64).reshape(-1, 2),
            np.array([piece.passes for piece, _, _ in found], dtype=np.float64).reshape(-1, 2),
        )

    def only(self, which: Bools | Indices) -> Pieces:
        """Return some of the pieces."""
        return Pieces._make(field[which] for field in self)

    def on_level(self, level: int) -> Pieces:
        """Return the pieces that balls on a level meet."""
        return self.only(self.levels >> level & 1 == 1)

    def joined(self, other: Pieces) -> Pieces:
        """Return these pieces followed by others."""
        return Pieces(*(np.concatenate(fields) for fields in zip(self, other, strict=True)))

    def bounds(self) -> tuple[Floats, Floats]:
        """Return a bounding circle of each piece: centres [piece, 2] and radii [piece], in [u]."""
        center = 0.5 * (self.core.max(axis=1) + self.core.min(axis=1))
        spread = np.sqrt(((self.core - center[:, None, :]) ** 2).sum(axis=2).max(axis=1))
        return center, spread + self.radius

    def boxes(self) -> tuple[Floats, Floats]:
        """Return the least and the greatest coordinates of each piece [u], shape [piece, 2] each."""
        margin = self.radius[:, None]
        return self.core.min(axis=1) - margin, self.core.max(axis=1) + margin


def moving_reach(paddle: Primitive) -> float:
    """Return the largest distance [u] of a point of a paddle from its pivot."""
    return max(math.hypot(*point) + piece.radius for piece in pieces_of(paddle) for point in piece.core)


def moving_pieces(paddle: Primitive, angles: Floats) -> tuple[Floats, Floats]:
    """Return the pieces of a paddle at many angles.

    Args:
        paddle: A primitive with a mover; its points are relative to the pivot.
        angles: Angles [rad], shape [angle].

    Returns:
        The cores [u], shape [angle, piece, 3, 2], and the radii [u], shape [piece].
    """
    assert paddle.mover is not None
    pieces = pieces_of(paddle)
    (pivot_x, pivot_z), direction = paddle.mover.pivot, paddle.mover.direction
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    across, along = np.moveaxis(np.array([piece.core for piece in pieces], dtype=np.float64), -1, 0)
    x = pivot_x + (across * cosine + along * sine)
    z = pivot_z + direction * (along * cosine - across * sine)
    cores = np.stack([x, z], axis=-1)
    if direction < 0.0:  # the mirror image of a triangle runs the other way round
        cores = cores[:, :, ::-1, :]
    return cores, np.array([piece.radius for piece in pieces], dtype=np.float64)


def paddle_at(paddle: Primitive, angle: float) -> list[Piece]:
    """Return the pieces of a paddle at one angle [rad]."""
    assert paddle.mover is not None
    (pivot_x, pivot_z), direction = paddle.mover.pivot, paddle.mover.direction
    sine, cosine = math.sin(angle), math.cos(angle)
    pieces = []
    for piece in pieces_of(paddle):
        a, b, c = (
            (
                pivot_x + (across * cosine + along * sine),
                pivot_z + direction * (along * cosine - across * sine),
            )
            for across, along in piece.core
        )
        pieces.append(Piece((a, b, c) if direction > 0.0 else (c, b, a), piece.radius))
    return pieces


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


class ClosePairs(NamedTuple):
    """Pairs of pieces that are close to each other.

    Attributes:
        first: The first piece of each pair, shape [pair], in order.
        second: The second piece of each pair.
        gap: The gap between them [u].
        is_complete: Whether these are all pairs.
    """

    first: Indices
    second: Indices
    gap: Floats
    is_complete: bool


def near_pairs(pieces: Pieces, widest: float, limit: int) -> ClosePairs:
    """Find the pairs of pieces of one level with less than a given gap [u] between them.

    Args:
        pieces: The pieces; those of one part make pairs too.
        widest: The gap [u].
        limit: The search ends after about this many pairs, to bound time and memory.
    """
    low, high = pieces.boxes()
    order = np.argsort(low[:, 0], kind="stable")
    ends = np.searchsorted(low[order, 0], high[order, 0] + widest)
    found: list[tuple[Indices, Indices, Floats]] = []
    count = 0
    at_once = max(1, COMPARED_AT_ONCE // max(1, len(order)))
    for begin in range(0, len(order), at_once):
        rows = slice(begin, begin + at_once)
        one, others = order[rows], order[begin : int(ends[rows].max())]
        meets = low[others, 1] - high[one, None, 1] < widest
        meets &= low[one, None, 1] - high[others, 1] < widest
        meets &= low[others, 0] - high[one, None, 0] < widest
        meets &= pieces.levels[one, None] & pieces.levels[others] != 0
        row, column = np.nonzero(np.triu(meets, 1))
        pair = np.sort(np.stack([one[row], others[column]]), axis=0)
        for part in range(0, pair.shape[1], CHUNK):
            a, b = pair[:, part : part + CHUNK]
            gap = core_distances(pieces.core[a], pieces.core[b]) - (pieces.radius[a] + pieces.radius[b])
            near = gap < widest
            found.append((a[near], b[near], gap[near]))
            count += int(near.sum())
            if count > limit:
                return ClosePairs(*_in_order(found), is_complete=False)
    return ClosePairs(*_in_order(found), is_complete=True)


def _in_order(found: list[tuple[Indices, Indices, Floats]]) -> tuple[Indices, Indices, Floats]:
    """Pairs sorted by the first and then by the second piece."""
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    first, second, gap = (np.concatenate(field) for field in zip(*found, strict=True))
    order = np.lexsort((second, first))
    return first[order], second[order], gap[order]


def clear_of(balls: Floats, ball_radius: float, pieces: Pieces, slack: float) -> Bools:
    """Return whether balls overlap no piece by more than a slack [u], bool [ball]."""
    low, high = pieces.boxes()
    low, high = low - ball_radius, high + ball_radius
    # A ball far from the line through a capsule is clear of it, which its box alone does not tell.
    is_flat = (pieces.core[:, 1] == pieces.core[:, 2]).all(axis=1)
    normal = np.where(is_flat[:, None], outward_normals(pieces.core)[:, 0], 0.0)
    level = (normal * pieces.core[:, 0]).sum(axis=1)
    reach = pieces.radius + ball_radius
    is_clear = np.ones(len(balls), dtype=bool)
    at_once = max(1, COMPARED_AT_ONCE // max(1, len(low)))
    for begin in range(0, len(balls), at_once):
        some = balls[begin : begin + at_once]
        x, z = some[:, 0, None], some[:, 1, None]
        near = (x > low[:, 0]) & (x < high[:, 0]) & (z > low[:, 1]) & (z < high[:, 1])
        near &= np.abs(x * normal[:, 0] + z * normal[:, 1] - level) < reach
        ball, piece = np.nonzero(near)
        for few in np.array_split(np.arange(len(ball)), len(ball) // CHUNK + 1):
            gap = distances(some[ball[few]], pieces.core[piece[few]]) - pieces.radius[piece[few]]
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
    """Return the unit normals of the three edges, shape [piece, 3, 2]; zero for an edge without length.

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
