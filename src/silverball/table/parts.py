"""The parts of a table: one frozen model per part, whose attributes are the keys of the TOML file.

    import silverball as sb

    bumper = sb.parts.Cylinder(center=(5.0, 1.5), radius=0.6)
    table = sb.load_table("classic").replace(cylinder=[bumper], board={"gravity": 12.0})

Every field states its unit, its range and its default. Points are (x, z): x runs up the table, z to the
player's right, and the origin is the centre of the board. Lengths are in table units [u], times in seconds,
angles in degrees, counter-clockwise as the player sees the board, from +z (right) towards +x (up).

A constructor refuses unknown names and values out of range with pydantic's `ValidationError`, a `ValueError`.
`replace` makes a changed copy. Whether the parts fit together is checked by `check_table`. Other words in
use: flipper for paddle, bumper for cylinder, drain for gutter, nudge for jitter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from silverball.physics.records import Shape
from silverball.table.primitive import Finish, Mover, Primitive, Surface
from silverball.table.quantity import COORDINATE, POINT, Count, FixedList, Interval, Quantity, refuse, shown

__all__ = [
    "Arcade",
    "Board",
    "Cylinder",
    "CylinderSurface",
    "Paddle",
    "PrismSurface",
    "RandomRecipe",
    "SlantWall",
    "TriangularPrism",
]

Point: TypeAlias = tuple[float, float]
"""A place on the board, (x, z) [u]."""

Triangle: TypeAlias = tuple[Point, Point, Point]
"""Three corners, (x, z) [u] each."""

Outline: TypeAlias = tuple[Triangle, float]
"""The three points of a convex core (x, z) and the radius around it [u]; fewer points are repeated."""

SineCosine: TypeAlias = Callable[[float], tuple[float, float]]
"""The sine and the cosine of an angle [rad]."""

_Place = Annotated[Point, POINT]
_Corners = Annotated[Triangle, FixedList(POINT, 3, "[[x, z], [x, z], [x, z]]")]
_Restitution = Annotated[float, Quantity(0.0, 1.0)]
_Falloff = Annotated[float, Quantity(0.0, 10.0, "s/u")]
_SpeedFactor = Annotated[float, Quantity(0.1, 3.0)]
_Points = Annotated[int, Count(0, 1_000_000, "points")]
_Radius = Annotated[float, Quantity(0.05, 10.0, "u")]
Name = Annotated[str, Field(max_length=80)]


def _counter_clockwise(corners: Triangle) -> Triangle:
    """Return the corners counter-clockwise: Σ(zᵢ·xᵢ₊₁ − xᵢ·zᵢ₊₁) > 0 with z to the right and x up."""
    a, b, c = corners
    # The sum relative to corner a: the same value, without cancellation far from the origin.
    turn = (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])
    return (a, b, c) if turn >= 0.0 else (a, c, b)


def _libm(angle: float) -> tuple[float, float]:
    return math.sin(angle), math.cos(angle)


class Model(BaseModel):
    """The base of all models: frozen, and without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    def replace(self, **changes: Any) -> Self:
        """Make a copy with some fields changed, validated as by the constructor.

        Raises:
            ValidationError: A name is unknown, or a value has the wrong type or is out of range.

        Examples:
            >>> import silverball as sb
            >>> sb.parts.Cylinder(center=(5.0, 1.5), radius=0.6).replace(points=250).points
            250
        """
        return type(self)(**(self.model_dump(exclude_defaults=True) | changes))


class _Part(Model):
    """The base of everything that a ball can hit."""

    name: Name = ""
    """A name for people; it has no effect in play."""

    def _surface(self) -> Surface:
        """How the part bounces a ball."""
        return Surface(**{key: getattr(self, key) for key in _SURFACE_KEYS if hasattr(self, key)})


_SURFACE_KEYS = ("restitution", "restitution_falloff", "speed_factor", "points")


