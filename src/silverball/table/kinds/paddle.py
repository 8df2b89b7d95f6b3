"""Paddles, which the player moves; the trade says flipper."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import ValidationInfo, field_validator, model_validator

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Solid
from silverball.table.model import SINCE_2, Falloff, Place, Restitution, SineCosine, Triangle, libm
from silverball.table.primitive import Finish, Mover, Primitive
from silverball.table.quantity import Quantity, refuse


class Paddle(Solid):
    """A flipper that turns about its pivot: an isosceles triangle, or a capsule that tapers towards its tip.

    Angles are those of a left paddle; a right one is the exact mirror image. So for both a larger angle
    means a higher tip.
    """

    side: Literal["left", "right"]
    """The way it turns: the tip of a left one points to the right at 0 deg. Also its button, unless `button`
    says another one; format 1 has one paddle per side."""
    pivot: Place
    """[u] the middle of the base, [x, z]; of a capsule the centre of its round base."""
    length: Annotated[float, Quantity(0.3, 10.0, "u")] = 2.1
    """[u] from the pivot to the tip; of a capsule to the centre of its round tip."""
    base: Annotated[float, Quantity(0.05, 5.0, "u")] = 0.5
    """[u] the triangle's height at the pivot."""
    rest_angle: Annotated[float, Quantity(-120.0, 120.0, "deg", before=(-85.0, 85.0))] = -10.0
    """[deg] when its button is not held; beyond ±85 needs format 2."""
    up_angle: Annotated[float, Quantity(-120.0, 120.0, "deg", before=(-85.0, 85.0))] = 45.0
    """[deg] when its button is held; above rest_angle. Beyond ±85 needs format 2."""
    stroke: Annotated[float, Quantity(0.01, 1.0, "s", before=(0.02, 1.0))] = 0.1
    """[s] from rest to up; below 0.02 needs format 2."""
    return_stroke: Annotated[float, Quantity(0.01, 1.0, "s", before=(0.02, 1.0))] = 0.1
    """[s] from up to rest; below 0.02 needs format 2."""
    shape: Annotated[Literal["triangle", "capsule"], SINCE_2] = "triangle"
    """A triangle has a `base`, a capsule a `base_radius` and a `tip_radius`."""
    base_radius: Annotated[float, Quantity(0.05, 2.0, "u"), SINCE_2] = 0.2
    """[u] radius of a capsule around its pivot."""
    tip_radius: Annotated[float, Quantity(0.02, 2.0, "u"), SINCE_2] = 0.12
    """[u] radius of a capsule around its tip; at most base_radius."""
    button: Annotated[Literal["left", "right"] | None, SINCE_2] = None
    """The button that moves it; by default that of its side."""
    profile: Annotated[Literal["constant", "coil"], SINCE_2] = "constant"
    """How it turns: at constant speed, or as a coil moves it, at constant acceleration from rest."""
    mass: Annotated[Annotated[float, Quantity(0.1, 1000.0, "ball masses")] | None, SINCE_2] = None
    """[ball masses] a light paddle gives way: the impulse on a ball is multiplied by 1 / (1 + 3·r²/(m·L²)), r
    from the pivot, L the length. A real one has about 1; by default it does not give way."""
    restitution: Restitution = 0.5
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.02
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""

    own_finish = Finish.PADDLE

    @field_validator("up_angle")
    @classmethod
    def _lifts(cls, up_angle: float, info: ValidationInfo) -> float:
        rest_angle = info.data.get("rest_angle")
        if rest_angle is not None and up_angle <= rest_angle:
            refuse(f"must be above rest_angle ({rest_angle:g} deg), got {up_angle:g}")
        return up_angle

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        default = type(self).model_fields
        foreign = ("base",) if self.shape == "capsule" else ("base_radius", "tip_radius")
        given = [key for key in foreign if getattr(self, key) != default[key].default]
        if given:
            refuse(f"must not have `{given[0]}`: its shape is a {self.shape}")
        if self.shape == "capsule" and self.tip_radius > self.base_radius:
            refuse(f"must have a tip_radius of at most base_radius ({self.base_radius:g} u)")
        if self.shape == "capsule" and self.length <= self.base_radius - self.tip_radius:
            refuse("must be longer: its round base contains its tip")
        return self

    @property
    def pressed_by(self) -> Literal["left", "right"]:
        """The button that moves it."""
        return self.side if self.button is None else self.button

    @property
    def reach(self) -> float:
        """[u] largest distance of a point of the paddle from the pivot."""
        if self.shape == "capsule":
            return self.length + self.tip_radius
        return max(self.length, 0.5 * self.base)

    @property
    def tip_speed(self) -> float:
        """[u/s] speed of the fastest point in the faster of the two strokes."""
        turn = math.radians(self.up_angle - self.rest_angle)
        average = turn / min(self.stroke, self.return_stroke) * self.reach
        return 2.0 * average if self.profile == "coil" else average

    @property
    def direction(self) -> float:
        """1 for a left paddle, whose tip points to +z at 0 deg; −1 for a right one."""
        return 1.0 if self.side == "left" else -1.0

    def local_corners(self) -> Triangle:
        """The lower base, tip and upper base (x, z) [u] of a left paddle at 0 deg, relative to its pivot.

        Of a capsule, a triangle along its axis.
        """
        half = 0.5 * self.base if self.shape == "triangle" else self.base_radius
        along = self.length if self.shape == "triangle" else self.reach
        return (-half, 0.0), (0.0, along), (half, 0.0)

    def corners(self, angle_deg: float) -> Triangle:
        """The corners (x, z) [u] at an angle, counter-clockwise.

        Args:
            angle_deg: The mirrored angle [deg]: −10 at rest and 45 up, for a left and a right paddle alike.
        """
        sine, cosine = libm(math.radians(angle_deg))
        x, z = self.pivot
        lower, tip, upper = (
            (x + (across * cosine + along * sine), z + self.direction * (along * cosine - across * sine))
            for across, along in self.local_corners()
        )
        return (lower, tip, upper) if self.side == "left" else (upper, tip, lower)

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one triangle or tapered capsule on a mover."""
        del board, sine_cosine
        is_capsule = self.shape == "capsule"
        return (
            Primitive(
                Shape.TAPERED if is_capsule else Shape.TRIANGLE,
                ((0.0, 0.0), (0.0, self.length)) if is_capsule else self.local_corners(),
                radius=self.base_radius if is_capsule else 0.0,
                tip_radius=self.tip_radius if is_capsule else 0.0,
                surface=self.surface(),
                finish=self.shown_finish,
                levels=self.all_levels,
                mover=Mover(
                    pivot=self.pivot,
                    direction=self.direction,
                    rest_angle=math.radians(self.rest_angle),
                    up_angle=math.radians(self.up_angle),
                    stroke=self.stroke,
                    return_stroke=self.return_stroke,
                    button=self.pressed_by,
                    is_coil=self.profile == "coil",
                    mass=self.mass,
                ),
            ),
        )
