"""What is a replay, and how does it become text and come back?

    silverball replay 1           what it is, and the version of the format
    program = 0.1.0               who wrote it; then what must be the same for the same game,
    ...                           one line each
    --- table
    ...                           the table as a table file
    --- play
    ...                           one line for every second (see `replay_lines`), a last one for what is left
    --- end
    ticks = 12345                 how it ended
    ...
    checksum = 0a1b...            over all text before this line

How that is read when it comes from elsewhere is the question of `replay_reader`.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from silverball.errors import StateError
from silverball.game.replay.reader import (
    END,
    FIRST,
    FORMAT,
    PLAY,
    TABLE,
    TEXT_LIMIT,
    Reader,
    checksum,
    has_mesh,
)
from silverball.game.rules import RULES_VERSION
from silverball.game.view import Mode
from silverball.physics import PHYSICS_VERSION
from silverball.table import Table, dump_table, table_digest
from silverball.wholefile import NOTHING, Unreadable, read_text

if TYPE_CHECKING:
    from silverball.world import World


@dataclass(frozen=True)
class Replay:
    """All that it takes to play a game again, and what must come out.

    Attributes:
        program: The version of Silverball that played it.
        mode: Which game.
        table: The finished table.
        seed: Of everything random.
        tick_rate: Ticks per second.
        lines: One for every full second: digests and inputs, see `replay_lines`.
        tail: The inputs after the last full second.
        ticks: How long the game was.
        score: What was reached.
        ended: "over", "stopped" (by the player), "running" (it went on), or the name of a fault.
        digest: Of the whole state at the end.
    """

    program: str
    mode: Mode
    table: Table
    seed: int
    tick_rate: int
    lines: tuple[str, ...]
    tail: str
    ticks: int
    score: int
    ended: str
    digest: str

    @classmethod
    def of(
        cls,
        world: World,
        mode: Mode,
        *,
        lines: tuple[str, ...],
        tail: str,
        score: int,
        ended: str,
        digest: str,
    ) -> Self:
        """The replay of a game that was played on a world."""
        from silverball import __version__

        return cls(
            __version__, mode, without_meshes(world.table), world.seed, world.tick_rate,
            lines, tail, world.tick, score, ended, digest,
        )  # fmt: skip

    @property
    def seconds(self) -> float:
        """How long the game was [s]."""
        return self.ticks / self.tick_rate

    def to_text(self) -> str:
        """The replay as text."""
        head = [f"{FIRST} {FORMAT}", f"program = {self.program}", f"physics = {PHYSICS_VERSION}"]
        head += [f"rules = {RULES_VERSION}", f"mode = {self.mode}", f"seed = {self.seed}"]
        head += [f"tick_rate = {self.tick_rate}", f"table = {table_digest(self.table)}"]
        play = [*self.lines]
        if self.tail or self.ticks % self.tick_rate:
            play.append(f"= {self.tail}" if self.tail else "=")
        end = [f"ticks = {self.ticks}", f"score = {self.score}", f"ended = {self.ended}"]
        table = dump_table(self.table).rstrip("\n")
        body = "\n".join([*head, TABLE, table, PLAY, *play, END, *end, f"digest = {self.digest}"]) + "\n"
        return f"{body}checksum = {checksum(body)}\n"

    @classmethod
    def from_text(cls, text: str, source: str = "replay") -> Self:
        """Read a replay.

        Args:
            text: What `to_text` gave.
            source: What to call it in messages, such as the file's name.

        Raises:
            StateError: The text is no replay, is damaged, was changed, or is of another version.
        """
        if len(text) > TEXT_LIMIT:
            raise StateError(
                f"{source}: a replay has at most {TEXT_LIMIT:,} characters, this has {len(text):,}"
            )
        return cls(*Reader(source, text).parts())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a replay from a file.

        Raises:
            StateError: There is no such file, it cannot be read, or it is no replay that can be played.
        """
        name = os.fspath(path) or NOTHING
        return cls.from_text(_file_text(name), name)


def without_meshes(table: Table) -> Table:
    """The table with the footprints of its meshes, so that it needs no other file."""
    if not has_mesh(table):
        return table
    prisms = tuple(part.resolved() for part in table.triangular_prism)
    cylinders = tuple(part.resolved() for part in table.cylinder)
    return table.model_copy(update={"triangular_prism": prisms, "cylinder": cylinders})


def _file_text(path: str) -> str:
    """The text of a file, which is read only if it can be a replay."""
    try:
        return read_text(path, TEXT_LIMIT, "a replay")
    except Unreadable as error:
        raise StateError(f"{path}: {error}") from None
