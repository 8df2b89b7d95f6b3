"""Composing of a frame: the baked table, and on it everything that moves.

    lamps → flashes of hits → moving parts → shadows of balls → trails → balls    on the playfield,
    the translucent level, and the same again                             for each upper level
    sparks

Each layer sees what lies below it, heights included, so a ball is hidden by a raised paddle and its shadow
climbs onto an obstacle. Between two frames only the dirty rectangles of the first are restored, and those in
which lamps have changed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.bake_sprites import pose_box
from silverball.drawing.build_solids import linear
from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import LEVEL_RISE
from silverball.drawing.effects import Effects, Spot
from silverball.drawing.kernels.chrome import Sphere, cast_shadow, draw_ball
from silverball.drawing.kernels.patches import add_light, add_spots, lay_over, lay_sprite
from silverball.drawing.kernels.stage import Box
from silverball.drawing.lamp_levels import Lamps
from silverball.drawing.lamp_lights import LampLights
from silverball.drawing.layout import Layout
from silverball.drawing.moment import BallAt, Moment
from silverball.drawing.moving import MovingPart, moving_parts
from silverball.drawing.pictures import BakedTable, Sprite
from silverball.drawing.poses import pose_of
from silverball.drawing.scene import TableScene
from silverball.drawing.sketch import Pen, sketch_pose
from silverball.drawing.themes import Color, Theme, ball_tint
from silverball.table import Table

MAX_SPOTS = 64  # spots of one trail, or sparks of one hit
TRAIL_LIGHT, SPARK_LIGHT = 0.5, 1.0
SUNK = 0.4  # how deep a ball lies in a hole, in radii
UNTINTED_BALLS = 2  # tables with at most so many balls show all of them alike


class _Layer:
    """The frame of one level: what lies below it, and its own things on top.

    Attributes:
        level: Its number.
        base: Height of its floor [u].
        frame: RGB, uint8 [row, column, 3].
        height: Of what each pixel shows [u], float32 [row, column].
        surface: The frame as a surface.
    """

    def __init__(
        self,
        level: int,
        base: float,
        pixels: NDArray[np.uint8],
        height: NDArray[np.float32],
        over: Sprite | None,
    ) -> None:
        self.level, self.base = level, base
        self.over = over
        rows, columns = height.shape
        self._bytes = bytearray(pixels.tobytes())
        self.frame = np.frombuffer(self._bytes, np.uint8).reshape(pixels.shape)
        self.rows = self.frame.reshape(rows, 3 * columns)
        if over is not None:
            height = height.copy()
            at = _within((over.left, over.top, *_end(over)))
            height[at] = np.where(over.height >= 0.0, over.height, height[at])
        self._still = height
        self.height = height.copy()
        self.raised: list[Box] = []  # dirty rectangles of heights, which only moving parts change
        self.surface = pygame.image.frombuffer(self._bytes, (columns, rows), "RGB")

    def lower(self) -> None:
        """Restore the heights that the last frame changed."""
        for box in self.raised:
            at = _within(box)
            self.height[at] = self._still[at]
        self.raised.clear()


class Composer:
    """Draws moments of one table in full quality.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        baked: The playfield without moving parts.
        levels: The upper levels, by their numbers.
        sprite: Returns the sprite of a moving part in a pose, or None while it is not baked.
    """

    def __init__(
        self,
        table: Table,
        camera: Camera,
        theme: Theme,
        baked: BakedTable,
        levels: Mapping[int, Sprite],
        sprite: Callable[[int, int], Sprite | None],
    ) -> None:
        self._camera = camera
        self._theme = theme
        self._baked = baked
        self._sprite = sprite
        layout = Layout.of(table)
        self._layout = layout
        self._parts = moving_parts(layout)
        self._is_tinted = table.board.max_balls > UNTINTED_BALLS
        scene = TableScene(layout._replace(rows=()), camera, theme).scene
        self._stage, self._inks = scene.stage, scene.inks
        self._lamps, self._lights = Lamps(layout), LampLights(baked)
        self._layers = [_Layer(0, 0.0, baked.pixels, baked.height, None)]
        for number, over in sorted(levels.items()):
            base = number * LEVEL_RISE * camera.dimensions.unit
            below = self._layers[-1]
            layer = _Layer(number, base, below.frame, below.height, over)
            lay_over(below.frame, layer.frame, over.left, over.top, over.remaining, over.added, _all(over))
            self._layers.append(layer)
        self._parts_on = [
            [(index, part) for index, part in enumerate(self._parts) if self._layer_of(part.level) is layer]
            for layer in self._layers
        ]
        self._changed: list[Box] = []  # dirty rectangles of colours
        self._spots = np.zeros((MAX_SPOTS, 7))
        self._before = np.zeros((1, 1, 3), np.uint8)
        self.surface = self._layers[-1].surface

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""
        stale = [*self._changed, *self._lights.update(self._lamps.light_levels(moment, effects))]
        self._changed = []
        lowest = self._layers[0]
        for box in stale:
            at = _within(box)
            lowest.frame[at] = self._lights.pixels[at]
        for name, strength in effects.flashes(moment.time):
            self._light_up(name, strength)
        balls = [*moment.balls, *effects.sinking_balls(moment.time)]
        trails = dict(effects.trails(moment))
        for number, layer in enumerate(self._layers):
            layer.lower()
            if number:
                self._lay_level(self._layers[number - 1], layer, [*stale, *self._changed])
            for index, part in self._parts_on[number]:
                self._lay_part(layer, index, part, moment, effects)
            here = [ball for ball in balls if self._layer_of(ball.level) is layer]
            for ball in here:
                self._shade(layer, ball)
            for ball in here:
                self._add_spots(layer, trails.get(ball.id, ()), self._theme.trail, TRAIL_LIGHT)
            for ball in sorted(here, key=lambda ball: -ball.x):  # the far one first
                self._draw_ball(layer, ball)
        for sparks in effects.sparks(moment.time):
            self._add_spots(self._layers[-1], sparks, self._theme.spark, SPARK_LIGHT)
        return self.surface

    def _layer_of(self, level: int) -> _Layer:
        """Return the layer of a level; that of the highest level below it if nothing is on it."""
        return max((layer for layer in self._layers if layer.level <= level), key=lambda layer: layer.level)

    def _light_up(self, part: str, strength: float) -> None:
        for flash in self._baked.flashes.get(part, ()):
            rows, columns = flash.pixels.shape[:2]
            flat = flash.pixels.reshape(rows, 3 * columns)
            add_light(self._layers[0].rows, flash.left, flash.top, flat, round(256 * strength))
            self._changed.append((flash.left, flash.top, flash.left + columns, flash.top + rows))

    def _lay_level(self, below: _Layer, layer: _Layer, boxes: Sequence[Box]) -> None:
        """Copy rectangles from the layer below, and blend the level over them."""
        over = layer.over
        assert over is not None
        for box in boxes:
            at = _within(box)
            layer.frame[at] = below.frame[at]
            # Read from the layer below, so that rectangles may overlap.
            lay_over(below.frame, layer.frame, over.left, over.top, over.remaining, over.added, box)

    def _lay_part(
        self, layer: _Layer, index: int, part: MovingPart, moment: Moment, effects: Effects
    ) -> None:
        pose = pose_of(part, moment, effects, self._camera.dimensions.ball)
        if pose is None:
            return
        sprite = self._sprite(index, pose)
        if sprite is None:
            self._changed.append(pose_box(self._camera, part, pose))
            sketch_pose(Pen(layer.surface, self._camera), part, pose, self._theme)
            return
        lay_sprite(layer.frame, layer.height, *sprite)
        box = (sprite.left, sprite.top, *_end(sprite))
        self._changed.append(box)
        layer.raised.append(box)

    def _sphere(self, layer: _Layer, ball: BallAt) -> Sphere:
        """Return a ball as the kernels take it."""
        r = self._camera.dimensions.ball
        y = layer.base + (-SUNK * r if self._layout.is_hole(ball.holder) else r)
        tint = linear(ball_tint(ball.id)) if self._is_tinted and ball.id else (1.0, 1.0, 1.0)
        return Sphere(ball.x, y, ball.z, r, layer.base, tint)

    def _shade(self, layer: _Layer, ball: BallAt) -> None:
        r = self._camera.dimensions.ball
        if self._layout.is_hole(ball.holder):
            return
        shift = layer.base * SHADOW_SHIFT
        box = self._camera.box(
            ball.x - shift - 2.8 * r, ball.x + 2.2 * r, ball.z - 2.2 * r, ball.z + 2.2 * r, 0.0,
            layer.base + 2.0 * r,
        )  # fmt: skip
        cast_shadow(layer.frame, layer.height, self._stage, self._sphere(layer, ball), box)
        self._changed.append(box)

    def _draw_ball(self, layer: _Layer, ball: BallAt) -> None:
        r = self._camera.dimensions.ball
        sphere = self._sphere(layer, ball)
        low = max(sphere.y - r, layer.base)
        box = self._camera.box(ball.x - r, ball.x + r, ball.z - r, ball.z + r, low, sphere.y + r)
        rows, columns = box[3] - box[1], box[2] - box[0]
        if rows > self._before.shape[0] or columns > self._before.shape[1]:
            self._before = np.zeros((rows + 4, columns + 4, 3), np.uint8)
        draw_ball(layer.frame, layer.height, self._before, self._stage, self._inks, sphere, box)
        self._changed.append(box)

    def _add_spots(self, layer: _Layer, spots: Sequence[Spot], color: Color, light: float) -> None:
        if not spots:
            return
        count = min(len(spots), MAX_SPOTS)
        for row, spot in zip(self._spots, spots, strict=False):
            shine = light * spot.strength
            row[:] = (spot.x, spot.y + layer.base, spot.z, spot.radius, *(shine * value for value in color))
        self._changed.append(add_spots(layer.frame, layer.height, self._stage, self._spots, count))


SHADOW_SHIFT = 1.2  # how far a shadow moves down the table, by the height of what casts it


def _end(sprite: Sprite) -> tuple[int, int]:
    """Return the column and the row after the last ones of a sprite."""
    rows, columns = sprite.remaining.shape
    return sprite.left + columns, sprite.top + rows


def _all(sprite: Sprite) -> Box:
    return sprite.left, sprite.top, *_end(sprite)


def _within(box: Box) -> tuple[slice, slice]:
    """Return the slices of a box, without what lies beyond the frame's left and upper edge."""
    left, top, right, bottom = box
    return slice(max(top, 0), max(bottom, 0)), slice(max(left, 0), max(right, 0))
