"""How bright every lamp of a table is at a moment: by its state, or by the light show that runs."""

from __future__ import annotations

import numpy as np

from silverball.drawing.effects import Effects
from silverball.drawing.layout import OF_THE_MODE, PLAIN_COLOR, STATES, Insert, Layout, Light
from silverball.drawing.light_shows import SHOWS, Levels, Places, places_of, show_levels, shown_share
from silverball.drawing.moment import Moment

ON, BLINKING = STATES.index("on"), STATES.index("blinking")
BLINK_RATE = 2.5  # [1/s]
BLINK_ON = 0.55  # share of a period in which a blinking lamp is bright
BLINK_EDGE = 0.09  # share of a period in which it becomes bright, and dark
CALM_LIGHT = 0.4  # of light shows with weaker effects


class Lamps:
    """The lamps of a table that lie in the playfield.

    Args:
        layout: The table.
    """

    def __init__(self, layout: Layout) -> None:
        self.inserts = layout.inserts
        self._places: Places = places_of(layout)
        self._numbers = np.array([insert.lamp for insert in layout.inserts], np.int64)
        self._begins = np.array([insert.begins for insert in layout.inserts], np.int64)
        lights = layout.lights
        self._insert_of = np.array([light.insert for light in lights], np.int64)
        self._shines = {
            color: np.array([_shines(layout.inserts[light.insert], light, color) for light in lights])
            for color in layout.mode_colors
        }

    def light_levels(self, moment: Moment, effects: Effects) -> Levels:
        """Return how bright each light is, 0 to 1, shape [light]: 0 if its lamp has another colour now."""
        shines = self._shines.get(moment.color, self._shines[PLAIN_COLOR])
        levels: Levels = self.levels(moment, effects)[self._insert_of] * shines
        return levels

    def levels(self, moment: Moment, effects: Effects) -> Levels:
        """Return how bright each lamp is, 0 to 1, shape [insert]."""
        if not self.inserts:
            return np.zeros(0)
        own = self._own_levels(moment)
        running = moment.show or effects.show(moment.time)
        if running is None or running.name not in SHOWS:
            return own
        show, age = SHOWS[running.name], running.age
        light, under = show_levels(show, age, self._places), show.under
        if not effects.is_full:
            light, under = CALM_LIGHT * light, 1.0 if under else 0.0
        share = shown_share(show, age)
        levels: Levels = share * np.maximum(light, under * own) + (1.0 - share) * own
        return levels

    def _own_levels(self, moment: Moment) -> Levels:
        """How bright the lamps are by their states."""
        states = np.array(moment.lamps, np.int64)[self._numbers] if moment.lamps else self._begins
        own: Levels = np.where(states == BLINKING, blink(moment.time), states == ON)
        return own


def _shines(insert: Insert, light: Light, color: str) -> bool:
    """Whether a light of an insert is the one that shines while the modes have a colour."""
    return insert.color != OF_THE_MODE or light.color == color


def blink(time: float) -> float:
    """Return how bright a blinking lamp is at a time [s]: 2.5 times a second, with soft edges."""
    phase = time * BLINK_RATE % 1.0
    edge = min(phase, BLINK_ON - phase) / BLINK_EDGE
    return min(max(edge, 0.0), 1.0)
