"""What does a contact do to a ball?

One rule for every collider: with the approach speed w = −n·(v − u) relative to the surface's own velocity
u, the ball leaves with

    v′ = v + (w + e·w)·n,     e = e₀ / (1 + k·w).

The restitution e₀ falls with the speed of the impact by the part's `restitution_falloff` k: real rubber
rings return less of a hard hit than of a soft one. Source of the law: the "elasticity falloff" of the
Visual Pinball simulator's tables, from which its authors' flippers get their feel; k = 0 gives the plain
law of Newton's restitution.

Above `hit_speed` a contact is a *hit*: the part's `speed_factor` multiplies the whole velocity and points
are scored. Below it is a *touch*, which leaves at least the hop speed √(2·A·HOP): a ball at rest hops 5e-4
u high instead of bouncing without end. The kinetic energy that a hop can add is at most ½·(hop speed)²,
that is A·HOP, 0.005 u²/s² on a part that stands still at gravity 10.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import Ball, Contact
from silverball.physics.tolerances import CAP_MARGIN, HOP, HOP_SHARE


@inlined
def restitution_at(e0: float, falloff: float, speed: float) -> float:
    """Restitution of an impact:  e = e₀ / (1 + k·w)."""
    return e0 / (1.0 + falloff * speed)


@inlined
def hop_speed(acceleration: float, hit_speed: float) -> float:
    """Least speed [u/s] after a touch: a hop of height HOP under this acceleration [u/s²].

    A hop must come back as a touch, or a ball at rest would score; so it stays below the speed of a hit.
    """
    return min(sqrt(2.0 * acceleration * HOP), HOP_SHARE * hit_speed)


@inlined
def capped(ball: Ball, cap: float) -> Ball:
    """The ball with its speed at most the cap [u/s], its direction kept."""
    square = ball.vx * ball.vx + ball.vz * ball.vz
    if square <= cap * cap:
        return ball
    scale = cap / sqrt(square) * CAP_MARGIN
    return Ball(ball.x, ball.z, ball.vx * scale, ball.vz * scale, ball.id)


@kernel
def bounced(
    ball: Ball,
    contact: Contact,
    c: Any,
    ux: float,
    uz: float,
    acceleration: float,
    hit_speed: float,
    cap: float,
) -> tuple[Ball, float]:
    """The ball after its contact with a surface that moves with (ux, uz), and the speed of the approach."""
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (ball.vx - ux) + nz * (ball.vz - uz))
    rebound = approach * restitution_at(c.restitution, c.restitution_falloff, approach)
    if approach <= hit_speed:
        rebound = max(rebound, hop_speed(acceleration, hit_speed))
        factor = 1.0
    else:
        factor = c.speed_factor
    change = approach + rebound
    vx = (ball.vx + change * nx) * factor
    vz = (ball.vz + change * nz) * factor
    leaving = Ball(ball.x, ball.z, vx, vz, ball.id)
    if ux == 0.0 and uz == 0.0:
        return capped(leaving, cap), approach
    return capped_along(leaving, nx, nz, cap), approach


@inlined
def capped_along(ball: Ball, nx: float, nz: float, cap: float) -> Ball:
    """The ball with its speed at most the cap, cut from the tangential part first.

    It must still leave the moving paddle that it has met. A table is only valid when every paddle's tip is
    slower than the cap, hop included; so the normal part may be cut to the cap itself.
    """
    square = ball.vx * ball.vx + ball.vz * ball.vz
    if square <= cap * cap:
        return ball
    out = nx * ball.vx + nz * ball.vz
    along = nx * ball.vz - nz * ball.vx
    top = cap * CAP_MARGIN
    out = min(max(out, -top), top)
    rest = sqrt(max(0.0, top * top - out * out))
    along = min(max(along, -rest), rest)
    return Ball(ball.x, ball.z, nx * out - nz * along, nz * out + nx * along, ball.id)


@kernel
def exchanged(
    a: Ball, b: Ball, contact: Contact, restitution: float, acceleration: float, hit_speed: float, cap: float
) -> tuple[Ball, Ball, float]:
    """Two balls of equal mass after their contact, and the speed w of the approach.

    Along the line of centres, from b to a, each takes half of (1 + e)·w.
    """
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (a.vx - b.vx) + nz * (a.vz - b.vz))
    rebound = approach * restitution
    if approach <= hit_speed:
        rebound = max(rebound, hop_speed(acceleration, hit_speed))
    push = 0.5 * (approach + rebound)
    a = Ball(a.x, a.z, a.vx + push * nx, a.vz + push * nz, a.id)
    b = Ball(b.x, b.z, b.vx - push * nx, b.vz - push * nz, b.id)
    return capped(a, cap), capped(b, cap), approach
