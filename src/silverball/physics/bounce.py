"""The effect of a contact on a ball's velocity and spin.

One rule holds for every collider: with the approach speed w = −n·(v − u) relative to the surface's own
velocity u, the ball leaves with

    v′ = v + (w + e·w)·n,     e = e₀ / (1 + k·w).

The restitution e₀ falls with the speed of the impact by the part's `restitution_falloff` k: real rubber rings
return less of a hard hit than of a soft one. Source of the law: the "elasticity falloff" in tables of the
Visual Pinball simulator. k = 0 gives Newton's law of restitution.

Above `hit_speed` a contact is a *hit*: the part's `speed_factor` multiplies the whole velocity, and points
are scored. Below it is a *touch*, which leaves at least the hop speed √(2·A·HOP): a ball at rest hops 5e-4 u
high instead of bouncing without end. The kinetic energy that a hop can add is at most ½·(hop speed)², that is
A·HOP: 0.005 u²/s² on a stationary part at gravity 10.

On a table with friction the contact also changes the spin; see `friction.py`.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.friction import apply_ball_friction, apply_surface_friction
from silverball.physics.kernel import inlined, internal
from silverball.physics.records import BallRecord, BoardRecord, ColliderRecord, Contact
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
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(acceleration, board.hit_speed))
        factor = 1.0
    normal_impulse = approach + rebound
    if board.friction != 0.0:
        apply_surface_friction(ball, board, nx, nz, ux, uz, normal_impulse)
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
        apply_surface_friction(ball, board, nx, nz, 0.0, 0.0, normal_impulse)
    ball.vx, ball.vz = clamp_speed(
        ball.vx + normal_impulse * nx, ball.vz + normal_impulse * nz, board.speed_cap
    )
    return approach