class Board(Model):
    """The board, its borders (left, right, top), and the physics of every ball on it."""

    length: Annotated[float, Quantity(4.0, 50.0, "u")] = 20.0
    """[u] along x: the board spans x = −length/2 … length/2."""
    width: Annotated[float, Quantity(2.0, 50.0, "u")] = 10.0
    """[u] along z: the board spans z = −width/2 … width/2."""
    height: Annotated[float, Quantity(0.0, 10.0, "u")] = 1.0
    """[u] height y of the plane in which the balls move."""
    gravity: Annotated[float, Quantity(0.0, 100.0, "u/s²")] = 10.0
    """[u/s²] acceleration of a sliding ball along the board, towards −x; at 0 a ball may never drain."""
    slope: Annotated[float, Quantity(1.0, 60.0, "deg")] = 6.5
    """[deg] slope of the board; it sets the acceleration onto it, gravity / tan(slope), which rolling
    needs."""
    friction: Annotated[float, Quantity(0.0, 2.0)] = 0.0
    """Coefficient of friction wherever a ball touches something; 0.2 is steel on lacquer."""
    rolling: Annotated[bool, Field(strict=True)] = False
    """Whether the playfield has friction too, so that balls slip and roll on it; needs friction above 0.
    Without it, or without gravity, balls slide."""
    ball_radius: Annotated[float, Quantity(0.1, 2.0, "u")] = 0.25
    """[u] radius of every ball."""
    ball_restitution: _Restitution = 0.95
    """Restitution of ball against ball."""
    max_balls: Annotated[int, Count(1, 2, "balls")] = 2
    """Balls that may be on the board at once, 1 or 2."""
    speed_cap: Annotated[float, Quantity(1.0, 200.0, "u/s")] = 22.0
    """[u/s] no ball is faster; a paddle's tip must stay slower."""
    hit_speed: Annotated[float, Quantity(0.01, 10.0, "u/s")] = 0.5
    """[u/s] an impact above it is a hit, below it a touch."""
    jitter: Annotated[float, Quantity(0.0, 20.0, "u/s")] = 1.5
    """[u/s] speed that a shove by the player adds to a ball."""
    gutter: Annotated[float, COORDINATE] = -9.0
    """[u] x of the gutter; a ball whose centre crosses it leaves the board."""
    wall_thickness: Annotated[float, Quantity(0.0, 1.0, "u")] = 0.1
    """[u] thickness of the borders, inwards from the edge of the board."""
    wall_restitution: _Restitution = 0.8
    """Restitution of the borders."""

    @field_validator("rolling")
    @classmethod
    def _has_friction(cls, rolling: bool, info: ValidationInfo) -> bool:
        if rolling and info.data.get("friction") == 0.0:
            refuse("needs friction above 0: a ball without friction slides; give friction = 0.2, for example")
        return rolling

    @property
    def center(self) -> Point:
        """The centre of the board (x, z) [u]: the origin, by definition."""
        return (0.0, 0.0)


class SlantWall(_Part):
    """A wall between two points, at any angle, with rounded ends; a ball can hit it from both sides."""

    start: _Place
    """[u] one end, [x, z]."""
    end: _Place
    """[u] the other end, [x, z]; the order of the two does not matter."""
    thickness: Annotated[float, Quantity(0.0, 1.0, "u")] = 0.1
    """[u] from the line between the ends to the surface, on both sides and around the ends."""
    restitution: _Restitution = 0.7
    """Restitution at a slow contact."""
    restitution_falloff: _Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    points: _Points = 0
    """Points for a hit."""

    def primitives(self, board: Board) -> tuple[Primitive, ...]:
        """One capsule."""
        return (Primitive(Shape.CAPSULE, (self.start, self.end), self.thickness, surface=self._surface()),)

    def outline(self) -> Outline:
        """The two ends as a core, and the thickness as its radius."""
        return (self.start, self.end, self.end), self.thickness

    def inward_normal(self, board: Board) -> Point:
        """Return the unit normal (x, z) that points towards the board's centre, for either order of the ends.

        If the line of the wall passes through the centre, the normal points up, or right for a vertical wall.

        Raises:
            ValueError: The two ends are the same point.
        """
        dx, dz = self.end[0] - self.start[0], self.end[1] - self.start[1]
        length = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
        if length == 0.0:
            raise ValueError("a slant wall whose two ends are the same point has no normal")
        nx, nz = dz / length, -dx / length
        side = nx * (board.center[0] - self.start[0]) + nz * (board.center[1] - self.start[1])
        if abs(side) < 1e-12:  # [u] through the centre, but for rounding
            side = nx if nx != 0.0 else nz
        return (nx, nz) if side > 0.0 else (-nx, -nz)


