"""Solids: the SOLID records that are built on the primitives of a table.

A primitive's shape gives the footprint, its finish the look (see looks.py). Gates, spinners and plungers
have a frame that stands and a piece that moves; the pieces of a pose are built by `add_pose`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.dimensions import LEVEL_RISE, Dimensions, corner_behind
from silverball.drawing.kernels.solids import CAP_RISE, CAP_SHARE, RING
from silverball.drawing.kernels.stage import SOLID, Material, Outline
from silverball.drawing.layout import Layout, Row
from silverball.drawing.looks import LOOKS, Fill, Look
from silverball.drawing.moving import (
    FLAP_ANGLE,
    PULL,
    SPIN_POSES,
    Motion,
    MovingPart,
    is_moving,
    motion_of,
    pose_angle,
)
from silverball.drawing.themes import Color, Theme, role_color
from silverball.physics.forms import Shape
from silverball.physics.records import records
from silverball.table import Board
from silverball.table.outlines import closed_outline
from silverball.table.primitive import Point, Primitive, arc_of

NO_CULL = 1e9  # [u]
BRACKET = 0.055  # [u] radius of the posts that hold a gate or a spinner
BLADE_AXIS = 0.42  # [u] height of the axis of a spinner
FLAP_AXIS = 0.52  # [u] the same of a gate
THIN = 0.02  # [u] least radius of a wall; a thinner one would be seen here and there only
WIRE = 0.05  # [u] half the width of a line in the playfield
SLOT = 0.012  # [u] height of what lies in the playfield
BULGE = 0.28  # tan(angle/4) of the rubber of a slingshot that has just kicked
ROD = 0.09  # [u] radius of a plunger


class Solids:
    """Collects the solids of a scene.

    Args:
        board: The board.
        dimensions: The heights on it.
        theme: The colours.
    """

    def __init__(self, board: Board, dimensions: Dimensions, theme: Theme) -> None:
        self.corners: list[Point] = []
        self._board = board
        self._dimensions = dimensions
        self._theme = theme
        self._unit = dimensions.unit
        self._records: list[Any] = []
        self._parts: list[str] = []
        self._counts: dict[str, int] = {}
        self._behind: list[tuple[Point, Point, Point]] = []
        self._group = 0
        self._base = 0.0

    def add_layout(self, layout: Layout, level: int) -> None:
        """Add what stands still on a level and below it."""
        for first, end in _runs(layout.rows):
            part, primitives = layout.rows[first].part, tuple(row.primitive for row in layout.rows[first:end])
            colors = self._next_colors(primitives[0])
            drawn = tuple(p for p in primitives if min(p.levels) <= level)
            if drawn:
                self._begin(part, shown_level(drawn[0], level))
                for primitive in drawn:
                    self._add_still(primitive, colors)
                self._fill(drawn, colors)
        for corners in self._behind:
            self._begin("", 0)
            solid = self._new(Material.PLAIN, self._theme.apron, 0.8 * self._dimensions.wall_height, 0.01)
            self._set_triangle(solid, corners)

    def add_pose(self, part: MovingPart, pose: int) -> None:
        """Add the moving piece of a part in one of its poses."""
        primitive = part.primitive
        look, color = LOOKS[primitive.finish], self._color(primitive, part.number)
        self._begin(part.part, part.level)
        if part.motion is Motion.TURNING:
            self._add_paddle(primitive, color, pose_angle(part, pose))
        elif part.motion is Motion.STANDING:
            self._add_shape(primitive, look, color)
        elif part.motion is Motion.PULLED:
            self._add_rod(primitive, color, PULL * self._unit * pose / (part.poses - 1))
        elif part.motion is Motion.KICKING:
            bulge = BULGE if pose == 0 else -BULGE
            self._add_shape(primitive._replace(shape=Shape.ARC, bulge=bulge), look, color)
        elif part.motion is Motion.SPINNING:
            assert primitive.spin is not None
            half = max(min(primitive.spin.height, 0.9 * BLADE_AXIS * self._unit), 0.1 * self._unit)
            self._add_plate(primitive, color, BLADE_AXIS, (-half, half), math.pi * pose / SPIN_POSES)
        else:
            way = primitive.one_way or (0.0, 0.0)
            (x0, z0), (x1, z1) = primitive.points
            forward = way[0] * (z1 - z0) - way[1] * (x1 - x0)  # along the plate's normal
            angle = math.copysign(FLAP_ANGLE, forward) * pose / (part.poses - 1)
            self._add_plate(primitive, color, FLAP_AXIS, (-0.85 * FLAP_AXIS * self._unit, 0.0), angle)

    def finished(self) -> tuple[NDArray[Any], NDArray[np.float64], tuple[str, ...]]:
        """Return the SOLID records, the corners of polygons, and the part of each solid."""
        solids = records(len(self._records), SOLID)
        for index, solid in enumerate(self._records):
            solids[index] = solid
        corners = np.array(self.corners, np.float64).reshape(-1, 2)
        return solids, corners, tuple(self._parts)

    def _begin(self, part: str, level: int) -> None:
        """Begin the solids of another part."""
        self._part = part
        self._group += 1
        self._base = level * LEVEL_RISE * self._unit

    def _new(self, material: Material, color: Color, height: float, bevel: float) -> Any:
        """Add a solid without a footprint."""
        solid: Any = np.zeros(1, SOLID)[0]
        solid["material"], solid["group"] = material, self._group
        solid["base"], solid["height"], solid["bevel"] = self._base, self._base + height, bevel
        solid["side"] = solid["cosine"] = 1.0
        solid["cull"], solid["top"] = NO_CULL, solid["height"]
        solid["red"], solid["green"], solid["blue"] = linear(color)
        self._records.append(solid)
        self._parts.append(self._part)
        return solid

    def _next_colors(self, primitive: Primitive) -> int:
        """Return the number of a part among those of its colours."""
        role = LOOKS[primitive.finish].role
        self._counts[role] = self._counts.get(role, -1) + 1
        return self._counts[role]

    def _color(self, primitive: Primitive, number: int) -> Color:
        return role_color(self._theme, LOOKS[primitive.finish].role, number)

    def _add_still(self, primitive: Primitive, number: int) -> None:
        """Add what of a primitive does not move."""
        look, color = LOOKS[primitive.finish], self._color(primitive, number)
        motion = motion_of(primitive)
        if motion is Motion.STANDING:  # the slot into which it sinks
            self._add_shape(primitive, look._replace(height=SLOT, bevel=0.004, glow=0.0), _dark(color))
        elif motion in (Motion.HANGING, Motion.SPINNING):
            for place in primitive.points:
                solid = self._new(
                    Material.STEEL, self._theme.steel, look.height * self._unit, 0.02 * self._unit
                )
                self._set_circle(solid, place, BRACKET * self._unit)
        elif not is_moving(primitive):
            self._add_shape(primitive, look, color)

    def _add_shape(self, primitive: Primitive, look: Look, color: Color) -> None:
        solid = self._new(look.material, color, look.height * self._unit, look.bevel * self._unit)
        solid["glow"] = look.glow * self._theme.halo
        solid["tube"] = self._theme.halo if look.has_tube else 0.0
        points, radius = primitive.points, primitive.radius
        if primitive.shape in (Shape.CIRCLE, Shape.DISC):
            self._set_circle(solid, points[0], radius)
            if look.material is not Material.BUMPER:
                solid["bevel"] = min(radius, solid["bevel"])
        elif primitive.shape == Shape.TRIANGLE:
            self._set_triangle(solid, points)
        elif primitive.shape == Shape.ARC:
            radius = max(radius, THIN * self._unit)
            self._set_arc(solid, primitive._replace(radius=radius))
            solid["bevel"] = min(radius, solid["bevel"])
        else:
            radius = WIRE * self._unit if primitive.shape == Shape.LINE else max(radius, THIN * self._unit)
            self._set_capsule(solid, points[0], points[1], radius)
            solid["bevel"] = min(radius, solid["bevel"])
            corner = corner_behind(self._board, *points) if look.has_tube else None
            if corner is not None:
                self._behind.append(corner)

    def _add_paddle(self, primitive: Primitive, color: Color, angle: float) -> None:
        mover, look = primitive.mover, LOOKS[primitive.finish]
        assert mover is not None
        solid = self._new(look.material, color, look.height * self._unit, look.bevel * self._unit)
        if primitive.shape == Shape.TRIANGLE:
            self._set_triangle(solid, primitive.points)
            base = primitive.points[2][0] - primitive.points[0][0]
        else:
            solid["outline"] = Outline.TAPERED
            _set_side(solid, 0, *primitive.points)
            solid["radius"], solid["tip_radius"] = primitive.radius, primitive.tip_radius
            base = 2.0 * primitive.radius
        solid["x"], solid["z"] = mover.pivot
        solid["reach"] = max(math.hypot(*point) for point in primitive.points) + primitive.radius
        solid["cull"], solid["turns"], solid["side"] = NO_CULL, 1, mover.direction
        solid["sine"], solid["cosine"] = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        height = float(solid["height"] - solid["base"])
        solid["bolt"] = min(0.36 * base, 0.3 * height / 0.33)
        solid["top"] += 0.5 * solid["bolt"]

    def _add_plate(
        self, primitive: Primitive, color: Color, axis: float, extent: tuple[float, float], angle: float
    ) -> None:
        """Add a plate that hangs from an axis [u] or turns about it."""
        solid = self._new(Material.BLADE, color, axis * self._unit, 0.0)
        self._set_capsule(solid, primitive.points[0], primitive.points[1], max(-extent[0], extent[1]))
        solid["outline"] = Outline.PLATE
        solid["thin"] = 0.02 * self._unit
        solid["cull"] += solid["thin"]
        solid["low"], solid["high"] = extent
        solid["top"] += solid["radius"] + solid["thin"]
        solid["sine"], solid["cosine"] = math.sin(angle), math.cos(angle)

    def _add_rod(self, primitive: Primitive, color: Color, pull: float) -> None:
        """Add the rod of a plunger below the ball that lies on it."""
        assert primitive.launch is not None
        (x, z), (to_x, to_z) = primitive.points[0], primitive.launch.direction
        look = LOOKS[primitive.finish]
        for length, radius in ((1.4, ROD), (0.02, 1.9 * ROD)):
            start = self._dimensions.ball + 1.9 * ROD * self._unit + pull
            end = start + length * self._unit
            solid = self._new(look.material, color, look.height * self._unit, radius * self._unit)
            self._set_capsule(
                solid,
                (x - start * to_x, z - start * to_z),
                (x - end * to_x, z - end * to_z),
                radius * self._unit,
            )

    def _fill(self, primitives: Sequence[Primitive], number: int) -> None:
        """Add what a closed wall encloses."""
        outline = closed_outline(tuple(primitives))
        if outline is None or (motion_of(primitives[0]) is not None and is_moving(primitives[0])):
            return
        fill: Fill = LOOKS[primitives[0].finish].fill
        height = (LOOKS[primitives[0].finish].height - fill.drop) * self._unit
        solid = self._new(fill.material, role_color(self._theme, fill.role, number), height, 0.0)
        xs, zs = [x for x, _ in outline], [z for _, z in outline]
        solid["outline"] = Outline.POLYGON
        solid["x"], solid["z"] = 0.5 * (min(xs) + max(xs)), 0.5 * (min(zs) + max(zs))
        solid["x1"], solid["z1"] = 0.5 * (max(xs) - min(xs)), 0.5 * (max(zs) - min(zs))
        solid["reach"] = solid["cull"] = math.hypot(solid["x1"], solid["z1"])
        solid["first"], solid["end"] = len(self.corners), len(self.corners) + len(outline)
        self.corners += outline

    def _set_circle(self, solid: Any, center: Point, radius: float) -> None:
        solid["outline"] = Outline.CIRCLE
        solid["x"], solid["z"] = center
        solid["radius"] = solid["reach"] = radius
        solid["cull"] = radius
        if solid["material"] == Material.BUMPER:  # its cap is a slice of a larger sphere
            wide = CAP_SHARE * radius
            rise = min(CAP_RISE * wide, 0.45 * self._unit)
            solid["cull"] = max(radius, (wide * wide + rise * rise) / (2.0 * rise))
            solid["top"] += rise + RING * self._unit

    def _set_capsule(self, solid: Any, start: Point, end: Point, radius: float) -> None:
        solid["outline"] = Outline.CAPSULE
        _set_side(solid, 0, start, end)
        solid["x1"], solid["z1"] = end
        solid["radius"] = radius
        solid["inward_x"], solid["inward_z"] = solid["along_z0"], -solid["along_x0"]
        solid["x"], solid["z"] = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        solid["reach"] = solid["cull"] = solid["length0"] / 2 + radius

    def _set_arc(self, solid: Any, primitive: Primitive) -> None:
        start, end = primitive.points
        center, radius, middle, _, cosine = arc_of(start, end, primitive.bulge)
        solid["outline"] = Outline.ARC
        solid["x"], solid["z"] = center
        solid["x0"], solid["z0"] = start
        solid["x1"], solid["z1"] = end
        solid["length0"], solid["radius"] = radius, primitive.radius
        solid["inward_x"], solid["inward_z"], solid["arc_cosine"] = *middle, cosine
        solid["reach"] = solid["cull"] = radius + primitive.radius

    def _set_triangle(self, solid: Any, corners: Sequence[Point]) -> None:
        solid["outline"] = Outline.TRIANGLE
        for number in range(3):
            _set_side(solid, number, corners[number], corners[(number + 1) % 3])
        x, z = sum(x for x, _ in corners) / 3, sum(z for _, z in corners) / 3
        solid["x"], solid["z"] = x, z
        reach = math.sqrt(max((px - x) ** 2 + (pz - z) ** 2 for px, pz in corners)) * (1 + 1e-12)
        solid["reach"] = solid["cull"] = reach


def shown_level(primitive: Primitive, level: int) -> int:
    """Return the level on which a primitive is drawn, of those up to a level.

    What lies flat, such as the mouth of a passage, is drawn on its lowest level, the rest on its highest.
    """
    numbers = [number for number in primitive.levels if number <= level]
    return min(numbers) if LOOKS[primitive.finish].height <= SLOT else max(numbers)


def _runs(rows: Sequence[Row]) -> list[tuple[int, int]]:
    """Return the ranges of rows that belong to one part."""
    starts = [n for n, row in enumerate(rows) if n == 0 or rows[n - 1].part != row.part]
    return list(pairwise([*starts, len(rows)]))


def _set_side(solid: Any, number: int, start: Point, end: Point) -> None:
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = max(math.sqrt(dx * dx + dz * dz), 1e-12)
    solid[f"x{number}"], solid[f"z{number}"] = start
    solid[f"along_x{number}"], solid[f"along_z{number}"] = dx / length, dz / length
    solid[f"length{number}"] = length


def _dark(color: Color) -> Color:
    red, green, blue = (value // 4 for value in color)
    return red, green, blue


def linear(color: Color) -> tuple[float, float, float]:
    """Convert a colour of the screen to linear light, with a gamma of 2.2."""
    red, green, blue = ((value / 255.0) ** 2.2 for value in color)
    return red, green, blue
