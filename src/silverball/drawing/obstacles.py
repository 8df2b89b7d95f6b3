"""The obstacles: how are prisms and cylinders painted, and how do they light up when hit?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from silverball.drawing import fields, palette
from silverball.drawing.camera import Camera, Patch
from silverball.drawing.canvas import facing, light, paint, shade, tone
from silverball.drawing.fields import Field
from silverball.drawing.palette import Color
from silverball.drawing.walls import cast_shadow, moved
from silverball.table import Cylinder, TriangularPrism

GLOW_REACH = 0.22  # [u] in which the light around a part falls to 1/e
PATCH_REACH = 1.1  # [u] beyond a part: there its light is below 1 %
HALO = 0.3  # [u] from a cylinder's surface to the ring of light on the floor
SPOKES = 8


def shadow_prism(canvas: NDArray[np.float32], camera: Camera, prism: TriangularPrism) -> None:
    """The shadow of a prism on the floor."""
    corners = prism.corners()
    patch = prism_patch(camera, prism)
    cast_shadow(canvas, patch, fields.polygon(patch.x, patch.z, tuple(moved(corner) for corner in corners)))


def paint_prism(canvas: NDArray[np.float32], camera: Camera, prism: TriangularPrism, color: Color) -> None:
    """A prism from above: three facets that rise to a flat top, and a glow in its colour."""
    patch = prism_patch(camera, prism)
    region, pixel = canvas[patch.rows_columns], patch.pixel
    distance = fields.polygon(patch.x, patch.z, prism.corners())
    light(region, color, 0.42 * fields.glow(distance, GLOW_REACH))
    mask = fields.cover(distance, pixel)
    paint(region, color, mask)
    bevel = min(0.17, 0.4 * _inner_radius(prism))
    facet = fields.cover(-distance - np.float32(bevel), pixel)
    shade(region, 0.62 * facing(*fields.slope(distance, pixel)), mask * facet)
    shade(region, np.full_like(distance, 0.06), mask * (1.0 - facet))
    shade(region, 0.4 * fields.ring(distance + np.float32(bevel), 0.5 * pixel, pixel), mask)
    shade(region, -0.4 * fields.ring(distance + np.float32(0.5 * pixel), 0.5 * pixel, pixel), mask)


def prism_flash(camera: Camera, prism: TriangularPrism, color: Color) -> tuple[Patch, NDArray[np.float32]]:
    """The light that a prism adds at the moment of a hit: where, and float RGB [row, column, 3]."""
    patch = prism_patch(camera, prism)
    distance = fields.polygon(patch.x, patch.z, prism.corners())
    glow = 0.75 * fields.glow(distance, 1.3 * GLOW_REACH)[..., None] * tone(color)
    core = 0.42 * fields.cover(distance, patch.pixel)[..., None] * tone(palette.LIGHT)
    return patch, _faded(patch, glow + core)


def shadow_cylinder(canvas: NDArray[np.float32], camera: Camera, cylinder: Cylinder) -> None:
    """The shadow of a cylinder on the floor."""
    x, z, radius = cylinder.circle()
    patch = cylinder_patch(camera, cylinder)
    cast_shadow(canvas, patch, fields.circle(patch.x, patch.z, moved((x, z)), radius))


def paint_cylinder(canvas: NDArray[np.float32], camera: Camera, cylinder: Cylinder, color: Color) -> None:
    """A cylinder from above: a steel ring, a cap with a star of light, a ring of light on the floor."""
    x, z, radius = cylinder.circle()
    patch = cylinder_patch(camera, cylinder)
    region, pixel = canvas[patch.rows_columns], patch.pixel
    distance = fields.circle(patch.x, patch.z, (x, z), radius)
    halo = np.abs(distance - np.float32(HALO))
    outside = 1.0 - fields.cover(distance, pixel)
    light(region, color, 0.5 * outside * fields.glow(halo, 0.16))
    paint(region, color, 0.9 * outside * fields.cover(halo - np.float32(0.03), pixel))
    _steel(region, patch, (x, z), radius, distance)
    _cap(region, patch, (x, z), 0.76 * radius, color)


def cylinder_flash(camera: Camera, cylinder: Cylinder, color: Color) -> tuple[Patch, NDArray[np.float32]]:
    """The light that a cylinder adds at the moment of a hit: where, and float RGB [row, column, 3]."""
    x, z, radius = cylinder.circle()
    patch = cylinder_patch(camera, cylinder)
    distance = fields.circle(patch.x, patch.z, (x, z), radius)
    halo = fields.glow(np.abs(distance - np.float32(HALO)), 0.24)[..., None] * tone(color)
    core = (
        0.65
        * fields.glow(distance + np.float32(0.35 * radius), 0.3 * radius)[..., None]
        * tone(palette.LIGHT)
    )
    return patch, _faded(patch, 0.9 * halo + core)


def prism_patch(camera: Camera, prism: TriangularPrism) -> Patch:
    """The pixels that a prism and its light may change."""
    corners = prism.corners()
    xs, zs = [corner[0] for corner in corners], [corner[1] for corner in corners]
    return camera.patch(
        min(xs) - PATCH_REACH, min(zs) - PATCH_REACH, max(xs) + PATCH_REACH, max(zs) + PATCH_REACH
    )


def cylinder_patch(camera: Camera, cylinder: Cylinder) -> Patch:
    """The pixels that a cylinder and its light may change."""
    x, z, radius = cylinder.circle()
    reach = radius + PATCH_REACH
    return camera.patch(x - reach, z - reach, x + reach, z + reach)


def _steel(
    region: NDArray[np.float32], patch: Patch, center: tuple[float, float], radius: float, distance: Field
) -> None:
    """A polished ring: what it mirrors changes with the direction."""
    mask = fields.cover(distance, patch.pixel)
    turn = np.arctan2(patch.x - center[0], patch.z - center[1])
    brightness = 0.5 + 0.34 * np.cos(2.0 * (turn - 2.2)) + 0.16 * np.cos(5.0 * turn + 1.0)
    steel = (0.16 + 0.84 * np.clip(brightness, 0.0, 1.0))[..., None] * tone(palette.STEEL)
    paint(region, steel.astype(np.float32), mask)
    inner = fields.ring(distance + np.float32(0.2 * radius), 0.06 * radius, patch.pixel)
    shade(region, -0.65 * inner, mask)
    shade(
        region,
        -0.45 * fields.ring(distance + np.float32(0.6 * patch.pixel), 0.5 * patch.pixel, patch.pixel),
        mask,
    )


def _cap(
    region: NDArray[np.float32], patch: Patch, center: tuple[float, float], radius: float, color: Color
) -> None:
    distance = fields.circle(patch.x, patch.z, center, radius)
    mask = fields.cover(distance, patch.pixel)
    paint(region, color, mask)
    across = 1.0 + distance / radius  # 0 in the middle, 1 at the edge
    turn = np.arctan2(patch.z - center[1], patch.x - center[0])
    blade = np.clip(0.5 + np.cos(SPOKES * turn) * (across + 0.05) * radius / (SPOKES * patch.pixel), 0.0, 1.0)
    band = fields.ring(distance + np.float32(0.45 * radius), 0.2 * radius, patch.pixel)
    paint(region, palette.LIGHT, 0.62 * blade.astype(np.float32) * band)
    shade(region, -0.55 * np.clip(across, 0.0, 1.0) ** 3, mask)
    paint(region, palette.LIGHT, fields.cover(distance + np.float32(0.8 * radius), patch.pixel))
    light(region, color, 0.5 * mask * fields.glow(np.abs(distance + np.float32(0.8 * radius)), 0.2 * radius))
    gleam_at = (center[0] + 0.42 * radius, center[1] - 0.36 * radius)
    gleam = fields.circle(patch.x, patch.z, gleam_at, 0.0)
    shade(region, (0.75 * np.exp(-((gleam / (0.3 * radius)) ** 2))).astype(np.float32), mask)


def _inner_radius(prism: TriangularPrism) -> float:
    """Radius [u] of the largest circle inside: twice the area over the girth."""
    (ax, az), (bx, bz), (cx, cz) = prism.corners()
    double_area = abs((bz - az) * (cx - ax) - (bx - ax) * (cz - az))
    girth = np.hypot(bx - ax, bz - az) + np.hypot(cx - bx, cz - bz) + np.hypot(ax - cx, az - cz)
    return float(double_area / girth)


def _faded(patch: Patch, flash: NDArray[np.float32]) -> NDArray[np.float32]:
    """A flash that is nothing at the patch's edges, so that its square does not show."""
    rows, columns = flash.shape[:2]
    down = np.minimum(np.arange(rows), np.arange(rows)[::-1])[:, None]
    right = np.minimum(np.arange(columns), np.arange(columns)[::-1])[None, :]
    fade = np.clip(np.minimum(down, right) * patch.pixel / 0.4, 0.0, 1.0)
    return (flash * fade[..., None]).astype(np.float32)
