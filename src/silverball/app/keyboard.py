"""Which key of the keyboard is meant by a name, on whatever layout is in use?

Settings name keys by what a US keyboard prints on them ("a", ",", "left shift"; those that it lacks by their
own character, as "é"). A name means the key that bears it without Shift on the layout in use. Where no key
bears it, as "." on a French keyboard or "a" on a Russian one, it means the key at its place on a US keyboard.
Shift is a paddle, so it changes nothing; only a sign that the layout has nowhere else may be typed with it.
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
    character: first + place
    for first, characters in (
        (pygame.KSCAN_A, "abcdefghijklmnopqrstuvwxyz1234567890"),
        (pygame.KSCAN_MINUS, "-=[]\\"),
        (pygame.KSCAN_SEMICOLON, ";'`,./"),
    )
    for place, character in enumerate(characters)
} | {"space": pygame.KSCAN_SPACE}
"""Where a US keyboard has its signs, as SDL numbers places."""
US_LABELS = {place: character for character, place in US_SCANCODES.items()}

WITH_SHIFT = {";": ".", ".": ","}
"""What keys bear with Shift if the layout has it nowhere else: "." on AZERTY, "," on Cyrillic ones.

Source: the layouts of xkeyboard-config 2.35.
"""

_LETTERS = frozenset(
    (*string.ascii_lowercase, *string.digits, ".", "-", "space", *map("[{}]".format, range(10)))
)
"""Initials are made of them; those in brackets are on the keypad."""

_PLACES = range(pygame.KSCAN_A, 232)  # up to the right Meta key, the last one that has a place


class KeyEvent(Protocol):
    """What is needed of pygame's KEYDOWN."""

    key: int
    scancode: int
    mod: int


class Keyboard:
    """The keyboard with the layout that is in use; SDL is asked for it."""

    def __init__(self) -> None:
        self._labels: dict[int, str] = {}  # what a key bears, by its place
        self.read()

    def read(self) -> None:
        """The layout may be another one now."""
        keys = {place: sdl.keycode_at(place) for place in _PLACES}
        self._labels = {place: name for place, key in keys.items() if key and (name := key_label(key, place))}

    def hear(self, event: KeyEvent) -> bool:
        """Learn from a key press; returns whether the layout is another one than it was."""
        name = key_label(event.key, event.scancode)
        if not self._labels or not event.scancode or self._labels.get(event.scancode) == name:
            return False
        self.read()
        self._labels[event.scancode] = name  # an event is never out of date
        return True

    def meant(self, event: KeyEvent, names: Iterable[str]) -> str:
        """Which one of some names a key press means; empty if none."""
        names = set(names)
        name = key_label(event.key, event.scancode)
        if event.mod & pygame.KMOD_SHIFT:
            typed = WITH_SHIFT.get(name, "")
            if typed in names and typed not in self._labels.values():
                return typed
        if event.scancode in self._labels:
            return self._meanings(names).get(event.scancode, "")
        # A program made the press up, as an on-screen keyboard does, or SDL cannot be asked.
        if name not in names and not name.isascii():
            name = US_LABELS.get(event.scancode, "")
        return name if name in names else ""

    def letter(self, event: KeyEvent) -> str:
        """The capital, digit, full stop, hyphen or space that a key press types; empty if none of these."""
        name = self.meant(event, _LETTERS).strip("[]")
        return " " if name == "space" else name.upper()

    def name_of(self, event: KeyEvent) -> str:
        """The name to keep for a key that has none yet; empty if there is nothing to tell it by."""
        name, sign = key_label(event.key, event.scancode), US_LABELS.get(event.scancode, "")
        if len(name) > 1 or name in US_SCANCODES or sign in self._labels.values():
            return name
        return sign or name

    def labels(self, names: Iterable[str]) -> dict[str, str]:
        """What stands on the keys that are meant by some names, where that is something else.

        Where there is no font for it, it is the sign of a US keyboard: such keyboards bear that too, unless
        it stands on another key.
        """
        labels = {}
        for place, name in self._meanings(set(names)).items():
            label = self._labels.get(place, name)
            if not can_show(label):
                sign = US_LABELS.get(place, name)
                label = name if sign in self._labels.values() else sign
            if name not in (label, "space"):
                labels[name] = label
        return labels

    def _meanings(self, names: set[str]) -> dict[int, str]:
        """The names that keys have, by their places."""
        meanings = {place: name for place, name in self._labels.items() if name in names}
        for name in sorted(names - set(meanings.values())):
            place = US_SCANCODES.get(name, 0)
            for _ in US_SCANCODES:  # a place whose own sign is meant gives way to that sign's place
                if place not in meanings:
                    break
                place = US_SCANCODES.get(self._labels.get(place, ""), 0)
            if place and place not in meanings:
                sign = self._labels.get(place)
                meanings |= {other: name for other in self._labels if self._labels[other] == sign}
                meanings[place] = name
        return meanings


def key_label(key: int, scancode: int) -> str:
    """What stands on a key, as pygame names it; a sign that pygame has no name for names itself.

    Args:
        key: What it bears, as pygame's number.
        scancode: Where it lies. It tells what a key does that only changes the next one, as an accent.
    """
    name = pygame.key.name(key)
    if not name and 32 < key <= sys.maxunicode and chr(key).isprintable():
        name = chr(key)
    return name or US_LABELS.get(scancode, "")
