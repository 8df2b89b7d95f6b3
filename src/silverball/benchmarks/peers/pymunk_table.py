"""The table in pymunk (Chipmunk), as an experienced user builds it.

Borders are thick boxes, slant walls segments with a radius, paddles kinematic bodies; a filter excludes
contacts between parts. Chipmunk multiplies two restitutions, so a ball takes the square root of its own and
the parts are divided by it. Chipmunk has no swept test: its documented remedy against tunnelling is a shorter
step, and the flipper example of pymunk uses 1/300 s. Slop, bias and iterations keep their defaults: of slops
from 0 to 0.1 u and biases from 10 to 50 % per 1/60 s, the defaults conserved energy best (several times so at
1/300 s), and no other value changed errors or penetration by much.
"""

from __future__ import annotations

import math
from functools import partial

import pymunk

from silverball.benchmarks.peers.playfield import (
    BodyPlayfield,
    Stepping,
    border_boxes,
    paddle_triangle,
    swapped,
)
from silverball.table import Table

RECOMMENDED = Stepping(5)  # 1/300 s, as in the flipper example of pymunk
PARTS = 1  # filter group of all parts, which do not collide with each other


class PymunkPlayfield(BodyPlayfield):
    """A table in a `pymunk.Space`."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        board = table.board
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -board.gravity)
        super().__init__(table, stepping, partial(self.space.step, stepping.step))
        self.bounce = math.sqrt(board.ball_restitution)
        self.gutter, self.cap_squared = board.gutter, board.speed_cap**2
        self.bodies: list[tuple[pymunk.Body, pymunk.Circle]] = []
        self._build()

    def _build(self) -> None:
        ground = self.space.static_body
        for left, bottom, right, top in border_boxes(self.table):
            corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
            self._add(pymunk.Poly(ground, corners), self.table.board.wall_restitution)
        for wall in self.table.slant_wall:
            segment = pymunk.Segment(ground, swapped(wall.start), swapped(wall.end), wall.thickness)
            self._add(segment, wall.restitution)
        for prism in self.table.triangular_prism:
            corners = [swapped(corner) for corner in prism.corners()]
            self._add(pymunk.Poly(ground, corners), prism.restitution)
        for cylinder in self.table.cylinder:
            x, z, radius = cylinder.circle()
            self._add(pymunk.Circle(ground, radius, (z, x)), cylinder.restitution)
        for paddle in self.table.paddle:
            body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
            body.position = swapped(paddle.pivot)
            side = 1.0 if paddle.side == "left" else -1.0
            body.angle = side * math.radians(paddle.rest_angle)
            self.space.add(body)
            self._add(pymunk.Poly(body, paddle_triangle(paddle)), paddle.restitution)
            self.add_motor(
                paddle,
                partial(getattr, body, "angle"),
                partial(setattr, body, "angular_velocity"),
            )

    def _add(self, shape: pymunk.Shape, restitution: float) -> None:
        shape.elasticity = restitution / self.bounce
        shape.friction = 0.0
        shape.filter = pymunk.ShapeFilter(group=PARTS)
        self.space.add(shape)

    def finish_frame(self) -> None:
        """Remove drained balls and apply the speed cap."""
        drained = []
        for body, shape in self.bodies:
            if body.position.y < self.gutter:
                drained.append((body, shape))
                continue
            velocity = body.velocity
            square = velocity.x * velocity.x + velocity.y * velocity.y
            if square > self.cap_squared:
                body.velocity = velocity * math.sqrt(self.cap_squared / square)
        for pair in drained:
            self.space.remove(*pair)
            self.bodies.remove(pair)

    def add_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """Add a ball of mass 1 without rotation, because nothing has friction."""
        body = pymunk.Body(1.0, math.inf)
        body.position, body.velocity = (z, x), (vz, vx)
        shape = pymunk.Circle(body, self.table.board.ball_radius)
        shape.elasticity, shape.friction = self.bounce, 0.0
        self.space.add(body, shape)
        self.bodies.append((body, shape))

    def remove_ball(self, index: int) -> None:
        """Remove a ball, by its index in `balls`."""
        self.space.remove(*self.bodies.pop(index))

    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z, vx, vz of every ball."""
        return [
            (body.position.y, body.position.x, body.velocity.y, body.velocity.x) for body, _ in self.bodies
        ]

    @property
    def ball_count(self) -> int:
        """Number of balls on the board."""
        return len(self.bodies)
