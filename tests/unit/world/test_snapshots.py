"""Snapshots of a batch hold what was saved, go into the chosen worlds, and refuse what does not fit."""

from __future__ import annotations

import copy
import hashlib
import pickle

import numpy as np
import pytest

import silverball as sb
from boards import PADDLES, full_table, table_of
from silverball.errors import StateError
from silverball.physics.records import PLAIN_WORLD
from silverball.world import World, WorldBatch
from silverball.world.snapshot import HEADER, Snapshot

TABLE_SIZE = hashlib.sha256().digest_size + 8  # [B] of a table in a snapshot: its hash and a flag
TABLES = [full_table(), table_of(*PADDLES), full_table(), sb.load_table("classic")]
COUNT = len(TABLES)


def batch_in_play(ticks: int = 30, tick_rate: int = 60) -> WorldBatch:
    """Four worlds on four boards, the first and third of which are equal, each with two balls."""
    batch = WorldBatch(TABLES, COUNT, 5, tick_rate)
    for _ in range(2):
        batch.create_balls()
        batch.step(np.tile([True, False, True], (COUNT, 1)), ticks)
    return batch


@pytest.fixture
def batch() -> WorldBatch:
    return batch_in_play()


def whole(batch: WorldBatch) -> tuple[bytes, ...]:
    """All that a refused call must leave alone."""
    return tuple(array.tobytes() for array in (batch.state, batch.board_of, batch.logs, batch.tallies))


INDICES = {
    "all": (None, [0, 1, 2, 3]),
    "a number": (2, [2]),
    "a number of NumPy's": (np.int32(2), [2]),
    "from the end": (-1, [3]),
    "a slice": (slice(1, 3), [1, 2]),
    "a slice backwards": (slice(None, None, -2), [3, 1]),
    "a slice beyond the end": (slice(2, 99), [2, 3]),
    "a list": ([3, 0], [3, 0]),
    "a tuple from the end": ((-1, 1), [3, 1]),
    "small unsigned numbers": (np.array([3, 1], np.uint8), [3, 1]),
    "a mask": ([True, False, False, True], [0, 3]),
    "an empty list": ([], []),
    "an empty slice": (slice(2, 2), []),
    "an empty mask": (np.zeros(COUNT, np.bool_), []),
}


@pytest.mark.parametrize("how", INDICES)
def test_an_index_chooses_the_same_worlds_for_saving_and_restoring(batch, how: str):
    index, rows = INDICES[how]
    before, start = batch.digests(), WorldBatch(TABLES, COUNT, 5, 60).digests()
    snapshot = batch.save(index)
    assert (len(snapshot), snapshot.digests()) == (len(rows), [before[row] for row in rows])
    other = WorldBatch(TABLES, COUNT, 5, 60)
    other.restore(snapshot, index)
    assert other.digests() == [before[row] if row in rows else start[row] for row in range(COUNT)]


def test_digests_of_a_batch_are_those_of_its_worlds(batch):
    for row, table in enumerate(TABLES):
        world = World(table, seed=5 + row, tick_rate=60)
        for _ in range(2):
            world.create_ball()
            world.step(True, False, True)
            world.step(True, False, False, ticks=29)
        assert batch.digests()[row] == world.digest()


def test_a_snapshot_is_a_copy_that_nothing_changes_afterwards(batch):
    snapshot, before = batch.save(), batch.digests()
    batch.step(np.zeros((COUNT, 3), np.bool_), 5)
    batch.state["score"] += 1
    assert snapshot.digests() == before != batch.digests()
    batch.restore(snapshot)
    assert batch.digests() == before
    batch.step(np.zeros((COUNT, 3), np.bool_), 5)
    batch.restore(snapshot, [3, 2, 1, 0])
    assert snapshot.digests() == before
    assert snapshot.table_of.tolist() == [0, 1, 2, 3]
    for array in (snapshot.records, snapshot.table_of):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = array[1]


def test_one_world_branches_into_4096_that_go_their_own_ways():
    batch = WorldBatch("classic", 4096)
    batch.create_balls()
    batch.step(np.zeros((4096, 3), np.bool_), 40)
    one = batch.digests()[7]
    batch.restore(batch.save(7))
    assert set(batch.digests()) == {one}
    actions = np.zeros((4096, 3), np.bool_)
    actions[1000:, 2] = True
    batch.step(actions, 10)
    assert len(set(batch.digests()[:1000])) == len(set(batch.digests()[1000:])) == 1
    assert len(set(batch.digests())) == 2
    batch.restore(batch.save(7))
    batch.state["seed"] = np.arange(4096)
    batch.step(np.ones((4096, 3), np.bool_))
    assert len(np.unique(batch.state["ball"]["vx"][:, 0])) > 4000  # shoved in 4096 random directions


