"""What are the short digests of a game, and which field of two games differs?

The state falls into groups that fail in different ways: a changed press shows in the paddles first, another
rule in the rules alone. Each group has a digest of two characters, 12 bits: in one second one of 4,096
differences goes unseen, and hardly any goes unseen for long; the whole state has a full digest at the end.
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
"""In the order in which a difference in one leads to differences in the next."""

CHARACTERS = 2  # of each group's digest


def short_digests(record: bytes, rules: str) -> str:
    """The digests of the groups of a world's record and of the text of its rules, one after the other."""
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
    """A stable hex string of the whole state of a game."""
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
    """Every field of a game with its path, in the order of `GROUPS`; floats as their shortest exact text."""
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
    """A value with its path, or those of all that is in it."""
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
