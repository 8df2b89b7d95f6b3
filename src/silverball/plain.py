"""How is text from outside shown without being obeyed?

A table file, a replay, a score or a file name may hold characters that steer a terminal (C0, C1), turn the
direction of writing round (bidi marks), break a line or cannot be encoded at all (half a surrogate pair).
Whoever prints such text, or puts it into a title or a page, passes it through here first.
"""

from __future__ import annotations

import unicodedata

_OBEYED = frozenset(
    {"Cc", "Cf", "Cs", "Zl", "Zp"}
)  # control, format, surrogate, line and paragraph separator


def plain(text: str, keep: str = "") -> str:
    """The text with every character that would be obeyed instead of shown written as its escape.

    Args:
        text: From a file, a database or the command line.
        keep: Characters that stay as they are, such as the line feed in a message of several lines.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        character
        if character in keep or unicodedata.category(character) not in _OBEYED
        else _escape(character)
        for character in text
    )


def _escape(character: str) -> str:
    """How Python writes a character in ASCII, as in x1b, u202e or U000e0001 behind a backslash."""
    return character.encode("unicode_escape", "surrogatepass").decode("ascii")
