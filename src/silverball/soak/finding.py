"""Findings of a soak as files that reproduce them.

A finding is the table, the state of the world some ticks before, and what was done in each tick from there
on; as text it is one JSON object. It needs neither the soak that made it nor its random numbers.
"""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field, ValidationError
from pydantic.dataclasses import dataclass

from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import MAX_BALLS, NOTHING, BoardGeometry, Lane, Motion
from silverball.physics.validation import validate_world
from silverball.soak.checks import Found, watched_tick
from silverball.soak.driver import ActionRecord
from silverball.soak.json_file import STRICT, Amount, Count, file_text, parse_json
from silverball.soak.rounds import KINDS, FindingPlace, Options, SoakBatch, round_batch
from silverball.table import Table, dump_table, table_digest
from silverball.table.file import SIZE_LIMIT as TABLE_LIMIT
from silverball.world.saved_world import pack, unpack

FORMAT = 1
LEAD_SECONDS = 1.0  # [s] from the saved state to the finding
BUTTONS = ("left", "right", "shove", "create")
DEVICES = ([1], [2], [3])  # launch and gates
SIZE_LIMIT = 2**25  # [bytes] of a finding; a ball stuck at 10,000 ticks a second takes 20 million
DESCRIPTION = "a finding of a soak"
LEAST_KICKS = 2  # velocities of an action, also where there are fewer balls
MAX_KICK = 1e4  # [u/s] of a kick: far above every speed cap


def _action(values: list[Any]) -> list[Any]:
    """An action as `_action_values` writes it, or a ValueError."""
    buttons, kicks = _buttons_and_kicks(values)
    are_valid = all(type(button) is int and button in (0, 1) for button in buttons[: len(BUTTONS)])
    are_valid &= all(type(devices) is int for devices in buttons[len(BUTTONS) :])
    has_count = LEAST_KICKS <= len(kicks) <= MAX_BALLS
    if not are_valid or not has_count or not all(kick is None or _is_kick(kick) for kick in kicks):
        raise ValueError(f"must be four times 0 or 1 and {LEAST_KICKS} to {MAX_BALLS} velocities")
    return values


def _buttons_and_kicks(values: list[Any]) -> tuple[list[Any], list[Any]]:
    """The buttons of an action, with the devices if there are any, and the velocities after them."""
    count = len(BUTTONS) + (values[len(BUTTONS) : len(BUTTONS) + 1] in DEVICES)
    return values[:count], values[count:]


def _is_kick(kick: Any) -> bool:
    return (
        isinstance(kick, list)
        and len(kick) == 2
        and all(type(number) in (int, float) and abs(number) <= MAX_KICK for number in kick)
    )


Digest = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


