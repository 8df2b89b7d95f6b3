"""What does a key, a gamepad button or an event of the window bring about?

Some of it is the window's own (help, debug view, full screen, sounds off), the paddle buttons are held here
until the next beat takes them, and all the rest is passed on to the program.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pygame

from silverball.app.controls import (
    MENU_KEYS,
    PADDLES,
    Action,
    Buttons,
    Controls,
    is_command,
    is_latin,
    key_name,
    says_something,
)
from silverball.app.gamepad import Gamepads, PadButton

if TYPE_CHECKING:
    from silverball.app.latency import LatencyMeter
    from silverball.app.messages import Messages
    from silverball.app.program import Program
    from silverball.app.screen import Screen
    from silverball.app.settings import Settings
    from silverball.app.sound import Sounds


class Listener:
    """Answers the events of a window.

    Attributes:
        buttons: The paddle buttons that are held.
        pads: The gamepads.
        controls: Which key does what.
        shows_help: Whether all keys are shown; the game waits meanwhile.
        shows_debug: Whether what the physics sees is shown.
    """

    def __init__(
        self,
        program: Program,
        screen: Screen,
        sounds: Sounds,
        messages: Messages,
        latency: LatencyMeter,
    ) -> None:
        self._program, self._screen, self._sounds = program, screen, sounds
        self._messages, self._latency = messages, latency
        self.buttons = Buttons()
        self.pads = Gamepads()
        self.controls = Controls(program.settings)
        self.shows_help = self.shows_debug = False

    def use(self, settings: Settings) -> None:
        """Other settings were chosen."""
        self.controls = Controls(settings)

    def close(self) -> None:
        """Listen no more."""
        self.pads.close()

    def answer(self, event: pygame.Event) -> None:
        """Answer an event."""
        self._screen.answer(event)
        if event.type == pygame.KEYDOWN:
            self._key_down(event)
        elif event.type == pygame.KEYUP:
            name = key_name(event.key, event.scancode)
            self._release(f"key {name}", self.controls.of_key(name))
            if name in MENU_KEYS:
                self._program.menus.release(MENU_KEYS[name])
        elif event.type == pygame.WINDOWFOCUSLOST and self._screen.owns(event):
            self.buttons.release_all()
            self._program.lose_focus()
        elif event.type in (pygame.QUIT, pygame.WINDOWCLOSE):
            self._program.is_over = True
        for button in self.pads.read(event):
            self._pad(button)

    def _key_down(self, event: pygame.Event) -> None:
        name = key_name(event.key, event.scancode)
        action = self.controls.of_key(name, event.mod)
        menus = self._program.menus
        if menus.wants_key and name != "escape" and not is_command(event.mod):
            self._program.capture(name)
        elif action is not None:
            self._press(f"key {name}", action, again=bool(event.mod & pygame.KMOD_SHIFT))
        elif name in MENU_KEYS and menus.is_open:
            self._program.press_menu(MENU_KEYS[name])
        elif says_something(event.key) and not is_command(event.mod):
            shown = name.upper() if is_latin(event.key) else "this key"
            helps = [key.upper() for key in self.controls.keys(Action.HELP)] or ["the menu"]
            self._messages.say(f"{shown} does nothing here; {helps[0]} shows the keys")

    def _pad(self, button: PadButton) -> None:
        action = self.controls.of_pad(button.name)
        if not button.down:
            self._release(button.source, action)
        elif self._program.menus.wants_pad:
            self._program.capture(button.name)
        elif action is not None:
            self._press(button.source, action)

    def _press(self, source: str, action: Action, *, again: bool = False) -> None:
        program = self._program
        if action is Action.HELP or (self.shows_help and action is Action.BACK):
            self.shows_help = not self.shows_help
            self._messages.clear()
        elif action is Action.DEBUG:
            self.shows_debug = not self.shows_debug
        elif action is Action.FULL_SCREEN:
            self._screen.toggle_full()
        elif action is Action.MUTE:
            program.set(muted=not program.settings.muted)
            self._messages.say("sounds are off" if program.settings.muted else "sounds are on")
        elif action in PADDLES:
            self.buttons.press(source, action)
            if program.is_playing and not self.shows_help:
                self._latency.heard()
            else:
                self.buttons.forget_taps()
            self._pass_on(action)
        elif action is Action.NEW_BOARD and again:
            for shift in ("key left shift", "key right shift"):  # it was meant for R, not for a paddle
                self.buttons.release(shift)
            self._pass_on(action, again=True)
        else:
            self._pass_on(action)

    def _pass_on(self, action: Action, *, again: bool = False) -> None:
        """A button for the game or the menus, which wait while the keys are shown."""
        program = self._program
        if self.shows_help:
            self._messages.say("the game waits while the keys are shown; F1 goes on")
        elif action is Action.SINGLE_TICK:
            program.single_tick(self.buttons.take())
        else:
            was_open, before = program.menus.is_open, program.menus.signature
            program.press(action, again=again)
            if was_open and program.menus.signature != before:
                self._sounds.menu(
                    "move" if action in PADDLES else "back" if action is Action.BACK else "choose"
                )

    def _release(self, source: str, action: Action | None) -> None:
        self.buttons.release(source)
        if action is not None:
            self._program.release(action)
