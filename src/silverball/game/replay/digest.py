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
from typing import TYPE_CHECKING, Any

import numpy as np

from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import LEFT, PADDLE, PLAIN_WORLD, STILL_WORLD, WORLD, Part
from silverball.world.saved_world import CABINET, world_bytes

if TYPE_CHECKING:
    from silverball.world import World

OLDEST_PHYSICS = 3
"""The oldest version of the physics that moves balls on tables of format 1 as this one does."""

FIRST_SHAPE_3 = 5  # row of the first stationary shape in version 3: after three borders and two paddles

_WORLD_3 = np.dtype(
    [
        (
            "ball",
            [
                *((name, "f8") for name in ("x", "z", "vx", "vz", "spin_x", "spin_y", "spin_z")),
                ("id", "i8"),
                *((name, "f8") for name in ("start_x", "start_z", "start_vx", "start_vz")),
                ("accel_x", "f8"), ("accel_z", "f8"), ("motion", "i8"), ("roll_age", "f8"),
                ("ticks", "i8"), ("offset", "f8"), ("age", "f8"),
                ("contact_age", "f8"), ("contact_row", "i8"),
            ],
            (2,),
        ),
        ("paddle", PADDLE, (2,)),
        *(
            (name, "i8")
            for name in (
                "tick", "seed", "draws", "score", "created", "drained", "wall_hits", "slant_wall_hits",
                "paddle_hits", "triangular_prism_hits", "cylinder_hits", "ball_hits", "touches", "jams",
                "fault",
            )
        ),
    ],
    align=True,
)  # fmt: skip
"""The record of a world in version 3 of the physics, whose bytes the digests of its replays hash."""

GROUPS = ("paddles", "random", "balls", "counts", "points", "rules")
"""In the order in which differences spread from one to the next."""

CHARACTERS = 2  # length of the digest of a group


def short_digests(record: bytes, rules: str, physics: int = PHYSICS_VERSION) -> str:
    """The digests of all groups, one after the other.

    Args:
        record: The bytes of the world's record, as `record_bytes` returns them.
        rules: The state of the rules as JSON.
        physics: The version of the physics in whose layout the bytes are.
    """
    spans = _SPANS_3 if physics != PHYSICS_VERSION else _SPANS[len(record)]
    parts = (*(b"".join(record[start:end] for start, end in group) for group in spans), rules.encode("ascii"))
    return "".join(_short(part) for part in parts)


def full_digest(record: bytes, rules: str) -> str:
    """The SHA-256 of the whole state of a game, in hex digits."""
    return hashlib.sha256(record + rules.encode("ascii")).hexdigest()


def record_bytes(world: World, physics: int) -> bytes:
    """The bytes of the record of a world, in the layout of a version of the physics.

    Version 3 had a row for the left and for the right paddle on every board, also where there is none.
    """
    record, board, colliders = world.records
    if physics == PHYSICS_VERSION:
        return world_bytes(record)
    then = np.zeros((), _WORLD_3)
    for name in _WORLD_3["ball"].base.names or ():
        then["ball"][name] = record["ball"][name][:2]
    rows = then["ball"]["contact_row"]
    rows[rows >= board["shape_first"]] += FIRST_SHAPE_3 - board["shape_first"]
    first = board["collider_first"] + Part.FIRST_PADDLE
    for number in range(int(board["paddles"])):
        then["paddle"][0 if colliders["button"][first + number] == LEFT else 1] = record["paddle"][number]
    for name in (_WORLD_3.names or ())[2:]:
        then[name] = record[name]
    return bytes(then.tobytes())


def group_spans(layout: np.dtype[Any]) -> tuple[tuple[tuple[int, int], ...], ...]:
    """The first byte and the end of every field of each group but the last, in the order of the layout."""
    groups = (("paddle", *CABINET), ("seed", "draws"), ("ball",), (), ("score",))
    named = {name for group in groups for name in group}
    assert layout.fields is not None, "a world record has fields"
    spans = {}
    for name in layout.names or ():
        part, start = layout.fields[name][:2]
        spans[name] = (int(start), int(start) + part.itemsize)
    return tuple(
        tuple(span for name, span in spans.items() if (name in group if group else name not in named))
        for group in groups
    )


_SPANS = {
    layout.itemsize: group_spans(layout) for layout in (WORLD, STILL_WORLD, PLAIN_WORLD)
}  # by the length of a record
_SPANS_3 = group_spans(_WORLD_3)


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
