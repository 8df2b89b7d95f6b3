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

On a table with friction the surfaces rub too; see friction.py.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.friction import rub_balls, rub_surface
from silverball.physics.kernel import inlined, internal
from silverball.physics.records import Contact
from silverball.physics.tolerances import CAP_MARGIN, HOP, HOP_SHARE, LEAST_HOP


@inlined
def restitution_at(e0: float, falloff: float, speed: float) -> float:
    """Restitution of an impact:  e = e₀ / (1 + k·w)."""
    return e0 / (1.0 + falloff * speed)


@inlined
def hop_speed(acceleration: float, hit_speed: float) -> float:
    """Least speed [u/s] after a touch: a hop of height HOP under this acceleration [u/s²].

    A hop must come back as a touch, or a ball at rest would score; so it stays below the speed of a hit.
    Where nothing pulls it is LEAST_HOP.
    """
    return max(min(sqrt(2.0 * acceleration * HOP), HOP_SHARE * hit_speed), LEAST_HOP)


@inlined
def capped(vx: float, vz: float, cap: float) -> tuple[float, float]:
    """A velocity, its size at most the cap [u/s], its direction kept."""
    square = vx * vx + vz * vz
    if square <= cap * cap:
        return vx, vz
    scale = cap / sqrt(square) * CAP_MARGIN
    return vx * scale, vz * scale


@inlined
def capped_along(vx: float, vz: float, nx: float, nz: float, cap: float) -> tuple[float, float]:
    """A velocity, its size at most the cap, cut from the part along the surface first.

    The ball must still leave the moving paddle that it has met. A table is only valid when every paddle's tip
    is slower than the cap, hop included; so the normal part may be cut to the cap itself.
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
    ball: Any, board: Any, c: Any, contact: Contact, ux: float, uz: float, acceleration: float
) -> float:
    """Give a ball the velocity and spin after its contact with a surface that moves with (ux, uz).

    `acceleration` [u/s²] sets the hop: gravity, and what a turning surface adds.

    Returns:
        The speed of the approach [u/s].
    """
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (ball.vx - ux) + nz * (ball.vz - uz))
    rebound = approach * restitution_at(c.restitution, c.restitution_falloff, approach)
    factor = c.speed_factor
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(acceleration, board.hit_speed))
        factor = 1.0
    push = approach + rebound
    if board.friction != 0.0:
        rub_surface(ball, board, nx, nz, ux, uz, push)
    vx = (ball.vx + push * nx) * factor
    vz = (ball.vz + push * nz) * factor
    if ux == 0.0 and uz == 0.0:
        ball.vx, ball.vz = capped(vx, vz, board.speed_cap)
    else:
        ball.vx, ball.vz = capped_along(vx, vz, nx, nz, board.speed_cap)
    return approach


@internal
def exchange(a: Any, b: Any, board: Any, contact: Contact) -> float:
    """Give two balls of equal mass the velocities and spins after their contact.

    Along the line of centres, from b to a, each takes half of (1 + e)·w.

    Returns:
        The speed w of the approach [u/s].
    """
    nx, nz = contact.nx, contact.nz
    approach = -(nx * (a.vx - b.vx) + nz * (a.vz - b.vz))
    rebound = approach * board.ball_restitution
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(board.gravity, board.hit_speed))
    push = 0.5 * (approach + rebound)
    if board.friction != 0.0:
        rub_balls(a, b, board, nx, nz, push)
    a.vx, a.vz = capped(a.vx + push * nx, a.vz + push * nz, board.speed_cap)
    b.vx, b.vz = capped(b.vx - push * nx, b.vz - push * nz, board.speed_cap)
    return approach


@internal
def bounce_off_held(ball: Any, board: Any, nx: float, nz: float) -> float:
    """Give a ball the velocity and spin after its contact with one that is held, along (nx, nz) from it.

    Returns:
        The speed of the approach [u/s].
    """
    approach = -(nx * ball.vx + nz * ball.vz)
    rebound = approach * board.ball_restitution
    if approach <= board.hit_speed:
        rebound = max(rebound, hop_speed(board.gravity, board.hit_speed))
    push = approach + rebound
    if board.friction != 0.0:
        rub_surface(ball, board, nx, nz, 0.0, 0.0, push)
    ball.vx, ball.vz = capped(ball.vx + push * nx, ball.vz + push * nz, board.speed_cap)
    return approach
