"""What a design has to reach, and which numbers of a table it may change, as read from the command line."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping
from typing import NamedTuple

from silverball.errors import SilverballError
from silverball.metrics.statistics import Estimate
from silverball.studies.figure_words import ROWS
from silverball.studies.table_change import number_at
from silverball.table import Table

TARGET = re.compile(r"\s*(?P<name>\w+)\s*=\s*(?P<value>[^±+\s]+)\s*(?:±|\+/?-)\s*(?P<within>\S+)\s*")
WORDS = {"ball_time": "seconds_per_ball", "median_ball_time": "median_ball"}
"""Names that people use for figures."""

GRAVITY, LENGTH = (0.6, 1.6), (0.85, 1.15)  # of the value that is there, if nothing is said


class Target(NamedTuple):
    """A figure and where it has to be.

    Attributes:
        name: As it was written.
        figure: The name of the figure in studies.
        value: [the unit of the figure]
        within: The largest distance from it, above zero.
    """

    name: str
    figure: str
    value: float
    within: float

    def miss(self, figures: Mapping[str, Estimate]) -> float:
        """How far away a table is, in widths of the target: at most 1 is reached; inf without the figure."""
        found = figures[self.figure].value if self.figure in figures else math.nan
        return abs(found - self.value) / self.within if math.isfinite(found) else math.inf

    def __str__(self) -> str:
        return f"{self.name}={self.value:g}±{self.within:g}"


class Range(NamedTuple):
    """A number of a table and between which values it may be.

    Attributes:
        path: Its path, see `table_change`.
        low: The least value.
        high: The greatest value.
        is_whole: Whether it is a whole number.
    """

    path: str
    low: float
    high: float
    is_whole: bool

    def at(self, share: float) -> float:
        """The value at a share of the way from the least to the greatest, rounded to four digits."""
        value = self.low + min(1.0, max(0.0, share)) * (self.high - self.low)
        return round(value) if self.is_whole else float(f"{value:.4g}")


def figure_names() -> tuple[str, ...]:
    """The figures that a target may name."""
    return (*WORDS, *ROWS)


def parse_target(text: str) -> Target:
    """Read a target: `ball_time=30±2`, or `ball_time=30+-2`.

    Raises:
        SilverballError: It is something else, or no figure has that name.

    Examples:
        >>> parse_target("ball_time=30±2").within
        2.0
    """
    found = TARGET.fullmatch(text)
    try:
        if found is None:
            raise ValueError
        value, within = float(found["value"]), float(found["within"])
        if not (math.isfinite(value) and math.isfinite(within) and within > 0.0):
            raise ValueError
    except ValueError:
        raise SilverballError(
            f"--target: expected FIGURE=VALUE±DISTANCE, for example ball_time=30±2, got {text!r}"
        ) from None
    name = found["name"]
    figure = WORDS.get(name, name)
    if figure not in ROWS:
        near = difflib.get_close_matches(name, figure_names(), 1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise SilverballError(
            f"--target: no figure is called {name!r}; {hint}there are {', '.join(figure_names())}"
        )
    return Target(name, figure, value, within)


def parse_range(text: str, table: Table) -> Range:
    """Read the range of a number of a table: `paddle.length=1.8:2.4`.

    Raises:
        SilverballError: It is something else, or the table has no such number.
    """
    path, _, given = text.partition("=")
    try:
        low, high = (float(word) for word in given.split(":"))
        if not (path.strip() and math.isfinite(low) and math.isfinite(high) and low < high):
            raise ValueError
    except ValueError:
        raise SilverballError(
            f"--vary: expected PATH=LEAST:GREATEST, for example paddle.length=1.8:2.4, got {text!r}"
        ) from None
    is_whole = isinstance(number_at(table, path.strip()), int)
    if is_whole and not (low.is_integer() and high.is_integer()):
        raise SilverballError(f"--vary {path.strip()}: this is a whole number, got {given!r}")
    return Range(path.strip(), low, high, is_whole)


def usual_ranges(table: Table) -> list[Range]:
    """What is varied if nothing is said: gravity, paddles, and of a recipe how many obstacles there are."""
    gravity = table.board.gravity
    found = [_around("board.gravity", gravity, GRAVITY)]
    if table.paddle:
        found.append(_around("paddle.length", table.paddle[0].length, LENGTH))
    if table.random is not None:
        for name in ("triangular_prisms", "cylinders"):
            found.append(Range(f"random.{name}", 0, 2 * max(1, getattr(table.random, name)), True))
    return found


def _around(path: str, value: float, shares: tuple[float, float]) -> Range:
    """The range between two shares of a value."""
    low, high = (float(f"{value * share:.3g}") for share in shares)
    return Range(path, low, high, False)
