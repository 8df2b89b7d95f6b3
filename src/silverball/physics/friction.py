"""Friction at a contact of a ball with a surface or another ball: Coulomb's law for one impact.

The contact pushes with the impulse P along the normal n (all impulses by the ball's mass, so in u/s). The
ball's surface slides over the other one with

    s = v − u + ω × (−r·n),    along t = (−n_z, n_x):  s_t = t·(v − u) + r·ω_y,
                               along y:                s_y = r·(ω_x·n_z − ω_z·n_x).

An impulse J along t changes s_t by 7/2·J (1 by the ball's speed, 5/2 by its spin) and ω_y by 5/(2r)·J. The
playfield fixes y: an impulse along y only turns the ball, and changes s_y by 5/2·J. The impulse that stops
the slip is J = −(s_t/(7/2), s_y/(5/2)). Friction is limited to μ·P; if J is larger, the impulse is μ·P
against the slip. Between two balls all factors are twice as large.

Energy never grows: sticking removes the slip's energy; a slipping contact, with |J| = μ·P below that of
sticking, so below |s|/(5/2), changes the energy by at most −|J|·|s| + ½·7/2·J² < 0.

Source: R. Cross, "Grip-slip behavior of a bouncing ball", American Journal of Physics 70 (2002), without the
grip's elasticity.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.kernel import inlined, internal
from silverball.physics.records import BallRecord, BoardRecord

ALONG_SHARE = 3.5  # slip along t changes by this times the impulse
UPRIGHT_SHARE = 2.5  # slip along y, where only the spin changes; also the spin's own share


@inlined
def _friction(slip_t: float, slip_y: float, ball_count: float, limit: float) -> tuple[float, float]:
    """Compute the friction impulses along t and y [u/s] between balls, at most `limit` in size."""
    jt = -slip_t / (ALONG_SHARE * ball_count)
    jy = -slip_y / (UPRIGHT_SHARE * ball_count)
    if jt * jt + jy * jy <= limit * limit:
        return jt, jy
    scale = -limit / sqrt(slip_t * slip_t + slip_y * slip_y)
    return scale * slip_t, scale * slip_y


@inlined
def _apply_friction_impulse(
    ball: BallRecord, curvature: float, nx: float, nz: float, jt: float, jy: float
) -> None:
    """Apply an impulse along t and y to a ball at the point −r·n of its surface."""
    gain = UPRIGHT_SHARE * curvature
    ball.vx -= jt * nz
    ball.vz += jt * nx
    ball.spin_x += gain * jy * nz
    ball.spin_y += gain * jt
    ball.spin_z -= gain * jy * nx


@internal
def apply_surface_friction(
    ball: BallRecord, board: BoardRecord, nx: float, nz: float, ux: float, uz: float, limit: float
) -> None:
    """Apply friction, at most `limit` [u/s], at a surface with velocity (ux, uz) and normal (nx, nz)."""
    radius = board.ball_radius
    slip_t = nx * (ball.vz - uz) - nz * (ball.vx - ux) + radius * ball.spin_y
    slip_y = radius * (ball.spin_x * nz - ball.spin_z * nx)
    jt, jy = _friction(slip_t, slip_y, 1.0, limit)
    _apply_friction_impulse(ball, board.curvature, nx, nz, jt, jy)


@internal
def apply_ball_friction(
    a: BallRecord, b: BallRecord, board: BoardRecord, nx: float, nz: float, normal_impulse: float
) -> None:
    """Apply friction between two balls that push each other along (nx, nz), from b to a.

    b's surface at the contact lies at +r·n, so its spin adds to a's; it takes the opposite impulse there,
    which turns it the same way as a.
    """
    radius = board.ball_radius
    slip_t = nx * (a.vz - b.vz) - nz * (a.vx - b.vx) + radius * (a.spin_y + b.spin_y)
    slip_y = radius * ((a.spin_x + b.spin_x) * nz - (a.spin_z + b.spin_z) * nx)
    jt, jy = _friction(slip_t, slip_y, 2.0, board.friction * normal_impulse)
    _apply_friction_impulse(a, board.curvature, nx, nz, jt, jy)
    gain = UPRIGHT_SHARE * board.curvature
    b.vx += jt * nz
    b.vz -= jt * nx
    b.spin_x += gain * jy * nz
    b.spin_y += gain * jt
    b.spin_z -= gain * jy * nx
