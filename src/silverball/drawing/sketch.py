"""A sketch of a table in flat colours, drawn within a tenth of a second and shown until the table is baked.

It uses the same camera and heights as the baked picture, and needs pygame and NumPy only, no compiled code.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import groupby, pairwise

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.dimensions import LEVEL_RISE, corner_behind
from silverball.drawing.effects import Effects
from silverball.drawing.kernels.stage import EMBLEM_AT, EMBLEM_SIZE, RAYS, RING_AT, Art, Material
from silverball.drawing.lamp_levels import Lamps
from silverball.drawing.layout import OF_THE_MODE, Insert, Layout
from silverball.drawing.looks import LOOKS
from silverball.drawing.moment import BallAt, Moment
from silverball.drawing.moving import PULL, Motion, MovingPart, is_moving, moving_parts, pose_angle, turned
from silverball.drawing.poses import pose_of
from silverball.drawing.themes import Color, Theme, lamp_color, role_color
from silverball.physics.forms import Shape
from silverball.table import Table
from silverball.table.outlines import closed_outline, path
from silverball.table.primitive import Point, Primitive

SUPERSAMPLE = 2  # antialiasing: the picture is drawn larger by this factor and scaled down
MAX_SUPERSAMPLED_PIXELS = 2_000_000  # larger pictures are not supersampled
FARTHEST = math.inf  # what is drawn first
LEVEL_ORDER, FLAT_ORDER = 1000.0, 500.0  # [u] more than any x: levels come last, what lies flat comes first
FLAT = 0.1  # [u] what is lower lies in the playfield
CIRCLE = 28  # corners of a circle
LINE: Color = (6, 6, 10)  # around the lens of a lamp


def sketch(table: Table, camera: Camera, theme: Theme) -> NDArray[np.uint8]:
    """The table without paddles and balls: RGB, uint8 [row, column, 3]."""
    width, height = camera.size
    enlarged = SUPERSAMPLE if width * height <= MAX_SUPERSAMPLED_PIXELS else 1
    surface = pygame.Surface((max(width * enlarged, 1), max(height * enlarged, 1)), 0, 24)
    surface.fill(theme.room)
    pen = Pen(surface, camera, enlarged)
    _floor(pen, table, theme)
    _emblem(pen, table, theme)
    _rails(pen, theme)
    layout = Layout.of(table)
    for insert in layout.inserts:
        sketch_lamp(pen, insert, 0.0, theme)
    for _, draw in sorted(_parts(pen, layout, theme), key=lambda part: -part[0]):  # the far ones first
        draw()
    _apron(pen, theme)
    small = pygame.transform.smoothscale(surface, camera.size) if enlarged > 1 else surface
    pixels = np.frombuffer(pygame.image.tobytes(small, "RGB"), np.uint8)
    return pixels.reshape(height, width, 3)


class Pen:
    """Draws raised shapes onto a surface.

    Args:
        surface: The target.
        camera: The view of the board.
        enlarged: Ratio of the surface's size to the camera's picture size.
    """

    def __init__(self, surface: pygame.Surface, camera: Camera, enlarged: int = 1) -> None:
        self.surface = surface
        self.camera = camera
        self.enlarged = enlarged

    def face(self, points: Iterable[tuple[float, float, float]], color: Color) -> None:
        """Draw a flat face with corners (x, z, y) [u]."""
        places = []
        for x, z, y in points:
            across, down = self.camera.to_pixel(x, z, y)
            places.append((across * self.enlarged, down * self.enlarged))
        pygame.draw.polygon(self.surface, color, places)

    def block(self, corners: Sequence[Point], height: float, top: Color, low: float = 0.0) -> None:
        """Draw a counter-clockwise footprint extruded to a height, without its hidden sides."""
        for (x0, z0), (x1, z1) in zip(corners, (*corners[1:], corners[0]), strict=True):
            outward = z0 - z1  # x of the outward normal of a counter-clockwise outline
            if outward < 0.0:
                length = max(math.hypot(x1 - x0, z1 - z0), 1e-9)
                face = [(x0, z0, low), (x1, z1, low), (x1, z1, height), (x0, z0, height)]
                self.face(face, dim(top, 0.35 + 0.2 * (-outward / length)))
        self.face([(x, z, height) for x, z in corners], top)


def sketch_pose(pen: Pen, part: MovingPart, pose: int, theme: Theme) -> None:
    """Draw a moving part in one of its poses."""
    primitive, unit = part.primitive, pen.camera.dimensions.unit
    look = LOOKS[primitive.finish]
    base, color = part.level * LEVEL_RISE * unit, role_color(theme, look.role, part.number)
    top = base + look.height * unit
    if part.motion is Motion.TURNING:
        corners = turned(primitive, pose_angle(part, pose))
        if primitive.shape == Shape.TAPERED:
            corners = hull_of_circles(corners, primitive)
        pen.block(corners, top, color, base)
    elif part.motion is Motion.SPINNING:
        (x0, z0), (x1, z1) = primitive.points
        high = 0.3 * unit * abs(math.cos(math.pi * pose / part.poses))
        axis = base + 0.42 * unit
        low, up = axis - high, axis + high + 0.02 * unit
        pen.face([(x0, z0, low), (x1, z1, low), (x1, z1, up), (x0, z0, up)], color)
    elif primitive.launch is not None:
        (x, z), (to_x, to_z) = primitive.points[0], primitive.launch.direction
        near = pen.camera.dimensions.ball + PULL * unit * pose / (part.poses - 1)
        far = near + 1.4 * unit
        top_end, low_end = (x - near * to_x, z - near * to_z), (x - far * to_x, z - far * to_z)
        pen.block(bar(top_end, low_end, 0.1 * unit), top, color, base)
    elif part.motion is not Motion.HANGING or pose == 0:
        start, end = primitive.points
        pen.block(bar(start, end, primitive.radius), top, color, base)


def sketch_ball(pen: Pen, ball: BallAt, is_sunk: bool = False) -> None:
    """Draw a ball with its shadow; one in a hole has none."""
    radius = pen.camera.dimensions.ball
    x, z, base = ball.x, ball.z, ball.level * LEVEL_RISE * pen.camera.dimensions.unit
    if not is_sunk:
        pen.face(circle(x - 0.5 * radius - base, z, radius, 0.0), (8, 8, 14))
    across, down = pen.camera.to_pixel(x, z, base if is_sunk else base + radius)
    size = max(radius * pen.camera.scale * pen.enlarged, 1.0)
    place = (across * pen.enlarged, down * pen.enlarged)
    for share, color in ((1.0, (120, 128, 150)), (0.86, (196, 202, 220)), (0.5, (250, 250, 255))):
        shift = 0.25 * size * (1.0 - share)
        pygame.draw.circle(pen.surface, color, (place[0], place[1] - shift), share * size)


def sketch_lamp(pen: Pen, insert: Insert, level: float, theme: Theme) -> None:
    """Draw the lens of a lamp, from 0 (dark glass) to 1 (fully lit)."""
    color = lamp_color(theme, insert.color, insert.number)
    red, green, blue = (round(0.5 * value + 127.0) for value in color)
    core = dim((red, green, blue), level) if level > 0.5 else dim(color, 0.35 + 0.4 * level)
    for size, tone in ((1.15, LINE), (1.0, dim(color, 0.25 + 0.75 * level)), (0.5, core)):
        pen.face([(x, z, 0.0) for x, z in lens_outline(insert, size)], tone)


LENSES: dict[str, tuple[Point, ...]] = {
    "square": ((0.7, 0.7), (-0.7, 0.7), (-0.7, -0.7), (0.7, -0.7)),
    "bar": ((0.92, 0.36), (-0.92, 0.36), (-0.92, -0.36), (0.92, -0.36)),
    "triangle": ((1.0, 0.0), (-0.5, 0.866), (-0.5, -0.866)),
    "arrow": (
        (1.0, 0.0), (0.05, 0.75), (0.05, 0.3), (-0.95, 0.3), (-0.95, -0.3), (0.05, -0.3), (0.05, -0.75),
    ),
    "star": tuple(
        (reach * math.cos(math.pi * number / 5), reach * math.sin(math.pi * number / 5))
        for number in range(10)
        for reach in ((1.0, 0.48)[number % 2],)
    ),
}  # fmt: skip
"""Corners of the lenses of lamps, along and across where they point, as in `kernels/inserts.py`."""


def lens_outline(insert: Insert, share: float = 1.0) -> list[Point]:
    """Return the outline (x, z) of a lamp's lens, or of a smaller one in its middle."""
    (x, z), size = insert.center, share * insert.size
    if insert.shape == "round":
        return [(px, pz) for px, pz, _ in circle(x, z, size, 0.0)]
    sine, cosine = math.sin(math.radians(insert.angle)), math.cos(math.radians(insert.angle))
    return [
        (x + size * (along * sine - across * cosine), z + size * (along * cosine + across * sine))
        for along, across in LENSES[insert.shape]
    ]


