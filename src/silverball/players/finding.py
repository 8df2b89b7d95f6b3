"""What does a soak write down of something it found, and does it happen again?

A finding is the table, the state of the world some ticks before, and what was done in each tick from there
on; as text it is one JSON object. It needs neither the soak that made it nor its random numbers.
"""

from __future__ import annotations

import json
import tomllib
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.players.drive import ACTION
from silverball.players.soak import Options, Place, Soaked, soaked_round
from silverball.players.watch import Found, watched_tick
from silverball.table import Table, dump_table, table_digest
from silverball.world.state import pack, unpack

FORMAT = 1
LEAD_SECONDS = 1.0  # [s] before the finding at which the state is kept
BUTTONS = ("left", "right", "shove", "create")


@dataclass(frozen=True)
class Finding:
    """One thing that should never happen.

    Attributes:
        kind: The name of a `Found` in small letters.
        ball: The id of the ball; 0 where it is of no single ball.
        depth: How deep it was inside something [u]; 0 where the kind has no depth.
        round: Of the soak.
        world: Of the round.
        tick: The tick of the world, counted from 1, after which it shows.
        program: The version of Silverball.
        physics: The version of the physics.
        table_text: The table as a table file.
        table_digest: Its hash.
        hostile: Whether the table was not checked.
        tick_rate: Ticks per second.
        state: The saved world before the first action, in hexadecimal.
        actions: Of each tick: left, right, shove, create (0 or 1), then the new velocity of each ball, [vx,
            vz] [u/s], or null.
    """

    kind: str
    ball: int
    depth: float
    round: int
    world: int
    tick: int
    program: str
    physics: int
    table_text: str
    table_digest: str
    hostile: bool
    tick_rate: int
    state: str
    actions: list[list[Any]]

    def to_text(self) -> str:
        """The finding as JSON, one line for every attribute and every action."""
        values = asdict(self) | {"format": FORMAT}
        actions = ",\n".join(f"  {json.dumps(action)}" for action in values.pop("actions"))
        lines = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in values.items()]
        return "{\n" + ",\n".join([*lines, f'"actions": [\n{actions}\n]']) + "\n}\n"

    @classmethod
    def from_text(cls, text: str, source: str) -> Finding:
        """Read a finding.

        Raises:
            StateError: The text is no finding of this format.
        """
        try:
            values = json.loads(text)
            if values.pop("format") != FORMAT:
                raise StateError(f"{source}: this program reads findings of format {FORMAT}")
            finding = cls(**values)
            for action in finding.actions:
                _read_into(np.zeros(1, ACTION)[0], action)
            Found[finding.kind.upper()]
        except (ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
            raise StateError(f"{source}: this is no finding of a soak, or a damaged one ({error})") from None
        return finding


def found_at(options: Options, place: Place) -> Finding:
    """Run the world of a finding again, alone, and write it down from `LEAD_SECONDS` before on."""
    from silverball import __version__

    rehearsal = soaked_round(options, place.round, place.world)
    rehearsal.run(place.tick)
    watch = rehearsal.watches[0]
    kind = Found(int(watch["found"]))
    since = int(watch["since"])
    start = since if kind == Found.STUCK else max(0, since - round(LEAD_SECONDS * options.tick_rate))
    # A stuck ball is written down from its arrival on: with another start it would count from another place.
    soaked = soaked_round(options, place.round, place.world)
    soaked.run(start)
    table = soaked.tables[0]
    digest = table_digest(table)
    state = pack(soaked.batch.state[0], digest, options.tick_rate)
    actions = []
    for _ in range(start, place.tick):
        soaked.run(1)
        actions.append(_written(soaked.actions[0]))
    slot = int(watch["slot"])
    return Finding(
        kind=kind.name.lower(),
        ball=0 if kind == Found.FAULT else int(soaked.batch.state["ball"]["id"][0, slot]),
        depth=float(watch["depth"]),
        round=place.round,
        world=place.world,
        tick=place.tick,
        program=__version__,
        physics=PHYSICS_VERSION,
        table_text=dump_table(table),
        table_digest=digest,
        hostile=options.hostile,
        tick_rate=options.tick_rate,
        state=state.hex(),
        actions=actions,
    )


def again(finding: Finding) -> Found:
    """Do again what was done, and say what the watch finds now: `Found.NOTHING` if it does not happen.

    Raises:
        StateError: The table or the state was changed, or is of another version of the physics.
    """
    try:
        table = Table.model_validate(tomllib.loads(finding.table_text))
        state = bytes.fromhex(finding.state)
    except ValueError:
        raise StateError("finding: table_text is no table or state no state; it was changed") from None
    if table_digest(table) != finding.table_digest:
        raise StateError("finding: table_text does not belong to table_digest; it was changed")
    soaked = Soaked([table], [0], finding.tick_rate, finding.hostile)
    soaked.batch.state[0] = unpack(state, finding.table_digest, finding.tick_rate)
    batch, true, watch, action = soaked.batch, soaked.true, soaked.watches[0], soaked.actions[0]
    for values in finding.actions:
        if watch["found"] != Found.NOTHING:
            break
        _read_into(action, values)
        watched_tick(
            batch.state[0], batch.boards.board[0], batch.boards.collider, batch.boards.grid,
            batch.boards.place, batch.logs[0],
            batch.tallies[0], true.board[0], true.collider, soaked.grounds.site[0], soaked.grounds.mark,
            watch, action, 1.0 / finding.tick_rate, finding.hostile,
        )  # fmt: skip
    return Found(int(watch["found"]))


def _written(action: Any) -> list[Any]:
    """An ACTION record as plain values."""
    kicks = [
        [float(vx), float(vz)] if kick else None
        for kick, vx, vz in zip(action["kick"], action["vx"], action["vz"], strict=True)
    ]
    return [*(int(action[name]) for name in BUTTONS), *kicks]


def _read_into(action: Any, values: list[Any]) -> None:
    """Write plain values into an ACTION record."""
    *buttons, first, second = values
    for name, value in zip(BUTTONS, buttons, strict=True):
        action[name] = value
    for slot, kick in enumerate((first, second)):
        action["kick"][slot] = kick is not None
        action["vx"][slot], action["vz"][slot] = kick or (0.0, 0.0)