@dataclass(frozen=True, config=STRICT)
class Finding:
    """One thing that should never happen.

    Attributes:
        kind: The name of a `Found` in small letters.
        ball: The id of the ball; 0 where no single ball is concerned.
        depth: How deep it was inside something, or how far a contact was from anything [u]; else 0.
        round: The round of the soak.
        world: The world of the round.
        tick: The tick of the world, counted from 1, after which it shows.
        program: The version of Silverball.
        physics: The version of the physics.
        table_text: The table as a table file.
        table_digest: Its hash.
        hostile: Whether the check of the table was not made, or warned.
        tick_rate: Ticks per second.
        state: The saved world before the first action, in hexadecimal.
        actions: Of each tick: left, right, shove, create (0 or 1; a shove from
            2 to 4 is a nudge), the sum of 1 if the launch button is held
            and 2 if gates move, unless it is 0, then the new velocity of each ball, [vx, vz] [u/s], or null;
            at least two, later ones only where there are any.
    """

    kind: Annotated[str, Field(pattern=f"^({'|'.join(kind.name.lower() for kind in KINDS)})$")]
    ball: Count
    depth: Amount
    round: Count
    world: Count
    tick: Count
    program: Annotated[str, Field(max_length=40)]
    physics: Count
    table_text: Annotated[str, Field(max_length=TABLE_LIMIT)]
    table_digest: Digest
    hostile: bool
    tick_rate: Annotated[int, Field(ge=10, le=100_000)]
    state: Annotated[str, Field(pattern="^([0-9a-f]{2})*$")]
    actions: list[Annotated[list[Any], AfterValidator(_action)]]

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
            StateError: The text is not a finding of this format.
        """
        return parse_json(text, source, DESCRIPTION, FORMAT, cls._of)

    @classmethod
    def load(cls, path: Path) -> Finding:
        """Read a finding from a file.

        Raises:
            StateError: The file does not exist, or cannot be read.
        """
        return cls.from_text(file_text(path, SIZE_LIMIT, DESCRIPTION), str(path))

    @classmethod
    def _of(cls, values: dict[str, Any]) -> Finding:
        finding = cls(**values)
        finding.table()
        return finding

    def table(self) -> Table:
        """The finished table.

        Raises:
            ValueError: `table_text` is not a finished table, or not that of `table_digest`.
        """
        try:
            table = Table.model_validate(tomllib.loads(self.table_text))
        except ValidationError:
            raise ValueError("table_text: is a table that cannot be used") from None
        if table.random is not None or table.has_mesh:
            raise ValueError("table_text: is not a finished table")
        if table_digest(table) != self.table_digest:
            raise ValueError("table_text: does not belong to table_digest; it was changed")
        return table


def record_finding(options: Options, place: FindingPlace) -> Finding:
    """Run the world of a finding again, alone, and record its last `LEAD_SECONDS`."""
    from silverball import __version__

    first_run = round_batch(options, place.round, place.world)
    first_run.run(place.tick)
    watch = first_run.watches.states[0]
    kind = Found(int(watch["found"]))
    since = int(watch["since"])
    start = since if kind == Found.STUCK else max(0, since - round(LEAD_SECONDS * options.tick_rate))
    # A stuck ball is recorded from its arrival on: with another start its time would count from another
    # place.
    soaked = round_batch(options, place.round, place.world)
    soaked.run(start)
    table = soaked.tables[0]
    digest = table_digest(table)
    state = pack(soaked.batch.state[0], digest, options.tick_rate)
    actions = []
    for _ in range(start, place.tick):
        soaked.run(1)
        actions.append(_action_values(soaked.drivers.actions[0]))
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
        hostile=bool(first_run.watches.hostile[0]),
        tick_rate=options.tick_rate,
        state=state.hex(),
        actions=actions,
    )


def reproduce(finding: Finding) -> Found:
    """Repeat the actions of a finding; return what the checks find now, `Found.NOTHING` if nothing.

    Raises:
        StateError: The state was changed, or is of another version of the physics.
    """
    soaked = SoakBatch([finding.table()], [0], finding.tick_rate, finding.hostile)
    batch, drivers = soaked.batch, soaked.drivers
    state, layout = bytes.fromhex(finding.state), batch.boards.layout
    record = unpack(state, finding.table_digest, finding.tick_rate, layout)
    batch.state[0] = record
    if not _is_possible(soaked):
        raise StateError("the state of this finding is impossible; it was changed")
    lane = Lane(batch.state[0], batch.logs[0], batch.tallies[0], batch.logs[0])
    geometry = BoardGeometry(batch.boards.board[0], batch.boards.collider, batch.boards.grid)
    watch, action, truth = soaked.watches.states[0], drivers.actions[0], soaked.truth(0)
    for values in finding.actions:
        if watch["found"] != Found.NOTHING:
            break
        _fill_action(action, values)
        watched_tick(lane, geometry, drivers.places, truth, watch, action, 1.0 / finding.tick_rate)
    return Found(int(watch["found"]))


def _is_possible(soaked: SoakBatch) -> bool:
    """Whether the kernels can continue from the state of the only world: no index in it leaves its array."""
    state, board = soaked.batch.state[0], soaked.batch.boards.board[0]
    parts = board["collider_end"] - board["collider_first"]
    balls = state["ball"]
    numbers = [number for row in (*balls.tolist(), *state["paddle"].tolist()) for number in row]
    return bool(
        not any(map(math.isnan, numbers))  # a time may be infinite, which means never
        and ((balls["contact_row"] >= NOTHING) & (balls["contact_row"] < parts)).all()
        and np.isin(balls["motion"], list(Motion)).all()
        and state["tick"] >= 0
        and validate_world(state, board)
    )


def _action_values(action: ActionRecord) -> list[Any]:
    """An ACTION record as plain values."""
    kicks = [
        [float(vx), float(vz)] if kick else None
        for kick, vx, vz in zip(action["kick"], action["vx"], action["vz"], strict=True)
    ]
    while len(kicks) > LEAST_KICKS and kicks[-1] is None:
        del kicks[-1]
    devices = int(action["launch"]) + 2 * int(action["gates"])
    return [*(int(action[name]) for name in BUTTONS), *([devices] if devices else []), *kicks]


def _fill_action(action: ActionRecord, values: list[Any]) -> None:
    """Write plain values into an ACTION record."""
    buttons, kicks = _buttons_and_kicks(values)
    for name, value in zip(BUTTONS, buttons, strict=False):
        action[name] = value
    devices = buttons[len(BUTTONS)] if len(buttons) > len(BUTTONS) else 0
    action["launch"], action["gates"] = devices & 1, devices >> 1
    for slot in range(MAX_BALLS):
        kick = kicks[slot] if slot < len(kicks) else None
        action["kick"][slot] = kick is not None
        action["vx"][slot], action["vz"][slot] = kick or (0.0, 0.0)
