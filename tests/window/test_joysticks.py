"""Gamepads and joysticks: devices without a mapping in SDL, and devices that come and go."""

from __future__ import annotations

import pygame
import pytest
from joysticks import GAMEPAD, UNKNOWN, VirtualJoystick

from reading import reads
from silverball.app.bindings import ACTIONS
from silverball.app.settings import Settings
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL
from silverball.game.view import Mode

LEFT_SHOULDER, RIGHT_SHOULDER, SOUTH = 9, 10, 0  # of SDL's virtual gamepad


@pytest.fixture
def plug_in(player):
    """Plugs a device in; all are pulled out in the end."""
    plugged = []

    def plug(kind=UNKNOWN, axes=2, buttons=12, hats=1, title=None) -> VirtualJoystick:
        plugged.append(VirtualJoystick(kind, axes, buttons, hats, title))
        player.frames(2)
        return plugged[-1]

    yield plug
    for device in plugged:
        device.pull_out()


def push(player, device, button, down=True):
    device.button(button, down)
    player.frames(2)


def tap(player, device, button):
    push(player, device, button)
    push(player, device, button, down=False)


def held(player):
    return player.window.input_handler.buttons.held


def gamepad_page(player) -> None:
    """Pause and go to the page GAMEPAD of the settings."""
    player.tap(pygame.K_p)
    choose(player, "SETTINGS")
    choose(player, "GAMEPAD")


def find(player, label: str) -> None:
    for _ in range(40):
        player.seconds(0.3)
        if reads(player.menus.draw(player.program.machine.now), label, (BOLD, NORMAL)):
            return
        player.tap(pygame.K_RIGHT)
    raise AssertionError(f"{label} is not on the page {player.menus.page}")


def choose(player, label: str) -> None:
    find(player, label)
    player.tap(pygame.K_SPACE)


WITH_BUTTONS = [line for line in ACTIONS if any(name.startswith("button") for name in line.joystick)]


@pytest.mark.parametrize("line", WITH_BUTTONS, ids=lambda line: line.action)
def test_the_buttons_of_an_unknown_joystick_have_a_use_at_first(player, plug_in, monkeypatch, line):
    asked = []
    monkeypatch.setattr(
        player.window.input_handler, "_press", lambda source, action, **_: asked.append(action)
    )
    device = plug_in()
    numbers = [int(name.split()[1]) for name in line.joystick if name.startswith("button")]
    for number in numbers:
        tap(player, device, number - 1)
    assert asked == [line.action] * len(numbers)


def test_the_paddles_follow_the_buttons_the_lever_and_the_hat_of_an_unknown_joystick(player, plug_in):
    device = plug_in()
    for press, let_go in (
        (lambda: device.button(4, True), lambda: device.button(4, False)),
        (lambda: device.axis(0, -32768), lambda: device.axis(0, 0)),
        (lambda: device.hat(0, 8), lambda: device.hat(0, 0)),
    ):
        press()
        player.frames(2)
        assert held(player) == (True, False)
        let_go()
        player.frames(2)
        assert held(player) == (False, False)
    device.axis(0, 32767)
    device.hat(0, 2)
    player.frames(2)
    assert held(player) == (False, True)
    device.axis(0, 9000)  # no longer far out, and the hat still holds
    player.frames(2)
    assert held(player) == (False, True)


def test_a_lever_that_trembles_on_the_threshold_presses_once(player, plug_in, monkeypatch):
    asked = []
    monkeypatch.setattr(
        player.window.input_handler, "_press", lambda source, action, **_: asked.append(action)
    )
    device = plug_in()
    for value in (0, 20000, 19000, 20000, 18000, 20500, 0):
        device.axis(0, value)
        player.frames(2)
    assert asked == ["right"]


def test_a_pedal_that_rests_at_its_end_presses_nothing_until_it_is_trodden():
    from silverball.app.gamepad import _Joystick

    class Device:
        get_guid = staticmethod(lambda: "0")
        get_name = staticmethod(lambda: "Pedals")
        get_numbuttons = staticmethod(lambda: 0)

    pedals = _Joystick(Device())
    seen = [dict(pedals.directions(2, value)) for value in (-1.0, -0.9, 0.0, 0.5, 1.0, -1.0)]
    assert [names.keys() for names in seen] == [{"axis 3 +"}] * len(seen)
    assert [names["axis 3 +"] for names in seen] == [False, False, None, True, True, False]


def test_any_button_of_an_unknown_joystick_can_be_chosen_and_is_kept_for_this_make(player, plug_in):
    one, other = plug_in(buttons=100, title="One make"), plug_in(buttons=20, title="Another")
    gamepad_page(player)
    choose(player, "NUDGE LEFT")
    choose(player, "NEW BUTTON")
    tap(player, one, 98)
    settings = player.program.settings.current
    guid = next(
        entry.guid for entry in player.window.input_handler.gamepads.joysticks if entry.title == "One make"
    )
    assert settings.joysticks == {guid: {"jitter": ("button 99",)}}
    assert settings.pad == settings.keys == {}
    while player.menus.is_open:
        player.tap(pygame.K_ESCAPE)
    tap(player, one, 98)
    assert "no ball" in player.says
    player.window.messages.clear()
    tap(player, one, 3)  # no longer
    assert "Button 4 does nothing here" in player.says
    player.window.messages.clear()
    tap(player, other, 3)  # still
    assert "no ball" in player.says
    again = Settings.of(player.program.store.settings())
    assert again.joysticks == settings.joysticks


