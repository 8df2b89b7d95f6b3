"""The lives of an episode, as Atari counts them: its balls that have not been lost yet."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def lives_of(info: Mapping[str, Any], balls: int) -> Any:
    """The balls left of an episode of so many, from its counts: numbers, or arrays [env].

    By the rules of a game the present ball counts until it is lost, and extra balls and those that are
    saved come back; without rules every ball in the gutter is lost.
    """
    if "balls_in_play" not in info:
        return balls - info["drained"]
    return np.maximum(balls - info["ball"], 0) + (np.asarray(info["balls_in_play"]) > 0)
