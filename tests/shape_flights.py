"""Flights against arcs and paddles, as numbers in hexadecimal; run as a script it prints them."""

from __future__ import annotations

import json

import numpy as np

from rows_of import RADIUS, ball_at, first_meeting, first_touch, row_of
from silverball.physics.records import PaddleSweep, Shape
from silverball.physics.shapes import distance
from silverball.table.primitive import Mover, Primitive

ARCS = ((0.41421, 0.1), (-1.0, 0.05), (2.4, 0.08), (-0.002, 0.0))
SWEEPS = (
    PaddleSweep(-0.5, 0.0, 0.4, 2000.0),
    PaddleSweep(0.4, -9.0, -0.5, 0.0),
    PaddleSweep(0.1, 0.0, 0.1, 0.0),
)


def flights() -> list[str]:
    """Times and normals of contacts that are the same wherever they are computed."""
    rng, found = np.random.default_rng(9), []
    for bulge, thickness in ARCS:
        row = row_of(Primitive(Shape.ARC, ((-1.0, -1.5), (1.5, 1.0)), thickness, bulge=bulge))
        for _ in range(60):
            x, z = (float(n) for n in rng.uniform(-3, 3, 2))
            found += [float(number).hex() for number in distance(row, x, z)]
            if distance(row, x, z)[0] > RADIUS:
                ball = ball_at(x, z, *(float(n) for n in rng.uniform(-12, 12, 2)), accel=(-10.0, 0.0))
                time, is_hit = first_touch(row, ball, RADIUS, 0.25)
                found.append(f"{float(time).hex()} {bool(is_hit)}")
    mover = Mover((0.0, 0.0), -1.0, -0.5, 0.4, 0.03, 0.1, "right", is_coil=True)
    row = row_of(Primitive(Shape.TAPERED, ((0.0, 0.0), (0.0, 1.15)), 0.2, 0.12, mover=mover))
    for sweep in SWEEPS:
        for _ in range(60):
            x, z, vx, vz = (float(n) for n in (*rng.uniform(-2, 2, 2), *rng.uniform(-12, 12, 2)))
            if x * x + z * z > 2.6:
                contact = first_meeting(row, sweep, ball_at(x, z, vx, vz, (-10.0, 0.0)), RADIUS, 0.03)
                found.append(" ".join(float(number).hex() for number in contact))
    return found


if __name__ == "__main__":
    print(json.dumps(flights()))
