"""Reference: flights and bounces of a ball in 50 digits, derived independently of the solver.

The centre of a ball of radius r that touches a part lies on the part's outline offset by r: straight pieces
and arcs. Between bounces the centre follows a parabola p(t) = p₀ + v₀t + ½at², so it meets

* a straight piece q + s·u with normal n where n·(p(t) − q) = R, a quadratic in t, if the foot u·(p − q) lies
  on the piece;
* an arc around c where |p(t) − c|² = R², a polynomial of degree four in t.

All roots are found. At the earliest one at which the ball approaches, the velocity is reflected with the
part's restitution. There is no stepwise search and no code in common with `silverball.physics`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from silverball.table import Table

DIGITS = 50
MIN_SEPARATION = 1e-4  # [s] of roots that double precision separates; it finds a double root to 1e-8
SPARE_DIGITS = 30  # in the calculation; every bounce off something round loses a few


class Piece(NamedTuple):
    """Straight piece of an outline, from q along u, with the outward normal n.

    Attributes:
        length: Length [u]; None for an infinite piece.
        gap: R, the distance of the ball's centre from the line at contact [u].
    """

    q: tuple[Any, Any]
    u: tuple[Any, Any]
    n: tuple[Any, Any]
    length: Any
    gap: Any
    restitution: Any


class Arc(NamedTuple):
    """Round piece of an offset outline: centre c and radius [u]."""

    c: tuple[Any, Any]
    radius: Any
    restitution: Any


class Bounce(NamedTuple):
    """A bounce: its time [s], the speed along the normal [u/s], and its share of the speed."""

    time: Any
    approach: Any
    share: Any


class Path(NamedTuple):
    """A ball's path: the flights as (start time [s], x, z [u], vx, vz [u/s]), and the bounce after each."""

    flights: list[tuple[Any, Any, Any, Any, Any]]
    bounces: list[Bounce]
    gravity: Any

    def position(self, time: Any) -> tuple[Any, Any]:
        """The centre (x, z) [u] at a time [s] before the end of the last flight."""
        t0, x, z, vx, vz = max((flight for flight in self.flights if flight[0] <= time), key=lambda f: f[0])
        h = mpmath.mpf(time) - t0
        return x + vx * h - self.gravity * h * h / 2, z + vz * h


def follow(
    table: Table, start: tuple[float, float, float, float], bounces: int, digits: int = DIGITS
) -> Path:
    """Follow a ball from (x, z, vx, vz) [u, u/s] over a number of bounces.

    Args:
        table: A plain table; its paddles stay at rest.
        start: Position and velocity at time 0, clear of everything.
        bounces: Number of bounces; the path ends early if the ball hits nothing any more.
        digits: Correct decimal digits.
    """
    with mpmath.workdps(digits + SPARE_DIGITS):
        outline = list(pieces(table))
        gravity = mpmath.mpf(table.board.gravity)
        x, z, vx, vz = map(mpmath.mpf, start)
        time = mpmath.mpf(0)
        path = Path([(time, x, z, vx, vz)], [], gravity)
        for _ in range(bounces):
            found = [
                (when, n, piece.restitution)
                for piece in outline
                for when, n in contacts(piece, x, z, vx, vz, gravity)
            ]
            if not found:
                break
            h, (nx, nz), restitution = min(found, key=lambda meeting: meeting[0])
            x, z = x + vx * h - gravity * h * h / 2, z + vz * h
            vx -= gravity * h
            approach = -(nx * vx + nz * vz)
            path.bounces.append(Bounce(time + h, approach, approach / mpmath.hypot(vx, vz)))
            vx += (1 + restitution) * approach * nx
            vz += (1 + restitution) * approach * nz
            time += h
            path.flights.append((time, x, z, vx, vz))
        return path


def contacts(
    piece: Piece | Arc, x: Any, z: Any, vx: Any, vz: Any, gravity: Any
) -> Iterator[tuple[Any, tuple[Any, Any]]]:
    """Times [s] from now at which a flight enters a piece, with the normal there."""
    if isinstance(piece, Piece):
        (nx, nz), (qx, qz) = piece.n, piece.q
        polynomial = [nx * (x - qx) + nz * (z - qz) - piece.gap, nx * vx + nz * vz, -gravity * nx / 2]
    else:
        cx, cz = piece.c
        dx, dz = x - cx, z - cz
        # |d + v·t + ½a·t²|² − R², with a = (−g, 0)
        polynomial = [
            dx * dx + dz * dz - piece.radius**2,
            2 * (dx * vx + dz * vz),
            vx * vx + vz * vz - gravity * dx,
            -gravity * vx,
            gravity * gravity / 4,
        ]
    for h in positive_roots(polynomial):
        center = (x + vx * h - gravity * h * h / 2, z + vz * h)
        if isinstance(piece, Piece):
            foot = piece.u[0] * (center[0] - piece.q[0]) + piece.u[1] * (center[1] - piece.q[1])
            if piece.length is not None and not 0 <= foot <= piece.length:
                continue
            normal = piece.n
        else:
            normal = ((center[0] - piece.c[0]) / piece.radius, (center[1] - piece.c[1]) / piece.radius)
        if normal[0] * (vx - gravity * h) + normal[1] * vz < 0:
            yield h, normal


