"""What does the marcher see of a table? Its parts as arrays: the physics' own shapes, and how they look.

A scene holds the very records that balls collide with (`COLLIDER` of physics/records.py), in the same order
and with the same numbers, beside each one its `LOOK`: what it is built as, how tall, which colour. Colours
are linear light here, not the screen's values.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import Build, corner_behind
from silverball.drawing.kernels.solids import list_cells
from silverball.drawing.kernels.stage import CELL, HALO, LIGHT, LOOK, MOST_CELLS, NEAR, STAGE, Form, Scene
from silverball.drawing.text import lettering
from silverball.drawing.themes import Color, Theme, in_turn
from silverball.physics.records import COLLIDER, Kind, Part, records
from silverball.table import Table
from silverball.world.compile import compile_tables


def make_scene(
    table: Table, camera: Camera, theme: Theme, angles: tuple[float | None, float | None] = (None, None)
) -> Scene:
    """The scene of a table without paddles, or with those whose angle [deg] is given."""
    build = camera.build
    boards = compile_tables([table])
    corners = [c for wall in table.slant_wall if (c := corner_behind(table.board, wall)) is not None]
    shapes = records(len(boards.collider) + len(corners), COLLIDER)
    shapes[: len(boards.collider)] = boards.collider
    looks = records(len(shapes), LOOK)
    _set_looks(looks, shapes, table, build, theme)
    _set_corners(looks, shapes, corners, len(boards.collider), build, theme)
    for number, angle in zip((Part.LEFT_PADDLE, Part.RIGHT_PADDLE), angles, strict=True):
        _set_paddle(looks[number], shapes[number], angle, build, theme)
    stage = _stage(camera, theme)
    return Scene(
        stage,
        looks,
        shapes,
        _inks(theme),
        list_cells(stage, looks, shapes, NEAR * stage[0]["unit"]),
        list_cells(stage, looks, shapes, HALO * stage[0]["unit"]),
        lettering(table.name, build),
    )


def _set_looks(looks: NDArray[Any], shapes: NDArray[Any], table: Table, build: Build, theme: Theme) -> None:
    forms = {Kind.SLANT_WALL: Form.WALL, Kind.TRIANGULAR_PRISM: Form.PRISM, Kind.CYLINDER: Form.CYLINDER}
    heights = {
        Form.WALL: build.wall_height, Form.PRISM: build.prism_height, Form.CYLINDER: build.body_height
    }  # fmt: skip
    counts = dict.fromkeys(heights, 0)
    colors = {Form.WALL: (theme.wall,), Form.PRISM: theme.prisms, Form.CYLINDER: theme.cylinders}
    for look, shape in zip(looks, shapes, strict=True):
        form = forms.get(Kind(int(shape["kind"])), Form.ABSENT)
        look["form"], look["side"], look["cosine"] = form, 1.0, 1.0
        if form is Form.ABSENT:
            continue
        look["height"] = heights[form]
        look["bevel"] = 0.055 * build.unit
        if form is Form.WALL:
            look["bevel"] = min(shape["radius"], 0.06 * build.unit)
        _set_color(look, in_turn(colors[form], counts[form]))
        look["glow"] = {Form.WALL: 0.0, Form.PRISM: 0.75, Form.CYLINDER: 1.0}[form] * theme.halo
        counts[form] += 1


def _set_corners(
    looks: NDArray[Any],
    shapes: NDArray[Any],
    corners: Sequence[Sequence[tuple[float, float]]],
    first: int,
    build: Build,
    theme: Theme,
) -> None:
    for number, corner in enumerate(corners, first):
        _set_triangle(shapes[number], corner)
        looks[number]["form"] = Form.CORNER
        looks[number]["height"], looks[number]["bevel"] = 0.8 * build.wall_height, 0.01
        _set_color(looks[number], theme.apron)


def _set_paddle(look: Any, shape: Any, angle: float | None, build: Build, theme: Theme) -> None:
    if angle is None or shape["kind"] != Kind.PADDLE:
        return
    look["form"], look["side"] = Form.PADDLE, shape["side"]
    look["sine"], look["cosine"] = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    look["height"], look["bevel"] = build.paddle_height, 0.055 * build.unit
    _set_color(look, theme.paddle)


def _set_triangle(shape: Any, corners: Sequence[tuple[float, float]]) -> None:
    """A triangle as the physics keeps it, for a corner that no ball can reach."""
    shape["kind"] = Kind.TRIANGULAR_PRISM
    for number in range(3):
        (x, z), (to_x, to_z) = corners[number], corners[(number + 1) % 3]
        length = math.hypot(to_x - x, to_z - z)
        shape[f"x{number}"], shape[f"z{number}"], shape[f"length{number}"] = x, z, length
        shape[f"along_x{number}"], shape[f"along_z{number}"] = (to_x - x) / length, (to_z - z) / length


def _set_color(look: Any, color: Color) -> None:
    look["red"], look["green"], look["blue"] = linear(color)


def _stage(camera: Camera, theme: Theme) -> NDArray[Any]:
    build, frustum = camera.build, camera.frustum
    stage = records(1, STAGE)
    row = stage[0]
    for name in ("half_length", "half_width", "thickness", "rail", "rail_height", "apron_height"):
        row[name] = getattr(build, name)
    row["apron_top"], row["top"] = build.apron_top, build.top
    row["unit"] = build.unit
    for name in ("art", "frame", "exposure", "key", "fill", "lacquer", "halo", "cap_ground"):
        row[name] = getattr(theme, name)
    row["light_x"], row["light_y"] = LIGHT
    for name in frustum._fields:
        row[name] = getattr(frustum, name)
    row["pixel"] = 1.0 / camera.scale
    long, wide = 2.0 * (build.half_length + build.rail), 2.0 * (build.half_width + build.rail)
    side = max(CELL * row["unit"], max(long, wide) / MOST_CELLS)
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
    """Linear light of a colour of the screen; its gamma is taken as 2.2."""
    red, green, blue = ((value / 255.0) ** 2.2 for value in color)
    return red, green, blue
