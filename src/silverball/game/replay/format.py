"""Replays: a recorded game as an object, as text and as a file.

    silverball replay 1           the version of the format
    program = 0.1.0               the version of Silverball that wrote it; then, one per line, everything that
    ...                           decides the game
    --- table
    ...                           the table as a table file
    --- play
    ...                           one line for every second (see `recording`), and one for the rest
    --- end
    ticks = 12345                 how the game ended
    ...
    checksum = 0a1b...            of all text before this line

Format 2 has one more line before the table, `own_rules = NAME`, for games with custom rules, and format 3
`players = N`, for matches of several players.
`reader` reads and checks untrusted text.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

from silverball.errors import OutputError, StateError
from silverball.game.replay.reader import (
    END,
    PLAY,
    PLAYERS_KEY,
    RULES_KEY,
    TABLE,
    TEXT_LIMIT,
    Reader,
    checksum,
)
from silverball.game.replay.recording import FIRST, FORMAT, FORMAT_OF_MATCH, FORMAT_WITH_RULES
from silverball.game.replay.verify import Verdict, verify
from silverball.game.rules import RULES_VERSION
from silverball.game.view import Mode
from silverball.physics import PHYSICS_VERSION
from silverball.table import Table, dump_table, table_digest
from silverball.wholefile import NOTHING, Unreadable, read_text, write_whole

if TYPE_CHECKING:
    from silverball.game.rules import Rules
    from silverball.world import World


@dataclass(frozen=True)
class Replay:
    """A recorded game: everything that is needed to play it again, and the result to expect.

    `Game.replay` makes one.

    Attributes:
        program: The version of Silverball that recorded it.
        mode: The mode.
        table: The finished table.
        seed: The seed of everything random.
        tick_rate: Ticks per second.
        lines: One line for every whole second: digests and inputs, see `recording`.
        tail: The inputs after the last whole second.
        ticks: The length of the game [ticks].
        score: The points at the end; in a match those of the best player.
        ended: "over", "stopped" (by the player), "running" (the game went on), or the name of a fault.
        digest: The digest of the whole state at the end.
        rules: The name of the rules that scored it; empty for the built-in rules of the mode.
        physics: The version of the physics that moved the balls, in whose layout the digests are.
        players: How many players took turns.

    Examples:
        >>> import silverball as sb
        >>> game = sb.Game("classic", seed=7)
        >>> game.create_ball()
        >>> game.step(ticks=480)
        >>> replay = sb.Replay.from_text(game.replay.to_text())
        >>> replay.seconds, replay.verify().ok
        (2.0, True)
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
    rules: str = ""
    physics: int = PHYSICS_VERSION
    players: int = 1

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
        rules: str = "",
        players: int = 1,
    ) -> Self:
        """The replay of a game; see the attributes for the arguments."""
        from silverball import __version__

        return cls(
            __version__, mode, world.table.resolved(), world.seed, world.tick_rate,
            lines, tail, world.tick, score, ended, digest, rules, players=players,
        )  # fmt: skip

    @property
    def seconds(self) -> float:
        """The length of the game [s]."""
        return self.ticks / self.tick_rate

    def to_text(self) -> str:
        """The replay as text, for `from_text`."""
        form = FORMAT_WITH_RULES if self.rules else FORMAT if self.players == 1 else FORMAT_OF_MATCH
        head = [f"{FIRST} {form}", f"program = {self.program}", f"physics = {self.physics}"]
        head += [f"rules = {RULES_VERSION}", f"mode = {self.mode}", f"seed = {self.seed}"]
        head += [f"tick_rate = {self.tick_rate}", f"table = {table_digest(self.table)}"]
        if self.rules:
            head.append(f"{RULES_KEY} = {self.rules}")
        if form == FORMAT_OF_MATCH:
            head.append(f"{PLAYERS_KEY} = {self.players}")
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
            text: The text of `to_text`.
            source: Its name in messages, for example that of its file.

        Raises:
            StateError: The text is not a replay, is damaged, was changed, or is of another version.
        """
        if len(text) > TEXT_LIMIT:
            raise StateError(
                f"{source}: a replay has at most {TEXT_LIMIT:,} characters, this has {len(text):,}"
            )
        return cls(*Reader(source, text).fields())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a replay from a file.

        Raises:
            StateError: There is no such file, it cannot be read, or it is not a replay that can be played.
        """
        name = os.fspath(path) or NOTHING
        try:
            text = read_text(name, TEXT_LIMIT, "a replay")
        except Unreadable as error:
            raise StateError(f"{name}: {error}") from None
        return cls.from_text(text, name)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the replay to a file, whole or not at all; a file of this name is replaced.

        Raises:
            OutputError: The file cannot be written.
        """
        text = self.to_text()
        try:
            write_whole(Path(path), lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
        except OSError as error:
            raise OutputError(f"{os.fspath(path)}: cannot be written ({error.strerror or error})") from None

    def verify(
        self, *, rules: Rules | None = None, progress: Callable[[int], None] = lambda _: None
    ) -> Verdict:
        """Play the replay again and compare the digests of every second and the end.

        Args:
            rules: The rules that scored the game, if they are not built in.
            progress: Called after every second of play with the ticks so far.

        Returns:
            The verdict, which includes a sentence.

        Raises:
            StateError: The rules are missing, or are not those of the game.
        """
        return verify(self, progress, rules=rules)
