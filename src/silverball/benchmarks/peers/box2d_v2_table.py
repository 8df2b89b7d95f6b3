"""The table in Box2D 2.3 (package box2d), as an experienced user builds it.

Balls are bullets, slant walls edges with a radius, paddles kinematic bodies. Polygons lose their default skin
of one centimetre, since a ball is thick enough for the swept test. Nothing bounces below 1 m/s, which cannot
be changed; a table unit is therefore two metres, which halves this limit and the engine's slop. Larger scales
approach the engine's limit of 2 m per step. The manual recommends 1/60 s with 8 velocity and 3 position
iterations.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import Box2D

from silverball.benchmarks.peers.playfield import (
    BodyPlayfield,
    Stepping,
    border_boxes,
    paddle_triangle,
    swapped,
)
from silverball.table import Table

RECOMMENDED = Stepping(1)
VELOCITY_ITERATIONS, POSITION_ITERATIONS = 8, 3
SCALE = 2.0  # [m/u]


def metres(point: tuple[float, float]) -> tuple[float, float]:
    """A point (right, up) [u] in metres."""
    return point[0] * SCALE, point[1] * SCALE


def polygon(corners: list[tuple[float, float]]) -> Any:
    """A polygon without skin, from corners (right, up) [u]."""
    shape = Box2D.b2PolygonShape(vertices=[metres(corner) for corner in corners])
    shape.radius = 0.0
    return shape


class Box2DV2Playfield(BodyPlayfield):
    """A table in a `Box2D.b2World`."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        board = table.board
        self.world = Box2D.b2World(
            gravity=(0.0, -board.gravity * SCALE), doSleep=False, continuousPhysics=True
        )
        step = partial(self.world.Step, stepping.step, VELOCITY_ITERATIONS, POSITION_ITERATIONS)
        super().__init__(table, stepping, step)
        self.gutter, self.cap_squared = board.gutter * SCALE, (board.speed_cap * SCALE) ** 2
        self.bodies: list[Any] = []
        self._build()

    def _build(self) -> None:
        ground = self.world.CreateStaticBody()
        for left, bottom, right, top in border_boxes(self.table):
            corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
            self._add(ground, polygon(corners), self.table.board.wall_restitution)
        for wall in self.table.slant_wall:
            ends = [metres(swapped(wall.start)), metres(swapped(wall.end))]
            edge = Box2D.b2EdgeShape(vertices=ends)
            edge.radius = wall.thickness * SCALE
            self._add(ground, edge, wall.restitution)
        for prism in self.table.triangular_prism:
            self._add(ground, polygon([swapped(corner) for corner in prism.corners()]), prism.restitution)
        for cylinder in self.table.cylinder:
            x, z, radius = cylinder.circle()
            circle = Box2D.b2CircleShape(pos=metres((z, x)), radius=radius * SCALE)
            self._add(ground, circle, cylinder.restitution)
        for paddle in self.table.paddle:
            side = 1.0 if paddle.side == "left" else -1.0
            body = self.world.CreateKinematicBody(
                position=metres(swapped(paddle.pivot)), angle=side * math.radians(paddle.rest_angle)
            )
            self._add(body, polygon(paddle_triangle(paddle)), paddle.restitution)
            self.add_motor(
                paddle,
                partial(getattr, body, "angle"),
                partial(setattr, body, "angularVelocity"),
            )

    def _add(self, body: Any, shape: Any, restitution: float) -> None:
        body.CreateFixture(shape=shape, density=1.0, friction=0.0, restitution=restitution)

    def finish_frame(self) -> None:
        """Remove drained balls and apply the speed cap."""
        for body in self.bodies[:]:
            if body.position[1] < self.gutter:
                self.bodies.remove(body)
                self.world.DestroyBody(body)
                continue
            velocity = body.linearVelocity
            square = velocity.lengthSquared
            if square > self.cap_squared:
                body.linearVelocity = velocity * math.sqrt(self.cap_squared / square)

    def add_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """Add a ball: a bullet without rotation, because nothing has friction."""
        body = self.world.CreateDynamicBody(
            position=metres((z, x)),
            linearVelocity=metres((vz, vx)),
            bullet=True,
            fixedRotation=True,
            allowSleep=False,
        )
        circle = Box2D.b2CircleShape(radius=self.table.board.ball_radius * SCALE)
        self._add(body, circle, self.table.board.ball_restitution)
        self.bodies.append(body)

    def remove_ball(self, index: int) -> None:
        """Remove a ball, by its index in `balls`."""
        self.world.DestroyBody(self.bodies.pop(index))

    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z, vx, vz of every ball."""
        found = []
        for body in self.bodies:
            (right, up), (across, upward) = body.position, body.linearVelocity
            found.append((up / SCALE, right / SCALE, upward / SCALE, across / SCALE))
        return found

    @property
    def ball_count(self) -> int:
        """Number of balls on the board."""
        return len(self.bodies)
