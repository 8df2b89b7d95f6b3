"""The procedural art of the playfield: its paint at a point, and the light that shines through it.

Everything is computed from (x, z) and the size of a pixel there, so edges are smooth at any resolution. The
art depends on the board and the theme but not on the obstacles: all boards of a recipe share one playfield.
"""

from __future__ import annotations

from math import atan2, cos, exp, pi, sin, sqrt
from typing import NamedTuple

from silverball.drawing.kernels.stage import EMBLEM_AT, EMBLEM_SIZE, RAYS, Art, Ink, Inks, StageRecord
from silverball.drawing.kernels.tones import (
    RGB,
    add_scaled,
    clamp01,
    coverage,
    hash01,
    ink,
    mix,
    scale,
    smoothstep,
    value_noise,
)
from silverball.physics.kernel import inlined, internal


class Planet(NamedTuple):
    """A painted planet: centre and radius [u], and whether it has a ring."""

    x: float
    z: float
    radius: float
    is_ringed: bool


@internal
def playfield_paint(s: StageRecord, inks: Inks, x: float, z: float, pixel: float) -> tuple[RGB, RGB]:
    """Return the paint of the playfield at (x, z), and the light that shines through it."""
    size = EMBLEM_SIZE * min(2.0 * s.half_width, s.half_length)
    from_x, from_z = x - EMBLEM_AT * 2.0 * s.half_length, z
    rho = sqrt(from_x * from_x + from_z * from_z)
    angle = atan2(from_z, from_x)  # 0 is up the table
    paint = _floor(s, inks, x, z, rho, angle, pixel)
    light = (0.0, 0.0, 0.0)
    if s.art == Art.COSMOS:
        paint, light = _starry_sky(s, inks, x, z, pixel, paint)
    paint, light = _pinstripes(s, inks, x, z, pixel, paint, light)
    if rho < 3.2 * size:
        paint, light = _emblem(s, inks, rho, angle, size, pixel, paint, light)
    if s.has_lamps == 0:
        paint, light = _arrows(s, inks, from_x, abs(z), size, pixel, paint, light)
    return paint, light


@inlined
def _floor(s: StageRecord, inks: Inks, x: float, z: float, rho: float, angle: float, pixel: float) -> RGB:
    """The colour of the floor with its rays."""
    along = x / s.half_length
    if along < 0.0:
        paint = mix(ink(inks, Ink.FLOOR_MIDDLE), ink(inks, Ink.FLOOR_LOW), min(-along, 1.0))
    else:
        paint = mix(ink(inks, Ink.FLOOR_MIDDLE), ink(inks, Ink.FLOOR_HIGH), min(along, 1.0))
    # The edge of a ray is where the wave is 0; its slope there is RAYS / rho, so this is one pixel wide.
    ray = clamp01(0.5 + cos(RAYS * angle) * rho / (RAYS * pixel))
    reach = rho / (1.1 * s.half_length)
    if s.art == Art.WOOD:
        paint = mix(paint, ink(inks, Ink.RAY), 0.8 * ray)
        turn = 2.0 * clamp01(ray) - 1.0
        grain = value_noise(0.9 * x + 3.0 * turn, 9.0 * z + 31.0 * turn) + 0.5 * value_noise(
            2.2 * x, 31.0 * z
        )
        return scale(paint, 0.66 + 0.4 * grain)
    strength = (0.62 * exp(-reach * reach * 1.6) + 0.12) * smoothstep(0.0, 0.25, reach)
    if s.art == Art.PLAIN:
        return mix(paint, ink(inks, Ink.RAY), 0.8 * ray)
    paint = mix(paint, ink(inks, Ink.RAY), ray * strength)
    return add_scaled(paint, ink(inks, Ink.GLOW), 0.22 * exp(-reach * reach * 12.0))


