"""How does a rolling ball sound? Loops of noise for some speeds, blended by how fast each ball is.

A ball has a lane of its own with all loops in it; its speed says which two are heard. Speeds, loudness and
places change gradually, so that nothing clicks when a ball bounces. A ball that slides sounds the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from silverball.app.sound.placing import pan
from silverball.app.sound.synth import RATE, Wave

_RATIO = 1.55
_STEP = math.log(_RATIO)
ROLL_SPEEDS = tuple(_RATIO**number for number in range(8))
"""Speeds of the ball [u/s] for which there is a loop, 1 to 21.5; between them two loops are blended."""

ROLL_SECONDS = 1.5
"""Length of a loop: long enough that one does not hear it come again."""

ROLL_LEVEL = -27.0
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
_LOUDER, _SOFTER = 0.045, 0.09  # [s] in which strength follows by 63 %
_SILENT = 0.004  # strength below which a lane is silent


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
        for lane in self._lanes:
            ball = there.pop(lane.ball, None)
            lane.follow(ball, seconds, width)
        for ball in there.values():
            free = min(self._lanes, key=lambda lane: (lane.is_taken, lane.strength))
            if not free.is_taken:
                free.begin(ball, width)
                free.follow(ball, seconds, width)
        return {
            (number, loop): gains for number, lane in enumerate(self._lanes) for loop, gains in lane.gains()
        }


class _Lane:
    def __init__(self) -> None:
        self.ball = 0
        self.is_taken = False
        self.strength = 0.0
        self._place = 0.0  # among the loops, 0 the slowest
        self._left = self._right = math.sqrt(0.5)

    def begin(self, ball: tuple[int, float, float, float], width: float) -> None:
        self.ball, self.strength = ball[0], 0.0
        self._place = _place(ball[3])
        self._left, self._right = pan(ball[2], width)

    def follow(self, ball: tuple[int, float, float, float] | None, seconds: float, width: float) -> None:
        self.is_taken = ball is not None
        wanted = 0.0
        if ball is not None:
            _, _, z, speed = ball
            wanted = min(speed / _FULL, 1.0) ** 0.6 if speed > _STILL else 0.0
            share = 1.0 - math.exp(-seconds / _LOUDER)
            self._place += share * (_place(speed) - self._place)
            left, right = pan(z, width)
            self._left += share * (left - self._left)
            self._right += share * (right - self._right)
        time = _LOUDER if wanted > self.strength else _SOFTER
        self.strength += (1.0 - math.exp(-seconds / time)) * (wanted - self.strength)
        if wanted == 0.0 and self.strength < _SILENT:
            self.strength = 0.0

    def gains(self) -> list[tuple[int, tuple[float, float]]]:
        if self.strength == 0.0:
            return []
        loop = min(int(self._place), len(ROLL_SPEEDS) - 2)
        turn = 0.5 * math.pi * (self._place - loop)  # equal power: two different noises add up as squares
        weights = ((loop, math.cos(turn)), (loop + 1, math.sin(turn)))
        return [
            (number, (self.strength * weight * self._left, self.strength * weight * self._right))
            for number, weight in weights
            if self.strength * weight > 0.5 * _SILENT
        ]


def _place(speed: float) -> float:
    """Where a speed lies among the loops: 2.5 is halfway, in ratio, between the third and the fourth."""
    return min(max(math.log(max(speed, 1e-3) / ROLL_SPEEDS[0]) / _STEP, 0.0), len(ROLL_SPEEDS) - 1.0)
