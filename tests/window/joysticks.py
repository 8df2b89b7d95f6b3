"""Virtual gamepads and joysticks of SDL."""

from __future__ import annotations

import ctypes

import pygame

UNKNOWN, GAMEPAD = 0, 1
"""SDL's types: one that it has no names for, and one that it has."""


class VirtualJoystick:
    """A device with buttons, axes and hats.

    Args:
        kind: `UNKNOWN` or `GAMEPAD`.
        axes: How many.
        buttons: How many.
        hats: How many.
        title: As its maker calls it.
    """

    def __init__(self, kind: int, axes: int, buttons: int, hats: int = 0, title: str | None = None) -> None:
        self._sdl = ctypes.CDLL(pygame.base.__file__)
        self._sdl.SDL_JoystickOpen.restype = ctypes.c_void_p
        self._sdl.SDL_JoystickSetVirtualButton.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8)
        self._sdl.SDL_JoystickSetVirtualAxis.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_int16)
        self._sdl.SDL_JoystickSetVirtualHat.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8)
        if title is None:
            self.number = self._sdl.SDL_JoystickAttachVirtual(kind, axes, buttons, hats)
        else:
            told = _Description(1, kind, axes, buttons, hats, name=title.encode())
            self.number = self._sdl.SDL_JoystickAttachVirtualEx(ctypes.byref(told))
        assert self.number >= 0
        self._handle = self._sdl.SDL_JoystickOpen(self.number)
        self._instance = self._sdl.SDL_JoystickInstanceID(ctypes.c_void_p(self._handle))

    def button(self, number: int, down: bool) -> None:
        self._sdl.SDL_JoystickSetVirtualButton(self._handle, number, down)

    def axis(self, number: int, value: int) -> None:
        self._sdl.SDL_JoystickSetVirtualAxis(self._handle, number, value)

    def hat(self, number: int, value: int) -> None:
        self._sdl.SDL_JoystickSetVirtualHat(self._handle, number, value)

    def pull_out(self) -> None:
        for number in range(self._sdl.SDL_NumJoysticks()):
            if self._sdl.SDL_JoystickGetDeviceInstanceID(number) == self._instance:
                self._sdl.SDL_JoystickDetachVirtual(number)
                return


class _Description(ctypes.Structure):
    """SDL_VirtualJoystickDesc."""

    _fields_ = (
        ("version", ctypes.c_uint16), ("type", ctypes.c_uint16), ("axes", ctypes.c_uint16),
        ("buttons", ctypes.c_uint16), ("hats", ctypes.c_uint16), ("vendor", ctypes.c_uint16),
        ("product", ctypes.c_uint16), ("padding", ctypes.c_uint16), ("button_mask", ctypes.c_uint32),
        ("axis_mask", ctypes.c_uint32), ("name", ctypes.c_char_p), ("userdata", ctypes.c_void_p),
        ("update", ctypes.c_void_p), ("set_player", ctypes.c_void_p), ("rumble", ctypes.c_void_p),
        ("rumble_triggers", ctypes.c_void_p), ("led", ctypes.c_void_p), ("effect", ctypes.c_void_p),
    )  # fmt: skip
