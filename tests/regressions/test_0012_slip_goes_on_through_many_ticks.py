"""A ball slipped on through the ticks in which the launch button came up, or something on the table was due.

A flight of a slipping ball is valid for one tick: its slip direction is constant, and its spin is advanced
from the flight's start. After 37 ticks the spin had grown to 2000 rad/s, and when the slip ended, the ball
jumped by two units.
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

from boards import PLAYGROUND, table_of
from silverball.errors import BoardFull, NoRoom
from silverball.physics.records import MAX_BALLS, Motion
from silverball.table.kinds import Plunger
from silverball.world import World, WorldBatch


def is_every_slip_new(world: World) -> bool:
    """Whether all flights of slipping balls began in the last tick."""
    balls = world.records[0]["ball"]
    return bool((balls["ticks"][(balls["id"] != 0) & (balls["motion"] == Motion.SLIPPING)] <= 1).all())


@pytest.mark.parametrize("tick_rate", [60, 240, 1000])
def test_a_slip_begins_anew_in_every_tick_whatever_is_due_on_the_table(tick_rate: int) -> None:
    board = PLAYGROUND.board.model_copy(update={"friction": 0.2, "rolling": True, "max_balls": MAX_BALLS})
    world = World(PLAYGROUND.model_copy(update={"board": board}), seed=3, tick_rate=tick_rate)
    buttons, slips = np.random.default_rng(5), 0
    for number in range(120):
        if number % 2 == 0:
            with suppress(NoRoom, BoardFull):
                world.create_ball()
        left, right, launch = buttons.random(3) < 0.5
        for _ in range(tick_rate // 4):
            world.step(left=left, right=right, launch=launch)
            assert is_every_slip_new(world)
            slips += int(np.count_nonzero(world.records[0]["ball"]["motion"] == Motion.SLIPPING))
    assert world.fault is None
    assert slips > 10 * tick_rate  # else nothing was tried


def test_a_slipping_ball_flies_alike_whatever_the_launch_button_does() -> None:
    table = table_of(Plunger(position=(-6.0, 4.0)), friction=0.2, rolling=True)
    ends = []
    for is_pressed in (False, True):
        world = World(table, tick_rate=240)
        world.create_ball((0.0, -3.0), (9.0, 2.0))
        batch = WorldBatch(table, 1, 0, 240)
        batch.state[:] = world.records[0]
        launch = [is_pressed and tick % 2 == 0 for tick in range(240)]
        for is_held in launch:
            world.step(launch=is_held)
        batch.step(np.array([[[False, False, False, is_held]] for is_held in launch]), ticks=240)
        for ball in (world.records[0]["ball"][0], batch.state["ball"][0, 0]):
            ends.append([float(ball[name]) for name in ("x", "z", "vx", "vz", "spin_x", "spin_y", "spin_z")])
    assert ends[0] == ends[1] == ends[2] == ends[3]
