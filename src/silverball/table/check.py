"""Checks of a layout: every reason why a table cannot be played, with its path in the file.

In this order: each part by itself (degenerate, outside the board, a paddle faster than the cap), parts
against each other (overlaps, gaps that a ball barely fits), the swing of the paddles, the path to the gutter,
the places where a ball would lie forever, and the rules of a recipe.

Single values are validated in `parts.py`, meshes in `mesh.py`; `placement.py` tries whether a recipe makes
boards.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from silverball.errors import Problem
from silverball.physics.tolerances import HOP, HOP_SHARE
from silverball.table.geometry import (
    BORDER_NAMES,
    Floats,
    Shapes,
    border_gaps,
    distances,
    near_pairs,
    offsets,
    side_of,
)
from silverball.table.kinds import Board, Cylinder, Paddle, Part, SlantWall, StationaryPart, TriangularPrism
from silverball.table.placement_rules import recipe_problems
from silverball.table.reach import PASSAGE_MARGIN, Space, creation_floor, space
from silverball.table.recipe import RandomRecipe
from silverball.table.sweep import CLEARANCE, touches_border, touches_paddle, touches_shape
from silverball.table.traps import level_faces, pockets

if TYPE_CHECKING:
    from silverball.table.table import Table

MIN_HEIGHT = 0.05  # [u] least height of a triangle and length of a slant wall; chosen: a fifth of a ball
ROUNDING = 1e-9  # [u] by which a part may extend beyond an edge of the board
MIN_OPEN_SHARE = 0.5  # share of the board that must lead to the gutter; corners may be closed off
MAX_CLOSE_PAIRS = 4000  # pairs of parts closer than a ball is wide; an arc of 256 short walls makes 2,500
MAX_OVERLAPS_LISTED = 100  # with more overlaps, traps are not searched for


class Layout(NamedTuple):
    """The parts of a table, each with its path in the file.

    A file with mistakes has a layout too, made of its valid parts.
    """

    board: Board
    slant_walls: tuple[tuple[str, SlantWall], ...] = ()
    paddles: tuple[tuple[str, Paddle], ...] = ()
    triangular_prisms: tuple[tuple[str, TriangularPrism], ...] = ()
    cylinders: tuple[tuple[str, Cylinder], ...] = ()
    random: RandomRecipe | None = None

    @classmethod
    def of(cls, table: Table) -> Layout:
        """Return the layout of a whole table."""
        return cls.of_parts(table.board, [(path, part) for path, _, part in table.parts()], table.random)

    @classmethod
    def of_parts(
        cls, board: Board, parts: Sequence[tuple[str, Part]], recipe: RandomRecipe | None = None
    ) -> Layout:
        """Return the layout of some parts, each with its path in the file."""
        paddles = [(path, part) for path, part in parts if isinstance(part, Paddle)]
        return cls(
            board,
            tuple((path, part) for path, part in parts if isinstance(part, SlantWall)),
            tuple(sorted(paddles, key=lambda item: int(item[0][7:-1]))),  # in the order of the file
            tuple((path, part) for path, part in parts if isinstance(part, TriangularPrism)),
            tuple((path, part) for path, part in parts if isinstance(part, Cylinder)),
            recipe,
        )


class Measured(NamedTuple):
    """The stationary parts of a layout that have an extent, with their shapes."""

    paths: list[str]
    parts: list[StationaryPart]
    shapes: Shapes


def check_layout(layout: Layout) -> list[Problem]:
    """Find every problem of a layout; an empty list if it can be played."""
    board_problems = _board_problems(layout.board)
    paddle_problems = _paddle_problems(layout)
    problems = board_problems + _hop_problems(layout.board) + paddle_problems
    stationary, part_problems = _stationary(layout)
    problems += part_problems
    if board_problems:
        return problems
    layout = layout._replace(paddles=_one_per_side(layout.paddles))  # the others are problems already
    overlaps, tight = _pair_problems(stationary, layout.board)
    problems += overlaps[:MAX_OVERLAPS_LISTED]
    if len(overlaps) > MAX_OVERLAPS_LISTED:
        problems.append(Problem("", f"and {len(overlaps) - MAX_OVERLAPS_LISTED:,} more overlaps"))
    problems += _sweep_problems(layout, stationary)
    paddles = tuple(paddle for _, paddle in layout.paddles)
    outlines = [part.outline() for part in stationary.parts]
    ball_space = space(layout.board, paddles, outlines)
    problems += [problem for problem, place in tight if ball_space.reaches(place)]
    problems += _exit_problems(layout, paddles, ball_space)
    crowd = _crowd_problems(stationary, layout.board)
    problems += crowd
    can_rest_anywhere = layout.board.gravity == 0.0
    if len(overlaps) <= MAX_OVERLAPS_LISTED and not crowd and not can_rest_anywhere:
        problems += _trap_problems(layout, stationary, ball_space)
    if layout.random is not None:
        problems += recipe_problems(layout.board, stationary.parts, paddles, layout.random)
    return problems


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


def _paddle_problems(layout: Layout) -> list[Problem]:
    """Problems of single paddles: on the board, slower than the cap."""
    problems = []
    for path, paddle in layout.paddles:
        x, z = paddle.pivot
        if not (layout.board.gutter < x < 0.5 * layout.board.length and abs(z) < 0.5 * layout.board.width):
            message = f"must lie on the board and above the gutter, got [{x:g}, {z:g}]"
            problems.append(Problem(f"{path}.pivot", message))
        problems += _speed_problems(path, paddle, layout.board)
    return problems


def _one_per_side(paddles: tuple[tuple[str, Paddle], ...]) -> tuple[tuple[str, Paddle], ...]:
    """The first paddle of each side."""
    first = {paddle.side: (path, paddle) for path, paddle in reversed(paddles)}
    return tuple(sorted(first.values(), key=lambda item: item[0]))


def _speed_problems(path: str, paddle: Paddle, board: Board) -> list[Problem]:
    """Check that the tip is slower than the cap; otherwise it would pass through balls that it has hit."""
    if _tip_and_hop(paddle.tip_speed, paddle, board) < board.speed_cap:
        return []
    quick = "stroke" if paddle.stroke <= paddle.return_stroke else "return_stroke"
    travel = paddle.tip_speed * getattr(paddle, quick)  # [u] of the tip
    # The speed falls with the time of the stroke; find the least time in whole milliseconds.
    times = (milliseconds / 1000.0 for milliseconds in range(10, 1001))
    possible = (time for time in times if _tip_and_hop(travel / time, paddle, board) < board.speed_cap)
    shortest = next(possible, None)
    remedy = f"make it {shortest:g} s or longer" if shortest else "make the paddle shorter"
    message = (
        f"makes the tip {paddle.tip_speed:.1f} u/s fast, with its hop "
        f"{_tip_and_hop(paddle.tip_speed, paddle, board):.1f}; "
        f"it must stay below the speed cap of {board.speed_cap:g} u/s: {remedy}"
    )
    return [Problem(f"{path}.{quick}", message)]


def _tip_and_hop(tip_speed: float, paddle: Paddle, board: Board) -> float:
    """[u/s] The speed of the tip plus that of the hop which a touch there may add.

    A hop is at most √(2·A·HOP); at the tip the acceleration A is gravity and ω²·reach.
    """
    return tip_speed + math.sqrt(2.0 * (board.gravity + tip_speed**2 / paddle.reach) * HOP)


def _stationary(layout: Layout) -> tuple[Measured, list[Problem]]:
    """The stationary parts with an extent, and the problems of those without one or beyond the board."""
    problems: list[Problem] = []
    paths: list[str] = []
    parts: list[StationaryPart] = []
    everything: tuple[tuple[str, StationaryPart], ...] = (
        *layout.slant_walls,
        *layout.triangular_prisms,
        *layout.cylinders,
    )
    for path, part in everything:
        problem = _own_problem(path, part, layout.board)
        if problem is None or not problem.message.startswith("is flat"):
            paths.append(path)
            parts.append(part)
        if problem is not None:
            problems.append(problem)
    return Measured(paths, parts, Shapes.of([part.outline() for part in parts])), problems


def _own_problem(path: str, part: StationaryPart, board: Board) -> Problem | None:
    core, radius = part.outline()
    points = np.array(core)
    path = f"{path}.{_place_key(part)}"
    if isinstance(part, SlantWall):
        if math.dist(part.start, part.end) < MIN_HEIGHT:
            return Problem(path, f"is flat: start and end must be at least {MIN_HEIGHT:g} u apart")
        beyond = max(abs(x) - 0.5 * board.length for x, _ in core[:2])
        beyond = max(beyond, *(abs(z) - 0.5 * board.width for _, z in core[:2]))
    else:
        if isinstance(part, TriangularPrism) and _height(points) < MIN_HEIGHT:
            return Problem(path, f"is flat: the triangle must be at least {MIN_HEIGHT:g} u high everywhere")
        low_edge = points[:, 0].min() - radius + 0.5 * board.length
        beyond = -min(float(border_gaps(points, board).min()) - radius, float(low_edge))
    if beyond > ROUNDING:
        return Problem(path, f"extends {beyond:.3g} u beyond the edge of the board: move it inwards")
    return None


def _height(corners: Floats) -> float:
    """[u] The least height of a triangle: twice its area over its longest side."""
    twice_area = float(side_of(corners[0], corners[1], corners[2]))
    longest = math.sqrt(float(((corners - corners[[1, 2, 0]]) ** 2).sum(axis=1).max()))
    return abs(twice_area) / longest if longest > 0.0 else 0.0


def _place_key(part: StationaryPart) -> str:
    """The key of a part's position."""
    if isinstance(part, SlantWall):
        return "end"
    return "vertices" if isinstance(part, TriangularPrism) and part.vertices is not None else "center"


