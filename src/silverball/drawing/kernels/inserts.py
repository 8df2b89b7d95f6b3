"""Inserts: the lenses of lamps, flush with the playfield. Their shape, their paint, and their light.

A lens that is off is dark glass in its colour, with a black line around it. What its lamp adds when it is lit
is a picture of its own: the lens, and a soft light on the playfield and the parts around it.
"""

from __future__ import annotations

from math import atan2, cos, exp, pi, sin, sqrt

from silverball.drawing.kernels.stage import FLOOR, InsertRecord, Lens, Scene, Vector
from silverball.drawing.kernels.tones import RGB, add_scaled, clamp01, coverage, mix, multiply, scale
from silverball.physics.kernel import inlined, internal

LAMP_REACH = 1.0  # [u] from the edge of a lens to where its light ends
LINE = 0.04  # [u] width of the black line around a lens
FACETS = 14  # wedges of a lens, as they are moulded into its underside
WHITE = (1.0, 1.0, 1.0)


@internal
def insert_distance(c: InsertRecord, x: float, z: float) -> float:
    """Return the distance from the edge of a lens [u], negative inside of it.

    In its own frame (p to where it points, q across, its radius 1) every shape is a circle or a number of
    straight sides; beyond a corner the distance is that of the nearer side, which light alone reads.
    """
    dx, dz = (x - c.x) / c.size, (z - c.z) / c.size
    p, q = dx * c.sine + dz * c.cosine, abs(dx * c.cosine - dz * c.sine)
    if c.shape == Lens.SQUARE:
        d = max(abs(p), q) - 0.70
    elif c.shape == Lens.BAR:
        d = max(abs(p) - 0.92, q - 0.36)
    elif c.shape == Lens.TRIANGLE:
        d = max(-p - 0.5, 0.5 * p + 0.8660254 * q - 0.5)
    elif c.shape == Lens.ARROW:
        head = max(0.05 - p, 0.6196 * (p - 1.0) + 0.7849 * q)
        d = min(head, max(abs(p + 0.45) - 0.5, q - 0.30))
    elif c.shape == Lens.STAR:
        d = _star_distance(p, q)
    else:
        d = sqrt(p * p + q * q) - 1.0
    edge: float = d * c.size
    return edge


@inlined
def _star_distance(p: float, q: float) -> float:
    """Distance from a star of five points: one edge from a tip to a notch, the others folded onto it."""
    step = 0.4 * pi
    place = atan2(q, p) / step + 0.5
    turned = (place - place // 1.0 - 0.5) * step
    rho = sqrt(p * p + q * q)
    across, along = rho * abs(sin(turned)), rho * cos(turned)
    notch_p, notch_q = 0.48 * cos(0.5 * step), 0.48 * sin(0.5 * step)
    ex, ez = notch_p - 1.0, notch_q
    return ((along - 1.0) * ez - across * ex) / sqrt(ex * ex + ez * ez)


@internal
def add_inserts(scene: Scene, x: float, z: float, pixel: float, paint: RGB, light: RGB) -> tuple[RGB, RGB]:
    """Return the paint of the playfield at (x, z) and the light that shines through it, with its lenses."""
    line = LINE * scene.stage[0].unit
    for index in range(len(scene.inserts)):
        c = scene.inserts[index]
        dx, dz, reach = x - c.x, z - c.z, c.size + 2.0 * line
        if c.is_painted == 0 or dx * dx + dz * dz > reach * reach:
            continue
        d = insert_distance(c, x, z)
        stay = 1.0 - coverage(d - line, pixel)
        paint, light = scale(paint, max(stay, 0.02)), scale(light, stay)
        lens = coverage(d, pixel)
        tone = (c.red, c.green, c.blue)
        rim = coverage(-0.12 * c.size - d, pixel)
        glass = scale(tone, 0.055 + 0.05 * _facet(c, x, z) + 0.09 * rim)
        # The room's lamp gleams in the half towards it.
        high, wide = dx / c.size - 0.42, dz / c.size
        gleam = exp(-(high * high + 0.45 * wide * wide) / 0.05)
        paint = mix(paint, add_scaled(glass, WHITE, 0.02 + 0.12 * gleam), lens)
        light = add_scaled(light, tone, 0.008 * lens)
    return paint, light


@internal
def insert_light(scene: Scene, index: int, part: int, point: Vector, normal: Vector, paint: RGB) -> RGB:
    """Return the light that a lit lens adds at a point of a surface: its own, or that on what is around."""
    s, c = scene.stage[0], scene.inserts[index]
    x, y, z = point
    tone = (c.red, c.green, c.blue)
    d = insert_distance(c, x, z)
    a = max(d, 0.0) / s.unit
    if a >= LAMP_REACH:
        return 0.0, 0.0, 0.0
    fade = 1.0 - (a / LAMP_REACH) ** 2
    around = fade * fade * (1.0 * exp(-a / 0.11) + 0.42 * exp(-a / 0.42))
    if part != FLOOR:  # the side of a part; a face turned away gets nothing
        step = 0.01 * s.unit
        gx = insert_distance(c, x + step, z) - d
        gz = insert_distance(c, x, z + step) - d
        length = max(sqrt(gx * gx + gz * gz), 1e-9)
        facing = clamp01(0.25 - 0.75 * (normal[0] * gx + normal[2] * gz) / length)
        strength = around * facing * exp(-y / (0.22 * s.unit))
        return scale(multiply(tone, mix(paint, WHITE, 0.2)), 1.2 * strength)
    lens = coverage(d, s.pixel)
    rho = sqrt((x - c.x) ** 2 + (z - c.z) ** 2) / c.size
    core = exp(-rho * rho / 0.24)
    hot = scale(mix(tone, WHITE, 0.03 + 0.30 * core), 0.50 + 1.35 * core)
    shine = lens * (0.78 + 0.22 * _facet(c, x, z))
    glow = scale(multiply(tone, mix(paint, WHITE, 0.16)), (1.0 - lens) * around)
    glow = add_scaled(glow, tone, 0.10 * (1.0 - lens) * fade * exp(-a / 0.14))  # in the air above it
    return add_scaled(glow, hot, shine)


@inlined
def _facet(c: InsertRecord, x: float, z: float) -> float:
    """How bright a wedge of the lens is, 0 to 1."""
    return 0.5 + 0.5 * cos(FACETS * atan2(z - c.z, x - c.x))
