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

A ball can only balance on a single round top, which is not a trap. Paddles are at rest here: a ball that only
a paddle can free would lie there forever in an unplayed game.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from silverball.table.geometry import (
    BORDER_NAMES,
    BORDER_NORMALS,
    CHUNK,
    Bools,
    Floats,
    Indices,
    Shapes,
    border_gaps,
    clear_of,
    near_pairs,
    offsets,
    outward_normals,
)
from silverball.table.kinds import Board
from silverball.table.primitive import Point
from silverball.table.reach import Space

LEVEL = 2.0  # [deg] a face below this slope is level: a ball on it slides a table's width in 8 s
SHALLOW = 1e-4  # [u] a ball hops out of a shallower pocket: a fifth of the smallest hop of a touch
CONTACT = 1e-7  # [u] a gap below this is a contact; crossings are accurate to 1e-12
ANGLE_TOLERANCE = 1e-9  # [rad] for the rounding of the angle between two normals
PARALLEL = 1e-9  # lines whose directions differ by a smaller sine are parallel
DUPLICATE_DECIMALS = 6  # places that are equal to so many decimals [u] are one


class LevelFace(NamedTuple):
    """A face on which a ball can lie: the shape, the slope [deg], and the ball's centre [u]."""

    shape: int
    slope: float
    ball: Point


class Pocket(NamedTuple):
    """Two contacts that hold a ball: a shape, the other shape or border, and the ball's centre [u]."""

    shape: int
    other: int | str
    ball: Point


def level_faces(shapes: Shapes, board: Board, space: Space) -> list[LevelFace]:
    """Find the faces on which a ball can lie, at most one for each shape."""
    found: dict[int, LevelFace] = {}
    normals = outward_normals(shapes.core)
    for shape, edge in np.argwhere(normals[..., 0] >= math.cos(math.radians(LEVEL))).tolist():
        start, end = shapes.core[shape, edge], shapes.core[shape, (edge + 1) % 3]
        normal = normals[shape, edge]
        count = max(2, int(math.hypot(*(end - start)) / space.grid.step) + 1)
        along = np.linspace(0.0, 1.0, count)[:, None]
        out = normal * (shapes.radius[shape] + board.ball_radius)
        balls = start + along * (end - start) + out
        free = _is_clear(balls, shapes, board)
        for ball in balls[free]:
            place = (float(ball[0]), float(ball[1]))
            if board.gutter < place[0] and space.reaches(place):
                slope = math.degrees(math.atan2(abs(normal[1]), normal[0]))
                found.setdefault(shape, LevelFace(shape, slope, place))
                break
    return list(found.values())


def pockets(shapes: Shapes, board: Board, space: Space) -> list[Pocket]:
    """Find the places where two contacts hold a ball, each once, the lowest first."""
    balls = _crossings(shapes, board)
    found: list[Pocket] = []
    for ball in balls:
        if space.reaches((float(ball[0]), float(ball[1]))):
            pocket = _pocket_at(ball, shapes, board)
            if pocket is not None:
                found.append(pocket)
    return found


def _is_clear(balls: Floats, shapes: Shapes, board: Board) -> Bools:
    """Whether balls overlap nothing, bool [ball]."""
    inside = border_gaps(balls, board).min(axis=-1) - board.ball_radius > -CONTACT
    is_clear: Bools = inside & clear_of(balls, board.ball_radius, shapes, CONTACT)
    return is_clear


def _gaps(balls: Floats, shapes: Shapes, board: Board) -> Floats:
    """The gaps from balls to all shapes and the three borders [u], shape [ball, shape + 3]."""
    away = offsets(balls[:, None, :], shapes.core[None])
    to_shapes = np.sqrt((away**2).sum(axis=-1)) - shapes.radius - board.ball_radius
    return np.concatenate([to_shapes, border_gaps(balls, board) - board.ball_radius], axis=1)


