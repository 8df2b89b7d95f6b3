"""Shading: the light that a point of a surface sends towards the eye.

    radiance = paint · (lamp · shadow · (n·l) + sky · openness + glow of parts) + own light + mirrored light

The glow is a sum over the parts, so the flash of one part can be added to a finished picture.
"""

from __future__ import annotations

from math import exp, sqrt

from silverball.drawing.kernels.march import ambient_visibility, lamp_visibility, trace
from silverball.drawing.kernels.solids import cell_at, footprint_distance, rail_footprint
from silverball.drawing.kernels.stage import (
    FLOOR,
    HALO,
    RAIL,
    RING_AT,
    ROOM,
    Ink,
    Inks,
    Material,
    Scene,
    StageRecord,
    Vector,
)
from silverball.drawing.kernels.surfaces import Surface, color_of, surface_of
from silverball.drawing.kernels.tones import RGB, add_scaled, clamp01, ink, mix, multiply, scale, smoothstep
from silverball.physics.kernel import inlined, internal

RING_CORE = 0.032  # [u] half the width of the bright line in the ring of light
MIRROR_REACH = 2.2  # [u] greatest distance at which parts are mirrored in the lacquer
MAX_GRAZING = 0.25  # reflectance at grazing angles, beyond a surface's gloss
FRONT = 0.20  # unshadowed light from the player's side, relative to the lamp


@internal
def radiance(scene: Scene, part: int, point: Vector, direction: Vector, pixel: float) -> RGB:
    """Return the light of a point of a part, seen along a direction (a unit vector)."""
    s = scene.stage[0]
    x, y, z = point
    dx, dy, dz = direction
    if part == ROOM:
        return _room_floor(scene, x, z)
    f = surface_of(scene, part, x, y, z, pixel)
    toward = -(f.nx * dx + f.ny * dy + f.nz * dz)
    facing = f.nx * s.light_x + f.ny * s.light_y
    lift = 0.006 * s.unit
    px, py, pz = x + lift * f.nx, y + lift * f.ny, z + lift * f.nz
    lamp = 0.0
    if facing > 0.0:
        lamp = facing * lamp_visibility(scene, px, py, pz)
    open_ = ambient_visibility(scene, px, py, pz, f.nx, f.ny, f.nz)
    light = _diffuse(s, f, lamp, open_)
    light = _add_glow(scene, part, f, x, y, z, light, open_)
    light = (light[0] + f.light[0], light[1] + f.light[1], light[2] + f.light[2])
    # It mirrors more at grazing angles. Source: C. Schlick, "An inexpensive BRDF model", 1994.
    grazing = clamp01(1.0 - toward)
    # Limited, because distant edges, one pixel wide, would flicker between sky and paint.
    share = f.gloss + min(1.0 - f.gloss, MAX_GRAZING) * grazing**5
    rx, ry, rz = dx + 2.0 * toward * f.nx, dy + 2.0 * toward * f.ny, dz + 2.0 * toward * f.nz
    if part == FLOOR:
        seen = _lacquer_reflection(scene, px, py, pz, rx, ry, rz, pixel)
        return add_scaled(light, seen, min(3.6 * share, 1.0) * s.lacquer)
    sky = sky_light(scene.inks, rx, ry, rz)
    sky = mix(sky, multiply(sky, f.paint), f.metal)
    return add_scaled(light, sky, share * (0.35 + 0.65 * open_))


@inlined
def _diffuse(s: StageRecord, f: Surface, lamp: float, open_: float) -> RGB:
    """Diffuse reflection of the lamp and of the ambient light."""
    front = FRONT * max(0.55 * f.ny - 0.83 * f.nx, 0.0)
    around = s.fill * open_ * (0.62 + 0.38 * f.ny)
    strength = (s.key * (lamp + front * open_) + around) * (1.0 - 0.8 * f.metal)
    return scale(f.paint, strength)


@internal
def _add_glow(
    scene: Scene, part: int, f: Surface, x: float, y: float, z: float, light: RGB, open_: float
) -> RGB:
    """Add the glow of the parts around and of the tubes along the rails."""
    s = scene.stage[0]
    cell = cell_at(s, x, z)
    own = scene.solids[part].group if part >= 0 else -1
    nearest, nearest_at = -1, 0.0
    for place in range(scene.lit[cell], scene.lit[cell + 1]):
        index = scene.lit[place]
        if scene.solids[index].group == own:
            continue
        at = footprint_distance(scene.solids[index], x, z)
        # The solids of a part are neighbours in the list; only the nearest of them lights this point.
        if nearest >= 0 and scene.solids[nearest].group == scene.solids[index].group:
            if at < nearest_at:
                nearest, nearest_at = index, at
            continue
        if nearest >= 0:
            light = add_scaled(light, part_glow(scene, nearest, part, f, x, y, z), 1.0)
        nearest, nearest_at = index, at
    if nearest >= 0:
        light = add_scaled(light, part_glow(scene, nearest, part, f, x, y, z), 1.0)
    gap = -rail_footprint(s, x, z) / s.unit
    if gap > 0.0 and part != RAIL:
        strength = s.halo * (0.55 * exp(-gap / 0.10) + 0.22 * exp(-gap / 0.45)) * exp(-y / (0.3 * s.unit))
        strip = ink(scene.inks, Ink.STRIP)
        light = add_scaled(light, multiply(strip, mix(f.paint, (1.0, 1.0, 1.0), 0.35)), strength * open_)
    return light


