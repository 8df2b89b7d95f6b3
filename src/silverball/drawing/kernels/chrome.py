"""The ball, a chrome sphere that mirrors the frame around it, and its shadow.

The ray through a pixel meets the sphere of centre c and radius r where it is nearest to c within r:

    b = d·(c − e),   q² = |c − e|² − b²,   the ball is met at b − √(r² − q²)   (e the eye, d the direction)

A mirrored ray that goes down is looked up in the frame, so a ball shows the table, the flashes and the other
ball; one that goes up meets a bright room.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from silverball.drawing.kernels.patches import pixel_ray
from silverball.drawing.kernels.stage import Box, Heights, Ink, Inks, Pixels, Records, StageRecord, Vector
from silverball.drawing.kernels.tones import RGB, add_scaled, clamp01, ink, mix, multiply, scale, smoothstep
from silverball.physics.kernel import inlined, internal, kernel

SHADOW = 0.72  # share of the light that a ball blocks at most
CONTACT = 0.85  # the same where it lies on the playfield
CONTACT_REACH = 2.2  # how far that is visible, in radii of the ball


class Sphere(NamedTuple):
    """A ball.

    Attributes:
        x: Its centre [u].
        y: Height of its centre [u].
        z: Its centre [u].
        radius: Its radius [u].
        floor: Height of the floor [u]; what is below it, in a hole, is hidden.
        tint: Factors of the light that it mirrors.
    """

    x: float
    y: float
    z: float
    radius: float
    floor: float
    tint: RGB


@kernel
def cast_shadow(frame: Pixels, height: Heights, stage: Records, ball: Sphere, box: Box) -> None:
    """Darken what a ball shades; its shadow climbs onto raised parts.

    The ray from a point to the lamp passes the ball's centre at distance q after a path t; the edge of the
    shadow is softer the farther away the ball is. Under the ball the ambient light is blocked too:
    a sphere covers (n·u)·r²/d² of the sky, d its distance and u its direction.
    Source: I. Quilez, "sphere ambient occlusion" and "sphere soft shadow", 2006 and 2014.
    """
    s = stage[0]
    x, middle, z, r = ball.x, ball.y, ball.z, ball.radius
    left, top, right, bottom = box
    for row in range(max(top, 0), min(bottom, frame.shape[0])):
        for column in range(max(left, 0), min(right, frame.shape[1])):
            dx, dy, dz, _length = pixel_ray(s, column, row)
            y = float(height[row, column])
            t = (y - s.eye_y) / dy
            ox, oy, oz = x - (s.eye_x + t * dx), middle - y, z - t * dz
            square = ox * ox + oy * oy + oz * oz
            along = ox * s.light_x + oy * s.light_y
            stay = 1.0
            if along > 0.0:
                q = sqrt(max(square - along * along, 0.0)) - r
                soft = 0.10 * r + 0.20 * along
                stay -= SHADOW * (1.0 - smoothstep(-soft, soft, q))
            fade = 1.0 - (ox * ox + oz * oz) / (CONTACT_REACH * r) ** 2
            if oy > 0.0 and fade > 0.0:
                stay *= 1.0 - CONTACT * fade * min(oy * r * r / (square * sqrt(square)), 1.0)
            if stay < 0.999:
                for channel in range(3):
                    frame[row, column, channel] = int(frame[row, column, channel] * stay)


@kernel
def draw_ball(
    frame: Pixels,
    height: Heights,
    before: Pixels,
    stage: Records,
    inks: Inks,
    ball: Sphere,
    box: Box,
) -> None:
    """Draw a ball.

    Args:
        frame: RGB.
        height: Of what each pixel shows [u].
        before: A buffer for a copy of the box that the ball covers.
        stage: The camera, a STAGE record.
        inks: The colours of the scene.
        ball: The ball.
        box: The pixels that it can cover.
    """
    s = stage[0]
    x, middle, z, r = ball.x, ball.y, ball.z, ball.radius
    left, top = max(box[0], 0), max(box[1], 0)
    right, bottom = min(box[2], frame.shape[1]), min(box[3], frame.shape[0])
    for row in range(top, bottom):
        for column in range(left, right):
            for channel in range(3):
                before[row - top, column - left, channel] = frame[row, column, channel]
    ex, ey, ez = x - s.eye_x, middle - s.eye_y, z
    square = ex * ex + ey * ey + ez * ez
    for row in range(top, bottom):
        for column in range(left, right):
            dx, dy, dz, length = pixel_ray(s, column, row)
            b = dx * ex + dy * ey + dz * ez
            q2 = max(square - b * b, 0.0)
            q = sqrt(q2)
            part = clamp01(0.5 + (r - q) * s.focal / (b / length))  # of the pixel that the ball covers
            if part <= 0.0:
                continue
            t = b - sqrt(max(r * r - q2, 0.0))
            if (height[row, column] - s.eye_y) / dy < t - 0.02 * r:
                continue  # hidden by something in front of it
            nx, ny, nz = dx * t - ex, dy * t - ey, dz * t - ez
            if middle + ny < ball.floor:
                continue
            inverse = 1.0 / sqrt(nx * nx + ny * ny + nz * nz)
            nx, ny, nz = nx * inverse, ny * inverse, nz * inverse
            direction, normal = (dx, dy, dz), (nx, ny, nz)
            light = _reflection(frame, before, s, inks, ball, direction, normal, (left, top, right, bottom))
            light = multiply(light, ball.tint)
            for channel in range(3):
                shown = 255.0 * sqrt(clamp01(light[channel]))
                old = float(frame[row, column, channel])
                frame[row, column, channel] = int(old + part * (shown - old) + 0.5)


@internal
def _reflection(
    frame: Pixels, before: Pixels, s: StageRecord, inks: Inks, ball: Sphere,
    direction: Vector, normal: Vector, box: Box,
) -> RGB:  # fmt: skip
    """The light that a ball mirrors at a normal, seen along a direction (two unit vectors)."""
    x, z, r = ball.x, ball.z, ball.radius
    dx, dy, dz = direction
    nx, ny, nz = normal
    toward = -(dx * nx + dy * ny + dz * nz)
    rx, ry, rz = dx + 2.0 * toward * nx, dy + 2.0 * toward * ny, dz + 2.0 * toward * nz
    room = _room_light(inks, rx, max(ry, 0.0), rz)
    light = room
    if ry < 0.05:
        # Down to the playfield; flat rays end at the rails.
        py = r + r * ny
        t = min(py / max(-ry, 0.02), 5.0 * r / 0.25)
        at_x = min(max(x + r * nx + t * rx, -s.half_length), s.half_length - s.thickness)
        at_z = min(max(z + r * nz + t * rz, s.thickness - s.half_width), s.half_width - s.thickness)
        spread = 1 + int(0.05 * t / s.pixel)
        table = _frame_light(frame, before, s, at_x, at_z, spread, box)
        # Close to the point it lies on, the ball mirrors its own shadow.
        table = add_scaled(
            scale(table, 0.30 + 1.10 * smoothstep(0.0, 1.1 * r, t)), ink(inks, Ink.SKY_LOW), 0.05
        )
        light = mix(table, room, smoothstep(-0.12, 0.05, ry))
    glint = nx * s.light_x + ny * s.light_y  # the lamp itself
    spot = smoothstep(0.90, 0.99, rx * s.light_x + ry * s.light_y)
    light = add_scaled(light, ink(inks, Ink.SKY), 1.6 * spot + 0.10 * max(glint, 0.0))
    # A dark line at the limb separates the ball from bright surroundings.
    return scale(light, 1.0 - 0.55 * smoothstep(0.30, 0.02, toward))


@inlined
def _room_light(inks: Inks, rx: float, ry: float, rz: float) -> RGB:
    """Light of the room above the table: bright overhead, two long lamps, a darker horizon."""
    high, low = ink(inks, Ink.SKY), ink(inks, Ink.SKY_LOW)
    light = mix(scale(low, 0.30), scale(high, 0.84), smoothstep(0.0, 0.66, ry))
    along = rx / (ry + 0.15)
    lamp = smoothstep(0.34, 0.22, abs(along + 0.55)) * smoothstep(1.3, 1.0, abs(rz) / (ry + 0.15))
    return add_scaled(light, high, 0.6 * lamp)


@internal
def _frame_light(
    frame: Pixels, before: Pixels, s: StageRecord, x: float, z: float, spread: int, box: Box
) -> RGB:
    """Return the linear light around (x, z) in the frame from before the ball was drawn.

    It is the mean of four pixels, `spread` away from the centre: a ball shrinks what it mirrors, and single
    pixels would flicker.
    """
    left, top, right, bottom = box
    depth = (x - s.eye_x) * s.sine + s.eye_y * s.cosine
    across = int(s.across + s.focal * z / depth)
    down = int(s.down - s.focal * ((x - s.eye_x) * s.cosine - s.eye_y * s.sine) / depth)
    light = (0.0, 0.0, 0.0)
    for corner in range(4):
        column = across + (spread if corner % 2 == 0 else -spread)
        row = down + (spread if corner < 2 else -spread)
        column = min(max(column, 0), frame.shape[1] - 1)
        row = min(max(row, 0), frame.shape[0] - 1)
        pixels = frame[row, column]
        if left <= column < right and top <= row < bottom:
            pixels = before[row - top, column - left]
        tone = (pixels[0] / 255.0, pixels[1] / 255.0, pixels[2] / 255.0)
        light = add_scaled(light, multiply(tone, tone), 0.25)
    return light
