"""Where are all sounds? In a bank: every wave of every recipe, made once, at its right loudness.

Waves are int16, shape [sample], mono; the place between left and right is given when one is played.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.loudness import loudness
from silverball.app.sound.recipes import RECIPES
from silverball.app.sound.rolling import (
    ROLL_LEVEL,
    ROLL_SECONDS,
    ROLL_SPEEDS,
    roll_pitch,
    roll_spectrum,
    roll_wobble,
)
from silverball.app.sound.synth import Wave, finished, looped, soft_limit

Samples: TypeAlias = NDArray[np.int16]

FULL = 32767.0
PEAK = 0.5
"""No wave is higher, so that two of the loudest fit together without any limiting."""


class Key(NamedTuple):
    """Which wave of the bank: the recipe's name, layer and variation."""

    name: str
    layer: int = 0
    variation: int = 0


class Bank(NamedTuple):
    """All sounds.

    Attributes:
        waves: By key.
        loops: Rolling, one for each speed of `ROLL_SPEEDS`; seamless.
    """

    waves: dict[Key, Samples]
    loops: tuple[Samples, ...]

    @property
    def size(self) -> int:
        """Memory of all waves [byte]."""
        return sum(wave.nbytes for wave in [*self.waves.values(), *self.loops])


@lru_cache(maxsize=1)
def make_bank() -> Bank:
    """Make all sounds; the same every time."""
    waves = {}
    for number, (name, recipe) in enumerate(RECIPES.items()):
        for layer in range(recipe.layers):
            for variation in range(recipe.variations):
                random = np.random.default_rng(
                    [number, variation]
                )  # layers differ in the blow, not in the thing
                wave = finished(recipe.make(layer, random))
                waves[Key(name, layer, variation)] = to_samples(levelled(wave, recipe.level))
    loops = (to_samples(levelled(roll_loop(number), ROLL_LEVEL)) for number in range(len(ROLL_SPEEDS)))
    return Bank(waves, tuple(loops))


def roll_loop(number: int) -> Wave:
    """The loop of rolling at a speed of `ROLL_SPEEDS`."""
    speed = ROLL_SPEEDS[number]
    loop = looped(roll_spectrum(roll_pitch(speed)), ROLL_SECONDS, number)
    return (loop * roll_wobble(speed)).astype(np.float32)


def levelled(wave: Wave, level: float) -> Wave:
    """A wave of a loudness [dB], or as loud as it can be below `PEAK`."""
    wave = wave * np.float32(10.0 ** ((level - loudness(wave)) / 20.0))
    return PEAK * soft_limit(wave / PEAK)


def to_samples(wave: Wave) -> Samples:
    """A wave in whole numbers."""
    samples: Samples = np.rint(wave * FULL).astype(np.int16)
    return samples
