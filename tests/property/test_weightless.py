"""Without gravity balls fly straight, keep their speed, rest forever, and get into nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from boards import CLASSIC, edited, full_table, launched, place, speed_of, table_of
from silverball.physics.audit import deepest
from silverball.physics.tolerances import MIN_HOP_SPEED
from silverball.soak.hostile import hostile_table
from silverball.table import Cylinder, SlantWall, Table, check_table, generate_table
from silverball.world import World, WorldBatch

DEPTH = 1e-9
RATES = st.sampled_from([10, 60, 240, 977])
RUBS = ({}, {"friction": 0.2}, {"friction": 0.2, "rolling": True}, {"friction": 2.0, "rolling": True})
TINY = (0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-12, 1e-6, 1e-3, 0.05)
"""[u/s²] Nothing, and less than anybody would notice."""


def weightless(table: Table, **board) -> Table:
    """The same table without gravity."""
    return table.model_copy(update={"board": table.board.model_copy(update={"gravity": 0.0} | board)})


@settings(max_examples=60)
@given(st.floats(-8, 8), st.floats(-4, 4), st.floats(-5, 5), st.floats(-5, 5), RATES, st.sampled_from(RUBS))
def test_a_free_ball_flies_straight_at_the_same_speed(x, z, vx, vz, tick_rate, rub) -> None:
    world = launched(table_of(gravity=0.0, **rub), (x, z, vx, vz), tick_rate=tick_rate)
    for tick in range(1, 200):
        world.step()
        if world.events or not world.balls:
            break
        t = tick / tick_rate
        assert place(world.balls[0]) == pytest.approx((x + vx * t, z + vz * t), abs=1e-12)
        assert speed_of(world.balls[0]) == (vx, vz)


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize("seed", range(4))
def test_energy_stays_where_nothing_takes_any(seed: int, tick_rate: int) -> None:
    table = full_table(gravity=0.0, boost=1.0, restitution=1.0, gutter=-9.9, hit_speed=0.01, max_balls=1)
    walls = SlantWall(start=(-8.5, -5.0), end=(-8.5, 5.0), restitution=1.0)
    table = table.model_copy(update={"slant_wall": (*table.slant_wall, walls)})
    world = World(table, seed, tick_rate)
    world.create_ball((8.0, -1.0 + 0.3 * seed), (7.0, 3.0 + seed))
    (vx, vz), hits = speed_of(world.balls[0]), 0
    for _ in range(60 * tick_rate):
        world.step()
        hits += len(world.events)
        assert math.hypot(*speed_of(world.balls[0])) == pytest.approx(math.hypot(vx, vz), rel=1e-12)
        assert deepest(*world.records) <= DEPTH
    assert hits > 50
    assert world.jams == 0


@pytest.mark.parametrize("gravity", TINY)
@pytest.mark.parametrize("tick_rate", [10, 240])
@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_a_ball_at_rest_stays_and_a_restored_one_too(rub, tick_rate: int, gravity: float) -> None:
    """For a quarter of an hour, and then for another one; its flight is as old as that."""
    if gravity >= 1e-6:  # it falls after all
        return
    world = launched(full_table(gravity=gravity, **rub), (1.5, 2.0, 0.0, 0.0), tick_rate=tick_rate)
    world.step(ticks=900 * tick_rate)
    other = World(world.table, 1, tick_rate)
    other.restore(world.save())
    for each in (world, other):
        each.step(left=True, ticks=900 * tick_rate)
    assert place(world.balls[0]) == pytest.approx((1.5, 2.0), abs=2e-6)
    assert gravity > 1e-13 or place(world.balls[0]) == (1.5, 2.0)
    assert world.save() == other.save()


@pytest.mark.parametrize("gravity", TINY)
@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_a_skip_and_a_batch_give_the_bits_of_one_tick_after_the_other(rub, gravity: float) -> None:
    tables = [weightless(generate_table(n), gravity=gravity, **rub) for n in range(8)]
    tables += [weightless(hostile_table(n), gravity=gravity, **rub) for n in range(8)]
    leaping, single = (WorldBatch(tables, len(tables), 3, 60) for _ in range(2))
    restored = WorldBatch(tables, len(tables), 3, 60)
    rng = np.random.default_rng(9)
    for _ in range(30):
        ticks = int(rng.integers(1, 40))
        held = rng.random((len(tables), 3)) < (0.4, 0.4, 0.3)
        for batch in (leaping, single):
            batch.create_balls()
        restored.restore(single.save())
        leaping.step(held, ticks)
        for tick in range(ticks):
            single.step(held & (True, True, tick == 0), 1)
        restored.step(held, ticks)
        assert leaping.state.tobytes() == single.state.tobytes() == restored.state.tobytes()
    assert not leaping.state["fault"].any()
    assert leaping.state["draws"].min() > 5


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize("degrees", [0, 1, 30, 45, 77, 90, 135])
def test_a_ball_slides_along_a_wall_that_has_taken_its_speed_towards_it(degrees: int, tick_rate: int) -> None:
    """A hop of MIN_HOP_SPEED is left of that speed, not a rounding that would be met again without end."""
    s, k = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    wall = SlantWall(start=(-4 * s, -4 * k), end=(4 * s, 4 * k), restitution=0.0)
    ball = (-3 * s + 0.5 * k, -3 * k - 0.5 * s, 2.0 * s - 0.5 * k, 2.0 * k + 0.5 * s)
    world = launched(table_of(wall, gravity=0.0, hit_speed=1.0), ball, tick_rate=tick_rate)
    for tick in range(1, 2 * tick_rate):
        world.step()
        x, z = place(world.balls[0])
        assert x * s + z * k == pytest.approx(-3.0 + 2.0 * tick / tick_rate, abs=1e-9)
    vx, vz = speed_of(world.balls[0])
    assert vx * s + vz * k == pytest.approx(2.0, abs=1e-9)
    assert vx * k - vz * s == pytest.approx(MIN_HOP_SPEED, abs=1e-14)
    assert world.jams == 0


def test_a_shove_moves_a_ball_that_lies_where_nothing_pulls() -> None:
    world = launched(full_table(gravity=0.0, jitter=3.0), (1.5, 2.0, 0.0, 0.0))
    world.step(ticks=1000)
    assert speed_of(world.balls[0]) == (0.0, 0.0)
    world.step(jitter=True)
    assert math.hypot(*speed_of(world.balls[0])) == pytest.approx(3.0, rel=1e-15)


@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_the_playfield_does_not_rub_a_ball_that_nothing_presses_onto_it(rub) -> None:
    """p = g / tan(slope) is 0, so a ball keeps its speed and its spin, whatever they are."""
    world = launched(table_of(gravity=0.0, **rub), (0.0, 0.0, 1.0, 0.5))

    def spin(record) -> None:
        for name in ("spin_x", "spin_y", "spin_z"):
            record["ball"][name][0] = 30.0

    world.restore(edited(world, spin))
    world.step(ticks=240)
    assert place(world.balls[0]) == pytest.approx((1.0, 0.5), abs=1e-12)
    assert world.balls[0].spin == (30.0, 30.0, 30.0)


@pytest.mark.parametrize("friction", [0.05, 0.5])
def test_a_part_rubs_all_the_same(friction: float) -> None:
    """A ball that meets a cylinder a little off its middle is turned by it."""
    post = Cylinder(center=(0.0, 0.0), radius=1.0, speed_factor=1.0)
    world = launched(table_of(post, gravity=0.0, friction=friction), (3.0, 0.4, -5.0, 0.0))
    world.step(ticks=120)
    assert world.hits["cylinder[0]"] == 1
    assert abs(world.balls[0].spin[1]) > 0.1


def test_the_tables_that_play_pass_the_check_without_gravity_too() -> None:
    assert check_table(weightless(CLASSIC)) == []
    assert check_table(weightless(generate_table(3))) == []
