"""The nudge: the cabinet swings as a damped oscillator, and every ball feels how its velocity changes."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from device_boards import everything, play, table_with
from silverball.errors import StateError, TableError
from silverball.physics.cabinet import DAMPING_RATIO, FREQUENCY
from silverball.physics.tolerances import CABINET_REST
from silverball.table import Table
from silverball.world import Snapshot, World, WorldBatch

NUDGE = 5.0  # [u/s]
RATES = (60, 240, 1000)
FREE = table_with(gravity=0.0, nudge=NUDGE, wall_restitution=0.5, hit_speed=0.1)
OMEGA = 2.0 * math.pi * FREQUENCY
ROOT = OMEGA * complex(-DAMPING_RATIO, math.sqrt(1.0 - DAMPING_RATIO**2))  # s'' + 2ζω·s' + ω²·s = 0


def place(time: float) -> float:
    """The place of an oscillator that was at rest at 0 and had the speed NUDGE then [u]."""
    return NUDGE * (cmath.exp(ROOT * time)).imag / ROOT.imag


def speed(time: float) -> float:
    """Its speed [u/s]."""
    return NUDGE * (ROOT * cmath.exp(ROOT * time)).imag / ROOT.imag


def swinging(table: Table, tick_rate: int = 240, ticks: int = 9) -> World:
    """A world with balls in the middle of a swing."""
    world = World(table, seed=5, tick_rate=tick_rate)
    world.create_ball()
    world.step(nudge="left")
    world.step(nudge="up", ticks=ticks)
    assert all(world.cabinet)
    return world


@pytest.mark.parametrize("tick_rate", RATES)
@pytest.mark.parametrize(("nudge", "sign", "axis"), [("left", -1.0, 1), ("right", 1.0, 1), ("up", 1.0, 0)])
def test_the_cabinet_is_the_damped_oscillator(tick_rate: int, nudge: str, sign: float, axis: int) -> None:
    world = World(FREE, tick_rate=tick_rate)
    world.step(nudge=nudge)
    for tick in range(tick_rate // 4):
        middle = (tick + 0.5) / tick_rate
        assert world.cabinet[axis] == pytest.approx(sign * place(middle), abs=1e-12)
        assert world.cabinet[1 - axis] == 0.0
        world.step()


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_ball_that_touches_nothing_keeps_its_place_in_the_room(tick_rate: int) -> None:
    world = World(FREE, tick_rate=tick_rate)
    world.create_ball(position=(5.0, 0.0))
    world.step(nudge="right")
    for tick in range(1, tick_rate):
        z, off = world.balls[0].position[2], world.cabinet[1]
        # The midpoint rule is off by h²·|s‴|/24 · time, and a cut-off swing by CABINET_REST.
        now = place(tick / tick_rate) if off else 0.0
        assert z == pytest.approx(-now, abs=CABINET_REST + 2.0 * NUDGE * OMEGA / (24.0 * tick_rate**2))
        world.step()
    assert world.cabinet == (0.0, 0.0)
    assert world.balls[0].velocity == pytest.approx((0.0, 0.0, 0.0), abs=1e-13)  # all changes add up to 0
    assert world.tick == tick_rate


def test_a_wall_that_moves_gives_a_ball_its_speed_and_its_restitution() -> None:
    world = World(FREE, tick_rate=1000)
    gap, left = 1e-4, world.table.board.width / 2 - 0.1 - world.table.board.ball_radius
    world.create_ball(position=(5.0, -left + gap))
    world.step(nudge="right")
    (hit,) = [event for event in world.events if event.kind == "hit"]
    assert hit.part == "board.left"
    assert hit.speed == pytest.approx(speed(0.0005), abs=1e-12)  # that of the middle of the tick
    world.step(ticks=1000)
    assert world.balls[0].velocity[2] == pytest.approx((1.0 + 0.5) * speed(0.0005), abs=1e-12)


def test_two_nudges_add_up_and_opposite_ones_leave_nothing() -> None:
    twice, once = World(FREE), World(FREE)
    for world in (twice, once):
        world.step(nudge="right", ticks=7)
    twice.step(nudge="right")
    once.step()
    assert twice.cabinet[1] - once.cabinet[1] == pytest.approx(place(0.5 / 240), abs=1e-12)
    batch = WorldBatch(FREE)
    batch.step(np.array([[False] * 4 + [True, True, False]]))  # left and right in the same tick
    assert batch.state["cabinet_vz"][0] == 0.0


def test_every_ball_that_is_not_held_has_an_event_in_the_direction_in_which_it_goes() -> None:
    world = World(everything().replace(board={"nudge": NUDGE}), seed=2)
    held = world.create_ball()  # on the plunger
    free = world.create_ball(position=(-4.0, 0.0))
    world.step(nudge="left")
    events = [event for event in world.events if event.kind == "jitter"]
    assert [(event.ball, event.normal) for event in events] == [(free.id, (0.0, 0.0, 1.0))]
    assert events[0].speed == NUDGE
    assert world.balls[0].id == held.id
    assert world.balls[0].velocity == (0.0, 0.0, 0.0)


def test_a_rolling_ball_slips_when_the_playfield_moves_under_it() -> None:
    table = table_with(gravity=0.5, friction=0.2, rolling=True, nudge=NUDGE)
    world = World(table)
    world.create_ball(position=(5.0, 0.0))
    world.step(ticks=10)
    rolls, z = world.balls[0].spin, world.balls[0].position[2]
    world.step(nudge="right", ticks=4)
    assert world.balls[0].position[2] < z - 0.02  # it stays in the room …
    assert world.balls[0].spin != rolls  # … and the playfield drags at it
    world.step(ticks=240)
    assert world.cabinet == (0.0, 0.0)


# --- The same bits


@pytest.mark.parametrize("tick_rate", RATES)
def test_many_ticks_at_once_give_the_bits_of_one_by_one(tick_rate: int) -> None:
    at_once, singly = (swinging(everything().replace(board={"nudge": NUDGE}), tick_rate) for _ in range(2))
    at_once.step(left=True, ticks=300)
    for _ in range(300):
        singly.step(left=True)
    assert at_once.digest() == singly.digest()


def test_a_batch_gives_the_bits_of_single_worlds() -> None:
    table, rng = everything().replace(board={"nudge": NUDGE}), np.random.default_rng(0)
    actions = rng.random((400, 3, 7)) < (0.3, 0.3, 0.01, 0.7, 0.02, 0.02, 0.02)
    batch = WorldBatch(table, count=3, seed=7)
    for _ in range(2):
        batch.create_balls()
    batch.step(actions, ticks=400)
    for row in range(3):
        single = WorldBatch(table, seed=7 + row)
        for _ in range(2):
            single.create_balls()
        for tick in range(400):
            single.step(actions[tick, row : row + 1])
        assert single.digests()[0] == batch.digests()[row]


def test_a_swing_goes_on_after_it_was_saved() -> None:
    table = everything().replace(board={"nudge": NUDGE})
    world = swinging(table)
    copy, other = World(table), WorldBatch(table, count=2, seed=1)
    copy.restore(world.save())
    assert copy.digest() == world.digest()
    batch = WorldBatch(table, count=2)
    batch.state[0] = world.records[0]
    snapshot = Snapshot.from_bytes(bytes(batch.save()))
    other.restore(snapshot)
    assert other.digests()[0] == world.digest() == snapshot.digests()[0]
    for one in (world, copy):
        one.step(ticks=50)
    other.step(np.zeros((2, 3), bool), ticks=50)
    assert copy.digest() == world.digest() == other.digests()[0]


def test_the_bytes_of_a_world_at_rest_have_no_cabinet() -> None:
    table = everything()
    plain, nudged = World(table, seed=3), World(table.replace(board={"nudge": NUDGE}), seed=3)
    rngs = [np.random.default_rng(1), np.random.default_rng(1)]
    for world, rng in zip((plain, nudged), rngs, strict=True):
        for tick in range(200):
            play(world, tick, rng)
    assert plain.digest() == nudged.digest()
    assert len(plain.save()) == len(nudged.save())
    nudged.step(nudge="up")
    assert len(nudged.save()) == len(plain.save()) + 4 * 8
    nudged.step(ticks=480)
    assert len(nudged.save()) == len(plain.save())
    batch = WorldBatch(table, count=2)
    at_rest = bytes(batch.save())
    batch.state["cabinet_z"][1] = 0.1
    assert len(bytes(batch.save())) == len(at_rest) + 2 * 4 * 8
    batch.state["cabinet_z"][1] = 0.0
    assert Snapshot.from_bytes(bytes(batch.save())).digests() == batch.digests()


def test_a_cabinet_from_outside_is_felt_or_put_at_rest() -> None:
    table = everything().replace(board={"nudge": NUDGE})
    world = World(table)
    world.create_ball(position=(-4.0, 0.0))
    world.step()
    world.records[0]["cabinet_vz"] = 1.0
    world.step()
    assert 0.0 < world.cabinet[1] < 0.01
    world.records[0]["cabinet_z"] = math.nan
    world.step()
    assert world.cabinet == (0.0, 0.0)
    assert world.fault is None
    with_nothing = World(everything())
    with_nothing.records[0]["cabinet_x"] = 1.0
    with_nothing.records[0]["launch_held"] = 1
    with_nothing.step()
    assert with_nothing.records[0]["cabinet_x"] == 0.0


# --- What cannot be


def test_a_table_without_nudge_has_the_jitter_alone() -> None:
    world = World(everything())
    with pytest.raises(ValueError, match=r"cannot be nudged: give \[board\] nudge, in u/s, or use jitter"):
        world.step(nudge="left")
    batch = WorldBatch(everything())
    batch.create_balls()
    before = batch.digests()
    batch.step(np.array([[False] * 4 + [True] * 3]), ticks=0)
    assert batch.digests() == before
    assert world.cabinet == (0.0, 0.0)


def test_a_direction_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ValueError, match="nudge must be left, right, up or None, got 'down'"):
        World(FREE).step(nudge="down")


def test_format_1_has_no_nudge() -> None:
    from silverball.table import parse_table

    with pytest.raises(TableError, match="nudge"):
        parse_table("[board]\nnudge = 5.0\n", "old")
    assert parse_table("format = 2\n[board]\nnudge = 5.0\n", "new").board.nudge == 5.0


def test_a_saved_world_that_is_cut_off_in_its_cabinet_is_refused() -> None:
    world = World(everything())
    with pytest.raises(StateError):
        world.restore(world.save()[:-8])
