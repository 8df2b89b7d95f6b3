"""Recipes for the sounds of mechanisms and further materials: one function each, from a layer to a wave.

A layer is the strength of the blow (0 soft, 1 hard), as in `hits.py`.
"""

from __future__ import annotations

import numpy as np

from silverball.app.sound.synth import (
    BAR,
    BELL,
    SKIN,
    Partial,
    Wave,
    edge,
    envelope,
    mix,
    noise,
    pitch_of,
    puff,
    ring,
    struck,
)


def metal(layer: int, random: np.random.Generator) -> Wave:
    """A wire guide: a thin bright ring that dies quickly."""
    wire = struck(
        620.0 + 40.0 * layer, BAR, 0.3, brightness=0.7 + 0.15 * layer, damping=0.6, detune=0.02, random=random
    )
    tick = puff(0.03, 900.0, 3000.0 + 1500.0 * layer, 0.015, random)
    click = (0.0, 0.4 + 0.25 * layer, edge(0.05, random))
    return mix(0.32, (0.0, 1.0, ring(wire, 0.32)), (0.0, 0.15 + 0.1 * layer, tick), click)


def plastic(layer: int, random: np.random.Generator) -> Wave:
    """A plastic cover on posts: a dry, hollow click."""
    plate = struck(
        410.0 + 25.0 * layer, SKIN, 0.1, brightness=0.5 + 0.2 * layer, damping=0.9, detune=0.03, random=random
    )
    knock = puff(0.04, 500.0, 1800.0 + 1200.0 * layer, 0.02, random)
    click = (0.0, 0.25 + 0.2 * layer, edge(0.02, random))
    return mix(0.14, (0.0, 1.0, ring(plate, 0.14)), (0.0, 0.25 + 0.1 * layer, knock), click)


def rubber(layer: int, random: np.random.Generator) -> Wave:
    """A rubber ring round a post: a short, soft thud with hardly any pitch."""
    band = struck(
        150.0 + 12.0 * layer,
        SKIN,
        0.11,
        brightness=0.35 + 0.2 * layer,
        damping=0.95,
        detune=0.03,
        random=random,
    )
    knock = puff(0.05, 140.0, 600.0 + 700.0 * layer, 0.03, random)
    click = (0.0, 0.08 + 0.1 * layer, edge(0.012, random))
    return mix(0.16, (0.0, 1.0, ring(band, 0.16)), (0.0, 0.3 + 0.1 * layer, knock), click)


def kick(layer: int, random: np.random.Generator) -> Wave:
    """A slingshot: the snap of its arm, the thump of the coil, and the twang of the rubber."""
    snap = puff(0.04, 500.0, 2600.0, 0.025, random)
    thump = ring([Partial(112.0, 1.0, 0.11), Partial(168.0, 0.5, 0.07)], 0.14)
    twang = ring(struck(233.0, BAR, 0.2, brightness=0.55, damping=0.8, detune=0.03, random=random), 0.22)
    return mix(
        0.26, (0.0, 0.9, thump), (0.0, 0.45, snap), (0.006, 0.5, twang), (0.002, 0.65, edge(0.04, random))
    )


def target(layer: int, random: np.random.Generator) -> Wave:
    """A stand-up target: the clack of a plate and two high notes."""
    plate = struck(480.0, BAR, 0.14, brightness=0.6 + 0.15 * layer, damping=0.85, detune=0.02, random=random)
    note = ring(struck(pitch_of(4), BELL, 0.4, brightness=0.3, damping=0.8, random=random), 0.4)
    return mix(
        0.42,
        (0.0, 1.0, ring(plate, 0.16)),
        (0.01, 0.5, note),
        (0.0, 0.2, puff(0.03, 500.0, 2200.0, 0.02, random)),
        (0.0, 0.45 + 0.2 * layer, edge(0.04, random)),
    )


def drop(layer: int, random: np.random.Generator) -> Wave:
    """A drop target that is hit: the clack of its plate, then the knock of its fall, lower down."""
    plate = struck(430.0, BAR, 0.12, brightness=0.6 + 0.15 * layer, damping=0.9, detune=0.02, random=random)
    fall = struck(165.0, BAR, 0.16, brightness=0.45, damping=0.9, detune=0.03, random=random)
    return mix(
        0.32,
        (0.0, 1.0, ring(plate, 0.14)),
        (0.07, 0.9, ring(fall, 0.2)),
        (0.07, 0.2, puff(0.05, 200.0, 1200.0, 0.03, random)),
        (0.0, 0.4 + 0.2 * layer, edge(0.03, random)),
        (0.07, 0.3, edge(0.03, random)),
    )


def bank_reset(layer: int, random: np.random.Generator) -> Wave:
    """A bank of drop targets that comes back: a strong coil, and the plates against their stop."""
    coil = ring([Partial(96.0, 1.0, 0.16), Partial(192.0, 0.4, 0.1)], 0.2)
    plates = [
        (0.05 + 0.012 * number, 0.45, ring(struck(pitch, BAR, 0.14, brightness=0.5, random=random), 0.16))
        for number, pitch in enumerate((360.0, 405.0, 385.0))
    ]
    clacks = [(start, 0.4, edge(0.035, random)) for start in (0.0, 0.05, 0.062, 0.074)]
    buzz = puff(0.08, 200.0, 1400.0, 0.06, random)
    return mix(0.36, (0.0, 1.0, coil), (0.0, 0.3, buzz), *plates, *clacks)


