"""When was that, for people? In their own time zone."""

from __future__ import annotations

from datetime import datetime


def local(when: datetime, form: str) -> str:
    """A moment as text.

    Args:
        when: With its time zone.
        form: As for `datetime.strftime`.
    """
    try:
        return f"{when.astimezone():{form}}"
    except (OverflowError, ValueError, OSError):  # within a day of the first or the last that Python knows
        return f"{when:{form}}"