class Paddle(_Part):
    """A flipper: an isosceles triangle that turns about the middle of its base.

    Angles are those of a left paddle; a right one is the exact mirror image. So for both a larger angle
    means a higher tip.
    """

    side: Literal["left", "right"]
    """The button that moves it; at most one paddle per side."""
    pivot: _Place
    """[u] the middle of the base, [x, z]."""
    length: Annotated[float, Quantity(0.3, 10.0, "u")] = 2.1
    """[u] from the pivot to the tip."""
    base: Annotated[float, Quantity(0.05, 5.0, "u")] = 0.5
    """[u] the triangle's height at the pivot."""
    rest_angle: Annotated[float, Quantity(-85.0, 85.0, "deg")] = -10.0
    """[deg] when its button is not held."""
    up_angle: Annotated[float, Quantity(-85.0, 85.0, "deg")] = 45.0
    """[deg] when its button is held; above rest_angle."""
    stroke: Annotated[float, Quantity(0.02, 1.0, "s")] = 0.1
    """[s] from rest to up, at constant speed."""
    return_stroke: Annotated[float, Quantity(0.02, 1.0, "s")] = 0.1
    """[s] from up to rest."""
    restitution: _Restitution = 0.5
    """Restitution at a slow contact."""
    restitution_falloff: _Falloff = 0.02
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    points: _Points = 0
    """Points for a hit."""

    @field_validator("up_angle")
    @classmethod
    def _lifts(cls, up_angle: float, info: ValidationInfo) -> float:
        rest_angle = info.data.get("rest_angle")
        if rest_angle is not None and up_angle <= rest_angle:
            refuse(f"must be above rest_angle ({rest_angle:g} deg), got {up_angle:g}")
        return up_angle

    @property
    def reach(self) -> float:
        """[u] largest distance of a point of the paddle from the pivot."""
        return max(self.length, 0.5 * self.base)

    @property
    def tip_speed(self) -> float:
        """[u/s] speed of the fastest point in the faster of the two strokes."""
        turn = math.radians(self.up_angle - self.rest_angle)
        return turn / min(self.stroke, self.return_stroke) * self.reach

    @property
    def direction(self) -> float:
        """1 for a left paddle, whose tip points to +z at 0 deg; −1 for a right one."""
        return 1.0 if self.side == "left" else -1.0

    def primitives(self, board: Board) -> tuple[Primitive, ...]:
        """One triangle on a mover; its points are relative to the pivot."""
        mover = Mover(
            self.pivot,
            self.direction,
            math.radians(self.rest_angle),
            math.radians(self.up_angle),
            self.stroke,
            self.return_stroke,
            self.side,
        )
        return (
            Primitive(
                Shape.TRIANGLE,
                self.local_corners(),
                surface=self._surface(),
                finish=Finish.PADDLE,
                mover=mover,
            ),
        )

    def local_corners(self) -> Triangle:
        """The lower base, tip and upper base (x, z) [u] of a left paddle at 0 deg, relative to its pivot."""
        half = 0.5 * self.base
        return (-half, 0.0), (0.0, self.length), (half, 0.0)

    def corners(self, angle_deg: float) -> Triangle:
        """The corners (x, z) [u] at an angle, counter-clockwise.

        Args:
            angle_deg: The mirrored angle [deg]: −10 at rest and 45 up, for a left and a right paddle alike.
        """
        sine, cosine = _libm(math.radians(angle_deg))
        x, z = self.pivot
        lower, tip, upper = (
            (x + (across * cosine + along * sine), z + self.direction * (along * cosine - across * sine))
            for across, along in self.local_corners()
        )
        return (lower, tip, upper) if self.side == "left" else (upper, tip, lower)


