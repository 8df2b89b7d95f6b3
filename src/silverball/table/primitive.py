"""Primitives: the simple shapes that every part of a table is made of.

    part (what a person writes)  →  primitives: shape × response × finish  →  rows of the compiled board

Whatever reads a table (checks, reachability, the generator, the compiler, the audit, pictures, sounds,
observations, the reference) reads primitives and finishes, never kinds of parts. A kind of part is one file
in `table/kinds/`; its `primitives` method is all that the rest of the program knows about it.

Points are (x, z) in table units [u]; angles are in radians, counter-clockwise as the player sees the board,
from +z (right) towards +x (up).
"""

from __future__ import annotations

import math
from enum import Enum
from typing import NamedTuple, TypeAlias

from silverball.physics.forms import Response, Shape

__all__ = ["Arc", "Finish", "Hold", "Launch", "Mover", "Point", "Primitive", "Spin", "Surface", "arc_of"]

Point: TypeAlias = tuple[float, float]
"""A place on the board, (x, z) [u]."""


class Finish(Enum):
    """What a primitive looks like and sounds like: one row in `drawing/` and one in `app/sound/` each."""

    BORDER = "border"
    WALL = "wall"  # painted wood or metal, as slant walls
    METAL = "metal"  # wire guides, lane guides
    WOOD = "wood"
    PLASTIC = "plastic"
    RUBBER = "rubber"  # posts, rings, slingshots
    PADDLE = "paddle"
    PRISM = "prism"
    BUMPER = "bumper"  # cylinders
    TARGET = "target"
    ROLLOVER = "rollover"
    GATE = "gate"
    SPINNER = "spinner"
    HOLE = "hole"
    PLUNGER = "plunger"
    RAMP = "ramp"  # the mouth of a passage to another level


class Surface(NamedTuple):
    """How a primitive bounces a ball; None: the board's own value."""

    restitution: float = 0.0
    restitution_falloff: float = 0.0  # [s/u]
    speed_factor: float = 1.0  # on the whole velocity, at a hit
    friction: float | None = None
    hit_speed: float | None = None  # [u/s] a contact above this is a hit
    kick: float = 0.0  # [u/s] added along the normal at a hit
    kick_profile: str = "flat"  # or "parabola": 1 − ξ² along a capsule, ξ = −1 … 1
    points: int = 0


class Mover(NamedTuple):
    """How a paddle turns about its pivot.

    Its primitive's points are those of a left paddle at 0 rad, relative to the pivot.
    """

    pivot: Point
    direction: float  # 1: the tip points to +z at 0 rad; −1: the mirror image
    rest_angle: float  # [rad]
    up_angle: float
    stroke: float  # [s]
    return_stroke: float
    button: str  # "left" or "right"
    is_coil: bool = False  # constant acceleration instead of constant speed
    mass: float | None = None  # [ball masses]; None: infinite


class Hold(NamedTuple):
    """How a hole holds a ball and lets it go."""

    capture_speed: float  # [u/s] faster balls pass over it
    duration: float  # [s]
    exit: Point
    exit_velocity: Point  # [u/s]
    spread: float = 0.0  # [rad] the direction of the exit varies by at most this, by the world's generator
    exit_level: int = 0
    is_drain: bool = False  # the ball is lost


class Launch(NamedTuple):
    """How a plunger launches the balls that lie on it."""

    least: float  # [u/s] after a short press
    greatest: float  # [u/s] after `charge`
    charge: float  # [s]
    direction: Point  # unit
    auto: Point | None = None  # [u/s] least and greatest, of balls that a game brings; None: it does not
    auto_delay: float = 0.0  # [s] before that


class Spin(NamedTuple):
    """How the blade of a spinner turns."""

    damping: float  # [1/s] rate at which its speed decays
    drag: float = 0.0  # [u/s] taken from the ball's speed
    height: float = 0.3  # [u] half of the blade's height: the radius at which the ball meets it


