"""Light shows: what all lamps do together for a moment, and forever while nobody plays.

A show is a list of waves. A wave runs over the lamps in the order of their places (up the table, around its
middle, …) with a rate; where it has just arrived a lamp is bright, and then fades. So a show is a function of
its own time and of the places of the lamps, and nothing of it is kept from frame to frame.

`SHOWS` has them all, by the names by which a rule's `cue` calls them. `EVENT_SHOWS` says which the machine
runs by itself.
"""

from __future__ import annotations

import math
from enum import StrEnum
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.layout import Layout
from silverball.game.view import GameEventKind

FADE = 0.25  # [s] at the end of a show, in which the game's own lamps come back
RISE = 0.07  # share of a period in which a lamp becomes bright
WAVE_FADE = 0.15  # [s] at the end of a wave, in which it fades
FOREVER = math.inf
GOLDEN = 0.6180339887498949  # the fractional parts of its multiples are spread evenly over 0 to 1

Levels: TypeAlias = NDArray[np.float64]
"""How bright each lamp is, 0 to 1, shape [lamp]."""


class Order(StrEnum):
    """In which order a wave reaches the lamps."""

    TOGETHER = "together"
    UP = "up"  # from the player to the top
    DOWN = "down"
    RIGHT = "right"  # from the left to the right
    LEFT = "left"
    OUT = "out"  # from the middle of the table
    IN = "in"
    TURN = "turn"  # around the middle, counter-clockwise
    BACK = "back"  # the other way round
    LIST = "list"  # as in the table file
    CHANCE = "chance"


class Wave(NamedTuple):
    """A wave of light.

    Attributes:
        order: The order of the lamps.
        rate: How often it starts [1/s].
        begins: When it begins [s].
        ends: When it ends [s].
        spread: How many waves are on their way at once: periods between the first lamp and the last.
        width: How long a lamp is bright, as a share of the period.
        light: How bright it is at most, 0 to 1.
    """

    order: Order
    rate: float
    begins: float = 0.0
    ends: float = FOREVER
    spread: float = 1.0
    width: float = 0.5
    light: float = 1.0


class Show(NamedTuple):
    """A light show.

    Attributes:
        seconds: How long it lasts [s].
        rank: A show of a lower rank does not interrupt it.
        waves: Its waves; a lamp is as bright as the brightest of them makes it.
        under: How much of the game's own lamps is seen beneath it, 0 to 1.
        repeats: Whether it begins again when its last wave has ended.
    """

    seconds: float
    rank: int
    waves: tuple[Wave, ...]
    under: float = 0.0
    repeats: bool = False


