"""A slow, obvious twin of the solver in plain Python, to test against.

It moves the balls in tiny steps and looks for overlaps: just what the solver must never do. When a step
ends in an overlap it is cut in half again and again until the overlap is gone or the step is nothing; then
the contact is where the ball stands. Shapes are lists of corners taken from the table; distances come from
the nearest point of each side. It shares no code with the solver.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from silverball.table import Paddle, Table

STEP = 1e-4  # [s] at 22 u/s a ball moves 1/110 of its radius
SHORTEST = 1e-13  # [s] a cut step this short is none


class Bounce(NamedTuple):
    """A contact: when [s], which ball (0, 1), with what ("ball" or a part's path), where [u], how fast
    [u/s]."""

    time: float
    ball: int
    part: str
    x: float
    z: float
    speed: float


class Body:
    """A ball."""

    def __init__(self, x: float, z: float, vx: float, vz: float) -> None:
        self.x, self.z, self.vx, self.vz = x, z, vx, vz

    def moved(self, h: float, gravity: float) -> Body:
        """The ball h seconds later, in free flight."""
        return Body(
            self.x + self.vx * h - gravity * h * h / 2, self.z + self.vz * h, self.vx - gravity * h, self.vz
        )


class Shape:
    """A part: corners that are joined, rounded by a radius, and its surface."""

    def __init__(self, path: str, corners, radius: float, surface, pivot=None, omega: float = 0.0) -> None:
        self.path, self.corners, self.radius, self.surface = path, corners, radius, surface
        self.pivot, self.omega = pivot, omega  # omega: counter-clockwise as the player sees it

    def nearest(self, x: float, z: float) -> tuple[float, float, float]:
        """Gap between the point and the surface, and the nearest point of the corners' outline."""
        best = (math.inf, 0.0, 0.0)
        count = len(self.corners)
        for i in range(1 if count <= 2 else count):
            (ax, az), (bx, bz) = self.corners[i], self.corners[(i + 1) % count]
            wx, wz = bx - ax, bz - az
            square = wx * wx + wz * wz
            share = min(1.0, max(0.0, ((x - ax) * wx + (z - az) * wz) / square)) if square else 0.0
            px, pz = ax + share * wx, az + share * wz
            best = min(best, (math.hypot(x - px, z - pz), px, pz))
        return best[0] - self.radius, best[1], best[2]


class Twin:
    """A table with balls, in tiny steps."""

    def __init__(self, table: Table, balls: list[tuple[float, float, float, float]]) -> None:
        self.table, self.board = table, table.board
        self.balls: list[Body | None] = [Body(*ball) for ball in balls]
        self.angles = {paddle.side: math.radians(paddle.rest_angle) for paddle in table.paddle}
        self.time = 0.0
        self.bounces: list[Bounce] = []
        self.still = [
            Shape(f"slant_wall[{i}]", (wall.start, wall.end), wall.thickness, wall)
            for i, wall in enumerate(table.slant_wall)
        ]
        self.still += [
            Shape(f"triangular_prism[{i}]", prism.corners(), 0.0, prism)
            for i, prism in enumerate(table.triangular_prism)
        ]
        self.still += [
            Shape(f"cylinder[{i}]", (part.circle()[:2],) * 2, part.circle()[2], part)
            for i, part in enumerate(table.cylinder)
        ]

    def run(self, seconds: float, held: dict[str, bool]) -> list[Bounce]:
        """Go on for some time with the buttons held like this; all bounces so far."""
        end = self.time + seconds
        while self.time < end - SHORTEST:
            self.step(min(STEP, end - self.time), held)
        return self.bounces

    def step(self, h: float, held: dict[str, bool]) -> None:
        """One tiny step; if it ends in an overlap with something that comes nearer, as much of it as has
        none."""
        part, is_cut = h, False
        while h > 0.0:
            balls = [ball and ball.moved(part, self.board.gravity) for ball in self.balls]
            angles = {paddle.side: self.turned(paddle, part, held) for paddle in self.table.paddle}
            met = self.overlap(balls, angles, held)
            if met is not None and part > SHORTEST:
                part, is_cut = part / 2, True
                continue
            self.balls, self.angles = balls, angles
            self.time += part
            h -= part
            if met is not None:
                self.bounce(*met)
            part, is_cut = min(h, part if is_cut else 2 * part), False

    def turned(self, paddle: Paddle, h: float, held: dict[str, bool]) -> float:
        """The angle of a paddle h seconds later."""
        angle = self.angles[paddle.side]
        rest, up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
        if held.get(paddle.side, False):
            return min(up, angle + (up - rest) / paddle.stroke * h)
        return max(rest, angle - (up - rest) / paddle.return_stroke * h)

    def shapes(self, angles: dict[str, float], held: dict[str, bool]) -> list[Shape]:
        """All parts, the paddles where they are and turning as they do."""
        shapes = list(self.still)
        for paddle in self.table.paddle:
            angle = angles[paddle.side]
            rest, up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
            omega = 0.0
            if held.get(paddle.side, False) and angle < up:
                omega = (up - rest) / paddle.stroke
            elif not held.get(paddle.side, False) and angle > rest:
                omega = -(up - rest) / paddle.return_stroke
            if paddle.side == "right":
                omega = -omega
            corners = paddle.corners(math.degrees(angle))
            shapes.append(Shape(f"paddle.{paddle.side}", corners, 0.0, paddle, paddle.pivot, omega))
        return shapes

    def overlap(self, balls, angles, held):
        """The first thing that a ball overlaps and moves towards: what `bounce` needs; None if there is
        none."""
        radius, board = self.board.ball_radius, self.board
        edge = board.width / 2 - board.wall_thickness - radius
        top = board.length / 2 - board.wall_thickness - radius
        for index, ball in enumerate(balls):
            if ball is None:
                continue
            if ball.x < board.gutter:
                return index, "gutter", (1.0, 0.0), (0.0, 0.0), None
            for path, gap, normal in (
                ("board.left", ball.z + edge, (0.0, 1.0)),
                ("board.right", edge - ball.z, (0.0, -1.0)),
                ("board.top", top - ball.x, (-1.0, 0.0)),
            ):
                if gap < 0 and normal[0] * ball.vx + normal[1] * ball.vz < 0:
                    return index, path, normal, (0.0, 0.0), None
            for shape in self.shapes(angles, held):
                gap, px, pz = shape.nearest(ball.x, ball.z)
                if gap >= radius:
                    continue
                away = math.hypot(ball.x - px, ball.z - pz)
                normal = ((ball.x - px) / away, (ball.z - pz) / away)
                surface = (0.0, 0.0)
                if shape.pivot is not None:
                    # The point of the surface under the ball: ω × r with r from the pivot.
                    rx = ball.x - radius * normal[0] - shape.pivot[0]
                    rz = ball.z - radius * normal[1] - shape.pivot[1]
                    surface = (shape.omega * rz, -shape.omega * rx)
                if normal[0] * (ball.vx - surface[0]) + normal[1] * (ball.vz - surface[1]) < 0:
                    return index, shape.path, normal, surface, shape.surface
        a, b = [*balls, None][:2]
        if a is not None and b is not None:
            apart = math.hypot(a.x - b.x, a.z - b.z)
            normal = ((a.x - b.x) / apart, (a.z - b.z) / apart)
            if apart < 2 * radius and normal[0] * (a.vx - b.vx) + normal[1] * (a.vz - b.vz) < 0:
                return 0, "ball", normal, (0.0, 0.0), None
        return None

    def bounce(self, index: int, path: str, normal, surface, part) -> None:
        """Turn the normal part of the velocity round."""
        board = self.board
        ball = self.balls[index]
        nx, nz = normal
        if path == "gutter":
            self.bounces.append(Bounce(self.time, index, path, ball.x, ball.z, -ball.vx))
            self.balls[index] = None
            return
        if path == "ball":
            other = self.balls[1]
            w = -(nx * (ball.vx - other.vx) + nz * (ball.vz - other.vz))
            push = (1 + board.ball_restitution) * w / 2
            ball.vx, ball.vz = ball.vx + push * nx, ball.vz + push * nz
            other.vx, other.vz = other.vx - push * nx, other.vz - push * nz
            self.cap(other)
        else:
            w = -(nx * (ball.vx - surface[0]) + nz * (ball.vz - surface[1]))
            e = (
                board.wall_restitution
                if part is None
                else part.restitution / (1 + part.restitution_falloff * w)
            )
            factor = getattr(part, "speed_factor", 1.0) if w > board.hit_speed else 1.0
            ball.vx, ball.vz = (ball.vx + (1 + e) * w * nx) * factor, (ball.vz + (1 + e) * w * nz) * factor
        self.cap(ball)
        self.bounces.append(Bounce(self.time, index, path, ball.x, ball.z, w))

    def cap(self, ball: Body) -> None:
        """No ball is faster than the cap."""
        speed = math.hypot(ball.vx, ball.vz)
        if speed > self.board.speed_cap:
            ball.vx *= self.board.speed_cap / speed
            ball.vz *= self.board.speed_cap / speed