class Arc(NamedTuple):
    """A circular arc: its circle, and which part of it.

    Attributes:
        center: The centre of the circle [u].
        radius: The radius of the circle [u].
        middle: The unit direction from the centre to the middle of the arc.
        half_angle: Half of the angle that the arc spans [rad], 0 to π.
        cosine: The cosine of that half, without a trigonometric function: the same bits on every machine.
    """

    center: Point
    radius: float
    middle: Point
    half_angle: float
    cosine: float


class Primitive(NamedTuple):
    """One simple shape, what a contact with it does, and what it looks and sounds like.

    Attributes:
        shape: PLANE (borders only), CIRCLE, CAPSULE, TRIANGLE, TAPERED, ARC, LINE or DISC.
        points: CIRCLE and DISC: the centre. CAPSULE, ARC and LINE: start and end. TRIANGLE: three corners,
            counter-clockwise. TAPERED: pivot and tip. Those of a paddle are relative to its pivot. PLANE: one
            point on it and its unit normal.
        radius: The radius around the core [u]: of a circle or disc, half the thickness of a capsule or arc,
            the base radius of a tapered capsule.
        tip_radius: TAPERED only [u].
        bulge: ARC only: tan(angle/4); positive: counter-clockwise from start to end.
        response: BOUNCE, PASS or HOLD.
        surface: How it bounces a ball.
        finish: What it looks and sounds like.
        levels: The levels on which a ball meets it.
        one_way: The unit direction in which balls pass it; balls that come against it are blocked.
        bank: Drop targets: the bank to which its switch belongs; members of a bank come back together.
        reset_after: Drop targets [s]: after the last of the bank has fallen.
        is_gate: Whether rules may open and close it by its part's name; it starts closed.
        mover: Paddles.
        hold: Holes.
        launch: Plungers.
        spin: Spinners.
        passage: The levels before and after a crossing of a LINE, in the direction to the left of start → end
            as the player sees it; in the other direction the other way round.
    """

    shape: Shape
    points: tuple[Point, ...]
    radius: float = 0.0
    tip_radius: float = 0.0
    bulge: float = 0.0
    response: Response = Response.BOUNCE
    surface: Surface = Surface()
    finish: Finish = Finish.WALL
    levels: tuple[int, ...] = (0,)
    one_way: Point | None = None
    bank: str | None = None
    reset_after: float = 0.0
    is_gate: bool = False
    mover: Mover | None = None
    hold: Hold | None = None
    launch: Launch | None = None
    spin: Spin | None = None
    passage: tuple[int, int] | None = None

    @property
    def has_switch(self) -> bool:
        """Whether it can be away: a drop target, or a gate that rules open."""
        return self.bank is not None or self.is_gate

    @property
    def arc(self) -> Arc:
        """The circle of an ARC."""
        return arc_of(self.points[0], self.points[1], self.bulge)


def arc_of(start: Point, end: Point, bulge: float) -> Arc:
    """Return the arc from start to end with this bulge, tan(angle/4); positive: counter-clockwise.

    With the chord's half length c and the rise s = |bulge|·c of the arc over it, the radius is
    (c² + s²) / (2·s). Source: the bulge of polylines in the DXF format.

    Examples:
        >>> from silverball.table.primitive import arc_of
        >>> arc_of((0.0, -1.0), (0.0, 1.0), 1.0).radius
        1.0
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    chord = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
    half, rise = 0.5 * chord, 0.5 * chord * abs(bulge)
    radius = (half * half + rise * rise) / (2.0 * rise)
    # Counter-clockwise from start to end, the arc lies to the right of the chord: (−dz, dx) is that side.
    side = math.copysign(1.0, bulge)
    middle = (side * -dz / chord, side * dx / chord)
    to_center = rise - radius  # along `middle` from the chord's middle; beyond it for more than a half circle
    center = (
        0.5 * (start[0] + end[0]) + to_center * middle[0],
        0.5 * (start[1] + end[1]) + to_center * middle[1],
    )
    square = bulge * bulge
    return Arc(center, radius, middle, 2.0 * math.atan(abs(bulge)), (1.0 - square) / (1.0 + square))
