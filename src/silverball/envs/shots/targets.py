"""Which parts of a table are shots: what a goal may name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from silverball.envs.rewards import did_you_mean
from silverball.plain import plain
from silverball.table import Table, expand

SHOTS: Final[dict[str, tuple[str, ...]]] = {
    "classic": ("left side", "left lane", "left", "heart", "top", "right", "right lane", "right side"),
    "silver_comet": (
        "left target", "left orbit switch", "ramp", "left drop target", "middle drop target",
        "right drop target", "saucer", "right orbit switch", "side target",
    ),
}  # fmt: skip
"""The shots of built-in tables by the names of parts, from left to right."""

MAX_SHOTS = 64


def parts_of(table: Table, shots: Sequence[str]) -> NDArray[np.int64]:
    """The shot that each part of a table is, int64 [part]; −1: none.

    Args:
        table: A finished table.
        shots: Names of parts, as in the table file or as in events.

    Raises:
        ValueError: A name is unknown, or two name the same part.
    """
    expansion = expand(table)
    numbers = {**expansion.numbers, **expansion.named}
    found = np.full(len(expansion.parts), -1, np.int64)
    for shot, name in enumerate(shots):
        if name not in numbers:
            hint = did_you_mean(name, numbers) or "expected names of parts"
            raise ValueError(f"shots: {plain(table.name)} has no part {name!r}; {hint.strip()}")
        if found[numbers[name]] >= 0:
            raise ValueError(f"shots: {name!r} is named twice")
        found[numbers[name]] = shot
    return found


def checked_shots(shots: Sequence[str] | None, table: str | None) -> tuple[str, ...]:
    """The names of the shots, by default those of a built-in table.

    Args:
        shots: Names, or None.
        table: The name of a built-in table; None: it is another one.

    Raises:
        TypeError: They are not a list of names.
        ValueError: There are fewer than 2 or more than MAX_SHOTS, or the table has none by default.
    """
    if shots is None and table not in SHOTS:
        names = " and ".join(map(repr, SHOTS))
        raise ValueError(f"shots must be a list of names of parts: only {names} have shots by default")
    given = SHOTS[table] if shots is None and table is not None else shots
    if (
        not isinstance(given, Sequence)
        or isinstance(given, str)
        or not all(isinstance(name, str) for name in given)
    ):
        raise TypeError(f"shots must be a list of names of parts, got {given!r}")
    if not 2 <= len(given) <= MAX_SHOTS:
        raise ValueError(f"shots must be 2 to {MAX_SHOTS} names of parts, got {len(given)}")
    return tuple(given)
