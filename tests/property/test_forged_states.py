"""Whatever a state from outside claims, no ball gets into anything: it continues, or it is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import event as hypothesis_event, given, settings, strategies as st

from boards import edited, full_table, launched
from silverball.errors import FaultError, StateError
from silverball.physics.audit import deepest
from silverball.physics.records import BALL, PLAIN_BALL
from silverball.table import Table, table_digest
from silverball.world import Snapshot, World, WorldBatch

DEPTH = 1e-9
RUBS: tuple[dict[str, Any], ...] = (
    {},
    {"friction": 0.2},
    {"friction": 0.2, "rolling": True},
    {"gravity": 0.0},
    {"max_balls": 3},  # worlds that are not plain have more fields
)
FIELDS = tuple(BALL.names or ())


def has_field(rub: dict[str, Any], name: str) -> bool:
    """Whether the balls of worlds on this board have a field."""
    return "max_balls" in rub or name in (PLAIN_BALL.names or ())


TICK = 1 / 60


def board(rub: dict[str, Any]) -> Table:
    """A board full of parts."""
    return full_table(**rub)


STRAYS: dict[str, tuple[World, bytes]] = {}


def stray(table: Table, tick_rate: int) -> World:
    """A world that has played something else; the same one is used again and again."""
    key = f"{table_digest(table)} {tick_rate}"
    if key not in STRAYS:
        other = World(table, 5, tick_rate)
        other.create_ball()
        other.step(right=True, ticks=40)
        STRAYS[key] = other, other.save()
    other, state = STRAYS[key]
    other.restore(state)
    return other


def played(table: Table, ticks: int, buttons: bool = False) -> World:
    """A world in the middle of a game with two balls, one of them fast and soon at the parts."""
    world = launched(table, (1.5, 2.0, 6.0, 7.0), (3.7, -0.3, -4.0, 9.0), tick_rate=60)
    world.step(left=buttons, ticks=ticks)
    return world


def through_restore(world: World, change: Callable[[Any], None]) -> WorldBatch:
    """The bytes of a world, changed and restored into itself."""
    world.restore(edited(world, change))
    return world._batch


def through_another_world(world: World, change: Callable[[Any], None]) -> WorldBatch:
    """The same, restored into a world that has played something else."""
    other = stray(world.table, world.tick_rate)
    other.restore(edited(world, change))
    return other._batch


def through_a_snapshot(world: World, change: Callable[[Any], None]) -> WorldBatch:
    """The bytes of a snapshot of many."""
    batch = WorldBatch(world.table, 3, 0, world.tick_rate)
    batch.state[1] = world.records[0]
    saved = batch.save()
    records = saved.records.copy()
    change(records[1])
    made = Snapshot(records, saved.tables, saved.table_of.copy(), saved.tick_rate, saved.plain)
    batch.restore(Snapshot.from_bytes(bytes(made)))
    return batch


def through_the_array(world: World, change: Callable[[Any], None]) -> WorldBatch:
    """Numbers written into the record of a world that plays."""
    change(world.records[0])
    return world._batch


WAYS = (through_restore, through_another_world, through_a_snapshot, through_the_array)


def plays_on_outside(way, world: World, change: Callable[[Any], None]) -> str:
    """Forge a state and play on; "played", "refused", or the name of the fault."""
    start = deepest(*world.records)
    assert start <= DEPTH
    try:
        batch = way(world, change)
    except StateError:
        return "refused"
    row = 1 if len(batch) > 1 else 0
    state, boards = batch.state, batch.boards
    for tick in range(15):
        held = np.zeros((1, len(batch), 3), np.bool_)
        held[..., 0] = tick % 8 < 4
        batch.step_unchecked(held, 1)
        if state["fault"][row]:
            return f"fault {state['fault'][row]}"
        assert deepest(state[row], boards.board[0], boards.collider) <= DEPTH
        balls = state["ball"][row]
        assert all(np.isfinite(balls[name]).all() for name in ("x", "z", "vx", "vz"))
    return "played"


LATER = {
    name: [0.2, 0.01, -0.01, 0.25, 1.0, -1.0, 1e-6, 1e9]
    for name in ("contact_age", "age", "offset", "roll_age")
}
STRANGE = [0.0, -0.0, 1e-300, 0.3, -0.3, 7.0, -7.0, 1e9, -1e9, 1e300, math.inf, -math.inf, math.nan]
WHOLE = [0, 1, -1, 2, 3, 5, 7, -2, -3, -5, 12, 10**6, 2**53, 2**62, -(2**62), 2**63 - 1, -(2**63)]


@pytest.mark.parametrize(
    ("rub", "name"), [(rub, name) for rub in RUBS for name in FIELDS if has_field(rub, name)], ids=str
)
@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
def test_no_single_forged_number_leads_a_ball_into_anything(name: str, way, rub) -> None:
    """Each number is replaced, and shifted."""
    table, whole = board(rub), BALL[name].kind == "i"
    saved = {ticks: played(table, ticks).save() for ticks in (3, 26)}
    world = World(table, 0, 60)
    for ticks, state in saved.items():
        for value in WHOLE if whole else STRANGE + LATER.get(name, []):
            for shifts in (False, True):

                def change(record, value=value, shifts=shifts) -> None:
                    old = record["ball"][name][0].item() if shifts else 0
                    new = old + value
                    record["ball"][name][0] = new if not whole or abs(new) < 2**63 else value

                world.restore(state)
                world.step(ticks=ticks % 3)
                plays_on_outside(way, world, change)


@pytest.mark.parametrize("rub", RUBS, ids=str)
@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
@pytest.mark.parametrize("later", [1e-3, 0.01, TICK, 0.1, 0.2, 0.25, 3.0])
def test_a_contact_that_is_put_off_happens_when_it_should(later: float, way, rub) -> None:
    """The forged world goes the way of the honest one: what is due is searched for again."""
    honest, world = played(board(rub), 3), played(board(rub), 3)

    def put_off(record) -> None:
        record["ball"]["contact_age"][:2] += later

    batch = way(world, put_off)
    row = 1 if len(batch) > 1 else 0
    for _ in range(60):
        honest.step()
        batch.step_unchecked(np.zeros((1, len(batch), 3), np.bool_), 1)
        assert batch.state[row].tobytes() == honest.records[0].tobytes()


numbers = st.floats() | st.sampled_from(STRANGE) | st.floats(-10, 10)
wholes = st.sampled_from(WHOLE) | st.integers(-6, 20)


@settings(max_examples=400)
@given(
    st.sampled_from(RUBS), st.integers(0, 40), st.sampled_from(WAYS), st.booleans(),
    st.lists(st.tuples(st.sampled_from(FIELDS), st.integers(0, 1), numbers, wholes), min_size=1, max_size=6),
)  # fmt: skip
def test_no_forged_numbers_together_lead_a_ball_into_anything(rub, ticks, way, keeps_place, forged) -> None:
    def change(record) -> None:
        for name, slot, number, whole in forged:
            if keeps_place and name in ("x", "z", "vx", "vz", "id"):
                continue
            if not has_field(rub, name):
                continue
            record["ball"][name][slot] = whole if BALL[name].kind == "i" else number

    hypothesis_event(plays_on_outside(way, played(board(rub), ticks), change))


@settings(max_examples=200)
@given(
    st.sampled_from(RUBS), st.sampled_from(WAYS), st.floats(0.0, 3.0), st.integers(0, 200), st.booleans(),
    st.floats(0.0, 10.0), st.integers(-6, 16),
)  # fmt: skip
def test_no_flight_that_fits_its_ball_but_comes_through_a_wall_leads_it_on(
    rub, way, age, ticks, is_whole, due, meets
) -> None:
    """A flight made up so well that it leads to the very bits of the ball's place and velocity."""
    world = played(board(rub), 5)

    def change(record) -> None:
        ball = record["ball"][0]
        ball["ticks"], ball["offset"] = (ticks, 0.0) if is_whole else (1, min(max(TICK - age, 0.0), TICK))
        ball["age"] = ball["ticks"] * TICK - ball["offset"]
        a = ball["age"]
        ball["start_vx"], ball["start_vz"] = (
            ball["vx"] - ball["accel_x"] * a,
            ball["vz"] - ball["accel_z"] * a,
        )
        ball["start_x"] = ball["x"] - a * (ball["start_vx"] + 0.5 * ball["accel_x"] * a)
        ball["start_z"] = ball["z"] - a * (ball["start_vz"] + 0.5 * ball["accel_z"] * a)
        ball["vx"], ball["vz"] = (
            ball["start_vx"] + ball["accel_x"] * a,
            ball["start_vz"] + ball["accel_z"] * a,
        )
        ball["x"] = ball["start_x"] + a * (ball["start_vx"] + 0.5 * ball["accel_x"] * a)
        ball["z"] = ball["start_z"] + a * (ball["start_vz"] + 0.5 * ball["accel_z"] * a)
        ball["contact_age"], ball["contact_row"] = due, meets

    hypothesis_event(plays_on_outside(way, world, change))


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("angle", [-3.0, -1.0, -0.5, 0.9, 1.5, 3.1, 9.9, 11.0, math.nan, math.inf])
@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
def test_a_paddle_beyond_its_stops_is_refused_or_a_named_fault(way, angle: float, side: int) -> None:
    def change(record) -> None:
        record["paddle"]["angle"][side] = angle

    assert plays_on_outside(way, played(full_table(), 3), change) in ("refused", "fault 1", "fault 5")


