"""Boards of the PinBall domain, and the reader of their `.cfg` files.

A file has one item a line, with coordinates from 0 to 1; x goes to the right and y downwards:

    ball 0.02                              the radius of the ball
    target 0.9 0.2 0.04                    centre and radius of the target
    start 0.2 0.9                          where the ball may start: one or more places, x y each
    polygon 0.0 0.0 0.0 0.01 1.0 0.01 …    the corners of an obstacle, x y each

Empty lines, and what follows a `#`, are ignored.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, TypeAlias

from silverball.errors import Problem, TableError
from silverball.plain import plain
from silverball.table.quantity import shown
from silverball.wholefile import Unreadable, read_text

MAX_BYTES = 1_000_000  # of a file; those of the papers have 2,000
MAX_CORNERS = 1000  # of one polygon
MAX_EDGES = 4000  # of all polygons
MAX_STARTS = 1000
RADII = (0.01, 0.2)  # of the ball
TARGET_RADII = (0.005, 0.5)
FOLDER = Path(__file__).parent / "boards"

Spot: TypeAlias = tuple[float, float]
"""A place (x, y) on a board."""


class DomainBoard(NamedTuple):
    """A board of the domain; lengths in widths of the board.

    Attributes:
        name: The name of a built-in board, or the path of the file.
        ball_radius: The radius of the ball.
        target: The centre of the target.
        target_radius: The ball's centre must come this near to the target's.
        starts: Where the ball may start.
        polygons: The corners of the obstacles, in order; none is repeated.
    """

    name: str
    ball_radius: float
    target: Spot
    target_radius: float
    starts: tuple[Spot, ...]
    polygons: tuple[tuple[Spot, ...], ...]


def board_names() -> list[str]:
    """The names of the built-in boards, from the easiest on.

    Examples:
        >>> from silverball.envs.domain.board_file import board_names
        >>> board_names()
        ['open', 'wall', 'steps', 'rooms']
    """
    boards = [load_board(path.stem) for path in FOLDER.glob("*.cfg")]
    return [board.name for board in sorted(boards, key=lambda board: len(board.polygons))]


def load_board(name_or_path: str | os.PathLike[str]) -> DomainBoard:
    """Read a board.

    Args:
        name_or_path: The name of a built-in board (see `board_names`), or the path of a ``.cfg`` file.

    Raises:
        TableError: There is no such board, or the file has problems; all of them are in `problems`.

    Examples:
        >>> from silverball.envs.domain.board_file import load_board
        >>> load_board("open").target_radius
        0.05
    """
    if not isinstance(name_or_path, str | os.PathLike):
        raise TypeError(f"board must be a name or a path, got {type(name_or_path).__name__}")
    text = os.fspath(name_or_path)
    is_name = isinstance(name_or_path, str) and not text.endswith(".cfg") and os.sep not in text
    path = FOLDER / f"{text}.cfg" if is_name else Path(text)
    if is_name and text not in {file.stem for file in FOLDER.glob("*.cfg")}:
        names = ", ".join(sorted(file.stem for file in FOLDER.glob("*.cfg")))
        raise TableError(text, [Problem("", f"no board has this name; expected {names}, or a path *.cfg")])
    try:
        return parse_board(read_text(path, MAX_BYTES, "a board"), text)
    except Unreadable as error:
        raise TableError(text, [Problem("", str(error))]) from None


def parse_board(text: str, source: str = "board") -> DomainBoard:
    """Read a board from the text of a file.

    Args:
        text: The text.
        source: Its name in messages.

    Raises:
        TableError: The text has problems; all of them are in `problems`, each with its line.
    """
    reading = _Reading()
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].split()
        if words:
            reading.read(f"line {number}", words)
    reading.finish()
    if reading.problems:
        raise TableError(source, reading.problems)
    return DomainBoard(
        plain(source),
        reading.numbers["ball"][0],
        (reading.numbers["target"][0], reading.numbers["target"][1]),
        reading.numbers["target"][2],
        tuple(reading.starts),
        tuple(reading.polygons),
    )


class _Reading:
    """What has been read of a file so far.

    Attributes:
        numbers: Those of the ball and the target, by the word at the start of the line.
        starts: All places where the ball may start.
        polygons: The corners of all obstacles.
        problems: What is wrong.
    """

    def __init__(self) -> None:
        self.numbers: dict[str, list[float]] = {}
        self.starts: list[Spot] = []
        self.polygons: list[tuple[Spot, ...]] = []
        self.problems: list[Problem] = []

    def read(self, where: str, words: list[str]) -> None:
        """Read a line."""
        item, values = words[0], self._numbers(where, words[1:])
        if values is None:
            return
        if item in ("ball", "target"):
            self._read_one(where, item, values)
        elif item in ("start", "polygon"):
            self._read_spots(where, item, values)
        else:
            self._refuse(where, f"expected ball, target, start or polygon, got {shown(item)}")

    def finish(self) -> None:
        """Note what is missing, and what is too much."""
        given = {**self.numbers, "start": self.starts}
        for item, example in (("ball", "0.02"), ("target", "0.9 0.2 0.04"), ("start", "0.2 0.9")):
            if not given.get(item) and not self.problems:
                self._refuse("", f"has no {item}: add a line like `{item} {example}`")
        edges = sum(map(len, self.polygons))
        if edges > MAX_EDGES:
            self._refuse("", f"has {edges:,} edges of polygons, at most {MAX_EDGES:,} are allowed")
        if len(self.starts) > MAX_STARTS:
            self._refuse("", f"has {len(self.starts):,} starts, at most {MAX_STARTS:,} are allowed")

    def _refuse(self, where: str, message: str) -> None:
        self.problems.append(Problem(where, message))

    def _numbers(self, where: str, words: list[str]) -> list[float] | None:
        """The numbers of a line; None if a word is not a finite number."""
        values: list[float] = []
        for word in words:
            try:
                value = float(word)
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                self._refuse(where, f"expected numbers after the first word, got {shown(word)}")
                return None
            values.append(value + 0.0)
        return values

    def _read_one(self, where: str, item: str, values: list[float]) -> None:
        """Read the ball or the target, of which a board has one."""
        form, (least, greatest) = ("radius", RADII) if item == "ball" else ("x y radius", TARGET_RADII)
        if item in self.numbers:
            self._refuse(where, f"a board has one {item}, and this is the second: leave one out")
        elif len(values) != len(form.split()):
            self._refuse(where, f"expected `{item} {form}`, got {len(values)} numbers")
        elif not least <= values[-1] <= greatest:
            self._refuse(where, f"the radius must be {least:g} to {greatest:g}, got {values[-1]:g}")
        elif all(self._is_on_board(where, value) for value in values[:-1]):
            self.numbers[item] = values

    def _read_spots(self, where: str, item: str, values: list[float]) -> None:
        """Read places of the ball, or the corners of a polygon."""
        if len(values) % 2 or not values:
            self._refuse(where, f"expected `{item} x y x y …`, got {len(values)} numbers")
            return
        if not all(self._is_on_board(where, value) for value in values):
            return
        spots = list(zip(values[::2], values[1::2], strict=True))
        if item == "start":
            self.starts += spots
            return
        corners = tuple(_without_repeats(spots))
        if not 3 <= len(corners) <= MAX_CORNERS:
            self._refuse(
                where, f"a polygon must have 3 to {MAX_CORNERS} different corners, got {len(corners)}"
            )
            return
        self.polygons.append(corners)

    def _is_on_board(self, where: str, value: float) -> bool:
        """Whether a coordinate is on the board; if not, that is noted."""
        if 0.0 <= value <= 1.0:
            return True
        self._refuse(where, f"a coordinate must be 0 to 1, got {value:g}")
        return False


def _without_repeats(spots: list[Spot]) -> Iterator[Spot]:
    """The corners of a closed polygon, without those that the next one repeats."""
    for spot, after in pairwise([*spots, spots[0]]):
        if spot != after:
            yield spot