def _pair_problems(
    stationary: Measured, board: Board
) -> tuple[list[Problem], list[tuple[Problem, tuple[float, float]]]]:
    """Overlaps; and gaps that a ball barely fits, each with the middle of the gap."""
    overlaps: list[Problem] = []
    tight: list[tuple[Problem, tuple[float, float]]] = []
    shapes, parts, paths = stationary.shapes, stationary.parts, stationary.paths
    if not parts:
        return overlaps, tight
    widest = (2.0 + PASSAGE_MARGIN) * board.ball_radius
    first, second, gaps = near_pairs(shapes, widest)
    for one, other, gap in zip(first.tolist(), second.tolist(), gaps.tolist(), strict=True):
        path = f"{paths[other]}.{_place_key(parts[other])}"
        walls = isinstance(parts[one], SlantWall) and isinstance(parts[other], SlantWall)
        if walls and _cross(parts[one], parts[other]):
            overlaps.append(Problem(path, f"crosses {paths[one]}: let the walls meet at their ends"))
        elif not walls and gap <= 0.0:
            overlaps.append(Problem(path, f"overlaps {paths[one]}: move one of the two"))
        elif 2.0 * board.ball_radius <= gap < widest:
            place = _middle(shapes.core[one], shapes.core[other])
            tight.append((_gap_problem(path, gap, paths[one], board), place))
    to_border = border_gaps(shapes.core, board).min(axis=1) - shapes.radius[:, None]
    for shape, border in np.argwhere((to_border >= 2.0 * board.ball_radius) & (to_border < widest)).tolist():
        path = f"{paths[shape]}.{_place_key(parts[shape])}"
        corner = shapes.core[shape, np.argmin(border_gaps(shapes.core[shape], board)[:, border])]
        problem = _gap_problem(path, float(to_border[shape, border]), BORDER_NAMES[border], board)
        tight.append((problem, (float(corner[0]), float(corner[1]))))
    return overlaps, tight