@pytest.mark.parametrize(
    ("name", "move", "back"),
    [
        ("axis 4 -", lambda device: device.axis(3, -32000), lambda device: device.axis(3, 0)),
        ("hat 2 down", lambda device: device.hat(1, 4), lambda device: device.hat(1, 0)),
    ],
)
def test_an_axis_or_a_hat_can_be_chosen_too(player, plug_in, name, move, back):
    device = plug_in(axes=4, hats=2)
    gamepad_page(player)
    choose(player, "NUDGE LEFT")
    choose(player, "NEW BUTTON")
    for do in (move, back):
        do(device)
        player.frames(2)
    assert [*player.program.settings.current.joysticks.values()] == [{"jitter": (name,)}]


@pytest.mark.parametrize(
    ("title", "read"),
    [
        ("Cabinet board", "CABINET BOARD"),
        ("Bad \x1b[31m\u202e name", r"BAD \X1B[31M\U202E NAME"),
        ("", "JOYSTICK"),
    ],
)
def test_the_page_names_the_joystick_and_obeys_nothing_in_its_name(player, plug_in, title, read):
    plug_in(buttons=1, title=title)
    (entry,) = player.window.input_handler.gamepads.joysticks
    assert entry.title.upper() == read
    assert entry.title.isprintable()
    gamepad_page(player)
    for _ in range(80):  # a long name scrolls
        player.seconds(0.2)
        if reads(player.menus.draw(player.program.machine.now), read[:9], (BOLD, NORMAL)):
            break
    else:
        raise AssertionError("not named")


@pytest.mark.parametrize("buttons", [0, 1, 100])
def test_joysticks_of_any_size_come_and_go(player, plug_in, buttons):
    for _ in range(3):
        device = plug_in(buttons=buttons, hats=0, axes=0)
        assert [entry.buttons for entry in player.window.input_handler.gamepads.joysticks] == [buttons]
        for button in range(buttons):
            tap(player, device, button)
        device.pull_out()
        player.frames(2)
        assert player.window.input_handler.gamepads.joysticks == ()
        assert held(player) == (False, False)
        if player.menus.is_open:
            player.tap(pygame.K_ESCAPE)


def test_two_joysticks_hold_a_paddle_each_and_one_lets_go_of_its_own(player, plug_in):
    one, other = plug_in(), plug_in()
    push(player, one, 4)
    push(player, other, 4)
    push(player, other, 5)
    assert held(player) == (True, True)
    push(player, other, 4, down=False)
    assert held(player) == (True, True)
    push(player, one, 4, down=False)
    assert held(player) == (False, True)


@pytest.mark.parametrize("kind", [GAMEPAD, UNKNOWN])
@pytest.mark.parametrize("mode", list(Mode))
def test_the_game_waits_when_the_gamepad_that_is_played_with_goes(open_window, kind, mode):
    player = open_window(mode=mode)
    device = VirtualJoystick(kind, 6, 15)
    player.frames(2)
    left = LEFT_SHOULDER if kind == GAMEPAD else 4
    push(player, device, SOUTH)
    assert player.world.balls
    push(player, device, left)
    assert held(player) == (True, False)
    device.pull_out()
    player.frames(2)
    assert player.program.is_paused
    assert "gamepad" in player.says
    assert held(player) == (False, False)
    tick = player.world.tick
    player.seconds(0.5)
    assert player.world.tick == tick
    again = VirtualJoystick(kind, 6, 15)
    player.frames(2)
    tap(player, again, SOUTH)  # "resume"
    assert not player.program.is_paused
    push(player, again, left)
    assert held(player) == (True, False)
    again.pull_out()
    player.frames(2)


def test_the_game_goes_on_when_a_gamepad_goes_that_nobody_plays_with(player, plug_in):
    used, unused, left_for_keys = plug_in(GAMEPAD), plug_in(GAMEPAD), plug_in(GAMEPAD)
    player.tap(pygame.K_SPACE)
    push(player, left_for_keys, LEFT_SHOULDER)
    push(player, left_for_keys, LEFT_SHOULDER, down=False)
    player.tap(pygame.K_a)
    tap(player, used, RIGHT_SHOULDER)
    for device in (unused, left_for_keys):
        device.pull_out()
        player.frames(2)
        assert not player.program.is_paused
    used.pull_out()
    player.frames(2)
    assert player.program.is_paused


def test_settings_of_joysticks_that_make_no_sense_are_passed_over():
    kept = {"keys": {"jitter": ["q"]}, "pad": {"left": ["x"]}}
    for bad in (3, [], {"guid": 3}, {"guid": {"left": 5}}, {"guid": {"left": [1]}}):
        settings = Settings.of(kept | {"joysticks": bad})
        assert settings.joysticks == {}
        assert settings.keys == {"jitter": ("q",)}
        assert settings.pad == {"left": ("x",)}