class PrismSurface(Model):
    """The surface of a triangular prism, which slows a ball down."""

    restitution: _Restitution = 0.8
    """Restitution at a slow contact."""
    restitution_falloff: _Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    speed_factor: _SpeedFactor = 0.85
    """At a hit, the whole velocity after the bounce is multiplied by this; below 1 it slows the ball."""
    points: _Points = 50
    """Points for a hit."""


class TriangularPrism(PrismSurface, _Part):
    """An obstacle with a triangular footprint.

    Give exactly one of: `vertices`; or `center` and `size` (and `rotation`) for an equilateral one; or
    `mesh`, whose footprint becomes the `vertices` when the table file is loaded.
    """

    vertices: _Corners | None = None
    """[u] the three corners, each [x, z], in any order."""
    center: _Place | None = None
    """[u] the centre of an equilateral footprint, [x, z]."""
    size: _Radius | None = None
    """[u] circumradius of an equilateral footprint."""
    rotation: Annotated[float, Quantity(-360.0, 360.0, "deg")] = 0.0
    """[deg] direction from the centre to the first corner of an equilateral footprint."""
    mesh: Annotated[str, Field(min_length=1, max_length=1000)] | None = None
    """An STL, OBJ or GLB file, relative to the table file."""

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        has_rotation = "rotation" in self.model_fields_set
        given = [
            key
            for key, is_given in (
                ("vertices", self.vertices is not None),
                ("center", self.center is not None or self.size is not None or has_rotation),
                ("mesh", self.mesh is not None),
            )
            if is_given
        ]
        forms = "`vertices`, or `center` with `size` and `rotation`, or `mesh`"
        if len(given) != 1:
            refuse(f"needs exactly one of {forms}, got {' and '.join(given) if given else 'none of them'}")
        if given == ["center"] and (self.center is None or self.size is None):
            refuse(
                f"needs `{'center' if self.center is None else 'size'}` too: an equilateral prism has both"
            )
        return self

    def resolved(self, folder: Path | None = None) -> TriangularPrism:
        """Return the prism with its mesh, if any, replaced by the `vertices` of its footprint.

        Args:
            folder: Where to look for the mesh; the current folder by default.

        Raises:
            TableError: The mesh cannot be read or used.
        """
        if self.mesh is None:
            return self
        from silverball.table.mesh import triangle_footprint

        vertices = triangle_footprint((folder or Path()) / self.mesh)
        return self.model_copy(update={"mesh": None, "vertices": vertices})

    def corners(self, sine_cosine: SineCosine = _libm) -> Triangle:
        """Return the three corners (x, z) [u], counter-clockwise, however the prism was specified.

        Args:
            sine_cosine: The functions that turn an equilateral prism. The physics passes its own, which give
                the same bits on every machine.
        """
        if self.vertices is not None:
            return _counter_clockwise(self.vertices)
        if self.mesh is not None:
            return self.resolved().corners()
        assert self.center is not None
        assert self.size is not None
        x, z = self.center
        angles = (sine_cosine(math.radians(self.rotation + third)) for third in (0.0, 120.0, 240.0))
        a, b, c = ((x + self.size * sine, z + self.size * cosine) for sine, cosine in angles)
        return (a, b, c)

    def primitives(self, board: Board) -> tuple[Primitive, ...]:
        """One triangle."""
        return (Primitive(Shape.TRIANGLE, self.corners(), surface=self._surface(), finish=Finish.PRISM),)

    def outline(self) -> Outline:
        """The corners as a core, without a radius."""
        return self.corners(), 0.0


