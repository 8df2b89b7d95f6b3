"""The rules for placing the obstacles of a recipe, and whether they can be met at all.

An obstacle counts as its bounding circle. It must leave `gap` to every other obstacle, and `wall_gap` to the
surface of every wall and to the circle around a turning paddle. Both are wider than a ball, so a ball never
touches an obstacle and something else at once, and no obstacle makes a pocket. Every edge of a prism stays
10° off both axes, so none is level. All lengths are in [u], points are (x, z).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from silverball.errors import Problem
from silverball.physics.forms import Shape
from silverball.table.geometry import (
    Floats,
    Pieces,
    Polygon,
    border_gaps,
    distances,
    is_solid,
    moving_reach,
)
from silverball.table.placed_parts import Layout
from silverball.table.primitive import Primitive
from silverball.table.reach import PASSAGE_MARGIN

if TYPE_CHECKING:
    from silverball.table.kinds import Board
    from silverball.table.recipe import RandomRecipe

EDGE_ANGLE = 10  # [deg] least angle between an edge of a placed prism and an axis
_TRIALS = 48  # sample points along each side of the area

# Angles are drawn as integers, in tenths of a degree: exact, and readable in the file.
_TENTHS = 10


class Surroundings(NamedTuple):
    """What is on the playfield before anything is placed.

    Attributes:
        board: The board, for its borders.
        walls: Walls and everything else that is not an obstacle, and the area in which sensors and holes act.
        polygons: The insides of closed walls.
        paddle_circles: A circle around the reach of each paddle: x, z, radius, [paddle, 3].
        obstacle_circles: The bounding circles of the obstacles, single circles and triangles: x, z, radius,
            [obstacle, 3].
    """

    board: Board
    walls: Pieces
    polygons: list[Polygon]
    paddle_circles: Floats
    obstacle_circles: Floats

    @classmethod
    def of(cls, layout: Layout) -> Surroundings:
        """Return the surroundings that a layout makes."""
        board = layout.board
        obstacles, others = [], []
        for part in layout.parts:
            primitives = [p for p in part.primitives if p.shape is not Shape.PLANE and 0 in p.levels]
            is_obstacle = len(primitives) == 1 and is_solid(primitives[0])
            if is_obstacle and primitives[0].shape in (Shape.CIRCLE, Shape.TRIANGLE):
                obstacles.append(primitives)
            else:
                exits = [p.hold.exit for p in primitives if p.hold is not None and p.hold.exit_level == 0]
                arriving = [Primitive(Shape.DISC, (point,), board.ball_radius) for point in exits]
                others.append([*primitives, *arriving])
        center, radius = Pieces.of(obstacles).bounds()
        circles = np.concatenate([center, radius[:, None]], axis=1)
        paddles = [paddle for _, paddle in layout.moving() if paddle.mover is not None and 0 in paddle.levels]
        turning = [(*paddle.mover.pivot, moving_reach(paddle)) for paddle in paddles if paddle.mover]
        polygons = [polygon for polygon in layout.polygons() if polygon.levels & 1]
        return cls(
            board,
            Pieces.of(others),
            polygons,
            np.array(turning, dtype=np.float64).reshape(-1, 3),
            circles,
        )

    def wall_distances(self, points: Floats) -> Floats:
        """Return the distances [u] of points [..., 2] to the nearest wall or paddle circle, shape [...].

        Inside a closed wall they are negative.
        """
        nearest = border_gaps(points, self.board).min(axis=-1)
        nearest = np.minimum(nearest, points[..., 0] - self.board.gutter)
        if len(self.walls.radius):
            to_walls = distances(points[..., None, :], self.walls.core) - self.walls.radius
            nearest = np.minimum(nearest, to_walls.min(axis=-1))
        for polygon in self.polygons:
            inside = polygon.contains(points.reshape(-1, 2)).reshape(points.shape[:-1])
            nearest = np.where(inside, -math.inf, nearest)
        return np.asarray(np.minimum(nearest, circle_distances(points, self.paddle_circles)))


def circle_distances(points: Floats, circles: Floats) -> Floats:
    """Return the distance [u] of points [..., 2] to the nearest circle [circle, 3]; infinite without any."""
    away = points[..., None, :] - circles[:, :2]
    nearest: Floats = (np.sqrt((away**2).sum(axis=-1)) - circles[:, 2]).min(axis=-1, initial=math.inf)
    return nearest


def allowed_rotations(recipe: RandomRecipe) -> list[float]:
    """Return the rotations [deg] that an equilateral prism may have, in steps of a tenth.

    Its edges run at 30° plus its rotation, modulo 60°; the axes lie at 0° and 30°. So an edge is as far from
    an axis as the rotation is from a multiple of 30°.
    """
    low, high = (bound * _TENTHS for bound in recipe.rotation)
    least, period = EDGE_ANGLE * _TENTHS, 30 * _TENTHS
    tenths = range(math.ceil(low - 1e-9), math.floor(high + 1e-9) + 1)
    return [tenth / _TENTHS for tenth in tenths if least <= tenth % period <= period - least]


def recipe_problems(layout: Layout) -> list[Problem]:
    """Find the rules of a recipe that no layout can meet."""
    board, recipe = layout.board, layout.random
    assert recipe is not None
    problems = []
    least = (2.0 + PASSAGE_MARGIN) * board.ball_radius
    for key in ("gap", "wall_gap"):
        given = getattr(recipe, key)
        if given < least:
            message = (
                f"must let a ball of {2.0 * board.ball_radius:g} u pass: {least:.2f} u or more, got {given:g}"
            )
            problems.append(Problem(f"random.{key}", message))
    if recipe.triangular_prisms and not allowed_rotations(recipe):
        low, high = recipe.rotation
        message = (
            f"leaves no angle at which every edge of a prism is {EDGE_ANGLE} deg off both axes, "
            f"got [{low:g}, {high:g}]: 10 to 20, 40 to 50 and 70 to 80 deg are such angles"
        )
        problems.append(Problem("random.rotation", message))
    (low_x, low_z), (high_x, high_z) = recipe.area
    edge_x, edge_z = 0.5 * board.length, 0.5 * board.width
    if low_x > edge_x or high_x < board.gutter or low_z > edge_z or high_z < -edge_z:
        return [*problems, Problem("random.area", "must lie on the board and above the gutter")]
    sizes = [recipe.prism_size[0]] * (recipe.triangular_prisms > 0)
    sizes += [recipe.cylinder_radius[0]] * (recipe.cylinders > 0)
    if not sizes:
        return problems
    around = Surroundings.of(layout)
    x, z = np.linspace(low_x, high_x, _TRIALS), np.linspace(low_z, high_z, _TRIALS)
    rows = (np.stack([np.full_like(z, height), z], axis=-1) for height in x)  # to bound the memory
    widest = max(float(around.wall_distances(row).max()) for row in rows)
    if widest < max(sizes) + recipe.wall_gap:
        message = (
            f"leaves no place in the area for an obstacle of {max(sizes):g} u: its centre is at most "
            f"{widest:.2f} u from the nearest wall or paddle, and needs {max(sizes) + recipe.wall_gap:g} u"
        )
        problems.append(Problem("random.wall_gap", message))
    return problems
