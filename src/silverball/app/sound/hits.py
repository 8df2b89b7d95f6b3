"""Recipes for the sounds of the board: one function each, from a layer to a wave.

A layer is the strength of the blow (0 soft, 1 hard), or for a cylinder the step of the scale. The random
generator makes every blow different.
"""

from __future__ import annotations

import numpy as np

from silverball.app.sound.sound_sets import DEFAULT_SET, SoundSet
from silverball.app.sound.synth import (
    BAR,
    BELL,
    SKIN,
    TUNED_BAR,
    Partial,
    Wave,
    edge,
    envelope,
    glide,
    mix,
    noise,
    pitch_of,
    puff,
    ring,
    struck,
)


def wall(layer: int, random: np.random.Generator) -> Wave:
    """Wood, behind a strip of rubber: a low, strongly damped bar."""
    body = struck(
        208.0 + 14.0 * layer, BAR, 0.16, brightness=0.5 + 0.2 * layer, damping=0.8, detune=0.03, random=random
    )
    knock = puff(0.06, 160.0, 900.0 + 900.0 * layer, 0.03, random)
    click = (0.0, 0.12 + 0.16 * layer, edge(0.02, random))
    return mix(0.22, (0.0, 1.0, ring(body, 0.22)), (0.0, 0.25 + 0.15 * layer, knock), click)


def slant_wall(layer: int, random: np.random.Generator) -> Wave:
    """A thinner board, higher than the wall and with a little more ring."""
    body = struck(
        262.0 + 18.0 * layer,
        BAR,
        0.2,
        brightness=0.5 + 0.2 * layer,
        damping=0.75,
        detune=0.03,
        random=random,
    )
    knock = puff(0.05, 250.0, 1200.0 + 1200.0 * layer, 0.025, random)
    click = (0.0, 0.14 + 0.2 * layer, edge(0.02, random))
    return mix(0.24, (0.0, 1.0, ring(body, 0.24)), (0.0, 0.22 + 0.13 * layer, knock), click)


def prism(layer: int, random: np.random.Generator) -> Wave:
    """A marimba bar: a warm, dry note of the low scale and a rubber thud."""
    step = (-5, -3, -2)[int(random.integers(3))]
    bar = struck(
        pitch_of(step),
        TUNED_BAR,
        0.42,
        brightness=0.32 + 0.16 * layer,
        damping=0.9,
        detune=0.01,
        random=random,
    )
    thud = ring([Partial(98.0, 1.0, 0.12)], 0.15)
    knock = puff(0.05, 200.0, 1000.0 + 800.0 * layer, 0.03, random)
    click = (0.0, 0.12 + 0.16 * layer, edge(0.02, random))
    return mix(0.45, (0.0, 1.0, ring(bar, 0.45)), (0.0, 0.7, thud), (0.0, 0.2, knock), click)


def cylinder(layer: int, random: np.random.Generator, sounds: SoundSet = DEFAULT_SET) -> Wave:
    """A bell chord on a step of the scale, over the thump of the coil that throws the ball off."""
    layers = []
    for above, strength in ((0, 1.0), (2, 0.34), (4, 0.22)):
        bell = struck(
            pitch_of(layer + above), sounds.bell, 0.95,
            brightness=0.5, damping=sounds.bell_damping, detune=0.002, random=random,
        )  # fmt: skip
        bell.append(Partial(pitch_of(layer + above) * 1.003, 0.35, 0.8))  # beating with the lowest partial
        layers.append((0.012 * above, strength, ring(bell, 0.95)))
    thump = ring([Partial(104.0, 1.0, 0.14), Partial(147.0, 0.5, 0.09)], 0.16)
    snap = puff(0.03, 400.0, 2500.0, 0.02, random)
    return mix(0.95, *layers, (0.0, 0.8, thump), (0.0, 0.1, snap), (0.004, 0.4, edge(0.04, random)))


def coil(layer: int, random: np.random.Generator) -> Wave:
    """The coil of a paddle: a dull clack with a trace of mains hum."""
    clack = puff(0.05, 240.0, 1500.0, 0.045, random, rise=0.0015)
    pull = ring([Partial(118.0 * random.uniform(0.97, 1.03), 1.0, 0.09), Partial(236.0, 0.4, 0.06)], 0.11)
    return mix(0.12, (0.0, 0.5, clack), (0.0, 0.9, pull), (0.006, 0.45, edge(0.03, random)))


