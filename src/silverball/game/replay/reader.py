"""The reader of replays: it checks untrusted text and refuses invalid text in one sentence.

An error message names the line, what was expected, what was found, and the remedy. All sizes and counts have
limits: reading takes time proportional to the length of the text, and so does playing, because every second
of play has a line.
"""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple, NoReturn

from pydantic import ValidationError

from silverball.errors import StateError
from silverball.game.match import MAX_PLAYERS
from silverball.game.replay.digest import OLDEST_PHYSICS
from silverball.game.replay.recording import (
    FIRST,
    FORMAT,
    FORMAT_OF_MATCH,
    FORMAT_WITH_RULES,
    LINE,
    MAX_TICK_RATE,
    MIN_TICK_RATE,
    PLAY_LIMIT,
    SECONDS_LIMIT,
    TAIL,
    parse_inputs,
)
from silverball.game.rules import NAME_LIMIT, RULES_VERSION, is_custom_name
from silverball.game.view import Mode
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import Fault
from silverball.plain import plain
from silverball.table import Table, table_digest
from silverball.table.explain import explain
from silverball.table.file import SIZE_LIMIT as TABLE_LIMIT

FORMATS = (FORMAT, FORMAT_WITH_RULES, FORMAT_OF_MATCH)
TEXT_LIMIT = PLAY_LIMIT + TABLE_LIMIT + 10_000
ENDINGS = ("running", "over", "stopped", *(fault.name.lower() for fault in Fault if fault))
TABLE, PLAY, END = "--- table", "--- play", "--- end"
HEADER_KEYS = ("program", "physics", "rules", "mode", "seed", "tick_rate", "table")
RULES_KEY = "own_rules"
PLAYERS_KEY = "players"
MORE_KEYS = {FORMAT: (), FORMAT_WITH_RULES: (RULES_KEY,), FORMAT_OF_MATCH: (PLAYERS_KEY,)}
HEADER_LINE = 2  # the first line of the header
END_KEYS = ("ticks", "score", "ended", "digest", "checksum")
COPY_AGAIN = "copy the file again from where it was written"
_NUMBER = re.compile(r"0|[1-9]\d{0,18}", re.ASCII)
_HEX = re.compile(r"[0-9a-f]{64}", re.ASCII)


class _Section(NamedTuple):
    """A section of the file: the number of its first line, counted from 1, and the text of its lines."""

    first: int
    text: Sequence[str]


