"""Handles the events of the window: keys, gamepad buttons, and changes of focus, layout and devices.

Help, debug view, full screen and mute are handled here. Paddle buttons are stored until the next input poll;
all other actions are passed on to the program. Releasing a key ends the action that pressing it started, even
if the layout or the bindings have changed since.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pygame

from silverball.app import button_handlers
from silverball.app.bindings import upper_label
from silverball.app.controls import (
    HELD,
    MENU_KEYS,
    NUDGES,
    PADDLES,
    Action,
    Controls,
    PaddleButtons,
    is_printable,
    is_shortcut,
)
from silverball.app.gamepad import REMOVED, Gamepads, PadButton
from silverball.app.keyboard import Keyboard, key_label
from silverball.app.menus import Button
from silverball.app.overlay import HELP_PAGES
from silverball.drawing.text import can_show

if TYPE_CHECKING:
    from silverball.app.backglass.list_view import ListView
    from silverball.app.overlay import Messages
    from silverball.app.program import Program
    from silverball.app.screen import Screen
    from silverball.app.sound import Sounds
    from silverball.app.timing import LatencyMeter


MOUSE_EVENTS = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)
LEFT_BUTTON, RIGHT_BUTTON = 1, 3
ARROWS = {"left": -1, "right": 1}  # keys that change the setting chosen in a list

_SHIFT_KEYS = ("left shift", "right shift")


class _PressedKey(NamedTuple):
    """A key that is down."""

    name: str
    action: Action | None = None
    menu: Button | None = None


class InputHandler:
    """Handles the events of a window.

    Attributes:
        buttons: The paddle buttons and the launch button, as far as they are held.
        gamepads: The gamepads and joysticks.
        keyboard: The keyboard.
        controls: The current key bindings.
        shows_help: Whether the help is shown, which pauses the game.
        help_page: The visible page of the help: how to score, or the keys.
        shows_debug: Whether the debug view is shown.
    """

    def __init__(
        self,
        program: Program,
        screen: Screen,
        sounds: Sounds,
        messages: Messages,
        latency: LatencyMeter,
        list_view: ListView,
    ) -> None:
        self._list_view = list_view
        self._program, self._screen, self._sounds = program, screen, sounds
        self._messages, self._latency = messages, latency
        self.buttons = PaddleButtons()
        self.gamepads = Gamepads()
        self.keyboard = Keyboard()
        self._keys: dict[int, _PressedKey] = {}  # keys that are down, by scancode
        self._gamepads_in_use: set[int] = set()  # since the last paddle key
        self.shows_help = self.shows_debug = False
        self.help_page = 0
        self.update_controls()

    def update_controls(self) -> None:
        """Read the key bindings from the settings."""
        self.controls = Controls(self._program.settings.current)
        self._update_key_labels()

    def close(self) -> None:
        """Close all devices."""
        self.gamepads.close()

    def handle(self, event: pygame.Event) -> None:
        """Handle an event."""
        self._screen.handle(event)
        if event.type == pygame.KEYDOWN:
            self._key_down(event)
        elif event.type == pygame.KEYUP:
            self._key_up(event)
        elif event.type in MOUSE_EVENTS:
            self._mouse(event)
        elif event.type == pygame.KEYMAPCHANGED:
            self.keyboard.read_layout()
            self._update_key_labels()
        elif self._screen.has_lost_focus(event):
            self._keys.clear()
            self.buttons.release_all()
            self._program.lose_focus()
        elif event.type in (pygame.QUIT, pygame.WINDOWCLOSE):
            self._program.should_quit = True
        for button in self.gamepads.read(event):
            self._gamepad_button(button)
        if event.type in REMOVED or event.type == pygame.JOYDEVICEADDED:
            self._devices_changed(event)

    def _update_key_labels(self) -> None:
        self.controls.labels = self.keyboard.labels(self.controls.key_names)
        self._program.menus.context.key_labels = self.controls.labels

    def _key_down(self, event: pygame.Event) -> None:
        if self.keyboard.learn(event):
            self._update_key_labels()
        name = self.keyboard.resolve(event, self.controls.key_names.union(MENU_KEYS))
        action = self.controls.action_of_key(name, event.mod)
        menus = self._program.menus
        if action in NUDGES and name in MENU_KEYS and (menus.is_open or self.shows_help):
            action = None  # in menus and in the help it moves
        scancode = event.scancode or event.key
        if menus.wants_key and name != "escape" and not is_shortcut(event.mod):
            self._program.capture(name or self.keyboard.new_name(event))
        elif menus.wants_text and self._type(event, action):
            self._sounds.play_menu("back" if name == "backspace" else "choose")
        elif (
            name in ARROWS and self._list_view.is_shown and not self.shows_help and menus.adjust(ARROWS[name])
        ):
            self._sounds.play_menu("move")
        elif action is not None:
            self._keys[scancode] = _PressedKey(name, action)
            if action in PADDLES:
                self._gamepads_in_use.clear()
            self._press(f"key {scancode}", action, same_board=bool(event.mod & pygame.KMOD_SHIFT))
        elif name in MENU_KEYS and self.shows_help:
            self._turn_help()
        elif name in MENU_KEYS and menus.is_open:
            self._keys[scancode] = _PressedKey(name, menu=MENU_KEYS[name])
            self._program.press_menu(MENU_KEYS[name])
        elif is_printable(event.key) and not is_shortcut(event.mod):
            label = key_label(event.key, event.scancode)
            key = upper_label(label) if can_show(label) else "this key"
            self._messages.show(f"{key} does nothing here; {self._help_key('the menu')} shows the keys")

    def _key_up(self, event: pygame.Event) -> None:
        scancode = event.scancode or event.key
        pressed = self._keys.pop(scancode, None)
        if pressed is not None:
            self._release(f"key {scancode}", pressed.action)
            if pressed.menu is not None:
                self._program.menus.release(pressed.menu)

    def _help_key(self, default: str) -> str:
        """The label of the key that shows the help; `default` if there is none."""
        labels = self.controls.key_labels(Action.HELP)
        return upper_label(labels[0]) if labels else default

    def _type(self, event: pygame.Event, action: Action | None) -> bool:
        """Pass a key to the page with text input; return whether the page consumed the key."""
        if self.shows_help or is_shortcut(event.mod):
            return False
        # Beside a grid of letters, which arrows and mouse choose, keys with letters type at once.
        is_button = action is Action.CREATE or (action in PADDLES and not self._list_view.is_shown)
        # SDL's text input is off, because an input method would swallow letters.
        letter = self.keyboard.letter(event) or event.unicode
        return self._program.menus.type(letter, self.keyboard.new_name(event), is_button=is_button)

    def _mouse(self, event: pygame.Event) -> None:
        """Handle the mouse: it chooses in lists, turns the pages of the help and ends the attract mode."""
        menus = self._program.menus
        if event.type == pygame.MOUSEWHEEL:
            self._wheel(event.y)
            return
        place = self._screen.to_backglass(event)
        hit = self._list_view.at(place) if menus.is_open and place is not None else None
        if event.type == pygame.MOUSEMOTION:
            has_moved = event.rel != (0, 0)  # otherwise a page has opened under a pointer at rest
            if has_moved and hit is not None and not self.shows_help and menus.point(hit.row):
                self._sounds.play_menu("move")
        elif self.shows_help and event.button == LEFT_BUTTON:
            self._turn_help()
        elif self.shows_help and event.button == RIGHT_BUTTON:
            self._press("mouse", Action.HELP)
        elif event.button == RIGHT_BUTTON and menus.is_open:
            self._press("mouse", Action.BACK)
        elif event.button == LEFT_BUTTON and hit is not None:
            self._program.click_menu(hit.row, hit.step)
            self._sounds.play_menu("choose")
        elif event.button == LEFT_BUTTON and menus.page == "attract":
            self._press("mouse", Action.BACK)

    def _wheel(self, steps: int) -> None:
        """Turn the pages of the help, or move through the list that is shown."""
        if self.shows_help and steps:
            self._turn_help()
        elif self._list_view.is_shown:
            button = Button.LEFT if steps > 0 else Button.RIGHT
            for _ in range(abs(steps)):
                self._program.press_menu(button)
                self._program.menus.release(button)

    def _gamepad_button(self, button: PadButton) -> None:
        action = self.controls.action_of_button(button.name, button.kind)
        if not button.down:
            self._release(button.source, action)
        elif self._program.menus.wants_pad:
            self._program.capture(button.name, button.kind)
        elif action is not None:
            self._gamepads_in_use.add(button.pad)
            self._press(button.source, action)
        elif button.name.startswith("button"):
            self._messages.show(f"{button.name} does nothing here; the gamepad settings can change that")

    def _devices_changed(self, event: pygame.Event) -> None:
        """Handle a gamepad or joystick that was connected or removed."""
        self._program.menus.context.joysticks = self.gamepads.joysticks
        if event.type in REMOVED and event.instance_id in self._gamepads_in_use:
            self._gamepads_in_use.discard(event.instance_id)
            self._program.lose_gamepad("the gamepad")

    def _press(self, source: str, action: Action, *, same_board: bool = False) -> None:
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
            program.settings.change(muted=not program.settings.current.muted)
            self._messages.show("sounds are off" if program.settings.current.muted else "sounds are on")
        elif action is Action.CREATE and program.charges_plunger and not self.shows_help:
            self.buttons.press(source, Action.LAUNCH)
        elif action in HELD:
            self.buttons.press(source, action)
            if program.is_playing and not self.shows_help:
                if action in PADDLES:
                    self._latency.record_press()
            else:
                self.buttons.forget_taps()
            self._press_in_program(action)
        elif action is Action.NEW_BOARD and same_board:
            for scancode, pressed in self._keys.items():
                if pressed.name in _SHIFT_KEYS:  # part of this shortcut, not a paddle button
                    self.buttons.release(f"key {scancode}")
            self._press_in_program(action, same_board=True)
        else:
            self._press_in_program(action)

    def _press_in_program(self, action: Action, *, same_board: bool = False) -> None:
        """Pass a button on to the game or the menus, unless the help is shown."""
        program = self._program
        if self.shows_help:
            self._press_in_help(action)
        elif action is Action.SINGLE_TICK:
            program.single_tick(self.buttons.poll())
        else:
            was_open, before = program.menus.is_open, program.menus.signature
            button_handlers.press(program, action, same_board=same_board)
            if was_open and program.menus.signature != before:
                self._sounds.play_menu(
                    "move" if action in PADDLES else "back" if action is Action.BACK else "choose"
                )

    def _press_in_help(self, action: Action) -> None:
        """Turn the pages with the paddles and Space; for other buttons, show how to close the help."""
        if action in (*HELD, Action.CREATE):
            self._turn_help()
        key = self._help_key("Esc")
        if self._program.has_game and action not in PADDLES:
            self._messages.show(f"game paused while help is open; press {key} to continue")
        elif action not in (*HELD, Action.CREATE):
            self._messages.show(f"press {key} to close the help")

    def _turn_help(self) -> None:
        self.help_page = (self.help_page + 1) % HELP_PAGES
        self._sounds.play_menu("move")

    def _release(self, source: str, action: Action | None) -> None:
        self.buttons.release(source)
        if action is not None:
            button_handlers.release(self._program, action)
