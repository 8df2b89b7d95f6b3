"""Traps: the places where a ball would lie forever.

A ball at rest lies on a level face, or on two contacts whose normals support it from both sides. Both are
found exactly, not on a grid: faces by their slope, pairs of contacts as the crossings of outlines that are
offset by a ball's radius. All pairs of parts closer than a ball is wide are considered, and every part with
every border. A crossing is a pocket if

    no other part is in the way,
    the up-table direction lies between the two normals (less than 180° apart),
    a ball can get there (`Space.reaches`), and
    to escape over the lower part, the ball would have to climb higher than the small hop that each touch
    gives it.

A one-way part holds a ball on the side to which balls pass only.

A ball can only balance on a single round top, which is not a trap. Paddles are at rest here: a ball that only
a paddle can free would lie there forever in an unplayed game.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from silverball.table.geometry import (
    BORDER_NAMES,
    BORDER_NORMALS,
    CHUNK,
    Bools,
    Floats,
    Indices,
    Pieces,
    Polygon,
    border_gaps,
    clear_of,
    near_pairs,
    offsets,
    outward_normals,
)
from silverball.table.primitive import Point
from silverball.table.reach import Space

if TYPE_CHECKING:
    from silverball.table.kinds import Board

LEVEL = 2.0  # [deg] a face below this slope is level: a ball on it slides a table's width in 8 s
SHALLOW = 1e-4  # [u] a ball hops out of a shallower pocket: a fifth of the smallest hop of a touch
CONTACT = 1e-7  # [u] a gap below this is a contact; crossings are accurate to 1e-12
ANGLE_TOLERANCE = 1e-9  # [rad] for the rounding of the angle between two normals
PARALLEL = 1e-9  # lines whose directions differ by a smaller sine are parallel
MAX_CLOSE_PAIRS = 20_000  # pairs of pieces closer than a ball is wide; a rich real table makes 10,000
DUPLICATE_DECIMALS = 6  # places that are equal to so many decimals [u] are one


class Terrain(NamedTuple):
    """What balls on one level lie on: pieces, closed chains and borders, and where balls get to."""

    pieces: Pieces
    polygons: list[Polygon]
    board: Board
    space: Space
    level: int = 0

    def is_clear(self, balls: Floats) -> Bools:
        """Return whether balls overlap nothing, bool [ball]."""
        is_clear: Bools = border_gaps(balls, self.board).min(axis=-1) - self.board.ball_radius > -CONTACT
        is_clear &= clear_of(balls, self.board.ball_radius, self.pieces, CONTACT)
        for polygon in self.polygons:
            is_clear[is_clear] = ~polygon.contains(balls[is_clear])
        return is_clear

    def is_reached(self, ball: Floats) -> bool:
        """Return whether a ball gets near a place that is above the gutter."""
        x, z = ball.tolist()
        return bool(x > self.board.gutter) and self.space.reaches((x, z), self.level)


class LevelFace(NamedTuple):
    """A face on which a ball can lie: its part, the slope [deg], and the ball's centre [u]."""

    part: int
    slope: float
    ball: Point


class Pocket(NamedTuple):
    """Two contacts that hold a ball: a part, the other part or border, and the ball's centre [u]."""

    part: int
    other: int | str
    ball: Point


def level_faces(terrain: Terrain) -> list[LevelFace]:
    """Find the faces on which a ball can lie, at most one for each part."""
    found: dict[int, LevelFace] = {}
    pieces, board = terrain.pieces, terrain.board
    normals = outward_normals(pieces.core)
    is_inner = (normals * pieces.outer[:, None]).sum(axis=-1) <= 0.0  # a ball rolls off the outside of an arc
    holds = (normals * pieces.passes[:, None]).sum(axis=-1) >= 0.0  # a ball passes the other face of a gate
    is_level = (normals[..., 0] >= math.cos(math.radians(LEVEL))) & is_inner & holds
    for piece, edge in np.argwhere(is_level).tolist():
        part = int(pieces.part[piece])
        if part in found:
            continue
        start, end = pieces.core[piece, edge], pieces.core[piece, (edge + 1) % 3]
        normal = normals[piece, edge]
        count = max(2, int(math.hypot(*(end - start)) / terrain.space.grid.step) + 1)
        along = np.linspace(0.0, 1.0, count)[:, None]
        balls = start + along * (end - start) + normal * (pieces.radius[piece] + board.ball_radius)
        balls = balls[[terrain.is_reached(ball) for ball in balls]]
        balls = balls[terrain.is_clear(balls)]
        if len(balls):
            slope = math.degrees(math.atan2(abs(normal[1]), normal[0]))
            found[part] = LevelFace(part, slope, (float(balls[0, 0]), float(balls[0, 1])))
    return list(found.values())


