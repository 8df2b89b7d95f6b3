"""A board of the PinBall domain as a table of the engine.

The unit square of the domain becomes a square of SIDE u, whose edges are the borders of the table. The
domain's x points to +z (right), its y to −x (down):

    z = (x − ½)·SIDE,     x_table = (½ − y)·SIDE

Below the lower edge, which is a wall, lies the gutter that every table has; no ball reaches it.
"""

from __future__ import annotations

from silverball.envs.domain.board_file import DomainBoard, Spot
from silverball.errors import Problem, TableError
from silverball.table import Board, Table
from silverball.table.kinds.hole import Hole
from silverball.table.kinds.wall import Wall
from silverball.table.primitive import Point
from silverball.world import World

SIDE = 10.0  # [u] of a board
EDGE = 0.5  # [u] thickness of the borders
TICK_RATE = 20  # ticks a second; a step of the domain is one
STEP_TRAVEL = 1.0  # ball radii that a ball moves in a step at the speed 1. Source: the paper's code
SPEED_LIMIT = 2.0  # of each component of a velocity, when an impulse is given. Source: the paper's code
TOP_SPEED = SPEED_LIMIT * 2.0**0.5 * (1.0 + 1e-9)  # in any direction, in units of the domain
SLOWEST_HIT = 0.01  # [u/s] the least `hit_speed`


def point_of(spot: Spot) -> Point:
    """The place on the table (x, z) [u] of a place (x, y) of the domain."""
    x, y = spot
    return (0.5 - y) * SIDE, (x - 0.5) * SIDE


def unit_speed(board: DomainBoard) -> float:
    """The speed on the table [u/s] of the speed 1 of the domain."""
    return STEP_TRAVEL * board.ball_radius * SIDE * TICK_RATE


def table_of(board: DomainBoard) -> Table:
    """The table of a board.

    Raises:
        TableError: A ball does not fit where it should start.
    """
    half = 0.5 * SIDE
    middle = -half - 0.5 * EDGE
    floor = Wall(
        name="lower edge",
        points=((middle, -half), (middle, half)),
        thickness=0.5 * EDGE,
        restitution=1.0,
    )
    table = Table(
        format=2,
        name=f"PinBall {board.name}"[:80],
        board=Board(
            length=SIDE + 2.0 * EDGE,
            width=SIDE + 2.0 * EDGE,
            gravity=0.0,
            ball_radius=board.ball_radius * SIDE,
            speed_cap=TOP_SPEED * unit_speed(board),
            hit_speed=SLOWEST_HIT,
            gutter=-half - EDGE,
            wall_thickness=EDGE,
            wall_restitution=1.0,
        ),
        wall=(
            floor,
            *(
                Wall(points=tuple(map(point_of, corners)), closed=True, thickness=0.0, restitution=1.0)
                for corners in board.polygons
            ),
        ),
        hole=(
            Hole(
                name="target",
                center=point_of(board.target),
                radius=board.target_radius * SIDE,
                capture_speed=200.0,
                drain=True,
            ),
        ),
    )
    _refuse_starts(board, table)
    return table


def _refuse_starts(board: DomainBoard, table: Table) -> None:
    """Refuse places where a ball would overlap something, or lie in the target."""
    world, problems = World(table, tick_rate=TICK_RATE), []
    for x, y in board.starts:
        distance = ((x - board.target[0]) ** 2 + (y - board.target[1]) ** 2) ** 0.5
        if world.clearance(*point_of((x, y))) < 0.0:
            problems.append(Problem(f"start {x:g} {y:g}", "a ball would overlap a polygon or an edge there"))
        elif distance <= board.target_radius:
            problems.append(Problem(f"start {x:g} {y:g}", "must not lie in the target"))
    if problems:
        raise TableError(board.name, problems)
