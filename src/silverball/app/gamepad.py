"""Which gamepad buttons go down and come up? One name a button, whatever the maker printed on it.

SDL knows the layout of hundreds of gamepads and gives their buttons common names. A trigger is an axis; it
counts as a button that is down while it is pulled more than a third. Pads may come and go at any time.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import pygame
from pygame._sdl2 import controller

TRIGGER_DOWN = 11_000  # of 32,767
TRIGGER_UP = 8_000  # lower, so that a trembling finger does not chatter

BUTTON_NAMES = {
    pygame.CONTROLLER_BUTTON_A: "a",
    pygame.CONTROLLER_BUTTON_B: "b",
    pygame.CONTROLLER_BUTTON_X: "x",
    pygame.CONTROLLER_BUTTON_Y: "y",
    pygame.CONTROLLER_BUTTON_BACK: "back",
    pygame.CONTROLLER_BUTTON_GUIDE: "guide",
    pygame.CONTROLLER_BUTTON_START: "start",
    pygame.CONTROLLER_BUTTON_LEFTSTICK: "leftstick",
    pygame.CONTROLLER_BUTTON_RIGHTSTICK: "rightstick",
    pygame.CONTROLLER_BUTTON_LEFTSHOULDER: "leftshoulder",
    pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: "rightshoulder",
    pygame.CONTROLLER_BUTTON_DPAD_UP: "dpup",
    pygame.CONTROLLER_BUTTON_DPAD_DOWN: "dpdown",
    pygame.CONTROLLER_BUTTON_DPAD_LEFT: "dpleft",
    pygame.CONTROLLER_BUTTON_DPAD_RIGHT: "dpright",
}
TRIGGER_NAMES = {
    pygame.CONTROLLER_AXIS_TRIGGERLEFT: "lefttrigger",
    pygame.CONTROLLER_AXIS_TRIGGERRIGHT: "righttrigger",
}


class PadButton(NamedTuple):
    """A gamepad button that went down or came up.

    Attributes:
        pad: Which gamepad.
        name: Which button, for example "leftshoulder".
        down: Whether it went down.
    """

    pad: int
    name: str
    down: bool

    @property
    def source(self) -> str:
        """What tells this button from all others."""
        return f"pad {self.pad} {self.name}"


class Gamepads:
    """All gamepads that are plugged in."""

    def __init__(self) -> None:
        self._pads: dict[int, Any] = {}
        self._pulled: set[tuple[int, str]] = set()
        with contextlib.suppress(pygame.error):  # a game without gamepads is a game too
            controller.init()

    def read(self, event: pygame.Event) -> Iterator[PadButton]:
        """The buttons that an event of SDL is about; most are about none."""
        if event.type in (pygame.CONTROLLERBUTTONDOWN, pygame.CONTROLLERBUTTONUP):
            name = BUTTON_NAMES.get(event.button)
            if name is not None:
                yield PadButton(event.instance_id, name, event.type == pygame.CONTROLLERBUTTONDOWN)
        elif event.type == pygame.CONTROLLERAXISMOTION:
            yield from self._read_trigger(event)
        elif event.type == pygame.CONTROLLERDEVICEADDED:
            self._plug_in(event.device_index)
        elif event.type == pygame.CONTROLLERDEVICEREMOVED:
            self._pads.pop(event.instance_id, None)
            for pad, name in [pulled for pulled in self._pulled if pulled[0] == event.instance_id]:
                self._pulled.discard((pad, name))
                yield PadButton(pad, name, False)

    def rumble(self, strength: float, seconds: float) -> None:
        """Let all gamepads rumble, 0 to 1; those that cannot do not."""
        for pad in self._pads.values():
            with contextlib.suppress(pygame.error, AttributeError):
                pad.rumble(strength, strength, round(1000 * seconds))

    def close(self) -> None:
        """Forget all gamepads."""
        self._pads.clear()
        with contextlib.suppress(pygame.error):
            controller.quit()

    def _read_trigger(self, event: pygame.Event) -> Iterator[PadButton]:
        name = TRIGGER_NAMES.get(event.axis)
        if name is None:
            return
        trigger = (event.instance_id, name)
        if event.value >= TRIGGER_DOWN and trigger not in self._pulled:
            self._pulled.add(trigger)
            yield PadButton(*trigger, True)
        elif event.value <= TRIGGER_UP and trigger in self._pulled:
            self._pulled.discard(trigger)
            yield PadButton(*trigger, False)

    def _plug_in(self, index: int) -> None:
        with contextlib.suppress(pygame.error):
            pad = controller.Controller(index)
            self._pads[pad.as_joystick().get_instance_id()] = pad
