"""How does a rolling ball sound? Loops of noise for some speeds, blended by how fast each ball is.

A ball has a lane of its own with all loops in it; its speed says which two are heard. Speeds, loudness and
places change gradually, so that nothing clicks when a ball bounces. A ball that slides sounds the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from silverball.app.sound.levels import pan
from silverball.app.sound.synth import RATE, Wave

_RATIO = 1.55
_STEP = math.log(_RATIO)
ROLL_SPEEDS = tuple(_RATIO**number for number in range(8))
"""Speeds of the ball [u/s] for which there is a loop, 1 to 21.5; between them two loops are blended."""

ROLL_SECONDS = 1.5
"""Length of a loop: long enough that one does not hear it come again."""

ROLL_LEVEL = -28.0
"""Loudness of a loop at full strength [dB]: well below a hit."""

_TURN = 1.57  # [u] that a ball of the usual radius of 0.25 u goes in one turn


def roll_pitch(speed: float) -> float:
    """Where the rolling of a ball sounds strongest [Hz], by its speed [u/s]: 110 Hz · speed^0.45.

    Steel on wood does not rise as a siren does: twice the speed raises it by less than half an octave.
    """
    return float(110.0 * speed**0.45)


def roll_spectrum(pitch: float) -> Callable[[Wave], Wave]:
    """How strong each pitch is in a loop: a hump at the pitch, another one of the wood, and a faint hiss."""

    def strength(pitches: Wave) -> Wave:
        octaves = np.log2(np.maximum(pitches, 1.0) / pitch)
        hump = np.exp(-0.5 * (octaves / 0.16) ** 2)
        wood = 0.22 * np.exp(-0.5 * ((octaves - math.log2(2.756)) / 0.3) ** 2)
        hiss = 0.02 * np.exp(-0.5 * (np.log2(np.maximum(pitches, 1.0) / (8.0 * pitch)) / 0.8) ** 2)
        return hump + wood + hiss

    return strength


def roll_wobble(speed: float) -> Wave:
    """How a ball's turning is heard in a loop: louder and softer, a whole number of times."""
    count = round(ROLL_SECONDS * RATE)
    turns = max(round(speed / _TURN * ROLL_SECONDS), 1)
    return 1.0 + 0.22 * np.sin(2.0 * np.pi * turns * np.arange(count) / count)


# --- which loops are heard ------------------------------------------------------------------------------

LANES = 3
"""Balls that are heard at once: two, and one that has just gone and fades."""

_STILL = 0.15  # [u/s] below it a ball is silent
_FULL = 20.0  # [u/s] at which a ball is at full strength
_LOUDER, _SOFTER = 0.08, 0.12  # [s] in which the strength of a loop follows by 63 %
_MOST_SHARE = 0.25  # of a change in one frame: the mixer sets strengths in steps, and large ones click
_SILENT = 0.008  # strength below which a loop that is no longer wanted ends


class RollingBall(NamedTuple):
    """A ball: its id, its centre (x, z) [u], its speed [u/s]."""

    id: int
    x: float
    z: float
    speed: float


Gains = dict[tuple[int, int], tuple[float, float]]
"""(lane, loop) → strength in the left and in the right ear; what is silent is left out."""


class Rolling:
    """Follows the balls, frame by frame."""

    def __init__(self) -> None:
        self._lanes = [_Lane() for _ in range(LANES)]

    def reset(self) -> None:
        """Forget all balls."""
        self._lanes = [_Lane() for _ in range(LANES)]

    def update(self, balls: Iterable[tuple[int, float, float, float]], seconds: float, width: float) -> Gains:
        """Which loops are heard after so many more seconds; balls as `RollingBall`, the table's width [u]."""
        there = {ball[0]: ball for ball in balls}
        followed = [(lane, there.pop(lane.ball, None)) for lane in self._lanes]
        for number, (lane, ball) in enumerate(followed):
            if ball is None and there and not lane.gains:
                lane.ball, found = there.popitem()
                followed[number] = (lane, found)
        for lane, ball in followed:
            lane.follow({} if ball is None else _wanted(ball[3], pan(ball[2], width)), seconds)
        return {
            (number, loop): gains
            for number, lane in enumerate(self._lanes)
            for loop, gains in lane.gains.items()
        }


class _Lane:
    """One ball's loops, and how strong they are by now."""

    def __init__(self) -> None:
        self.ball = 0
        self.gains: dict[int, tuple[float, float]] = {}

    def follow(self, wanted: dict[int, tuple[float, float]], seconds: float) -> None:
        louder, softer = (min(1.0 - math.exp(-seconds / time), _MOST_SHARE) for time in (_LOUDER, _SOFTER))
        gains = {}
        for loop in self.gains.keys() | wanted.keys():
            left, right = self.gains.get(loop, (0.0, 0.0))
            to_left, to_right = wanted.get(loop, (0.0, 0.0))
            left += (louder if to_left > left else softer) * (to_left - left)
            right += (louder if to_right > right else softer) * (to_right - right)
            if loop in wanted or max(left, right) > _SILENT:
                gains[loop] = (left, right)
        self.gains = gains


def _wanted(speed: float, ears: tuple[float, float]) -> dict[int, tuple[float, float]]:
    """The loops of a ball that has long had a speed [u/s]."""
    if speed <= _STILL:
        return {}
    strength = min(speed / _FULL, 1.0) ** 0.6
    place = min(max(math.log(speed) / _STEP, 0.0), len(ROLL_SPEEDS) - 1.0)
    loop = min(int(place), len(ROLL_SPEEDS) - 2)
    turn = 0.5 * math.pi * (place - loop)  # equal power: two different noises add up as squares
    return {
        number: (strength * weight * ears[0], strength * weight * ears[1])
        for number, weight in ((loop, math.cos(turn)), (loop + 1, math.sin(turn)))
        if strength * weight > _SILENT
    }
