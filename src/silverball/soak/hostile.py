"""Hostile boards: tables that break every rule of placement, to test the solver where it is weakest.

Their parts overlap, touch, leave gaps of just a ball's width or just less, obstruct the paddles, are as
thin as a hair, or return a ball faster than it came. None of them passes `check_table`, and on none may a
ball ever get inside anything, or off the board.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import NamedTuple

from silverball.table import Board, Cylinder, Paddle, SlantWall, Table, TriangularPrism

MIN_FEATURES, MAX_FEATURES = 4, 12
HAIR = (1e-4, 1e-3, 1e-2, 0.05)  # [u] widths of thin parts, and clearances in narrow places

Part = SlantWall | TriangularPrism | Cylinder


class _Site(NamedTuple):
    """Where the next feature goes: its random generator, the board, the paddles, and a place (x, z) [u]."""

    pick: random.Random
    board: Board
    paddles: tuple[Paddle, ...]
    x: float
    z: float


def hostile_table(seed: int) -> Table:
    """The hostile board of a seed; the same seed always gives the same one."""
    pick = random.Random(seed)
    board = hostile_board(pick)
    paddles = _paddles(pick, board)
    parts: list[Part] = []
    for _ in range(pick.randint(MIN_FEATURES, MAX_FEATURES)):
        x = pick.uniform(-4.0, 0.5 * board.length)
        z = pick.uniform(-0.5, 0.5) * board.width
        parts += pick.choice(FEATURES)(_Site(pick, board, paddles, x, z))
    return Table(
        name=f"Hostile {seed}",
        board=board,
        paddle=paddles,
        slant_wall=tuple(part for part in parts if isinstance(part, SlantWall)),
        triangular_prism=tuple(part for part in parts if isinstance(part, TriangularPrism)),
        cylinder=tuple(part for part in parts if isinstance(part, Cylinder)),
    )


def hostile_board(pick: random.Random) -> Board:
    """A board with extreme values."""
    friction = pick.choice((0.0, 0.0, 0.02, 0.2, 1.0))
    return Board(
        friction=friction,
        rolling=friction > 0.0 and pick.random() < 0.7,
        slope=pick.uniform(2.0, 20.0),
        length=pick.uniform(12.0, 24.0),
        width=pick.uniform(7.0, 14.0),
        gravity=pick.choice((0.5, 3.0, 10.0, 20.0)),
        ball_radius=pick.choice((0.1, 0.2, 0.25, 0.25, 0.4)),
        ball_restitution=pick.choice((0.0, 0.5, 0.95, 1.0)),
        jitter=pick.uniform(0.0, 6.0),
        gutter=-5.5,
        wall_thickness=pick.choice((0.0, 0.1, 0.5)),
        wall_restitution=pick.choice((0.0, 0.8, 1.0)),
        speed_cap=pick.uniform(22.0, 60.0),
    )


def _paddles(pick: random.Random, board: Board) -> tuple[Paddle, ...]:
    """Two paddles, or one, or none; their tips may meet."""
    apart = pick.uniform(1.5, 0.5 * board.width - 0.5)
    rest = pick.uniform(-30.0, 10.0)
    shape = {
        "length": pick.uniform(1.0, 2.2),
        "base": pick.uniform(0.05, 1.0),
        "rest_angle": rest,
        "up_angle": rest + pick.uniform(20.0, 60.0),
        "stroke": pick.uniform(0.12, 0.3),
        "return_stroke": pick.uniform(0.12, 0.3),
        "restitution": pick.choice((0.0, 0.5, 1.0)),
    }
    both = (
        Paddle(side="left", pivot=(-4.0, -apart), **shape),  # type: ignore[arg-type]
        Paddle(side="right", pivot=(-4.0, apart), **shape),  # type: ignore[arg-type]
    )
    return pick.choice((both, both, both, both[:1], both[1:], ()))


def _prism(site: _Site, x: float, z: float, size: float) -> TriangularPrism:
    return TriangularPrism(
        center=(x, z),
        size=size,
        rotation=site.pick.uniform(0.0, 120.0),
        restitution=site.pick.choice((0.0, 0.5, 1.0)),
        speed_factor=site.pick.choice((0.5, 1.0, 3.0)),
    )


def _cylinder(site: _Site, x: float, z: float, radius: float) -> Cylinder:
    return Cylinder(
        center=(x, z),
        radius=radius,
        restitution=site.pick.choice((0.0, 0.9, 1.0)),
        speed_factor=site.pick.choice((0.5, 1.0, 3.0)),
    )


def heap(site: _Site) -> list[Part]:
    """Prisms and cylinders that overlap one another."""
    parts: list[Part] = []
    for _ in range(site.pick.randint(2, 5)):
        x, z = site.x + site.pick.gauss(0.0, 0.7), site.z + site.pick.gauss(0.0, 0.7)
        make = site.pick.choice((_prism, _cylinder))
        parts.append(make(site, x, z, site.pick.uniform(0.3, 1.0)))
    return parts


def pocket(site: _Site) -> list[Part]:
    """A V of two slant walls, open at a random side, in which a ball gets stuck."""
    turn, half = site.pick.uniform(0.0, 2.0 * math.pi), site.pick.uniform(0.02, 0.6)
    long = site.pick.uniform(0.5, 2.5)
    return [
        SlantWall(
            start=(site.x, site.z),
            end=(site.x + long * math.sin(turn + side), site.z + long * math.cos(turn + side)),
            thickness=site.pick.choice((0.0, 0.1)),
            restitution=site.pick.choice((0.0, 0.7, 1.0)),
        )
        for side in (half, -half)
    ]


def gate(site: _Site) -> list[Part]:
    """Two cylinders, a ball's width apart: a hair more, a hair less, or nothing but rounding."""
    radius, turn = site.pick.uniform(0.2, 0.8), site.pick.uniform(0.0, math.pi)
    clearance = site.pick.choice((0.0, *HAIR, *(-width for width in HAIR)))
    apart = 2.0 * radius + 2.0 * site.board.ball_radius + clearance
    x, z = site.x + apart * math.sin(turn), site.z + apart * math.cos(turn)
    return [_cylinder(site, site.x, site.z, radius), _cylinder(site, x, z, radius)]


