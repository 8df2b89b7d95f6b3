"""What did the player do? The inputs of one game as plain data, and how to play them again.

A log is the table, the seed, the tick rate and every change of input. As text it is JSON Lines: a header, one
line for every change, and a last line with the number of ticks and the digest that they led to.
"""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from silverball.errors import StateError

if TYPE_CHECKING:
    from silverball.world import World

FORMAT = 1
KINDS = ("left", "right", "create", "jitter")
_HEADER = ("format", "program", "physics", "table", "table_digest", "table_text", "seed", "tick_rate")


class Change(NamedTuple):
    """Something the player did.

    Attributes:
        tick: Before this tick, counted from 0.
        kind: "left" or "right" (a button went down or up), "create" (a new ball) or "jitter" (a shove).
        down: Whether a button went down; true for the others.
    """

    tick: int
    kind: str
    down: bool = True


@dataclass
class InputLog:
    """The inputs of one game.

    Attributes:
        program: The version of Silverball.
        physics: The version of the physics.
        table: The table's name.
        table_digest: The hash of the finished table.
        table_text: The finished table as a table file, so that a log needs nothing else.
        seed: Of the world.
        tick_rate: Ticks per second.
        changes: What the player did, in order.
        ticks: How many ticks were played.
        digest: The world's digest after them; empty while the game goes on.
        fault: The name of the fault that ended the game; empty if none did.
    """

    program: str
    physics: int
    table: str
    table_digest: str
    table_text: str
    seed: int
    tick_rate: int
    changes: list[Change] = field(default_factory=list)
    ticks: int = 0
    digest: str = ""
    fault: str = ""

    @classmethod
    def begin(cls, world: World) -> Self:
        """An empty log for a world that has just been made."""
        from silverball import __version__
        from silverball.physics import PHYSICS_VERSION
        from silverball.table import dump_table, table_digest

        return cls(
            program=__version__,
            physics=PHYSICS_VERSION,
            table=world.table.name,
            table_digest=table_digest(world.table),
            table_text=dump_table(world.table),
            seed=world.seed,
            tick_rate=world.tick_rate,
        )

    def ended(self, world: World) -> InputLog:
        """This log, closed with the ticks and the digest that a world has reached."""
        changes, digest = list(self.changes), world.digest()
        return replace(self, changes=changes, ticks=world.tick, digest=digest, fault=world.fault or "")

    def to_text(self) -> str:
        """The log as JSON Lines."""
        header = {"format": FORMAT} | {key: getattr(self, key) for key in _HEADER[1:]}
        lines: list[Any] = [
            header,
            *self.changes,
            {"ticks": self.ticks, "digest": self.digest, "fault": self.fault},
        ]
        return "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)

    @classmethod
    def from_text(cls, text: str) -> Self:
        """Read a log.

        Raises:
            StateError: The text is no input log of this format.
        """
        try:
            header, *changes, end = [json.loads(line) for line in text.splitlines()]
            if header["format"] != FORMAT:
                raise StateError(f"input log: format must be {FORMAT}, got {header['format']!r}")
            log = cls(
                **{key: header[key] for key in _HEADER[1:]},
                changes=[Change(int(tick), str(kind), bool(down)) for tick, kind, down in changes],
                ticks=int(end["ticks"]),
                digest=str(end["digest"]),
                fault=str(end["fault"]),
            )
        except (ValueError, KeyError, TypeError) as error:
            raise StateError(f"input log: this is no input log, or a damaged one ({error})") from None
        for line, change in enumerate(log.changes, 2):
            if change.kind not in KINDS:
                raise StateError(
                    f"input log, line {line}: expected one of {', '.join(KINDS)}, got {change.kind!r}"
                )
        return log


def replay(log: InputLog) -> World:
    """Play a log again: the world that it leads to, the same bit for bit.

    A game that ended at a fault ends there again, with the fault in `world.fault`. The table is taken as
    it was played, checked or not.

    Raises:
        StateError: The table in the log is not the one that was played.
        FaultError: The world stopped at a fault where the game did not.
    """
    from silverball.errors import FaultError
    from silverball.table import Table, table_digest
    from silverball.world import World

    try:
        table = Table.model_validate(tomllib.loads(log.table_text))
    except ValueError:
        raise StateError("input log: table_text is no table; the log was changed or damaged") from None
    if table_digest(table) != log.table_digest:
        raise StateError("input log: table_text does not belong to table_digest; the log was changed")
    world = World(table, log.seed, log.tick_rate)
    down = {"left": False, "right": False}
    shove = False
    for change in [*log.changes, Change(log.ticks, "end")]:
        if change.tick > world.tick:
            try:
                world.step(down["left"], down["right"], shove, change.tick - world.tick)
            except FaultError:
                if not log.fault:
                    raise
                return world
            shove = False
        if change.kind == "create":
            world.create_ball()
        elif change.kind == "jitter":
            shove = True
        elif change.kind in down:
            down[change.kind] = change.down
    return world
