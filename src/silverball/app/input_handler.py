"""What does a key, a gamepad button or an event of the window bring about?

Some of it is the window's own (help, debug view, full screen, sounds off), the paddle buttons are held here
until the next beat takes them, and all the rest is passed on to the program. A key that comes up ends what it
began when it went down, even if the layout or the settings have changed since.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pygame

from silverball.app.controls import (
    MENU_KEYS,
    PADDLES,
    Action,
    Controls,
    PaddleButtons,
    is_command,
    says_something,
)
from silverball.app.gamepad import REMOVED, Gamepads, PadButton
from silverball.app.keyboard import Keyboard, key_label
from silverball.app.menus import Button, capital
from silverball.app.overlay import HELP_PAGES
from silverball.drawing.text import can_show

if TYPE_CHECKING:
    from silverball.app.overlay import Messages
    from silverball.app.program import Program
    from silverball.app.screen import Screen
    from silverball.app.settings import Settings
    from silverball.app.sound import Sounds
    from silverball.app.timing import LatencyMeter


_SHIFTS = ("left shift", "right shift")


class _Pressed(NamedTuple):
    """A key that is down."""

    name: str
    action: Action | None = None
    menu: Button | None = None


class InputHandler:
    """Answers the events of a window.

    Attributes:
        buttons: The paddle buttons that are held.
        gamepads: The gamepads and joysticks.
        keyboard: The keyboard.
        controls: Which key does what.
        shows_help: Whether the help is shown; the game waits meanwhile.
        help_page: Which page of it: the keys, or how to score.
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
        self.buttons = PaddleButtons()
        self.gamepads = Gamepads()
        self.keyboard = Keyboard()
        self._keys: dict[int, _Pressed] = {}  # that are down, by their places
        self._played_with: set[int] = set()  # gamepads used since the last paddle key
        self.shows_help = self.shows_debug = False
        self.help_page = 0
        self.use(program.settings)

    def use(self, settings: Settings) -> None:
        """Other settings were chosen."""
        self.controls = Controls(settings)
        self._know_labels()

    def close(self) -> None:
        """Listen no more."""
        self.gamepads.close()

    def answer(self, event: pygame.Event) -> None:
        """Answer an event."""
        self._screen.answer(event)
        if event.type == pygame.KEYDOWN:
            self._key_down(event)
        elif event.type == pygame.KEYUP:
            self._key_up(event)
        elif event.type == pygame.KEYMAPCHANGED:
            self.keyboard.read()
            self._know_labels()
        elif event.type == pygame.WINDOWFOCUSLOST and self._screen.owns(event):
            self._keys.clear()
            self.buttons.release_all()
            self._program.lose_focus()
        elif event.type in (pygame.QUIT, pygame.WINDOWCLOSE):
            self._program.is_over = True
        for button in self.gamepads.read(event):
            self._pad(button)
        if event.type in REMOVED or event.type == pygame.JOYDEVICEADDED:
            self._devices_changed(event)

    def _know_labels(self) -> None:
        """The layout of the keyboard or the choice of keys is another one."""
        self.controls.labels = self.keyboard.labels(self.controls.key_names)
        self._program.menus.know(labels=self.controls.labels)

    def _key_down(self, event: pygame.Event) -> None:
        if self.keyboard.hear(event):
            self._know_labels()
        name = self.keyboard.meant(event, self.controls.key_names.union(MENU_KEYS))
        action = self.controls.of_key(name, event.mod)
        menus = self._program.menus
        place = event.scancode or event.key
        if menus.wants_key and name != "escape" and not is_command(event.mod):
            self._program.capture(name or self.keyboard.name_of(event))
        elif menus.wants_text and self._typed(event, action):
            self._sounds.menu("back" if name == "backspace" else "choose")
        elif action is not None:
            self._keys[place] = _Pressed(name, action)
            if action in PADDLES:
                self._played_with.clear()
            self._press(f"key {place}", action, again=bool(event.mod & pygame.KMOD_SHIFT))
        elif name in MENU_KEYS and self.shows_help:
            self._turn_help()
        elif name in MENU_KEYS and menus.is_open:
            self._keys[place] = _Pressed(name, menu=MENU_KEYS[name])
            self._program.press_menu(MENU_KEYS[name])
        elif says_something(event.key) and not is_command(event.mod):
            label = key_label(event.key, event.scancode)
            self._say_nothing_done(capital(label) if can_show(label) else "this key")

    def _key_up(self, event: pygame.Event) -> None:
        place = event.scancode or event.key
        pressed = self._keys.pop(place, None)
        if pressed is not None:
            self._release(f"key {place}", pressed.action)
            if pressed.menu is not None:
                self._program.menus.release(pressed.menu)

    def _say_nothing_done(self, what: str) -> None:
        helps = [capital(key) for key in self.controls.shown_keys(Action.HELP)] or ["the menu"]
        self._messages.say(f"{what} does nothing here; {helps[0]} shows the keys")

    def _typed(self, event: pygame.Event, action: Action | None) -> bool:
        """Whether a key was a letter of what is being entered; the page knows whose A and D are."""
        if self.shows_help or is_command(event.mod):
            return False
        is_button = action in (*PADDLES, Action.CREATE)
        letter = self.keyboard.letter(event) or event.unicode  # typing is off: an input method would keep it
        return self._program.menus.type(letter, self.keyboard.name_of(event), is_button=is_button)

    def _pad(self, button: PadButton) -> None:
        action = self.controls.of_pad(button.name, button.kind)
        if not button.down:
            self._release(button.source, action)
        elif self._program.menus.wants_pad:
            self._program.capture(button.name, button.kind)
        elif action is not None:
            self._played_with.add(button.pad)
            self._press(button.source, action)
        elif button.name.startswith("button"):
            self._messages.say(f"{button.name} does nothing here; settings, gamepad, can change that")

    def _devices_changed(self, event: pygame.Event) -> None:
        """A gamepad or joystick has come or gone."""
        self._program.menus.know(joysticks=self.gamepads.joysticks)
        if event.type in REMOVED and event.instance_id in self._played_with:
            self._played_with.discard(event.instance_id)
            self._program.lose_gamepad("the gamepad")

    def _press(self, source: str, action: Action, *, again: bool = False) -> None:
        program = self._program
        if action is Action.HELP or (self.shows_help and action is Action.BACK):
            self.shows_help = not self.shows_help
            self.help_page = 0
            self._messages.clear()
        elif action is Action.DEBUG:
            self.shows_debug = not self.shows_debug
        elif action is Action.FULL_SCREEN:
            self._screen.toggle_fullscreen()
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
            for place, pressed in self._keys.items():
                if pressed.name in _SHIFTS:  # it was meant for R, not for a paddle
                    self.buttons.release(f"key {place}")
            self._pass_on(action, again=True)
        else:
            self._pass_on(action)

    def _pass_on(self, action: Action, *, again: bool = False) -> None:
        """A button for the game or the menus, which wait while the help is shown."""
        program = self._program
        if self.shows_help:
            self._press_in_help(action)
        elif action is Action.SINGLE_TICK:
            program.single_tick(self.buttons.take())
        else:
            was_open, before = program.menus.is_open, program.menus.signature
            program.press(action, again=again)
            if was_open and program.menus.signature != before:
                self._sounds.menu(
                    "move" if action in PADDLES else "back" if action is Action.BACK else "choose"
                )

    def _press_in_help(self, action: Action) -> None:
        """The paddles and Space turn the pages of the help; whoever wants to play is told how to go on."""
        if action in (*PADDLES, Action.CREATE):
            self._turn_help()
        helps = [capital(key) for key in self.controls.shown_keys(Action.HELP)] or ["Esc"]
        if self._program.has_game and action not in PADDLES:
            self._messages.say(f"the game waits while the help is shown; {helps[0]} goes on")
        elif action not in (*PADDLES, Action.CREATE):
            self._messages.say(f"{helps[0]} leaves the help")

    def _turn_help(self) -> None:
        self.help_page = (self.help_page + 1) % HELP_PAGES
        self._sounds.menu("move")

    def _release(self, source: str, action: Action | None) -> None:
        self.buttons.release(source)
        if action is not None:
            self._program.release(action)
