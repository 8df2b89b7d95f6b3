"""What are the bytes of a saved world?

A header (magic, format, physics version, tick rate, hash of the table), the record of the world, and a
checksum of all that. Every field of a world record is eight bytes wide, so the record has no padding: its
bytes are its fields in order.
"""

from __future__ import annotations

import hashlib
import struct
from typing import Any

import numpy as np

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.layout import WORLD

MAGIC = b"SILVERBL"
FORMAT = 1
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
    body: bytes = header + record.tobytes()
    return body + hashlib.sha256(body).digest()[:CHECKSUM]


def unpack(state: bytes, table: str, tick_rate: int) -> Any:
    """The record of saved bytes, for a world on this table (its hash) with this tick rate.

    Raises:
        StateError: The bytes are damaged, or belong to another table, tick rate or version.
    """
    if not isinstance(state, (bytes, bytearray, memoryview)):
        raise StateError(f"a state is the bytes that World.save returned, got {type(state).__name__}")
    data = bytes(state)
    length = HEADER.size + WORLD.itemsize + CHECKSUM
    if data[: len(MAGIC)] != MAGIC:
        raise StateError("these bytes are not a saved world; use the bytes that World.save returned")
    if len(data) < HEADER.size:
        raise StateError(f"the state is cut off: {len(data)} bytes where a header needs {HEADER.size}")
    _, form, physics, rate, digest = HEADER.unpack(data[: HEADER.size])
    if (form, physics) != (FORMAT, PHYSICS_VERSION):
        raise StateError(
            f"the state has format {form} of physics {physics}, this program reads format {FORMAT} "
            f"of physics {PHYSICS_VERSION}"
        )
    if len(data) != length:
        raise StateError(f"the state is damaged: {len(data)} bytes where {length} are expected")
    if hashlib.sha256(data[:-CHECKSUM]).digest()[:CHECKSUM] != data[-CHECKSUM:]:
        raise StateError("the state is damaged: its checksum does not match")
    if digest.hex() != table:
        raise StateError(
            "the state belongs to another table; make the world with the table it was saved from"
        )
    if rate != tick_rate:
        raise StateError(f"the state was saved at {rate} ticks a second, this world runs at {tick_rate}")
    return np.frombuffer(data[HEADER.size : -CHECKSUM], WORLD)[0]


def digest(record: Any) -> str:
    """A stable hex string of a world record and the version of the physics."""
    return hashlib.sha256(PHYSICS_VERSION.to_bytes(8, "little") + record.tobytes()).hexdigest()
