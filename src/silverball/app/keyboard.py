"""Resolves key presses to the key names of the settings, on any keyboard layout.

Settings name keys by the labels of a US keyboard ("a", ",", "left shift"); other characters, like "é", name
themselves. A name means the key with that label on the current layout, without Shift. If no key has the label
("." on a French keyboard, "a" on a Russian one), it means the key with the scancode that a US keyboard has
for it. Shift is a paddle button, so it is ignored, except for characters that the layout has only with Shift.
"""

from __future__ import annotations

import string
import sys
from collections.abc import Iterable
from typing import Protocol

import pygame

from silverball.app import sdl
from silverball.drawing.text import can_show

US_SCANCODES: dict[str, int] = {
    character: first + scancode
    for first, characters in (
        (pygame.KSCAN_A, "abcdefghijklmnopqrstuvwxyz1234567890"),
        (pygame.KSCAN_MINUS, "-=[]\\"),
        (pygame.KSCAN_SEMICOLON, ";'`,./"),
    )
    for scancode, character in enumerate(characters)
} | {"space": pygame.KSCAN_SPACE}
"""The scancodes of characters on a US keyboard."""
US_LABELS = {scancode: character for character, scancode in US_SCANCODES.items()}

WITH_SHIFT = {";": ".", ".": ","}
"""Characters typed with Shift on layouts that have no key for them: "." on AZERTY, "," on Cyrillic ones.

Source: the layouts of xkeyboard-config 2.35.
"""

_INITIALS_KEYS = frozenset(
    (*string.ascii_lowercase, *string.digits, ".", "-", "space", *map("[{}]".format, range(10)))
)
"""Keys for initials; names in brackets are on the keypad."""

_SCANCODES = range(pygame.KSCAN_A, 232)  # up to the right Meta key, the last key of a keyboard


class KeyEvent(Protocol):
    """The attributes of KEYDOWN that are used."""

    key: int
    scancode: int
    mod: int


class Keyboard:
    """The keyboard with its current layout, which is read from SDL."""

    def __init__(self) -> None:
        self._labels: dict[int, str] = {}  # key labels by scancode
        self.read_layout()

    def read_layout(self) -> None:
        """Read the current layout."""
        keys = {scancode: sdl.keycode_at(scancode) for scancode in _SCANCODES}
        self._labels = {
            scancode: name for scancode, key in keys.items() if key and (name := key_label(key, scancode))
        }

    def learn(self, event: KeyEvent) -> bool:
        """Learn from a key press; return whether the layout has changed."""
        name = key_label(event.key, event.scancode)
        if not self._labels or not event.scancode or self._labels.get(event.scancode) == name:
            return False
        self.read_layout()
        self._labels[event.scancode] = name  # SDL may be out of date; an event never is
        return True

    def resolve(self, event: KeyEvent, names: Iterable[str]) -> str:
        """Return the name, among `names`, of a pressed key; empty if it is none of them."""
        names = set(names)
        name = key_label(event.key, event.scancode)
        if event.mod & pygame.KMOD_SHIFT:
            typed = WITH_SHIFT.get(name, "")
            if typed in names and typed not in self._labels.values():
                return typed
        if event.scancode in self._labels:
            return self._names_by_scancode(names).get(event.scancode, "")
        # A program such as an on-screen keyboard generated the press, or SDL is not available.
        if name not in names and not name.isascii():
            name = US_LABELS.get(event.scancode, "")
        return name if name in names else ""

    def letter(self, event: KeyEvent) -> str:
        """Return the capital, digit, full stop, hyphen or space that a key press types; otherwise empty."""
        name = self.resolve(event, _INITIALS_KEYS).strip("[]")
        return " " if name == "space" else name.upper()

    def new_name(self, event: KeyEvent) -> str:
        """Return a name for a key that is not bound yet; empty if it cannot be identified."""
        name, us_label = key_label(event.key, event.scancode), US_LABELS.get(event.scancode, "")
        if len(name) > 1 or name in US_SCANCODES or us_label in self._labels.values():
            return name
        return us_label or name

    def labels(self, names: Iterable[str]) -> dict[str, str]:
        """Return the labels of the keys that some names mean, where they differ from the names.

        A label that the fonts lack, or that keys of several names have, is replaced by that of a US keyboard,
        which such keyboards show as well, unless another key has it.
        """
        labels = {}
        names_by_scancode = self._names_by_scancode(set(names))
        for scancode, name in names_by_scancode.items():
            label = self._labels.get(scancode, name)
            same = {other for key, other in names_by_scancode.items() if self._labels.get(key) == label}
            if len(same) > 1 or not can_show(label):
                us_label = US_LABELS.get(scancode, name)
                label = name if us_label in self._labels.values() else us_label
            if name not in (label, "space"):
                labels[name] = label
        return labels

    def _names_by_scancode(self, names: set[str]) -> dict[int, str]:
        """Return the names by the scancodes of the keys that they mean."""
        found = {scancode: name for scancode, name in self._labels.items() if name in names}
        for name in sorted(names - set(found.values())):
            scancode = US_SCANCODES.get(name, 0)
            # A key that has a name by its own label is taken: try the US scancode of that label.
            for _ in US_SCANCODES:
                if scancode not in found:
                    break
                scancode = US_SCANCODES.get(self._labels.get(scancode, ""), 0)
            if scancode and scancode not in found:
                same = [other for other, label in self._labels.items() if label == self._labels.get(scancode)]
                # Of several keys with one label, those whose place is another name's own are left to it.
                found |= {other: name for other in same if US_LABELS.get(other, name) not in names - {name}}
                found[scancode] = name
        return found


def key_label(key: int, scancode: int) -> str:
    """Return the label of a key: its name in pygame, or else the character itself.

    Args:
        key: Its key code.
        scancode: Its scancode, for dead keys, which have no character.
    """
    name = pygame.key.name(key)
    if not name and 32 < key <= sys.maxunicode and chr(key).isprintable():
        name = chr(key)
    return name or US_LABELS.get(scancode, "")
