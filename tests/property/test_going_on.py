"""A world continues with the same bits wherever it was saved and whatever its neighbours are."""

from __future__ import annotations

import copy
import math

import numpy as np
from hypothesis import event as hypothesis_event, given, settings, strategies as st

from boards import edited, full_table
from silverball.errors import FaultError, StateError
from silverball.physics.audit import deepest
from silverball.table import Table, generate_table
from silverball.world import World, WorldBatch
from spinning import spin_balls

RATES = st.sampled_from([10, 60, 240, 977])
boards = st.tuples(
    st.integers(0, 40),
    st.fixed_dictionaries(
        {
            "friction": st.sampled_from([0.0, 0.02, 0.2, 2.0]),
            "rolling": st.booleans(),
            "slope": st.floats(1, 60),
            "gravity": st.floats(0.1, 40) | st.floats(0.0, 0.1) | st.just(0.0),
            "ball_restitution": st.floats(0, 1),
            "wall_restitution": st.floats(0, 1),
        }
    ),
)
spins = st.tuples(*[st.floats(-100, 100)] * 3)
rows = st.lists(
    st.tuples(st.booleans(), st.booleans(), st.booleans(), st.booleans()), min_size=1, max_size=25
)
"""Left, right, jitter, and whether a new ball is wanted; each for some ticks."""


def table_of_numbers(drawn) -> Table:
    """A board with any friction."""
    number, update = drawn
    table = generate_table(number) if number else full_table()
    update["rolling"] = update["rolling"] and update["friction"] > 0.0
    return table.model_copy(update={"board": table.board.model_copy(update=update)})


def play(world: World, actions, ticks: int) -> list:
    """Play on; all that is seen."""
    seen = []
    for left, right, jitter, new in actions:
        if new and len(world.balls) < 2:
            world.create_ball()
        world.step(left=left, right=right, jitter=jitter, ticks=ticks)
        seen.append((world.digest(), world.events))
    return seen


@settings(max_examples=60)
@given(boards, st.integers(0, 2**63 - 1), RATES, rows, rows, spins, st.integers(1, 9), st.integers(1, 9))
def test_a_world_saved_at_any_moment_goes_on_bit_for_bit(
    board, seed, tick_rate, before, after, spin, ticks, later
) -> None:
    table = table_of_numbers(board)
    world = World(table, seed, tick_rate)
    world.create_ball()
    spin_balls(world, spin)
    play(world, before, ticks)
    state, twin = world.save(), copy.deepcopy(world)
    seen = play(world, after, later)
    assert play(twin, after, later) == seen
    other = World(table, 1, tick_rate)
    play(other, after, 3)  # whatever it did before
    other.restore(state)
    assert other.save() == state
    assert play(other, after, later) == seen


@settings(max_examples=30)
@given(st.lists(boards, min_size=2, max_size=5), st.integers(0, 2**62), RATES, rows, st.integers(1, 9))
def test_a_world_alone_is_the_same_world_among_others(drawn, seed, tick_rate, actions, ticks) -> None:
    tables = [table_of_numbers(board) for board in drawn]
    batch = WorldBatch(tables, len(tables), seed, tick_rate)
    alone = [World(table, seed + number, tick_rate) for number, table in enumerate(tables)]
    for left, right, jitter, new in actions:
        if new:
            batch.create_balls()
        # Each world has the buttons of its neighbour swapped.
        held = np.array([(left, right, jitter), (right, left, jitter)] * 3)[: len(tables)]
        batch.step(held, ticks)
        for number, world in enumerate(alone):
            if new and len(world.balls) < world.table.board.max_balls:
                world.create_ball()
            world.step(*held[number].tolist(), ticks=ticks)
            assert world.digest() == batch.digests()[number]


@settings(max_examples=60)
@given(
    boards,
    st.integers(0, 2**63 - 1),
    RATES,
    rows,
    st.lists(spins, min_size=1, max_size=25),
    st.integers(1, 40),
)
def test_whatever_is_pressed_and_however_a_ball_spins_all_stays_finite_and_outside(
    board, seed, tick_rate, actions, turns, ticks
) -> None:
    table = table_of_numbers(board)
    world = World(table, seed, tick_rate)
    for number, (left, right, jitter, new) in enumerate(actions):
        if new and len(world.balls) < 2:
            world.create_ball()
        spin_balls(world, *[turns[number % len(turns)]] * len(world.balls))
        world.step(left=left, right=right, jitter=jitter, ticks=ticks)
        assert world.fault is None
        assert deepest(*world.records) <= 1e-9
        for ball in world.balls:
            assert all(math.isfinite(n) for n in (*ball.position, *ball.velocity, *ball.spin))
            assert math.hypot(*ball.velocity) <= table.board.speed_cap


wild = st.floats() | st.sampled_from([0.0, -0.0, 1e300, -1e300, 30.0, -0.01])
NUMBERS = (
    "start_x",
    "start_z",
    "start_vx",
    "start_vz",
    "accel_x",
    "accel_z",
    "roll_age",
    "offset",
    "age",
    "contact_age",
)
COUNTS = ("contact_row", "motion", "ticks")


@settings(max_examples=150)
@given(
    st.sampled_from([{}, {"friction": 0.2}, {"friction": 0.2, "rolling": True}]),
    st.integers(0, 40),
    st.lists(st.tuples(st.sampled_from(NUMBERS), wild), max_size=3),
    st.lists(
        st.tuples(st.sampled_from(COUNTS), st.integers(-6, 20) | st.integers(-(2**63), 2**63 - 1)), max_size=2
    ),
)
def test_whatever_flight_a_state_claims_for_a_ball_it_stays_finite_or_ends_in_a_named_fault(
    rub, ticks, numbers, counts
) -> None:
    """A flight made up by hand may lead a ball anywhere, but not the step astray."""
    world = World(full_table(**rub), tick_rate=60)
    world.create_ball((1.5, 2.0), (6.0, 7.0))
    world.step(ticks=ticks)

    def claim(record) -> None:
        for name, number in (*numbers, *counts):
            record["ball"][name][0] = number

    try:
        world.restore(edited(world, claim))
        for _ in range(30):
            world.step(left=True)
            assert all(math.isfinite(n) for ball in world.balls for n in (*ball.position, *ball.velocity))
    except (StateError, FaultError) as error:
        hypothesis_event(type(error).__name__)