@pytest.mark.parametrize(("x", "z"), [(5.0, 1.0), (2.4, -0.6), (-7.3, -2.0), (0.0, 4.8), (9.9, 0.0)])
def test_a_ball_written_into_a_part_stops_its_world_with_a_named_fault(x: float, z: float) -> None:
    world = played(full_table(), 3)
    world.records[0]["ball"]["x"][0], world.records[0]["ball"]["z"][0] = x, z
    with pytest.raises(FaultError, match="inside"):
        world.step()
    assert world.fault == "inside"


def test_two_balls_written_into_each_other_are_parted() -> None:
    world = played(full_table(), 3)
    ball = world.records[0]["ball"]
    ball["x"][:2], ball["z"][:2] = (3.0, 3.1), (3.0, 3.2)
    world.step()
    assert deepest(*world.records) <= DEPTH


@pytest.mark.parametrize("rub", RUBS, ids=str)
@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_copies_of_rows_go_on_like_their_originals(rub, tick_rate: int) -> None:
    """Rows that change places, row by row and all at once, in games with balls that come and go."""
    table = board(rub)
    one, two = (WorldBatch(table, 16, 3, tick_rate) for _ in range(2))
    rng = np.random.default_rng(1)
    for _ in range(60):
        for batch in (one, two):
            batch.create_balls()
        held = rng.random((16, 3)) < (0.4, 0.4, 0.1)
        places = rng.permutation(16)
        two.state[:] = two.state[places]
        one.step(held, 7)
        two.step(held[places], 7)
        two.state[places] = two.state.copy()
        assert one.state.tobytes() == two.state.tobytes()
    assert one.state["created"].sum() > 30
    assert not one.state["fault"].any()