class CylinderSurface(Model):
    """The surface of a cylinder, which speeds a ball up."""

    restitution: _Restitution = 0.9
    """Restitution at a slow contact."""
    restitution_falloff: _Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    speed_factor: _SpeedFactor = 1.25
    """At a hit, the whole velocity after the bounce is multiplied by this; above 1 it boosts the ball."""
    points: _Points = 100
    """Points for a hit."""


class Cylinder(CylinderSurface, _Part):
    """A round obstacle: `center` and `radius`, or a `mesh` whose footprint gives both when loaded."""

    center: _Place | None = None
    """[u] the centre, [x, z]."""
    radius: _Radius | None = None
    """[u] from the centre to the surface."""
    mesh: Annotated[str, Field(min_length=1, max_length=1000)] | None = None
    """An STL, OBJ or GLB file, relative to the table file."""

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        given = [key for key in ("center", "radius") if getattr(self, key) is not None]
        if self.mesh is not None and given:
            refuse(f"needs either `mesh` or `center` and `radius`, got mesh and {' and '.join(given)}")
        if self.mesh is None and len(given) < 2:
            missing = " and ".join(f"`{key}`" for key in ("center", "radius") if key not in given)
            refuse(f"needs {missing}: a cylinder has `center` and `radius`, or a `mesh`")
        return self

    def resolved(self, folder: Path | None = None) -> Cylinder:
        """Return the cylinder with its mesh, if any, replaced by the `center` and `radius` of its footprint.

        Args:
            folder: Where to look for the mesh; the current folder by default.

        Raises:
            TableError: The mesh cannot be read or used.
        """
        if self.mesh is None:
            return self
        from silverball.table.mesh import circle_footprint

        x, z, radius = circle_footprint((folder or Path()) / self.mesh)
        return self.model_copy(update={"mesh": None, "center": (x, z), "radius": radius})

    def circle(self) -> tuple[float, float, float]:
        """Return the footprint: x and z of the centre, and the radius [u]."""
        if self.mesh is not None:
            return self.resolved().circle()
        assert self.center is not None
        assert self.radius is not None
        return (*self.center, self.radius)

    def primitives(self, board: Board) -> tuple[Primitive, ...]:
        """One circle."""
        x, z, radius = self.circle()
        return (Primitive(Shape.CIRCLE, ((x, z),), radius, surface=self._surface(), finish=Finish.BUMPER),)

    def outline(self) -> Outline:
        """The centre as a core, and the radius."""
        x, z, radius = self.circle()
        return ((x, z), (x, z), (x, z)), radius


StationaryPart: TypeAlias = SlantWall | TriangularPrism | Cylinder
"""A part that does not move."""

PART_KINDS: dict[str, type[SlantWall | Paddle | TriangularPrism | Cylinder]] = {
    "slant_wall": SlantWall,
    "paddle": Paddle,
    "triangular_prism": TriangularPrism,
    "cylinder": Cylinder,
}
"""The sections of a table file that hold a list of parts, and the model of each."""


