"""A table as arrays for ray marching: the physics' own shapes, and what is built on each.

A scene holds the records that balls collide with (`COLLIDER` of physics/records.py), in the same order and
with the same numbers, and for each one its `SOLID`: form, height and colour. Colours are linear light here,
not the screen's values.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import Dimensions, corner_behind
from silverball.drawing.kernels.solids import list_cells
from silverball.drawing.kernels.stage import (
    CELL,
    HALO,
    LIGHT,
    MAX_CELLS,
    NEAR,
    SOLID,
    STAGE,
    Form,
    Scene,
    ShapeRecord,
    SolidRecord,
)
from silverball.drawing.text import lettering
from silverball.drawing.themes import Color, Theme, cycled_color
from silverball.physics.records import COLLIDER, Kind, Part, records
from silverball.table import Table
from silverball.world.compile import compile_parts


def make_scene(
    table: Table, camera: Camera, theme: Theme, angles: tuple[float | None, float | None] = (None, None)
) -> Scene:
    """Return the scene of a table, with the paddles whose angle [deg] is given."""
    dimensions = camera.dimensions
    parts = compile_parts(table)
    corners = [c for wall in table.slant_wall if (c := corner_behind(table.board, wall)) is not None]
    shapes = records(len(parts) + len(corners), COLLIDER)
    shapes[: len(parts)] = parts
    solids = records(len(shapes), SOLID)
    _set_solids(solids, shapes, table, dimensions, theme)
    _set_corners(solids, shapes, corners, len(parts), dimensions, theme)
    for number, angle in zip((Part.LEFT_PADDLE, Part.RIGHT_PADDLE), angles, strict=True):
        _set_paddle(solids[number], shapes[number], angle, dimensions, theme)
    stage = _stage(camera, theme)
    return Scene(
        stage,
        solids,
        shapes,
        _inks(theme),
        list_cells(stage, solids, shapes, NEAR * stage[0]["unit"]),
        list_cells(stage, solids, shapes, HALO * stage[0]["unit"]),
        lettering(table.name, dimensions),
    )


def _set_solids(
    solids: NDArray[Any], shapes: NDArray[Any], table: Table, dimensions: Dimensions, theme: Theme
) -> None:
    forms = {Kind.SLANT_WALL: Form.WALL, Kind.TRIANGULAR_PRISM: Form.PRISM, Kind.CYLINDER: Form.CYLINDER}
    heights = {
        Form.WALL: dimensions.wall_height,
        Form.PRISM: dimensions.prism_height,
        Form.CYLINDER: dimensions.body_height,
    }
    counts = dict.fromkeys(heights, 0)
    colors = {Form.WALL: (theme.wall,), Form.PRISM: theme.prisms, Form.CYLINDER: theme.cylinders}
    for solid, shape in zip(solids, shapes, strict=True):
        form = forms.get(Kind(int(shape["kind"])), Form.ABSENT)
        solid["form"], solid["side"], solid["cosine"] = form, 1.0, 1.0
        if form is Form.ABSENT:
            continue
        solid["height"] = heights[form]
        solid["bevel"] = 0.055 * dimensions.unit
        if form is Form.WALL:
            solid["bevel"] = min(shape["radius"], 0.06 * dimensions.unit)
        _set_color(solid, cycled_color(colors[form], counts[form]))
        solid["glow"] = {Form.WALL: 0.0, Form.PRISM: 0.75, Form.CYLINDER: 1.0}[form] * theme.halo
        counts[form] += 1


def _set_corners(
    solids: NDArray[Any],
    shapes: NDArray[Any],
    corners: Sequence[Sequence[tuple[float, float]]],
    first: int,
    dimensions: Dimensions,
    theme: Theme,
) -> None:
    for number, corner in enumerate(corners, first):
        _set_triangle(shapes[number], corner)
        solids[number]["form"] = Form.CORNER
        solids[number]["height"], solids[number]["bevel"] = 0.8 * dimensions.wall_height, 0.01
        _set_color(solids[number], theme.apron)


def _set_paddle(
    solid: SolidRecord, shape: ShapeRecord, angle: float | None, dimensions: Dimensions, theme: Theme
) -> None:
    if angle is None or shape["kind"] != Kind.PADDLE:
        return
    solid["form"], solid["side"] = Form.PADDLE, shape["side"]
    solid["sine"], solid["cosine"] = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    solid["height"], solid["bevel"] = dimensions.paddle_height, 0.055 * dimensions.unit
    _set_color(solid, theme.paddle)


def _set_triangle(shape: ShapeRecord, corners: Sequence[tuple[float, float]]) -> None:
    """Set the fields of a triangle, as the physics does, for a corner that no ball can reach."""
    shape["kind"] = Kind.TRIANGULAR_PRISM
    for number in range(3):
        (x, z), (to_x, to_z) = corners[number], corners[(number + 1) % 3]
        length = math.hypot(to_x - x, to_z - z)
        shape[f"x{number}"], shape[f"z{number}"], shape[f"length{number}"] = x, z, length
        shape[f"along_x{number}"], shape[f"along_z{number}"] = (to_x - x) / length, (to_z - z) / length


def _set_color(solid: SolidRecord, color: Color) -> None:
    solid["red"], solid["green"], solid["blue"] = linear(color)


def _stage(camera: Camera, theme: Theme) -> NDArray[Any]:
    dimensions, frustum = camera.dimensions, camera.frustum
    stage = records(1, STAGE)
    row = stage[0]
    for name in ("half_length", "half_width", "thickness", "rail", "rail_height", "apron_height"):
        row[name] = getattr(dimensions, name)
    row["apron_top"], row["top"] = dimensions.apron_top, dimensions.top
    row["unit"] = dimensions.unit
    for name in ("art", "frame", "exposure", "key", "fill", "lacquer", "halo", "cap_ground"):
        row[name] = getattr(theme, name)
    row["light_x"], row["light_y"] = LIGHT
    for name in frustum._fields:
        row[name] = getattr(frustum, name)
    row["pixel"] = 1.0 / camera.scale
    long, wide = (
        2.0 * (dimensions.half_length + dimensions.rail),
        2.0 * (dimensions.half_width + dimensions.rail),
    )
    side = max(CELL * row["unit"], max(long, wide) / MAX_CELLS)
    row["low_x"], row["low_z"], row["cell_scale"] = -0.5 * long, -0.5 * wide, 1.0 / side
    row["rows"], row["columns"] = math.ceil(long / side), math.ceil(wide / side)
    return stage


def _inks(theme: Theme) -> NDArray[np.float64]:
    colors = (
        theme.room, *theme.floor, theme.ray, theme.glow, *theme.ornament, theme.heart, theme.rail, theme.wall,
        theme.apron, theme.label, *theme.strips, theme.paddle_edge, theme.cap, theme.steel, theme.ball,
        theme.ball_low,
    )  # fmt: skip
    return np.array([linear(color) for color in colors])


def linear(color: Color) -> tuple[float, float, float]:
    """Convert a colour of the screen to linear light, with a gamma of 2.2."""
    red, green, blue = ((value / 255.0) ** 2.2 for value in color)
    return red, green, blue