class Reader:
    """Reads one replay.

    Args:
        source: The name of the text in messages.
        text: The text of the replay.
    """

    def __init__(self, source: str, text: str) -> None:
        self.source = source
        self.text = text.replace("\r\n", "\n").removeprefix("\ufeff")
        self.lines = self.text.split("\n")

    def fields(self) -> tuple[Any, ...]:
        """The attributes of `Replay` in their order, all of them checked.

        Raises:
            StateError: The text is not a replay, is damaged, or is of another version.
        """
        form = self._checked_format()
        head, table, play, end = self._sections()
        self._check_checksum(end)
        values = self._values(head, (*HEADER_KEYS, *MORE_KEYS[form]))
        physics = self._integer(head, 1, values[1], OLDEST_PHYSICS, PHYSICS_VERSION)
        self._integer(head, 2, values[2], RULES_VERSION, RULES_VERSION)
        mode = self._choice(head, 3, values[3], tuple(Mode))
        seed = self._integer(head, 4, values[4], 0, 2**63 - 1)
        rate = self._integer(head, 5, values[5], MIN_TICK_RATE, MAX_TICK_RATE)
        ends = self._values(end, END_KEYS)
        ticks = self._integer(end, 0, ends[0], 0, rate * (SECONDS_LIMIT + 1))
        score = self._integer(end, 1, ends[1], 0, 10**18)
        ended = self._choice(end, 2, ends[2], ENDINGS)
        digest = self._hex(end, 3, ends[3])
        lines, tail = self._play(play, ticks, rate)
        board = self._table(table, self._hex(head, 6, values[6]))
        if physics != PHYSICS_VERSION and board.format != 1:
            self.refuse(
                table.first, f"expected a table of format 1 with physics {physics}, got {board.format}"
            )
        program = plain(values[0][:40])
        rules = self._own_rules(head, 7, values[7]) if form == FORMAT_WITH_RULES else ""
        players = self._players(head, 7, values[7], mode) if form == FORMAT_OF_MATCH else 1
        fields = (
            program,
            Mode(mode),
            board,
            seed,
            rate,
            lines,
            tail,
            ticks,
            score,
            ended,
            digest,
            rules,
            physics,
            players,
        )
        return fields

    def refuse(self, line: int, message: str) -> NoReturn:
        """Raise `StateError` with a sentence about a line."""
        raise StateError(f"{self.source}, line {line}: {message}")

    def _checked_format(self) -> int:
        """The format of the replay, if it is one and its versions can be played."""
        first = self.lines[0]
        if not self.text.strip():
            raise StateError(f"{self.source}: the file is empty; a replay begins with '{FIRST} {FORMAT}'")
        match = re.fullmatch(rf"{FIRST} (\d{{1,9}})", first, re.ASCII)
        if match is None:
            self.refuse(
                1, f"this is not a replay: it begins with {_shown(first)}, a replay with '{FIRST} {FORMAT}'"
            )
        form = int(match[1])
        if form not in FORMATS:
            self.refuse(1, _other_version("format", form, FORMATS[-1]))
        versions = (("physics", OLDEST_PHYSICS, PHYSICS_VERSION), ("rules", RULES_VERSION, RULES_VERSION))
        for number, (key, oldest, ours) in enumerate(versions, 3):
            line = self.lines[number - 1] if len(self.lines) >= number else ""
            version = re.fullmatch(rf"{key} = (\d{{1,9}})", line, re.ASCII)
            if version is not None and not oldest <= int(version[1]) <= ours:
                program = self.lines[1].removeprefix("program = ")[:40]
                self.refuse(number, _other_version(key, int(version[1]), ours, program))
        return form

    def _sections(self) -> tuple[_Section, _Section, _Section, _Section]:
        """The header, the table, the lines of play and the end."""
        starts = [1]
        for heading in (TABLE, PLAY, END):
            try:
                starts.append(self.lines.index(heading, starts[-1]) + 1)
            except ValueError:
                self.refuse(
                    len(self.lines),
                    f"the file is cut off or damaged: there is no line '{heading}'; {COPY_AGAIN}",
                )
        edges = [*starts, len(self.lines) + 1]
        head, table, play, end = (
            _Section(first + 1, self.lines[first : after - 1]) for first, after in pairwise(edges)
        )
        if len(end.text) < len(END_KEYS) + 1:
            self.refuse(len(self.lines), f"the file is cut off: the last lines are missing; {COPY_AGAIN}")
        if len(end.text) > len(END_KEYS) + 1 or end.text[-1]:
            line = end.first + len(END_KEYS)
            self.refuse(line, "there is more text after the checksum; remove it")
        return head, table, play, end

    def _check_checksum(self, end: _Section) -> None:
        line = end.first + len(END_KEYS) - 1
        last = end.text[len(END_KEYS) - 1]
        match = re.fullmatch(r"checksum = ([0-9a-f]{32})", last, re.ASCII)
        if match is None:
            self.refuse(
                line, f"expected 'checksum = ' and 32 hexadecimal digits, got {_shown(last)}; {COPY_AGAIN}"
            )
        body = "\n".join(self.lines[: line - 1]) + "\n"
        got = checksum(body)
        if match[1] != got:
            self.refuse(
                line,
                f"the text was changed or damaged: expected checksum {match[1]}, got {got}; {COPY_AGAIN}",
            )

    def _values(self, part: _Section, keys: tuple[str, ...]) -> list[str]:
        """The values of lines that must have these keys in this order."""
        values = []
        for number, key in enumerate(keys):
            line = part.text[number] if number < len(part.text) else ""
            if not line.startswith(f"{key} = "):
                self.refuse(part.first + number, f"expected '{key} = …', got {_shown(line)}; {COPY_AGAIN}")
            values.append(line.removeprefix(f"{key} = "))
        if part.first == HEADER_LINE and len(part.text) > len(keys):
            extra = part.text[len(keys)]
            self.refuse(part.first + len(keys), f"expected '{TABLE}', got {_shown(extra)}; {COPY_AGAIN}")
        return values

    def _integer(self, part: _Section, number: int, value: str, least: int, most: int) -> int:
        if not _NUMBER.fullmatch(value) or not least <= int(value) <= most:
            span = f"an integer from {least} to {most}" if least < most else str(least)
            self.refuse(part.first + number, f"expected {span}, got {_shown(value)}")
        return int(value)

    def _choice(self, part: _Section, number: int, value: str, choices: Sequence[str]) -> str:
        if value not in choices:
            self.refuse(part.first + number, f"expected one of {', '.join(choices)}, got {_shown(value)}")
        return value

    def _hex(self, part: _Section, number: int, value: str) -> str:
        if not _HEX.fullmatch(value):
            self.refuse(part.first + number, f"expected 64 hexadecimal digits, got {_shown(value)}")
        return value

    def _own_rules(self, part: _Section, number: int, value: str) -> str:
        if not is_custom_name(value):
            expected = f"the name of rules, 1 to {NAME_LIMIT} printable characters that are not a mode"
            self.refuse(part.first + number, f"expected {expected}, got {_shown(value)}")
        return value

    def _players(self, part: _Section, number: int, value: str, mode: str) -> int:
        if mode != Mode.ARCADE:
            self.refuse(part.first + number, f"expected one player in {mode} play, got {_shown(value)}")
        return self._integer(part, number, value, 2, MAX_PLAYERS)

    def _play(self, part: _Section, ticks: int, rate: int) -> tuple[tuple[str, ...], str]:
        """The lines of the whole seconds, and the inputs after them."""
        full, rest = divmod(ticks, rate)
        lines = list(part.text)
        has_tail = len(lines) == full + 1 and lines[-1].startswith("=")
        if len(lines) - has_tail != full or (rest and not has_tail):
            self.refuse(
                part.first,
                f"{ticks} ticks need {full} lines{' and a last one' if rest else ''}, one for each second, "
                f"got {len(lines)}; {COPY_AGAIN}",
            )
        tail = ""
        for number, line in enumerate(lines):
            last = number == full
            match = (TAIL if last else LINE).fullmatch(line)
            if match is None:
                shape = "'='" if last else "12 characters of digests"
                self.refuse(part.first + number, f"expected {shape} and inputs, got {_shown(line)}")
            inputs = match[1 if last else 2] or ""
            self._check_inputs(part.first + number, inputs, rest if last else rate - 1)
            tail = inputs if last else ""
        if has_tail and not rest and not tail:
            self.refuse(part.first + full, f"the last line is empty; {COPY_AGAIN}")
        return tuple(lines[:full]), tail

    def _check_inputs(self, line: int, inputs: str, last: int) -> None:
        try:
            for one in parse_inputs(inputs):
                if one.tick > last:
                    self.refuse(
                        line, f"expected inputs up to tick {last} of the second, got one at {one.tick}"
                    )
        except ValueError as error:
            self.refuse(line, f"expected inputs like 'kL' or '+2c', got {_shown(str(error))}")

    def _table(self, part: _Section, digest: str) -> Table:
        text = "\n".join(part.text)
        if len(text) > TABLE_LIMIT:
            self.refuse(part.first, f"a table has at most {TABLE_LIMIT:,} characters, got {len(text):,}")
        try:
            table = Table.model_validate(tomllib.loads(text))
        except RecursionError:
            self.refuse(part.first, "the table's brackets are nested too deeply")
        except ValidationError as error:
            self.refuse(part.first, f"the table cannot be used: {explain(error, Table)[0]}")
        except ValueError as error:
            self.refuse(part.first, f"the table is not valid TOML: {str(error)[:200]}")
        if table.random is not None:
            self.refuse(part.first, "the table is a recipe; a replay has the finished board")
        if table.has_mesh:
            self.refuse(part.first, "the table names a mesh; a replay has its footprint instead")
        got = table_digest(table)
        if got != digest:
            self.refuse(
                part.first,
                f"this is not the table that was played: expected digest {digest}, got {got}; {COPY_AGAIN}",
            )
        return table


def checksum(body: str) -> str:
    """The checksum of all text before the checksum's own line."""
    return hashlib.sha256(body.encode("utf-8", "surrogatepass")).hexdigest()[:32]


def _other_version(what: str, got: int, ours: int, program: str = "") -> str:
    """The sentence that refuses a file of another version."""
    if got > ours:
        return f"this replay has {what} {got}, this program knows {what} {ours}; get a newer Silverball"
    its = f"Silverball {program}, which wrote it" if program else "an older Silverball"
    return f"this replay has {what} {got}, this program has {what} {ours}; play it with {its}"


def _shown(text: str) -> str:
    """Some text as a message quotes it: short, on one line."""
    return repr(text if len(text) <= 40 else f"{text[:39]}…")
