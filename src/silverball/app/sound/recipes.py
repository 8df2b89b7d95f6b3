"""Which sounds are there, how loud, and in how many variations? The table of all of them.

A sound has layers (how hard the blow was, or which step of the scale) and in each layer some variations, so
that no two blows in a row are the same wave.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from silverball.app.sound import hits, tunes
from silverball.app.sound.scale import BELL_STEPS
from silverball.app.sound.synth import Wave


class Recipe(NamedTuple):
    """How a sound is made.

    Attributes:
        make: The wave of a layer; the generator is that of the variation.
        level: Loudness of its loudest moment at full strength [dB], see `loudness`.
        layers: How many layers there are.
        variations: How many variations of each.
    """

    make: Callable[[int, np.random.Generator], Wave]
    level: float
    layers: int = 1
    variations: int = 1


RECIPES: dict[str, Recipe] = {
    "wall": Recipe(hits.wall, -20.0, 2, 3),
    "slant_wall": Recipe(hits.slant_wall, -20.0, 2, 3),
    "prism": Recipe(hits.prism, -18.0, 2, 3),
    "cylinder": Recipe(hits.cylinder, -17.0, BELL_STEPS, 2),
    "coil": Recipe(hits.coil, -23.0, 1, 3),
    "stop": Recipe(hits.stop, -22.0, 2, 3),
    "paddle_hit": Recipe(hits.paddle_hit, -20.0, 2, 3),
    "balls": Recipe(hits.balls, -21.0, 2, 3),
    "created": Recipe(hits.created, -19.0, 1, 2),
    "shove": Recipe(hits.shove, -20.0, 1, 2),
    "drain": Recipe(hits.drain, -18.0, 1, 2),
    "ball_saved": Recipe(tunes.ball_saved, -18.0),
    "warning": Recipe(tunes.warning, -18.0),
    "tilt": Recipe(tunes.tilt, -16.0),
    "un_stuck": Recipe(tunes.un_stuck, -20.0),
    "double_on": Recipe(tunes.double_on, -18.0),
    "game_over": Recipe(tunes.game_over, -18.0),
    "high_score": Recipe(tunes.high_score, -16.0),
    "menu_move": Recipe(tunes.menu_move, -25.0, 1, 2),
    "menu_choose": Recipe(tunes.menu_choose, -22.0),
    "menu_back": Recipe(tunes.menu_back, -23.0),
    "menu_refuse": Recipe(tunes.menu_refuse, -22.0),
    "attract": Recipe(tunes.attract, -22.0),
}
"""All sounds but the rolling of a ball, which is in `rolling.py`."""
