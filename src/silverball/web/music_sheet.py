"""The music of a page: its notes, what its instruments are made of, and how it follows a game.

A page carries no wave of the music but the drums. It makes every note itself, as `app/sound/instruments.py`
does: a sum of tones that die away. So the music of a table is some kilobytes.
"""

from __future__ import annotations

from typing import Any

from silverball.app.sound import instruments
from silverball.app.sound.composition import BEATS, LAYERS, Tone
from silverball.app.sound.instruments import NOTE_LEVEL, Timbre
from silverball.app.sound.levels import loudness
from silverball.app.sound.moods import (
    DRAIN_PAUSE,
    LONG_COMBO,
    MISSION,
    PLAYING,
    WAITING,
    missions_of,
)
from silverball.app.sound.music import LIFT, PART_LEVELS, band_of
from silverball.app.sound.sound_sets import SoundSet
from silverball.app.sound.synth import pitch_of
from silverball.table import Table

DRUMS = ("kick", "snare", "hat", "open_hat")


def music_sheet(table: Table, sounds: SoundSet) -> dict[str, Any]:
    """What `page/music.js` plays on a table.

    Args:
        table: A finished table.
        sounds: The timbres.
    """
    band = band_of(table, sounds)
    beat = 60.0 / band.composition.tempo
    timbres = {
        "pad": sounds.pad, "bass": sounds.bass, "arpeggio": sounds.pluck, "run": sounds.pluck,
        "lead": sounds.lead,
    }  # fmt: skip
    layers = [
        [[_written(tone, timbres.get(tone.instrument), beat, band.gain) for tone in bar] for bar in bars]
        for bars in band.composition.layers
    ]
    return {
        "beat": beat, "beats": BEATS, "layers": layers, "lift": LIFT, "drums": list(DRUMS),
        "timbres": {name: timbre._asdict() for name, timbre in timbres.items()},
        "brightest": instruments.BRIGHTEST,
        "moods": {
            "waiting": WAITING, "playing": PLAYING, "mission": MISSION, "most": len(LAYERS),
            "longCombo": LONG_COMBO, "pause": DRAIN_PAUSE, "missions": _missions(table),
        },
    }  # fmt: skip


def _written(tone: Tone, timbre: Timbre | None, beat: float, gain: float) -> list[Any]:
    """A note: start [s], instrument, pitch [Hz], how long it is held [s], strength, and side."""
    level = gain * tone.strength * 10.0 ** ((PART_LEVELS[tone.instrument] - NOTE_LEVEL) / 20.0)
    pitch, seconds = 0.0, round(tone.beats * beat, 4)
    if timbre is not None:
        pitch = pitch_of(tone.step)
        level *= _strength(timbre, tone.step, seconds)
    return [
        round(tone.start * beat, 5), tone.instrument, round(pitch, 3), seconds, float(f"{level:.4g}"),
        tone.side,
    ]  # fmt: skip


def _strength(timbre: Timbre, step: int, seconds: float) -> float:
    """By what the sum of the tones of a note is multiplied to be as loud as all notes."""
    return float(
        10.0 ** ((NOTE_LEVEL - loudness(instruments.sounded(timbre, pitch_of(step), seconds))) / 20.0)
    )


def _missions(table: Table) -> dict[str, Any]:
    """The missions of a table: their seconds, and what is counted until one is won."""
    counters = [counter.name for counter in table.counter]
    lamps = [lamp.name for lamp in table.lamp]
    return {
        name: {
            "seconds": mission.seconds,
            "goals": [
                {
                    "counter": counters.index(goal.counter) if goal.counter else -1, "value": goal.value,
                    "lamps": [lamps.index(lamp) for lamp in goal.lamps],
                }
                for goal in mission.goals
            ],
        }
        for name, mission in missions_of(table).items()
    }  # fmt: skip