class RandomRecipe(Model):
    """Which obstacles to place at random for each seed, and the rules for placing them."""

    triangular_prisms: Annotated[int, Count(0, 32, "prisms")] = 4
    """Number of triangular prisms."""
    cylinders: Annotated[int, Count(0, 32, "cylinders")] = 3
    """Number of cylinders."""
    prism_size: Annotated[tuple[float, float], Interval(Quantity(0.2, 5.0, "u"))] = (0.8, 1.0)
    """[u] circumradius of a prism, [least, greatest]."""
    cylinder_radius: Annotated[tuple[float, float], Interval(Quantity(0.1, 5.0, "u"))] = (0.5, 0.7)
    """[u] radius of a cylinder, [least, greatest]."""
    area: Annotated[tuple[Point, Point], FixedList(POINT, 2, "[[x, z], [x, z]]")] = ((-2.0, -4.0), (8.5, 4.0))
    """[u] the rectangle for the centres: its lower left and its upper right corner."""
    gap: Annotated[float, Quantity(0.0, 10.0, "u")] = 0.9
    """[u] least free space between the bounding circles of two obstacles; more than a ball."""
    wall_gap: Annotated[float, Quantity(0.0, 10.0, "u")] = 0.9
    """[u] the same from a bounding circle to the surface of any wall and to the turning paddles."""
    rotation: Annotated[tuple[float, float], Interval(Quantity(0.0, 360.0, "deg"))] = (10.0, 80.0)
    """[deg] rotation of a prism, [least, greatest]; every edge also stays 10° off both axes."""
    prism: PrismSurface = PrismSurface()
    """How the prisms bounce a ball."""
    cylinder: CylinderSurface = CylinderSurface()
    """How the cylinders bounce a ball."""

    @field_validator("area")
    @classmethod
    def _has_inside(cls, area: tuple[Point, Point]) -> tuple[Point, Point]:
        (low_x, low_z), (high_x, high_z) = area
        if low_x > high_x or low_z > high_z:
            refuse(
                "must be written [[lower x, left z], [upper x, right z]], "
                f"got {shown([list(point) for point in area])}"
            )
        return area


class Arcade(Model):
    """The rules of an arcade game on this table; free play ignores them."""

    balls: Annotated[int, Count(1, 99, "balls")] = 3
    """Balls of a game. With three the reflex player lasts for two minutes."""
    ball_save: Annotated[float, Quantity(0.0, 60.0, "s")] = 5.0
    """[s] a ball that is lost within this time of its start is returned to the player; 0: never. A second
    ball launched while the first is in play is not. Choose a little less than an unplayed ball lasts (about
    8 s)."""
    ball_saves: Annotated[int, Count(0, 9, "times")] = 1
    """How often the same ball is returned; with 1 a returned ball is not saved again."""
    combo_window: Annotated[float, Quantity(0.0, 10.0, "s")] = 1.0
    """[s] a scoring hit within this time of the previous one continues the combo; 0: no combos. With 1 s on
    the built-in tables six hits of ten continue a combo."""
    combo_step: Annotated[int, Count(1, 100, "hits")] = 3
    """Hits that raise the factor of a combo by one: with 3 the first to third count once, the fourth to sixth
    twice, and so on."""
    combo_limit: Annotated[int, Count(1, 100)] = 5
    """The greatest factor of a combo; 1: combos are counted but pay nothing."""
    double: Annotated[int, Count(1, 100)] = 2
    """The factor while two balls are on the board. The second ball is one of the remaining balls and is not
    saved, so this rewards the risk."""
    tilt_decay: Annotated[float, Quantity(0.1, 60.0, "s")] = 1.5
    """[s] time in which the swing of the tilt bob falls to 1/e. Each shove adds 1 to the swing."""
    tilt_warning: Annotated[float, Quantity(0.0, 1000.0)] = 1.5
    """A shove that swings the bob further than this gives a warning. With 1.5 and a decay of 1.5 s a second
    shove within a second does, a single one never; below 1 every shove does."""
    tilt_limit: Annotated[float, Quantity(0.0, 1000.0)] = 2.4
    """A swing further than this is a tilt: the paddles are dead and nothing scores until the board is
    empty. With 2.4 the third of three quick shoves is a tilt."""
    warnings: Annotated[int, Count(0, 99, "warnings")] = 2
    """Warnings per ball; the next one after the last of them is a tilt."""
    un_stick: Annotated[float, Quantity(0.5, 60.0, "s")] = 3.0
    """[s] how long a ball lies still before the machine shoves it. A ball within reach of the paddles is left
    alone while a button is held: the player has caught it."""
    stall: Annotated[float, Quantity(1.0, 600.0, "s")] = 20.0
    """[s] time without a scoring hit after which the machine shoves in any case, so that a ball cannot be
    held forever; longer than any player needs to aim."""