@internal
def _starry_sky(s: StageRecord, inks: Inks, x: float, z: float, pixel: float, paint: RGB) -> tuple[RGB, RGB]:
    """Clouds of light, two planets and the stars."""
    w = s.half_width
    cloud = value_noise(2.6 * x / w, 2.6 * z / w) + 0.5 * value_noise(5.9 * x / w, 5.9 * z / w + 7.0)
    cloud = smoothstep(0.62, 1.35, cloud + 0.2 * value_noise(14.0 * x / w, 14.0 * z / w))
    hue = smoothstep(0.3, 0.7, value_noise(1.3 * x / w + 11.0, 1.3 * z / w))
    tint = mix(ink(inks, Ink.ORNAMENT_2), ink(inks, Ink.ORNAMENT), hue)
    paint = add_scaled(paint, tint, 0.07 * cloud)
    light = scale(tint, 0.035 * cloud)
    for layer in range(2):
        cell_size = (0.055 + 0.075 * layer) * w
        i, j = int((x / cell_size + 1000.0) // 1.0), int((z / cell_size + 1000.0) // 1.0)
        chance = hash01(i + 7919 * layer, j)
        if chance < 0.17:
            at_x = (i - 1000.0 + 0.2 + 0.6 * hash01(i, j + 513)) * cell_size
            at_z = (j - 1000.0 + 0.2 + 0.6 * hash01(i + 271, j)) * cell_size
            distance = sqrt((x - at_x) ** 2 + (z - at_z) ** 2)
            radius = (0.0022 + 0.0030 * layer + 0.004 * chance) * w
            shine = coverage(distance - radius, pixel + 0.5 * radius) * min(1.0, 2.0 * radius / pixel)
            shine += 0.16 * layer * exp(-distance / (2.2 * radius))
            light = add_scaled(light, (0.9, 0.95, 1.0), (0.25 + 2.6 * chance) * shine)
    large = Planet(0.60 * w, -0.60 * w, 0.20 * w, True)
    small = Planet(-0.36 * w, 0.72 * w, 0.11 * w, False)
    paint, light = _planet(inks, large, x, z, pixel, paint, light)
    return _planet(inks, small, x, z, pixel, paint, light)


@internal
def _planet(
    inks: Inks, planet: Planet, x: float, z: float, pixel: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """A sphere with bands, lit from above, and perhaps a ring around it."""
    size = planet.radius
    u, v = (x - planet.x) / size, (z - planet.z) / size
    distance = sqrt(u * u + v * v)
    if distance > 2.6:
        return paint, light
    tone = ink(inks, Ink.ORNAMENT_2 if planet.is_ringed else Ink.ORNAMENT)
    other = ink(inks, Ink.GLOW)
    disc = coverage((distance - 1.0) * size, pixel)
    lit = clamp01(0.45 + 0.55 * (0.75 * u - 0.45 * v)) * (
        0.55 + 0.45 * sqrt(clamp01(1.0 - distance * distance))
    )
    band = 0.5 + 0.5 * sin(11.0 * (u + 0.35 * v) + 2.0 * value_noise(2.5 * u + 9.0, 4.0 * v))
    body = scale(mix(tone, other, 0.35 + 0.45 * band), 0.62 * lit)
    paint = mix(paint, body, 0.92 * disc)
    light = add_scaled(scale(light, 1.0 - disc), body, 0.22 * disc)
    light = add_scaled(light, tone, 0.10 * exp(-3.4 * max(distance - 1.0, 0.0)) * (1.0 - disc))
    if planet.is_ringed:
        p, q = 0.92 * u + 0.39 * v, -0.39 * u + 0.92 * v
        ring = sqrt((3.2 * p) ** 2 + q * q)
        line = coverage((abs(ring - 1.75) - 0.16) * size * 0.5, pixel)
        line = max(line, 0.6 * coverage((abs(ring - 2.12) - 0.08) * size * 0.5, pixel))
        if p > 0.0:
            line *= 1.0 - disc
        paint = mix(paint, scale(mix(tone, (1.0, 1.0, 1.0), 0.45), 0.7), 0.75 * line)
        light = add_scaled(light, tone, 0.10 * line)
    return paint, light


@inlined
def _pinstripes(
    s: StageRecord, inks: Inks, x: float, z: float, pixel: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """Two fine lines that follow the rails, with round corners."""
    inset, turn = 0.075 * s.half_width, 0.16 * s.half_width
    px = max(x - (s.half_length - s.thickness - inset - turn), 0.0)
    pz = max(abs(z) - (s.half_width - s.thickness - inset - turn), 0.0)
    distance = sqrt(px * px + pz * pz) - turn
    if px == 0.0 and pz == 0.0:
        distance = -turn
    wide, thin = 0.006 * s.half_width, 0.003 * s.half_width
    line = coverage(abs(distance) - wide, pixel) * min(1.0, 2.0 * wide / pixel)
    second = coverage(abs(distance + 0.026 * s.half_width) - thin, pixel) * min(1.0, 2.0 * thin / pixel)
    tone = ink(inks, Ink.ORNAMENT)
    paint = mix(paint, tone, 0.75 * line)
    paint = mix(paint, ink(inks, Ink.ORNAMENT_2), 0.6 * second)
    if s.art == Art.COSMOS:
        light = add_scaled(light, tone, 0.22 * line + 0.05 * exp(-abs(distance) / (0.02 * s.half_width)))
        light = add_scaled(light, ink(inks, Ink.ORNAMENT_2), 0.2 * second)
    return paint, light


@internal
def _emblem(
    s: StageRecord, inks: Inks, rho: float, angle: float, size: float, pixel: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """A faceted star in two rings, and a ring of painted inserts around it where no real ones are."""
    shine = 0.0 if s.art == Art.PLAIN else (1.0 if s.art == Art.COSMOS else 0.25)
    if s.has_lamps != 0:
        shine *= 0.3  # paint, which must not be taken for something lit
    one, two = ink(inks, Ink.ORNAMENT), ink(inks, Ink.ORNAMENT_2)
    disc = coverage(rho - 1.30 * size, pixel)
    paint = mix(paint, scale(paint, 0.35), 0.75 * disc)
    line = coverage(abs(rho - 1.30 * size) - 0.035 * size, pixel)
    paint = mix(paint, one, 0.9 * line)
    light = add_scaled(
        light, one, shine * (0.55 * line + 0.12 * exp(-abs(rho - 1.30 * size) / (0.14 * size)))
    )
    line = coverage(abs(rho - 1.14 * size) - 0.02 * size, pixel)
    paint = mix(paint, two, 0.9 * line)
    light = add_scaled(light, two, shine * (0.5 * line + 0.10 * exp(-abs(rho - 1.14 * size) / (0.10 * size))))
    paint, light = _star(inks, rho, angle, size, pixel, shine, paint, light)
    if s.has_lamps != 0:
        return paint, light
    # Painted inserts: twelve round lenses, every third one larger; all computed as one by folding the angle.
    step = 2.0 * pi / 12.0
    number = int((angle + pi) / step)
    turned = angle + pi - (number + 0.5) * step
    across, along = rho * sin(turned), rho * cos(turned) - 1.72 * size
    distance = sqrt(across * across + along * along)
    lens = 0.17 * size if number % 3 == 1 else 0.12 * size
    tone = one if number % 2 == 0 else two
    return _lens(distance, lens, tone, shine, pixel, paint, light)


@internal
def _star(
    inks: Inks, rho: float, angle: float, size: float, pixel: float, shine: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """A five-pointed star whose arms have a light and a dark half, like folded paper."""
    heart = ink(inks, Ink.HEART)
    step = 2.0 * pi / 5.0
    place = (angle + 2.0 * pi + 0.5 * step) / step
    turned = (place - place // 1.0 - 0.5) * step
    px, pz = rho * cos(turned), rho * abs(sin(turned))
    # The edge of an arm runs from its tip to the notch halfway to the next.
    tip = 0.98 * size
    notch = 0.46 * size
    notch_x, notch_z = notch * cos(0.5 * step), notch * sin(0.5 * step)
    ex, ez = notch_x - tip, notch_z
    length = sqrt(ex * ex + ez * ez)
    distance = ((px - tip) * -ez + pz * ex) / -length
    star = coverage(distance, pixel)
    fold = clamp01(0.5 + 0.5 * rho * sin(turned) / pixel)
    face = mix(heart, (1.0, 1.0, 1.0), 0.38 * fold * (1.0 - 0.5 * rho / size))
    face = scale(face, 0.55 + 0.45 * fold)
    paint = mix(paint, face, 0.95 * star)
    rim = coverage(abs(distance) - 0.025 * size, pixel)
    paint = mix(paint, (1.0, 1.0, 1.0), 0.5 * rim * star)
    light = add_scaled(light, face, shine * 0.30 * star)
    return paint, add_scaled(
        light, heart, shine * 0.20 * exp(-max(distance, 0.0) / (0.16 * size)) * (1.0 - star)
    )


@inlined
def _lens(
    distance: float, size: float, tone: RGB, shine: float, pixel: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """A round insert: a lit lens in a bright rim."""
    disc = coverage(distance - size, pixel)
    rim = coverage(abs(distance - size) - 0.12 * size, pixel)
    paint = mix(paint, scale(tone, 0.5), 0.9 * disc)
    paint = mix(paint, mix(tone, (1.0, 1.0, 1.0), 0.5), 0.8 * rim)
    inner = clamp01(1.0 - distance / size)
    light = add_scaled(light, tone, shine * disc * (0.10 + 0.55 * inner * inner))
    light = add_scaled(light, tone, shine * 0.10 * exp(-max(distance - size, 0.0) / (0.8 * size)))
    return paint, light


@internal
def _arrows(
    s: StageRecord, inks: Inks, from_x: float, z: float, size: float, pixel: float, paint: RGB, light: RGB
) -> tuple[RGB, RGB]:
    """Rows of painted arrows that point up the table: three between paddles and emblem, two above."""
    shine = 0.0 if s.art == Art.PLAIN else (1.0 if s.art == Art.COSMOS else 0.25)
    for row in range(3):
        if row == 0:
            at_z, low, count, tone = 0.0, -5.6 * size, 4, ink(inks, Ink.HEART)
        elif row == 1:
            at_z, low, count, tone = 1.25 * size, -5.0 * size, 3, ink(inks, Ink.ORNAMENT_2)
        else:
            at_z, low, count, tone = 1.55 * size, 2.3 * size, 4, ink(inks, Ink.ORNAMENT)
        step = 0.86 * size
        number = (from_x - low) // step
        if 0.0 <= number < count and abs(z - at_z) < 0.6 * size:
            u = (from_x - low - (number + 0.5) * step) / size
            v = abs(z - at_z) / size
            # A chevron: a band along x + 0.75·|z| = const, clipped at both sides.
            distance = max(abs(u + 0.75 * v - 0.08) * 0.8 - 0.115, v - 0.30) * size
            shape = coverage(distance, pixel)
            bright = 0.35 + 0.65 * number / count
            paint = mix(paint, scale(tone, 0.6), 0.9 * shape)
            light = add_scaled(
                light, tone, shine * bright * (0.34 * shape + 0.10 * exp(-max(distance, 0.0) / (0.03 * size)))
            )
    return paint, light