def stop(layer: int, random: np.random.Generator) -> Wave:
    """A paddle at its stop: layer 0 falls back onto felt, layer 1 is thrown up against wood."""
    body = struck(
        (230.0, 340.0)[layer],
        BAR,
        0.1 + 0.03 * layer,
        brightness=0.45 + 0.2 * layer,
        damping=0.9,
        detune=0.03,
        random=random,
    )
    return mix(
        0.15,
        (0.0, 1.0, ring(body, 0.15)),
        (0.0, 0.3, puff(0.03, 200.0, 800.0 + 1200.0 * layer, 0.02, random)),
        (0.0, (0.15, 0.4)[layer], edge(0.025, random)),
    )


def paddle_hit(layer: int, random: np.random.Generator) -> Wave:
    """Steel on a rubber ring round a hollow bat: a round thud, an octave below the stop."""
    body = struck(185.0, SKIN, 0.15, brightness=0.55 + 0.2 * layer, damping=0.8, detune=0.02, random=random)
    return mix(
        0.2,
        (0.0, 1.0, ring(body, 0.2)),
        (0.0, 0.2 + 0.15 * layer, puff(0.04, 200.0, 1000.0 + 1000.0 * layer, 0.025, random)),
        (0.0, 0.14 + 0.2 * layer, edge(0.015, random)),
    )


def balls(layer: int, random: np.random.Generator) -> Wave:
    """Steel on steel: a short bright click over a small knock of the floor."""
    click = [
        Partial(pitch * random.uniform(0.98, 1.02), strength, decay)
        for pitch, strength, decay in (
            (1830.0, 1.0, 0.09),
            (2950.0, 0.45 + 0.2 * layer, 0.06),
            (4420.0, 0.2 + 0.2 * layer, 0.04),
        )
    ]
    knock = ring([Partial(420.0, 1.0, 0.05), Partial(690.0, 0.5, 0.04)], 0.08)
    return mix(
        0.14, (0.0, 1.0, ring(click, 0.14)), (0.0, 0.9, knock), (0.0, 0.4 + 0.3 * layer, edge(0.03, random))
    )


def created(layer: int, random: np.random.Generator) -> Wave:
    """A new ball in the lane: the knock of the plunger, the ball rushing up, and two quiet notes."""
    rush = noise(0.42, 180.0, 700.0, random) * envelope(0.42, 0.16, 0.5)
    knock = ring(struck(140.0, BAR, 0.16, brightness=0.4, damping=0.8, random=random), 0.2)
    low, high = (
        ring(struck(pitch_of(step), BELL, 0.5, brightness=0.35, random=random), 0.55) for step in (0, 3)
    )
    click = (0.0, 0.35, edge(0.04, random))
    return mix(0.75, (0.0, 1.0, knock), (0.02, 0.35, rush), (0.08, 0.35, low), (0.2, 0.4, high), click)


def shove(layer: int, random: np.random.Generator) -> Wave:
    """A hand against the cabinet: a low, soft thump, a rattle inside and in the glass."""
    body = ring(struck(98.0, SKIN, 0.24, brightness=0.65, damping=0.7, detune=0.03, random=random), 0.3)
    rattle = puff(0.16, 300.0, 1200.0, 0.14, random, rise=0.02)
    glass = [(start, 0.2, edge(0.03, random)) for start in (0.03, 0.08)]
    return mix(0.32, (0.0, 1.0, body), (0.03, 0.12, rattle), *glass)


def drain(layer: int, random: np.random.Generator) -> Wave:
    """A ball in the gutter: a hollow knock, a second one lower down, and two falling notes."""
    first, second = (
        ring(struck(pitch, BAR, 0.3, brightness=0.35, damping=0.9, detune=0.02, random=random), 0.35)
        for pitch in (123.0, 98.0)
    )
    fall = glide(lambda t: pitch_of(-2) * 2.0 ** (-0.9 * t), 0.55, (1.0, 0.3, 0.1)) * envelope(
        0.55, 0.03, 0.6
    )
    return mix(
        0.85,
        (0.0, 0.8, first),
        (0.17, 0.7, second),
        (0.06, 0.55, fall),
        (0.02, 0.12, puff(0.3, 150.0, 500.0, 0.3, random, rise=0.03)),
        (0.0, 0.2, edge(0.03, random)),
        (0.17, 0.12, edge(0.03, random)),
    )
