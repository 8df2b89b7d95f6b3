"""The tilt bob: how far it swings after each shove, and whether that is a warning or a tilt.

A weight hangs in every pinball machine; if it swings far enough to touch the ring around it, the machine
tilts. Here its swing is one number. Each shove adds 1 to it, and between shoves it decays, so every shove
counts, whatever the rhythm.

The decay uses multiplications alone, which have the same bits on every machine (the last bit of `exp` differs
between systems), and is computed at each shove only, so that it does not matter how many ticks are played at
once. The functions need no compiler; `turns.py` compiles them.
"""

from __future__ import annotations

from enum import IntEnum

SHOVE = 1.0  # swing added by one shove: the unit of the limits in table files


class ShoveResult(IntEnum):
    """The consequence of a shove."""

    NOTHING = 0
    WARNING = 1
    TILT = 2


def decayed(swing: float, ticks: int, decay_ticks: float) -> float:
    """The swing after some ticks without a shove: swing · (1 − 1/decay)^ticks, close to e^(−ticks/decay).

    Args:
        swing: The swing before.
        ticks: Ticks since then.
        decay_ticks: Time constant: the swing falls to about 1/e in this time [ticks].
    """
    factor = max(1.0 - 1.0 / decay_ticks, 0.0)
    while ticks > 0:
        if ticks & 1 != 0:
            swing *= factor
        factor *= factor
        ticks >>= 1
    return swing


def shove_result(
    swing: float, warnings: int, warning_limit: float, tilt_limit: float, allowed: int
) -> ShoveResult:
    """The consequence of a shove.

    Args:
        swing: The swing after the shove.
        warnings: Warnings before it.
        warning_limit: A greater swing causes a warning.
        tilt_limit: A greater swing causes a tilt.
        allowed: After this many warnings the next one is a tilt.
    """
    if swing > tilt_limit or (swing > warning_limit and warnings >= allowed):
        return ShoveResult.TILT
    return ShoveResult.WARNING if swing > warning_limit else ShoveResult.NOTHING
