"""The sounds of a page: those of a table's parts, at half the rate and with four bits a sample.

A page carries one wave for each layer of a sound. It has no variations, which it makes by playing a wave a
little faster or slower; nor the steps of the bell, which are one wave at several speeds. `page/sounds.js`
unpacks and plays them.

Four bits say by how many steps the wave rises or falls, ADPCM: steps grow while the wave moves fast. Source:
Interactive Multimedia Association, "Recommended practices for enhancing digital audio compatibility in
multimedia systems" (1992), section 6; the lengths of the steps are 7 · 1.1ⁿ.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from silverball.app.sound.bank import RECIPES, Key, Samples, make_bank, to_samples
from silverball.app.sound.calls import CALLS, call_of_cue, seconds_of
from silverball.app.sound.ducking import DOWN, DUCKED, ROLL_UNDER_MUSIC, TAIL, UP
from silverball.app.sound.levels import FULL_SPEED, LOUDNESS_POWER, SPREAD
from silverball.app.sound.moods import missions_of
from silverball.app.sound.music import drum
from silverball.app.sound.part_sounds import BALL, EVENTS, HitSound, PartSound, event_sound, sounds_of_parts
from silverball.app.sound.rolling import ROLL_SPEEDS
from silverball.app.sound.sound_sets import DEFAULT_SET, SoundSet
from silverball.app.sound.synth import BELL_STEPS, RATE, pitch_of
from silverball.app.sound.voices import GAME_CALLS, GAME_SOUNDS, HARD, default_paddles, paddles_of
from silverball.physics.records import LEFT, RIGHT, EventKind
from silverball.table import Table
from silverball.web.music_sheet import DRUMS, music_sheet
from silverball.web.pack import compress

SLOWER = 2  # times fewer samples than in the window
STEPS = tuple(math.floor(7 * 1.1**number) for number in range(89))
INDEX_CHANGES = (-1, -1, -1, -1, 2, 4, 6, 8)  # of the step, by the size of a change
BELL_LAYER = 3  # the step of the scale that is carried
ROLL_LOOP = 4  # the loop of rolling that is carried
LOUDEST = 32767
MECHANICAL = (EventKind.PASS, EventKind.SPIN, EventKind.CAPTURED, EventKind.RELEASED)
MESSAGE_SOUNDS = {kind.name: name for kind, name in GAME_SOUNDS.items()}
"""The sounds of what rules report, by its kind."""

CALL_SLOWER = 3  # times fewer samples of calls: a voice has its strength below 8 kHz

BUTTONS = {"left": LEFT, "right": RIGHT}


class PackedSounds(NamedTuple):
    """Sounds as a page plays them.

    Attributes:
        meta: What sounds when, and where its wave is, for JSON.
        waves: All waves, four bits a sample, compressed, as text.
    """

    meta: dict[str, Any]
    waves: str


def packed_sounds(table: Table, numbers: dict[str, int], sounds: SoundSet = DEFAULT_SET) -> PackedSounds:
    """The sounds of a table.

    Args:
        table: A finished table.
        numbers: The numbers of its parts by their names in events.
        sounds: The timbres of its music and its calls.
    """
    parts = sounds_of_parts(table)
    mechanisms = {numbers[name]: _mechanisms(part) for name, part in parts.items()}
    general: dict[int, tuple[str, float]] = {
        int(EventKind[kind.upper()]): (sound.name, sound.strength)
        for kind, sound in EVENTS.items()
        if sound is not None
    }
    names = {
        "coil",
        "stop",
        BALL.name,
        *(part.blow.name for part in parts.values()),
        *MESSAGE_SOUNDS.values(),
    }
    names |= {name for name, _ in general.values()}
    names |= {name for found in mechanisms.values() for name, _ in found.values()}
    packed = bytearray()
    places = {name: [_put(packed, wave) for wave in _layers(name, sounds)] for name in sorted(names)}
    places["roll"] = [_put(packed, _halved(ROLL_LOOP))]
    calls = calls_of(table)
    spoken = sorted({*calls["cues"].values(), *calls["modes"].values(), *calls["kinds"].values()})
    places |= {name: [_put(packed, _call(name, sounds))] for name in spoken}
    places |= {f"{name} drum": [_put(packed, _drum(name))] for name in DRUMS}
    paddles = paddles_of(table) or default_paddles()
    meta = {
        "rate": RATE // SLOWER, "callRate": RATE // CALL_SLOWER, "steps": STEPS,
        "changes": INDEX_CHANGES, "waves": places,
        "blows": {numbers[name]: _blow(part.blow) for name, part in parts.items()}, "ball": _blow(BALL),
        "mechanisms": mechanisms, "events": general, "messages": MESSAGE_SOUNDS,
        "bells": [pitch_of(step) / pitch_of(BELL_LAYER) for step in range(BELL_STEPS)],
        "paddles": [[BUTTONS[paddle.button], *paddle.strokes] for paddle in paddles],
        "hard": HARD, "fullSpeed": FULL_SPEED, "power": LOUDNESS_POWER, "spread": SPREAD,
        "rollSpeed": ROLL_SPEEDS[ROLL_LOOP], "width": table.board.width,
        "calls": calls | {name: [CALLS[name].rank, seconds_of(name)] for name in spoken},
        "music": music_sheet(table, sounds),
        "ducking": {
            "ducked": DUCKED, "rollUnderMusic": ROLL_UNDER_MUSIC, "down": DOWN, "up": UP, "tail": TAIL,
        },
    }  # fmt: skip
    return PackedSounds(meta, compress(bytes(packed)))


def calls_of(table: Table) -> dict[str, dict[str, str]]:
    """The calls of a table's cues, of its missions as they start, and of what rules report."""
    cues = {rule.cue: call for rule in table.rule if (call := call_of_cue(rule.cue or ""))}
    told = {
        "EXTRA_BALL": any(rule.extra_ball for rule in table.rule),
        "MULTIBALL": any(rule.multiball > 1 for rule in table.rule),
        "BALL_LOCKED": any(rule.lock for rule in table.rule),
    }
    kinds = {kind.name: call for kind, call in GAME_CALLS.items() if told[kind.name]}
    return {"cues": cues, "modes": dict.fromkeys(missions_of(table), "mission_start"), "kinds": kinds}


