"""Names that want to be obeyed instead of shown, and how a test knows that none of them was."""

from __future__ import annotations

import os
import unicodedata

OBEYED = ("Cc", "Cf", "Cs", "Zl", "Zp")

NAMES = {
    **{f"C0-{code:02x}": f"a{chr(code)}b" for code in (*range(1, 9), *range(10, 32))},
    "delete": "a\x7fb",
    **{f"C1-{code:02x}": f"a{chr(code)}31mb" for code in range(0x80, 0xA0)},
    "red": "\x1b[31mred",
    "title": "\x1b]0;pwned\x07",
    "cursor up": "\x1b[2A\x1b[2K",
    "C1 red": "\x9b31mred",
    "line over line": "good\rbad",
    "second line": "x: 1 problem\n  all is well",
    "next line": "a\x85b",
    "line separator": "a\u2028b\u2029c",
    **{f"bidi-{code:04x}": f"a{chr(code)}b" for code in (*range(0x202A, 0x202F), *range(0x2066, 0x206A))},
    **{f"mark-{code:04x}": f"a{chr(code)}b" for code in (0x061C, 0x200E, 0x200F, 0x00AD)},
    "no width": "a\u200bb\u200cc\u200dd\u2060e\ufefff",
    "tags": "a\U000e0001\U000e0041b",
    "selector": "\ufe0f",
    "selectors": "a\ufe0fb\U000e0100\u034f",
    "pile": "a" + "\u0301" * 30,
    "markup": "[red]x[/red]",
    "markup end": "[/]",
    "markup link": "[link=https://example.org]x[/link]",
    "markup open": "[bold",
    "markup action": "[@click=app.bell]x",
    "emoji": ":warning:",
    "braces": "{0}{name}{",
    "percent": "%s%n%",
    "quotes": "\"'`$(id)",
    "backslash": "a\\[red]\\",
}
"""By what they try. All can stand in a TOML string (the zero character is in no file name)."""

FEW = ("red", "C1 red", "second line", "bidi-202e", "delete", "markup", "markup end", "tags")
"""One of each kind, for what takes long."""

NO_TEXT = os.fsdecode(b"caf\xe9\xff\x9b31m")
"""The name of a file in bytes that are no UTF-8."""


def obeyed_in(text: str) -> set[str]:
    """The characters of a text that a terminal would obey, the ends of its lines apart."""
    return {letter for letter in text if letter != "\n" and unicodedata.category(letter) in OBEYED}


def toml_string(text: str) -> str:
    """A text as TOML writes it, in ASCII."""
    return '"' + "".join(f"\\U{ord(letter):08x}" for letter in text) + '"'
