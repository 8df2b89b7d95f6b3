"""Every command can be given on every keyboard, pressed with real keys on a real X server.

Needs Debian's packages xvfb, xdotool and x11-xkb-utils, which `.ci/run` installs; without them these tests
are skipped. What a key bears is asked of the X server, not of SDL.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from typing import Any

import pygame
import pytest
from xserver import all_layouts, choose_layout, signs, x_server

from patience import PATIENCE
from silverball.app import sdl
from silverball.app.bindings import ACTIONS
from silverball.app.controls import Action
from silverball.app.window import Window
from silverball.drawing.text import can_show
from silverball.game.view import Mode

PROGRAMS = ("Xvfb", "xdotool", "setxkbmap", "xkbcomp")
pytestmark = pytest.mark.skipif(
    not all(map(shutil.which, PROGRAMS)), reason=f"needs the programs {', '.join(PROGRAMS)}"
)
LAYOUTS = """
    us us:dvorak gb fr fr:bepo fr:geo gn be ch de de:neo es cz tr tr:f jp ru ua bg rs gr il ara ge am th in
""".split()
SPECIAL = {"up": 111, "left": 113, "right": 114, "left shift": 50, "right shift": 62, "space": 65}
SPECIAL |= {"f1": 67, "f3": 69, "f11": 95, "return": 36}
"""X's numbers of the keys that are the same on every layout."""
US_KEYS = {
    sign: key
    for row, first in (("1234567890-=", 10), ("qwertyuiop[]", 24), ("asdfghjkl;'`", 38), ("\\zxcvbnm,./", 51))
    for key, sign in enumerate(row, first)
}
"""X's numbers of the keys of a US keyboard."""
A, COMMA_PLACE, SHIFT = 38, 59, 50
SAMPLED = 8  # one layout in so many is a slow test


class Typist:
    """Somebody at the real keyboard of a window."""

    def __init__(self, window: Window, display: str) -> None:
        self.window, self.display = window, display
        self.asked: list[Action] = []

    @property
    def input_handler(self):
        return self.window.input_handler

    def use(self, layout: str) -> None:
        """Another keyboard is plugged in."""
        choose_layout(self.display, *layout.split(":"))
        self.until(lambda: True)

    def do(self, *words: str | int) -> None:
        """Work the real keys as xdotool understands it."""
        environment = os.environ | {"DISPLAY": self.display}
        subprocess.run(["xdotool", *map(str, words)], env=environment, timeout=PATIENCE, check=True)
        self.until(lambda: True)

    def until(self, is_reached: Callable[[], bool], seconds: float = 120.0) -> None:
        """Beats for a twentieth of a second, and on until something is reached."""
        start = time.monotonic()
        while time.monotonic() - start < 0.05 or not is_reached():
            assert time.monotonic() - start < seconds, "nothing happened"
            self.window.poll_input(0.001)
            time.sleep(0.002)

    def press(self, *keys: int) -> list[Action]:
        """What some keys ask for, one after the other."""
        self.asked.clear()
        if keys:
            self.do("key", *keys)
        return list(self.asked)


@pytest.fixture(scope="module")
def typist(tmp_path_factory) -> Iterator[Typist]:
    with x_server(1024, 800) as display, pytest.MonkeyPatch.context() as patch:
        patch.setenv("SDL_VIDEODRIVER", "x11")
        patch.setenv("SDL_AUDIODRIVER", "dummy")
        patch.setenv("DISPLAY", display)
        patch.setattr("silverball.drawing.background.Background._work", lambda self: None)
        patch.setattr("silverball.app.player_warmup.PlayerWarmup._work", lambda self: None)
        window = Window("classic", 7, height=400, mode=Mode.FREE, folder=tmp_path_factory.mktemp("data"))
        typist = Typist(window, display)
        typist.until(lambda: window.is_ready, 300.0)
        # Without a window manager a new window takes the focus by itself.
        typist.until(lambda: window._screen._window.focused)
        yield typist
        window.close()


@pytest.fixture
def asked(typist, monkeypatch) -> list[Action]:
    """The actions that keys ask for, which are not done."""

    def note(source: str, action: Action, *, same_board: bool = False) -> None:
        typist.asked.append(action)

    monkeypatch.setattr(typist.input_handler, "_press", note)
    typist.asked.clear()
    return typist.asked


