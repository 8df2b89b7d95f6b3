"""Boards with up to eight balls and eight paddles."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from boards import PADDLES, full_table
from silverball.errors import NoRoom
from silverball.physics.audit import deepest
from silverball.physics.records import Fault
from silverball.table import Board, Paddle, SlantWall, Table
from silverball.world import World, WorldBatch

UPPER = (
    Paddle(side="left", pivot=(1.0, -4.2), rest_angle=-20.0, up_angle=30.0),
    Paddle(side="right", pivot=(1.0, 4.2), rest_angle=-20.0, up_angle=30.0),
    Paddle(
        side="left",
        pivot=(5.0, -4.2),
        button="right",
        profile="coil",
        shape="capsule",
        stroke=0.2,
        return_stroke=0.2,
    ),
)


def crowded(**board) -> Table:
    """A board with five paddles for eight balls."""
    guides = (
        SlantWall(start=(-4.5, -5.0), end=(-6.88, -2.76)),
        SlantWall(start=(-6.88, 2.76), end=(-4.5, 5.0)),
    )
    return Table(
        name="crowded",
        format=2,
        board=Board(max_balls=8, **board),
        paddle=(*PADDLES, *UPPER),
        slant_wall=guides,
    )


def mirrored(table: Table) -> Table:
    """The mirror image of a crowded board; its paddles keep their order."""
    sides = {"left": "right", "right": "left"}
    paddles = tuple(
        paddle.replace(
            side=sides[paddle.side],
            pivot=(paddle.pivot[0], -paddle.pivot[1]),
            button=sides[paddle.pressed_by],
        )
        for paddle in table.paddle
    )
    walls = tuple(
        wall.replace(start=(wall.start[0], -wall.start[1]), end=(wall.end[0], -wall.end[1]))
        for wall in table.slant_wall
    )
    return table.replace(paddle=paddles, slant_wall=walls)


def played(world: World, ticks: int, seed: int = 0) -> World:
    """A world after random play with as many balls as there can be."""
    rng = np.random.default_rng(seed)
    for tick in range(ticks):
        if tick % 8 == 0 and len(world.balls) < 8:
            with contextlib.suppress(NoRoom):
                world.create_ball()
        left, right = (rng.random(2) < 0.5).tolist()
        world.step(left, right, ticks=1)
    return world


@pytest.mark.parametrize(
    "board", [{}, {"friction": 0.2, "rolling": True}, {"gravity": 60.0, "ball_restitution": 0.2}]
)
@pytest.mark.parametrize("tick_rate", [60, 240])
def test_eight_balls_and_five_paddles_are_never_inside_each_other(board: dict, tick_rate: int) -> None:
    batch = WorldBatch(crowded(**board), 16, 3, tick_rate)
    rng = np.random.default_rng(0)
    most, depth, jams = 0, 0.0, batch.state["jams"].copy()
    for _ in range(400 if tick_rate == 60 else 1000):
        batch.create_balls()
        batch.step(rng.random((16, 3)) < (0.5, 0.5, 0.02))
        # A jammed ball is stopped, and held if it jams again: twice in a tick at most.
        assert (batch.state["jams"] - jams).max() <= 2 * 8
        jams = batch.state["jams"].copy()
        most = max(most, int((batch.state["ball"]["id"] != 0).sum(axis=1).max()))
        for world in batch.state:
            depth = max(depth, deepest(world, batch.boards.board[0], batch.boards.collider))
    assert most == 8
    assert depth < 1e-9
    assert (batch.state["fault"] == Fault.NONE).all()
    met = {
        name for name, count in zip(batch.boards.names[0], batch.tallies.sum(axis=0), strict=True) if count
    }
    assert sum(name.startswith("paddle") for name in met) == 5


def test_a_batch_of_crowds_is_its_single_worlds() -> None:
    table = crowded()
    batch = WorldBatch(table, 3, 7, 60)
    worlds = [World(table, 7 + index, 60) for index in range(3)]
    rng = np.random.default_rng(2)
    for _ in range(150):
        for world, is_new in zip(worlds, batch.create_balls(), strict=True):
            if is_new:
                world.create_ball()
        actions = rng.random((3, 3)) < 0.4
        batch.step(actions, 3)
        for world, (left, right, jitter) in zip(worlds, actions.tolist(), strict=True):
            world.step(left, right, jitter, 3)
    assert batch.digests() == [world.digest() for world in worlds]


def test_a_crowd_goes_on_from_any_tick_to_the_bit() -> None:
    world, other = (played(World(crowded(), 4, 240), 400) for _ in range(2))
    assert len(world.balls) > 4
    for tick in range(300):
        other.restore(other.save())
        for one in (world, other):
            one.step(tick % 40 < 20, tick % 30 < 9)
        assert world.digest() == other.digest()


def test_skipping_ahead_of_a_crowd_gives_the_bits_of_tick_by_tick() -> None:
    one, other = (played(World(crowded(), 6, 240), 300) for _ in range(2))
    for _ in range(30):
        one.step(ticks=24)
        for _ in range(24):
            other.step()
        assert one.digest() == other.digest()


def test_a_mirrored_crowd_plays_the_mirror_image() -> None:
    table = crowded()
    one, other = World(table, 0, 240), World(mirrored(table), 0, 240)
    rng = np.random.default_rng(5)
    for x in (2.5, 4.0, 6.5, 8.0):
        for z in (-2.0, 1.0):
            vx, vz = rng.uniform(-9.0, 9.0, 2).tolist()
            one.create_ball(position=(x, z), velocity=(vx, vz))
            other.create_ball(position=(x, -z), velocity=(vx, -vz))
    for tick in range(1500):
        left, right = tick % 50 < 25, tick % 70 < 30
        one.step(left, right)
        other.step(right, left)
        balls, images = one.records[0]["ball"], other.records[0]["ball"]
        assert balls["id"].tolist() == images["id"].tolist()
        assert balls["x"].tolist() == images["x"].tolist(), tick
        assert balls["z"].tolist() == (0.0 - images["z"]).tolist()


SCRIPT = """
import sys
sys.path[:0] = {paths!r}
from device_boards import everything, play
from test_many_balls import crowded, played
import numpy as np
from silverball.world import World
world, rng = World(everything(), 5, 60), np.random.default_rng(0)
for tick in range(150):
    play(world, tick, rng)
print(world.digest(), played(World(crowded(), 1, 60), 60).digest())
"""


def test_the_interpreter_gives_the_bits_of_the_compiler() -> None:
    here = Path(__file__).resolve()
    script = SCRIPT.format(paths=[str(here.parent), str(here.parents[2])])
    answers = [
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, **more},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for more in ({}, {"NUMBA_DISABLE_JIT": "1"})
    ]
    assert answers[0] == answers[1]
    assert len(answers[0]) == 2


def test_the_paddles_of_one_button_move_together() -> None:
    world = World(crowded())
    world.step(right=True, ticks=240)
    is_up = [paddle.angle > 0.2 for paddle in world.paddles]
    assert is_up == [False, True, False, True, True]


def test_more_balls_than_a_table_allows_are_refused() -> None:
    with pytest.raises(ValueError, match="8"):
        full_table(max_balls=9)
