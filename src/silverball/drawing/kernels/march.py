"""Ray marching: the first surface on a ray, soft shadows, and ambient visibility.

A ray advances by the distance to the nearest surface until that is zero (sphere tracing), so no step can pass
a surface. The intersection with the playfield, a plane, is computed in closed form.
"""

from __future__ import annotations

from silverball.drawing.kernels.solids import apron_distance, cell_at, rail_distance, solid_distance
from silverball.drawing.kernels.stage import APRON, FLOOR, RAIL, ROOM, Scene
from silverball.physics.kernel import internal

STEPS = 72  # upper limit of steps of a ray
GAP = 0.0012  # [u] at which a ray has arrived; 1/15 pixel of a picture 1152 pixels high
SHADOW_STEPS = 22
SHADOW_SHARPNESS = 9.0  # of the penumbra: higher values give harder shadows
OCCLUSION_REACH = 0.42  # [u]
BELOW = -1.2  # [u] height of the room's floor


@internal
def nearest_part(scene: Scene, x: float, y: float, z: float) -> tuple[float, int]:
    """Return the distance of the nearest surface, at most the stage's `near`, and the number of its solid."""
    s = scene.stage[0]
    best, part = rail_distance(s, x, y, z), RAIL
    apron = apron_distance(s, x, y, z)
    if apron < best:
        best, part = apron, APRON
    cell = cell_at(s, x, z)
    for place in range(scene.near[cell], scene.near[cell + 1]):
        index = scene.near[place]
        solid = scene.solids[index]
        dx, dz, reach = x - solid.x, z - solid.z, best + solid.cull
        if y - solid.top >= best or dx * dx + dz * dz > reach * reach:
            continue  # nothing of it is nearer
        d = solid_distance(scene.corners, solid, x, y, z)
        if d < best:
            best, part = d, index
    return min(best, s.near), part


@internal
def trace(
    scene: Scene, x: float, y: float, z: float, dx: float, dy: float, dz: float, limit: float
) -> tuple[float, int]:
    """Return the distance to the first surface on a ray, up to `limit`, and the number of its solid.

    The number is ROOM for a ray that leaves the table or meets nothing within the limit.
    """
    s = scene.stage[0]
    t = 0.0
    if dy < 0.0:
        if y > s.top:
            t = (s.top - y) / dy
        floor = -y / dy
        at_x, at_z = x + floor * dx, z + floor * dz
        is_inside = abs(at_x) < s.half_length + s.rail and abs(at_z) < s.half_width + s.rail
        if is_inside and floor < limit:
            end, end_part = floor, FLOOR
        else:
            end, end_part = min(limit, (BELOW * s.unit - y) / dy), ROOM
    else:
        end, end_part = limit, ROOM
        if dy > 0.0:
            end = min(end, (s.top - y) / dy)
    for _ in range(STEPS):
        gap, part = nearest_part(scene, x + t * dx, y + t * dy, z + t * dz)
        if gap < GAP * s.unit:
            return t, part
        t += gap
        if t >= end:
            return end, end_part
    return t, part


@internal
def lamp_visibility(scene: Scene, x: float, y: float, z: float) -> float:
    """Return how much of the lamp is visible from a point, 0 to 1, with soft shadows.

    A ray to the lamp that passes a part at distance d, after a path t, is dimmed to about k·d/t, so
    the shadow of a farther part is softer. Source: I. Quilez, "soft shadows in raymarched SDFs", 2010.
    """
    s = scene.stage[0]
    light, t = 1.0, 0.03 * s.unit
    for _ in range(SHADOW_STEPS):
        gap, _part = nearest_part(scene, x + t * s.light_x, y + t * s.light_y, z)
        light = min(light, SHADOW_SHARPNESS * gap / t)
        t += max(gap, 0.03 * s.unit)
        if light < 0.005 or y + t * s.light_y > s.top:
            break
    light = min(max(light, 0.0), 1.0)
    return light * light * (3.0 - 2.0 * light)


@internal
def ambient_visibility(scene: Scene, x: float, y: float, z: float, nx: float, ny: float, nz: float) -> float:
    """Return how much of the ambient light reaches a point, 0 to 1 (1 − ambient occlusion).

    Along the normal the distance to the nearest part should grow as fast as the path; the difference is
    occluded. Source: A. Evans, "Fast approximations for global illumination on dynamic scenes", 2006.
    """
    s = scene.stage[0]
    covered, weight = 0.0, 1.0
    for step in range(1, 5):
        t = step * 0.25 * OCCLUSION_REACH * s.unit
        above = y + t * ny
        gap, _part = nearest_part(scene, x + t * nx, above, z + t * nz)
        gap = min(gap, above)
        covered += weight * max(t - gap, 0.0) / (OCCLUSION_REACH * s.unit)
        weight *= 0.72
    return min(max(1.0 - 1.05 * covered, 0.0), 1.0)
