"""Many worlds saved at once: `Snapshot`, for restoring them and for branching one into thousands.

A snapshot holds copies of world records, the hash of each record's table, and the tick rate. Restoring
scatters record i into the i-th chosen world, or a single record into all of them.

Records are copied as plain bytes, which is twenty times as fast as NumPy's copying field by field. A snapshot
holds PLAIN_WORLD records if the boards of all its worlds are plain, so it does not depend on the other worlds
of its batch.
"""

from __future__ import annotations

import hashlib
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import PLAIN_WORLD, STILL_WORLD, WORLD, records
from silverball.world import saved_world
from silverball.world.arguments import Index, resolve_index

MAGIC = b"SILVERSN"
HEADER = struct.Struct("<8sqqqqq")  # magic, format, physics version, tick rate, tables, records
TABLE_HASH = hashlib.sha256().digest_size
PLAIN_FLAG = np.dtype("<i8")  # of each table: 1 if its worlds have PLAIN_WORLD records


@dataclass(frozen=True, eq=False, slots=True)
class Snapshot:
    """Saved worlds, made by `WorldBatch.save`; `len` is how many.

    It is immutable. `bytes(snapshot)` and `Snapshot.from_bytes`, or pickle, carry it to another process.

    Attributes:
        records: WORLD or PLAIN_WORLD records, shape [record], read-only.
        tables: Hashes of tables; a snapshot of few worlds may name tables that none of its records uses.
        table_of: The number in `tables` of each record's table, int64 [record], read-only.
        tick_rate: Ticks per second.
        plain: For each table, whether a world that is on it alone has a PLAIN_WORLD record, bool [table].

    Examples:
        >>> import silverball as sb
        >>> batch = sb.WorldBatch("classic", count=8, tick_rate=60)
        >>> snapshot = batch.save([0, 3])
        >>> sb.Snapshot.from_bytes(bytes(snapshot))
        <Snapshot of 2 world(s) at 60 ticks/s>
    """

    records: NDArray[Any]
    tables: tuple[str, ...]
    table_of: NDArray[np.int64]
    tick_rate: int
    plain: NDArray[np.bool_]

    def __post_init__(self) -> None:
        self.records.flags.writeable = False
        self.table_of.flags.writeable = False

    def __len__(self) -> int:
        """The number of records."""
        return len(self.records)

    def __repr__(self) -> str:
        return f"<Snapshot of {len(self)} world(s) at {self.tick_rate} ticks/s>"

    def digests(self) -> list[str]:
        """Return the digest of each record, as `World.digest` does."""
        return saved_world.digests(self.records, self.plain[self.table_of])

    def pick(self, index: Index) -> Snapshot:
        """Return a snapshot of some of the records.

        Args:
            index: Which records: None (all), a number, a slice, a list of numbers, or a mask bool [record].
                A record may be picked repeatedly.

        Raises:
            ValueError: The index is invalid or out of range.
        """
        return gather(self.records, self.tables, self.plain, self.table_of, self.tick_rate, index)

    def __bytes__(self) -> bytes:
        """The snapshot with its tables, the version of the physics and a checksum."""
        used, table_of = np.unique(self.table_of, return_inverse=True)
        tables = b"".join(bytes.fromhex(self.tables[number]) for number in used)
        header = HEADER.pack(MAGIC, saved_world.FORMAT, PHYSICS_VERSION, self.tick_rate, len(used), len(self))
        plain = self.plain[used].astype(PLAIN_FLAG).tobytes()
        numbers = table_of.astype("<i8").tobytes()
        worlds, size = self.records, self.records.dtype.itemsize
        if worlds.dtype == WORLD and saved_world.is_still(worlds):
            size = STILL_WORLD.itemsize  # the cabinets come last
        every = np.ascontiguousarray(worlds).view(np.uint8).reshape(len(worlds), worlds.dtype.itemsize)
        data = every[:, :size].tobytes()
        return saved_world.seal(header + tables + plain + numbers + data)

    @classmethod
    def from_bytes(cls, data: bytes) -> Snapshot:
        """Make a snapshot from the bytes of one.

        Raises:
            StateError: The bytes are damaged, or of another version of the physics.
        """
        body = saved_world.unseal(data, MAGIC, HEADER, "bytes(snapshot)")
        *_, tick_rate, table_count, count = HEADER.unpack_from(body)
        if not 0 <= table_count * TABLE_HASH < len(body):
            raise StateError(f"the state is damaged: {len(body)} bytes cannot name {table_count} tables")
        plain_at = HEADER.size + table_count * TABLE_HASH
        numbers_at = plain_at + table_count * PLAIN_FLAG.itemsize
        plain = np.frombuffer(body[plain_at:numbers_at].ljust(numbers_at - plain_at), PLAIN_FLAG) == 1
        layout = PLAIN_WORLD if plain.all() else WORLD
        records_at = numbers_at + count * 8
        size = layout.itemsize
        if layout == WORLD and len(body) == records_at + count * STILL_WORLD.itemsize:
            size = STILL_WORLD.itemsize  # all cabinets are at rest
        end = records_at + count * size
        if len(body) != end or count < 0:
            raise StateError(f"the state is damaged: {len(body)} bytes where {end} are expected")
        table_of = np.frombuffer(body, "<i8", count, numbers_at).astype(np.int64)
        if count and not 0 <= table_of.min() <= table_of.max() < table_count:
            raise StateError("the state is damaged: a record names a table that is not there")
        starts = range(HEADER.size, plain_at, TABLE_HASH)
        tables = tuple(body[start : start + TABLE_HASH].hex() for start in starts)
        saved = records(count, layout)
        rows = saved.view(np.uint8).reshape(count, layout.itemsize)
        rows[:, :size] = np.frombuffer(body, np.uint8, count * size, records_at).reshape(count, size)
        return cls(saved, tables, table_of, tick_rate, plain)

    def __reduce__(self) -> tuple[Any, ...]:
        """Support `copy` and `pickle`."""
        return Snapshot.from_bytes, (bytes(self),)


