"""What are the bytes of a saved world?

A header (magic, format, physics version, tick rate, hash of the table), the record of the world, and a
checksum of all that. Every field of a world record is eight bytes wide, so the record has no padding: its
bytes are its fields in order. The same frame, with another magic, holds the many worlds of a `Snapshot`.
"""

from __future__ import annotations

import hashlib
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import WORLD

MAGIC = b"SILVERBL"
FORMAT = 1
FRAME = struct.Struct("<8sqq")  # magic, format, physics version: what every saved thing begins with
HEADER = struct.Struct("<8sqqq32s")
CHECKSUM = 16


def _field_bytes(dtype: np.dtype[Any]) -> int:
    """Bytes of all fields of a record, without padding."""
    if dtype.subdtype is not None:
        base, shape = dtype.subdtype
        return int(np.prod(shape)) * _field_bytes(base)
    if dtype.fields is None:
        return dtype.itemsize
    return sum(_field_bytes(field[0]) for field in dtype.fields.values())


assert _field_bytes(WORLD) == WORLD.itemsize, "a world record has padding: hash its fields, not its bytes"


def pack(record: Any, table: str, tick_rate: int) -> bytes:
    """A world's record with its header and checksum."""
    header = HEADER.pack(MAGIC, FORMAT, PHYSICS_VERSION, tick_rate, bytes.fromhex(table))
    return seal(header + record.tobytes())


def unpack(state: bytes, table: str, tick_rate: int) -> Any:
    """The record of saved bytes, for a world on this table (its hash) with this tick rate.

    Raises:
        StateError: The bytes are damaged, or belong to another table, tick rate or version.
    """
    data = unseal(state, MAGIC, HEADER, "World.save")
    expected = HEADER.size + WORLD.itemsize
    if len(data) != expected:
        raise StateError(f"the state is damaged: {len(data)} bytes where {expected} are expected")
    *_, rate, digest = HEADER.unpack(data[: HEADER.size])
    if digest.hex() != table:
        raise StateError(
            "the state belongs to another table; make the world with the table it was saved from"
        )
    if rate != tick_rate:
        raise StateError(f"the state was saved at {rate} ticks a second, this world runs at {tick_rate}")
    return np.frombuffer(data[HEADER.size :], WORLD)[0]


def seal(body: bytes) -> bytes:
    """A frame with its checksum behind it."""
    return body + hashlib.sha256(body).digest()[:CHECKSUM]


def unseal(state: Any, magic: bytes, header: struct.Struct, maker: str) -> bytes:
    """The frame of saved bytes without its checksum, if they are what `maker` made in this version.

    Raises:
        StateError: The bytes are something else, damaged, or of another version.
    """
    if not isinstance(state, (bytes, bytearray, memoryview)):
        raise StateError(f"a state is the bytes that {maker} returned, got {type(state).__name__}")
    data = bytes(state)
    if data[: len(magic)] != magic:
        raise StateError(f"these bytes are not a saved state; use the bytes that {maker} returned")
    if len(data) < header.size + CHECKSUM:
        raise StateError(f"the state is cut off: {len(data)} bytes where a header needs {header.size}")
    _, form, physics = FRAME.unpack_from(data)
    if (form, physics) != (FORMAT, PHYSICS_VERSION):
        raise StateError(
            f"the state has format {form} of physics {physics}, this program reads format {FORMAT} "
            f"of physics {PHYSICS_VERSION}"
        )
    body, checksum = data[:-CHECKSUM], data[-CHECKSUM:]
    if hashlib.sha256(body).digest()[:CHECKSUM] != checksum:
        raise StateError(f"the state is damaged: the checksum of its {len(data)} bytes does not match")
    return body


def digest(record: Any) -> str:
    """A stable hex string of a world record and the version of the physics."""
    return hashlib.sha256(PHYSICS_VERSION.to_bytes(8, "little") + record.tobytes()).hexdigest()


def digests(records: NDArray[Any]) -> list[str]:
    """The digest of each world record, shape [world], about half a microsecond each."""
    version, size = PHYSICS_VERSION.to_bytes(8, "little"), records.dtype.itemsize
    data = np.ascontiguousarray(records).tobytes()
    starts = range(0, len(data), size)
    return [hashlib.sha256(version + data[start : start + size]).hexdigest() for start in starts]
