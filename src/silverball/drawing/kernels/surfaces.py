"""Surfaces: normal, paint, emitted light and gloss at a point of a part."""

from __future__ import annotations

from math import atan2, cos, exp, pi, sin, sqrt
from typing import NamedTuple

from silverball.drawing.kernels.art import playfield_paint
from silverball.drawing.kernels.inserts import add_inserts
from silverball.drawing.kernels.solids import (
    CAP_SHARE,
    apron_distance,
    footprint_distance,
    rail_distance,
    rail_footprint,
    solid_distance,
)
from silverball.drawing.kernels.stage import (
    APRON,
    FLOOR,
    RAIL,
    Frame,
    Ink,
    Material,
    Outline,
    Scene,
    SolidRecord,
)
from silverball.drawing.kernels.tones import (
    RGB,
    add_scaled,
    clamp01,
    coverage,
    ink,
    mix,
    scale,
    smoothstep,
    value_noise,
)
from silverball.physics.kernel import inlined, internal

STEP = 0.004  # [u] between the points whose distances give a normal
SPOKES = 8  # spokes of the star on a cap
BOLT_SPACING = 2.4  # [u] between the bolts of the rails


class Surface(NamedTuple):
    """The properties of a surface at a point.

    Attributes:
        nx: The unit normal, its part up the table.
        ny: Its part out of the board.
        nz: Its part to the right.
        paint: Diffuse reflectance of each colour.
        light: Emitted light.
        gloss: Reflectance when seen from straight above it.
        metal: 1 for metal, which mirrors in its own colour and has no paint; 0 for everything else.
    """

    nx: float
    ny: float
    nz: float
    paint: RGB
    light: RGB
    gloss: float
    metal: float


class Hit(NamedTuple):
    """Where a ray meets a surface: the point [u], the unit normal, and the size of a pixel there [u]."""

    x: float
    y: float
    z: float
    nx: float
    ny: float
    nz: float
    pixel: float


@internal
def surface_of(scene: Scene, part: int, x: float, y: float, z: float, pixel: float) -> Surface:
    """Return the surface of a part at (x, y, z), where a pixel has a size [u]."""
    s = scene.stage[0]
    if part == FLOOR:
        paint, light = playfield_paint(s, scene.inks, x, z, pixel)
        paint, light = add_inserts(scene, x, z, pixel, paint, light)
        return Surface(0.0, 1.0, 0.0, paint, light, 0.04, 0.0)
    nx, ny, nz = _normal(scene, part, x, y, z)
    hit = Hit(x, y, z, nx, ny, nz, pixel)
    if part == RAIL:
        return _rail(scene, hit)
    if part == APRON:
        return _apron(scene, hit)
    solid = scene.solids[part]
    if solid.material == Material.BUMPER:
        return _bumper(scene, solid, hit)
    if solid.material == Material.BAR:
        return _bar(scene, solid, hit)
    inside = -footprint_distance(solid, x, z)
    if solid.material == Material.ACRYLIC:
        return _acrylic(solid, hit, inside)
    if solid.material == Material.PADDLE:
        return _paddle(scene, solid, hit, inside)
    if solid.material >= Material.INSERT:
        return _flat(scene, solid, hit, inside)
    return _simple(scene, solid, hit, inside)


@inlined
def color_of(solid: SolidRecord) -> RGB:
    """Return the own colour of a part."""
    return solid.red, solid.green, solid.blue


@internal
def _distance(scene: Scene, part: int, x: float, y: float, z: float) -> float:
    if part == RAIL:
        return rail_distance(scene.stage[0], x, y, z)
    if part == APRON:
        return apron_distance(scene.stage[0], x, y, z)
    return solid_distance(scene.corners, scene.solids[part], x, y, z)


