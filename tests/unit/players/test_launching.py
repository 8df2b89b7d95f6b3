"""Players that know the paddle buttons only play on tables with a plunger."""

from __future__ import annotations

import numpy as np
import pytest

from silverball.metrics.ball_time import time_balls
from silverball.physics.records import Motion
from silverball.players.rollout import play
from silverball.players.simple import LAUNCH_LEAST, LAUNCH_PERIOD, LAUNCH_SPAN, holds_launch
from silverball.table import Table, load_table
from silverball.world import World, WorldBatch

TABLE = Table.model_validate(
    {
        "name": "Lane",
        "paddle": load_table("classic").paddle,
        "plunger": [{"position": (-6.0, 3.0), "angle": 105.0}],
    }
)


def test_the_button_is_held_for_a_part_of_every_period_that_varies():
    world, tick = World(TABLE, 7), 1.0 / 240.0
    record = world.records[0]
    held = []
    for number in range(240 * 30):
        record["tick"] = number
        held.append(bool(holds_launch(record, tick)))
    shares = np.array(held).reshape(-1, round(LAUNCH_PERIOD * 240)).mean(axis=1)
    assert shares.min() >= LAUNCH_LEAST
    assert shares.max() <= LAUNCH_LEAST + LAUNCH_SPAN + 0.01
    assert np.ptp(shares) > 0.2


@pytest.mark.parametrize("player", ["idle", "reflex", "trained"])
def test_balls_are_launched_in_rollouts(player):
    batch = WorldBatch(TABLE, 8, seed=2)
    totals = play(batch, player, 6.0, balls=1, audit=True)
    assert totals.faults == 0
    assert totals.deepest < 1e-9
    balls = batch.state["ball"]
    is_waiting = ((balls["id"] != 0) & (balls["motion"] == Motion.CAPTURED)).any(axis=1)
    assert totals.drained > 0 or not is_waiting.all()


def test_ball_times_do_not_count_the_wait_on_a_plunger_forever():
    times = time_balls(WorldBatch(TABLE, 16, seed=2), "idle", 10.0)
    assert times.drained >= 12