def keys_that_the_help_names(typist: Typist) -> list[tuple[int, Action]]:
    """The keys that bear what the help page writes, by X's numbers, and what they do."""
    bears = signs(typist.display)
    controls = typist.input_handler.controls
    found = []
    for action in (Action(line.action) for line in ACTIONS):
        for name, label in zip(controls.keys(action), controls.key_labels(action), strict=True):
            keys = [key for key, sign in bears.items() if sign == label]
            if name in SPECIAL:
                keys = [SPECIAL[name]]
            elif not keys:  # no font has its sign, or two keys do; these keyboards bear Latin letters too
                keys = [US_KEYS[label]]
                sign = bears.get(keys[0], "\ufffe")
                is_clear = can_show(sign) and list(bears.values()).count(sign) == 1
                assert not is_clear, f"{name} is said to be {label}"
            found += [(key, action) for key in keys]
    return found


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_command_is_given_by_the_key_that_the_help_names(typist, asked, layout):
    typist.use(layout)
    named = keys_that_the_help_names(typist)
    assert {action for _, action in named} == set(Action) - {Action.BACK}  # Esc, as everywhere
    assert typist.press(*(key for key, _ in named)) == [action for _, action in named]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_sign_that_the_layout_has_is_its_key_and_no_other(typist, asked, layout):
    typist.use(layout)
    of_sign = {
        "a": Action.LEFT,
        "d": Action.RIGHT,
        "z": Action.JITTER,
        ",": Action.SLOWER,
        ".": Action.FASTER,
    }
    there = [(key, sign) for key, sign in signs(typist.display).items() if sign in of_sign]
    assert typist.press(*(key for key, _ in there)) == [of_sign[sign] for _, sign in there]
    for sign, action in of_sign.items():
        keys = [key for key, other in there if other == sign]
        if keys and US_KEYS[sign] not in keys:
            assert action not in typist.press(US_KEYS[sign])


@pytest.mark.parametrize(
    ("layout", "sign", "action"),
    [
        ("fr", ";", Action.FASTER),
        ("be", ";", Action.FASTER),
        ("ru", ".", Action.SLOWER),
        ("ua", ".", Action.SLOWER),
    ],
)
def test_a_sign_that_is_nowhere_else_may_be_typed_with_shift(typist, asked, layout, sign, action):
    typist.use(layout)
    key = next(key for key, other in signs(typist.display).items() if other == sign)
    typist.do("keydown", SHIFT, "key", key, "keyup", SHIFT)
    assert asked == [Action.LEFT, action]  # the Shift key is a paddle


@pytest.mark.parametrize("after", ["fr", "ru", "us:dvorak"])
def test_a_key_that_is_held_while_the_layout_changes_is_let_go(typist, after):
    typist.use("us")
    typist.do("keydown", A)
    assert typist.input_handler.buttons.held == (True, False)
    typist.use(after)
    typist.do("keyup", A)
    assert typist.input_handler.buttons.held == (False, False)


def test_help_and_settings_follow_the_layout_without_a_key_being_pressed(typist):
    for layout, sign in (("ru", "ф"), ("gr", "α"), ("us", "a")):
        typist.use(layout)
        typist.until(lambda sign=sign: typist.input_handler.controls.key_labels(Action.LEFT)[0] == sign)
        assert typist.window.program.menus.context.key_label("left") == sign.upper()


def test_no_input_method_gets_the_letters_whatever_is_done_to_the_window(typist):
    screen = typist.window._screen
    for do in (screen.toggle_fullscreen, screen.toggle_fullscreen, lambda: screen.resize((300, 500))):
        do()
        typist.until(lambda: True)
        assert sdl._function("SDL_IsTextInputActive")() == 0
    pygame.key.start_text_input()
    screen.resize((250, 400))
    assert sdl._function("SDL_IsTextInputActive")() == 0


def every_layout() -> list[Any]:
    """All layouts: an even sample for the slow tests, the others for a campaign."""
    return [
        pytest.param(layout, marks=pytest.mark.slow if number % SAMPLED == 0 else pytest.mark.campaign)
        for number, layout in enumerate(all_layouts())
    ]


@pytest.mark.parametrize("layout", every_layout())
def test_every_command_is_given_on_every_keyboard_that_there_is(typist, asked, layout):
    try:
        typist.use(layout)
    except subprocess.CalledProcessError:
        pytest.skip("this X server cannot load it")
    bears = signs(typist.display)
    if all(map(can_show, bears.values())):
        keys = {key for key, _ in keys_that_the_help_names(typist)}
    else:  # no font here has its letters
        keys = {*bears, *US_KEYS.values(), *SPECIAL.values()}
    assert set(typist.press(*keys)) == set(Action) - {Action.BACK}
