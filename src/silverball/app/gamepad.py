"""Gamepads and joysticks: which of their buttons go down and come up.

SDL knows the layout of hundreds of gamepads and gives their buttons common names. A trigger is an axis; it
counts as a button that is down while it is pulled more than a third, and a stick as one in each direction.
Devices without a mapping in SDL (arcade encoders, boards of pinball cabinets, old pads) are joysticks: their
buttons are numbered from 1 ("button 5"), and each direction of a hat or an axis is a button too ("hat 1
left", "axis 2 +"). Both kinds may be connected and removed at any time.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import pygame
from pygame._sdl2 import controller

from silverball.app.menus import JoystickEntry
from silverball.plain import plain

TRIGGER_DOWN = 11_000  # of 32,767
TRIGGER_UP = 8_000  # hysteresis against chatter
STICK_DOWN, STICK_UP = 20_000, 10_000  # of 32,767
AXIS_DOWN = 0.6  # share of the way from its rest position to its end
AXIS_UP = 0.4

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
STICK_NAMES = {
    pygame.CONTROLLER_AXIS_LEFTX: ("stick left", "stick right"),
    pygame.CONTROLLER_AXIS_LEFTY: ("stick up", "stick down"),
    pygame.CONTROLLER_AXIS_RIGHTX: ("stick left", "stick right"),
    pygame.CONTROLLER_AXIS_RIGHTY: ("stick up", "stick down"),
}
"""Both sticks of a gamepad nudge: a flick of one is a button that goes down and comes up."""

REMOVED = (pygame.CONTROLLERDEVICEREMOVED, pygame.JOYDEVICEREMOVED)


class PadButton(NamedTuple):
    """A button of a gamepad or joystick that went down or came up.

    Attributes:
        pad: Instance id of the device.
        name: Name of the button, for example "leftshoulder" or "button 5".
        down: Whether it went down.
        kind: The kind of device: "pad", or the GUID of a joystick, as in the settings.
    """

    pad: int
    name: str
    down: bool
    kind: str = "pad"

    @property
    def source(self) -> str:
        """Identifies this button among those of all devices."""
        return f"pad {self.pad} {self.name}"


class _Joystick:
    """A connected joystick, and the rest positions of its axes."""

    def __init__(self, device: Any) -> None:
        self.device = device
        self.entry = JoystickEntry(
            device.get_guid(), plain(device.get_name()).strip() or "JOYSTICK", device.get_numbuttons()
        )
        self._rests: dict[int, int] = {}

    def directions(self, axis: int, value: float) -> Iterator[tuple[str, bool | None]]:
        """Yield the buttons of an axis, and whether they are down; None: unchanged."""
        if axis not in self._rests:  # the first event gives the rest position, which a pedal has at one end
            self._rests[axis] = round(value)
        for sign, direction in (("-", -1), ("+", 1)):
            if self._rests[axis] == direction:
                continue
            fraction = direction * (value - self._rests[axis]) / (1 + abs(self._rests[axis]))
            yield (
                f"axis {axis + 1} {sign}",
                True if fraction >= AXIS_DOWN else False if fraction <= AXIS_UP else None,
            )


class Gamepads:
    """All connected gamepads and joysticks."""

    def __init__(self) -> None:
        self._pads: dict[int, Any] = {}
        self._joysticks: dict[int, _Joystick] = {}
        self._down: dict[tuple[int, str], PadButton] = {}
        with contextlib.suppress(pygame.error):  # the game also works without gamepads
            controller.init()
            pygame.joystick.init()

    @property
    def joysticks(self) -> tuple[JoystickEntry, ...]:
        """The connected joysticks, one per make."""
        return tuple({stick.entry.guid: stick.entry for stick in self._joysticks.values()}.values())

    def read(self, event: pygame.Event) -> Iterator[PadButton]:
        """Yield the buttons that an event of SDL changes; most events change none."""
        for button in self._read(event):
            key = (button.pad, button.name)
            if button.down:
                self._down[key] = button
            else:
                self._down.pop(key, None)
            yield button
        if event.type in REMOVED:
            self._pads.pop(event.instance_id, None)
            self._joysticks.pop(event.instance_id, None)

    def _read(self, event: pygame.Event) -> Iterator[PadButton]:
        if event.type in (pygame.CONTROLLERBUTTONDOWN, pygame.CONTROLLERBUTTONUP):
            name = BUTTON_NAMES.get(event.button)
            if name is not None:
                yield PadButton(event.instance_id, name, event.type == pygame.CONTROLLERBUTTONDOWN)
        elif event.type == pygame.CONTROLLERAXISMOTION:
            yield from self._read_trigger(event)
            yield from self._read_stick(event)
        elif event.type == pygame.CONTROLLERDEVICEADDED:
            self._connect(event.device_index)
        elif event.type == pygame.JOYDEVICEADDED:
            self._connect_joystick(event.device_index)
        elif event.type in REMOVED:
            held = [button for button in self._down.values() if button.pad == event.instance_id]
            yield from (button._replace(down=False) for button in held)
        elif getattr(event, "instance_id", None) in self._joysticks:
            yield from self._read_joystick(event, self._joysticks[event.instance_id])

    def rumble(self, strength: float, seconds: float) -> None:
        """Rumble all gamepads that support it, with a strength from 0 to 1."""
        for pad in self._pads.values():
            with contextlib.suppress(pygame.error, AttributeError):
                pad.rumble(strength, strength, round(1000 * seconds))

    def close(self) -> None:
        """Close all gamepads and joysticks."""
        self._pads.clear()
        self._joysticks.clear()
        with contextlib.suppress(pygame.error):
            controller.quit()
            pygame.joystick.quit()

    def _read_trigger(self, event: pygame.Event) -> Iterator[PadButton]:
        name = TRIGGER_NAMES.get(event.axis)
        if name is None:
            return
        is_down = (event.instance_id, name) in self._down
        if event.value >= TRIGGER_DOWN and not is_down:
            yield PadButton(event.instance_id, name, True)
        elif event.value <= TRIGGER_UP and is_down:
            yield PadButton(event.instance_id, name, False)

    def _read_stick(self, event: pygame.Event) -> Iterator[PadButton]:
        for sign, name in zip((-1, 1), STICK_NAMES.get(event.axis, ()), strict=False):
            is_down = (event.instance_id, name) in self._down
            if sign * event.value >= STICK_DOWN and not is_down:
                yield PadButton(event.instance_id, name, True)
            elif sign * event.value <= STICK_UP and is_down:
                yield PadButton(event.instance_id, name, False)

    def _read_joystick(self, event: pygame.Event, joystick: _Joystick) -> Iterator[PadButton]:
        pad, kind = event.instance_id, joystick.entry.guid
        states: Iterable[tuple[str, bool | None]] = ()
        if event.type in (pygame.JOYBUTTONDOWN, pygame.JOYBUTTONUP):
            states = ((f"button {event.button + 1}", event.type == pygame.JOYBUTTONDOWN),)
        elif event.type == pygame.JOYHATMOTION:
            x, y = event.value
            directions = {"left": x < 0, "right": x > 0, "up": y > 0, "down": y < 0}
            states = ((f"hat {event.hat + 1} {direction}", down) for direction, down in directions.items())
        elif event.type == pygame.JOYAXISMOTION:
            states = joystick.directions(event.axis, event.value)
        for name, down in states:
            if down is not None and down is not ((pad, name) in self._down):
                yield PadButton(pad, name, down, kind)

    def _connect(self, index: int) -> None:
        with contextlib.suppress(pygame.error):
            pad = controller.Controller(index)
            self._pads[pad.as_joystick().get_instance_id()] = pad

    def _connect_joystick(self, index: int) -> None:
        with contextlib.suppress(pygame.error):
            if not controller.is_controller(index):
                device = pygame.joystick.Joystick(index)
                self._joysticks[device.get_instance_id()] = _Joystick(device)