def pockets(terrain: Terrain) -> list[Pocket] | None:
    """Find the places where two contacts hold a ball, the lowest of each pair of parts, the lowest first.

    Returns:
        The pockets, or None if more than `MAX_CLOSE_PAIRS` pieces are too close to each other to search.
    """
    balls = _crossings(terrain)
    if balls is None:
        return None
    found: dict[tuple[int, int | str], Pocket] = {}
    boxes = _boxes_of_balls(terrain)
    for ball in balls:
        if terrain.is_reached(ball):
            pocket = _pocket_at(ball, terrain, boxes)
            if pocket is not None:
                found.setdefault((pocket.part, pocket.other), pocket)
    return list(found.values())


def _boxes_of_balls(terrain: Terrain) -> tuple[Floats, Floats]:
    """Boxes around the places where a ball touches a piece, shape [piece, 2] each."""
    low, high = terrain.pieces.boxes()
    margin = terrain.board.ball_radius + CONTACT
    return low - margin, high + margin


def _pocket_at(ball: Floats, terrain: Terrain, boxes: tuple[Floats, Floats]) -> Pocket | None:
    """The pocket made of the contacts that hold a ball at a place, or None."""
    pieces, board = terrain.pieces, terrain.board
    near = np.nonzero(((ball >= boxes[0]) & (ball <= boxes[1])).all(axis=1))[0]
    away = offsets(ball, pieces.core[near])
    gaps = np.sqrt((away**2).sum(axis=-1)) - pieces.radius[near] - board.ball_radius
    count = len(pieces.radius)
    contacts = [  # (angle of the normal to the right [rad], piece or border)
        (math.atan2(z, x), piece)
        for piece, gap, (x, z) in zip(near.tolist(), gaps.tolist(), away.tolist(), strict=True)
        if abs(gap) < CONTACT and x * pieces.passes[piece, 0] + z * pieces.passes[piece, 1] >= 0.0
    ]
    for border, gap in enumerate((border_gaps(ball, board) - board.ball_radius).tolist()):
        if abs(gap) < CONTACT:
            x, z = BORDER_NORMALS[border]
            contacts.append((math.atan2(z, x), count + border))
    nearest_left = max((contact for contact in contacts if contact[0] <= 0.0), default=None)
    nearest_right = min((contact for contact in contacts if contact[0] >= 0.0), default=None)
    if nearest_left is None or nearest_right is None or nearest_left[1] == nearest_right[1]:
        return None
    if nearest_right[0] - nearest_left[0] >= math.pi - ANGLE_TOLERANCE:  # it slides down vertical faces
        return None
    first, second = sorted((nearest_left[1], nearest_right[1]))
    if first >= count:
        return None  # borders alone hold no ball: none of them faces up
    over = [i for i in (first, second) if i < count]
    tops = pieces.core[over, :, 0].max(axis=1) + pieces.radius[over] + board.ball_radius
    if tops.min() - ball[0] < SHALLOW:
        return None
    part, place = int(pieces.part[first]), (float(ball[0]), float(ball[1]))
    if second >= count:
        return Pocket(part, BORDER_NAMES[second - count], place)
    part, other = sorted((part, int(pieces.part[second])))
    return Pocket(part, other, place)


def _crossings(terrain: Terrain) -> Floats | None:
    """The places where a ball touches two pieces and overlaps nothing, [ball, 2]; None for too many pieces.

    Sorted from the lowest up, without duplicates: overlapping walls cross in the same places.
    """
    pieces, board = terrain.pieces, terrain.board
    if len(pieces.radius) == 0:
        return np.empty((0, 2))
    first, second, _, is_complete = near_pairs(pieces, 2.0 * board.ball_radius, MAX_CLOSE_PAIRS)
    if not is_complete:
        return None
    found = []
    for begin in range(0, len(first), CHUNK):
        chunk = slice(begin, begin + CHUNK)
        found.append(_pair_crossings(pieces, first[chunk], second[chunk], board.ball_radius))
    center, bound = pieces.bounds()
    near_border = border_gaps(center, board) - bound[:, None] < 2.0 * board.ball_radius
    found += [
        _border_crossings(pieces, np.nonzero(near)[0], i, board) for i, near in enumerate(near_border.T)
    ]
    balls = np.concatenate(found)
    _, once = np.unique(np.round(balls, DUPLICATE_DECIMALS), axis=0, return_index=True)
    balls = balls[once]
    return balls[terrain.is_clear(balls)]


