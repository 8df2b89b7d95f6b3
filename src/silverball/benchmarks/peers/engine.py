"""What is asked of an engine: build a table, move it on by steps, and say where balls and paddles are.

Engines draw the plane as (right, up), Silverball as (x up, z right): the peers' modules swap the two on the
way in and out, gravity points down. Their paddles are kinematic bodies, whose turning a `Drive` commands
before every step.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

from silverball.table import Table
from silverball.table.parts import Paddle

FRAME_RATE = 60
STOP_MARGIN = 1e-4  # [rad] a paddle this close to its stop has reached it; 2e-4 u at the tip


class Stepping(NamedTuple):
    """How an engine divides a frame of 1/60 s.

    Attributes:
        steps: Calls of the engine's step in a frame.
        substeps: What the engine does inside of a call, where it can be told (Box2D v3).
    """

    steps: int
    substeps: int = 1

    @property
    def step(self) -> float:
        """Length of a step [s]."""
        return 1.0 / (FRAME_RATE * self.steps)

    @property
    def label(self) -> str:
        """As people write it: 1/240, or 1/60 × 4 with substeps."""
        return f"1/{FRAME_RATE * self.steps}" + (f" × {self.substeps}" if self.substeps > 1 else "")


class Playfield(ABC):
    """One table in one engine."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        self.table = table
        self.stepping = stepping

    @abstractmethod
    def step(self, left: bool, right: bool) -> None:
        """Move on by one step with the paddle buttons held or not."""

    @abstractmethod
    def finish_frame(self) -> None:
        """What a game does after each frame: take drained balls away, hold the speed cap."""

    @abstractmethod
    def put_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """A new ball with its centre at (x, z) [u] and a velocity [u/s]."""

    @abstractmethod
    def take_ball(self, index: int) -> None:
        """Take a ball off the board."""

    @abstractmethod
    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z [u], vx, vz [u/s] of every ball, in a stable order."""

    @abstractmethod
    def angles(self) -> tuple[float, float]:
        """The left and the right paddle's angle [rad], both seen as a left one."""

    @property
    @abstractmethod
    def ball_count(self) -> int:
        """How many balls are on the board."""

    def frame(self, left: bool, right: bool) -> None:
        """Move on by one frame of 1/60 s."""
        for _ in range(self.stepping.steps):
            self.step(left, right)
        self.finish_frame()


class Drive:
    """The motor of a kinematic paddle: before each step it sets the speed that ends at the stop, not beyond.

    Args:
        paddle: The part of the table.
        step: Length of a step [s].
        read: Gives the body's angle [rad], counter-clockwise.
        turn: Sets the body's angular velocity [rad/s].
    """

    def __init__(
        self, paddle: Paddle, step: float, read: Callable[[], float], turn: Callable[[float], None]
    ) -> None:
        self.side = 1.0 if paddle.side == "left" else -1.0
        self.rest, self.up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
        self.most = step * (self.up - self.rest) / paddle.stroke
        self.least = -step * (self.up - self.rest) / paddle.return_stroke
        self.step = step
        self.read, self.turn = read, turn
        self.raised, self.still = False, True

    @property
    def angle(self) -> float:
        """The paddle's angle [rad], seen as a left one."""
        return self.side * self.read()

    def aim(self, raised: bool) -> None:
        """Set the speed for the next step; a paddle that lies at its stop costs next to nothing."""
        if self.still and raised == self.raised:
            return
        self.raised = raised
        gap = (self.up if raised else self.rest) - self.side * self.read()
        self.still = abs(gap) < STOP_MARGIN
        way = 0.0 if self.still else min(max(gap, self.least), self.most)
        self.turn(self.side * way / self.step)


class BodyPlayfield(Playfield):
    """What the peers have in common: paddles with drives.

    Args:
        table: A finished table with plain parts.
        stepping: How a frame is divided.
        advance: One step of the engine itself, arguments and all, so that no Python stands in between.
    """

    def __init__(self, table: Table, stepping: Stepping, advance: Callable[[], object]) -> None:
        super().__init__(table, stepping)
        self.advance = advance
        self.drives: dict[str, Drive] = {}

    def add_drive(self, paddle: Paddle, read: Callable[[], float], turn: Callable[[float], None]) -> None:
        """Give a paddle's body its motor."""
        self.drives[paddle.side] = Drive(paddle, self.stepping.step, read, turn)

    def step(self, left: bool, right: bool) -> None:
        """Set the motors and let the engine move on by one step."""
        if "left" in self.drives:
            self.drives["left"].aim(left)
        if "right" in self.drives:
            self.drives["right"].aim(right)
        self.advance()

    def frame(self, left: bool, right: bool) -> None:
        """Move on by one frame; what is timed, so without calls that a tight loop would not make."""
        advance = self.advance
        motors = [(drive, left if side == "left" else right) for side, drive in self.drives.items()]
        for _ in range(self.stepping.steps):
            for drive, raised in motors:
                if not drive.still or raised is not drive.raised:
                    drive.aim(raised)
            advance()
        self.finish_frame()

    def angles(self) -> tuple[float, float]:
        """The left and the right paddle's angle [rad], both seen as a left one; 0 where there is none."""
        left, right = self.drives.get("left"), self.drives.get("right")
        return left.angle if left else 0.0, right.angle if right else 0.0


def swapped(point: tuple[float, float]) -> tuple[float, float]:
    """A point (x up, z right) as the peers want it: (right, up)."""
    return point[1], point[0]


def border_boxes(table: Table) -> list[tuple[float, float, float, float]]:
    """The left, right and top border as boxes two units thick: (least right, least up, most right, most up).

    A thick wall is what the engines' manuals advise against tunnelling.
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
    """The corners of a paddle (right, up) [u] from its pivot, at angle 0; the right one's tip points left."""
    side = 1.0 if paddle.side == "left" else -1.0
    half = paddle.base / 2
    corners = [(0.0, -half), (side * paddle.length, 0.0), (0.0, half)]
    return corners if side > 0.0 else corners[::-1]