@internal
def _normal(scene: Scene, part: int, x: float, y: float, z: float) -> RGB:
    """Return the gradient of the distance as a unit vector, from four points around."""
    if part >= 0 and scene.solids[part].outline == Outline.POLYGON:
        return 0.0, 1.0, 0.0
    nx, ny, nz = 0.0, 0.0, 0.0
    h = STEP * scene.stage[0].unit
    for corner in range(4):  # of a tetrahedron: (+,−,−), (−,−,+), (−,+,−), (+,+,+)
        ex = h if corner == 0 or corner == 3 else -h  # noqa: PLR1714 - no tuple in a kernel
        ey = h if corner >= 2 else -h
        ez = h if corner == 1 or corner == 3 else -h  # noqa: PLR1714
        d = _distance(scene, part, x + ex, y + ey, z + ez)
        nx += ex * d
        ny += ey * d
        nz += ez * d
    length = max(sqrt(nx * nx + ny * ny + nz * nz), 1e-12)
    return nx / length, ny / length, nz / length


@internal
def _rail(scene: Scene, hit: Hit) -> Surface:
    """The rail: metal with a bright trim, or wood with brass; bolts on top, a tube of light at its foot."""
    x, y, z, nx, ny, nz, pixel = hit
    s = scene.stage[0]
    in_top = x - s.half_length > abs(z) - s.half_width or -x - s.half_length > abs(z) - s.half_width
    along = z if in_top else x
    width = s.rail + s.thickness
    deep = rail_footprint(s, x, z) + 0.5 * width  # 0 on the middle line, grows to both sides
    tone = ink(scene.inks, Ink.RAIL)
    light = (0.0, 0.0, 0.0)
    steel = ink(scene.inks, Ink.STEEL)
    metal, gloss = 0.0, 0.10
    if s.frame == Frame.WOOD:
        across = x if in_top else z
        grain = value_noise(1.1 * along, 14.0 * across) + 0.5 * value_noise(
            2.7 * along, 41.0 * across + 3.0 * y
        )
        tone = scale(tone, 0.62 + 0.5 * grain)
    else:
        brushed = value_noise(3.0 * along, 60.0 * (x if in_top else z))
        tone = scale(tone, 0.85 + 0.3 * brushed)
        gloss = 0.22
    if ny > 0.5:
        trim = coverage(abs(abs(deep) - 0.02 * width) - 0.035 * width, pixel)
        if trim > 0.5:
            tone, metal, gloss = mix(tone, steel, 0.8), 0.8, 0.5
        spacing = BOLT_SPACING * s.unit
        place = along / spacing + 0.5
        off = (place - place // 1.0 - 0.5) * spacing
        radius = 0.16 * width
        rho = sqrt(off * off + deep * deep)
        if rho < radius:
            tone, metal, gloss = steel, 1.0, 0.85
            # A round head: its normal leans outwards.
            lean = 0.7 * rho / radius / max(rho, 1e-9)
            lean_x, lean_z = (deep * 0.0 + off, 0.0) if not in_top else (0.0, off)
            nx, nz = nx + lean * lean_x, nz + lean * lean_z
            length = sqrt(nx * nx + ny * ny + nz * nz)
            nx, ny, nz = nx / length, ny / length, nz / length
        tone = scale(tone, 1.0 - 0.5 * coverage(abs(rho - radius) - 0.02 * width, pixel))
    elif abs(x) < s.half_length - 0.5 * s.thickness and abs(z) < s.half_width:
        strip = exp(-(((y - 0.09 * s.unit) / (0.045 * s.unit)) ** 2))
        light = scale(ink(scene.inks, Ink.STRIP), 1.6 * strip * s.halo)
    return Surface(nx, ny, nz, tone, light, gloss, metal)


@internal
def _apron(scene: Scene, hit: Hit) -> Surface:
    """The plate at the player's end, with the table's name."""
    x, y, z, nx, ny, nz = hit.x, hit.y, hit.z, hit.nx, hit.ny, hit.nz
    s = scene.stage[0]
    tone = ink(scene.inks, Ink.APRON)
    light = (0.0, 0.0, 0.0)
    depth = s.apron_top + s.half_length
    half = s.half_width - s.thickness
    down = (s.apron_top - x) / max(depth, 1e-9)
    if ny > 0.9:
        tone = scale(tone, 0.8 + 0.5 * clamp01(1.0 - down))
        row = int(down * scene.label.shape[0])
        column = int((z + half) / (2.0 * half) * scene.label.shape[1])
        if 0 <= row < scene.label.shape[0] and 0 <= column < scene.label.shape[1]:
            letter = scene.label[row, column]
            name = ink(scene.inks, Ink.LABEL)
            tone = mix(tone, name, 0.85 * letter)
            light = scale(name, 0.25 * letter * s.halo)
    else:
        edge = exp(-(((y - s.apron_height + 0.08 * s.unit) / (0.05 * s.unit)) ** 2))
        light = scale(ink(scene.inks, Ink.STRIP), (0.15 + 0.9 * edge) * s.halo)
    return Surface(nx, ny, nz, tone, light, 0.06, 0.0)


@internal
def _bumper(scene: Scene, c: SolidRecord, hit: Hit) -> Surface:
    """A bumper: a lit ribbed body, a steel ring, a domed cap with a star."""
    y, nx, ny, nz, pixel = hit.y, hit.nx, hit.ny, hit.nz, hit.pixel
    tone = color_of(c)
    s = scene.stage[0]
    rx, rz = hit.x - c.x, hit.z - c.z
    rho, angle = sqrt(rx * rx + rz * rz), atan2(rz, rx)
    unit = s.unit
    wide = CAP_SHARE * c.radius
    if rho > wide - 0.01 * unit and y > c.height - 0.078 * unit:
        return Surface(nx, ny, nz, ink(scene.inks, Ink.STEEL), (0.0, 0.0, 0.0), 0.85, 1.0)
    if y < c.height:
        share = (y - c.base) / (c.height - c.base)
        rib = 0.5 + 0.5 * cos(20.0 * angle)
        shine = (0.22 + 0.5 * share) * (0.45 + 0.55 * rib) * s.halo
        return Surface(nx, ny, nz, scale(tone, 0.8), scale(tone, shine), 0.08, 0.0)
    share = rho / wide
    white = mix(tone, ink(scene.inks, Ink.CAP), s.cap_ground)
    step = 2.0 * pi / SPOKES
    place = angle / step + 1000.5
    turned = (place - place // 1.0 - 0.5) * step
    # A spoke widens from the middle to the rim and ends round.
    off = rho * abs(sin(turned)) - 0.30 * rho * sin(0.5 * step) - 0.045 * wide
    spoke = coverage(max(off, abs(rho - 0.60 * wide) - 0.25 * wide), pixel)
    heart = coverage(rho - 0.22 * wide, pixel)
    collar = coverage(abs(rho - 0.22 * wide) - 0.035 * wide, pixel)
    rim = coverage(0.93 * wide - rho, pixel)
    paint = mix(scale(tone, 0.85 - 0.25 * share), white, 0.95 * max(spoke, heart))
    paint = mix(paint, scale(tone, 0.35), max(collar, rim))
    shine = (0.22 + 0.34 * (1.0 - share) * (1.0 - share)) * (0.4 + 0.6 * s.halo)
    light = add_scaled(scale(paint, shine), white, 0.25 * max(heart, 0.4 * spoke) * s.halo)
    return Surface(nx, ny, nz, paint, light, 0.07, 0.0)


@internal
def _acrylic(solid: SolidRecord, hit: Hit, inside: float) -> Surface:
    """Lit acrylic: light gathers at the edges, and a second, fainter line runs inside the top."""
    y, nx, ny, nz, pixel = hit.y, hit.nx, hit.ny, hit.nz, hit.pixel
    tone = color_of(solid)
    unit = (solid.height - solid.base) / 0.34
    if ny > 0.85:
        edge = exp(-max(inside - solid.bevel, 0.0) / (0.07 * unit))
        line = coverage(abs(inside - 0.24 * unit) - 0.018 * unit, pixel)
        inner = smoothstep(0.24 * unit, 0.3 * unit, inside)
        paint = scale(tone, 0.75 - 0.22 * inner)
        light = scale(mix(tone, (1.0, 1.0, 1.0), 0.12 * edge), 0.26 + 0.62 * edge - 0.10 * inner)
        return Surface(nx, ny, nz, paint, add_scaled(light, tone, 0.5 * line), 0.07, 0.0)
    if ny > 0.25:  # the bevelled edge, where the light comes out
        white = mix(tone, (1.0, 1.0, 1.0), 0.42)
        away = 1.0 - 0.65 * max(nx, 0.0)  # less at the far edges, which are thinner than a pixel
        return Surface(nx, ny, nz, tone, scale(white, 1.05 * away), 0.10, 0.0)
    up = clamp01((y - solid.base) / (solid.height - solid.base))
    return Surface(nx, ny, nz, scale(tone, 0.8), scale(tone, 0.16 + 0.42 * up * up), 0.10, 0.0)


@internal
def _paddle(scene: Scene, solid: SolidRecord, hit: Hit, inside: float) -> Surface:
    """A bright plate with a rubber around it and a bolt over its pivot."""
    nx, ny, nz = hit.nx, hit.ny, hit.nz
    tone = color_of(solid)
    if hit.y > solid.height + 0.004:
        return Surface(nx, ny, nz, ink(scene.inks, Ink.STEEL), (0.0, 0.0, 0.0), 0.8, 1.0)
    edge = ink(scene.inks, Ink.PADDLE_EDGE)
    rim = coverage(inside - 0.055 * (solid.height - solid.base) / 0.33, hit.pixel)
    light = scale(mix(tone, edge, rim), 0.16)
    if ny < 0.5:
        return Surface(nx, ny, nz, scale(mix(tone, edge, 0.45), 0.85), scale(tone, 0.10), 0.06, 0.0)
    return Surface(nx, ny, nz, mix(tone, edge, rim), light, 0.08, 0.0)


@internal
def _bar(scene: Scene, solid: SolidRecord, hit: Hit) -> Surface:
    """A wall: a steel bar, or a wooden one; a tube of light along its foot."""
    y, nx, ny, nz = hit.y - solid.base, hit.nx, hit.ny, hit.nz
    tone = color_of(solid)
    s = scene.stage[0]
    strip = exp(-(((y - 0.09 * s.unit) / (0.045 * s.unit)) ** 2)) if ny < 0.3 else 0.0
    light = scale(ink(scene.inks, Ink.STRIP_2), 1.6 * strip * solid.tube)
    if s.frame == Frame.WOOD:
        return Surface(nx, ny, nz, tone, light, 0.25, 0.5)
    return Surface(nx, ny, nz, tone, light, 0.4, 0.55)


@internal
def _simple(scene: Scene, solid: SolidRecord, hit: Hit, inside: float) -> Surface:
    """Steel, timber, plastic, rubber, the face of a target, or one colour."""
    nx, ny, nz, pixel = hit.nx, hit.ny, hit.nz, hit.pixel
    tone, dark = color_of(solid), (0.0, 0.0, 0.0)
    unit = scene.stage[0].unit
    if solid.material == Material.STEEL:
        return Surface(nx, ny, nz, tone, dark, 0.6, 0.9)
    if solid.material == Material.TIMBER:
        grain = value_noise(1.3 * hit.x, 11.0 * hit.z) + 0.5 * value_noise(3.1 * hit.x, 37.0 * hit.z)
        return Surface(nx, ny, nz, scale(tone, 0.6 + 0.45 * grain), dark, 0.10, 0.0)
    if solid.material == Material.PLASTIC:
        if solid.outline == Outline.POLYGON:
            stripe = clamp01(0.5 + 2.0 * sin(2.6 * (hit.x + hit.z) / unit))
            return Surface(nx, ny, nz, scale(tone, 0.55 + 0.15 * stripe), scale(tone, 0.06), 0.12, 0.0)
        return Surface(nx, ny, nz, scale(tone, 0.85), scale(tone, 0.22), 0.16, 0.0)
    if solid.material == Material.RUBBER:
        return Surface(nx, ny, nz, tone, scale(tone, 0.05), 0.05, 0.0)
    if solid.material == Material.TARGET:
        white = mix(tone, (1.0, 1.0, 1.0), 0.75)
        if ny > 0.5:
            core = coverage(0.045 * unit - inside, pixel)
            return Surface(nx, ny, nz, mix(white, tone, core), scale(tone, 0.18 * core), 0.10, 0.0)
        up = (hit.y - solid.base) / (solid.height - solid.base)
        band = coverage(abs(up - 0.55) - 0.12, 0.06)
        return Surface(nx, ny, nz, mix(tone, white, band), scale(tone, 0.24), 0.10, 0.0)
    return Surface(nx, ny, nz, tone, dark, 0.05, 0.0)


@internal
def _flat(scene: Scene, solid: SolidRecord, hit: Hit, inside: float) -> Surface:
    """What lies in the playfield (a lens, a hole, the mouth of a passage), or a turning blade."""
    nx, ny, nz, pixel = hit.nx, hit.ny, hit.nz, hit.pixel
    tone = color_of(solid)
    s = scene.stage[0]
    unit = s.unit
    if solid.material == Material.INSERT:
        deep = clamp01(inside / max(solid.radius, 1e-9))
        rim = coverage(inside - 0.035 * unit, pixel)
        paint = mix(scale(tone, 0.55), mix(tone, (1.0, 1.0, 1.0), 0.6), 0.8 * rim)
        shine = (0.16 + 0.5 * deep * deep) * (0.4 + 0.6 * s.halo)
        return Surface(nx, ny, nz, paint, scale(tone, shine), 0.06, 0.0)
    if solid.material == Material.PIT:
        rim = coverage(inside - 0.07 * unit, pixel)
        # The far wall of the pit is lit; the near one hides its floor.
        deep = inside / max(solid.radius, 1e-9)
        wall = clamp01((hit.x - solid.x) / max(solid.radius, 1e-9)) * (1.0 - deep)
        paint = mix(scale(tone, 0.12 + 0.75 * wall), ink(scene.inks, Ink.STEEL), rim)
        return Surface(nx, ny, nz, paint, scale(tone, 0.04 + 0.25 * wall), 0.02 + 0.45 * rim, rim)
    if solid.material == Material.BLADE:
        foot = (hit.x - solid.x0) * solid.along_x0 + (hit.z - solid.z0) * solid.along_z0
        band = coverage(abs(foot - 0.5 * solid.length0) - 0.16 * solid.length0, pixel)
        white = mix(tone, (1.0, 1.0, 1.0), 0.8)
        return Surface(nx, ny, nz, mix(tone, white, band), scale(mix(tone, white, band), 0.10), 0.2, 0.2)
    # The mouth of a passage: arrows across the line
    along = (hit.x - solid.x0) * solid.along_x0 + (hit.z - solid.z0) * solid.along_z0
    across = (hit.x - solid.x0) * solid.inward_x + (hit.z - solid.z0) * solid.inward_z
    step = 0.3 * unit
    place = (along + abs(across)) / step
    arrow = coverage((abs(place - place // 1.0 - 0.5) - 0.25) * step, pixel)
    return Surface(nx, ny, nz, scale(tone, 0.25 + 0.6 * arrow), scale(tone, 0.30 * arrow), 0.06, 0.0)
