"""The calls: short phrases, sung or blown, for what is worth a shout: a jackpot, a mission won, a multiball.

A call is a list of syllables. Each is a chord in the five notes of the scale and a pair of vowels between
which the mouth moves. A choir sings them, brass blows them, or glass rings them: that is the caller of the
sound set.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from silverball.app.sound import tunes
from silverball.app.sound.sound_sets import DEFAULT_SET, GLASS, Caller, SoundSet
from silverball.app.sound.synth import (
    RATE,
    SCALE,
    Wave,
    as_float32,
    edge,
    mix,
    pitch_of,
    ring,
    sample_count,
    struck,
)

# The first three formants [Hz] of vowels of men. Source: G. Peterson, H. Barney, "Control methods used in a
# study of the vowels", J. Acoust. Soc. Am. 24 (1952), table II.
FORMANTS = {
    "a": (730.0, 1090.0, 2440.0),
    "e": (530.0, 1840.0, 2480.0),
    "i": (270.0, 2290.0, 3010.0),
    "o": (570.0, 840.0, 2410.0),
    "u": (300.0, 870.0, 2240.0),
}
FORMANT_WIDTHS = (110.0, 140.0, 220.0)  # [Hz]; somewhat wider than in speech, so that no harmonic sticks out
FORMANT_STRENGTHS = (1.0, 0.7, 0.45)
SINGERS_FORMANT, SINGERS_WIDTH, SINGERS_STRENGTH = 3300.0, 500.0, 0.35  # [Hz]; what carries a voice; chosen
BRIGHTEST = 9_000.0  # [Hz] highest harmonic
VIBRATO_RATE, VIBRATO_DEPTH, VIBRATO_AFTER = 5.6, 0.006, 0.18  # [Hz], share of the pitch, [s]
SCOOP, SCOOP_TIME = 0.03, 0.035  # share of the pitch by which a note begins too low, and for how long [s]


class Syllable(NamedTuple):
    """A note or chord of a call.

    Attributes:
        start: [s].
        seconds: How long it is held.
        steps: Steps of the scale, sung together.
        vowels: The vowel at its start and at its end.
        strength: 0 to 1.
    """

    start: float
    seconds: float
    steps: tuple[int, ...]
    vowels: str = "aa"
    strength: float = 1.0


class Call(NamedTuple):
    """A call.

    Attributes:
        words: What it is for.
        rank: While a call sounds, none of a lower rank begins.
        level: Loudness of its loudest moment [dB].
        syllables: What is sung.
    """

    words: str
    rank: int
    level: float
    syllables: tuple[Syllable, ...]


def _line(*syllables: tuple[float, float, tuple[int, ...], str]) -> tuple[Syllable, ...]:
    return tuple(Syllable(*one) for one in syllables)


CALLS = {
    "super_jackpot": Call("a super jackpot", 9, -15.0, _line(
        (0.0, 0.11, (3,), "uu"), (0.12, 0.11, (5,), "ee"), (0.24, 0.11, (7,), "aa"),
        (0.36, 1.1, (5, 8, 10), "oa"),
    )),
    "wizard": Call("the wizard mode", 9, -15.0, _line(
        (0.0, 0.5, (-5, 0, 3), "uo"), (0.5, 0.25, (0, 4, 7), "oa"), (0.75, 1.1, (0, 5, 8, 10), "aa"),
    )),
    "jackpot": Call("a jackpot", 8, -15.0, _line((0.0, 0.16, (3, 5), "aa"), (0.17, 0.75, (5, 7, 8), "oa"))),
    "multiball": Call("a multiball begins", 8, -15.0, _line(
        (0.0, 0.15, (5,), "uu"), (0.16, 0.15, (7,), "ii"), (0.32, 0.8, (3, 5, 8), "oo"),
    )),
    "extra_ball": Call("an extra ball", 7, -16.0, _line(
        (0.0, 0.15, (7,), "ee"), (0.16, 0.15, (8,), "aa"), (0.32, 0.7, (5, 8, 10), "oo"),
    )),
    "mission_won": Call("a mission is won", 6, -16.0, _line(
        (0.0, 0.1, (0,), "aa"), (0.11, 0.1, (2,), "aa"), (0.22, 0.1, (3,), "aa"),
        (0.33, 0.9, (5, 7, 8), "ae"),
    )),
    "mission_start": Call("a mission begins", 5, -17.0, _line(
        (0.0, 0.16, (0, 3), "uo"), (0.18, 0.5, (2, 5), "oa"),
    )),
    "skill_shot": Call("a skill shot", 5, -17.0, _line((0.0, 0.12, (5,), "ii"), (0.13, 0.45, (8, 10), "oo"))),
    "mission_lost": Call("a mission is lost", 4, -18.0, _line(
        (0.0, 0.22, (4,), "oo"), (0.23, 0.22, (2,), "oo"), (0.46, 0.6, (-1,), "ou"),
    )),
    "lock": Call("a ball is locked", 4, -18.0, _line((0.0, 0.42, (-5, 0), "ou"))),
    "kickback": Call("a kickback", 3, -19.0, _line((0.0, 0.22, (3, 5), "ei"))),
    "lit": Call("something is lit", 2, -20.0, _line(
        (0.0, 0.09, (3,), "ii"), (0.09, 0.09, (5,), "ii"), (0.18, 0.3, (7,), "ia"),
    )),
    "shot": Call("a lit shot is made", 2, -19.0, _line((0.0, 0.08, (5,), "aa"), (0.09, 0.25, (3, 7), "aa"))),
    "bonus": Call("the bonus is counted", 2, -19.0, _line(
        (0.0, 0.14, (3, 7), "aa"), (0.16, 0.3, (5, 8), "aa"),
    )),
    "combo": Call("a combo", 1, -20.0, _line((0.0, 0.1, (5,), "ii"), (0.1, 0.22, (7,), "ii"))),
}  # fmt: skip
"""All calls."""

CUES = (
    ("lit shot", "shot"),
    ("lit", "lit"),
    ("lost", "mission_lost"),
    ("over", "mission_lost"),
    ("super jackpot", "super_jackpot"),
    ("jackpot", "jackpot"),
    ("multiball", "multiball"),
    ("wizard", "wizard"),
    ("extra ball", "extra_ball"),
    ("won", "mission_won"),
    ("mission", "mission_start"),
    ("skill shot", "skill_shot"),
    ("lock", "lock"),
    ("kickback", "kickback"),
    ("last chance", "kickback"),
    ("bonus", "bonus"),
    ("combo", "combo"),
    ("lanes", "lit"),
)
"""The calls of cues. A cue of a table's rules plays the first call here whose words are all in it: "super
jackpot lit" is `lit`, "jackpot on the left" is `jackpot`. Other cues are silent; they may be light shows."""

