"""Recipes for the tunes and signals of the game and its menus: one function each."""

from __future__ import annotations

import numpy as np

from silverball.app.sound.synth import (
    BAR,
    BELL,
    RATE,
    TUNED_BAR,
    Wave,
    as_float32,
    envelope,
    glide,
    mix,
    pitch_of,
    ring,
    struck,
)


def _bells(
    random: np.random.Generator, seconds: float, *notes: tuple[float, int, float], decay: float = 0.7
) -> Wave:
    """Play bells: (start [s], step of the scale, strength)."""
    return mix(
        seconds,
        *(
            (
                start,
                strength,
                ring(
                    struck(pitch_of(step), BELL, decay, brightness=0.36, detune=0.001, random=random),
                    min(decay, seconds),
                ),
            )
            for start, step, strength in notes
        ),
    )


def _reed(step: int, seconds: float, release: float = 0.12) -> Wave:
    """Play a sustained note, like that of a small organ: a few overtones, a slow attack, a soft release."""
    tone = glide(lambda t: np.full_like(t, pitch_of(step)), seconds, (1.0, 0.5, 0.28, 0.14, 0.06))
    edge = min(release, 0.5 * seconds)
    time = np.arange(len(tone)) / RATE
    shape = np.minimum(np.minimum(time / 0.02, 1.0), np.maximum(seconds - time, 0.0) / edge)
    return as_float32(tone * np.sin(0.5 * np.pi * np.minimum(shape, 1.0)) ** 2)


def ball_saved(layer: int, random: np.random.Generator) -> Wave:
    """Four bells upwards, G B D G."""
    return _bells(random, 1.0, (0.0, 0, 0.8), (0.08, 2, 0.8), (0.16, 3, 0.9), (0.24, 5, 1.0))


def warning(layer: int, random: np.random.Generator) -> Wave:
    """Two short dull buzzes."""
    buzz = glide(lambda t: np.full_like(t, 123.5), 0.14, (1.0, 0.7, 0.5, 0.3, 0.2, 0.1)) * envelope(
        0.14, 0.015, 0.4
    )
    return mix(0.42, (0.0, 1.0, buzz), (0.2, 0.9, buzz))


def tilt(layer: int, random: np.random.Generator) -> Wave:
    """A hum that sinks by three octaves and dies, as if the power failed."""
    hum = glide(lambda t: 392.0 * 2.0 ** (-3.0 * t**0.8), 1.4, (1.0, 0.6, 0.4, 0.25, 0.12)) * envelope(
        1.4, 0.01, 2.2
    )
    clunk = ring(struck(98.0, BAR, 0.3, brightness=0.4, damping=0.9, random=random), 0.35)
    return mix(1.5, (0.0, 0.7, hum), (0.0, 1.0, clunk))


def unstuck(layer: int, random: np.random.Generator) -> Wave:
    """Two knocks from below, and a small note up."""
    knocks = [
        ring(struck(pitch, BAR, 0.12, brightness=0.4, damping=0.8, random=random), 0.15)
        for pitch in (131.0, 165.0)
    ]
    hop = glide(lambda t: pitch_of(-2) * 2.0 ** (0.6 * t), 0.18, (1.0, 0.25)) * envelope(0.18, 0.03, 0.3)
    return mix(0.5, (0.0, 1.0, knocks[0]), (0.12, 1.0, knocks[1]), (0.24, 0.5, hop))


def double_on(layer: int, random: np.random.Generator) -> Wave:
    """An arpeggio, G D B E."""
    return _bells(
        random, 1.1, (0.0, -5, 0.8), (0.05, 3, 0.7), (0.1, 5, 0.6), (0.15, 7, 0.7), (0.2, 9, 0.5), decay=0.9
    )


def game_over(layer: int, random: np.random.Generator) -> Wave:
    """Bells E D B down to a G with its octave below."""
    bells = _bells(
        random, 2.2, (0.0, 4, 0.8), (0.22, 3, 0.8), (0.44, 2, 0.8), (0.7, 0, 1.0), (0.7, -5, 0.9), decay=1.3
    )
    return mix(2.2, (0.0, 1.0, bells), (0.7, 0.12, _reed(-5, 1.2, 0.9)), (0.7, 0.1, _reed(-2, 1.2, 0.9)))


def high_score(layer: int, random: np.random.Generator) -> Wave:
    """A fanfare: D D D G, B, and a chord of the whole scale, reeds under bells."""
    melody = (
        (0.0, 3, 0.12),
        (0.15, 3, 0.12),
        (0.3, 3, 0.12),
        (0.45, 5, 0.3),
        (0.8, 3, 0.14),
        (0.97, 5, 0.14),
        (1.14, 7, 1.0),
    )
    reeds = [(start, 0.34, _reed(step, length)) for start, step, length in melody]
    chord = [(1.14, 0.2, _reed(step, 1.0, 0.6)) for step in (0, 3, 5)] + [(1.14, 0.3, _reed(-5, 1.0, 0.6))]
    bells = _bells(
        random,
        2.5,
        *((start, step, 0.6) for start, step, _ in melody),
        (1.2, 10, 0.4),
        (1.3, 8, 0.35),
        (1.4, 10, 0.3),
        decay=1.1,
    )
    return mix(2.5, *reeds, *chord, (0.0, 0.8, bells))


# --- the menus ------------------------------------------------------------------------------------------


def menu_move(layer: int, random: np.random.Generator) -> Wave:
    """A wooden tick."""
    return ring(
        struck(pitch_of(3), TUNED_BAR, 0.11, brightness=0.25, damping=0.8, detune=0.004, random=random), 0.12
    )


def menu_choose(layer: int, random: np.random.Generator) -> Wave:
    """Two notes up."""
    return _bells(random, 0.5, (0.0, 0, 0.8), (0.07, 3, 1.0), decay=0.4)


def menu_back(layer: int, random: np.random.Generator) -> Wave:
    """The same two notes down, shorter."""
    return _bells(random, 0.42, (0.0, 3, 0.8), (0.07, 0, 0.9), decay=0.32)


def menu_refuse(layer: int, random: np.random.Generator) -> Wave:
    """A soft double thud."""
    thud = ring(struck(147.0, BAR, 0.11, brightness=0.4, damping=0.9, random=random), 0.13)
    return mix(0.28, (0.0, 1.0, thud), (0.11, 0.9, thud))


def attract(layer: int, random: np.random.Generator) -> Wave:
    """A distant music box, up and down the scale."""
    steps = (0, 2, 3, 5, 7, 5, 3, 7, 9, 7, 5, 3, 2, 3, 0)
    notes = [(0.16 * number, step, 0.8 if number % 4 == 0 else 0.55) for number, step in enumerate(steps)]
    return _bells(random, 3.2, *notes, (0.0, -5, 0.6), (0.16 * 14, -5, 0.6), decay=0.8)
