"""Worlds on plain boards have shorter records and no code for devices; nothing else tells them apart."""

from __future__ import annotations

import numpy as np
import pytest
from numba import from_dtype
from numba.core.errors import TypingError

from boards import PADDLES
from silverball.envs.pointers import ADDRESSES
from silverball.physics import two_codes
from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import SETTINGS, internal, kernel
from silverball.physics.records import PLAIN_WORLD, WORLD, Lane, records
from silverball.table import Board, Table, load_table
from silverball.table.kinds import Cylinder, Gate, Hole, Rollover
from silverball.table.rulebook import Rule
from silverball.table.standard_rules import standard_rules
from silverball.world import Snapshot, World, WorldBatch
from silverball.world.single_step import addresses_of

CYLINDER = Cylinder(center=(4.0, 1.0), radius=0.5)
PLAIN = Table(name="plain", board=Board(), paddle=PADDLES, cylinder=(CYLINDER,))
SENSOR = Rollover(start=(3.0, -1.0), end=(3.0, 1.0))
FULL = {
    "three balls": Table(name="many", format=2, board=Board(max_balls=3), paddle=PADDLES),
    "three paddles": Table(name="paddles", format=2, paddle=(*PADDLES, PADDLES[0])),
    "a sensor": Table(name="sensor", format=2, paddle=PADDLES, rollover=(SENSOR,)),
    "a hole": Table(name="hole", format=2, paddle=PADDLES, hole=(Hole(center=(2.0, 0.0), drain=True),)),
    "a one-way gate": Table(
        name="gate", format=2, paddle=PADDLES, gate=(Gate(start=(3.0, -1.0), end=(3.0, 1.0), passes="up"),)
    ),
    "a held gate": Table(
        name="held",
        format=2,
        paddle=PADDLES,
        gate=(Gate(start=(3.0, -1.0), end=(3.0, 1.0), held=True, name="held"),),
    ),
    "rules of its own": Table(
        name="rules", format=2, paddle=PADDLES, rule=(Rule(on_press=("left",), award=1),)
    ),
    "another level": Table(
        name="level", format=2, paddle=PADDLES, cylinder=(CYLINDER.model_copy(update={"level": 1}),)
    ),
}
TICKS = 240


@pytest.mark.parametrize("name", ["classic", "original", "rolling", "random"])
def test_tables_of_format_1_are_plain(name: str) -> None:
    assert World(load_table(name)).records[0].dtype == PLAIN_WORLD


@pytest.mark.parametrize("table", FULL.values(), ids=FULL)
def test_a_board_with_anything_that_a_plain_world_has_no_room_for_is_not_plain(table: Table) -> None:
    assert World(table).records[0].dtype == WORLD


def test_the_standard_rules_need_no_more_than_plain_worlds_have_code_for() -> None:
    given = {
        name
        for rule in standard_rules().rule
        for name, field in type(rule).model_fields.items()
        if getattr(rule, name) != field.default
    }
    assert given <= {"name", "on_hit", "add", "set", "award", "award_part", "times"}
    assert not standard_rules().lamp + standard_rules().counter + standard_rules().mode


def batches() -> tuple[WorldBatch, WorldBatch]:
    """Two worlds on the plain table alone, and the same two beside a world with a sensor, all played."""
    alone, mixed = WorldBatch(PLAIN, 2, 5, 60), WorldBatch([PLAIN, PLAIN, FULL["a sensor"]], 3, 5, 60)
    held = np.random.default_rng(1).random((TICKS, 3, 3)) < 0.4
    held[..., 2] &= held[..., 0]
    for batch in (alone, mixed):
        for _ in range(2):
            batch.create_balls()
        batch.step(held[:, : batch.count], TICKS)
    return alone, mixed