@internal
def part_glow(scene: Scene, index: int, part: int, f: Surface, x: float, y: float, z: float) -> RGB:
    """Return the light that one solid throws onto another: its halo, and a bumper's ring of light."""
    s = scene.stage[0]
    solid = scene.solids[index]
    a = footprint_distance(solid, x, z) / s.unit
    if a >= HALO:
        return 0.0, 0.0, 0.0
    fade = 1.0 - (max(a, 0.0) / HALO) ** 2
    fade *= fade
    near = max(a, 0.0)
    up = max(y - solid.base, 0.0)
    above = max(up / s.unit - 0.45, 0.0)
    strength = solid.glow * fade * (0.85 * exp(-near / 0.16) + 0.30 * exp(-near / 0.62)) * exp(-above / 0.2)
    tone = color_of(solid)
    if solid.tube > 0.0:
        tone = ink(scene.inks, Ink.STRIP_2)
        strength = solid.tube * fade * (0.55 * exp(-near / 0.09) + 0.20 * exp(-near / 0.4)) * exp(-up / 0.3)
    if part != FLOOR:
        # Light comes from the solid's side, so a face turned away from it gets less.
        gx = footprint_distance(solid, x + 0.01, z) / s.unit - a
        gz = footprint_distance(solid, x, z + 0.01) / s.unit - a
        length = max(sqrt(gx * gx + gz * gz), 1e-9)
        strength *= clamp01(0.4 - 0.6 * (f.nx * gx + f.nz * gz) / length)
    glow = scale(multiply(tone, mix(f.paint, (1.0, 1.0, 1.0), 0.22)), strength)
    if solid.material == Material.BUMPER and part == FLOOR:
        off = abs(a - RING_AT)
        core = smoothstep(RING_CORE + 0.6 * s.pixel / s.unit, RING_CORE - 0.6 * s.pixel / s.unit, off)
        core *= min(1.0, 2.0 * RING_CORE * s.unit / s.pixel)
        hot = mix(tone, (1.0, 1.0, 1.0), 0.35)
        glow = add_scaled(glow, hot, solid.glow * 1.25 * core)
        glow = add_scaled(glow, tone, solid.glow * (0.42 * exp(-off / 0.06) + 0.14 * exp(-off / 0.22)) * fade)
    return glow


@internal
def _lacquer_reflection(
    scene: Scene, x: float, y: float, z: float, dx: float, dy: float, dz: float, pixel: float
) -> RGB:
    """Return the reflection in the lacquer: the first part on the ray, simply lit, or the dark room."""
    s = scene.stage[0]
    reach = MIRROR_REACH * s.unit
    t, part = trace(scene, x, y, z, dx, dy, dz, reach)
    if part in (ROOM, FLOOR):
        return scale(ink(scene.inks, Ink.SKY_LOW), 0.05)
    at_x, at_y, at_z = x + t * dx, y + t * dy, z + t * dz
    f = surface_of(scene, part, at_x, at_y, at_z, pixel)
    facing = max(f.nx * s.light_x + f.ny * s.light_y, 0.0)
    front = FRONT * max(0.55 * f.ny - 0.83 * f.nx, 0.0)
    light = scale(f.paint, 0.7 * s.key * facing + s.key * front + 0.6 * s.fill)
    light = (light[0] + f.light[0], light[1] + f.light[1], light[2] + f.light[2])
    if f.metal > 0.0:
        light = add_scaled(light, ink(scene.inks, Ink.SKY_LOW), 0.4 * f.metal)
    return scale(light, 1.0 - (t / reach) ** 2)


@internal
def sky_light(inks: Inks, dx: float, dy: float, dz: float) -> RGB:
    """What polished parts mirror: a bright ceiling with two long lamps, a dark horizon, the floor below."""
    high, low = ink(inks, Ink.SKY), ink(inks, Ink.SKY_LOW)
    if dy <= 0.0:
        return scale(mix(ink(inks, Ink.FLOOR_MIDDLE), low, 0.25), 0.8 * clamp01(1.0 + dy))
    light = mix(scale(low, 0.30), scale(high, 0.42), smoothstep(0.05, 0.98, dy))
    along, across = dx / (dy + 0.05), dz / (dy + 0.05)
    for row in range(2):
        middle = 1.75 if row == 0 else -0.35
        lamp = smoothstep(0.42, 0.30, abs(along - middle)) * smoothstep(1.6, 1.3, abs(across))
        light = add_scaled(light, high, 1.9 * lamp)
    return light


@inlined
def _room_floor(scene: Scene, x: float, z: float) -> RGB:
    """The floor of the room, lit faintly by the table."""
    s = scene.stage[0]
    out_x = max(abs(x) - s.half_length - s.rail, 0.0)
    out_z = max(abs(z) - s.half_width - s.rail, 0.0)
    gap = sqrt(out_x * out_x + out_z * out_z) / s.unit
    return add_scaled(ink(scene.inks, Ink.ROOM), ink(scene.inks, Ink.GLOW), 0.10 * s.halo * exp(-gap / 0.7))
