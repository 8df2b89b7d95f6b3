"""Devices: sensors, passages, spinners, holes, plungers, drop targets and gates, in worlds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from device_boards import LANE, TARGETS, everything, play, table_with
from silverball.errors import NoRoom
from silverball.physics import records
from silverball.physics.records import NO_CLOCK
from silverball.table.kinds import (
    Cylinder,
    Gate,
    Hole,
    Level,
    Passage,
    Plunger,
    Rollover,
    SlantWall,
    Spinner,
)
from silverball.world import World, WorldBatch

RATES = (60, 240, 1000)


def events_of(world: World, ticks: int, **buttons) -> list:
    """All events of a number of ticks, played one by one."""
    found = []
    for _ in range(ticks):
        world.step(**buttons)
        found += world.events
    return found


def times_of(world: World, kind: str, seconds: float, **buttons) -> list[tuple[str, float]]:
    """The parts and times [s] of all events of a kind."""
    events = events_of(world, round(seconds * world.tick_rate), **buttons)
    return [(e.part, e.tick / world.tick_rate + e.offset) for e in events if e.kind == kind]


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_sensor_is_crossed_twice_at_the_exact_times_of_the_parabola(tick_rate: int) -> None:
    world = World(table_with(LANE, gravity=10.0), tick_rate=tick_rate)
    world.create_ball(position=(0.0, 0.0), velocity=(8.0, 0.0))
    times = times_of(world, "pass", 1.6)
    root = math.sqrt(64.0 - 40.0)
    assert [part for part, _ in times] == ["rollover[0]"] * 2
    assert [time for _, time in times] == pytest.approx([(8 - root) / 10, (8 + root) / 10], abs=1e-12)
    assert world.hits["rollover[0]"] == 2


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_flight_over_sensors_keeps_its_bits(tick_rate: int) -> None:
    sensors = (LANE, Rollover(center=(3.0, 0.4), radius=0.5), Spinner(start=(4.0, -3.0), end=(4.0, 3.0)))
    obstacle = Cylinder(center=(6.0, 0.9), radius=0.6)
    with_sensors, without = (World(table_with(*parts, obstacle), 3, tick_rate) for parts in (sensors, ()))
    for world in (with_sensors, without):
        world.create_ball(position=(0.0, 0.1), velocity=(13.0, 0.5))
        world.step(ticks=3 * tick_rate)
    assert with_sensors.hits["rollover[0]"] > 0
    names = ["x", "z", "vx", "vz", "start_x", "start_z", "start_vx", "start_vz", "ticks", "offset"]
    one, other = (world.records[0]["ball"][0][names].tolist() for world in (with_sensors, without))
    assert one == other


def test_a_ball_is_captured_below_the_capture_speed_only() -> None:
    hole = Hole(
        center=(2.0, 0.0), radius=0.3, capture_speed=5.0, hold=0.5, exit_velocity=(-3.0, 1.0), spread=0.0
    )
    for speed, kinds in ((5.0 - 1e-9, ["captured"]), (5.0 + 1e-9, [])):
        world = World(table_with(hole, gravity=0.0), tick_rate=240)
        world.create_ball(position=(0.0, 0.0), velocity=(speed, 0.0))
        events = events_of(world, 200)
        assert [e.kind for e in events if e.kind == "captured"] == kinds


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_hole_lets_go_at_the_exact_time(tick_rate: int) -> None:
    hole = Hole(
        center=(2.0, 0.0), radius=0.3, capture_speed=9.0, hold=0.5, exit=(-2.0, 2.0),
        exit_velocity=(3.0, 1.0), spread=0.0,
    )  # fmt: skip
    world = World(table_with(hole, gravity=0.0), tick_rate=tick_rate)
    world.create_ball(position=(0.0, 0.0), velocity=(4.0, 0.0))
    events = events_of(world, tick_rate)
    captured, released = (next(e for e in events if e.kind == kind) for kind in ("captured", "released"))
    time = captured.tick / tick_rate + captured.offset
    assert time == pytest.approx(1.7 / 4.0, abs=1e-12)
    assert released.tick / tick_rate + released.offset == pytest.approx(time + 0.5, abs=1e-12)
    (ball,) = world.balls
    left = 1.0 - time - 0.5
    assert ball.position == pytest.approx((-2.0 + 3.0 * left, 1.0, 2.0 + 1.0 * left), abs=1e-9)
    assert world.hits["hole[0]"] == 1


def test_a_drain_takes_a_ball_away() -> None:
    world = World(table_with(Hole(center=(2.0, 0.0), radius=0.3, drain=True), gravity=0.0))
    world.create_ball(position=(0.0, 0.0), velocity=(4.0, 0.0))
    events = events_of(world, 240)
    assert [(e.kind, e.part) for e in events] == [("created", ""), ("gutter", "hole[0]")]
    assert (world.drained, world.balls) == (1, ())


def test_a_captured_ball_is_a_fixed_disc_to_others_and_is_not_shoved() -> None:
    hole = Hole(center=(2.0, 0.0), radius=0.3, capture_speed=9.0, hold=20.0, exit_velocity=(0.0, 1.0))
    world = World(table_with(hole, gravity=0.0, ball_restitution=1.0))
    world.create_ball(position=(1.0, 0.0), velocity=(4.0, 0.0))
    world.step(ticks=240)
    world.create_ball(position=(-1.0, 0.0), velocity=(4.0, 0.0))
    events = events_of(world, 240)
    assert [e.kind for e in events if e.kind != "created"] == ["ball_hit"]
    held, other = world.balls
    assert held.position == (2.0, 1.0, 0.0)
    assert other.velocity == pytest.approx((-4.0, 0.0, 0.0))
    world.step(jitter=True)
    assert world.balls[0].velocity == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("tick_rate", RATES)
@pytest.mark.parametrize("held", [0.1, 0.5, 2.0])
def test_a_plunger_launches_at_the_speed_of_its_charge(tick_rate: int, held: float) -> None:
    plunger = Plunger(position=(-5.0, 4.0), launch=(8.0, 20.0), charge=1.0)
    world = World(table_with(plunger), tick_rate=tick_rate)
    ball = world.create_ball()
    assert ball.position == (-5.0, 1.0, 4.0)
    ticks = round(held * tick_rate)
    world.step(ticks=tick_rate)
    world.step(launch=True, ticks=ticks)
    assert world.balls[0].position == (-5.0, 1.0, 4.0)
    (event,) = [e for e in events_of(world, 1) if e.kind == "released"]
    assert event.part == "plunger[0]"
    assert event.speed == pytest.approx(8.0 + 12.0 * min(ticks / tick_rate, 1.0), abs=1e-12)
    assert world.balls[0].velocity[0] > 0.0


def test_drop_targets_fall_and_come_back_together_but_not_under_a_ball() -> None:
    world = World(table_with(*TARGETS, gravity=0.0, max_balls=3))
    for z in (-0.6, 0.6):
        world.create_ball(position=(2.0, z), velocity=(8.0, 0.0))
    events = events_of(world, 120)
    hits = [e for e in events if e.kind == "hit" and e.part.startswith("drop_target")]
    assert [e.part for e in hits] == ["drop_target[0]", "drop_target[1]"]
    assert world.records[0]["off"] == 3
    world.create_ball(position=(3.0, 0.6))  # where the target was
    assert not [e for e in events_of(world, 240) if e.kind == "reset"]
    world.records[0]["ball"]["vz"][world.records[0]["ball"]["id"] == 3] = 4.0
    resets = [e.part for e in events_of(world, 240) if e.kind == "reset"]
    assert resets == ["drop_target[0]", "drop_target[1]"]
    assert world.records[0]["off"] == 0
    assert world.records[0]["next_clock"] == NO_CLOCK


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_bank_comes_back_at_the_exact_time(tick_rate: int) -> None:
    world = World(table_with(TARGETS[0], gravity=0.0), tick_rate=tick_rate)
    world.create_ball(position=(2.0, -0.6), velocity=(8.0, 0.0))
    events = events_of(world, tick_rate)
    hit, reset = (next(e for e in events if e.kind == kind) for kind in ("hit", "reset"))
    assert (reset.tick - hit.tick) / tick_rate + reset.offset - hit.offset == pytest.approx(0.5, abs=1e-12)


def test_a_one_way_gate_passes_one_way() -> None:
    gate = Gate(start=(3.0, -1.0), end=(3.0, 1.0), passes="up", restitution=1.0, restitution_falloff=0.0)
    for x, speed, blocked in ((1.0, 6.0, False), (5.0, -6.0, True)):
        world = World(table_with(gate, gravity=0.0))
        world.create_ball(position=(x, 0.0), velocity=(speed, 0.0))
        events = events_of(world, 120)
        assert any(e.part == "gate[0]" for e in events) == blocked
        assert world.balls[0].position[0] > 3.0


def test_a_held_gate_opens_and_does_not_close_on_a_ball() -> None:
    gate = Gate(start=(3.0, -1.0), end=(3.0, 1.0), held=True, name="door")
    world = World(table_with(gate, gravity=0.0))
    world.create_ball(position=(1.0, 0.0), velocity=(2.0, 0.0))
    assert world.open_gate("door")
    world.step(ticks=240)
    assert not any(e.part == "gate[0]" for e in world.events)
    assert world.balls[0].position[0] == pytest.approx(3.0)
    assert not world.open_gate("door", False)
    world.step(ticks=240)
    assert world.open_gate("gate[0]", False)
    with pytest.raises(ValueError, match=r"\['gate\[0\]'\], got 'window'"):
        world.open_gate("window")


def test_a_passage_changes_the_level_and_balls_of_two_levels_do_not_meet() -> None:
    line = Passage(start=(0.0, 1.0), end=(0.0, -1.0), **{"from": 0, "to": 1})
    parts = (line, Level(number=1, gravity=(-2.0, 0.5)), Cylinder(center=(4.0, 0.0), radius=0.6))
    up = -1.0 if line.left_normal[0] < 0.0 else 1.0
    world = World(table_with(*parts, gravity=0.0, max_balls=3))
    world.create_ball(position=(-up, 0.0), velocity=(6.0 * up, 0.0))
    world.create_ball(position=(2.0 * up, 0.0))
    events = events_of(world, 100)
    assert events[2].kind == "pass"
    assert not any(e.kind.startswith("ball") for e in events)
    assert world.records[0]["ball"]["level"][:2].tolist() == [1, 0]
    time = 100 / 240 - 1.0 / 6.0
    assert world.balls[0].position[2] == pytest.approx(0.25 * time * time, abs=1e-9)


def test_a_passage_throws_a_ball_back_where_another_one_is_in_the_way() -> None:
    line = Passage(start=(0.0, 1.0), end=(0.0, -1.0), **{"from": 0, "to": 1})
    world = World(table_with(line, gravity=0.0))
    up = -1.0 if line.left_normal[0] < 0.0 else 1.0
    world.create_ball(position=(0.4 * up, 0.0))
    world.records[0]["ball"]["level"][0] = 1
    world.create_ball(position=(-up, 0.0), velocity=(6.0 * up, 0.0))
    world.step(ticks=120)
    assert world.records[0]["ball"]["level"][:2].tolist() == [1, 0]
    assert world.balls[1].velocity == pytest.approx((-6.0 * up, 0.0, 0.0))


def test_a_ball_that_a_passage_throws_back_touches_it() -> None:
    line = Passage(start=(0.0, 1.0), end=(0.0, -1.0), **{"from": 0, "to": 1})
    lid = SlantWall(start=(0.1, -1.0), end=(0.1, 1.0), levels=(1,))
    world = World(table_with(line, lid, gravity=0.0))
    up = -1.0 if line.left_normal[0] < 0.0 else 1.0
    world.create_ball(position=(-up, 0.0), velocity=(6.0 * up, 0.0))
    (event,) = [event for event in events_of(world, 120) if event.part]
    assert (event.kind, event.part, event.speed) == ("touch", "passage[0]", pytest.approx(6.0))
    assert event.normal[0] == pytest.approx(-up)
    assert event.tick / 240 + event.offset == pytest.approx(1.0 / 6.0, abs=1e-12)
    assert world.hits["passage[0]"] == 0


def test_a_new_ball_is_on_the_level_of_its_plunger() -> None:
    plunger = Plunger(position=(-3.0, 2.0), launch=(10.0, 10.0), level=1)
    lid = Cylinder(center=(-3.0, 2.2), radius=0.5)  # on level 0 only
    stop = SlantWall(start=(0.0, 1.0), end=(0.0, 3.0), levels=(1,))
    world = World(table_with(plunger, lid, stop, Level(number=1)))
    world.create_ball()
    assert world.records[0]["ball"]["level"][0] == 1
    world.step(launch=True, ticks=10)
    parts = [event.part for event in events_of(world, 240) if event.kind in ("hit", "touch")]
    assert parts[0] == "slant_wall[0]"
    blocked = World(table_with(plunger, Cylinder(center=(-3.0, 2.2), radius=0.5, level=1), Level(number=1)))
    with pytest.raises(NoRoom):
        blocked.create_ball()


@pytest.mark.parametrize("tick_rate", RATES)
def test_a_spinner_turns_as_its_closed_form_says(tick_rate: int) -> None:
    spinner = Spinner(start=(2.0, -1.0), end=(2.0, 1.0), damping=2.0, height=0.3)
    world = World(table_with(spinner, gravity=0.0), tick_rate=tick_rate)
    world.create_ball(position=(0.0, 0.0), velocity=(10.0, 0.0))
    times = [time for _, time in times_of(world, "spin", 1.8)]
    omega = 10.0 / 0.3
    expected = []
    while (share := 2.0 * (2 * len(expected) + 1) * math.pi / omega) < 1.0:
        expected.append(0.2 - math.log1p(-share) / 2.0)
    assert times == pytest.approx(expected, abs=1e-12)
    assert len(times) > 2


@pytest.mark.parametrize("tick_rate", [60, 240])
def test_worlds_with_all_devices_go_on_from_any_tick_to_the_bit(tick_rate: int) -> None:
    world = World(everything(), 5, tick_rate)
    other = World(everything(), 5, tick_rate)
    rng, same = np.random.default_rng(0), np.random.default_rng(0)
    seen: set[str] = set()
    for tick in range(25 * tick_rate):
        play(world, tick, rng)
        other.restore(other.save())
        play(other, tick, same)
        seen |= {event.kind for event in world.events}
        assert world.digest() == other.digest(), tick
    assert seen >= {"pass", "spin", "captured", "released", "reset", "hit", "ball_hit", "gutter"}
    assert not world.fault


def test_skipping_ahead_gives_the_bits_of_tick_by_tick() -> None:
    one, other = (World(everything(), 9, 240) for _ in range(2))
    for world in (one, other):
        for _ in range(3):
            world.create_ball()
            world.step(launch=True, ticks=70)
            world.step(ticks=10)
    for _ in range(40):
        one.step(ticks=60)
        for _ in range(60):
            other.step()
        assert one.digest() == other.digest()


def test_a_batch_with_all_devices_is_its_single_worlds() -> None:
    table = everything()
    batch = WorldBatch(table, 4, 11, 60)
    worlds = [World(table, 11 + index, 60) for index in range(4)]
    rng = np.random.default_rng(1)
    for tick in range(200):
        actions = rng.random((4, 4)) < (0.3, 0.3, 0.02, 0.8)
        if tick % 20 == 0:
            created = batch.create_balls()
            for world, is_new in zip(worlds, created, strict=True):
                if is_new:
                    world.create_ball()
        batch.step(actions, 2)
        for world, (left, right, jitter, launch) in zip(worlds, actions.tolist(), strict=True):
            world.step(left, right, jitter, 2, launch)
    assert batch.digests() == [world.digest() for world in worlds]


def test_no_field_of_a_record_hides_behind_an_attribute_of_numpy() -> None:
    """Without the compiler `record.shape` would be the shape of the record, not a field of this name."""
    dtypes = [value for value in vars(records).values() if isinstance(value, np.dtype)]
    names = {name for dtype in dtypes for name in dtype.names or ()}
    assert len(dtypes) > 7
    assert not names & {*dir(np.record), *dir(np.recarray)}