OCTAVES_DOWN = {Caller.CHOIR: 1, Caller.BRASS: 0, Caller.GLASS: 0}
"""Voices sing an octave lower than brass: on higher notes a vowel has too few harmonics to be recognised."""

TILT_FALL = _line((0.0, 0.35, (-1,), "oo"), (0.36, 0.9, (-4,), "ou"))


def call_recipe(name: str) -> Callable[[int, np.random.Generator, SoundSet], Wave]:
    """Return the recipe of a call of `CALLS`."""

    def recipe(layer: int, random: np.random.Generator, sounds: SoundSet = DEFAULT_SET) -> Wave:
        return performed(CALLS[name].syllables, sounds.caller, random)

    recipe.__doc__ = f"A call: {CALLS[name].words}."
    return recipe


def call_of_cue(cue: str) -> str:
    """Return the call that a cue plays; empty if there is none."""
    words = set(re.split(r"[^a-z]+", cue.lower()))
    return next((call for named, call in CUES if set(named.split()) <= words), "")


def seconds_of(name: str) -> float:
    """Return how long a call is sung [s], without its echo."""
    return max(one.start + one.seconds for one in CALLS[name].syllables)


def tilt(layer: int, random: np.random.Generator, sounds: SoundSet = DEFAULT_SET) -> Wave:
    """A hum that sinks by three octaves and dies, as if the power failed, and a voice that sinks with it."""
    hum = tunes.tilt(layer, random)
    fall = performed(TILT_FALL, sounds.caller, random)
    return mix(len(hum) / RATE, (0.0, 1.0, hum), (0.05, 0.25, fall))


def performed(syllables: tuple[Syllable, ...], caller: Caller, random: np.random.Generator) -> Wave:
    """Return syllables as a caller performs them."""
    voice = {Caller.CHOIR: _sung, Caller.BRASS: _blown, Caller.GLASS: _rung}[caller]
    layers = []
    for one in syllables:
        for step in one.steps:
            sung = voice(one, step - OCTAVES_DOWN[caller] * len(SCALE), random)
            layers.append((one.start, one.strength / len(one.steps) ** 0.5, sung))
        if caller is not Caller.GLASS:
            layers.append((one.start, 0.5 * one.strength, edge(0.03, random)))  # its consonant
    return mix(max(start + len(wave) / RATE for start, _, wave in layers), *layers)


