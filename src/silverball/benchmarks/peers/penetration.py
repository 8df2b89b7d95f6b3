"""Does a ball get where it cannot be, and how deep does it get into things?

The same checks for every engine, between its steps, by geometry alone. Depth is that of `physics.audit`,
which shares no code with any solver. A ball has *escaped* when its centre is inside a part or behind a
border, or when the way of its centre in one frame has crossed the middle line of a slant wall or of a paddle
(in the paddle's own frame, and short of its tip, which a ball may pass). An escaped ball is taken off the
board.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias

from silverball.benchmarks.peers.engine import Playfield
from silverball.benchmarks.peers.play import Game
from silverball.physics.audit import deepest
from silverball.physics.records import WORLD, records
from silverball.table import Paddle, Table
from silverball.table.parts import Point
from silverball.world.compile import compile_tables

AXIS_SHARE = 0.75  # of a paddle's axis that no ball can cross: the rest a fast one may cut round the tip

Way: TypeAlias = tuple[Point, Point]


class Watched(NamedTuple):
    """What was seen.

    Attributes:
        frames: Frames of 1/60 s watched.
        escapes: Balls that got where they cannot be.
        deepest: The deepest that a ball was inside anything [u], at most its radius: deeper is an escape.
    """

    frames: int
    escapes: int
    deepest: float


class Watcher:
    """Looks at one playfield after each step and each frame."""

    def __init__(self, table: Table) -> None:
        boards = compile_tables([table])
        self.table = table
        self.board, self.colliders = boards.board[0], boards.collider
        self.record: Any = records(1, WORLD)[0]
        self.radius = table.board.ball_radius
        self.depth = 0.0
        self.before: list[Point] = []
        self.angles_before = (0.0, 0.0)

    def depths(self, field: Playfield) -> list[float]:
        """How deep each ball is inside any part or border [u]; the overlap of two balls is kept too."""
        balls = field.balls()
        self.record["paddle"]["angle"] = field.angles()
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
        """Remember where everything is."""
        self.before = [(x, z) for x, z, _, _ in field.balls()]
        self.angles_before = field.angles()

    def escaped(self, field: Playfield) -> list[int]:
        """The balls that were on the board before this frame and have escaped in it."""
        found = []
        angles = field.angles()
        depths = self.depths(field)
        for index, ((x, z, _, _), depth) in enumerate(zip(field.balls(), depths, strict=True)):
            way = (self.before[index], (x, z))
            if depth >= self.radius or self.crosses(way, angles):
                found.append(index)
        return found

    def crosses(self, way: Way, angles: tuple[float, float]) -> bool:
        """Whether the way of a ball's centre crosses the middle line of a slant wall or a paddle."""
        if any(do_cross(way, (wall.start, wall.end)) for wall in self.table.slant_wall):
            return True
        for paddle in self.table.paddle:
            side = paddle.side == "right"
            start = seen_from(paddle, self.angles_before[side], way[0])
            end = seen_from(paddle, angles[side], way[1])
            if do_cross((start, end), ((0.0, 0.0), (0.0, AXIS_SHARE * paddle.length))):
                return True
        return False


def watch(game: Game, frames: int, watcher: Watcher) -> int:
    """Play on and look after each step.

    Returns:
        How many balls have escaped. The greatest depth is kept in the watcher.
    """
    field, escapes = game.field, 0
    for _ in range(frames):
        left, right = next(game.press)
        watcher.start_frame(field)
        count = field.ball_count
        for _ in range(field.stepping.steps):
            field.step(left, right)
            if field.ball_count < count:  # Silverball drains within a step; then nothing pairs up any more
                watcher.start_frame(field)
                count = field.ball_count
            watcher.depths(field)
        for index in reversed(watcher.escaped(field)):
            field.take_ball(index)
            escapes += 1
        field.finish_frame()
        game.fill()
    return escapes


def seen_from(paddle: Paddle, angle: float, point: Point) -> Point:
    """A point (x, z) in the frame of a paddle that stands at an angle [rad]: z′ runs from pivot to tip."""
    side = 1.0 if paddle.side == "left" else -1.0
    dx, dz = point[0] - paddle.pivot[0], side * (point[1] - paddle.pivot[1])
    sine, cosine = math.sin(angle), math.cos(angle)
    return dx * cosine - dz * sine, dx * sine + dz * cosine


def do_cross(first: Way, second: Way) -> bool:
    """Whether two straight ways properly cross."""
    (a, b), (c, d) = first, second
    return turn(a, b, c) * turn(a, b, d) < 0.0 and turn(c, d, a) * turn(c, d, b) < 0.0


def turn(a: Point, b: Point, c: Point) -> float:
    """Positive for c on one side of the line from a to b, negative on the other."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
