"""Combos: hits that follow each other quickly, and what they pay.

The functions need no compiler; `numbers.py` compiles them.
"""

from __future__ import annotations


def hits_in_a_row(combo: int, combo_tick: int, combo_ticks: int, tick: int) -> int:
    """Hits in a row so far; 0 if the time for the next one is over.

    Args:
        combo: Hits in a row when the last one came.
        combo_tick: The tick of that hit.
        combo_ticks: The time for the next one [ticks]; negative: there are no combos.
        tick: The present tick.
    """
    return combo if tick - combo_tick <= combo_ticks else 0


def factor_of_combo(hits: int, step: int, limit: int) -> int:
    """What points are multiplied by in a combo: 1 + (hits − 1) / step, up to the limit.

    Args:
        hits: Hits in a row.
        step: Hits that raise the factor by one.
        limit: The greatest factor.
    """
    return min(1 + max(hits - 1, 0) // step, limit)