SHOWS = {
    "attract": Show(FOREVER, 0, (
        Wave(Order.UP, 0.9, 0.0, 4.0, spread=1.0, width=0.55),
        Wave(Order.TURN, 0.6, 4.0, 8.0, spread=2.0, width=0.5),
        Wave(Order.CHANCE, 1.1, 8.0, 11.0, spread=1.0, width=0.45),
        Wave(Order.OUT, 0.9, 11.0, 14.0, spread=1.2, width=0.5),
        Wave(Order.LEFT, 0.8, 14.0, 17.0, spread=1.5, width=0.5),
        Wave(Order.LIST, 0.35, 17.0, 20.0, spread=1.0, width=0.3),
    ), repeats=True),
    "ball start": Show(1.3, 1, (Wave(Order.UP, 1.2, 0.0, 1.3, spread=0.75, width=0.4),), under=0.5),
    "ball saved": Show(1.2, 2, (Wave(Order.UP, 2.5, 0.0, 1.2, spread=1.5, width=0.5),), under=0.3),
    "end of ball": Show(1.6, 3, (Wave(Order.DOWN, 0.9, 0.0, 1.6, spread=0.9, width=0.6, light=0.8),)),
    "lock": Show(1.2, 2, (Wave(Order.IN, 1.8, 0.0, 1.2, spread=1.0, width=0.4),), under=0.2),
    "kickback": Show(0.7, 1, (Wave(Order.UP, 3.0, 0.0, 0.7, spread=1.0, width=0.5),), under=0.5),
    "skill shot": Show(1.4, 2, (Wave(Order.DOWN, 1.8, 0.0, 1.4, spread=1.0, width=0.45),), under=0.2),
    "mission": Show(1.0, 1, (Wave(Order.TURN, 2.0, 0.0, 1.0, spread=1.0, width=0.4),), under=0.3),
    "mission won": Show(2.6, 4, (
        Wave(Order.CHANCE, 2.2, 0.0, 1.6, spread=1.0, width=0.5),
        Wave(Order.UP, 1.2, 1.2, 2.6, spread=0.8, width=0.5),
    )),
    "mission lost": Show(1.2, 2, (Wave(Order.DOWN, 1.0, 0.0, 1.0, spread=0.7, width=0.3, light=0.6),)),
    "jackpot": Show(2.0, 4, (
        Wave(Order.TOGETHER, 2.5, 0.0, 0.6, width=0.8),
        Wave(Order.OUT, 2.0, 0.5, 2.0, spread=0.9, width=0.55),
    )),
    "super jackpot": Show(3.2, 5, (
        Wave(Order.TOGETHER, 2.5, 0.0, 1.0, width=0.8),
        Wave(Order.OUT, 2.2, 0.8, 2.2, spread=1.2, width=0.55),
        Wave(Order.TURN, 1.5, 2.0, 3.2, spread=2.0, width=0.6),
        Wave(Order.CHANCE, 2.5, 2.0, 3.2, spread=1.0, width=0.3),
    )),
    "multiball": Show(3.0, 4, (
        Wave(Order.TURN, 1.4, 0.0, 1.6, spread=2.0, width=0.5),
        Wave(Order.BACK, 1.4, 1.4, 3.0, spread=2.0, width=0.5),
        Wave(Order.UP, 2.0, 1.4, 3.0, spread=1.0, width=0.35),
    )),
    "extra ball": Show(2.0, 4, (
        Wave(Order.RIGHT, 1.25, 0.0, 2.0, spread=1.0, width=0.35),
        Wave(Order.LEFT, 1.25, 0.0, 2.0, spread=1.0, width=0.35),
    )),
    "wizard": Show(3.6, 5, (
        Wave(Order.IN, 1.5, 0.0, 1.8, spread=1.5, width=0.5),
        Wave(Order.OUT, 1.5, 1.6, 3.6, spread=1.5, width=0.5),
        Wave(Order.CHANCE, 2.5, 1.6, 3.6, spread=1.0, width=0.3),
    )),
    "last chance": Show(1.2, 2, (Wave(Order.UP, 2.5, 0.0, 1.2, spread=1.5, width=0.5),), under=0.3),
    "lock lit": Show(0.8, 1, (Wave(Order.OUT, 1.6, 0.0, 0.8, spread=0.8, width=0.4),), under=0.6),
    "extra ball lit": Show(0.8, 1, (Wave(Order.RIGHT, 1.6, 0.0, 0.8, spread=0.8, width=0.4),), under=0.6),
    "super jackpot lit": Show(1.0, 2, (Wave(Order.IN, 2.5, 0.0, 1.0, spread=1.0, width=0.4),), under=0.5),
    "wizard lit": Show(1.6, 3, (Wave(Order.IN, 1.5, 0.0, 1.6, spread=1.5, width=0.5),), under=0.3),
    "wizard over": Show(1.6, 3, (Wave(Order.DOWN, 0.9, 0.0, 1.6, spread=0.9, width=0.5),)),
    "lanes": Show(0.6, 1, (Wave(Order.DOWN, 2.0, 0.0, 0.6, spread=0.8, width=0.35),), under=0.6),
    "combo": Show(0.5, 1, (Wave(Order.RIGHT, 2.5, 0.0, 0.5, spread=0.8, width=0.35),), under=0.7),
    "lit shot": Show(0.5, 1, (Wave(Order.OUT, 2.5, 0.0, 0.5, spread=0.8, width=0.35),), under=0.7),
    "warning": Show(0.6, 3, (Wave(Order.RIGHT, 3.0, 0.0, 0.6, spread=1.0, width=0.6),), under=0.4),
    "tilt": Show(FOREVER, 6, (Wave(Order.TOGETHER, 2.0, 0.0, 0.5, width=0.9),)),
    "game over": Show(2.4, 6, (
        Wave(Order.TOGETHER, 0.5, 0.0, 0.9, width=1.0, light=0.9),
        Wave(Order.IN, 0.7, 0.6, 2.4, spread=0.8, width=0.5, light=0.7),
    )),
}  # fmt: skip
"""All light shows by their names. None flashes everything more than three times a second: that is dangerous
for people with epilepsy (WCAG 2.2, criterion 2.3.1)."""

