"""Saved states continue bit for bit, and bytes that are not a state change nothing."""

from __future__ import annotations

import hashlib
import math
import struct

import numpy as np
import pytest
from hypothesis import event, given, settings, strategies as st

from boards import CONTACTS, PADDLES, edited, full_table, launched, place, table_of
from silverball.errors import FaultError, StateError
from silverball.physics.audit import deepest
from silverball.table import table_digest
from silverball.world import World
from silverball.world.saved_world import pack

TABLE = full_table()


def press(world: World, seed: int, ticks: int) -> None:
    """Play on with buttons that depend on the seed and the tick alone; balls are created when there are
    fewer than two."""
    for _ in range(ticks):
        if len(world.balls) < 2 and world.tick % 7 == 0:
            world.create_ball()
        left, right, jitter = (hash((seed, world.tick // 20, button)) % 2 == 0 for button in range(3))
        world.step(left=left, right=right, jitter=jitter and world.tick % 20 == 0)


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize("at", [0, 1, 37, 250, 611])
def test_a_saved_state_goes_on_bit_for_bit(at: int, tick_rate: int) -> None:
    world = World(TABLE, seed=3, tick_rate=tick_rate)
    press(world, 1, at)
    state = world.save()
    seen = []
    for _ in range(30):
        press(world, 1, 11)
        seen.append((world.digest(), world.events, world.save()))
    for other in (world, World(TABLE, seed=99, tick_rate=tick_rate)):
        other.restore(state)
        assert other.save() == state
        for expected in seen:
            press(other, 1, 11)
            assert (other.digest(), other.events, other.save()) == expected


def test_every_state_of_a_game_can_be_restored() -> None:
    """Contacts split the strokes of the paddles; no rounding may carry one past its stop, or the state
    would be refused."""
    for tick_rate in (10, 20, 60):
        for seed in range(4):
            world = World(TABLE, seed=seed, tick_rate=tick_rate)
            for _ in range(400):
                press(world, seed, 1)
                state = world.save()
                world.restore(state)
                assert world.save() == state


def test_a_restored_world_has_no_old_events() -> None:
    world = World(TABLE, seed=3)
    world.create_ball()
    state = world.save()
    world.step(ticks=100, jitter=True)
    assert world.events
    world.restore(state)
    assert world.events == ()


@pytest.mark.parametrize("max_balls", [2, 3])
def test_the_digest_tells_every_field_apart(max_balls: int) -> None:
    """With two balls in a plain world, with three in one that has all fields."""
    table = TABLE.model_copy(update={"board": TABLE.board.model_copy(update={"max_balls": max_balls})})
    world = launched(table, (1.0, 3.0, 0.0, 0.0), (2.0, 3.5, 1.0, 1.0))
    record = world.records[0]
    before = world.digest()
    seen = {before}
    fields = [("ball", name, slot) for name in record["ball"].dtype.names for slot in (0, 1)]
    fields += [("paddle", name, side) for name in record["paddle"].dtype.names for side in (0, 1)]
    if max_balls > 2:
        fields += [("spinner", name, slot) for name in record["spinner"].dtype.names for slot in (0, 1)]
    for group, name, index in fields:
        kept = record[group][name][index]
        record[group][name][index] = kept + 1 if kept + 1 != kept else 0.0  # one is infinite
        seen.add(world.digest())
        record[group][name][index] = kept
    plain = [name for name in record.dtype.names if record.dtype[name].shape == ()]
    for name in plain:
        record[name] += 1
        seen.add(world.digest())
        record[name] -= 1
    assert world.digest() == before
    assert len(seen) == 1 + len(fields) + len(plain)


def refused(world: World, state, match: str | None = None) -> None:
    before, events = world.save(), world.events
    with pytest.raises(StateError, match=match):
        world.restore(state)
    assert world.save() == before
    assert world.events == events


@settings(max_examples=300)
@given(st.data())
def test_damaged_bytes_are_refused_and_nothing_changes(data) -> None:
    world = launched(TABLE, (1.0, 3.0, 0.0, 0.0))
    good = world.save()
    world.step(ticks=3)
    way = data.draw(st.sampled_from(["bit", "cut", "longer", "noise", "swap"]))
    bad = bytearray(good)
    if way == "bit":
        bad[data.draw(st.integers(0, len(good) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    elif way == "cut":
        bad = bad[: data.draw(st.integers(0, len(good) - 1))]
    elif way == "longer":
        bad += data.draw(st.binary(min_size=1, max_size=40))
    elif way == "noise":
        bad = data.draw(st.binary(max_size=600))
    else:
        i, j = data.draw(st.integers(0, len(good) - 1)), data.draw(st.integers(0, len(good) - 1))
        bad[i], bad[j] = bad[j], bad[i]
        if bytes(bad) == good:
            bad = b""
    refused(world, bytes(bad))


@pytest.mark.parametrize("what", [None, "text", 5, [1, 2], object()])
def test_things_that_are_no_bytes_are_refused(what) -> None:
    refused(World(TABLE), what, "bytes")


def test_a_state_of_another_table_rate_or_version_is_refused_and_says_so() -> None:
    world = World(TABLE, seed=1)
    refused(world, World(table_of(*PADDLES), seed=1).save(), "another table")
    refused(world, World(TABLE, seed=1, tick_rate=60).save(), "60 ticks")
    good = world.save()
    body = bytearray(good[:-16])
    struct.pack_into("<q", body, 8, 99)
    refused(world, bytes(body) + hashlib.sha256(body).digest()[:16], "format 99")


def put(group: str, name: str, value, index: int = 0):
    def change(record) -> None:
        record[group][name][index] = value

    return change


def count(name: str, value: int):
    def change(record) -> None:
        record[name] = value

    return change


def twice(record) -> None:
    record["ball"][1] = record["ball"][0]
    record["ball"]["x"][1] += 2.0


IMPOSSIBLE = {
    "place not a number": put("ball", "x", math.nan),
    "place infinite": put("ball", "z", math.inf),
    "speed not a number": put("ball", "vx", math.nan),
    "speed infinite": put("ball", "vz", -math.inf),
    "spin not a number": put("ball", "spin_y", math.nan),
    "beyond the border": put("ball", "z", 5.5),
    "far away": put("ball", "x", 1e300),
    "faster than the cap": put("ball", "vx", 22.5),
    "inside a cylinder": lambda record: (put("ball", "x", 5.0)(record), put("ball", "z", 1.0)(record)),
    "inside a paddle": lambda record: (put("ball", "x", -7.3)(record), put("ball", "z", -2.0)(record)),
    "inside a border": put("ball", "z", 4.7),
    "a negative id": put("ball", "id", -3),
    "an id not given yet": put("ball", "id", 7),
    "an id twice": twice,
    "paddle beyond its stop": put("paddle", "angle", 1.0),
    "paddle not a number": put("paddle", "angle", math.nan, 1),
    "paddle's speed not a number": put("paddle", "angular_velocity", math.nan),
    "paddle's command not a number": put("paddle", "angle_commanded", math.nan),
    "unknown fault": count("fault", 99),
    **{
        f"negative {name}": count(name, -1)
        for name in ("tick", "seed", "draws", "score", "created", "touches", "jams")
    },
}


@pytest.mark.parametrize("what", IMPOSSIBLE)
def test_an_impossible_state_is_refused_and_nothing_changes(what: str) -> None:
    world = launched(TABLE, (1.0, 3.0, 0.0, 0.0))
    bad = edited(world, IMPOSSIBLE[what])
    world.step(ticks=5)
    refused(world, bad)


def test_two_balls_on_a_table_for_one_are_refused() -> None:
    world = launched(table_of(max_balls=1), (1.0, 3.0, 0.0, 0.0))

    def another(record) -> None:
        record["created"] = 2
        record["ball"][1] = record["ball"][0]
        record["ball"]["id"][1] = 2
        record["ball"]["x"][1] = 4.0

    refused(world, edited(world, another), "more balls")


SENSIBLE = [st.floats(-4.5, 9.5), st.floats(-4.6, 4.6), st.floats(-15, 15), st.floats(-15, 15)] * 2


@settings(max_examples=150)
@given(
    st.tuples(*SENSIBLE, *[st.floats(-0.174, 0.785)] * 2),
    st.none() | st.none() | st.tuples(st.integers(0, 9), st.floats()),
    st.just((1, 2, 5, 9)) | st.just((2, 0, 7, 2)) | st.tuples(*[st.integers(-(2**63), 2**63 - 1)] * 4),
    st.lists(st.tuples(st.booleans(), st.booleans(), st.booleans()), min_size=1, max_size=30),
)
def test_whatever_a_state_holds_it_is_refused_or_stays_finite(sensible, wild, counts, actions) -> None:
    world = World(TABLE, tick_rate=60)
    numbers = list(sensible)
    if wild is not None:
        numbers[wild[0]] = wild[1]

    def fill(record) -> None:
        for slot in (0, 1):
            for name, number in zip(("x", "z", "vx", "vz"), numbers[4 * slot :], strict=False):
                record["ball"][name][slot] = number
            record["ball"]["id"][slot] = counts[slot]
        if counts[1] == 0:
            record["ball"][1] = 0
        record["paddle"]["angle"][:2] = numbers[8:]
        record["tick"], record["created"] = counts[2:]

    try:
        world.restore(edited(world, fill))
    except StateError:
        event("refused")
        return
    event("played")
    assert deepest(*world.records) <= 1e-9
    for left, right, jitter in actions:
        world.step(left=left, right=right, jitter=jitter)
        assert all(math.isfinite(n) for ball in world.balls for n in (*ball.position, *ball.velocity))


@settings(max_examples=60)
@given(
    st.integers(0, 2**63 - 1),
    st.sampled_from([10, 60, 240, 977, 100_000]),
    st.lists(st.tuples(*[st.booleans()] * 4), min_size=1, max_size=60),
)
def test_any_play_stays_finite_and_without_a_fault(seed, tick_rate, actions) -> None:
    world = World(TABLE, seed=seed, tick_rate=tick_rate)
    for left, right, jitter, new in actions:
        if new and len(world.balls) < 2:
            world.create_ball()
        world.step(left=left, right=right, jitter=jitter, ticks=3)
        assert world.fault is None
        assert all(math.isfinite(n) for ball in world.balls for n in (*ball.position, *ball.velocity))
        assert all(math.hypot(*ball.velocity) <= 22.0 for ball in world.balls)
        assert all(math.isfinite(n) for e in world.events for n in (e.offset, *e.position, *e.normal))


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        (put("ball", "x", math.nan), "not_finite"),
        (put("ball", "vz", math.inf), "not_finite"),
        (put("ball", "z", 6.0), "outside"),
        (put("ball", "vx", 30.0), "too_fast"),
        (put("paddle", "angle", math.nan), "not_finite"),
    ],
)
def test_a_record_that_is_impossible_stops_its_world_with_a_named_fault(change, fault: str) -> None:
    """Records of a batch are open to callers: whatever they write, a kernel names the fault and stands
    still."""
    world = launched(TABLE, (1.0, 3.0, 0.0, 0.0))
    change(world.records[0])
    with pytest.raises(FaultError, match=fault) as caught:
        world.step()
    assert (caught.value.fault, world.fault, world.tick) == (fault, fault, 0)
    other = World(TABLE)
    other.restore(caught.value.state)
    assert other.fault == fault
    with pytest.raises(FaultError):
        other.step()


def test_the_events_that_do_not_fit_are_counted() -> None:
    world = launched(table_of(), (0.0, 0.0, 0.0, 20.0), tick_rate=60)
    seen = 0
    for _ in range(600):
        world.step()
        seen += len(world.events)
    world = launched(table_of(), (0.0, 0.0, 0.0, 20.0), tick_rate=60)
    world.step(ticks=600)
    assert world.events_lost == max(0, seen - len(world.events))
    assert seen == len(world.events) + world.events_lost


def test_events_come_in_order_with_places_and_units() -> None:
    world = World(TABLE, seed=8, tick_rate=60)
    world.create_ball()
    world.create_ball()
    world.step(left=True)
    world.step(ticks=30)
    times = [(e.tick, e.offset) for e in world.events]
    assert times == sorted(times)
    assert all(0.0 <= offset <= 1 / 60 for _, offset in times)
    for e in world.events:
        if e.kind in CONTACTS:
            assert math.hypot(*e.normal) == pytest.approx(1.0, abs=1e-14)
            assert e.ball in (1, 2)


@pytest.mark.parametrize("ticks", [-1, 1.5, True, "3", None, math.nan])
def test_a_number_of_ticks_that_cannot_be_is_refused(ticks) -> None:
    world = World(TABLE)
    before = world.digest()
    with pytest.raises(ValueError, match="ticks"):
        world.step(ticks=ticks)
    assert world.digest() == before


def test_many_ticks_at_once_are_the_same_as_one_by_one() -> None:
    one, many = (World(TABLE, seed=4) for _ in range(2))
    for world in (one, many):
        world.create_ball()
    for number in range(20):
        for _ in range(13):
            one.step(left=number % 2 == 0, right=number % 3 == 0)
        many.step(left=number % 2 == 0, right=number % 3 == 0, ticks=13)
        assert one.digest() == many.digest()


def test_counters_and_score_add_up() -> None:
    world = World(TABLE, seed=12, tick_rate=60)
    points = {f"triangular_prism[{i}]": 50 for i in range(4)} | {f"cylinder[{i}]": 100 for i in range(3)}
    hits: dict[str, int] = {}
    score = drained = 0
    for tick in range(3000):
        if len(world.balls) < 2:
            world.create_ball()
        world.step(left=tick % 20 < 8, right=tick % 28 < 9)
        for e in world.events:
            if e.kind == "hit":
                hits[e.part] = hits.get(e.part, 0) + 1
                score += points.get(e.part, 0)
            drained += e.kind == "gutter"
    assert world.score == score > 0
    assert {part: number for part, number in world.hits.items() if number} == hits
    assert world.drained == drained > 0
    assert world.created == drained + len(world.balls)
    assert place(world.balls[0])[0] > -9.0


def test_packing_by_hand_is_what_save_does() -> None:
    """`edited` in the tests above makes states that only differ in what it changes."""
    world = launched(TABLE, (1.0, 3.0, 0.0, 0.0))
    assert edited(world, lambda record: None) == world.save()
    assert pack(world.records[0], table_digest(TABLE), 240) == world.save()
    assert np.frombuffer(world.save()[-16:], np.uint8).any()
