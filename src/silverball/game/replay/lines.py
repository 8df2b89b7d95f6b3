"""How is a second of play written on one line, and read again?

    q3Zx0aKfB1Gg +c4kK2a

First come the digests of the state at the second's end, two characters for each group of fields (see
`replay_digest`), then, if the player did anything, what it was. A letter is a change of a button: small for
the left one, capital for the right one, down or up in turn. The letter also says how many ticks after the
change before it: a 0, b 1, … z 25, and a number in front adds 26 each. The first counts from the second's
beginning. `+` and `!` before a small letter make it a new ball and a shove.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

LETTERS = 26
MARKS = {"L": "", "R": "", "+": "+", "!": "!"}
LINE = re.compile(r"([A-Za-z0-9_-]{12})(?: ((?:[+!]?\d{0,4}[A-Za-z])+))?", re.ASCII)
TAIL = re.compile(r"=(?: ((?:[+!]?\d{0,4}[A-Za-z])+))?", re.ASCII)
_TOKEN = re.compile(r"([+!]?)(\d{0,4})([A-Za-z])", re.ASCII)


class Input(NamedTuple):
    """Something the player did.

    Attributes:
        tick: Before this tick, counted from the beginning of its second.
        kind: "L" or "R" (a button goes down or up), "+" (a new ball) or "!" (a shove).
    """

    tick: int
    kind: str


def written(kind: str, ticks: int) -> str:
    """One input, so many ticks after the one before it."""
    more, letter = divmod(ticks, LETTERS)
    first = "A" if kind == "R" else "a"
    return f"{MARKS[kind]}{more or ''}{chr(ord(first) + letter)}"


def read(inputs: str) -> Iterator[Input]:
    """The inputs of a line, for a text that `LINE` or `TAIL` matches.

    Raises:
        ValueError: Something in it is not written as `written` writes it.
    """
    tick = 0
    for mark, more, letter in _TOKEN.findall(inputs):
        is_small = letter >= "a"
        if more.startswith("0") or (mark and not is_small):
            raise ValueError(f"{mark}{more}{letter}")
        tick += LETTERS * int(more or 0) + ord(letter) - ord("a" if is_small else "A")
        yield Input(tick, mark or ("L" if is_small else "R"))
