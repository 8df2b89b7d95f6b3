"""The effect of a contact on a ball's velocity and spin.

One rule holds for every collider: with the approach speed w = −n·(v − u) relative to the surface's own
velocity u, the ball leaves with

    v′ = v + (w + e·w)·n,     e = e₀ / (1 + k·w).

The restitution e₀ falls with the speed of the impact by the part's `restitution_falloff` k: real rubber rings
return less of a hard hit than of a soft one. Source of the law: the "elasticity falloff" in tables of the
Visual Pinball simulator. k = 0 gives Newton's law of restitution.

Above `hit_speed` a contact is a *hit*: the part's `kick` is added to the speed along n, its `speed_factor`
multiplies the whole velocity, and points are scored. A kick may fall off towards the ends of a capsule or arc
as 1 − ξ², ξ = −1 … 1: the rubber of a slingshot. Below it is a *touch*, which leaves at least the hop speed
√(2·A·HOP): a ball at rest hops 5e-4 u high instead of bouncing without end. The kinetic energy that a hop can
add is at most ½·(hop speed)², that is A·HOP: 0.005 u²/s² on a stationary part at gravity 10. A is gravity,
and what a turning surface or the inside of a curve adds.

A turning paddle may have a mass m, in balls. A free rod with the length L and the moment of inertia m·L²/3
would take the impulse × 1/(1 + 3·r²/(m·L²)) at the distance r from its pivot, so this is the impulse here.
The paddle's motion is prescribed, so the ball keeps at least the hop speed relative to it. At its stop a
paddle is rigid.

Where a part has friction the contact also changes the spin; see `friction.py`.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.friction import apply_ball_friction, apply_surface_friction
from silverball.physics.kernel import inlined, internal
from silverball.physics.records import BallRecord, BoardRecord, ColliderRecord, Contact, KickProfile, Shape
from silverball.physics.shapes import is_beside_arc
from silverball.physics.tolerances import CAP_MARGIN, HOP, HOP_SHARE, MIN_HOP_SPEED


@inlined
def restitution_at(e0: float, falloff: float, speed: float) -> float:
    """Compute the restitution of an impact:  e = e₀ / (1 + k·w)."""
    return e0 / (1.0 + falloff * speed)


@inlined
def hop_speed(acceleration: float, hit_speed: float) -> float:
    """Compute the smallest speed [u/s] after a touch: a hop of height HOP under this acceleration [u/s²].

    A hop must come back as a touch, or a ball at rest would score. So it stays below the speed of a hit.
    Without acceleration it is MIN_HOP_SPEED.
    """
    return max(min(sqrt(2.0 * acceleration * HOP), HOP_SHARE * hit_speed), MIN_HOP_SPEED)


@inlined
def clamp_speed(vx: float, vz: float, cap: float) -> tuple[float, float]:
    """Limit the size of a velocity to the cap [u/s] and keep its direction."""
    square = vx * vx + vz * vz
    if square <= cap * cap:
        return vx, vz
    scale = cap / sqrt(square) * CAP_MARGIN
    return vx * scale, vz * scale


@inlined
def clamp_speed_along(vx: float, vz: float, nx: float, nz: float, cap: float) -> tuple[float, float]:
    """Limit the size of a velocity to the cap [u/s] by reducing the component along the surface first.

    The ball must still leave the moving paddle that it has met. In a valid table every paddle's tip is slower
    than the cap, hop included, so the normal part may be cut to the cap itself.
    """
    square = vx * vx + vz * vz
    if square <= cap * cap:
        return vx, vz
    out = nx * vx + nz * vz
    along = nx * vz - nz * vx
    top = cap * CAP_MARGIN
    out = min(max(out, -top), top)
    rest = sqrt(max(0.0, top * top - out * out))
    along = min(max(along, -rest), rest)
    return nx * out - nz * along, nz * out + nx * along


@inlined
def kick_at(c: ColliderRecord, x: float, z: float) -> float:
    """Compute the kick [u/s] of a part at the place (x, z) of its surface."""
    if c.kick_profile == KickProfile.FLAT:
        return c.kick
    wx, wz = c.x1 - c.x0, c.z1 - c.z0
    place = 2.0 * ((x - c.x0) * wx + (z - c.z0) * wz) / (wx * wx + wz * wz) - 1.0
    return c.kick * max(0.0, 1.0 - place * place)


@internal
def curve_acceleration(c: ColliderRecord, ball: BallRecord, nx: float, nz: float) -> float:
    """Compute the acceleration [u/s²] of the gap of a ball that runs along the inside of an arc:  v²/ρ."""
    to_center = nx * (c.x2 - ball.x) + nz * (c.z2 - ball.z)
    if to_center <= 0.0 or not is_beside_arc(c, ball.x, ball.z):
        return 0.0
    along = nx * ball.vz - nz * ball.vx
    return along * along / to_center


@inlined
def recoil_share(c: ColliderRecord, x: float, z: float) -> float:
    """Compute the share of an impulse that a paddle with a mass gives at (x, z):  1 / (1 + 3·r²/(m·L²))."""
    rx, rz = x - c.x, z - c.z
    return 1.0 / (1.0 + c.recoil * (rx * rx + rz * rz))


@internal
def bounce(
    ball: BallRecord,
    board: BoardRecord,
    c: ColliderRecord,
    contact: Contact,
    ux: float,
    uz: float,
    acceleration: float,
) -> float:
    """Set a ball's velocity and spin after its contact with a surface that moves with (ux, uz).

    `acceleration` [u/s²] sets the hop: gravity, and what a turning surface adds.

    Returns:
        The approach speed [u/s].
    """
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (ball.vx - ux) + nz * (ball.vz - uz))
    rebound = approach * restitution_at(c.restitution, c.restitution_falloff, approach)
    factor = c.speed_factor
    if approach <= c.hit_speed:
        if c.form == Shape.ARC:
            acceleration += curve_acceleration(c, ball, nx, nz)
        rebound = max(rebound, hop_speed(acceleration, c.hit_speed))
        factor = 1.0
    elif c.kick != 0.0:
        rebound += kick_at(c, ball.x - board.ball_radius * nx, ball.z - board.ball_radius * nz)
    if c.recoil != 0.0 and (ux != 0.0 or uz != 0.0):
        share = recoil_share(c, ball.x - board.ball_radius * nx, ball.z - board.ball_radius * nz)
        rebound = max((approach + rebound) * share - approach, hop_speed(acceleration, c.hit_speed))
    normal_impulse = approach + rebound
    if c.friction != 0.0:
        apply_surface_friction(ball, board, nx, nz, ux, uz, c.friction * normal_impulse)
    vx = (ball.vx + normal_impulse * nx) * factor
    vz = (ball.vz + normal_impulse * nz) * factor
    if ux == 0.0 and uz == 0.0:
        ball.vx, ball.vz = clamp_speed(vx, vz, board.speed_cap)
    else:
        ball.vx, ball.vz = clamp_speed_along(vx, vz, nx, nz, board.speed_cap)
    return approach


@internal
def bounce_balls(a: BallRecord, b: BallRecord, board: BoardRecord, contact: Contact) -> float:
    """Set the velocities and spins of two balls of equal mass after their contact.

    Along the line of centres, from b to a, each takes half of (1 + e)·w.

    Returns:
        The approach speed w [u/s].
    """
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (a.vx - b.vx) + nz * (a.vz - b.vz))
    rebound = approach * board.ball_restitution
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(board.gravity, board.hit_speed))
    normal_impulse = 0.5 * (approach + rebound)
    if board.friction != 0.0:
        apply_ball_friction(a, b, board, nx, nz, normal_impulse)
    a.vx, a.vz = clamp_speed(a.vx + normal_impulse * nx, a.vz + normal_impulse * nz, board.speed_cap)
    b.vx, b.vz = clamp_speed(b.vx - normal_impulse * nx, b.vz - normal_impulse * nz, board.speed_cap)
    return approach


@internal
def bounce_off_held(ball: BallRecord, board: BoardRecord, nx: float, nz: float) -> float:
    """Set a ball's velocity and spin after its contact with a held ball, from which (nx, nz) points away.

    Returns:
        The approach speed [u/s].
    """
    approach = -(nx * ball.vx + nz * ball.vz)
    rebound = approach * board.ball_restitution
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(board.gravity, board.hit_speed))
    normal_impulse = approach + rebound
    if board.friction != 0.0:
        apply_surface_friction(ball, board, nx, nz, 0.0, 0.0, board.friction * normal_impulse)
    ball.vx, ball.vz = clamp_speed(
        ball.vx + normal_impulse * nx, ball.vz + normal_impulse * nz, board.speed_cap
    )
    return approach