EVENT_SHOWS = {
    GameEventKind.BALL_READY: "end of ball",  # but before the first ball
    GameEventKind.BALL_SAVED: "ball saved",
    GameEventKind.BALL_LOCKED: "lock",
    GameEventKind.MULTIBALL: "multiball",
    GameEventKind.EXTRA_BALL: "extra ball",
    GameEventKind.WARNING: "warning",
    GameEventKind.TILT: "tilt",
    GameEventKind.OVER: "game over",
}
"""The shows that the machine runs by itself; and "ball start" when the next ball comes."""

ALWAYS = (GameEventKind.BALL_READY, GameEventKind.OVER)
"""What interrupts every show: the ball of that show is gone."""


class Running(NamedTuple):
    """A show that runs, and for how long it has [s]."""

    name: str
    age: float


Places: TypeAlias = dict[Order, Levels]
"""Where each lamp comes in an order, 0 (first) to 1 (last), shape [lamp]."""


def places_of(layout: Layout) -> Places:
    """Return where the lamps of a table come in every order."""
    count = len(layout.inserts)
    x = np.array([insert.center[0] for insert in layout.inserts])
    z = np.array([insert.center[1] for insert in layout.inserts])
    up, right = _spread(x), _spread(z)
    around = np.arctan2(up - 0.5, right - 0.5) / (2.0 * math.pi) % 1.0
    out = _spread(np.hypot(up - 0.5, right - 0.5))
    number = np.arange(count, dtype=np.float64)
    return {
        Order.TOGETHER: np.zeros(count),
        Order.UP: up, Order.DOWN: 1.0 - up,
        Order.RIGHT: right, Order.LEFT: 1.0 - right,
        Order.OUT: out, Order.IN: 1.0 - out,
        Order.TURN: around, Order.BACK: 1.0 - around,
        Order.LIST: _spread(number),
        Order.CHANCE: GOLDEN * (number + 1) % 1.0,
    }  # fmt: skip


def _spread(values: Levels) -> Levels:
    """Stretch numbers over 0 to 1."""
    if not len(values):
        return values
    low, high = values.min(), values.max()
    stretched: Levels = (values - low) / max(high - low, 1e-9)
    return stretched


def show_levels(show: Show, age: float, places: Places) -> Levels:
    """Return how bright a show makes each lamp at an age [s], 0 to 1, shape [lamp]."""
    if show.repeats:
        age %= max(wave.ends for wave in show.waves)
    levels = np.zeros(len(places[Order.TOGETHER]))
    for wave in show.waves:
        if wave.begins <= age < wave.ends:
            arrived = (age - wave.begins) * wave.rate - wave.spread * places[wave.order]
            phase = arrived % 1.0
            bright = np.minimum(phase / RISE, np.clip((wave.width - phase) / (wave.width - RISE), 0.0, 1.0))
            bright = wave.light * bright * min((wave.ends - age) / WAVE_FADE, 1.0)
            levels = np.maximum(levels, np.where(arrived < 0.0, 0.0, bright))
    return levels


def shown_share(show: Show, age: float) -> float:
    """Return how much of a show is seen at an age [s]: 1, and in the end less of it and more of the game."""
    return min(max((show.seconds - age) / FADE, 0.0), 1.0)
