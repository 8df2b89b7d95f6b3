"""A table as arrays for ray marching: its stage, its solids, and the grid of them.

Colours are linear light here, not the screen's values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.build_solids import Solids, linear
from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import LEVEL_RISE
from silverball.drawing.kernels.solids import list_cells
from silverball.drawing.kernels.stage import (
    CELL,
    HALO,
    INSERT,
    LIGHT,
    MANY,
    MAX_CELLS,
    NEAR,
    NEAR_IF_MANY,
    STAGE,
    Lens,
    Scene,
)
from silverball.drawing.layout import Layout
from silverball.drawing.moving import MovingPart
from silverball.drawing.text import lettering
from silverball.drawing.themes import Theme, lamp_color
from silverball.physics.records import records


class TableScene:
    """The scene of a table without its moving parts, and with some of them.

    Args:
        layout: The table.
        camera: The view of it.
        theme: Its colours.
        level: The highest level that is drawn.

    Attributes:
        scene: The scene without moving parts.
        parts: The part of each of its solids, by its path.
    """

    def __init__(self, layout: Layout, camera: Camera, theme: Theme, level: int = 0) -> None:
        self._layout, self._camera, self._theme = layout, camera, theme
        self._still = Solids(layout.board, camera.dimensions, theme)
        self._still.add_layout(layout, level)
        solids, corners, self.parts = self._still.finished()
        stage = _stage(camera, theme, level)
        stage[0]["has_lamps"] = bool(layout.inserts)
        label = lettering(layout.name, camera.dimensions)
        self.scene = _with_cells(
            Scene(stage, solids, corners, _inks(theme), EMPTY, EMPTY, label, _inserts(layout, theme))
        )

    def posed(self, poses: Iterable[tuple[MovingPart, int]]) -> Scene:
        """Return the scene with moving parts in these poses; their solids come last."""
        moving = Solids(self._layout.board, self._camera.dimensions, self._theme)
        for part, pose in poses:
            moving.add_pose(part, pose)
        solids, _, _ = moving.finished()
        solids["group"] += 1_000_000  # apart from those that stand still
        both = records(len(self.scene.solids) + len(solids), solids.dtype)
        both[: len(self.scene.solids)], both[len(self.scene.solids) :] = self.scene.solids, solids
        return _with_cells(self.scene._replace(solids=both))


EMPTY = np.zeros(0, np.int32)


def make_scene(
    layout: Layout, camera: Camera, theme: Theme, poses: Iterable[tuple[MovingPart, int]] = ()
) -> Scene:
    """Return the scene of a table's playfield, with moving parts in some poses."""
    return TableScene(layout, camera, theme).posed(poses)


def _with_cells(scene: Scene) -> Scene:
    stage = scene.stage.copy()
    unit = float(stage[0]["unit"])
    stage[0]["near"] = (NEAR if len(scene.solids) <= MANY else NEAR_IF_MANY) * unit
    return scene._replace(
        stage=stage,
        near=list_cells(stage, scene.solids, float(stage[0]["near"]), False),
        lit=list_cells(stage, scene.solids, HALO * unit, True),
    )


def _stage(camera: Camera, theme: Theme, level: int) -> NDArray[Any]:
    dimensions, frustum = camera.dimensions, camera.frustum
    stage = records(1, STAGE)
    row = stage[0]
    for name in ("half_length", "half_width", "thickness", "rail", "rail_height", "apron_height"):
        row[name] = getattr(dimensions, name)
    row["apron_top"], row["top"] = dimensions.apron_top, dimensions.top + level * LEVEL_RISE * dimensions.unit
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


def _inserts(layout: Layout, theme: Theme) -> NDArray[Any]:
    """The lenses of the lamps that lie in the playfield, one for each colour of light."""
    rows = records(len(layout.lights), INSERT)
    painted = set[int]()
    for row, light in zip(rows, layout.lights, strict=True):
        insert = layout.inserts[light.insert]
        row["is_painted"] = light.insert not in painted
        painted.add(light.insert)
        angle = math.radians(insert.angle)
        row["shape"], row["size"] = Lens[insert.shape.upper()], insert.size
        row["x"], row["z"] = insert.center
        row["sine"], row["cosine"] = math.sin(angle), math.cos(angle)
        row["red"], row["green"], row["blue"] = linear(lamp_color(theme, light.color, insert.number))
    return rows


def _inks(theme: Theme) -> NDArray[np.float64]:
    colors = (
        theme.room, *theme.floor, theme.ray, theme.glow, *theme.ornament, theme.heart, theme.rail, theme.wall,
        theme.apron, theme.label, *theme.strips, theme.paddle_edge, theme.cap, theme.steel, theme.ball,
        theme.ball_low,
    )  # fmt: skip
    return np.array([linear(color) for color in colors])
