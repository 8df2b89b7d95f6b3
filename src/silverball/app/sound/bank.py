"""The sound bank: all recipes, and the waves made from them at their target loudness.

A sound has layers (how hard the blow was, or which step of the scale) and in each layer some variations, so
that no two blows in a row play the same wave. Waves are int16, shape `[sample]`, mono; they are panned
when they are played.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound import calls, hits, mechanics, tunes
from silverball.app.sound.calls import CALLS, call_recipe
from silverball.app.sound.levels import loudness
from silverball.app.sound.rolling import (
    ROLL_LEVEL,
    ROLL_SECONDS,
    ROLL_SPEEDS,
    roll_pitch,
    roll_spectrum,
    roll_wobble,
)
from silverball.app.sound.sound_sets import DEFAULT_SET, SoundSet
from silverball.app.sound.synth import BELL_STEPS, Wave, finished, looped, soft_limit


class Recipe(NamedTuple):
    """How to make a sound.

    Attributes:
        make: Makes the wave of a layer with the random generator of a variation.
        level: Loudness of its loudest moment at full strength [dB], see `loudness`.
        layers: Number of layers.
        variations: Number of variations of each layer.
        is_of_set: Whether it differs between sound sets; `make` then takes the set as a third argument.
    """

    make: Callable[..., Wave]
    level: float
    layers: int = 1
    variations: int = 1
    is_of_set: bool = False


RECIPES: dict[str, Recipe] = {
    "wall": Recipe(hits.wall, -20.0, 2, 3),
    "slant_wall": Recipe(hits.slant_wall, -20.0, 2, 3),
    "prism": Recipe(hits.prism, -18.0, 2, 3),
    "cylinder": Recipe(hits.cylinder, -17.0, BELL_STEPS, 2, is_of_set=True),
    "coil": Recipe(hits.coil, -23.0, 1, 3),
    "stop": Recipe(hits.stop, -22.0, 2, 3),
    "paddle_hit": Recipe(hits.paddle_hit, -20.0, 2, 3),
    "balls": Recipe(hits.balls, -21.0, 2, 3),
    "created": Recipe(hits.created, -19.0, 1, 2),
    "shove": Recipe(hits.shove, -20.0, 1, 2),
    "drain": Recipe(hits.drain, -18.0, 1, 2),
    "ball_saved": Recipe(tunes.ball_saved, -18.0),
    "warning": Recipe(tunes.warning, -18.0),
    "tilt": Recipe(calls.tilt, -16.0, is_of_set=True),
    "unstuck": Recipe(tunes.unstuck, -20.0),
    "double_on": Recipe(tunes.double_on, -18.0),
    "game_over": Recipe(tunes.game_over, -18.0),
    "high_score": Recipe(tunes.high_score, -16.0),
    "menu_move": Recipe(tunes.menu_move, -25.0, 1, 2),
    "menu_choose": Recipe(tunes.menu_choose, -22.0),
    "menu_back": Recipe(tunes.menu_back, -23.0),
    "menu_refuse": Recipe(tunes.menu_refuse, -22.0),
    "attract": Recipe(tunes.attract, -22.0),
    "metal": Recipe(mechanics.metal, -21.0, 2, 3),
    "plastic": Recipe(mechanics.plastic, -21.0, 2, 3),
    "rubber": Recipe(mechanics.rubber, -21.0, 2, 3),
    "kick": Recipe(mechanics.kick, -18.0, 1, 3),
    "target": Recipe(mechanics.target, -18.0, 2, 2),
    "drop": Recipe(mechanics.drop, -18.0, 2, 2),
    "bank_reset": Recipe(mechanics.bank_reset, -19.0, 1, 2),
    "rollover": Recipe(mechanics.rollover, -21.0, 1, 2),
    "spinner": Recipe(mechanics.spinner, -23.0, 1, 4),
    "gate": Recipe(mechanics.gate, -24.0, 1, 2),
    "capture": Recipe(mechanics.capture, -19.0, 1, 2),
    "release": Recipe(mechanics.release, -19.0, 1, 2),
    "plunger_pull": Recipe(mechanics.plunger_pull, -25.0, 1, 2),
    "launch": Recipe(mechanics.launch, -19.0, 1, 2),
    "ramp": Recipe(mechanics.ramp, -23.0, 1, 2),
    **{name: Recipe(call_recipe(name), call.level, is_of_set=True) for name, call in CALLS.items()},
}
"""All sounds except the rolling of a ball, which is in `rolling.py`. The place of a recipe seeds its random
generator: new ones belong at the end."""

_NUMBERS = {name: number for number, name in enumerate(RECIPES)}


Samples: TypeAlias = NDArray[np.int16]

FULL = 32767.0  # the greatest int16 sample
PEAK = 0.5
"""Peak of every wave, so that two of the loudest can be added without limiting."""


class Key(NamedTuple):
    """Identifies a wave of the bank: the name of the recipe, layer and variation."""

    name: str
    layer: int = 0
    variation: int = 0


class Bank(NamedTuple):
    """All sounds.

    Attributes:
        waves: All waves, by key.
        loops: Seamless loops of rolling, one per speed of `ROLL_SPEEDS`.
    """

    waves: dict[Key, Samples]
    loops: tuple[Samples, ...]

    @property
    def size(self) -> int:
        """Memory of all waves [byte]."""
        return sum(wave.nbytes for wave in [*self.waves.values(), *self.loops])


@lru_cache(maxsize=1)
def make_bank(sounds: SoundSet = DEFAULT_SET) -> Bank:
    """Make all sounds of a set, deterministically; what is the same in all sets is made once."""
    common = common_sounds()
    waves = {
        key: wave for name in RECIPES for key, wave in (common.waves.get(name) or _made(name, sounds)).items()
    }
    return Bank(waves, common.loops)


class CommonSounds(NamedTuple):
    """What is the same in all sound sets.

    Attributes:
        waves: By the name of the recipe, then by key.
        loops: As in `Bank`.
    """

    waves: dict[str, dict[Key, Samples]]
    loops: tuple[Samples, ...]


@lru_cache(maxsize=1)
def common_sounds() -> CommonSounds:
    """Make the sounds that are the same in all sound sets."""
    waves = {name: _made(name) for name, recipe in RECIPES.items() if not recipe.is_of_set}
    loops = (to_samples(levelled(roll_loop(number), ROLL_LEVEL)) for number in range(len(ROLL_SPEEDS)))
    return CommonSounds(waves, tuple(loops))


def _made(name: str, *sounds: SoundSet) -> dict[Key, Samples]:
    """Make all waves of a recipe."""
    recipe, waves = RECIPES[name], {}
    for layer in range(recipe.layers):
        for variation in range(recipe.variations):
            random = np.random.default_rng([_NUMBERS[name], variation])  # the same for all layers
            wave = finished(recipe.make(layer, random, *sounds))
            waves[Key(name, layer, variation)] = to_samples(levelled(wave, recipe.level))
    return waves


def roll_loop(number: int) -> Wave:
    """Make the loop of rolling for one of `ROLL_SPEEDS`."""
    speed = ROLL_SPEEDS[number]
    loop = looped(roll_spectrum(roll_pitch(speed)), ROLL_SECONDS, number)
    return (loop * roll_wobble(speed)).astype(np.float32)


def levelled(wave: Wave, level: float) -> Wave:
    """Scale a wave to a loudness [dB], limited to `PEAK`."""
    wave = wave * np.float32(10.0 ** ((level - loudness(wave)) / 20.0))
    return PEAK * soft_limit(wave / PEAK)


def to_samples(wave: Wave) -> Samples:
    """Convert a wave to int16."""
    samples: Samples = np.rint(wave * FULL).astype(np.int16)
    return samples
