"""Flights, lines and discs as records, and their crossings to 50 digits."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from mpmath import mp, mpf

from silverball.physics.records import BALL, COLLIDER, records

TIME_BOUND = 8 * math.ulp(10.0)
"""[u] Coordinates reach 10 u; divided by the speed at the crossing this bounds the error of its time."""


def flight(x, z, vx, vz, ax=-10.0, az=0.0):
    """A ball at the start of a flight."""
    ball = records(1, BALL)[0]
    ball["x"], ball["z"], ball["vx"], ball["vz"] = x, z, vx, vz
    ball["start_x"], ball["start_z"], ball["start_vx"], ball["start_vz"] = x, z, vx, vz
    ball["accel_x"], ball["accel_z"] = ax, az
    return ball


def segment(start, end, radius=0.0):
    """A line, or the axis of a capsule that balls pass to the left of start → end."""
    row = records(1, COLLIDER)[0]
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = math.sqrt(dx * dx + dz * dz)
    row["x0"], row["z0"], row["x1"], row["z1"] = *start, *end
    row["along_x0"], row["along_z0"], row["length0"] = dx / length, dz / length, length
    row["inward_x"], row["inward_z"] = dz / length, -dx / length
    row["radius"] = radius
    return row


def disc(x, z, radius):
    row = records(1, COLLIDER)[0]
    row["x"], row["z"], row["radius"] = x, z, radius
    return row


def random_flight(rng, kind: str, targets=((0.0, 0.0), (0.0, 0.0))):
    """A flight through the first point and, every other time, through the second one too.

    It is under gravity, under any acceleration or under none.
    """
    accel = np.array({"gravity": (-10.0, 0.0), "none": (0.0, 0.0)}.get(kind, rng.normal(0.0, 10.0, 2)))
    first, second = np.array(targets)
    early = rng.uniform(0.05, 0.5)
    late = early + rng.uniform(0.05, 0.9)
    if rng.random() < 0.5:
        second = second + rng.uniform(-3.0, 3.0, 2)
    velocity = (second - first) / (late - early) - accel * (early + late) / 2
    place = first - early * (velocity + accel * early / 2)
    return flight(*(float(n) for n in (*place, *velocity, *accel)))


def all_found(find: Callable[[float, bool, float], Any], limits) -> list[Any]:
    """All crossings of a flight, searched piece by piece up to each of these ages in turn."""
    found, start = [], 0.0
    for limit in limits:
        is_past_start = False
        while True:
            age, *rest = find(start, is_past_start, limit)
            start = age
            if not rest[-1]:
                assert age == limit
                break
            found.append((age, *rest))
            is_past_start = True
            assert len(found) < 9
    return found


def exact_path(ball, x=0.0, z=0.0):
    """Position and velocity of a ball, relative to a point, as functions of mpf times."""
    px, pz = mpf(float(ball["start_x"])) - mpf(x), mpf(float(ball["start_z"])) - mpf(z)
    vx, vz = mpf(float(ball["start_vx"])), mpf(float(ball["start_vz"]))
    ax, az = mpf(float(ball["accel_x"])), mpf(float(ball["accel_z"]))

    def position(t):
        return px + t * (vx + ax * t / 2), pz + t * (vz + az * t / 2)

    def velocity(t):
        return vx + ax * t, vz + az * t

    return position, velocity


def real_roots(coefficients) -> list[Any]:
    """The real roots of a polynomial, in order; coefficients from the lowest power."""
    while coefficients and coefficients[-1] == 0:
        coefficients = coefficients[:-1]
    if len(coefficients) < 2:
        return []
    roots = mpmath.polyroots(coefficients, maxsteps=500, extraprec=400, asc=True)
    return sorted(mp.re(root) for root in roots if abs(mp.im(root)) < mpf(10) ** -25)


def exact_disc_entries(ball, x: float, z: float, radius: float) -> list[tuple[Any, Any]]:
    """All entries into a disc after the start of a flight: age, and the rate of the distance there."""
    position, velocity = exact_path(ball, x, z)
    (px, pz), (vx, vz) = position(mpf(0)), velocity(mpf(0))
    ax, az = velocity(mpf(1))[0] - vx, velocity(mpf(1))[1] - vz
    coefficients = [
        px * px + pz * pz - mpf(radius) ** 2,
        2 * (px * vx + pz * vz),
        vx * vx + vz * vz + ax * px + az * pz,
        ax * vx + az * vz,
        (ax * ax + az * az) / 4,
    ]
    found = []
    for t in real_roots(coefficients):
        (qx, qz), (ux, uz) = position(t), velocity(t)
        rate = (qx * ux + qz * uz) / mpf(radius)
        if t > 0 and rate < 0:
            found.append((t, rate))
    return found


def float_positions(ball, times) -> tuple[Any, Any]:
    """Positions of a ball at an array of times."""
    x = ball["start_x"] + times * (ball["start_vx"] + 0.5 * ball["accel_x"] * times)
    z = ball["start_z"] + times * (ball["start_vz"] + 0.5 * ball["accel_z"] * times)
    return np.asarray(x), np.asarray(z)