def test_one_record_may_go_into_the_same_world_twice(batch):
    before = batch.digests()
    batch.restore(batch.save(1), [2, 0, 2])
    assert batch.digests() == [before[1], before[1], before[1], before[3]]


def test_a_restored_world_stands_on_the_board_it_was_saved_on(batch):
    """Its future is that of the world it was saved from, not that of the board that the place had."""
    row, still = np.zeros((COUNT, 3), np.bool_), batch.save()
    batch.step(row, 120)
    expected = batch.digests()
    batch.restore(still)
    batch.restore(still, [3, 2, 1, 0])
    assert batch.board_of.tolist() == [3, 2, 1, 0]
    batch.step(row, 120)
    assert batch.digests() == expected[::-1]


def test_boards_are_found_by_their_tables_in_another_batch(batch):
    other = WorldBatch([TABLES[3], TABLES[1], TABLES[2]], 3, 5, 60)
    other.restore(batch.save([0, 3]), [1, 2])
    assert other.board_of.tolist() == [0, 2, 0]
    assert [other.tables[board] for board in other.board_of] == [TABLES[3], TABLES[2], TABLES[3]]
    row = np.zeros((COUNT, 3), np.bool_)
    batch.step(row, 120)
    other.step(row[:3], 120)
    assert other.digests()[1:] == [batch.digests()[0], batch.digests()[3]]


def test_logs_of_restored_worlds_are_emptied_and_tallies_stay(batch):
    snapshot = batch.save()
    batch.step(np.tile([True, True, True], (COUNT, 1)), 60)
    tallies, counts = batch.tallies.copy(), batch.logs["count"].copy()
    batch.logs["lost"] = 3
    assert (counts > 0).all()
    batch.restore(snapshot.pick([0, 2]), [0, 2])
    assert batch.logs["count"].tolist() == [0, counts[1], 0, counts[3]]
    assert batch.logs["lost"].tolist() == [0, 3, 0, 3]
    assert batch.tallies.tolist() == tallies.tolist()


def test_records_are_picked_from_a_snapshot_as_worlds_are_saved(batch):
    snapshot, before = batch.save(), batch.digests()
    for index, rows in INDICES.values():
        assert snapshot.pick(index).digests() == [before[row] for row in rows]
    assert snapshot.pick([1, 1, 1]).digests() == [before[1]] * 3
    with pytest.raises(ValueError, match="index 4 is out of range"):
        snapshot.pick(4)


@pytest.mark.parametrize(
    "carried",
    [
        lambda snapshot: Snapshot.from_bytes(bytes(snapshot)),
        lambda snapshot: pickle.loads(pickle.dumps(snapshot)),
        copy.copy,
        copy.deepcopy,
    ],
    ids=["bytes", "pickle", "copy", "deepcopy"],
)
@pytest.mark.parametrize("index", [None, [3, 1, 1], 2, []])
def test_a_snapshot_survives_being_carried_elsewhere(batch, carried, index):
    snapshot = batch.save(index)
    other = carried(snapshot)
    assert (other.digests(), len(other), other.tick_rate) == (snapshot.digests(), len(snapshot), 60)
    tables = [[saved.tables[number] for number in saved.table_of] for saved in (snapshot, other)]
    assert tables[0] == tables[1]
    fresh = WorldBatch(TABLES, COUNT, 5, 60)
    fresh.restore(other, slice(len(other)))
    assert fresh.digests()[: len(other)] == snapshot.digests()
    with pytest.raises(ValueError, match="read-only"):
        other.records["score"] = 1


def test_the_bytes_of_a_snapshot_name_no_table_that_it_does_not_use(batch):
    sizes = [len(bytes(batch.save(index))) for index in ([0, 0], [0, 1])]
    assert sizes[1] - sizes[0] == TABLE_SIZE


# --- what is refused, and changes nothing ----------------------------------------------------------------

NO_INDEX = [
    4,
    -5,
    [0, 4],
    [0, -5],
    True,
    1.0,
    "1",
    [[0]],
    [[0], [1, 2]],
    [0.5],
    [True, False],
    2**70,
    pytest.param(object(), id="an object"),
]