def test_a_world_is_the_same_beside_worlds_with_devices() -> None:
    alone, mixed = batches()
    assert (alone.state.dtype, mixed.state.dtype) == (PLAIN_WORLD, WORLD)
    assert alone.state["tick"].tolist() == [TICKS, TICKS]
    assert alone.digests() == mixed.digests()[:2] == mixed.save().digests()[:2]
    assert alone.tallies.tolist() == mixed.tallies[:2, : alone.tallies.shape[1]].tolist()
    assert bytes(alone.save()) == bytes(mixed.save([0, 1]))
    assert bytes(alone.save(1)) == bytes(mixed.save().pick(1))


def test_saved_worlds_move_between_batches_of_either_kind() -> None:
    alone, mixed = batches()
    copy = Snapshot.from_bytes(bytes(mixed.save()))
    assert copy.digests() == mixed.digests()
    fresh = WorldBatch(PLAIN, 2, 0, 60)
    fresh.restore(copy.pick([1, 0]))
    assert fresh.digests() == alone.digests()[::-1]
    fresh = WorldBatch([FULL["a sensor"], PLAIN], 2, 0, 60)
    fresh.restore(alone.save(1), 1)
    assert fresh.digests()[1] == alone.digests()[1]
    for batch in (alone, fresh):
        batch.step(np.zeros((2, 3), bool), TICKS)
    assert fresh.digests()[1] == alone.digests()[1]


@for_devices(lambda world: 7)
@internal
def switches_and_one(world) -> int:
    """A function for devices; in plain worlds the constant 7."""
    return world.off + 1


@kernel
def of_world(world) -> int:
    return switches_and_one(world)


@for_devices(lambda lane, more: more)
@internal
def next_clock(lane, more: int) -> int:
    """A function for devices that finds the world in a tuple."""
    return lane.world.next_clock + more


@kernel
def of_lane(world, more: int) -> int:
    return next_clock(Lane(world, 0, 0, 0), more)


@kernel
def undecorated(world) -> int:
    return world.off


@pytest.mark.parametrize(
    "pair",
    [
        (WORLD, PLAIN_WORLD),
        (WORLD["ball"].base, PLAIN_WORLD["ball"].base),
        (addresses_of(WORLD), addresses_of(PLAIN_WORLD)),
        (addresses_of(WORLD, ADDRESSES), addresses_of(PLAIN_WORLD, ADDRESSES)),
    ],
)
def test_numba_takes_neither_record_for_the_other(pair) -> None:
    """It would where one begins with all fields of the other, and use the code compiled for that."""
    one, other = map(from_dtype, pair)
    assert one.can_convert_to(None, other) is None
    assert other.can_convert_to(None, one) is None


def test_code_for_devices_is_replaced_in_plain_worlds() -> None:
    full, plain = records(1, WORLD)[0], records(1, PLAIN_WORLD)[0]
    full["off"], full["next_clock"] = 3, 5
    assert (of_world(full), of_world(plain)) == (4, 7)
    assert (of_lane(full, 2), of_lane(plain, 2)) == (7, 2)


@pytest.mark.skipif(bool(SETTINGS.DISABLE_JIT), reason="nothing is compiled")
def test_undecorated_code_for_devices_does_not_compile_for_plain_worlds() -> None:
    with pytest.raises((TypingError, KeyError), match="off"):
        undecorated(records(1, PLAIN_WORLD)[0])


def test_code_for_devices_is_replaced_without_the_compiler_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(two_codes.SETTINGS, "DISABLE_JIT", 1)
    choose = for_devices(lambda lane: 7)(lambda lane: lane.world["off"] + 1)
    assert choose(Lane(np.zeros(1, PLAIN_WORLD)[0], 0, 0, 0)) == 7
    assert choose(Lane(np.zeros(1, WORLD)[0], 0, 0, 0)) == 1


def test_what_replaces_code_for_devices_must_have_its_parameters() -> None:
    with pytest.raises(TypeError, match="parameters"):
        for_devices(lambda world, tick: 0)(of_world)