def _lines(pieces: Pieces, which: Indices, ball_radius: float) -> tuple[Floats, Floats]:
    """The lines of a ball's centre along the faces of pieces: normals n and levels d of n·p = d."""
    normal = outward_normals(pieces.core[which])
    level = (normal * pieces.core[which]).sum(axis=-1)
    return normal, level + (pieces.radius[which] + ball_radius)[:, None]


def _pair_crossings(pieces: Pieces, first: Indices, second: Indices, ball_radius: float) -> Floats:
    """The crossings of the outlines of pairs of pieces, offset by a ball's radius: [ball, 2]."""
    lines, corners, radii = [], [], []
    for which in (first, second):
        lines.append(_lines(pieces, which, ball_radius))
        corners.append(pieces.core[which])
        radii.append(pieces.radius[which] + ball_radius)
    (n1, d1), (n2, d2) = lines
    found = [_line_line(n1[:, :, None], d1[:, :, None], n2[:, None], d2[:, None])]
    for (normal, level), points, radius in (
        (lines[0], corners[1], radii[1]),
        (lines[1], corners[0], radii[0]),
    ):
        found += _line_circle(normal[:, :, None], level[:, :, None], points[:, None], radius[:, None, None])
    found += _circle_circle(
        corners[0][:, :, None], radii[0][:, None, None], corners[1][:, None], radii[1][:, None, None]
    )
    pairs = np.arange(len(first))
    kept = []
    for points in found:  # most crossings of lines and circles do not lie on the outlines
        flat = points.reshape(len(pairs), -1, 2)
        ok = np.asarray(np.isfinite(flat).all(axis=-1))
        for which in (first, second):
            away = offsets(np.where(ok[..., None], flat, 0.0), pieces.core[which][:, None])
            gap = np.sqrt((away**2).sum(axis=-1)) - (pieces.radius[which] + ball_radius)[:, None]
            ok &= np.abs(gap) < CONTACT
        kept.append(flat[ok])
    return np.concatenate(kept)


def _border_crossings(pieces: Pieces, which: Indices, border: int, board: Board) -> Floats:
    """The crossings of the outlines of pieces, offset by a ball's radius, with a border: [ball, 2]."""
    if len(which) == 0:
        return np.empty((0, 2))
    normal = np.array(BORDER_NORMALS[border])
    # On this line the ball touches the border; its distance is the gap at the origin minus the radius.
    level = np.array(board.ball_radius - border_gaps(np.zeros(2), board)[border])
    n, d = _lines(pieces, which, board.ball_radius)
    radius = (pieces.radius[which] + board.ball_radius)[:, None]
    found = [_line_line(n, d, normal, level), *_line_circle(normal, level, pieces.core[which], radius)]
    balls = np.concatenate([points.reshape(-1, 2) for points in found])
    finite: Floats = balls[np.isfinite(balls).all(axis=-1)]
    return finite


def _line_line(n1: Floats, d1: Floats, n2: Floats, d2: Floats) -> Floats:
    """The point with n1·p = d1 and n2·p = d2; not finite for parallel lines."""
    turn = n1[..., 0] * n2[..., 1] - n1[..., 1] * n2[..., 0]
    turn = np.where(np.abs(turn) > PARALLEL, turn, np.nan)
    x = (d1 * n2[..., 1] - d2 * n1[..., 1]) / turn
    z = (d2 * n1[..., 0] - d1 * n2[..., 0]) / turn
    return np.stack([x, z], axis=-1)


def _line_circle(normal: Floats, level: Floats, center: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """The two intersections of a line n·p = d and a circle; not finite if there are none."""
    gap = level - (normal * center).sum(axis=-1)
    square = radius**2 - gap**2
    half = np.sqrt(np.where(square >= 0.0, square, np.nan))
    along = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    foot = center + gap[..., None] * normal
    return foot + half[..., None] * along, foot - half[..., None] * along


def _circle_circle(c1: Floats, r1: Floats, c2: Floats, r2: Floats) -> tuple[Floats, Floats]:
    """The two intersections of two circles; not finite if there are none."""
    between = c2 - c1
    square = (between**2).sum(axis=-1)
    square = np.where(square > 0.0, square, np.nan)
    share = 0.5 * (1.0 + (r1**2 - r2**2) / square)
    height = r1**2 / square - share**2
    height = np.sqrt(np.where(height >= 0.0, height, np.nan))
    across = np.stack([-between[..., 1], between[..., 0]], axis=-1)
    foot = c1 + share[..., None] * between
    return foot + height[..., None] * across, foot - height[..., None] * across