def _whole(layout: np.dtype[Any]) -> np.dtype[Any]:
    """A record as plain bytes, which are copied in one piece."""
    return np.dtype((np.void, layout.itemsize))


def gather(
    worlds: NDArray[Any],
    tables: tuple[str, ...],
    plain: NDArray[np.bool_],
    table_of: NDArray[np.int64],
    tick_rate: int,
    index: Index,
) -> Snapshot:
    """Copy the chosen records into a snapshot.

    Raises:
        ValueError: The index is invalid or out of range.
    """
    rows = resolve_index(index, len(worlds))
    saved = worlds.view(_whole(worlds.dtype))[rows].copy().view(worlds.dtype, type(worlds))
    saved_tables = table_of[rows].copy()
    if plain[saved_tables].all():
        saved = saved_world.in_layout(saved, PLAIN_WORLD)
    return Snapshot(saved, tables, saved_tables, tick_rate, plain)


def scatter(
    snapshot: Snapshot,
    worlds: NDArray[Any],
    tables: tuple[str, ...],
    table_of: NDArray[np.int64],
    tick_rate: int,
    index: Index,
) -> slice | NDArray[np.int64]:
    """Write the records of a snapshot into the chosen worlds.

    Args:
        snapshot: One record for all chosen worlds, or as many as are chosen.
        worlds: WORLD or PLAIN_WORLD records [world], written.
        tables: Hashes of the tables that the worlds may be played on.
        table_of: The number in `tables` of each world's table [world], written.
        tick_rate: Of the worlds [1/s].
        index: Which worlds.

    Returns:
        The rows that were written.

    Raises:
        StateError: Another tick rate, or a table that is not in `tables`; nothing is changed.
        ValueError: An index that is invalid, out of range, or of another length; nothing is changed.
    """
    if not isinstance(snapshot, Snapshot):
        raise StateError(f"a batch is restored from a Snapshot, got {type(snapshot).__name__}")
    if snapshot.tick_rate != tick_rate:
        raise StateError(
            f"the snapshot was saved at {snapshot.tick_rate} ticks a second, these worlds run at {tick_rate}"
        )
    rows = resolve_index(index, len(worlds))
    count = len(range(*rows.indices(len(worlds)))) if isinstance(rows, slice) else len(rows)
    if len(snapshot) not in (1, count):
        raise ValueError(
            f"the snapshot has {len(snapshot)} records for {count} worlds; it must have one, or one for each"
        )
    if len(snapshot) > 1 and not isinstance(rows, slice) and np.bincount(rows).max() > 1:
        raise ValueError("the index names a world twice, which cannot take two records")
    numbers = _local_numbers(snapshot, tables)
    whole, saved = _whole(worlds.dtype), saved_world.in_layout(snapshot.records, worlds.dtype)
    worlds.view(whole)[rows] = saved.view(whole)
    table_of[rows] = numbers
    return rows


def _local_numbers(snapshot: Snapshot, tables: tuple[str, ...]) -> NDArray[np.int64]:
    """The number of each record's table among these tables, int64 [record]."""
    if snapshot.tables is tables or snapshot.tables == tables:
        return snapshot.table_of
    number_of = {table: number for number, table in enumerate(tables)}
    numbers = np.array([number_of.get(table, -1) for table in snapshot.tables], np.int64)
    local = numbers[snapshot.table_of]
    if local.size and local.min() < 0:
        unknown = int((local < 0).sum())
        raise StateError(
            f"{unknown} of the {len(snapshot)} records belong to a table that this batch does not have; "
            "make the batch with the tables that they were saved on"
        )
    return local