def sliver(site: _Site) -> list[Part]:
    """A prism as thin as a hair, or a wall without thickness."""
    turn, long = site.pick.uniform(0.0, 2.0 * math.pi), site.pick.uniform(0.3, 3.0)
    x, z = site.x + long * math.sin(turn), site.z + long * math.cos(turn)
    if site.pick.random() < 0.5:
        return [SlantWall(start=(site.x, site.z), end=(x, z), thickness=0.0)]
    share, wide = site.pick.random(), site.pick.choice(HAIR)
    third = (
        site.x + share * (x - site.x) + wide * math.cos(turn),
        site.z + share * (z - site.z) - wide * math.sin(turn),
    )
    return [TriangularPrism(vertices=((site.x, site.z), (x, z), third))]


def at_border(site: _Site) -> list[Part]:
    """A cylinder that touches a border, cuts it, or leaves a narrow gap."""
    radius, side = site.pick.uniform(0.2, 1.0), site.pick.choice((-1.0, 1.0))
    widths = (-radius, *(-width for width in HAIR), 0.0, *HAIR, 2.0 * site.board.ball_radius)
    clearance = site.pick.choice(widths)
    z = side * (0.5 * site.board.width - site.board.wall_thickness - radius - clearance)
    return [_cylinder(site, site.x, z, radius)]


def guide(site: _Site) -> list[Part]:
    """A wall from a border down to a paddle, and a prism with a corner on it."""
    side = site.pick.choice((-1.0, 1.0))
    start = (site.pick.uniform(-3.0, 0.0), side * 0.5 * site.board.width)
    end = (site.pick.uniform(-4.2, -3.6), side * site.pick.uniform(0.2, 0.4) * site.board.width)
    share = site.pick.random()
    x, z = start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
    size = site.pick.uniform(0.2, 1.0)
    corners = ((x, z), (x + size, z - side * site.pick.uniform(0.0, size)), (x + 0.5 * size, z - side * size))
    return [SlantWall(start=start, end=end), TriangularPrism(vertices=corners)]


def in_the_way(site: _Site) -> list[Part]:
    """A part within a paddle's sweep, so that a ball can be pinched between them."""
    if not site.paddles:
        return heap(site)
    paddle = site.pick.choice(site.paddles)
    turn = math.radians(site.pick.uniform(paddle.rest_angle - 30.0, paddle.up_angle + 30.0))
    far = site.pick.uniform(0.3, 1.3) * paddle.length
    side = 1.0 if paddle.side == "left" else -1.0
    x = paddle.pivot[0] + far * math.sin(turn)
    z = paddle.pivot[1] + side * far * math.cos(turn)
    return [site.pick.choice((_prism, _cylinder))(site, x, z, site.pick.uniform(0.1, 0.5))]


def twins(site: _Site) -> list[Part]:
    """The same part twice, in the same place."""
    part = site.pick.choice((_prism, _cylinder))(site, site.x, site.z, site.pick.uniform(0.2, 0.8))
    return [part, part]


FEATURES: tuple[Callable[[_Site], list[Part]], ...] = (
    heap,
    pocket,
    gate,
    sliver,
    at_border,
    guide,
    in_the_way,
    twins,
)
