"""Balls that pass each other at two radii, but for some ulps, met or not depending on how a run was cut.

A skip over many ticks searched for their contact over its whole length, where rounding differs from that in
the one tick in which they pass.
"""

from __future__ import annotations

import random

import numpy as np

from boards import table_of
from silverball.errors import NoRoom
from silverball.world import World

TABLE = table_of(gravity=0.1, length=50.0, width=20.0, gutter=-24.0)


def test_a_skip_is_the_same_as_single_ticks_for_balls_that_nearly_touch() -> None:
    pick = random.Random(1)
    leaping, stepping = World(TABLE, tick_rate=240), World(TABLE, tick_rate=240)
    start, met = leaping.save(), 0
    for _ in range(600):
        z, x, way, speed = pick.uniform(-5, 5), pick.uniform(0, 10), pick.uniform(2, 8), pick.uniform(5, 22)
        other = z - 0.5 + pick.randint(-6, 6) * float(np.spacing(abs(z)))
        try:
            for world in (leaping, stepping):
                world.restore(start)
                world.create_ball((x, z))
                world.create_ball((x + way, other), (-speed, 0.0))
        except NoRoom:
            continue
        leaping.step(ticks=150)
        for _ in range(150):
            stepping.step()
            met += bool(stepping.events)
        assert leaping.digest() == stepping.digest()
    assert met > 50  # or nothing was tried