def _sung(one: Syllable, step: int, random: np.random.Generator) -> Wave:
    """A voice: the harmonics of the vocal cords, through the formants of its vowels."""
    pitch = pitch_of(step)
    seconds = one.seconds + 0.12
    turns = _turns(pitch * random.uniform(0.996, 1.004), seconds, random.uniform(0.0, 1.0))
    tones = pitch * np.arange(1, _highest(pitch) + 1)
    first, last = (_mouth(tones, vowel) for vowel in one.vowels)
    moved = np.linspace(0.0, 1.0, len(turns), dtype=np.float32)

    def strength(number: int) -> Wave:
        return as_float32(first[number] + (last[number] - first[number]) * moved)

    return _harmonics(turns, len(tones), strength) * _breath(seconds, 0.025, 0.12)


def _blown(one: Syllable, step: int, random: np.random.Generator) -> Wave:
    """A brass instrument: the higher a harmonic, the later it comes and the sooner it goes."""
    pitch = pitch_of(step)
    seconds = one.seconds + 0.1
    turns = _turns(pitch * random.uniform(0.998, 1.002), seconds, random.uniform(0.0, 1.0))
    time = np.arange(len(turns), dtype=np.float32) / RATE

    def strength(number: int) -> Wave:
        rise = np.minimum(time / (0.01 + 0.005 * number), 1.0)
        fall = np.exp(-time * (0.25 * number))
        return as_float32((number + 1.0) ** -0.75 * rise * (0.35 + 0.65 * fall))

    return _harmonics(turns, _highest(pitch), strength) * _breath(seconds, 0.012, 0.1)


def _rung(one: Syllable, step: int, random: np.random.Generator) -> Wave:
    """Glasses that are struck, over a soft voice."""
    ringing = ring(
        struck(pitch_of(step), GLASS, 1.6, brightness=0.6, damping=0.4, detune=0.001, random=random),
        one.seconds + 0.6,
    )
    return mix(len(ringing) / RATE, (0.0, 1.0, ringing), (0.0, 0.5, 0.3 * _sung(one, step, random)))


def _turns(pitch: float, seconds: float, start: float) -> Wave:
    """The phase of a tone in turns: it begins a little low and gets a vibrato."""
    time = np.arange(sample_count(seconds)) / RATE
    vibrato = VIBRATO_DEPTH * np.clip((time - VIBRATO_AFTER) / 0.2, 0.0, 1.0)
    bend = 1.0 - SCOOP * np.exp(-time / SCOOP_TIME) + vibrato * np.sin(2.0 * np.pi * VIBRATO_RATE * time)
    turns: Wave = start + np.cumsum(pitch * bend) / RATE
    return turns


def _harmonics(turns: Wave, count: int, strength: Callable[[int], Wave]) -> Wave:
    """Return Σ strength(k) · sin(2π·(k+1)·turns), k from 0.

    Each sine comes from the two before it: sin (n+1)φ = 2·cos φ·sin nφ − sin (n−1)φ.
    """
    angle = 2.0 * np.pi * (turns % 1.0)
    before, sine, twice = np.zeros_like(angle), np.sin(angle), 2.0 * np.cos(angle)
    wave = np.zeros(len(turns), np.float32)
    for number in range(count):
        wave += strength(number) * sine
        before, sine = sine, twice * sine - before
    return as_float32(wave)


def _highest(pitch: float) -> int:
    """How many harmonics a tone has."""
    return max(int(BRIGHTEST / pitch), 1)


def _mouth(tones: Wave, vowel: str) -> Wave:
    """How much of each pitch a mouth lets pass; the vocal cords have the more the lower it is."""
    passed = SINGERS_STRENGTH / (1.0 + ((tones - SINGERS_FORMANT) / SINGERS_WIDTH) ** 2)
    for middle, width, strength in zip(FORMANTS[vowel], FORMANT_WIDTHS, FORMANT_STRENGTHS, strict=True):
        passed += strength / (1.0 + ((tones - middle) / width) ** 2)
    return as_float32((passed + 0.03) * (tones[0] / tones) ** 0.5)


def _breath(seconds: float, rise: float, fall: float) -> Wave:
    time = np.arange(sample_count(seconds)) / RATE
    shape = np.minimum(np.minimum(time / rise, 1.0), np.maximum(seconds - time, 0.0) / fall)
    return as_float32(np.sin(0.5 * np.pi * np.clip(shape, 0.0, 1.0)) ** 2)
