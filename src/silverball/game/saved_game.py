"""What are the bytes of a saved game? The saved world and the text of the rules, sealed with a checksum."""

from __future__ import annotations

import json
import struct
from typing import Any

from silverball.errors import StateError
from silverball.game.rules import InPlay, RuleState
from silverball.game.stuck import Rest, Watch
from silverball.physics import PHYSICS_VERSION
from silverball.world import saved_world as states

MAGIC = b"SILVERGM"
HEADER = struct.Struct("<8sqqq")  # magic, format, physics version, bytes of the world

Own = tuple[bool, bool, bool, bool]  # buttons left and right; shoves to come: the player's, the machine's


def pack_game(mode: str, ended: str, world: bytes, rules_text: str) -> bytes:
    """A game as bytes."""
    header = HEADER.pack(MAGIC, states.FORMAT, PHYSICS_VERSION, len(world))
    words = f"{mode} {ended} {rules_text}".encode("ascii")
    return states.seal(header + world + words)


def unpack_game(state: bytes) -> tuple[str, str, bytes, tuple[RuleState, Watch, Own]]:
    """The mode of a saved game, how it ended, its world and what its rules remember.

    Raises:
        StateError: The bytes are damaged or of another version.
    """
    body = states.unseal(state, MAGIC, HEADER, "Game.save")
    *_, size = HEADER.unpack_from(body)
    world, words = body[HEADER.size : HEADER.size + size], body[HEADER.size + size :]
    try:
        mode, ended, text = words.decode("ascii").split(" ", 2)
        return mode, ended, world, _remembered(json.loads(text))
    except (ValueError, TypeError, KeyError):
        raise StateError("the state is damaged: it does not hold what a game remembers") from None


def _remembered(data: dict[str, Any]) -> tuple[RuleState, Watch, Own]:
    own = tuple(bool(data.pop(name)) for name in ("left", "right", "shove", "machine"))
    watch = data.pop("watch")
    rests = tuple(Rest(**rest) for rest in watch.pop("rests"))
    balls = tuple(InPlay(**ball) for ball in data.pop("balls"))
    left, right, shove, machine = own
    return RuleState(**data, balls=balls), Watch(rests, **watch), (left, right, shove, machine)