def rollover(layer: int, random: np.random.Generator) -> Wave:
    """The wire of a rollover switch: two light clicks and a small bell."""
    click = puff(0.015, 1500.0, 5000.0, 0.01, random)
    bell = ring(struck(pitch_of(7), BELL, 0.5, brightness=0.3, damping=0.7, random=random), 0.5)
    wire = edge(0.02, random)
    return mix(
        0.52,
        (0.0, 0.5, click),
        (0.035, 0.35, click),
        (0.004, 0.8, bell),
        (0.0, 0.4, wire),
        (0.035, 0.3, wire),
    )


def spinner(layer: int, random: np.random.Generator) -> Wave:
    """One turn of a spinner: the tick of its crank on the switch."""
    blade = struck(940.0, BAR, 0.06, brightness=0.6, damping=0.9, detune=0.03, random=random)
    tick = puff(0.02, 1200.0, 4000.0, 0.01, random)
    return mix(0.08, (0.0, 1.0, ring(blade, 0.08)), (0.0, 0.35, tick), (0.001, 0.4, edge(0.02, random)))


def gate(layer: int, random: np.random.Generator) -> Wave:
    """The flap of a gate that swings: a light rattle of wire."""
    wire = ring(struck(780.0, BAR, 0.12, brightness=0.5, damping=0.8, detune=0.03, random=random), 0.14)
    rattle = mix(0.14, (0.0, 1.0, wire), (0.0, 0.35, edge(0.03, random)))
    return mix(0.28, (0.0, 1.0, rattle), (0.08, 0.5, rattle), (0.14, 0.25, rattle))


def capture(layer: int, random: np.random.Generator) -> Wave:
    """A ball that drops into a hole: a hollow knock and its echo."""
    cup = ring(struck(155.0, SKIN, 0.22, brightness=0.4, damping=0.9, detune=0.02, random=random), 0.26)
    rim = edge(0.025, random)
    thud = puff(0.06, 200.0, 900.0, 0.04, random)
    return mix(0.4, (0.0, 1.0, cup), (0.09, 0.45, cup), (0.0, 0.2, thud), (0.0, 0.3, rim), (0.09, 0.15, rim))


def release(layer: int, random: np.random.Generator) -> Wave:
    """A hole that sends its ball off: the coil and the ball leaving its cup."""
    coil = ring([Partial(108.0, 1.0, 0.12), Partial(216.0, 0.45, 0.08)], 0.15)
    pop = ring(struck(290.0, BAR, 0.12, brightness=0.5, damping=0.85, random=random), 0.14)
    clack = puff(0.04, 300.0, 1800.0, 0.03, random)
    return mix(0.22, (0.0, 1.0, coil), (0.015, 0.6, pop), (0.0, 0.3, clack), (0.004, 0.6, edge(0.04, random)))


def plunger_pull(layer: int, random: np.random.Generator) -> Wave:
    """The plunger pulled back: the creak of its spring, rising."""
    creak = noise(0.4, 260.0, 900.0, random) * envelope(0.4, 0.12, 0.5)
    coils = noise(0.4, 2200.0, 6500.0, random) * envelope(0.4, 0.2, 0.4)
    return mix(
        0.42, (0.0, 1.0, creak), (0.0, 0.3, puff(0.04, 300.0, 1400.0, 0.02, random)), (0.0, 0.1, coils)
    )


def launch(layer: int, random: np.random.Generator) -> Wave:
    """The plunger that strikes a ball: the spring, steel on steel, and the ball rushing up."""
    spring = ring(struck(130.0, BAR, 0.2, brightness=0.5, damping=0.8, random=random), 0.24)
    click = ring([Partial(1830.0, 1.0, 0.06), Partial(2950.0, 0.5, 0.04)], 0.08)
    rush = noise(0.4, 180.0, 800.0, random) * envelope(0.4, 0.14, 0.5)
    strike = (0.008, 0.7, edge(0.05, random))
    return mix(0.5, (0.0, 1.0, spring), (0.008, 0.35, click), (0.02, 0.4, rush), strike)


def ramp(layer: int, random: np.random.Generator) -> Wave:
    """A ball that rolls onto a ramp or off it: the lip of the plate, and plastic humming under the ball."""
    lip = ring(struck(320.0, BAR, 0.1, brightness=0.5, damping=0.9, detune=0.02, random=random), 0.12)
    hum = noise(0.5, 240.0, 1100.0, random) * envelope(0.5, 0.08, 0.4)
    hiss = noise(0.5, 2500.0, 7000.0, random) * envelope(0.5, 0.06, 0.35)
    return mix(0.52, (0.0, 0.7, lip), (0.02, 0.8, hum), (0.0, 0.3, edge(0.025, random)), (0.02, 0.1, hiss))
