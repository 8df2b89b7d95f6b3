"""Interface of an engine in the comparison: build a table, step it, and read balls and paddles.

Coordinates of the plane are (right, up) in the peers and (x up, z right) in Silverball: the modules of the
peers swap them on input and output. Gravity points down. Their paddles are kinematic bodies, whose angular
velocity a `PaddleMotor` sets before every step.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

from silverball.table import Table
from silverball.table.parts import Paddle

FRAME_RATE = 60
STOP_MARGIN = 1e-4  # [rad] from the stop at which it counts as reached; 2e-4 u at the tip


class Stepping(NamedTuple):
    """How an engine divides a frame of 1/60 s.

    Attributes:
        steps: Calls of the engine's step per frame.
        substeps: Substeps of the engine per call, where they are an argument (Box2D v3).
    """

    steps: int
    substeps: int = 1

    @property
    def step(self) -> float:
        """Length of a step [s]."""
        return 1.0 / (FRAME_RATE * self.steps)

    @property
    def label(self) -> str:
        """As text: 1/240, or 1/60 × 4 with substeps."""
        return f"1/{FRAME_RATE * self.steps}" + (f" × {self.substeps}" if self.substeps > 1 else "")


class Playfield(ABC):
    """One table in one engine."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        self.table = table
        self.stepping = stepping

    @abstractmethod
    def step(self, left: bool, right: bool) -> None:
        """Advance by one step, with each paddle button held or not."""

    @abstractmethod
    def finish_frame(self) -> None:
        """Remove drained balls and apply the speed cap, as a game does after each frame."""

    @abstractmethod
    def add_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """Add a ball with its centre at (x, z) [u] and a velocity [u/s]."""

    @abstractmethod
    def remove_ball(self, index: int) -> None:
        """Remove a ball, by its index in `balls`."""

    @abstractmethod
    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z [u], vx, vz [u/s] of every ball, in a stable order."""

    @abstractmethod
    def angles(self) -> tuple[float, float]:
        """Angles of the left and the right paddle [rad], both measured like that of a left one."""

    @property
    @abstractmethod
    def ball_count(self) -> int:
        """Number of balls on the board."""

    def frame(self, left: bool, right: bool) -> None:
        """Advance by one frame of 1/60 s."""
        for _ in range(self.stepping.steps):
            self.step(left, right)
        self.finish_frame()


class PaddleMotor:
    """Turns a kinematic paddle: sets the angular velocity of each step so that it ends exactly at the stop.

    Args:
        paddle: The part of the table.
        step: Length of a step [s].
        read: Returns the body's angle [rad], counter-clockwise.
        turn: Sets the body's angular velocity [rad/s].
    """

    def __init__(
        self, paddle: Paddle, step: float, read: Callable[[], float], turn: Callable[[float], None]
    ) -> None:
        self.side = 1.0 if paddle.side == "left" else -1.0
        self.rest, self.up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
        self.max_turn = step * (self.up - self.rest) / paddle.stroke
        self.min_turn = -step * (self.up - self.rest) / paddle.return_stroke
        self.step = step
        self.read, self.turn = read, turn
        self.raised, self.is_still = False, True

    @property
    def angle(self) -> float:
        """Angle of the paddle [rad], measured like that of a left one."""
        return self.side * self.read()

    def aim(self, raised: bool) -> None:
        """Set the angular velocity of the next step; costs next to nothing for a paddle at its stop."""
        if self.is_still and raised == self.raised:
            return
        self.raised = raised
        gap = (self.up if raised else self.rest) - self.side * self.read()
        self.is_still = abs(gap) < STOP_MARGIN
        turned = 0.0 if self.is_still else min(max(gap, self.min_turn), self.max_turn)
        self.turn(self.side * turned / self.step)


class BodyPlayfield(Playfield):
    """Base of the peers' playfields: paddles with motors.

    Args:
        table: A finished table with plain parts.
        stepping: How a frame is divided into steps.
        advance: One step of the engine, with its arguments bound, so that no Python code runs in between.
    """

    def __init__(self, table: Table, stepping: Stepping, advance: Callable[[], object]) -> None:
        super().__init__(table, stepping)
        self.advance = advance
        self.motors: dict[str, PaddleMotor] = {}

    def add_motor(self, paddle: Paddle, read: Callable[[], float], turn: Callable[[float], None]) -> None:
        """Add the motor of a paddle's body."""
        self.motors[paddle.side] = PaddleMotor(paddle, self.stepping.step, read, turn)

    def step(self, left: bool, right: bool) -> None:
        """Set the motors and advance the engine by one step."""
        if "left" in self.motors:
            self.motors["left"].aim(left)
        if "right" in self.motors:
            self.motors["right"].aim(right)
        self.advance()

    def frame(self, left: bool, right: bool) -> None:
        """Advance by one frame. This is timed, so it makes no call that a tight loop would not make."""
        advance = self.advance
        motors = [(motor, left if side == "left" else right) for side, motor in self.motors.items()]
        for _ in range(self.stepping.steps):
            for motor, raised in motors:
                if not motor.is_still or raised is not motor.raised:
                    motor.aim(raised)
            advance()
        self.finish_frame()

    def angles(self) -> tuple[float, float]:
        """Angles of the left and the right paddle [rad], measured like those of a left one; 0 if missing."""
        left, right = self.motors.get("left"), self.motors.get("right")
        return left.angle if left else 0.0, right.angle if right else 0.0


def swapped(point: tuple[float, float]) -> tuple[float, float]:
    """A point (x up, z right) in the coordinates of the peers: (right, up)."""
    return point[1], point[0]


def border_boxes(table: Table) -> list[tuple[float, float, float, float]]:
    """The left, right and top border as boxes (left, bottom, right, top) [u] that are two units thick.

    The engines' manuals advise thick walls against tunnelling.
    """
    b = table.board
    side, top = b.width / 2 - b.wall_thickness, b.length / 2 - b.wall_thickness
    deep = 2.0
    low = -b.length / 2 - deep
    return [
        (-side - deep, low, -side, top + deep),
        (side, low, side + deep, top + deep),
        (-side - deep, top, side + deep, top + deep),
    ]


def paddle_triangle(paddle: Paddle) -> list[tuple[float, float]]:
    """Corners (right, up) [u] of a paddle from its pivot, at angle 0; a right one points to the left."""
    side = 1.0 if paddle.side == "left" else -1.0
    half = paddle.base / 2
    corners = [(0.0, -half), (side * paddle.length, 0.0), (0.0, half)]
    return corners if side > 0.0 else corners[::-1]
