"""Which numbers can be seeds, and what becomes of them?"""

from __future__ import annotations

from operator import index
from typing import Any

GREATEST_SEED = 2**63


def key_of(seed: Any) -> int:
    """What a seed is for the engine: a whole number from 0, below 2⁶³.

    Raises:
        ValueError: It is no whole number, or negative.
    """
    try:
        number = index(seed)
    except TypeError:
        number = -1
    if number < 0:
        raise ValueError(f"seed must be a whole number from 0, got {seed!r}")
    return number % GREATEST_SEED
