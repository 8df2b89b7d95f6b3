"""Checks of a layout: the errors that keep a table from being played, and warnings, with their paths.

In this order: the board, the paddles, each part by itself (degenerate, outside the board), what lines, holes,
gates and plungers need (`check_devices.py`), the swing of the paddles, parts against each other (overlaps,
gaps that a ball barely fits), the ways out, the places where a ball would lie forever, and the rules of a
recipe.

What cannot work is an error; what a maker may want, because real tables have it, is a warning, once for each
pair of parts. Single values are validated by the models of the parts, meshes in `mesh.py`; `placement.py`
tries whether a recipe makes boards.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from silverball.errors import Problem
from silverball.physics.forms import Shape
from silverball.physics.tolerances import HOP, HOP_SHARE
from silverball.table.check_devices import device_problems, limit_problems
from silverball.table.geometry import (
    BORDER_NAMES,
    Bools,
    ClosePairs,
    Floats,
    Indices,
    Pieces,
    Triangle,
    border_gaps,
    distances,
    moving_reach,
    near_pairs,
    offsets,
    side_of,
)
from silverball.table.placed_parts import Layout, PlacedPart
from silverball.table.placement_rules import recipe_problems
from silverball.table.primitive import Mover, Primitive
from silverball.table.reach import PASSAGE_MARGIN, Space, creation_floor, resting_pieces, space
from silverball.table.sweep import CLEARANCE, near_paddle, touches_border, touches_paddle, touches_piece
from silverball.table.traps import MAX_CLOSE_PAIRS, Terrain, level_faces, pockets

if TYPE_CHECKING:
    from silverball.table.kinds import Board

MIN_HEIGHT = 0.05  # [u] least height of a triangle and length of a single capsule; chosen: a fifth of a ball
MIN_EDGE = 1e-6  # [u] least length of an edge among others
ROUNDING = 1e-9  # [u] by which a part may extend beyond an edge of the board
MIN_OPEN_SHARE = 0.5  # share of the board that must lead out; corners may be closed off
MAX_LISTED = 100  # warnings of one sort that are listed
TOUCHING = 1e-9  # [u] for the rounding of the middle of a gap


def check_layout(layout: Layout) -> list[Problem]:
    """Find every problem of a layout; an empty list if it can be played and nothing is unusual."""
    board_problems = _board_problems(layout.board)
    limits = limit_problems(layout)
    problems = board_problems + _hop_problems(layout.board) + limits
    for path, paddle in layout.moving():
        problems += _pivot_problems(path, paddle, layout.board) + _speed_problems(path, paddle, layout.board)
    layout, part_problems = _with_extent(layout)
    problems += part_problems
    if board_problems or limits:
        return problems
    ball_space = space(layout)
    pieces = layout.solids()
    problems += device_problems(layout, ball_space)
    problems += _sweep_problems(layout, pieces)
    widest = (2.0 + PASSAGE_MARGIN) * layout.board.ball_radius
    close = near_pairs(pieces, widest, MAX_CLOSE_PAIRS)
    problems += _pair_problems(layout, pieces, ball_space, close, widest)
    problems += _exit_problems(layout, ball_space)
    if not close.is_complete:
        message = (
            f"has more than {MAX_CLOSE_PAIRS:,} pairs of edges between which a ball barely fits or does not: "
            "not all of them were compared, and traps were not searched for; remove parts"
        )
        problems.append(_warning("board", message))
    elif layout.board.gravity > 0.0:  # otherwise a ball may rest anywhere
        problems += _trap_problems(layout, pieces, ball_space)
    if layout.random is not None:
        problems += recipe_problems(layout)
    return problems


def _warning(path: str, message: str) -> Problem:
    return Problem(path, message, "warning")


def _board_problems(board: Board) -> list[Problem]:
    problems = []
    edge = 0.5 * board.length
    if not -edge <= board.gutter <= edge:
        problems.append(
            Problem("board.gutter", f"must lie on the board, {-edge:g} to {edge:g} u, got {board.gutter:g}")
        )
    space_between = min(board.width, board.length) - 2.0 * board.wall_thickness
    if space_between < 4.0 * board.ball_radius:
        message = (
            f"must fit the board: the borders are {space_between:g} u apart, "
            "too little for two balls side by side"
        )
        problems.append(Problem("board.ball_radius", message))
    return problems


def _hop_problems(board: Board) -> list[Problem]:
    """Check that a hop cannot count as a hit: a ball at rest hops, and would score forever."""
    hop = math.sqrt(2.0 * board.gravity * HOP)
    if board.hit_speed >= hop / HOP_SHARE:
        return []
    least = math.ceil(1000.0 * hop / HOP_SHARE) / 1000.0
    message = (
        f"must be at least {least:g} u/s at gravity {board.gravity:g}, "
        f"got {board.hit_speed:g}: a ball at rest hops at {hop:.3g} u/s, which must not count as a hit"
    )
    return [Problem("board.hit_speed", message)]


def _pivot_problems(path: str, paddle: Primitive, board: Board) -> list[Problem]:
    x, z = _mover(paddle).pivot
    if board.gutter < x < 0.5 * board.length and abs(z) < 0.5 * board.width:
        return []
    message = f"must lie on the board and above the gutter, got [{x:g}, {z:g}]"
    return [Problem(f"{path}.pivot", message)]


def _mover(paddle: Primitive) -> Mover:
    assert paddle.mover is not None
    return paddle.mover


def _speed_problems(path: str, paddle: Primitive, board: Board) -> list[Problem]:
    """Check that the tip is slower than the cap; otherwise it would pass through balls that it has hit."""
    mover, reach = _mover(paddle), moving_reach(paddle)
    key = "stroke" if mover.stroke <= mover.return_stroke else "return_stroke"
    stroke = min(mover.stroke, mover.return_stroke)
    travel = (mover.up_angle - mover.rest_angle) * reach  # [u] of the tip
    if mover.is_coil:  # from rest at constant acceleration, the last speed is twice the average
        travel *= 2.0

    def fastest(time: float) -> float:
        return _tip_and_hop(travel / time, reach, board)

    if fastest(stroke) < board.speed_cap:
        return []
    # The speed falls with the time of the stroke; find the least time in whole milliseconds.
    times = (milliseconds / 1000.0 for milliseconds in range(10, 1001))
    shortest = next((time for time in times if fastest(time) < board.speed_cap), None)
    remedy = f"make it {shortest:g} s or longer" if shortest else "make the paddle shorter"
    message = (
        f"makes the tip {travel / stroke:.1f} u/s fast, with its hop {fastest(stroke):.1f}; "
        f"it must stay below the speed cap of {board.speed_cap:g} u/s: {remedy}"
    )
    return [Problem(f"{path}.{key}", message)]


def _tip_and_hop(tip_speed: float, reach: float, board: Board) -> float:
    """[u/s] The speed of the tip plus that of the hop which a touch there may add.

    A hop is at most √(2·A·HOP); at the tip the acceleration A is gravity and ω²·reach.
    """
    return tip_speed + math.sqrt(2.0 * (board.gravity + tip_speed**2 / reach) * HOP)


def _with_extent(layout: Layout) -> tuple[Layout, list[Problem]]:
    """The layout without flat parts, and the problems of parts that are flat or beyond the board."""
    problems: list[Problem] = []
    parts: list[PlacedPart] = []
    for part in layout.parts:
        flat = _flat_problem(part)
        beyond = None if flat else _beyond_problem(part, layout.board)
        problems += [problem for problem in (flat, beyond) if problem]
        if flat is None:
            parts.append(part)
    return layout._replace(parts=tuple(parts)), problems


def _flat_problem(part: PlacedPart) -> Problem | None:
    least = MIN_HEIGHT if len(part.solid) == 1 else MIN_EDGE
    for primitive in part.solid:
        if primitive.shape is Shape.TRIANGLE and _height(np.array(primitive.points)) < MIN_HEIGHT:
            message = f"is flat: the triangle must be at least {MIN_HEIGHT:g} u high everywhere"
            return Problem(part.place, message)
        if primitive.shape in (Shape.CAPSULE, Shape.ARC) and math.dist(*primitive.points) < least:
            ends = "start and end" if len(part.solid) == 1 else "the ends of every edge"
            return Problem(part.place, f"is flat: {ends} must be at least {least:g} u apart")
    return None


def _height(corners: Floats) -> float:
    """[u] The least height of a triangle: twice its area over its longest side."""
    twice_area = float(side_of(corners[0], corners[1], corners[2]))
    longest = math.sqrt(float(((corners - corners[[1, 2, 0]]) ** 2).sum(axis=1).max()))
    return abs(twice_area) / longest if longest > 0.0 else 0.0


def _beyond_problem(part: PlacedPart, board: Board) -> Problem | None:
    """A part that is partly beyond the board is unusual; one that is wholly beyond it is a mistake."""
    half = np.array([0.5 * board.length, 0.5 * board.width])
    beyond, is_outside = 0.0, True
    for primitive in part.primitives:
        points = np.array(primitive.points)
        low, high = points.min(axis=0) - primitive.radius, points.max(axis=0) + primitive.radius
        is_outside &= bool((low > half).any() or (high < -half).any())
        if primitive.shape in (Shape.CIRCLE, Shape.TRIANGLE):
            low_edge = float(points[:, 0].min() - primitive.radius + half[0])
            inner = min(float(border_gaps(points, board).min()) - primitive.radius, low_edge)
            beyond = max(beyond, -inner)
        else:  # walls may run into the borders with their thickness
            beyond = max(beyond, float((np.abs(points) - half).max()))
    if is_outside and part.primitives:
        return Problem(part.place, "lies beyond the edge of the board: move it onto the board")
    if beyond <= ROUNDING:
        return None
    return _warning(part.place, f"extends {beyond:.3g} u beyond the edge of the board: move it inwards")


def _pair_problems(
    layout: Layout, pieces: Pieces, ball_space: Space, close: ClosePairs, widest: float
) -> list[Problem]:
    """Overlaps; and gaps that a ball barely fits, where a ball gets to: once for each pair of parts."""
    board, parts = layout.board, layout.parts
    first, second, gaps, _ = close
    other = pieces.part[first] != pieces.part[second]
    first, second, gaps = first[other], second[other], gaps[other]
    ends = pieces.core[:, 1, None] - pieces.core
    is_wall = (ends[:, 0] != 0.0).any(axis=1) & (ends[:, 2] == 0.0).all(axis=1)  # a core of two points
    walls = is_wall[first] & is_wall[second]
    crossing = _cross(pieces, first, second) & walls
    overlapping = (gaps <= 0.0) & ~walls
    is_tight = (2.0 * board.ball_radius <= gaps) & ~crossing & ~overlapping
    faults: dict[tuple[int, int], str] = {}
    lanes: dict[tuple[int, int], tuple[float, int]] = {}
    for pair in np.nonzero(crossing | overlapping | is_tight)[0].tolist():
        one, two = int(first[pair]), int(second[pair])
        key = (int(pieces.part[one]), int(pieces.part[two]))
        if crossing[pair]:
            faults[key] = "crosses"
        elif overlapping[pair]:
            faults.setdefault(key, "overlaps")
        elif gaps[pair] < lanes.get(key, (math.inf, 0))[0] and _is_lane(
            pieces, one, two, float(gaps[pair]), ball_space
        ):
            lanes[key] = (float(gaps[pair]), pair)
    for polygon in layout.polygons():
        for part in np.unique(pieces.part[polygon.contains(pieces.core[:, 0])]).tolist():
            if part != polygon.part and _share_level(layout, part, polygon.part):
                faults.setdefault((min(part, polygon.part), max(part, polygon.part)), "overlaps")
    problems = []
    for (one, two), fault in sorted(faults.items()):
        remedy = "let the walls meet at their ends" if fault == "crosses" else "move one of the two"
        problems.append(_warning(parts[two].place, f"{fault} {parts[one].path}: {remedy}"))
    problems = _shortened(problems, "overlaps")
    for (one, two), (gap, _) in sorted(lanes.items()):
        problems.append(_gap_problem(parts[two].place, gap, parts[one].path, board))
    problems += _border_lanes(layout, pieces, ball_space, widest)
    return problems


def _shortened(problems: list[Problem], sort: str) -> list[Problem]:
    """The first problems of a sort, and how many more there are."""
    if len(problems) <= MAX_LISTED:
        return problems
    return [*problems[:MAX_LISTED], _warning("", f"and {len(problems) - MAX_LISTED:,} more {sort}")]


def _share_level(layout: Layout, one: int, other: int) -> bool:
    levels = [{level for p in layout.parts[part].solid for level in p.levels} for part in (one, other)]
    return bool(levels[0] & levels[1])


def _is_lane(pieces: Pieces, one: int, two: int, gap: float, ball_space: Space) -> bool:
    """Whether a gap between two pieces is the narrowest place of a lane, and a ball gets there."""
    middle = _middle(pieces.core[one], pieces.core[two], pieces.radius[one], pieces.radius[two])
    levels = int(pieces.levels[one] & pieces.levels[two])
    if not any(ball_space.reaches(middle, level) for level in ball_space.levels if levels >> level & 1):
        return False
    both = np.isin(pieces.part, pieces.part[[one, two]])
    nearest = (distances(np.array(middle), pieces.core[both]) - pieces.radius[both]).min()
    return bool(nearest >= 0.5 * gap - TOUCHING)


def _border_lanes(layout: Layout, pieces: Pieces, ball_space: Space, widest: float) -> list[Problem]:
    """Gaps to a border that a ball barely fits, the narrowest of each part and border."""
    board = layout.board
    if not len(pieces.radius):
        return []
    corner_gaps = border_gaps(pieces.core, board)
    gaps = corner_gaps.min(axis=1) - pieces.radius[:, None]
    narrowest: dict[tuple[int, int], float] = {}
    for piece, border in np.argwhere(gaps < widest).tolist():
        key, gap = (int(pieces.part[piece]), border), float(gaps[piece, border])
        narrowest[key] = min(gap, narrowest.get(key, math.inf))
    problems = []
    for piece, border in np.argwhere((gaps >= 2.0 * board.ball_radius) & (gaps < widest)).tolist():
        part, gap = int(pieces.part[piece]), float(gaps[piece, border])
        corner = pieces.core[piece, np.argmin(corner_gaps[piece, :, border])].tolist()
        levels = [level for level in ball_space.levels if pieces.levels[piece] >> level & 1]
        if gap == narrowest[part, border] and any(
            ball_space.reaches((corner[0], corner[1]), level) for level in levels
        ):
            narrowest[part, border] = -1.0  # reported
            problems.append(_gap_problem(layout.parts[part].place, gap, BORDER_NAMES[border], board))
    return problems


def _gap_problem(path: str, gap: float, other: str, board: Board) -> Problem:
    ball = 2.0 * board.ball_radius
    message = (
        f"leaves {gap:.3f} u to {other}, which a ball of {ball:g} u barely fits: "
        f"leave at least {ball + PASSAGE_MARGIN * board.ball_radius:.2f} u, or less than {ball:g} u"
    )
    return _warning(path, message)


def _cross(pieces: Pieces, first: Indices, second: Indices) -> Bools:
    """Whether pairs of capsules cross away from their ends, bool [pair]."""
    a, b = pieces.core[first, 0], pieces.core[first, 1]
    c, d = pieces.core[second, 0], pieces.core[second, 1]
    crossing = (side_of(a, b, c) * side_of(a, b, d) < 0.0) & (side_of(c, d, a) * side_of(c, d, b) < 0.0)
    some = np.nonzero(crossing)[0]
    ends = np.minimum(
        distances(pieces.core[first[some], :2], pieces.core[second[some], None]).min(axis=1),
        distances(pieces.core[second[some], :2], pieces.core[first[some], None]).min(axis=1),
    )
    crossing[some] = ends > pieces.radius[first[some]] + pieces.radius[second[some]]
    return np.asarray(crossing)


def _middle(first: Floats, second: Floats, first_radius: float, second_radius: float) -> tuple[float, float]:
    """The middle of the gap between two pieces, where they are nearest to each other."""
    best = (math.inf, 0.0, 0.0)
    for points, core, near, far in (
        (first, second, first_radius, second_radius),
        (second, first, second_radius, first_radius),
    ):
        for point, away in zip(points, offsets(points, core), strict=True):
            length = math.hypot(*away)
            share = 0.5 * (length + near - far) / length if length > 0.0 else 0.0
            middle = point - share * away
            best = min(best, (length, float(middle[0]), float(middle[1])))
    return best[1], best[2]


def _sweep_problems(layout: Layout, pieces: Pieces) -> list[Problem]:
    """The parts that the paddles touch while they turn."""
    problems = []
    paddles = layout.moving()
    for index, (path, paddle) in enumerate(paddles):
        for other_path, other in paddles[index + 1 :]:
            angles = touches_paddle(paddle, other)
            if angles is not None:
                at = f"at {angles[0]:.0f} and {angles[1]:.0f} deg"
                message = f"must stay {CLEARANCE:g} u clear of {path}, but comes closer {at}: move them apart"
                problems.append(Problem(other_path, message))
        border = touches_border(paddle, layout.board)
        if border is not None:
            problems.append(_swing_problem(path, border[0], BORDER_NAMES[border[1]]))
        touched: dict[int, float] = {}
        for piece in near_paddle(paddle, pieces).tolist():
            part = int(pieces.part[piece])
            if part not in touched:
                a, b, c = (tuple(point) for point in pieces.core[piece].tolist())
                core: Triangle = (a, b, c)
                angle = touches_piece(paddle, core, float(pieces.radius[piece]))
                if angle is not None:
                    touched[part] = angle
        for part, angle in sorted(touched.items()):
            problems.append(_swing_problem(path, angle, layout.parts[part].path))
    return problems


def _swing_problem(path: str, angle: float, other: str) -> Problem:
    message = f"must stay {CLEARANCE:g} u clear of {other} in its swing, but comes closer at {angle:.0f} deg"
    return Problem(path, f"{message}: move one of the two")


def _exit_problems(layout: Layout, ball_space: Space) -> list[Problem]:
    """Check that a ball can be created, and that it can leave from most of the board."""
    board = layout.board
    above = ball_space.free[0, ball_space.grid.floor_row :]
    leads_out = ball_space.reached[0, ball_space.grid.floor_row :]
    if above.any() and leads_out.sum() >= MIN_OPEN_SHARE * above.sum():
        return []
    if not above.any():
        floor = creation_floor(layout)
        return [Problem("board", f"has no free place for a ball above x = {floor:.2f} u: remove parts")]
    ball = 2.0 * board.ball_radius
    closed = 1.0 - float(leads_out.sum() / above.sum())
    has_drain = any(p.hold is not None and p.hold.is_drain for part in layout.parts for p in part.primitives)
    message = (
        f"has no way to the gutter{' or into a drain' if has_drain else ''} from {closed:.0%} of the places "
        "above the paddles: "
        f"open a gap of more than {ball:g} u"
    )
    return [Problem("board", message)]


def _trap_problems(layout: Layout, pieces: Pieces, ball_space: Space) -> list[Problem]:
    """The places where a ball would lie forever, with the paddles at rest."""
    paddles = layout.moving()
    paths = [*(part.path for part in layout.parts), *(path for path, _ in paddles)]
    places = [*(part.place for part in layout.parts), *(f"{path}.rest_angle" for path, _ in paddles)]
    everything = pieces.joined(resting_pieces(layout))
    problems: dict[tuple[str, ...], Problem] = {}  # once for each pair, on whatever level
    for level in ball_space.levels:
        polygons = [polygon for polygon in layout.polygons() if polygon.levels >> level & 1]
        terrain = Terrain(everything.on_level(level), polygons, layout.board, ball_space, level)
        for part, slope, (x, z) in level_faces(terrain):
            message = (
                f"has a face that is level within {slope:.1f} deg, on which a ball would lie forever at "
                f"[{x:.2f}, {z:.2f}]: turn it by 2 deg or more"
            )
            problems.setdefault((places[part],), _warning(places[part], message))
        for part, other, (x, z) in pockets(terrain) or ():
            beside = other if isinstance(other, str) else "itself" if other == part else paths[other]
            message = (
                f"makes a pocket with {beside}, in which a ball would lie forever at [{x:.2f}, {z:.2f}]: "
                f"open a gap of more than {2.0 * layout.board.ball_radius:g} u or fill the pocket"
            )
            problems.setdefault((places[part], beside), _warning(places[part], message))
    return list(problems.values())
