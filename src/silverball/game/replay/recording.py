"""The lines of a recording: each second of play as text, written while it is played and read again.

    q3Zx0aKfB1Gg +c4kK2a

A line begins with the digests of the state at the end of the second, two characters for each group of fields
(see `digest`). The inputs of the second follow, if there are any. A letter is a change of a button, down and
up in turn: lower case for the left button, upper case for the right one. The letter also gives the ticks
since the previous input: a is 0, b is 1, … z is 25; a number in front of it adds 26 each. The first input
counts from the beginning of the second. `+` before a lower-case letter is a new ball, `!` a shove (on a
table with `nudge` one up), `(` and `)` a nudge to the left and to the right, and `^` a change of the launch
button, down and up in turn.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

FIRST = "silverball replay"  # the first line of a replay, with the format
FORMAT = 1
FORMAT_WITH_RULES = 2  # with the name of custom rules in its header
FORMAT_OF_MATCH = 3  # with the number of players in its header
MIN_TICK_RATE, MAX_TICK_RATE = 10, 1000  # [1/s] limits for games: a recording counts ticks within a second
PLAY_LIMIT = 4_000_000  # characters of all lines: a day of lively play, or hours of a program
SECONDS_LIMIT = 86_400  # longest game
LETTERS = 26
LEFT, RIGHT, BALL, SHOVE, LAUNCH = "L", "R", "+", "!", "^"  # the kinds of input
NUDGES = {"left": "(", "right": ")", "up": SHOVE}
"""The kind of input of a nudge, by its direction."""

PREFIXES = {LEFT: "", RIGHT: ""} | {kind: kind for kind in (BALL, LAUNCH, *NUDGES.values())}
LINE = re.compile(r"([A-Za-z0-9_-]{12})(?: ((?:[+!^()]?\d{0,4}[A-Za-z])+))?", re.ASCII)
TAIL = re.compile(r"=(?: ((?:[+!^()]?\d{0,4}[A-Za-z])+))?", re.ASCII)
_TOKEN = re.compile(r"([+!^()]?)(\d{0,4})([A-Za-z])", re.ASCII)


class Input(NamedTuple):
    """One input of the player.

    Attributes:
        tick: The tick before which it comes, counted from the beginning of its second.
        kind: `LEFT`, `RIGHT` or `LAUNCH` (a button goes down or up), `BALL` (a new ball), `SHOVE`
            or another one of `NUDGES`.
    """

    tick: int
    kind: str


def format_input(kind: str, ticks: int) -> str:
    """The text of one input.

    Args:
        kind: The kind of input.
        ticks: Ticks since the previous input.
    """
    more, letter = divmod(ticks, LETTERS)
    first = "A" if kind == RIGHT else "a"
    return f"{PREFIXES[kind]}{more or ''}{chr(ord(first) + letter)}"


def parse_inputs(text: str) -> Iterator[Input]:
    """The inputs of a line, for a text that `LINE` or `TAIL` matches.

    Raises:
        ValueError: An input is not written as `format_input` writes it.
    """
    tick = 0
    for prefix, more, letter in _TOKEN.findall(text):
        is_lower = letter >= "a"
        if more.startswith("0") or (prefix and not is_lower):
            raise ValueError(f"{prefix}{more}{letter}")
        tick += LETTERS * int(more or 0) + ord(letter) - ord("a" if is_lower else "A")
        yield Input(tick, prefix or (LEFT if is_lower else RIGHT))


class Recorder:
    """Records the inputs of a game, second by second.

    Attributes:
        lines: The whole seconds so far: digests and inputs.
        inputs: The inputs of the second that has begun.
    """

    def __init__(self, tick_rate: int) -> None:
        self.lines: list[str] = []
        self.inputs = ""
        self._tick_rate = tick_rate
        self._last_tick = 0  # tick of the last input, or of the beginning of the second
        self._size = 0  # characters of all lines

    def add_input(self, tick: int, kind: str) -> None:
        """Record an input that comes before this tick."""
        self.inputs += format_input(kind, tick - self._last_tick)
        self._last_tick = tick

    def end_second(self, digests: str) -> None:
        """End a second, with the digests of the state at its end."""
        line = f"{digests} {self.inputs}" if self.inputs else digests
        self.lines.append(line)
        self._size += len(line) + 1
        self.inputs = ""
        self._last_tick = len(self.lines) * self._tick_rate

    @property
    def is_full(self) -> bool:
        """Whether nothing more can be recorded; the game ends then."""
        return len(self.lines) >= SECONDS_LIMIT or self._size + len(self.inputs) >= PLAY_LIMIT


def has_custom_rules(text: str) -> bool:
    """Whether the text of a replay is of a game with custom rules."""
    first_line = text.removeprefix("\ufeff").partition("\n")[0].rstrip("\r")
    return first_line == f"{FIRST} {FORMAT_WITH_RULES}"
