"""The sound sets: what each theme of colours sounds like. One row for every theme.

A set gives the timbres of the music, its tempo, the material of the bumpers' bells, and the voice of the
calls; what is struck on the table sounds alike in all, because wood, steel and coils stay the same.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from silverball.app.sound import instruments
from silverball.app.sound.instruments import Timbre
from silverball.app.sound.synth import BELL, TUNED_BAR


class Caller(Enum):
    """Who sings the calls."""

    CHOIR = "choir"
    BRASS = "brass"
    GLASS = "glass"


class SoundSet(NamedTuple):
    """How a theme sounds.

    Attributes:
        name: The name of the theme.
        pad, bass, pluck, lead: Timbres of the music.
        tempo: Slowest and fastest tempo [beats per minute].
        swing: How late every second eighth is, 0 to 0.33.
        bell: Ratios of the partials of bumpers and tunes.
        bell_damping: How much faster their high partials die.
        caller: Who sings the calls.
    """

    name: str
    pad: Timbre
    bass: Timbre
    pluck: Timbre
    lead: Timbre
    tempo: tuple[float, float]
    swing: float
    bell: tuple[float, ...]
    bell_damping: float
    caller: Caller


GLASS = (1.0, 2.32, 4.25, 6.63)
"""Partials of a wine glass. Source: N. Fletcher, T. Rossing, "The Physics of Musical Instruments", 2nd ed.
(1998), ch. 20: they go by about the square of 2, 3, 4, 5."""

SOUND_SETS = {
    "neon": SoundSet(
        "neon", instruments.SAW_PAD, instruments.SAW_BASS, instruments.SAW_PLUCK, instruments.SQUARE_LEAD,
        (116.0, 128.0), 0.0, BELL, 0.7, Caller.CHOIR,
    ),
    "parlour": SoundSet(
        "parlour", instruments.ORGAN, instruments.ROUND_BASS, instruments.MUSIC_BOX, instruments.REED_LEAD,
        (104.0, 116.0), 0.33, TUNED_BAR, 0.6, Caller.BRASS,
    ),
    "clear": SoundSet(
        "clear", instruments.BREATH, instruments.ROUND_BASS, instruments.MARIMBA, instruments.GLASS_LEAD,
        (96.0, 110.0), 0.1, GLASS, 0.5, Caller.GLASS,
    ),
}  # fmt: skip
"""The sets by the names of their themes."""

DEFAULT_SET = SOUND_SETS["neon"]


def sound_set(theme: str) -> SoundSet:
    """Return the sound set of a theme; a theme of your own sounds like the first."""
    return SOUND_SETS.get(theme, DEFAULT_SET)
