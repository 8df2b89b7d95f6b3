"""The table in Box2D v3 (package pyb2d3), as an experienced user builds it.

Balls are bullets, so they are swept against everything; slant walls are capsules, paddles kinematic bodies.
The restitution threshold is zero, and the speed cap is that of the Box2D world. Contacts are as stiff as the
step allows, which has an effect from 1/240 s on. Sleeping is off. The manual recommends steps of 1/60 s
with four substeps.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import pyb2d3

from silverball.benchmarks.peers.playfield import (
    BodyPlayfield,
    Stepping,
    border_boxes,
    paddle_triangle,
    swapped,
)
from silverball.table import Table

SUBSTEPS = 4
RECOMMENDED = Stepping(1, SUBSTEPS)
HERTZ = 240.0  # stiffness of a contact; the engine limits it to a quarter of the substep rate
DAMPING = 10.0  # the default
PUSH_SPEED = 3.0  # [u/s] at which an overlap is pushed apart; the default


def rotation(angle: float) -> Any:
    """The rotation by an angle [rad]; the engine's own sine is accurate to 2e-3 only."""
    result = pyb2d3.Rot()
    result.s, result.c = math.sin(angle), math.cos(angle)
    return result


def angle_of(body: Any) -> float:
    """The angle [rad] of a body, by Python's arc tangent, since the engine's is inaccurate."""
    turned = body.rotation
    return math.atan2(turned.s, turned.c)


class Box2DV3Playfield(BodyPlayfield):
    """A table in a `pyb2d3.World`."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        board = table.board
        self.world = pyb2d3.World(
            gravity=(0.0, -board.gravity),
            restitution_threshold=0.0,
            maximum_linear_speed=board.speed_cap,
        )
        self.world.sleeping_enabled = False
        self.world.continuous_enabled = True
        self.world.set_contact_tuning(HERTZ, DAMPING, PUSH_SPEED)
        super().__init__(table, stepping, partial(self.world.step, stepping.step, stepping.substeps))
        self.gutter = board.gutter
        self.bodies: list[Any] = []
        self._build()

    def _build(self) -> None:
        ground = self.world.create_static_body()
        for left, bottom, right, top in border_boxes(self.table):
            corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
            self._add(ground, pyb2d3.polygon(points=corners), self.table.board.wall_restitution)
        for wall in self.table.slant_wall:
            capsule = pyb2d3.capsule(swapped(wall.start), swapped(wall.end), wall.thickness)
            self._add(ground, capsule, wall.restitution)
        for prism in self.table.triangular_prism:
            corners = [swapped(corner) for corner in prism.corners()]
            self._add(ground, pyb2d3.polygon(points=corners), prism.restitution)
        for cylinder in self.table.cylinder:
            x, z, radius = cylinder.circle()
            self._add(ground, pyb2d3.circle((z, x), radius), cylinder.restitution)
        for paddle in self.table.paddle:
            side = 1.0 if paddle.side == "left" else -1.0
            body = self.world.create_kinematic_body(
                position=swapped(paddle.pivot),
                rotation=rotation(side * math.radians(paddle.rest_angle)),
            )
            self._add(body, pyb2d3.polygon(points=paddle_triangle(paddle)), paddle.restitution)
            self.add_motor(
                paddle,
                partial(angle_of, body),
                partial(setattr, body, "angular_velocity"),
            )

    def _add(self, body: Any, shape: Any, restitution: float) -> None:
        material = pyb2d3.surface_material(restitution=restitution, friction=0.0)
        body.create_shape(pyb2d3.shape_def(density=1.0, material=material), shape)

    def finish_frame(self) -> None:
        """Remove drained balls; the Box2D world applies the speed cap."""
        for body in self.bodies[:]:
            if body.position.y < self.gutter:
                self.bodies.remove(body)
                body.destroy()

    def add_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """Add a ball: a bullet without rotation, because nothing has friction."""
        body = self.world.create_dynamic_body(
            position=(z, x), linear_velocity=(vz, vx), is_bullet=True, fixed_rotation=True, enable_sleep=False
        )
        self._add(body, pyb2d3.circle(radius=self.table.board.ball_radius), self.table.board.ball_restitution)
        self.bodies.append(body)

    def remove_ball(self, index: int) -> None:
        """Remove a ball, by its index in `balls`."""
        self.bodies.pop(index).destroy()

    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z, vx, vz of every ball."""
        found = []
        for body in self.bodies:
            position, velocity = body.position, body.linear_velocity
            found.append((position.y, position.x, velocity.y, velocity.x))
        return found

    @property
    def ball_count(self) -> int:
        """Number of balls on the board."""
        return len(self.bodies)
