"""The daily board: a seed that is the date, so that everybody plays the same board on the same day.

A daily list holds the scores of that seed on a table; they count in the table's list as well. Nothing but the
seed makes a game a daily one, and a score's replay proves its seed. Seeds that the program draws are smaller.
"""

from __future__ import annotations

from datetime import date

FIRST_YEAR = 2000  # seeds that the program draws are below its dates


def daily_seed(day: date) -> int:
    """The seed of a day, its date as a number.

    Examples:
        >>> from datetime import date
        >>> daily_seed(date(2026, 11, 29))
        20261129
    """
    return day.year * 10_000 + day.month * 100 + day.day


def day_of(seed: int) -> date | None:
    """The day of a daily seed; None if the seed is of no day from the year 2000 on."""
    try:
        day = date(seed // 10_000, seed // 100 % 100, seed % 100)
    except (ValueError, OverflowError):
        return None
    return day if day.year >= FIRST_YEAR else None