def _crowd_problems(stationary: Measured, board: Board) -> list[Problem]:
    """Limit the number of close pairs: slant walls may overlap, but each pair may make pockets."""
    pairs = len(near_pairs(stationary.shapes, 2.0 * board.ball_radius)[0])
    if pairs <= MAX_CLOSE_PAIRS:
        return []
    message = (
        f"has {pairs:,} pairs of parts between which no ball fits, at most {MAX_CLOSE_PAIRS:,}: remove parts"
    )
    return [Problem("board", message)]


def _gap_problem(path: str, gap: float, other: str, board: Board) -> Problem:
    ball = 2.0 * board.ball_radius
    message = (
        f"leaves {gap:.3f} u to {other}, which a ball of {ball:g} u barely fits: "
        f"leave at least {ball + PASSAGE_MARGIN * board.ball_radius:.2f} u, or less than {ball:g} u"
    )
    return Problem(path, message)


def _cross(one: StationaryPart, other: StationaryPart) -> bool:
    """Whether two slant walls cross away from their ends."""
    (a, b, _), near = one.outline()
    (c, d, _), far = other.outline()
    points = [np.array(point) for point in (a, b, c, d)]
    if side_of(points[0], points[1], points[2]) * side_of(points[0], points[1], points[3]) >= 0.0:
        return False
    if side_of(points[2], points[3], points[0]) * side_of(points[2], points[3], points[1]) >= 0.0:
        return False
    ends = np.concatenate(
        [
            distances(np.array([a, b]), np.array([c, d, d])),
            distances(np.array([c, d]), np.array([a, b, b])),
        ]
    )
    return bool(ends.min() > near + far)


