"""Digests of a game: a short one for each group of fields, for every second, and a full one for the end.

The state falls into groups that fail in different ways: a changed input shows in the paddles first, a changed
rule in the rules alone. A short digest has two characters, 12 bits: one difference in 4,096 is missed in
one second, and hardly any is missed for long.
"""

from __future__ import annotations

import hashlib
import json
from base64 import urlsafe_b64encode
from collections.abc import Iterator
from typing import Any

import numpy as np

from silverball.physics.records import WORLD

FIELDS = WORLD.fields
assert FIELDS is not None, "a world record has fields"
_PADDLES, _TICK, _SEED, _SCORE, _REST = (
    int(FIELDS[name][1]) for name in ("paddle", "tick", "seed", "score", "created")
)

GROUPS = ("paddles", "random", "balls", "counts", "points", "rules")
"""In the order in which differences spread from one to the next."""

CHARACTERS = 2  # length of the digest of a group


def short_digests(record: bytes, rules: str) -> str:
    """The digests of all groups, one after the other.

    Args:
        record: The bytes of the world's record.
        rules: The state of the rules as JSON.
    """
    parts = (
        record[_PADDLES:_TICK],
        record[_SEED:_SCORE],
        record[:_PADDLES],
        record[_TICK:_SEED] + record[_REST:],
        record[_SCORE:_REST],
        rules.encode("ascii"),
    )
    return "".join(_short(part) for part in parts)


def full_digest(record: bytes, rules: str) -> str:
    """The SHA-256 of the whole state of a game, in hex digits."""
    return hashlib.sha256(record + rules.encode("ascii")).hexdigest()


def differing_groups(expected: str, got: str) -> tuple[str, ...]:
    """The groups in which two lines of short digests differ."""
    starts = range(0, len(expected), CHARACTERS)
    return tuple(
        group
        for group, at in zip(GROUPS, starts, strict=True)
        if expected[at : at + CHARACTERS] != got[at : at + CHARACTERS]
    )


def values(record: Any, rules: str) -> Iterator[tuple[str, Any]]:
    """Every field of a game with its path, in the order of `GROUPS`."""
    for name in ("paddle", "seed", "draws", "ball"):
        yield from _flat(name, record[name])
    for name in record.dtype.names:
        if name not in ("paddle", "seed", "draws", "ball", "score"):
            yield from _flat(name, record[name])
    yield from _flat("score", record["score"])
    yield from _flat("rules", json.loads(rules))


def _short(part: bytes) -> str:
    digest = hashlib.blake2b(part, digest_size=3).digest()
    return urlsafe_b64encode(digest)[:CHARACTERS].decode("ascii")


def _flat(path: str, value: Any) -> Iterator[tuple[str, Any]]:
    """A value with its path, or all values in it with theirs."""
    names = getattr(getattr(value, "dtype", None), "names", None)
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _flat(f"{path}.{key}", item)
    elif isinstance(value, list) or np.ndim(value) > 0:
        for number, item in enumerate(value):
            yield from _flat(f"{path}[{number}]", item)
    elif names:
        for name in names:
            yield from _flat(f"{path}.{name}", value[name])
    else:
        yield path, value.item() if hasattr(value, "item") else value
