"""The sound of rolling balls: loops of noise for several speeds, blended by the speed of each ball.

Each ball has its own lane with all loops; two of them are heard, depending on its speed. Speeds, loudness and
places change gradually, so that nothing clicks when a ball bounces. A sliding ball sounds the same.
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
"""Speeds [u/s] that have a loop, 1 to 21.5; between them two loops are blended."""

ROLL_SECONDS = 1.5
"""Length of a loop [s], long enough to hide the repetition."""

ROLL_LEVEL = -28.0
"""Loudness of a loop at full strength [dB]: well below a hit."""

_TURN = 1.57  # [u] per turn of a ball of the usual radius of 0.25 u


def roll_pitch(speed: float) -> float:
    """Return the dominant pitch of rolling [Hz] at a speed [u/s]: 110 Hz · speed^0.45.

    Steel on wood does not rise like a siren: twice the speed raises it by less than half an octave.
    """
    return float(110.0 * speed**0.45)


def roll_spectrum(pitch: float) -> Callable[[Wave], Wave]:
    """Return the spectrum of a loop: a peak at the pitch, another one of the wood, and a faint hiss."""

    def strength(pitches: Wave) -> Wave:
        octaves = np.log2(np.maximum(pitches, 1.0) / pitch)
        hump = np.exp(-0.5 * (octaves / 0.16) ** 2)
        wood = 0.22 * np.exp(-0.5 * ((octaves - math.log2(2.756)) / 0.3) ** 2)
        hiss = 0.02 * np.exp(-0.5 * (np.log2(np.maximum(pitches, 1.0) / (10.0 * pitch)) / 0.95) ** 2)
        return hump + wood + hiss

    return strength


def roll_wobble(speed: float) -> Wave:
    """Return the modulation of a loop by the ball's turns, a whole number of periods."""
    count = round(ROLL_SECONDS * RATE)
    turns = max(round(speed / _TURN * ROLL_SECONDS), 1)
    return 1.0 + 0.22 * np.sin(2.0 * np.pi * turns * np.arange(count) / count)


# --- blending of the loops ------------------------------------------------------------------------------

LANES = 3
"""Balls heard at the same time: two, and one that has just left and fades."""

_STILL = 0.15  # [u/s] a ball at this speed or below is silent
_FULL = 20.0  # [u/s] a ball at this speed has full strength
_LOUDER, _SOFTER = 0.08, 0.12  # [s] time constants of the strength
_MAX_STEP = 0.25  # share of a change per frame: large steps of the mixer's strengths click
_SILENT = 0.008  # strength below which a fading loop ends


class RollingBall(NamedTuple):
    """A ball: its id, centre (x, z) [u] and speed [u/s]."""

    id: int
    x: float
    z: float
    speed: float


Gains = dict[tuple[int, int], tuple[float, float]]
"""(lane, loop) → strength in the left and right ear, without silent loops."""


class Rolling:
    """Computes the gains of the loops from the balls, frame by frame."""

    def __init__(self) -> None:
        self._lanes = [_Lane() for _ in range(LANES)]

    def reset(self) -> None:
        """Stop all loops."""
        self._lanes = [_Lane() for _ in range(LANES)]

    def update(self, balls: Iterable[tuple[int, float, float, float]], seconds: float, width: float) -> Gains:
        """Return the gains after more time [s]; balls as `RollingBall`, the width of the table in [u]."""
        unassigned = {ball[0]: ball for ball in balls}
        followed = [(lane, unassigned.pop(lane.ball, None)) for lane in self._lanes]
        for number, (lane, ball) in enumerate(followed):
            if ball is None and unassigned and not lane.gains:
                lane.ball, found = unassigned.popitem()
                followed[number] = (lane, found)
        for lane, ball in followed:
            lane.follow({} if ball is None else _steady_gains(ball[3], pan(ball[2], width)), seconds)
        return {
            (number, loop): gains
            for number, lane in enumerate(self._lanes)
            for loop, gains in lane.gains.items()
        }


class _Lane:
    """The loops of one ball, and their current strengths."""

    def __init__(self) -> None:
        self.ball = 0
        self.gains: dict[int, tuple[float, float]] = {}

    def follow(self, target: dict[int, tuple[float, float]], seconds: float) -> None:
        louder, softer = (min(1.0 - math.exp(-seconds / time), _MAX_STEP) for time in (_LOUDER, _SOFTER))
        gains = {}
        for loop in self.gains.keys() | target.keys():
            left, right = self.gains.get(loop, (0.0, 0.0))
            to_left, to_right = target.get(loop, (0.0, 0.0))
            left += (louder if to_left > left else softer) * (to_left - left)
            right += (louder if to_right > right else softer) * (to_right - right)
            if loop in target or max(left, right) > _SILENT:
                gains[loop] = (left, right)
        self.gains = gains


def _steady_gains(speed: float, ears: tuple[float, float]) -> dict[int, tuple[float, float]]:
    """Return the steady-state gains at a speed [u/s]."""
    if speed <= _STILL:
        return {}
    strength = min(speed / _FULL, 1.0) ** 0.6
    place = min(max(math.log(speed) / _STEP, 0.0), len(ROLL_SPEEDS) - 1.0)
    loop = min(int(place), len(ROLL_SPEEDS) - 2)
    turn = 0.5 * math.pi * (place - loop)  # equal power: different noises add up as squares
    return {
        number: (strength * weight * ears[0], strength * weight * ears[1])
        for number, weight in ((loop, math.cos(turn)), (loop + 1, math.sin(turn)))
        if strength * weight > _SILENT
    }
