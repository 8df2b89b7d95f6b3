"""The notes of the music: a loop of bars in layers, composed from a seed in the five notes of the scale.

A table's digest is the seed, so every table has a melody of its own and always the same. Chords and melodies
use the notes of the bumpers only (`synth.SCALE`): whatever rings on the table fits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from silverball.app.sound.synth import SCALE

BARS = 8
"""Bars of the loop."""

BEATS = 4
"""Beats of a bar."""

LAYERS = ("pad", "bass", "arpeggio", "beat", "lead", "drive")
"""In the order in which they join: music of level 3 is pad, bass and arpeggio."""

# Chords by the degree of their root: steps of the scale, 0 is the root G. Only notes of the scale, so those
# on A and D have a fourth for a third.
CHORDS = ((0, 2, 3), (1, 3, 4), (2, 3, 5), (3, 5, 6), (4, 5, 7))
PROGRESSIONS = ((0, 4, 1, 3), (4, 3, 0, 1), (0, 2, 4, 3), (0, 0, 4, 3), (4, 0, 1, 3), (0, 1, 4, 1))
BASS_RHYTHMS = (
    (0.0, 1.5, 2.0, 3.5),
    (0.0, 0.75, 1.5, 2.5, 3.0),
    (0.0, 1.0, 2.0, 2.5, 3.0),
    (0.0, 2.0, 2.75, 3.5),
)
Rhythm = tuple[tuple[float, float], ...]
"""Starts and lengths of the notes of a bar [beats]."""

LEAD_RHYTHMS: tuple[Rhythm, ...] = (
    ((0.0, 1.0), (1.0, 0.5), (1.5, 0.5), (2.0, 2.0)),
    ((0.0, 0.75), (0.75, 0.75), (1.5, 0.5), (2.0, 1.5), (3.5, 0.5)),
    ((0.5, 0.5), (1.0, 1.0), (2.0, 0.5), (2.5, 1.5)),
    ((0.0, 1.5), (1.5, 0.5), (2.0, 1.0), (3.0, 1.0)),
)
ARPEGGIOS = (
    (0, 1, 2, 3, 2, 1, 2, 1),
    (0, 2, 1, 3, 0, 2, 1, 3),
    (3, 2, 1, 0, 1, 2, 1, 2),
    (0, 1, 2, 1, 3, 2, 1, 2),
)
OCTAVE = len(SCALE)
BASS_OCTAVE, PAD_OCTAVE = -2 * OCTAVE, -OCTAVE
LOWEST_BASS = BASS_OCTAVE - 2  # the roots D and E lie below G
LEAD_LOW, LEAD_HIGH = 2, 9  # steps between which the melody walks


class Tone(NamedTuple):
    """A note of a bar.

    Attributes:
        start: Beats after the start of the bar.
        instrument: A layer with a pitch, or "kick", "snare", "hat", "open_hat".
        step: Step of the scale; 0 for drums.
        beats: How long it is held.
        strength: 0 to 1.
        side: Its place, −1 left to 1 right.
    """

    start: float
    instrument: str
    step: int
    beats: float
    strength: float
    side: float = 0.0


Bar = tuple[Tone, ...]


class Composition(NamedTuple):
    """A loop of music.

    Attributes:
        tempo: Beats per minute.
        layers: The bars of each layer, `[layer][bar]`.
    """

    tempo: float
    layers: tuple[tuple[Bar, ...], ...]


def compose(seed: int, tempo: tuple[float, float], swing: float = 0.0) -> Composition:
    """Compose a loop.

    Args:
        seed: Any whole number from 0 up; another one is another piece.
        tempo: Slowest and fastest tempo [beats per minute].
        swing: How late every second eighth is, 0 to 0.33 of a beat's half.
    """
    random = np.random.default_rng(seed)
    first, second = (PROGRESSIONS[index] for index in random.permutation(len(PROGRESSIONS))[:2])
    roots = (*first, *second[:3], 3)  # the last bar, on D, leads back to the first
    layers = (_pads(roots), _basses(roots, random), _arpeggios(roots, random), _beats(random),
              _leads(roots, random), _drives(roots, random))  # fmt: skip
    swung = tuple(tuple(tuple(_swung(tone, swing) for tone in bar) for bar in bars) for bars in layers)
    return Composition(round(float(random.uniform(*tempo)), 1), swung)


def _swung(tone: Tone, swing: float) -> Tone:
    is_off = tone.start % 1.0 == 0.5
    return tone._replace(start=tone.start + 0.5 * swing) if is_off else tone


def _pads(roots: tuple[int, ...]) -> tuple[Bar, ...]:
    sides = (-0.6, 0.0, 0.6)
    return tuple(
        tuple(
            Tone(0.0, "pad", PAD_OCTAVE + step, BEATS - 0.25, 0.6, side)
            for step, side in zip(CHORDS[root], sides, strict=True)
        )
        for root in roots
    )


def _basses(roots: tuple[int, ...], random: np.random.Generator) -> tuple[Bar, ...]:
    rhythms = [BASS_RHYTHMS[index] for index in random.permutation(len(BASS_RHYTHMS))[:2]]
    bars = []
    for number, root in enumerate(roots):
        rhythm = rhythms[number // 2 % 2]
        low = BASS_OCTAVE + root - (OCTAVE if root >= 3 else 0)
        ends = (*rhythm[1:], float(BEATS))
        steps = [low if index % 3 != 2 else low + OCTAVE for index in range(len(rhythm))]
        bars.append(
            tuple(
                Tone(start, "bass", step, 0.85 * (end - start), 1.0 if start == 0.0 else 0.8)
                for start, end, step in zip(rhythm, ends, steps, strict=True)
            )
        )
    return tuple(bars)


def _arpeggios(roots: tuple[int, ...], random: np.random.Generator) -> tuple[Bar, ...]:
    patterns = [ARPEGGIOS[index] for index in random.permutation(len(ARPEGGIOS))[:2]]
    bars = []
    for number, root in enumerate(roots):
        steps = (*CHORDS[root], CHORDS[root][0] + OCTAVE)
        bars.append(
            tuple(
                Tone(
                    0.5 * place, "arpeggio", steps[index], 0.4, (0.9, 0.6)[place % 2], (-0.5, 0.5)[place % 2]
                )
                for place, index in enumerate(patterns[number % 2])
            )
        )
    return tuple(bars)


def _beats(random: np.random.Generator) -> tuple[Bar, ...]:
    late = (2.5, 3.5)[int(random.integers(2))]
    plain = (
        *(Tone(start, "kick", 0, 0.25, 0.9) for start in (0.0, 2.0, late)),
        *(Tone(0.5 * place, "hat", 0, 0.1, (0.5, 0.8)[place % 2], 0.25) for place in range(8)),
    )
    last = (*plain, Tone(3.5, "open_hat", 0, 0.3, 0.7, 0.25))
    return (*(plain,) * 3, last, *(plain,) * 3, last)


def _leads(roots: tuple[int, ...], random: np.random.Generator) -> tuple[Bar, ...]:
    """A melody of four phrases of two bars: twice the first motif, once the second, and the first again."""
    motifs = [_motif(random), _motif(random)]
    bars: list[Bar] = []
    for phrase, motif in enumerate((0, 0, 1, 0)):
        for half in (0, 1):
            rhythm, moves = motifs[motif][half]
            number = 2 * phrase + half
            chord = CHORDS[roots[number]]
            step = chord[(phrase + half) % 3] + (OCTAVE if half == 0 and phrase == 2 else 0)
            tones = []
            for index, ((start, beats), move) in enumerate(zip(rhythm, moves, strict=True)):
                step = _bounded(step + move)
                if index == len(rhythm) - 1:  # a bar ends on a note of its chord
                    step = _bounded(_nearest(step, chord))
                tones.append(Tone(start, "lead", step, 0.9 * beats, 0.9 if start == 0.0 else 0.75, -0.15))
            bars.append(tuple(tones))
    return tuple(bars)


def _motif(random: np.random.Generator) -> list[tuple[Rhythm, list[int]]]:
    halves: list[tuple[Rhythm, list[int]]] = []
    for _ in range(2):
        rhythm = LEAD_RHYTHMS[int(random.integers(len(LEAD_RHYTHMS)))]
        moves = [0, *(int(move) for move in random.choice([-2, -1, -1, 1, 1, 2], len(rhythm) - 1))]
        halves.append((rhythm, moves))
    return halves


def _drives(roots: tuple[int, ...], random: np.random.Generator) -> tuple[Bar, ...]:
    """Snare, kicks between the beats, and the chord in sixteenths two octaves up."""
    fill = tuple(Tone(start, "snare", 0, 0.2, 0.5 + 0.1 * start) for start in (3.0, 3.25, 3.5, 3.75))
    pattern = [int(index) for index in random.integers(0, 3, 16)]
    bars = []
    for number, root in enumerate(roots):
        drums = [Tone(start, "snare", 0, 0.2, 0.9) for start in (1.0, 3.0)]
        drums += [Tone(start, "kick", 0, 0.25, 0.7) for start in (1.0, 3.0)]
        runs = [
            Tone(0.25 * place, "run", CHORDS[root][index] + OCTAVE, 0.2, (0.7, 0.4, 0.5, 0.4)[place % 4],
                 (0.6, -0.6)[place % 2])
            for place, index in enumerate(pattern)
        ]  # fmt: skip
        bars.append((*drums, *runs, *(fill if number == BARS - 1 else ())))
    return tuple(bars)


def _bounded(step: int) -> int:
    """A step within the range of the melody, by octaves."""
    while step < LEAD_LOW:
        step += OCTAVE
    while step > LEAD_HIGH:
        step -= OCTAVE
    return step


def _nearest(step: int, chord: tuple[int, ...]) -> int:
    """The note of a chord, in any octave, that is nearest to a step."""
    notes = [note + OCTAVE * octave for note in chord for octave in (-1, 0, 1, 2)]
    return min(notes, key=lambda note: (abs(note - step), note))