def dim(color: Color, share: float) -> Color:
    """Return a darker (or, above 1, lighter) colour."""
    red, green, blue = (min(round(share * value), 255) for value in color)
    return red, green, blue


def circle(x: float, z: float, radius: float, y: float) -> list[tuple[float, float, float]]:
    """Return the corners (x, z, y) of a circle, counter-clockwise."""
    turns = [2.0 * math.pi * number / CIRCLE for number in range(CIRCLE)]
    return [(x + radius * math.sin(turn), z + radius * math.cos(turn), y) for turn in turns]


def _floor(pen: Pen, table: Table, theme: Theme) -> None:
    """Draw the floor with its rays, computed for every second pixel."""
    camera, dimensions = pen.camera, pen.camera.dimensions
    width, height = max(camera.size[0] // 2, 1), max(camera.size[1] // 2, 1)
    f = camera.frustum
    u = ((np.arange(width, dtype=np.float32) + 0.5) * camera.size[0] / width - f.across) / f.focal
    v = (f.down - (np.arange(height, dtype=np.float32) + 0.5) * camera.size[1] / height) / f.focal
    t = -f.eye_y / np.minimum(v * f.sine - f.cosine, -1e-3)
    x = (f.eye_x + t * (f.sine + v * f.cosine))[:, None]
    z = t[:, None] * u[None, :]
    stops = np.array([-dimensions.half_length, 0.0, dimensions.half_length], np.float32)
    paint = np.stack(
        [np.interp(x[:, 0], stops, [color[channel] for color in theme.floor]) for channel in range(3)], axis=1
    )[:, None, :]
    from_x = x - np.float32(EMBLEM_AT * table.board.length)
    rho = np.hypot(from_x, z) / np.float32(1.1 * dimensions.half_length)
    ray = np.clip(0.5 + 4.0 * np.cos(RAYS * np.arctan2(z, from_x)), 0.0, 1.0)
    strength = 0.8 * ray if theme.art is Art.WOOD else (0.5 * np.exp(-1.6 * rho * rho) + 0.1) * ray
    picture = paint + (np.array(theme.ray, np.float32) - paint) * strength[:, :, None]
    inside = (np.abs(x) < dimensions.half_length) & (np.abs(z) < dimensions.half_width)
    picture = np.where(inside[:, :, None], picture, np.array(theme.room, np.float32))
    small = pygame.image.frombuffer(picture.clip(0, 255).astype(np.uint8).tobytes(), (width, height), "RGB")
    pen.surface.blit(pygame.transform.smoothscale(small, pen.surface.get_size()), (0, 0))


def _emblem(pen: Pen, table: Table, theme: Theme) -> None:
    """Draw the star where the rays meet, in its ring."""
    dimensions = pen.camera.dimensions
    size, x = (
        EMBLEM_SIZE * min(2.0 * dimensions.half_width, dimensions.half_length),
        EMBLEM_AT * table.board.length,
    )
    for share, color in ((1.34, theme.ornament[0]), (1.27, dim(theme.floor[1], 0.5))):
        pen.face(circle(x, 0.0, share * size, 0.0), color)
    star = []
    for number in range(10):
        reach, turn = (0.98 if number % 2 == 0 else 0.46) * size, math.radians(36.0 * number)
        star.append((x + reach * math.cos(turn), reach * math.sin(turn), 0.0))
    pen.face(star, theme.heart)


def _rails(pen: Pen, theme: Theme) -> None:
    """Draw the frame, from the far end to the near one."""
    dimensions = pen.camera.dimensions
    long, wide, high = (
        dimensions.half_length + dimensions.rail,
        dimensions.half_width + dimensions.rail,
        dimensions.rail_height,
    )
    top, side = dimensions.half_length - dimensions.thickness, dimensions.half_width - dimensions.thickness
    bottom, foot = -dimensions.half_length, -dimensions.skirt
    inner, outer = dim(theme.rail, 0.35), dim(theme.rail, 0.5)
    pen.face([(top, -side, 0.0), (top, side, 0.0), (top, side, high), (top, -side, high)], inner)
    for sign in (-1.0, 1.0):
        z = sign * side
        pen.face([(top, z, 0.0), (bottom, z, 0.0), (bottom, z, high), (top, z, high)], dim(inner, 0.8))
        pen.face(
            [(long, sign * wide, high), (-long, sign * wide, high), (-long, z, high), (long, z, high)],
            theme.rail,
        )
    pen.face([(long, -wide, high), (long, wide, high), (top, wide, high), (top, -wide, high)], theme.rail)
    pen.face([(-long, -wide, foot), (-long, wide, foot), (-long, wide, high), (-long, -wide, high)], outer)


def _apron(pen: Pen, theme: Theme) -> None:
    dimensions = pen.camera.dimensions
    long, wide, high = (
        dimensions.half_length + dimensions.rail,
        dimensions.half_width + dimensions.rail,
        dimensions.rail_height,
    )
    side = dimensions.half_width - dimensions.thickness
    plate = [(-dimensions.half_length, -side), (-dimensions.half_length, side), (dimensions.apron_top, side)]
    pen.block([*plate, (dimensions.apron_top, -side)], dimensions.apron_height, theme.apron)
    near = -dimensions.half_length
    pen.face([(near, -wide, high), (near, wide, high), (-long, wide, high), (-long, -wide, high)], theme.rail)


def _parts(pen: Pen, layout: Layout, theme: Theme) -> Iterator[tuple[float, Callable[[], None]]]:
    """Yield for each primitive an order, by its level and its x [u], and a function that draws it."""
    dimensions, counts = pen.camera.dimensions, dict[str, int]()
    for _, rows in groupby(layout.rows, key=lambda row: row.part):
        primitives = tuple(row.primitive for row in rows)
        look = LOOKS[primitives[0].finish]
        counts[look.role] = counts.get(look.role, -1) + 1
        level = min(primitives[0].levels)
        base = level * LEVEL_RISE * dimensions.unit
        outline = closed_outline(primitives)
        if outline is not None:
            fill = role_color(theme, look.fill.role, counts[look.role])
            height = base + (look.height - look.fill.drop) * dimensions.unit
            middle = 0.5 * (min(x for x, _ in outline) + max(x for x, _ in outline))
            yield (
                middle - LEVEL_ORDER * level,
                partial(pen.block, counter_clockwise(outline), height, fill, base),
            )
        for primitive in primitives:
            if is_moving(primitive):
                continue
            color = role_color(theme, LOOKS[primitive.finish].role, counts[look.role])
            xs = [x for x, _ in primitive.points]
            order = 0.5 * (min(xs) + max(xs)) - LEVEL_ORDER * level
            if LOOKS[primitive.finish].height < FLAT:
                order += FLAT_ORDER
            yield order, partial(_primitive, pen, primitive, color, theme, base)
            corner = _corner_behind(layout, primitive)
            if corner is not None:
                yield (
                    FARTHEST,
                    partial(pen.block, corner, 0.8 * dimensions.wall_height, dim(theme.apron, 0.8)),
                )


def _primitive(pen: Pen, primitive: Primitive, color: Color, theme: Theme, base: float) -> None:
    """Draw a primitive that does not move."""
    look, unit = LOOKS[primitive.finish], pen.camera.dimensions.unit
    top = base + look.height * unit
    if look.material is Material.BUMPER:
        (x, z), radius = primitive.points[0], primitive.radius
        _bumper(pen, x, z, radius, color, theme)
    elif primitive.shape in (Shape.CIRCLE, Shape.DISC):
        (x, z), radius = primitive.points[0], primitive.radius
        corners = [(px, pz) for px, pz, _ in circle(x, z, radius, 0.0)]
        if look.material is Material.PIT:
            pen.face([(px, pz, top) for px, pz in corners], theme.steel)
            corners = [(px, pz) for px, pz, _ in circle(x, z, 0.8 * radius, 0.0)]
        pen.block(corners, top, color, base)
    elif primitive.shape == Shape.TRIANGLE:
        pen.block(primitive.points, top, color, base)
    else:
        width = 0.05 * unit if primitive.shape == Shape.LINE else primitive.radius
        points = path(primitive)
        for start, end in pairwise(points):
            if start != end:
                pen.block(bar(start, end, width), top, color, base)


def _corner_behind(layout: Layout, primitive: Primitive) -> tuple[Point, Point, Point] | None:
    if primitive.shape != Shape.CAPSULE or not LOOKS[primitive.finish].has_tube:
        return None
    start, end = primitive.points
    return corner_behind(layout.board, start, end)


def _bumper(pen: Pen, x: float, z: float, radius: float, color: Color, theme: Theme) -> None:
    dimensions = pen.camera.dimensions
    unit = dimensions.unit
    pen.face(circle(x, z, radius + (RING_AT + 0.03) * unit, 0.0), color)
    pen.face(circle(x, z, radius + (RING_AT - 0.03) * unit, 0.0), dim(color, 0.3))
    corners = [(px, pz) for px, pz, _ in circle(x, z, radius, 0.0)]
    pen.block(corners, dimensions.body_height, dim(theme.steel, 0.85))
    cap = 0.9 * radius
    for share, tone in ((1.0, dim(color, 0.8)), (0.85, color), (0.22, theme.cap)):
        rise = min(0.42 * cap, 0.45 * unit) * (1.0 - share * share)
        pen.face(circle(x, z, share * cap, dimensions.body_height + rise), tone)


def bar(start: Point, end: Point, radius: float) -> list[Point]:
    """Return the outline of a segment with round ends, counter-clockwise."""
    (x0, z0), (x1, z1) = start, end
    direction = math.atan2(x1 - x0, z1 - z0)
    thick = max(radius, 0.02)
    outline = []
    for (x, z), first in (((x1, z1), direction - 0.5 * math.pi), ((x0, z0), direction + 0.5 * math.pi)):
        for step in range(7):
            turn = first + step * math.pi / 6.0
            outline.append((x + thick * math.sin(turn), z + thick * math.cos(turn)))
    return outline


def hull_of_circles(middles: Sequence[Point], primitive: Primitive) -> list[Point]:
    """Return the outline of a tapered paddle whose pivot and tip are at two places, counter-clockwise."""
    assert primitive.mover is not None
    pivot, tip = middles if primitive.mover.direction > 0.0 else (middles[1], middles[0])
    direction = math.atan2(tip[0] - pivot[0], tip[1] - pivot[1])
    half = 0.5 * math.pi - math.asin((primitive.radius - primitive.tip_radius) / math.dist(pivot, tip))
    outline = []
    for (x, z), radius, first, turn in (
        (tip, primitive.tip_radius, direction - half, 2.0 * half),
        (pivot, primitive.radius, direction + half, 2.0 * (math.pi - half)),
    ):
        for step in range(9):
            angle = first + turn * step / 8.0
            outline.append((x + radius * math.sin(angle), z + radius * math.cos(angle)))
    return outline


def counter_clockwise(corners: Sequence[Point]) -> list[Point]:
    """Return the corners of a polygon in counter-clockwise order."""
    pairs = zip(corners, (*corners[1:], corners[0]), strict=True)
    area = sum(z0 * x1 - z1 * x0 for (x0, z0), (x1, z1) in pairs)
    return list(corners) if area > 0.0 else list(reversed(corners))


class SketchPainter:
    """Draws moments in sketch quality, without compiled code.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        pixels: The baked table if it is cached, RGB [row, column, 3]; else a sketch is drawn.
    """

    def __init__(
        self, table: Table, camera: Camera, theme: Theme, pixels: NDArray[np.uint8] | None = None
    ) -> None:
        self._layout = Layout.of(table)
        self._parts = moving_parts(self._layout)
        self._lamps = Lamps(self._layout)
        self._theme = theme
        if pixels is None:
            pixels = sketch(table, camera, theme)
        self._baked = pygame.image.frombuffer(pixels.tobytes(), camera.size, "RGB")
        self._surface = rgb_surface(camera.size)
        self._pen = Pen(self._surface, camera)

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""
        self._surface.blit(self._baked, (0, 0))
        for _ in effects.trails(moment):
            pass  # advances the trails, so that they are complete when the baked picture takes over
        for insert, level in zip(self._layout.inserts, self._lamps.levels(moment, effects), strict=True):
            if level > 0.0:
                color = moment.color if insert.color == OF_THE_MODE else insert.color
                sketch_lamp(self._pen, insert._replace(color=color), float(level), self._theme)
        for ball in (*moment.balls, *effects.sinking_balls(moment.time)):
            sketch_ball(self._pen, ball, self._layout.is_hole(ball.holder))
        for part in self._parts:
            pose = pose_of(part, moment, effects, self._pen.camera.dimensions.ball)
            if pose is not None:
                sketch_pose(self._pen, part, pose, self._theme)
        return self._surface


def rgb_surface(size: tuple[int, int]) -> pygame.Surface:
    """Return a surface of 24 bits whose bytes are RGB; it needs no display."""
    return pygame.image.frombuffer(bytearray(3 * size[0] * size[1]), size, "RGB")


def ball_icon(side: int) -> pygame.Surface:
    """Return the program's icon, a polished ball on a transparent square of a side [pixel]."""
    middle, radius = 0.5 * side, 0.46 * side
    offset = (np.arange(side) + 0.5 - middle) / radius
    right, down = offset[:, None], offset[None, :]  # surfarray: columns first
    square = right**2 + down**2
    out = np.sqrt(np.clip(1.0 - square, 0.0, 1.0))
    up = -down
    # The ball mirrors the sky above, a dark horizon, a bright floor, and the lamp.
    mirrored = 2.0 * out * up  # height of the mirrored direction
    gray = np.where(
        mirrored > 0.05, 0.55 + 0.45 * np.clip(mirrored, 0.0, 1.0), 0.18 + 0.32 * np.clip(-mirrored, 0.0, 1.0)
    )
    gray = gray * (0.45 + 0.55 * np.sqrt(out))
    glint = np.clip(1.0 - ((right + 0.30) ** 2 + (down + 0.38) ** 2) / 0.06, 0.0, 1.0)
    gray = np.clip(gray + glint, 0.0, 1.0)
    image = pygame.Surface((side, side), pygame.SRCALPHA)
    colors, alpha = pygame.surfarray.pixels3d(image), pygame.surfarray.pixels_alpha(image)
    colors[:] = np.round(255.0 * gray[:, :, None] * np.array([0.96, 0.98, 1.0]))
    alpha[:] = np.round(255.0 * np.clip((1.0 - np.sqrt(square)) * radius + 0.5, 0.0, 1.0))
    del colors, alpha
    return image
