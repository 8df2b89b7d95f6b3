"""Ball time: how long a ball lives, when it counts as lost, and how balls not yet lost are counted."""

from __future__ import annotations

import math

import pytest

from boards import PADDLES, full_table, table_of
from silverball.metrics.ball_time import STALL, time_balls
from silverball.table import SlantWall
from silverball.world import World, WorldBatch

CRADLE = (SlantWall(start=(0.0, 0.0), end=(1.5, -1.5)), SlantWall(start=(0.0, 0.0), end=(1.5, 1.5)))


def cradled() -> WorldBatch:
    """Two worlds in which a ball lies forever."""
    batch = WorldBatch(table_of(*CRADLE), count=2, tick_rate=60)
    batch.state["created"] = batch.state["ball"]["id"][:, 0] = 1
    batch.state["ball"]["x"][:, 0] = 1.0
    return batch


def test_a_ball_is_lost_when_it_is_in_the_gutter() -> None:
    batch = WorldBatch(table_of(), count=5, seed=1, tick_rate=240)
    times = time_balls(batch, "idle", 60.0)
    seconds = []
    for seed in range(1, 6):
        world = World(table_of(), seed=seed)
        world.create_ball()
        while world.balls:
            world.step()
        seconds.append(world.time)
    assert (times.balls, times.drained, times.stalled, times.alive) == (5, 5, 0, 0)
    assert times.mean[0] == pytest.approx(sum(seconds) / 5, abs=1e-12)
    assert times.median[0] == sorted(seconds)[2]


def test_a_ball_that_makes_no_points_is_lost_after_fifteen_seconds() -> None:
    batch = cradled()
    times = time_balls(batch, "idle", 60.0)
    assert (times.drained, times.stalled, times.alive) == (0, 2, 0)
    assert times.median[0] == times.mean[0] == STALL
    assert not batch.state["ball"]["id"].any()


def test_holding_both_paddles_up_does_not_pay() -> None:
    lives = {}
    for kind in ("hold", "reflex"):
        lives[kind] = time_balls(WorldBatch(full_table(), count=64, seed=50, tick_rate=60), kind, 60.0)
    held, reflex = lives["hold"], lives["reflex"]
    assert held.stalled > 0
    assert held.mean[0] < reflex.mean[0]
    assert held.score[0] < reflex.score[0]


def test_a_ball_that_outlives_the_time_is_censored() -> None:
    times = time_balls(cradled(), "idle", 5.0)
    assert times.alive == 2
    assert times.median == (math.inf, math.inf, math.inf)
    assert times.mean[0] == pytest.approx(5.0)


def test_a_board_with_paddles_and_nothing_else_gives_no_points() -> None:
    times = time_balls(WorldBatch(table_of(*PADDLES), count=3, seed=1, tick_rate=60), "reflex", 20.0)
    assert times.score[0] == times.score_per_minute[0] == 0.0
