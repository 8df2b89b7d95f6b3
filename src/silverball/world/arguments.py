"""Checks of arguments: integers in a range, seeds, and selections of worlds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

MAX_SEED = 2**63 - 1

Index = int | slice | Sequence[int] | ArrayLike | None
"""Which worlds: None (all), one number, a slice, a list of numbers, or a mask bool [world]."""


def checked_int(name: str, value: Any, least: int, greatest: int) -> int:
    """Return an argument as an int.

    Raises:
        ValueError: It is not an integer, or out of range.
    """
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= greatest:
        raise ValueError(f"{name} must be an integer from {least} to {greatest}, got {value!r}")
    return int(value)


def checked_seeds(seed: int | Sequence[int], count: int) -> list[int]:
    """Return the seeds of some worlds: seed, seed + 1, … for an integer, or the given ones.

    Raises:
        ValueError: A seed is invalid, or there is not one for each world.
    """
    if isinstance(seed, (int, np.integer)) and not isinstance(seed, bool):
        first = checked_int("seed", seed, 0, MAX_SEED - count + 1)
        return [first + index for index in range(count)]
    if isinstance(seed, (bool, float, str)) or seed is None:
        raise ValueError(f"seed must be an integer from 0 to 2⁶³ − 1, or one for each world, got {seed!r}")
    seeds = [checked_int("seed", value, 0, MAX_SEED) for value in seed]
    if len(seeds) != count:
        raise ValueError(f"seed must be one integer or {count} of them, one for each world, got {len(seeds)}")
    return seeds


def resolve_index(index: Index, count: int) -> slice | NDArray[np.int64]:
    """Return the rows that an index chooses among `count`: a slice, or numbers from 0 to count − 1.

    Raises:
        ValueError: The index has a wrong type or shape, or is out of range; a slice never is.
    """
    if index is None:
        return slice(0, count)
    if isinstance(index, slice):
        return index
    if isinstance(index, int) and not isinstance(index, bool):
        return slice(row := checked_row(index, count), row + 1)
    try:
        rows = np.asarray(index)
    except ValueError:
        rows = np.empty((0, 0))  # lists of different lengths: refused below
    if rows.dtype == np.bool_ and rows.shape == (count,):
        return np.flatnonzero(rows)
    if rows.dtype == np.bool_ and rows.ndim == 1:
        raise ValueError(f"a mask must have the shape ({count},), got {rows.shape}")
    if rows.shape == (0,):
        return np.empty(0, np.int64)
    if rows.dtype.kind not in "iu" or rows.ndim > 1:
        raise ValueError(
            f"index must be None, an integer, a slice, a list of integers or a mask, got {index!r}"
        )
    if rows.ndim == 0:
        return slice(row := checked_row(int(rows), count), row + 1)
    checked_row(int(rows.min()), count)
    checked_row(int(rows.max()), count)
    rows = rows.astype(np.int64)
    return np.where(rows < 0, rows + count, rows)


def checked_row(row: int, count: int) -> int:
    """Return the row that a number chooses among `count`; negative numbers count from the end.

    Raises:
        ValueError: It is out of range.
    """
    if not -count <= row < count:
        raise ValueError(f"index {row} is out of range: there are {count} worlds")
    return row % count