def _mechanisms(part: PartSound) -> dict[int, tuple[str, float]]:
    """The sounds of a part's events that are no blows, by their kinds."""
    found: dict[int, tuple[str, float]] = {}
    for kind in MECHANICAL:
        sound = event_sound(kind.name.lower(), part.finish)
        if sound is not None:
            found[int(kind)] = (sound.name, sound.strength)
    return found


def _blow(sound: HitSound) -> list[Any]:
    return [sound.name, sound.least, sound.climbs]


def _layers(name: str, sounds: SoundSet) -> list[bytes]:
    layers = range(RECIPES[name].layers)
    chosen = [BELL_LAYER] if len(layers) == BELL_STEPS else layers
    return [_encoded(name, layer, sounds if RECIPES[name].is_of_set else DEFAULT_SET) for layer in chosen]


@lru_cache(maxsize=256)
def _encoded(name: str, layer: int, sounds: SoundSet) -> bytes:
    return encode(_slower(make_bank(sounds).waves[Key(name, layer)]))


@lru_cache(maxsize=64)
def _call(name: str, sounds: SoundSet) -> bytes:
    return encode(_slower(make_bank(sounds).waves[Key(name)], CALL_SLOWER))


@lru_cache(maxsize=8)
def _drum(name: str) -> bytes:
    return encode(_slower(to_samples(drum(name))))


@lru_cache(maxsize=1)
def _halved(loop: int) -> bytes:
    return encode(_slower(make_bank().loops[loop]))


def _slower(wave: Samples, slower: int = SLOWER) -> list[int]:
    """A wave with so many times fewer samples, without the pitches that it cannot have then."""
    spectrum = np.fft.rfft(wave.astype(np.float64))
    count = len(wave) // slower
    fewer = np.fft.irfft(spectrum[: count // 2 + 1], count) / slower
    numbers: list[int] = np.clip(np.rint(fewer), -LOUDEST, LOUDEST).astype(int).tolist()
    return numbers


def encode(wave: list[int]) -> bytes:
    """A wave of 16-bit samples with four bits a sample; the low half of a byte comes first."""
    codes, value, index = [], 0, 0
    for sample in wave:
        step, change = STEPS[index], sample - value
        size = min(abs(change) * 4 // step, 7)
        moved = (2 * size + 1) * step >> 3
        value = max(-LOUDEST, min(LOUDEST, value - moved if change < 0 else value + moved))
        index = max(0, min(len(STEPS) - 1, index + INDEX_CHANGES[size]))
        codes.append(size | (8 if change < 0 else 0))
    codes += [0] * (len(codes) % 2)
    return bytes(low | high << 4 for low, high in zip(codes[::2], codes[1::2], strict=True))


def decode(packed: bytes) -> list[int]:
    """The wave that a page makes of what `encode` gave."""
    wave, value, index = [], 0, 0
    for byte in packed:
        for code in (byte & 15, byte >> 4):
            size = code & 7
            moved = (2 * size + 1) * STEPS[index] >> 3
            value = max(-LOUDEST, min(LOUDEST, value - moved if code & 8 else value + moved))
            index = max(0, min(len(STEPS) - 1, index + INDEX_CHANGES[size]))
            wave.append(value)
    return wave


def _put(packed: bytearray, wave: bytes) -> list[int]:
    """Append a wave; return its first byte and the number of its bytes."""
    packed += wave
    return [len(packed) - len(wave), len(wave)]
