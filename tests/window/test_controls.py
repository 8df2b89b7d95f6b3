"""Actions of keys and gamepad buttons, without a window."""

from __future__ import annotations

import pygame
import pytest

from silverball.app.bindings import ACTIONS
from silverball.app.controls import Action, Controls, PaddleButtons
from silverball.app.gamepad import (
    BUTTON_NAMES,
    STICK_DOWN,
    STICK_NAMES,
    STICK_UP,
    TRIGGER_DOWN,
    TRIGGER_UP,
    Gamepads,
)
from silverball.app.settings import Settings
from silverball.app.timing import TickClock


@pytest.fixture(autouse=True)
def video(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pygame.display.init()  # names of keys need it
    yield
    pygame.display.quit()


def test_every_action_of_the_menus_is_one_that_the_window_knows():
    assert {line.action for line in ACTIONS} == {str(action) for action in Action}


def test_every_default_key_and_button_is_one_that_pygame_names():
    for line in ACTIONS:
        for name in line.keys:
            assert pygame.key.name(pygame.key.key_code(name)) == name
        for name in line.pad:
            sticks = {way for ways in STICK_NAMES.values() for way in ways}
            assert name in {*BUTTON_NAMES.values(), "lefttrigger", "righttrigger", *sticks}
        for name in line.joystick:
            thing, number, *way = name.split()
            assert int(number) >= 1
            assert (
                way
                in {"button": [[]], "hat": [["left"], ["right"], ["up"], ["down"]], "axis": [["-"], ["+"]]}[
                    thing
                ]
            )


def test_no_key_and_no_button_asks_for_two_things():
    for kind in ("keys", "pad", "joystick"):
        names = [name for line in ACTIONS for name in getattr(line, kind)]
        assert len(set(names)) == len(names)


def test_a_key_that_was_given_to_another_action_leaves_the_old_one():
    controls = Controls(Settings(keys={"jitter": ("a",)}))
    assert controls.action_of_key("a") is Action.JITTER
    assert controls.action_of_key("z") is None
    assert controls.action_of_key("left") is Action.LEFT


def test_escape_always_goes_back():
    assert Controls(Settings(keys={"left": ("escape",)})).action_of_key("escape") is Action.BACK


def test_a_shortcut_of_the_desktop_moves_no_more_than_paddles():
    controls = Controls(Settings())
    assert controls.action_of_key("r", pygame.KMOD_LCTRL) is None
    assert controls.action_of_key("a", pygame.KMOD_LCTRL) is Action.LEFT


def test_a_paddle_is_held_while_one_of_two_sources_holds_it():
    buttons = PaddleButtons()
    buttons.press("key a", Action.LEFT)
    buttons.press("pad 0 leftshoulder", Action.LEFT)
    buttons.release("key a")
    assert buttons.held == (True, False)
    buttons.release("pad 0 leftshoulder")
    assert buttons.held == (False, False)


def test_a_tap_counts_in_the_first_tick_only():
    buttons = PaddleButtons()
    buttons.press("key d", Action.RIGHT)
    buttons.release("key d")
    held = buttons.poll()
    assert held == ((False, True), (False, False), (False, False))
    assert buttons.poll().first == (False, False)


def axis(value: int) -> pygame.Event:
    return pygame.Event(
        pygame.CONTROLLERAXISMOTION, instance_id=3, axis=pygame.CONTROLLER_AXIS_TRIGGERLEFT, value=value
    )


def test_a_trigger_is_a_button_that_does_not_chatter():
    pads = Gamepads()
    seen = []
    for value in (0, TRIGGER_DOWN, TRIGGER_DOWN - 1, TRIGGER_UP + 1, 32767, TRIGGER_UP, 0):
        seen += [(button.name, button.down) for button in pads.read(axis(value))]
    assert seen == [("lefttrigger", True), ("lefttrigger", False)]


def test_a_stick_is_a_button_in_each_direction_that_does_not_chatter():
    pads = Gamepads()
    seen = []
    for value in (0, -STICK_DOWN, -STICK_DOWN + 1, -STICK_UP - 1, -32768, -STICK_UP, 0, 32767, 0):
        event = pygame.Event(
            pygame.CONTROLLERAXISMOTION, instance_id=3, axis=pygame.CONTROLLER_AXIS_LEFTX, value=value
        )
        seen += [(button.name, button.down) for button in pads.read(event)]
    assert seen == [
        ("stick left", True),
        ("stick left", False),
        ("stick right", True),
        ("stick right", False),
    ]


def test_a_gamepad_that_is_pulled_out_lets_its_trigger_go():
    pads = Gamepads()
    list(pads.read(axis(32767)))
    gone = pads.read(pygame.Event(pygame.CONTROLLERDEVICEREMOVED, instance_id=3))
    assert [(button.name, button.down) for button in gone] == [("lefttrigger", False)]


@pytest.mark.parametrize("speed", [0.25, 1.0, 16.0])
def test_the_clock_gives_ticks_by_its_speed_and_never_too_many_at_once(speed):
    clock = TickClock(240)
    clock.speed = speed
    ticks = [clock.advance(1 / 60) for _ in range(600)]
    assert sum(ticks) == pytest.approx(2400 * speed, abs=1)
    assert clock.advance(10.0) <= max(12, 12 * speed)
    assert 0.0 <= clock.fraction < 1.0


def test_the_launch_button_is_held_and_tapped_like_a_paddle_button():
    buttons = PaddleButtons()
    buttons.press("key return", Action.LAUNCH)
    held = buttons.poll()
    assert held == ((False, False), (False, False), (True, True))
    buttons.release("key return")
    buttons.press("key return", Action.LAUNCH)
    buttons.release("key return")
    assert buttons.poll().launch == (True, False)
    assert held.later.launch == (True, True)
