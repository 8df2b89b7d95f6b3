"""The bytes of a saved world: a header, the world's record, and a checksum.

The header holds a magic number, the format, the physics version, the tick rate and the hash of the table.
Every field of a world record is eight bytes wide, so a record has no padding and its bytes are its fields in
order. Snapshots and saved games use the same frame with another magic number.
"""

from __future__ import annotations

import hashlib
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import (
    NO_CLOCK,
    PLAIN_WORLD,
    STILL_WORLD,
    WORLD,
    records as empty_records,
)

MAGIC = b"SILVERBL"
FORMAT = 1
FRAME = struct.Struct("<8sqq")  # magic, format, physics version: the start of every header
HEADER = struct.Struct("<8sqqq32s")
CHECKSUM = 16
CABINET = tuple(name for name in WORLD.names or () if name not in (STILL_WORLD.names or ()))


def _field_bytes(dtype: np.dtype[Any]) -> int:
    """Bytes of all fields of a record, without padding."""
    if dtype.subdtype is not None:
        base, shape = dtype.subdtype
        return int(np.prod(shape)) * _field_bytes(base)
    if dtype.fields is None:
        return dtype.itemsize
    return sum(_field_bytes(field[0]) for field in dtype.fields.values())


assert all(_field_bytes(one) == one.itemsize for one in (WORLD, STILL_WORLD, PLAIN_WORLD)), (
    "a world record has padding: hash its fields, not its bytes"
)


def in_layout(worlds: NDArray[Any], layout: np.dtype[Any]) -> NDArray[Any]:
    """Return world records [world] in a layout; fields that are not in both are left out, or are 0."""
    if worlds.dtype == layout:
        return worlds
    converted = empty_records(len(worlds), layout)
    if layout == WORLD:
        converted["next_clock"] = NO_CLOCK
    _copy_fields(worlds, converted)
    return converted


def _copy_fields(source: Any, target: Any) -> None:
    """Copy the fields, items and all, that two arrays of records have in common."""
    for name in source.dtype.names:
        if name not in target.dtype.names:
            continue
        one, other = source[name], target[name]
        if one.ndim > source.ndim:
            count = min(one.shape[-1], other.shape[-1])
            one, other = one[..., :count], other[..., :count]
        if one.dtype.names is None:
            other[...] = one
        else:
            _copy_fields(one, other)


def world_bytes(record: Any) -> bytes:
    """Return the bytes of a world record, without those of its cabinet if that is at rest.

    So the bytes, and with them digests and saved worlds, are the same whether a table knows the nudge or not.
    """
    data = bytes(record.tobytes())
    if len(data) == WORLD.itemsize and not any(data[STILL_WORLD.itemsize :]):
        return data[: STILL_WORLD.itemsize]
    return data


def is_still(worlds: NDArray[Any]) -> bool:
    """Whether the cabinets of all worlds with WORLD records are at rest."""
    return not any(_bits(worlds, name).any() for name in CABINET)


def _bits(worlds: NDArray[Any], name: str) -> NDArray[np.int64]:
    """The bits of a field of 64 bits of world records; −0.0 is not 0 here."""
    return np.ascontiguousarray(worlds[name]).view(np.int64)


def pack(record: Any, table: str, tick_rate: int) -> bytes:
    """Return a world's record with a header and a checksum.

    Args:
        record: The record of a world in the layout of its board.
        table: The hash of its table.
        tick_rate: Ticks per second.
    """
    header = HEADER.pack(MAGIC, FORMAT, PHYSICS_VERSION, tick_rate, bytes.fromhex(table))
    return seal(header + world_bytes(record))


def unpack(state: bytes, table: str, tick_rate: int, layout: np.dtype[Any]) -> Any:
    """Return the record in saved bytes, for a world on the table with this hash at this tick rate.

    `layout` is the record of a world on this table.

    Raises:
        StateError: The bytes are damaged, or of another table, tick rate or version.
    """
    data = unseal(state, MAGIC, HEADER, "World.save")
    expected = HEADER.size + layout.itemsize
    if layout == WORLD and len(data) == HEADER.size + STILL_WORLD.itemsize:
        data += bytes(expected - len(data))
    if len(data) != expected:
        raise StateError(f"the state is damaged: {len(data)} bytes where {expected} are expected")
    *_, rate, digest = HEADER.unpack(data[: HEADER.size])
    if digest.hex() != table:
        raise StateError(
            "the state belongs to another table; make the world with the table it was saved from"
        )
    if rate != tick_rate:
        raise StateError(f"the state was saved at {rate} ticks a second, this world runs at {tick_rate}")
    return np.frombuffer(data[HEADER.size :], layout)[0]


def seal(body: bytes) -> bytes:
    """Append a checksum."""
    return body + hashlib.sha256(body).digest()[:CHECKSUM]


def unseal(state: Any, magic: bytes, header: struct.Struct, maker: str) -> bytes:
    """Check the header and the checksum of saved bytes, and return them without the checksum.

    Args:
        state: The bytes.
        magic: The magic number that they must begin with.
        header: The header.
        maker: The function that made them, for messages.

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
    """Return the SHA-256 of a world record and the physics version, as a hex string."""
    return hashlib.sha256(PHYSICS_VERSION.to_bytes(8, "little") + world_bytes(record)).hexdigest()


def digests(records: NDArray[Any], plain: NDArray[np.bool_]) -> list[str]:
    """Return the digest of each world record [world], about half a microsecond each.

    Args:
        records: The worlds, all in one layout.
        plain: Whether each is on a plain board, where it is hashed as a PLAIN_WORLD record [world].
    """
    if records.dtype == PLAIN_WORLD or not plain.any():
        return _digests(records)
    whole = np.array(_digests(records), object)
    whole[plain] = _digests(in_layout(records[plain], PLAIN_WORLD))
    return list(whole)


def _digests(records: NDArray[Any]) -> list[str]:
    version, size = PHYSICS_VERSION.to_bytes(8, "little"), records.dtype.itemsize
    lengths = [size] * len(records)
    if records.dtype == WORLD:
        is_moving = np.any([_bits(records, name) != 0 for name in CABINET], axis=0)
        lengths = np.where(is_moving, size, STILL_WORLD.itemsize).tolist()
    data = np.ascontiguousarray(records).tobytes()
    starts = range(0, len(data), size)
    return [
        hashlib.sha256(version + data[start : start + length]).hexdigest()
        for start, length in zip(starts, lengths, strict=True)
    ]
