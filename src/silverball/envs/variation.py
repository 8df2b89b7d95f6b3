"""Boards that differ in their physics: numbers drawn for each board from ranges, for domain randomisation.

A key is a section of a table file and one of its numbers, ``board.gravity`` or ``paddle.stroke``; a number of
parts holds for all parts of the kind. Only numbers are varied that leave the places of parts, the buttons and
the scales of observations as they are. A board's numbers follow from its seed and the key alone.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from numbers import Real
from typing import Any, TypeAlias

from silverball.envs.rewards import did_you_mean
from silverball.errors import TableError
from silverball.plain import plain
from silverball.table import Table
from silverball.table.table import PART_KINDS

Ranges: TypeAlias = tuple[tuple[str, float, float], ...]
"""Key, least and greatest value of everything that varies."""

BOARD_KEYS = (
    "gravity", "slope", "friction", "ball_restitution", "wall_restitution", "hit_speed", "jitter",
)  # fmt: skip
PART_KEYS = (
    "restitution", "restitution_falloff", "friction", "hit_speed", "speed_factor", "kick", "stroke",
    "return_stroke", "mass",
)  # fmt: skip
KEYS = (
    *(f"board.{key}" for key in BOARD_KEYS),
    *(f"{kind}.{key}" for kind, part in PART_KINDS.items() for key in PART_KEYS if key in part.model_fields),
)
"""Everything that can vary."""


def checked_ranges(vary: Any) -> Ranges:
    """The ranges of a `vary` option, in the order of `KEYS`; empty for None.

    Raises:
        ValueError: It is not a mapping of known keys to ranges (least, greatest).
    """
    if vary is None:
        return ()
    if not isinstance(vary, Mapping):
        raise ValueError(f'vary must be a dict such as {{"board.gravity": (8, 12)}}, got {vary!r}')
    for key in vary:
        if key not in KEYS:
            raise ValueError(
                f"vary: unknown key {key!r}; {did_you_mean(key, KEYS)}expected 'board.' and one of "
                f"{', '.join(BOARD_KEYS)}, or a kind of part and one of {', '.join(PART_KEYS)}"
            )
    return tuple((key, *_checked_range(key, vary[key])) for key in KEYS if key in vary)


def _checked_range(key: str, given: Any) -> tuple[float, float]:
    is_pair = isinstance(given, (tuple, list)) and len(given) == 2
    if not (is_pair and all(isinstance(end, Real) and not isinstance(end, bool) for end in given)):
        raise ValueError(f"vary: the range of {key!r} must be (least, greatest), got {given!r}")
    least, greatest = map(float, given)
    if not (least <= greatest and math.isfinite(greatest - least)):
        raise ValueError(f"vary: the range of {key!r} must be finite and ascending, got {given!r}")
    return least, greatest


def check_ends(table: Table, ranges: Ranges) -> None:
    """Check that a table can be played at both ends of the ranges.

    Raises:
        ValueError: It has no part of a kind that varies, or a number is out of the range of a table file.
    """
    for key, _, _ in ranges:
        kind = key.partition(".")[0]
        if kind != "board" and not getattr(table, kind):
            raise ValueError(f"vary: {plain(table.name)} has no {kind}, so that {key!r} cannot vary")
    ends = {key: least for key, least, _ in ranges}, {key: greatest for key, _, greatest in ranges}
    for numbers in ends:
        try:
            with_numbers(table, numbers).replace()
        except TableError as error:
            problem = error.problems[0]
            raise ValueError(f"vary: {plain(problem.path)} {plain(problem.message)}") from None


def numbers_of(seed: int, ranges: Ranges) -> dict[str, float]:
    """The numbers of the board with this seed: evenly from their ranges, the same on every machine."""
    return {key: least + (greatest - least) * _share(seed, key) for key, least, greatest in ranges}


def _share(seed: int, key: str) -> float:
    """A number from 0 to below 1 that follows from a seed and a text."""
    return int.from_bytes(hashlib.sha256(f"{seed} {key}".encode()).digest()[:6], "big") / 2**48


def with_numbers(table: Table, numbers: Mapping[str, float]) -> Table:
    """A table with these numbers, by their keys; nothing is checked."""
    sections: dict[str, dict[str, float]] = {}
    for key, value in numbers.items():
        kind, _, name = key.partition(".")
        sections.setdefault(kind, {})[name] = value
    changed: dict[str, Any] = {}
    for kind, values in sections.items():
        if kind == "board":
            changed[kind] = table.board.model_copy(update=values)
        else:
            changed[kind] = tuple(part.model_copy(update=values) for part in getattr(table, kind))
    return table.model_copy(update=changed)


def without_physics(table: Table, section: str) -> Any:
    """A section of a table without the numbers that can vary, to compare with that of another table."""
    models, keys = getattr(table, section), set(BOARD_KEYS if section == "board" else PART_KEYS)
    several = models if isinstance(models, tuple) else (models,)
    return [model.model_dump(exclude=keys) for model in several]
