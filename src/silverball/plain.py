"""Escaping of untrusted text: control characters are shown instead of obeyed.

A table file, a replay, a score or a file name may contain characters that control a terminal (C0, C1),
reverse the direction of writing (bidi marks), break a line, or cannot be encoded (half a surrogate pair).
Such text passes through `plain` before it is printed or put into a title or a page.
"""

from __future__ import annotations

import unicodedata

_CONTROL_CATEGORIES = frozenset(
    {"Cc", "Cf", "Cs", "Zl", "Zp"}
)  # control, format, surrogate, line and paragraph separator


def plain(text: str, keep: str = "") -> str:
    """Replace every control character of a text by its escape.

    Args:
        text: Text from a file, a database or the command line.
        keep: Characters that stay as they are, for example the line feed in a message of several lines.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        character
        if character in keep or unicodedata.category(character) not in _CONTROL_CATEGORIES
        else _escape(character)
        for character in text
    )


def _escape(character: str) -> str:
    """The escape of a character in Python: a backslash with x1b, u202e or U000e0001."""
    return character.encode("unicode_escape", "surrogatepass").decode("ascii")