def positive_roots(polynomial: list[Any]) -> Iterator[Any]:
    """The positive real roots of a polynomial, lowest power first.

    They are found in double precision first. Well separated roots are refined to all digits by Newton's
    method; if two nearly coincide (a grazing contact), all are found in all digits. A root that is zero up to
    rounding is the bounce just made.
    """
    while polynomial and polynomial[-1] == 0:
        polynomial = polynomial[:-1]
    if len(polynomial) < 2:
        return
    small = mpmath.mpf(10) ** (-mpmath.mp.dps // 2)
    rough = np.roots([float(coefficient) for coefficient in reversed(polynomial)])
    if is_clear(rough):
        roots = [
            polished(polynomial, root.real)
            for root in rough
            if root.imag == 0 and root.real > -MIN_SEPARATION
        ]
    else:
        extra = 2 * mpmath.mp.prec
        found = mpmath.polyroots(polynomial, maxsteps=500, extraprec=extra, asc=True)
        roots = [mpmath.re(root) for root in found if abs(mpmath.im(root)) < small]
    yield from (root for root in roots if root > small)


def is_clear(roots: NDArray[Any]) -> bool:
    """Whether roots in double precision are so far apart that each is near one true root."""
    return all(abs(a - b) > MIN_SEPARATION for index, a in enumerate(roots) for b in roots[:index])


def polished(polynomial: list[Any], root: float) -> Any:
    """A single root in all digits, by Newton's rule, which doubles the right digits every time."""
    slope = [power * coefficient for power, coefficient in enumerate(polynomial)][1:]
    exact, digits = mpmath.mpf(root), 2.0
    while digits < 2 * mpmath.mp.dps:
        exact -= value(polynomial, exact) / value(slope, exact)
        digits *= 2
    return exact


def value(polynomial: list[Any], at: Any) -> Any:
    """The value of a polynomial, lowest power first."""
    total = mpmath.mpf(0)
    for coefficient in reversed(polynomial):
        total = total * at + coefficient
    return total


def pieces(table: Table) -> Iterator[Piece | Arc]:
    """The outlines of all parts, grown by the ball's radius, paddles at rest."""
    b = table.board
    number = mpmath.mpf
    radius, rim = number(b.ball_radius), number(b.wall_thickness)
    e = number(b.wall_restitution)
    side, top = number(b.width) / 2 - rim, number(b.length) / 2 - rim
    yield Piece((number(0), -side), (number(1), number(0)), (number(0), number(1)), None, radius, e)
    yield Piece((number(0), side), (number(1), number(0)), (number(0), number(-1)), None, radius, e)
    yield Piece((top, number(0)), (number(0), number(1)), (number(-1), number(0)), None, radius, e)
    for wall in table.slant_wall:
        ends = [tuple(map(number, end)) for end in (wall.start, wall.end)]
        # There and back: a wall has two sides.
        yield from polygon([*ends], number(wall.thickness) + radius, number(wall.restitution))
    for prism in table.triangular_prism:
        yield from polygon(
            [tuple(map(number, corner)) for corner in prism.corners()], radius, number(prism.restitution)
        )
    for paddle in table.paddle:
        corners = [tuple(map(number, corner)) for corner in paddle.corners(paddle.rest_angle)]
        yield from polygon(corners, radius, number(paddle.restitution))
    for cylinder in table.cylinder:
        x, z, r = map(number, cylinder.circle())
        yield Arc((x, z), r + radius, number(cylinder.restitution))


def polygon(corners: list[Any], gap: Any, restitution: Any) -> Iterator[Piece | Arc]:
    """The sides and corners of a polygon whose corners run counter-clockwise (z right, x up)."""
    for (px, pz), (qx, qz) in zip(corners, [*corners[1:], corners[0]], strict=True):
        wx, wz = qx - px, qz - pz
        length = mpmath.hypot(wx, wz)
        u = (wx / length, wz / length)
        # Outward is to the right of the way round: in (z, x), the direction turned clockwise.
        yield Piece((px, pz), u, (-u[1], u[0]), length, gap, restitution)
        yield Arc((px, pz), gap, restitution)
