"""The solver and its slow twin find the same contacts, in the same order, at the same places."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import CONTACTS, full_table, launched, moment, place
from oracle import Twin

SECONDS = 0.3
BOUNCES = 4
TOLERANCE = 1e-6
"""[u, s] The twin places a contact to 1e-13 s; a bounce off a small circle magnifies an error of place up
to fifty times, so after four it is below 1e-6. What the twin's step of 1e-4 s makes of a graze is left out
(below)."""


def random_ball(rng: np.random.Generator) -> tuple[float, float, float, float]:
    turn, speed = rng.uniform(0, 2 * math.pi), rng.uniform(4, 21)
    x, z = rng.uniform(-7.4, 8.5), rng.uniform(-4, 4)
    return float(x), float(z), float(speed * math.sin(turn)), float(speed * math.cos(turn))


def random_flights(count: int):
    """Two balls each, at places that are free, half of them among the paddles; and the buttons."""
    rng = np.random.default_rng(77)
    probe = launched(full_table())
    made = 0
    while made < count:
        a, b = random_ball(rng), random_ball(rng)
        if made % 2:
            a, b = ((-6.6 + 0.2 * p[0] / 8, p[1] * 0.7, *p[2:]) for p in (a, b))
        if min(probe.clearance(*a[:2]), probe.clearance(*b[:2]), math.dist(a[:2], b[:2]) - 0.5) > 0.01:
            made += 1
            yield a, b, {"left": bool(rng.random() < 0.6), "right": bool(rng.random() < 0.6)}


def test_contacts_come_in_the_order_and_at_the_places_of_the_slow_twin() -> None:
    tick_rate = 60
    table = full_table(speed_cap=40)
    compared = 0
    worst = 0.0
    parts = set()
    for a, b, held in random_flights(36):
        twin = Twin(table, [a, b]).run(SECONDS, held)
        world = launched(table, a, b, tick_rate=tick_rate)
        seen = []
        for _ in range(round(SECONDS * tick_rate)):
            world.step(**held)
            seen += [event for event in world.events if event.kind in (*CONTACTS, "gutter")]
        for event, bounce in zip(seen[:BOUNCES], twin[:BOUNCES], strict=False):
            # A contact slower than this may be a graze that the twin steps over, or a touch with a hop.
            if min(event.speed, bounce.speed) < 1.0:
                break
            assert (event.part, event.ball) == (bounce.part, bounce.ball + 1)
            error = max(
                abs(moment(world, event) - bounce.time), math.dist(place(event), (bounce.x, bounce.z))
            )
            worst = max(worst, error)
            assert error <= TOLERANCE
            assert event.speed == pytest.approx(bounce.speed, abs=1e-4)
            compared += 1
            parts.add(event.part.split("[")[0])
        else:
            assert min(len(seen), BOUNCES) == min(len(twin), BOUNCES)
    print(f"oracle: {compared} contacts, worst difference {worst:.1e}")
    assert compared >= 50
    assert parts >= {
        "paddle.left",
        "paddle.right",
        "slant_wall",
        "triangular_prism",
        "cylinder",
        "board.left",
    }