def _pocket_at(ball: Floats, shapes: Shapes, board: Board) -> Pocket | None:
    """The pocket made of the contacts that hold a ball at a place, or None."""
    gaps = _gaps(ball[None, :], shapes, board)[0]
    contacts: list[tuple[float, int]] = []  # (angle of the normal to the right [rad], shape)
    for collider in np.nonzero(np.abs(gaps) < CONTACT)[0].tolist():
        if collider < len(shapes.radius):
            x, z = offsets(ball, shapes.core[collider]).tolist()
        else:
            x, z = BORDER_NORMALS[collider - len(shapes.radius)]
        contacts.append((math.atan2(z, x), collider))
    nearest_left = max((contact for contact in contacts if contact[0] <= 0.0), default=None)
    nearest_right = min((contact for contact in contacts if contact[0] >= 0.0), default=None)
    if nearest_left is None or nearest_right is None or nearest_left[1] == nearest_right[1]:
        return None
    if nearest_right[0] - nearest_left[0] >= math.pi - ANGLE_TOLERANCE:  # it slides down vertical faces
        return None
    first, second = sorted((nearest_left[1], nearest_right[1]))
    count = len(shapes.radius)
    if first >= count:
        return None  # borders alone hold no ball: none of them faces up
    over = [i for i in (first, second) if i < count]
    tops = shapes.core[over, :, 0].max(axis=1) + shapes.radius[over] + board.ball_radius
    if tops.min() - ball[0] < SHALLOW:
        return None
    other = second if second < count else BORDER_NAMES[second - count]
    return Pocket(first, other, (float(ball[0]), float(ball[1])))


def _crossings(shapes: Shapes, board: Board) -> Floats:
    """The places where a ball touches two shapes and overlaps nothing, [ball, 2].

    Sorted from the lowest up, without duplicates: overlapping walls cross in the same places.
    """
    if len(shapes.radius) == 0:
        return np.empty((0, 2))
    first, second, _ = near_pairs(shapes, 2.0 * board.ball_radius)
    found = []
    for begin in range(0, len(first), CHUNK):
        chunk = slice(begin, begin + CHUNK)
        found.append(_pair_crossings(shapes, first[chunk], second[chunk], board.ball_radius))
    center, bound = shapes.bounds()
    near_border = border_gaps(center, board) - bound[:, None] < 2.0 * board.ball_radius
    found += [
        _border_crossings(shapes, np.nonzero(near)[0], i, board) for i, near in enumerate(near_border.T)
    ]
    balls = np.concatenate(found)
    _, once = np.unique(np.round(balls, DUPLICATE_DECIMALS), axis=0, return_index=True)
    balls = balls[once]
    return balls[_is_clear(balls, shapes, board)]


def _lines(shapes: Shapes, which: Indices, ball_radius: float) -> tuple[Floats, Floats]:
    """The lines of a ball's centre along the faces of shapes: normals n and levels d of n·p = d."""
    normal = outward_normals(shapes.core[which])
    level = (normal * shapes.core[which]).sum(axis=-1)
    return normal, level + (shapes.radius[which] + ball_radius)[:, None]


def _pair_crossings(shapes: Shapes, first: Indices, second: Indices, ball_radius: float) -> Floats:
    """The crossings of the outlines of pairs of shapes, offset by a ball's radius: [ball, 2]."""
    lines, corners, radii = [], [], []
    for which in (first, second):
        lines.append(_lines(shapes, which, ball_radius))
        corners.append(shapes.core[which])
        radii.append(shapes.radius[which] + ball_radius)
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
            away = offsets(np.where(ok[..., None], flat, 0.0), shapes.core[which][:, None])
            gap = np.sqrt((away**2).sum(axis=-1)) - (shapes.radius[which] + ball_radius)[:, None]
            ok &= np.abs(gap) < CONTACT
        kept.append(flat[ok])
    return np.concatenate(kept)


def _border_crossings(shapes: Shapes, which: Indices, border: int, board: Board) -> Floats:
    """The crossings of the outlines of shapes, offset by a ball's radius, with a border: [ball, 2]."""
    if len(which) == 0:
        return np.empty((0, 2))
    normal = np.array(BORDER_NORMALS[border])
    # On this line the ball touches the border; its distance is the gap at the origin minus the radius.
    level = np.array(board.ball_radius - border_gaps(np.zeros(2), board)[border])
    n, d = _lines(shapes, which, board.ball_radius)
    radius = (shapes.radius[which] + board.ball_radius)[:, None]
    found = [_line_line(n, d, normal, level), *_line_circle(normal, level, shapes.core[which], radius)]
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
