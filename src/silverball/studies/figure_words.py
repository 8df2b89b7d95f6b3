"""What the figures of a study are called, and how they are written."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the command line reads the words before NumPy is loaded
    from silverball.metrics.statistics import Estimate

ROWS = {
    "seconds_per_ball": ("seconds a ball", "{:.1f}"),
    "median_ball": ("median ball [s]", "{:.1f}"),
    "points_per_minute": ("points a minute in play", "{:,.0f}"),
    "points_per_ball": ("points a ball", "{:,.0f}"),
    "points_per_game": ("points a game", "{:,.0f}"),
    "median_score": ("median score", "{:,.0f}"),
    "hits_per_second": ("hits a second", "{:.2f}"),
    "strikes_per_minute": ("strikes a minute", "{:.1f}"),
    "share_above_half_cap": ("time above half the speed cap", "{:.1%}"),
    "share_time_left": ("time in the left half", "{:.1%}"),
    "share_lost_left": ("balls lost on the left", "{:.1%}"),
    "share_stuck": ("games with a ball stuck over 5 s", "{:.2%}"),
    "share_cut_short": ("games cut short", "{:.1%}"),
}
"""Figures in the order of tables: their words, and the format of the value."""

COMPARED = ("seconds_per_ball", "points_per_minute", "share_lost_left")
"""Figures of which differences between arms are shown."""

MOST_DIGITS = 4  # after the point
NOTHING = "–"


def in_words(one: Estimate, form: str) -> tuple[str, str]:
    """A figure and half of its interval, as "± 0.3", with as many digits as that needs.

    Args:
        one: The figure.
        form: The format of the value, with the fewest digits that it has.
    """
    if not math.isfinite(one.value):
        return NOTHING, ""
    wide = max(one.high - one.value, one.value - one.low)
    if not math.isfinite(wide):
        return form.format(one.value), ""
    while wide > 0.0 and not re.search("[1-9]", form.format(wide)):
        digits = int(form.split(".")[1][0])
        if digits == MOST_DIGITS:
            break
        form = form.replace(f".{digits}", f".{digits + 1}")
    return form.format(one.value), f"± {form.format(wide)}"


def on_one_line(one: Estimate, form: str) -> str:
    """A figure with half of its interval: "75.0 ± 0.3"."""
    return " ".join(in_words(one, form)).strip()
