"""Batches: world i is the single world of its own seed, whatever the number of threads, in this process and
in a new one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from boards import full_table
from patience import PATIENCE
from silverball.table import generate_table
from silverball.world import World, WorldBatch
from silverball.world.saved_world import digest

TABLE = full_table()
COUNT, TICKS = 24, 300


def actions(ticks: int, count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    held = rng.random((ticks, count, 3)) < [0.5, 0.5, 0.02]
    held[:, :, :2] = held[: (ticks + 9) // 10, :, :2].repeat(10, axis=0)[:ticks]
    return held


def played(table, threads: int | None, count: int = COUNT, seed: int = 40) -> WorldBatch:
    batch = WorldBatch(table, count=count, seed=seed, tick_rate=60, threads=threads)
    held = actions(TICKS, count)
    for part in np.split(held, 10):
        batch.create_balls()
        batch.step(part, ticks=len(part))
    return batch


def test_a_world_alone_is_the_same_world_in_a_batch() -> None:
    batch = played(TABLE, 1)
    held = actions(TICKS, COUNT)
    for index in range(COUNT):
        world = World(TABLE, seed=40 + index, tick_rate=60)
        for part in np.split(held[:, index], 10):
            if len(world.balls) < 2:
                world.create_ball()
            for left, right, jitter in part.tolist():
                world.step(left, right, jitter)
        assert world.digest() == digest(batch.state[index])


def test_the_number_of_threads_changes_no_bit() -> None:
    states = [played(TABLE, threads, count=300).state.tobytes() for threads in (1, 2, 5, None)]
    assert len(set(states)) == 1


def test_the_size_of_a_batch_changes_no_bit() -> None:
    assert (played(TABLE, 2, count=7).state == _first(7)).all()


def _first(count: int):
    batch = WorldBatch(TABLE, count=COUNT, seed=40, tick_rate=60)
    held = actions(TICKS, count)
    padded = np.zeros((TICKS, COUNT, 3), np.bool_)
    padded[:, :count] = held
    for part in np.split(padded, 10):
        batch.create_balls()
        batch.step(part, ticks=len(part))
    return batch.state[:count]


def test_every_world_of_a_recipe_has_the_board_of_its_own_seed() -> None:
    batch = WorldBatch("random", count=3, seed=7, tick_rate=60)
    for index in range(3):
        assert batch.tables[index] == generate_table(7 + index) == World("random", seed=7 + index).table
    held = np.zeros((3, 3), np.bool_)
    batch.create_balls()
    batch.step(held, ticks=200)
    for index in range(3):
        world = World("random", seed=7 + index, tick_rate=60)
        world.create_ball()
        world.step(ticks=200)
        assert world.digest() == digest(batch.state[index])


def test_held_buttons_are_the_same_as_the_same_row_for_every_tick() -> None:
    one, other = (WorldBatch(TABLE, count=3, seed=2) for _ in range(2))
    for batch in (one, other):
        batch.create_balls()
    row = np.array([[True, False, True], [False, True, False], [True, True, True]])
    one.step(row, ticks=40)
    rows = np.tile(row, (40, 1, 1))
    rows[1:, :, 2] = False  # one shove, on the first tick
    other.step(rows, ticks=40)
    assert one.state.tobytes() == other.state.tobytes()


PROGRAM = """
import numpy as np
from boards import full_table
from silverball.world import World, WorldBatch
from silverball.world.saved_world import digest
world = World("random", seed=7)
for tick in range(600):
    if len(world.balls) < 2:
        world.create_ball()
    world.step(left=tick % 40 < 15, right=tick % 50 < 20, jitter=tick % 90 == 0)
batch = WorldBatch(full_table(), count=50, seed=3, threads=2)
batch.create_balls()
batch.step(np.tile([True, False, True], (50, 1)), ticks=500)
print(world.digest(), digest(batch.state))
"""


def test_the_same_seed_gives_the_same_digest_in_a_new_process(capsys) -> None:
    exec(compile(PROGRAM, "program", "exec"), {})  # the very text that the new process runs
    here = capsys.readouterr().out.split()
    tests = str(Path(__file__).resolve().parents[2])
    path = os.pathsep.join([tests, *filter(None, [os.environ.get("PYTHONPATH")])])
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        capture_output=True, text=True, check=True, timeout=PATIENCE,
        env=os.environ | {"PYTHONPATH": path, "PYTHONHASHSEED": "123"},
    )  # fmt: skip
    assert len(here) == 2
    assert run.stdout.split() == here


@pytest.mark.parametrize(
    ("how", "match"),
    [
        ({"count": 0}, "count"),
        ({"count": 2.5}, "count"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**63}, "seed"),
        ({"seed": "7"}, "seed"),
        ({"seed": 1.0}, "seed"),
        ({"seed": None}, "seed"),
        ({"seed": True}, "seed"),
        ({"count": 3, "seed": [1, 2]}, "seed"),
        ({"tick_rate": 9}, "tick_rate"),
        ({"tick_rate": 100_001}, "tick_rate"),
        ({"tick_rate": 60.0}, "tick_rate"),
        ({"threads": 0}, "threads"),
    ],
)
def test_a_batch_that_cannot_be_is_refused_by_name(how, match: str) -> None:
    with pytest.raises(ValueError, match=match):
        WorldBatch(TABLE, **how)


def test_as_many_tables_as_worlds() -> None:
    with pytest.raises(ValueError, match="table"):
        WorldBatch([TABLE, TABLE], count=3)


@pytest.mark.parametrize("shape", [(3,), (2, 3), (5, 4, 3), (4, 2), (1, 4, 2), (6, 4, 3, 1)])
def test_actions_of_another_shape_are_refused_and_nothing_moves(shape) -> None:
    batch = WorldBatch(TABLE, count=4)
    before = batch.state.tobytes()
    with pytest.raises(ValueError, match="shape"):
        batch.step(np.zeros(shape, np.bool_), ticks=6)
    assert batch.state.tobytes() == before


def test_create_balls_obeys_its_mask_and_says_where() -> None:
    batch = WorldBatch(TABLE, count=4, seed=1)
    assert batch.create_balls([True, False, True, False]).tolist() == [True, False, True, False]
    assert batch.create_balls().all()
    assert batch.create_balls().tolist() == [False, True, False, True]
    before = batch.state.tobytes()
    assert not batch.create_balls().any()
    assert batch.state.tobytes() == before
    with pytest.raises(ValueError, match="mask"):
        batch.create_balls([True])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="only some systems fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_batch_that_has_used_its_threads_goes_on_in_a_forked_child():
    script = """
import os, sys, numpy as np, silverball as sb
batch = sb.WorldBatch("classic", 64, threads=2)
still = np.zeros((64, 3), bool)
batch.step(still, ticks=64)
child = os.fork()
if child == 0:
    batch.step(still, ticks=64)
    os._exit(7)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    assert subprocess.run([sys.executable, "-c", script], timeout=PATIENCE, check=False).returncode == 7