def _middle(first: Floats, second: Floats) -> tuple[float, float]:
    """The midpoint between the nearest points of two cores."""
    best = (math.inf, 0.0, 0.0)
    for points, core in ((first, second), (second, first)):
        for point, away in zip(points, offsets(points, core), strict=True):
            middle = point - 0.5 * away
            best = min(best, (math.hypot(*away), float(middle[0]), float(middle[1])))
    return best[1], best[2]


def _sweep_problems(layout: Layout, stationary: Measured) -> list[Problem]:
    """The parts that the paddles touch while they turn."""
    problems = []
    for index, (path, paddle) in enumerate(layout.paddles):
        for other_path, other in layout.paddles[index + 1 :]:
            angles = touches_paddle(paddle, other)
            if angles is not None:
                at = f"at {angles[0]:.0f} and {angles[1]:.0f} deg"
                message = f"must stay {CLEARANCE:g} u clear of {path}, but comes closer {at}: move them apart"
                problems.append(Problem(other_path, message))
        border = touches_border(paddle, layout.board)
        if border is not None:
            problems.append(_swing_problem(path, border[0], BORDER_NAMES[border[1]]))
        for other_path, part in zip(stationary.paths, stationary.parts, strict=True):
            angle = touches_shape(paddle, *part.outline())
            if angle is not None:
                problems.append(_swing_problem(path, angle, other_path))
    return problems


def _swing_problem(path: str, angle: float, other: str) -> Problem:
    message = f"must stay {CLEARANCE:g} u clear of {other} in its swing, but comes closer at {angle:.0f} deg"
    return Problem(path, f"{message}: move one of the two")


def _exit_problems(layout: Layout, paddles: tuple[Paddle, ...], ball_space: Space) -> list[Problem]:
    """Check that a ball can be created, and that it can leave from most of the board."""
    board = layout.board
    above = ball_space.free[ball_space.grid.floor_row :]
    leads_out = ball_space.reached[ball_space.grid.floor_row :]
    if above.any() and leads_out.sum() >= MIN_OPEN_SHARE * above.sum():
        return []
    if not above.any():
        floor = creation_floor(board, paddles)
        return [Problem("board", f"has no free place for a ball above x = {floor:.2f} u: remove parts")]
    ball = 2.0 * board.ball_radius
    closed = 1.0 - float(leads_out.sum() / above.sum())
    message = (
        f"has no way to the gutter from {closed:.0%} of the places above the paddles: "
        f"open a gap of more than {ball:g} u"
    )
    return [Problem("board", message)]


def _trap_problems(layout: Layout, stationary: Measured, ball_space: Space) -> list[Problem]:
    """The places where a ball would lie forever, with the paddles at rest."""
    resting = [(paddle.corners(paddle.rest_angle), 0.0) for _, paddle in layout.paddles]
    shapes = Shapes.of([*(part.outline() for part in stationary.parts), *resting])
    paths = [*stationary.paths, *(path for path, _ in layout.paddles)]
    keys = [*(_place_key(part) for part in stationary.parts), *("rest_angle" for _ in layout.paddles)]
    problems = []
    for shape, slope, (x, z) in level_faces(shapes, layout.board, ball_space):
        message = (
            f"has a face that is level within {slope:.1f} deg, on which a ball would lie forever at "
            f"[{x:.2f}, {z:.2f}]: turn it by 2 deg or more"
        )
        problems.append(Problem(f"{paths[shape]}.{keys[shape]}", message))
    for shape, other, (x, z) in pockets(shapes, layout.board, ball_space):
        beside = other if isinstance(other, str) else paths[other]
        message = (
            f"makes a pocket with {beside}, in which a ball would lie forever at [{x:.2f}, {z:.2f}]: "
            f"open a gap of more than {2.0 * layout.board.ball_radius:g} u or fill the pocket"
        )
        problems.append(Problem(f"{paths[shape]}.{keys[shape]}", message))
    return problems
