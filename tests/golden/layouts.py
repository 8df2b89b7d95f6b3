"""The bytes of a world as earlier versions of the physics laid out its record.

A digest of an earlier version hashes these bytes, so it goes on to guard every field that it guarded then.
"""

from __future__ import annotations

import numpy as np

from silverball.physics.records import PADDLE, PLAIN_BALL
from silverball.world import World
from silverball.world.saved_world import world_bytes

BALLS_THEN = PADDLES_THEN = 2
BALL_FIELDS = {name: "contact_part" if name == "contact_row" else name for name in PLAIN_BALL.names}
"""Fields of a ball in versions 2 and 3, by their names now."""

WORLD_3 = np.dtype(
    [
        ("ball", [(old, PLAIN_BALL.fields[name][0]) for name, old in BALL_FIELDS.items()], (BALLS_THEN,)),
        ("paddle", PADDLE, (PADDLES_THEN,)),
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


def record_bytes(world: World, version: int) -> bytes:
    """The record of a world in the layout of a version of the physics."""
    record = world.records[0]
    if version > 3:
        return world_bytes(record)
    then = np.zeros((), WORLD_3)
    for name, old in BALL_FIELDS.items():
        then["ball"][old] = record["ball"][name][:BALLS_THEN]
    then["paddle"] = record["paddle"][:PADDLES_THEN]
    for name in WORLD_3.names[2:]:
        then[name] = record[name]
    return then.tobytes()
