"""A slow, obvious twin of the solver in plain Python, to test against.

It moves the balls in tiny steps and checks for overlaps: just what the solver must never do. When a step
ends in an overlap it is cut in half again and again until the overlap is gone or the step is negligible; then
the contact is where the ball stands. Shapes are lists of corners taken from the table; distances come from
the nearest point of each side. Friction is the law itself, in three dimensions. It shares no code with the
solver.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from silverball.table import Board, Paddle, Table

STEP = 1e-4  # [s] at 22 u/s a ball moves 1/110 of its radius
SHORTEST = 1e-13  # [s] a shorter step is negligible


class Bounce(NamedTuple):
    """A contact: when [s], which ball (0, 1), with what ("ball" or a part's path), where [u], how fast
    [u/s]."""

    time: float
    ball: int
    part: str
    x: float
    z: float
    speed: float


Vector = tuple[float, float, float]
"""(x, y, z): x up the table, y out of it, z to the right; a right-handed frame."""

INERTIA = 2 / 5  # of a solid sphere, by mass and radius²


def dot(a: Vector, b: Vector) -> float:
    """a·b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a: Vector, b: Vector, share: float = 1.0) -> Vector:
    """a + share·b."""
    return a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]


def surface_slip(velocity: Vector, spin: Vector, arm: Vector) -> Vector:
    """Velocity [u/s] of the point of a ball that lies at `arm` [u] from its centre:  v + ω × r."""
    return plus(velocity, cross(spin, arm))


def pushed(velocity: Vector, spin: Vector, arm: Vector, impulse: Vector) -> tuple[Vector, Vector]:
    """Velocity and spin after an impulse [u/s, by the mass] at `arm`; the playfield takes what is along y."""
    turn = cross(arm, impulse)
    moment = INERTIA * dot(arm, arm)
    return plus(velocity, (impulse[0], 0.0, impulse[2])), plus(spin, turn, 1 / moment)


def rubbing(slip: Vector, normal: Vector, most: float, bodies: int = 1) -> Vector:
    """The impulse of friction against a slip between `bodies` balls: what stops it, or all that is available.

    An impulse J along the surface changes the slip there by J for the ball's speed and by J/INERTIA for its
    spin; along y by the latter alone.
    """
    along = cross((0.0, 1.0, 0.0), normal)
    slip_along, slip_up = dot(slip, along), slip[1]
    stop_along = -slip_along / ((1 + 1 / INERTIA) * bodies)
    stop_up = -slip_up * INERTIA / bodies
    if math.hypot(stop_along, stop_up) <= most:
        return plus((0.0, stop_up, 0.0), along, stop_along)
    share = -most / math.hypot(slip_along, slip_up)
    return plus((0.0, share * slip_up, 0.0), along, share * slip_along)


class Body:
    """A ball."""

    def __init__(self, x: float, z: float, vx: float, vz: float, spin: Vector = (0.0, 0.0, 0.0)) -> None:
        self.x, self.z, self.vx, self.vz, self.spin = x, z, vx, vz, spin

    @property
    def velocity(self) -> Vector:
        """Velocity as a vector [u/s]."""
        return self.vx, 0.0, self.vz

    def moved(self, h: float, board: Board) -> Body:
        """The ball h seconds later, with the acceleration that it has now."""
        ax, az, spin = -board.gravity, 0.0, self.spin
        if board.rolling:
            arm = (0.0, -board.ball_radius, 0.0)
            slip = surface_slip(self.velocity, spin, arm)
            speed = math.hypot(slip[0], slip[2])
            grip = board.friction * board.gravity / math.tan(math.radians(board.slope))
            if speed > (1 + 1 / INERTIA) * (grip + board.gravity) * h:
                fx, fz = -grip * slip[0] / speed, -grip * slip[2] / speed
            else:  # all slip goes away; what gravity then needs for rolling is less than the grip
                away = h * (1 + 1 / INERTIA)
                fx, fz = -slip[0] / away - ax / (1 + 1 / INERTIA), -slip[2] / away
            _, spin = pushed(self.velocity, spin, arm, (fx * h, 0.0, fz * h))
            ax, az = ax + fx, az + fz
        return Body(
            self.x + self.vx * h + ax * h * h / 2,
            self.z + self.vz * h + az * h * h / 2,
            self.vx + ax * h,
            self.vz + az * h,
            spin,
        )

    def push(self, arm: Vector, impulse: Vector) -> None:
        """Give the ball an impulse at a point of its surface."""
        (self.vx, _, self.vz), self.spin = pushed(self.velocity, self.spin, arm, impulse)


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

    def __init__(
        self, table: Table, balls: list[tuple[float, float, float, float]], spins: list[Vector] | None = None
    ) -> None:
        self.table, self.board = table, table.board
        spins = spins or [(0.0, 0.0, 0.0)] * len(balls)
        self.balls: list[Body | None] = [Body(*ball, spin) for ball, spin in zip(balls, spins, strict=True)]
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
            balls = [ball and ball.moved(part, self.board) for ball in self.balls]
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
        """Turn the normal part of the velocity round, and let the surfaces rub."""
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
            self.apply_ball_friction(ball, other, (nx, 0.0, nz), push)
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
            self.apply_surface_friction(ball, (nx, 0.0, nz), (1 + e) * w, (surface[0], 0.0, surface[1]))
            ball.vx, ball.vz = (ball.vx + (1 + e) * w * nx) * factor, (ball.vz + (1 + e) * w * nz) * factor
        self.cap(ball)
        self.bounces.append(Bounce(self.time, index, path, ball.x, ball.z, w))

    def apply_surface_friction(self, ball: Body, normal: Vector, push: float, surface: Vector) -> None:
        """Friction at a surface with a velocity of its own."""
        arm = plus((0.0, 0.0, 0.0), normal, -self.board.ball_radius)
        slip = plus(surface_slip(ball.velocity, ball.spin, arm), surface, -1.0)
        ball.push(arm, rubbing(slip, normal, self.board.friction * push))

    def apply_ball_friction(self, ball: Body, other: Body, normal: Vector, push: float) -> None:
        """Friction between two balls: equal and opposite impulses at one point."""
        nowhere, radius = (0.0, 0.0, 0.0), self.board.ball_radius
        arm, other_arm = plus(nowhere, normal, -radius), plus(nowhere, normal, radius)
        slip = plus(
            surface_slip(ball.velocity, ball.spin, arm),
            surface_slip(other.velocity, other.spin, other_arm),
            -1.0,
        )
        impulse = rubbing(slip, normal, self.board.friction * push, bodies=2)
        ball.push(arm, impulse)
        other.push(other_arm, plus(nowhere, impulse, -1.0))

    def cap(self, ball: Body) -> None:
        """No ball is faster than the cap."""
        speed = math.hypot(ball.vx, ball.vz)
        if speed > self.board.speed_cap:
            ball.vx *= self.board.speed_cap / speed
            ball.vz *= self.board.speed_cap / speed
