"""A board with every device, and random play on it."""

from __future__ import annotations

import contextlib

import numpy as np

from boards import PADDLES, table_of
from silverball.errors import NoRoom
from silverball.table import Table
from silverball.table.kinds import (
    Cylinder,
    DropTarget,
    Gate,
    Hole,
    Level,
    Passage,
    Plunger,
    Rollover,
    SlantWall,
    Spinner,
)
from silverball.world import World

LANE = Rollover(start=(2.0, -1.0), end=(2.0, 1.0))
TARGETS = (
    DropTarget(start=(3.0, -1.0), end=(3.0, -0.2), bank="a", reset_after=0.5),
    DropTarget(start=(3.0, 0.2), end=(3.0, 1.0), bank="a", reset_after=0.5),
)


def table_with(*parts, **board) -> Table:
    """A table of these parts and two paddles."""
    return table_of(*PADDLES, *parts, **board)


def everything() -> Table:
    """A board with every device, on which a few balls play."""
    return table_with(
        LANE, Rollover(center=(3.0, 3.0), radius=0.6), Spinner(start=(5.0, -2.5), end=(5.0, -0.5), drag=0.4),
        Hole(center=(6.5, 2.5), radius=0.35, hold=0.3, exit=(6.0, 0.0), exit_velocity=(-4.0, 2.0)),
        Hole(center=(-3.0, -4.2), radius=0.3, drain=True),
        *TARGETS, Gate(start=(0.0, 2.0), end=(0.0, 3.4), passes="up"),
        Gate(start=(0.0, -3.4), end=(0.0, -2.0), held=True, name="door"),
        Passage(start=(-1.0, 3.0), end=(-1.0, -3.0), **{"from": 0, "to": 1}),
        Level(number=1, gravity=(-6.0, 1.0)),
        Plunger(position=(-6.0, 4.4), launch=(10.0, 20.0), charge=0.3),
        Cylinder(center=(1.0, 0.5), radius=0.5), SlantWall(start=(-4.5, -5.0), end=(-6.88, -2.76)),
        max_balls=5,
    )  # fmt: skip


def play(world: World, tick: int, rng: np.random.Generator) -> None:
    """One tick of random play."""
    if tick % 20 == 0 and len(world.balls) < 5:
        with contextlib.suppress(NoRoom):
            world.create_ball()
    if tick % 97 == 0:
        world.open_gate("door", tick % 2 == 0)
    left, right, jitter, launch = (rng.random(4) < (0.3, 0.3, 0.02, 0.8)).tolist()
    world.step(left=left, right=right, jitter=jitter, launch=launch)
