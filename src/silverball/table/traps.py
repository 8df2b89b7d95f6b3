"""Where can a ball lie for ever?

A ball at rest is carried in one of two ways: by a face that is level, or by two contacts whose normals
hold it up from both sides. Both are found exactly, not on a grid: faces by their slope, and pairs of
contacts as the crossings of the outlines, a ball's radius further out, of every two parts that are
nearer to each other than a ball is wide (and of every part and border). A crossing counts when

    no other part is in the way,
    straight up lies between the two normals (less than 180° apart), and
    a ball can get there: `Space.reaches`.

and when the way out over the nearer part climbs by more than the hops that every touch leaves.
On a single round top a ball can only balance; that is no trap. Paddles stand at rest here: what a player
must free by hand lies there for ever when nobody plays.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from silverball.table.geometry import (
    AT_ONCE,
    BORDER_NAMES,
    BORDER_NORMALS,
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
from silverball.table.parts import Board, Point
from silverball.table.reach import Space

LEVEL = 2.0  # [deg] a face is level below this slope; chosen: a ball there needs 8 s to slide a table's width
SHALLOW = 1e-4  # [u] a ball hops out of a less deep pocket; chosen: a fifth of the least hop of a touch
CONTACT = 1e-7  # [u] a gap below this is a contact; the crossings themselves are good to 1e-12


class LevelFace(NamedTuple):
    """A face on which a ball can lie: the shape, the slope [deg] and a place for the ball's centre [u]."""

    shape: int
    slope: float
    ball: Point


class Pocket(NamedTuple):
    """Two contacts that hold a ball: the shape, what else it leans on, and the ball's centre [u]."""

    shape: int
    other: int | str
    ball: Point


def level_faces(shapes: Shapes, board: Board, space: Space) -> list[LevelFace]:
    """The faces on which a ball can lie, at most one for each shape."""
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
    """The places where two contacts hold a ball, the lowest first, each once."""
    balls = _crossings(shapes, board)
    found: list[Pocket] = []
    for ball in balls:
        if space.reaches((float(ball[0]), float(ball[1]))):
            pocket = _held(ball, shapes, board)
            if pocket is not None:
                found.append(pocket)
    return found


def _is_clear(balls: Floats, shapes: Shapes, board: Board) -> Bools:
    """Whether balls touch things at most, shape [ball]."""
    inside = border_gaps(balls, board).min(axis=-1) - board.ball_radius > -CONTACT
    is_clear: Bools = inside & clear_of(balls, board.ball_radius, shapes, CONTACT)
    return is_clear


def _gaps(balls: Floats, shapes: Shapes, board: Board) -> Floats:
    """From balls' surfaces to all shapes and the three borders [u], shape [ball, shape + 3]."""
    away = offsets(balls[:, None, :], shapes.core[None])
    to_shapes = np.sqrt((away**2).sum(axis=-1)) - shapes.radius - board.ball_radius
    return np.concatenate([to_shapes, border_gaps(balls, board) - board.ball_radius], axis=1)


def _held(ball: Floats, shapes: Shapes, board: Board) -> Pocket | None:
    """The two contacts that hold a ball at this place, if there are two."""
    gaps = _gaps(ball[None, :], shapes, board)[0]
    contacts: list[tuple[float, int]] = []  # (how far the normal leans to the right [rad], collider)
    for collider in np.nonzero(np.abs(gaps) < CONTACT)[0].tolist():
        if collider < len(shapes.radius):
            x, z = offsets(ball, shapes.core[collider]).tolist()
        else:
            x, z = BORDER_NORMALS[collider - len(shapes.radius)]
        contacts.append((math.atan2(z, x), collider))
    leftmost = max((contact for contact in contacts if contact[0] <= 0.0), default=None)
    rightmost = min((contact for contact in contacts if contact[0] >= 0.0), default=None)
    if leftmost is None or rightmost is None or leftmost[1] == rightmost[1]:
        return None
    if rightmost[0] - leftmost[0] >= math.pi - 1e-9:  # pinched between upright faces: it slides down
        return None
    first, second = sorted((leftmost[1], rightmost[1]))
    count = len(shapes.radius)
    if first >= count:
        return None  # borders alone hold nothing: none of them faces up
    over = [i for i in (first, second) if i < count]
    tops = shapes.core[over, :, 0].max(axis=1) + shapes.radius[over] + board.ball_radius
    if tops.min() - ball[0] < SHALLOW:
        return None
    other = second if second < count else BORDER_NAMES[second - count]
    return Pocket(first, other, (float(ball[0]), float(ball[1])))


