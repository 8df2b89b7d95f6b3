"""Escapes and penetration: balls in impossible positions, and how deeply they overlap with parts.

Every engine is checked in the same way, between its steps, by geometry alone. Depth is that of
`physics.audit`, which shares no code with any solver. A ball has *escaped* if its centre is inside a part or
behind a border, or if its centre crossed the middle line of a slant wall or of a paddle within one frame (in
the paddle's own frame of reference, and short of its tip, which a ball may pass). An escaped ball is removed.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias

from silverball.benchmarks.peers.playfield import Playfield
from silverball.benchmarks.peers.random_play import Game
from silverball.physics.audit import deepest
from silverball.physics.records import records
from silverball.table import Paddle, Table
from silverball.table.primitive import Point
from silverball.world.compile import compile_tables

AXIS_SHARE = 0.75  # of a paddle's axis that no ball can cross; a fast ball may cut across the rest

Segment: TypeAlias = tuple[Point, Point]


class Penetration(NamedTuple):
    """Result of the checks.

    Attributes:
        frames: Frames of 1/60 s that were checked.
        escapes: Balls that reached an impossible position.
        deepest: Deepest overlap of a ball with anything [u], at most its radius: deeper is an escape.
    """

    frames: int
    escapes: int
    deepest: float


class PenetrationMonitor:
    """Checks one playfield after each step and each frame.

    Attributes:
        depth: Deepest overlap so far [u].
    """

    def __init__(self, table: Table) -> None:
        boards = compile_tables([table])
        self.table = table
        self.board, self.colliders = boards.board[0], boards.collider
        self.record: Any = records(1, boards.layout)[0]
        self.radius = table.board.ball_radius
        self.depth = 0.0
        self.before: list[Point] = []
        self.angles_before = (0.0, 0.0)

    def depths(self, field: Playfield) -> list[float]:
        """Overlap of each ball with parts and borders [u]; updates `depth`, by the overlap of balls too."""
        balls = field.balls()
        self.record["paddle"]["angle"][:2] = field.angles()
        found = []
        for x, z, _, _ in balls:
            self.record["ball"][0]["x"], self.record["ball"][0]["z"], self.record["ball"][0]["id"] = x, z, 1
            found.append(float(deepest(self.record, self.board, self.colliders)))
        overlap = 0.0
        for index, (x, z, _, _) in enumerate(balls):
            for other in balls[:index]:
                overlap = max(overlap, 2.0 * self.radius - math.hypot(x - other[0], z - other[1]))
        self.depth = max(self.depth, min(max([overlap, *found]), self.radius))
        return found

    def start_frame(self, field: Playfield) -> None:
        """Store the positions at the start of a frame."""
        self.before = [(x, z) for x, z, _, _ in field.balls()]
        self.angles_before = field.angles()

    def escaped(self, field: Playfield) -> list[int]:
        """Indices of the balls that escaped in this frame."""
        found = []
        angles = field.angles()
        depths = self.depths(field)
        for index, ((x, z, _, _), depth) in enumerate(zip(field.balls(), depths, strict=True)):
            path = (self.before[index], (x, z))
            if depth >= self.radius or self.crosses(path, angles):
                found.append(index)
        return found

    def crosses(self, path: Segment, angles: tuple[float, float]) -> bool:
        """Whether the path of a ball's centre crosses the middle line of a slant wall or a paddle."""
        if any(do_cross(path, (wall.start, wall.end)) for wall in self.table.slant_wall):
            return True
        for paddle in self.table.paddle:
            side = paddle.side == "right"
            start = in_paddle_frame(paddle, self.angles_before[side], path[0])
            end = in_paddle_frame(paddle, angles[side], path[1])
            if do_cross((start, end), ((0.0, 0.0), (0.0, AXIS_SHARE * paddle.length))):
                return True
        return False


def play_monitored(game: Game, frames: int, monitor: PenetrationMonitor) -> int:
    """Play, and check the balls after each step.

    Returns:
        Number of balls that escaped. The greatest depth is in the monitor.
    """
    field, escapes = game.field, 0
    for _ in range(frames):
        left, right = next(game.press)
        monitor.start_frame(field)
        count = field.ball_count
        for _ in range(field.stepping.steps):
            field.step(left, right)
            if (
                field.ball_count < count
            ):  # Silverball drains balls within a step; the others move up in the list
                monitor.start_frame(field)
                count = field.ball_count
            monitor.depths(field)
        for index in reversed(monitor.escaped(field)):
            field.remove_ball(index)
            escapes += 1
        field.finish_frame()
        game.fill()
    return escapes


def in_paddle_frame(paddle: Paddle, angle: float, point: Point) -> Point:
    """A point (x, z) in the frame of a paddle at an angle [rad]; z′ runs from the pivot to the tip."""
    side = 1.0 if paddle.side == "left" else -1.0
    dx, dz = point[0] - paddle.pivot[0], side * (point[1] - paddle.pivot[1])
    sine, cosine = math.sin(angle), math.cos(angle)
    return dx * cosine - dz * sine, dx * sine + dz * cosine


def do_cross(first: Segment, second: Segment) -> bool:
    """Whether two segments properly cross."""
    (a, b), (c, d) = first, second
    return (
        orientation(a, b, c) * orientation(a, b, d) < 0.0
        and orientation(c, d, a) * orientation(c, d, b) < 0.0
    )


def orientation(a: Point, b: Point, c: Point) -> float:
    """Sign of the turn a → b → c: positive on one side of the line from a to b, negative on the other."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
