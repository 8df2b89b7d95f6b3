"""Sensors, one-way gates, spinners, holes, plungers, drop targets and levels on a table in play.

Flights are parabolas: gravity is 10 u/s² down the table and there is no friction, so each expected time is
worked out here. Times of events must not depend on the tick rate.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from silverball.table import Board, Table
from silverball.table.kinds.gate import Gate
from silverball.table.kinds.hole import Hole
from silverball.table.kinds.level import Level, Passage
from silverball.table.kinds.plunger import Plunger
from silverball.table.kinds.rollover import Rollover
from silverball.table.kinds.slant_wall import SlantWall
from silverball.table.kinds.spinner import Spinner
from silverball.table.kinds.target import DropTarget
from silverball.world import World

GRAVITY = 10.0
RATES = (60, 240, 1000)
TIME_BOUND = 1e-12  # [s]


def world_of(tick_rate: int = 240, board: dict[str, Any] | None = None, seed: int = 0, **parts: Any) -> World:
    """A world with these parts, each a tuple by the name of its kind, and room for all balls."""
    table = Table(format=2, name="devices", board=Board(max_balls=8, **(board or {})), **parts)
    return World(table, tick_rate=tick_rate, seed=seed)


def played(world: World, seconds: float, **buttons: bool) -> list[Any]:
    """All events of a time, tick by tick: time [s], kind, part, ball."""
    found = []
    for _ in range(round(seconds * world.tick_rate)):
        world.step(**buttons)
        found += [
            (event.tick / world.tick_rate + event.offset, event.kind, event.part, event.ball)
            for event in world.events
        ]
    return found


def times(events: list[Any], kind: str, part: str | None = None) -> list[float]:
    return [time for time, is_kind, which, _ in events if is_kind == kind and part in (None, which)]


# --- sensors -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", RATES)
def test_a_ball_crosses_a_line_upwards_and_downwards_at_exact_times(rate: int) -> None:
    world = world_of(rate, rollover=(Rollover(start=(2.0, -1.0), end=(2.0, 1.0)),))
    world.create_ball((0.0, 0.2), (8.0, 0.5))
    root = math.sqrt(64 - 40)
    expected = [(8 - root) / GRAVITY, (8 + root) / GRAVITY]
    assert times(played(world, 1.5), "pass") == pytest.approx(expected, abs=TIME_BOUND)


@pytest.mark.parametrize("rate", RATES)
def test_a_ball_enters_a_round_sensor_twice_in_one_flight(rate: int) -> None:
    world = world_of(rate, rollover=(Rollover(center=(2.0, 0.0), radius=0.5),))
    world.create_ball((0.0, 0.0), (9.0, 0.0))  # its apex is at 4.05
    expected = [(9 - math.sqrt(81 - 30)) / GRAVITY, (9 + math.sqrt(81 - 50)) / GRAVITY]
    assert times(played(world, 1.6), "pass") == pytest.approx(expected, abs=TIME_BOUND)


@pytest.mark.parametrize("rate", RATES)
def test_many_lines_at_one_place_are_each_crossed_once(rate: int) -> None:
    lines = tuple(Rollover(start=(2.0, -1.0 - k), end=(2.0, 1.0 + k)) for k in range(4))
    world = world_of(rate, rollover=lines)
    world.create_ball((0.0, 0.0), (9.0, 0.0))
    events = played(world, 1.6)
    for number in range(4):
        assert len(times(events, "pass", f"rollover[{number}]")) == 2


def test_a_flight_over_sensors_keeps_its_bits() -> None:
    lines = tuple(Rollover(start=(x, -4.0), end=(x + 0.3, 4.0)) for x in np.linspace(-6.0, 8.0, 40).tolist())
    discs = tuple(Rollover(center=(x, 0.5), radius=0.7) for x in np.linspace(-6.0, 8.0, 20).tolist())
    bare, full = world_of(), world_of(rollover=(*lines, *discs))
    for world in (bare, full):
        world.create_ball((-3.0, 0.3), (13.0, 1.0))
        world.create_ball((2.0, -2.0), (3.0, -0.9))
    crossings = 0
    for _ in range(400):
        for world in (bare, full):
            world.step()
        assert bare.balls == full.balls
        crossings += sum(event.kind == "pass" for event in full.events)
    assert crossings > 50


# --- gates -------------------------------------------------------------------------------------------------

GATE = Gate(start=(2.0, -2.0), end=(2.0, 2.0), passes="up", thickness=0.05, restitution=0.5)


@pytest.mark.parametrize("rate", RATES)
def test_a_ball_passes_a_gate_and_is_blocked_when_it_falls_back_in_the_same_flight(rate: int) -> None:
    world = world_of(rate, gate=(GATE,))
    world.create_ball((0.0, 0.0), (9.0, 0.0))
    events = played(world, 1.6)
    contact = (9 + math.sqrt(81 - 20 * 2.3)) / GRAVITY
    assert times(events, "hit", "gate[0]") == pytest.approx([contact], abs=TIME_BOUND)
    assert world.balls[0].position[0] > 2.3


def test_a_ball_that_turns_back_in_a_gate_falls_out_of_it() -> None:
    world = world_of(gate=(GATE,))
    world.create_ball((0.0, 0.0), (math.sqrt(20 * 2.2), 0.0))  # up to 2.2: it overlaps the gate
    events = played(world, 1.2)
    assert times(events, "hit") == []
    assert times(events, "touch") == []
    assert world.balls[0].position[0] < 1.0
    assert world.fault is None


def test_a_ball_lies_on_a_gate_forever() -> None:
    gate = Gate(start=(2.0, -2.0), end=(2.6, 0.0), passes="up")
    wall = SlantWall(start=(2.0, -2.0), end=(5.0, -2.5))  # it keeps the ball from rolling off
    world = world_of(gate=(gate,), slant_wall=(wall,))
    world.create_ball((4.0, -1.0), (0.0, 0.0))
    played(world, 29.0)
    assert len(times(played(world, 1.0), "touch", "gate[0]")) > 10
    assert world.balls[0].position[0] > 2.0
    assert world.fault is None


# --- spinners ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", RATES)
def test_a_spinner_turns_at_the_times_of_its_decay(rate: int) -> None:
    spinner = Spinner(start=(2.0, -1.0), end=(2.0, 1.0), damping=2.0, height=0.3)
    world = world_of(rate, spinner=(spinner,), rollover=(Rollover(start=(9.9, -5.0), end=(9.9, 5.0)),))
    world.create_ball((0.0, 0.0), (12.0, 0.0))  # it comes back after 2.2 s
    events = played(world, 2.1)
    speed = math.sqrt(144 - 40)
    crossing = (12 - speed) / GRAVITY
    omega = speed / 0.3
    expected = []
    while (share := 2.0 * (2 * len(expected) + 1) * math.pi / omega) < 1:
        expected.append(crossing - math.log1p(-share) / 2.0)
    expected = [time for time in expected if time < 2.0]
    turns = [time for time in times(events, "spin") if time < 2.0]
    assert len(expected) >= 2
    assert turns == pytest.approx(expected, abs=TIME_BOUND)


# --- holes and plungers ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("difference", "is_caught"), [(-1e-9, False), (1e-9, True)])
def test_a_hole_captures_up_to_its_speed(difference: float, is_caught: bool) -> None:
    entry = math.sqrt(81 - 20 * 1.5)  # at the edge of the hole
    hole = Hole(
        center=(2.0, 0.0), radius=0.5, capture_speed=entry + difference, exit=(5.0, 3.0),
        exit_velocity=(0.0, 0.0), hold=0.25,
    )  # fmt: skip
    world = world_of(hole=(hole,))
    world.create_ball((0.0, 0.0), (9.0, 0.0))
    assert len(times(played(world, 0.4), "captured")) == is_caught


@pytest.mark.parametrize("rate", RATES)
def test_a_hole_sends_its_ball_off_after_its_time(rate: int) -> None:
    hole = Hole(
        center=(2.0, 0.0), radius=0.5, capture_speed=15.0, exit=(5.0, 3.0), exit_velocity=(-2.0, 3.0),
        hold=0.3, spread=0.0,
    )  # fmt: skip
    world = world_of(rate, hole=(hole,))
    world.create_ball((0.0, 0.0), (9.0, 0.0))
    events = played(world, 0.6)
    caught = (9 - math.sqrt(81 - 30)) / GRAVITY
    assert times(events, "captured") == pytest.approx([caught], abs=TIME_BOUND)
    assert times(events, "released") == pytest.approx([caught + 0.3], abs=TIME_BOUND)
    flown = world.time - caught - 0.3
    (ball,) = world.balls
    assert ball.position[0] == pytest.approx(5.0 - 2.0 * flown - 5.0 * flown**2, abs=1e-11)
    assert ball.position[2] == pytest.approx(3.0 + 3.0 * flown, abs=1e-11)


def test_a_drain_takes_the_ball() -> None:
    world = world_of(hole=(Hole(center=(2.0, 0.0), radius=0.5, drain=True),))
    world.create_ball((0.0, 0.0), (9.0, 0.0))
    played(world, 0.5)
    assert (world.balls, world.drained) == ((), 1)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("held", [0.1, 0.5, 1.0, 1.7])
def test_a_plunger_launches_by_the_time_of_its_press(rate: int, held: float) -> None:
    plunger = Plunger(position=(-6.0, 4.0), launch=(5.0, 15.0), charge=1.0)
    world = world_of(rate, plunger=(plunger,))
    world.create_ball()
    assert world.balls[0].position[::2] == (-6.0, 4.0)
    played(world, 0.2)
    assert world.balls[0].position[::2] == (-6.0, 4.0)
    played(world, held, launch=True)
    assert world.balls[0].position[::2] == (-6.0, 4.0)
    world.step()
    speed = 5.0 + 10.0 * min(held, 1.0) - GRAVITY / rate
    assert world.balls[0].velocity[0] == pytest.approx(speed, abs=1e-12)


# --- drop targets ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", RATES)
def test_a_bank_comes_back_together_after_its_last_target_has_fallen(rate: int) -> None:
    bank = tuple(
        DropTarget(start=(2.0, z), end=(2.0, z + 1.0), bank="b", reset_after=0.5, restitution=0.3)
        for z in (-2.0, 0.5)
    )
    world = world_of(rate, drop_target=bank)
    world.create_ball((0.0, -1.5), (9.0, 0.0))
    world.create_ball((-1.0, 1.0), (9.0, 0.0))
    events = played(world, 1.0)
    edge = 2.0 - 0.25 - bank[0].thickness
    falls = [(9 - math.sqrt(81 - 20 * (edge - x))) / GRAVITY for x in (0.0, -1.0)]
    assert sorted(times(events, "hit")) == pytest.approx(falls, abs=TIME_BOUND)
    assert times(events, "reset") == pytest.approx([falls[1] + 0.5] * 2, abs=TIME_BOUND)


def test_a_bank_does_not_come_back_into_a_ball() -> None:
    target = DropTarget(start=(2.0, -1.0), end=(2.0, 1.0), reset_after=0.5, restitution=0.3)
    world = world_of(board={"gravity": 0.0}, drop_target=(target,))
    world.create_ball((0.0, 0.0), (5.0, 0.0))
    assert len(times(played(world, 0.4), "hit")) == 1
    world.create_ball((2.0, 0.6), (0.0, 0.0))  # it lies where the target was
    events = played(world, 3.0)
    assert times(events, "reset") == []
    assert world.fault is None


# --- levels ------------------------------------------------------------------------------------------------


UP = Passage.model_validate({"start": (2.0, -1.0), "end": (2.0, 1.0), "from": 0, "to": 1})
LEVELS = {"passage": (UP,), "level": (Level(number=1),)}


@pytest.mark.parametrize("rate", RATES)
def test_a_passage_leads_up_and_down(rate: int) -> None:
    """Above the passage the ball meets the wall of level 1 and not that of level 0."""
    below = SlantWall(start=(3.0, -1.0), end=(3.0, 1.0), levels=(0,))
    above = SlantWall(
        start=(4.0, -1.0), end=(4.0, 1.0), levels=(1,), restitution=1.0, restitution_falloff=0.0
    )
    world = world_of(rate, slant_wall=(below, above), **LEVELS)
    world.create_ball((0.0, 0.0), (10.0, 0.0))
    events = played(world, 1.0)
    assert len(times(events, "hit", "slant_wall[1]")) == 1
    assert times(events, "hit", "slant_wall[0]") == []
    assert len(times(events, "pass")) == 2
    assert world.balls[0].position[0] < 2.0


@pytest.mark.parametrize("is_passage_there", [False, True])
def test_balls_on_two_levels_cross_and_balls_on_one_level_meet(is_passage_there: bool) -> None:
    world = world_of(board={"gravity": 0.0}, **(LEVELS if is_passage_there else {}))
    world.create_ball((1.0, 0.0), (4.0, 0.0))
    world.create_ball((6.0, 0.0), (-2.0, 0.0))
    assert (times(played(world, 0.9), "ball_hit") == []) == is_passage_there  # they meet at 4.3


# --- all together ------------------------------------------------------------------------------------------


def world_of_all(rate: int) -> World:
    """Three balls among devices of most kinds."""
    world = world_of(
        rate,
        rollover=(Rollover(start=(1.0, -5.0), end=(1.2, 5.0)), Rollover(center=(-2.0, 1.0), radius=0.6)),
        gate=(Gate(start=(-3.0, -4.0), end=(-3.2, 4.0), passes="up"),),
        spinner=(Spinner(start=(3.0, -3.0), end=(3.0, 3.0), drag=0.5),),
        hole=(
            Hole(
                center=(-2.6, 2.0), radius=0.4, capture_speed=30.0, exit=(-1.0, 2.0),
                exit_velocity=(11.0, 1.0), hold=0.2, spread=20.0,
            ),
        ),
        drop_target=(DropTarget(start=(5.0, -4.0), end=(5.0, 4.0), reset_after=0.4),),
        **LEVELS,
    )  # fmt: skip
    for z in (-2.0, 0.3, 2.0):
        world.create_ball((0.0, z), (12.0, 0.7 * z))
    return world


@pytest.mark.parametrize("rate", RATES)
def test_ticks_in_one_call_and_one_by_one_give_the_same_bits(rate: int) -> None:
    one, many = world_of_all(rate), world_of_all(rate)
    kinds = set()
    for _ in range(12):
        for _ in range(rate // 2):
            one.step()
            kinds |= {event.kind for event in one.events}
        many.step(ticks=rate // 2)
        assert one.digest() == many.digest()
    assert kinds >= {"pass", "spin", "captured", "released", "hit", "touch", "reset"}


def test_a_world_restored_at_any_tick_goes_on_the_same() -> None:
    world, other = world_of_all(240), world_of_all(240)
    world.step()
    for _ in range(960):
        other.restore(world.save())
        for one in (world, other):
            one.step()
        assert world.digest() == other.digest()
        assert world.events == other.events