def _crossings(shapes: Shapes, board: Board) -> Floats:
    """Every place where a ball touches two colliders at once and nothing is in its way, [ball, 2].

    The lowest first, and each once: walls that lie one on another cross in the same places.
    """
    if len(shapes.radius) == 0:
        return np.empty((0, 2))
    first, second, _ = near_pairs(shapes, 2.0 * board.ball_radius)
    found = []
    for begin in range(0, len(first), AT_ONCE):
        chunk = slice(begin, begin + AT_ONCE)
        found.append(_pair_crossings(shapes, first[chunk], second[chunk], board.ball_radius))
    center, bound = shapes.bounds()
    near_border = border_gaps(center, board) - bound[:, None] < 2.0 * board.ball_radius
    found += [
        _border_crossings(shapes, np.nonzero(near)[0], i, board) for i, near in enumerate(near_border.T)
    ]
    balls = np.concatenate(found)
    _, once = np.unique(np.round(balls, 6), axis=0, return_index=True)
    balls = balls[once]
    return balls[_is_clear(balls, shapes, board)]


def _lines(shapes: Shapes, which: Indices, ball_radius: float) -> tuple[Floats, Floats]:
    """The ball's centre on the faces of shapes: normals n and levels d of n·p = d, [shape, 3(, 2)]."""
    normal = outward_normals(shapes.core[which])
    level = (normal * shapes.core[which]).sum(axis=-1)
    return normal, level + (shapes.radius[which] + ball_radius)[:, None]


def _pair_crossings(shapes: Shapes, first: Indices, second: Indices, ball_radius: float) -> Floats:
    """Where the outlines of pairs of shapes, a ball's radius further out, cross: [ball, 2]."""
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
    for points in found:  # most crossings of whole lines and circles lie off the outlines: drop them early
        flat = points.reshape(len(pairs), -1, 2)
        ok = np.asarray(np.isfinite(flat).all(axis=-1))
        for which in (first, second):
            away = offsets(np.where(ok[..., None], flat, 0.0), shapes.core[which][:, None])
            gap = np.sqrt((away**2).sum(axis=-1)) - (shapes.radius[which] + ball_radius)[:, None]
            ok &= np.abs(gap) < CONTACT
        kept.append(flat[ok])
    return np.concatenate(kept)


def _border_crossings(shapes: Shapes, which: Indices, border: int, board: Board) -> Floats:
    """Where the outlines of shapes, a ball's radius further out, cross the line of a border: [ball, 2]."""
    if len(which) == 0:
        return np.empty((0, 2))
    normal = np.array(BORDER_NORMALS[border])
    # On this line the ball touches the border: its gap at the origin, less the radius, is the distance.
    level = np.array(board.ball_radius - border_gaps(np.zeros(2), board)[border])
    n, d = _lines(shapes, which, board.ball_radius)
    radius = (shapes.radius[which] + board.ball_radius)[:, None]
    found = [_line_line(n, d, normal, level), *_line_circle(normal, level, shapes.core[which], radius)]
    balls = np.concatenate([points.reshape(-1, 2) for points in found])
    finite: Floats = balls[np.isfinite(balls).all(axis=-1)]
    return finite


def _line_line(n1: Floats, d1: Floats, n2: Floats, d2: Floats) -> Floats:
    """Where n1·p = d1 and n2·p = d2; not finite for parallel lines."""
    turn = n1[..., 0] * n2[..., 1] - n1[..., 1] * n2[..., 0]
    turn = np.where(np.abs(turn) > 1e-9, turn, np.nan)
    x = (d1 * n2[..., 1] - d2 * n1[..., 1]) / turn
    z = (d2 * n1[..., 0] - d1 * n2[..., 0]) / turn
    return np.stack([x, z], axis=-1)


def _line_circle(normal: Floats, level: Floats, center: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """Where n·p = d meets a circle: both places; not finite where they do not meet."""
    gap = level - (normal * center).sum(axis=-1)
    square = radius**2 - gap**2
    half = np.sqrt(np.where(square >= 0.0, square, np.nan))
    along = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    foot = center + gap[..., None] * normal
    return foot + half[..., None] * along, foot - half[..., None] * along


def _circle_circle(c1: Floats, r1: Floats, c2: Floats, r2: Floats) -> tuple[Floats, Floats]:
    """Where two circles meet: both places; not finite where they do not meet."""
    between = c2 - c1
    square = (between**2).sum(axis=-1)
    square = np.where(square > 0.0, square, np.nan)
    share = 0.5 * (1.0 + (r1**2 - r2**2) / square)
    height = r1**2 / square - share**2
    height = np.sqrt(np.where(height >= 0.0, height, np.nan))
    across = np.stack([-between[..., 1], between[..., 0]], axis=-1)
    foot = c1 + share[..., None] * between
    return foot + height[..., None] * across, foot - height[..., None] * across