@pytest.mark.parametrize("index", NO_INDEX, ids=repr)
def test_what_is_no_index_is_refused_and_nothing_changes(batch, index):
    snapshot, before = batch_in_play(ticks=31).save(0), whole(batch)
    with pytest.raises(ValueError, match=r"index|mask"):
        batch.save(index)
    with pytest.raises(ValueError, match=r"index|mask"):
        batch.restore(snapshot, index)
    assert whole(batch) == before


@pytest.mark.parametrize(
    ("saved", "index", "match"),
    [
        ([0, 1], None, "2 records for 4 worlds"),
        ([0, 1], 3, "2 records for 1 worlds"),
        ([0, 1], slice(3), "2 records for 3 worlds"),
        ([0, 1], [True, True, True, False], "2 records for 3 worlds"),
        ([], None, "0 records for 4 worlds"),
        ([0, 1, 2], [3, 2, 3], "twice"),
        ([0, 1, 2], [3, 2, -1], "twice"),
    ],
)
def test_records_that_do_not_fit_the_index_are_refused_and_nothing_changes(batch, saved, index, match: str):
    snapshot, before = batch_in_play(ticks=31).save(saved), whole(batch)
    with pytest.raises(ValueError, match=match):
        batch.restore(snapshot, index)
    assert whole(batch) == before


@pytest.mark.parametrize(
    ("saved", "match"),
    [
        (lambda: batch_in_play(tick_rate=120).save(), "120 ticks a second, these worlds run at 60"),
        (
            lambda: WorldBatch([TABLES[0]] * 3 + [table_of()], 4, tick_rate=60).save(),
            "1 of the 4 records belong",
        ),
        (lambda: WorldBatch("random", 1, 3, 60).save(), "1 of the 1 records belong"),
        (lambda: World(TABLES[0], tick_rate=60).save(), "a Snapshot, got bytes"),
        (lambda: None, "a Snapshot, got NoneType"),
    ],
)
def test_a_snapshot_from_elsewhere_is_refused_and_nothing_changes(batch, saved, match: str):
    snapshot, before = saved(), whole(batch)
    with pytest.raises(StateError, match=match):
        batch.restore(snapshot)
    assert whole(batch) == before


def test_a_table_that_only_other_records_of_the_batch_used_is_no_hindrance(batch):
    other = WorldBatch(TABLES[1], 1, 5, 60)
    other.restore(batch.save(1))
    assert other.digests() == [batch.digests()[1]]


@pytest.mark.parametrize("at", range(0, 4 * PLAIN_WORLD.itemsize, 29))
def test_a_changed_bit_in_the_bytes_of_a_snapshot_is_found(batch, at: int):
    data = bytearray(bytes(batch.save()))
    data[at] ^= 1
    with pytest.raises(StateError):
        Snapshot.from_bytes(bytes(data))


@pytest.mark.parametrize("keep", [0, 5, 8, HEADER.size - 1, HEADER.size, HEADER.size + 40, -1])
def test_bytes_of_a_snapshot_that_were_cut_off_are_refused(batch, keep: int):
    with pytest.raises(StateError):
        Snapshot.from_bytes(bytes(batch.save())[:keep])


SAME_LENGTH = (4 + PLAIN_WORLD.itemsize + 8, 4 - TABLE_SIZE)
"""Four tables and four records take as many bytes as so many tables and less than no records."""


@pytest.mark.parametrize("counts", [(1, 3), (9, 4), (-1, 4), (3, -4), (2**60, 2**60), SAME_LENGTH])
def test_a_header_that_does_not_fit_its_records_is_refused(batch, counts):
    body = bytearray(bytes(batch.save())[:-16])
    HEADER.pack_into(body, 0, *HEADER.unpack_from(body)[:-2], *counts)
    with pytest.raises(StateError, match="damaged"):
        Snapshot.from_bytes(bytes(body) + hashlib.sha256(body).digest()[:16])


def test_a_record_of_a_table_that_is_not_there_is_refused():
    data = bytes(WorldBatch(TABLES[0], 1).save())
    number_at = HEADER.size + TABLE_SIZE
    body = data[:number_at] + (1).to_bytes(8, "little") + data[number_at + 8 : -16]
    with pytest.raises(StateError, match="names a table"):
        Snapshot.from_bytes(body + hashlib.sha256(body).digest()[:16])


def test_the_bytes_of_a_world_are_no_snapshot_and_the_other_way_round(batch):
    world = World(TABLES[0], tick_rate=60)
    with pytest.raises(StateError, match=r"bytes\(snapshot\) returned"):
        Snapshot.from_bytes(world.save())
    with pytest.raises(StateError, match=r"World\.save returned"):
        world.restore(bytes(batch.save(0)))
