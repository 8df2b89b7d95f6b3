"""How far does the plumb-bob of the tilt swing, and what does the next shove bring about?

A weight hangs in every pinball machine; when it swings far enough to touch the ring around it, the machine
tilts. Here its swing is one number: every shove adds 1 to it, as if it always came in the bob's own rhythm,
and in between it fades. So there is no rhythm to be learnt in which shoves cost nothing.

The fading is worked out by multiplications alone, so that it has the same bits on every machine (the last bit
of `exp` differs between systems), and only when there is a shove, so that it is the same for ticks played one
by one or all at once.
"""

from __future__ import annotations

from enum import Enum

SHOVE = 1.0  # what one shove adds to the swing: the unit in which tables give their limits


class Verdict(Enum):
    """What a shove brings about."""

    NOTHING = 0
    WARNING = 1
    TILT = 2


def faded(swing: float, ticks: int, decay_ticks: float) -> float:
    """The swing after some ticks without a shove: swing · (1 − 1/decay)^ticks, close to e^(−ticks/decay).

    Args:
        swing: Before.
        ticks: How many.
        decay_ticks: In which a swing falls to 1/e, about.
    """
    keeps = max(1.0 - 1.0 / decay_ticks, 0.0)
    while ticks > 0:
        if ticks & 1:
            swing *= keeps
        keeps *= keeps
        ticks >>= 1
    return swing


def judged(swing: float, warnings: int, warning_limit: float, tilt_limit: float, allowed: int) -> Verdict:
    """What a shove brings about that has made the bob swing so far, after so many warnings."""
    if swing > tilt_limit or (swing > warning_limit and warnings >= allowed):
        return Verdict.TILT
    return Verdict.WARNING if swing > warning_limit else Verdict.NOTHING
