"""Checks of the arguments of vector environments: seeds, reset masks, autoreset modes, ended episodes."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from numpy.typing import ArrayLike, NDArray

from silverball.envs.options import SEED_RANGE, checked_seed
from silverball.envs.state import ResetMode

RESET_MODES = {
    AutoresetMode.DISABLED: ResetMode.DISABLED,
    AutoresetMode.NEXT_STEP: ResetMode.NEXT_STEP,
    AutoresetMode.SAME_STEP: ResetMode.SAME_STEP,
}
"""The modes of Gymnasium as numbers for kernels."""


def refuse_ended(over: NDArray[np.int64]) -> None:
    """Raise an error if episodes are over, int [env], which a step cannot continue.

    Raises:
        ResetNeeded: One is.
    """
    rows = np.flatnonzero(over)
    if len(rows):
        raise ResetNeeded(
            f"{len(rows)} episodes are over or have not begun, the first in environment {rows[0]}: "
            'call reset, with options={"reset_mask": terminated | truncated} to begin only these'
        )


def seeds_of(seed: Any, count: int) -> NDArray[np.int64]:
    """The seed of each of `count` environments, int64 [env]; −1: none.

    Raises:
        ValueError: There are not as many seeds as environments, or one is not an integer ≥ 0.
    """
    if seed is None:
        return np.full(count, -1, np.int64)
    if not isinstance(seed, (list, tuple, np.ndarray)) or np.ndim(seed) == 0:
        first = checked_seed(seed)
        return np.array([(first + number) % SEED_RANGE for number in range(count)], np.int64)
    if len(seed) != count:
        raise ValueError(f"seed must be one number or {count} of them, got {len(seed)}")
    return np.array([-1 if one is None else checked_seed(one) for one in seed], np.int64)


def draw_missing(seeds: NDArray[np.int64], where: NDArray[np.bool_], generator: np.random.Generator) -> None:
    """Draw the seeds of the environments `where`, bool [env], that have none, int64 [env]."""
    missing = where & (seeds < 0)
    if missing.any():
        drawn = generator.integers(SEED_RANGE, size=len(seeds), dtype=np.uint64)
        seeds[missing] = drawn.astype(np.int64)[missing]


def checked_mask(mask: ArrayLike | None, count: int) -> NDArray[np.bool_]:
    """The environments that a reset begins, bool [env]; all for None.

    Raises:
        ValueError: It has another length than `count`, or selects nothing.
        TypeError: It is not a boolean array.
    """
    if mask is None:
        return np.ones(count, np.bool_)
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
        raise TypeError(f"reset_mask must be a boolean array, got {getattr(mask, 'dtype', type(mask))}")
    if mask.shape != (count,):
        raise ValueError(f"reset_mask must have the shape ({count},), got {mask.shape}")
    if not mask.any():
        raise ValueError("reset_mask must select at least one environment, got none")
    return mask


def checked_mode(mode: AutoresetMode | str) -> AutoresetMode:
    """The autoreset mode, given by itself, its name or its value.

    Raises:
        ValueError: There is no such mode.
    """
    if mode in AutoresetMode.__members__:
        return AutoresetMode[str(mode)]
    try:
        return AutoresetMode(mode)
    except ValueError:
        modes = ", ".join(repr(one.value) for one in AutoresetMode)
        raise ValueError(f"autoreset_mode must be one of {modes}, got {mode!r}") from None
