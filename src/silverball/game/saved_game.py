"""The bytes of a saved game: the saved world and the state of the rules, sealed with a checksum.

The state of the rules, of the stuck-ball tracker and of the buttons is kept as JSON. This JSON is part of the
digests in replays, so its keys keep their names whatever the attributes are called.
"""

from __future__ import annotations

import json
import struct
from typing import Any, NamedTuple

from silverball.errors import StateError
from silverball.game.match import MatchState
from silverball.game.referee_state import TABLE_ROWS, Rest, StuckTracker, TableState
from silverball.game.rules import InPlay, RuleState
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import JITTER, NUDGE_LEFT, NUDGE_RIGHT, NUDGE_UP, NUDGES
from silverball.world import saved_world

MAGIC = b"SILVERGM"
HEADER = struct.Struct("<8sqqq")  # magic, format, physics version, bytes of the world


class GameState(NamedTuple):
    """The state of a game without that of its world.

    Attributes:
        rules: The state of the rules.
        stuck: The state of the stuck-ball tracker.
        left: Whether the left button is held.
        right: Whether the right button is held.
        shove: The shove of the player that comes in the next tick, `JITTER` or a bit of a nudge; 0: none.
        auto_shove: Whether a shove of the machine comes in the next tick.
        own_rules: The name of the rules; empty for the built-in ones.
        launch: Whether the launch button is held.
        table: What the rules of the table keep; None if it has none of its own.
        match: The players who wait, in a match of several.
    """

    rules: RuleState
    stuck: StuckTracker
    left: bool
    right: bool
    shove: int
    auto_shove: bool
    own_rules: str
    launch: bool = False
    table: TableState | None = None
    match: MatchState | None = None

    def to_json(self) -> str:
        """The state as JSON in ASCII; equal states have equal texts."""
        data = self.rules._asdict() | {"balls": [ball._asdict() for ball in self.rules.balls]}
        for name, default in (("memory", None), ("open_gates", ())):
            if getattr(self.rules, name) == default:
                del data[name]  # so that digests of games without it stay as they are
        data["watch"] = self.stuck._asdict() | {"rests": [rest._asdict() for rest in self.stuck.rests]}
        data |= {"left": self.left, "right": self.right, "shove": self.shove != 0, "machine": self.auto_shove}
        if self.shove & NUDGES:  # left out otherwise, as the launch button below
            data["nudge"] = self.shove
        if self.launch:  # left out otherwise, so that digests of tables without a plunger stay as they are
            data["launch"] = True
        if self.table is not None:
            data["table"] = self.table._asdict()
        if self.match is not None:
            data["match"] = self.match.to_values()
        if self.own_rules:
            data["own_rules"] = self.own_rules
        return json.dumps(data, separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> GameState:
        """The state of a text of `to_json`.

        Raises:
            ValueError, TypeError, KeyError: The text is not one.
        """
        data: dict[str, Any] = json.loads(text)
        left, right, shoves, auto = (bool(data.pop(name)) for name in ("left", "right", "shove", "machine"))
        shove = data.pop("nudge", JITTER) if shoves else 0
        if shove not in (0, JITTER, NUDGE_LEFT, NUDGE_RIGHT, NUDGE_UP):
            raise ValueError("there is no such nudge")
        launch, own_rules = bool(data.pop("launch", False)), str(data.pop("own_rules", ""))
        watch = data.pop("watch")
        stuck = StuckTracker(tuple(Rest(**rest) for rest in watch.pop("rests")), **watch)
        table = data.pop("table", None)
        if table is not None:
            table = TableState(**table | {name: tuple(table[name]) for name, _ in TABLE_ROWS})
        values = data.pop("match", None)
        match = None if values is None else MatchState.from_values(values)
        balls = tuple(InPlay(**ball) for ball in data.pop("balls"))
        data["open_gates"] = tuple(map(str, data.get("open_gates", ())))
        rules = RuleState(**data, balls=balls)
        return cls(rules, stuck, left, right, shove, auto, own_rules, launch, table, match)


def pack_game(mode: str, ended: str, world: bytes, state_json: str) -> bytes:
    """The bytes of a game.

    Args:
        mode: The mode of the game.
        ended: How it ended, see `GameCore.ended`.
        world: The saved world.
        state_json: What `GameState.to_json` gave.
    """
    header = HEADER.pack(MAGIC, saved_world.FORMAT, PHYSICS_VERSION, len(world))
    words = f"{mode} {ended} {state_json}".encode("ascii")
    return saved_world.seal(header + world + words)


def unpack_game(state: bytes) -> tuple[str, str, bytes, GameState]:
    """The mode of a saved game, how it ended, its saved world and the rest of its state.

    Raises:
        StateError: The bytes are damaged or of another version.
    """
    body = saved_world.unseal(state, MAGIC, HEADER, "Game.save")
    *_, size = HEADER.unpack_from(body)
    world, words = body[HEADER.size : HEADER.size + size], body[HEADER.size + size :]
    try:
        mode, ended, text = words.decode("ascii").split(" ", 2)
        return mode, ended, world, GameState.from_json(text)
    except (ValueError, TypeError, KeyError, AttributeError):
        raise StateError("the state is damaged: it does not hold the state of a game") from None
