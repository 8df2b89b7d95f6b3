"""Key names resolved on made-up keyboard layouts."""

from __future__ import annotations

import string
from typing import NamedTuple

import pygame
import pytest
from hypothesis import given, strategies as st

from silverball.app import sdl
from silverball.app.bindings import ACTIONS
from silverball.app.keyboard import US_LABELS, US_SCANCODES, Keyboard

USED = {name for line in ACTIONS for name in line.keys}
SIGNS = sorted(set(US_SCANCODES) - {"space"})
OTHERS = list("éèçàùöäüßñøåæłщъыэюяфвαβγδשגא:!<*$^")


class Press(NamedTuple):
    """A key press as pygame tells it."""

    key: int
    scancode: int
    mod: int = 0


@pytest.fixture(autouse=True, scope="module")
def video():
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SDL_VIDEODRIVER", "dummy")
        pygame.display.init()
        yield
        pygame.display.quit()


def keyboard(bears: dict[int, str]) -> Keyboard:
    """A keyboard with these signs; all its other keys are those of a US one."""
    real = sdl.keycode_at
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sdl, "keycode_at", lambda place: ord(bears[place]) if place in bears else real(place))
        return Keyboard()


def press(bears: dict[int, str], place: int, mod: int = 0) -> Press:
    return Press(ord(bears.get(place, US_LABELS.get(place, "\0"))), place, mod)


LAYOUTS = st.permutations([*SIGNS, *OTHERS]).map(
    lambda signs: dict(zip((US_SCANCODES[sign] for sign in SIGNS), signs, strict=False))
)


@given(bears=LAYOUTS)
def test_on_any_layout_every_name_that_can_be_meant_has_one_key_which_bears_its_label(bears):
    board = keyboard(bears)
    labels = board.labels(USED)
    signs = USED & set(SIGNS)
    meant = {place: board.resolve(press(bears, place), USED) for place in bears}
    for name in signs:
        places = [place for place, one in meant.items() if one == name]
        assert len(places) <= 1
        if name in bears.values():
            assert bears[places[0]] == name
            assert name not in labels
        elif places:
            assert labels.get(name, name) in (bears[places[0]], name)


@given(bears=LAYOUTS, place=st.sampled_from([US_SCANCODES[sign] for sign in SIGNS]))
def test_a_key_that_is_chosen_is_that_key_ever_after(bears, place):
    board = keyboard(bears)
    event = press(bears, place)
    if not board.resolve(event, USED):
        name = board.new_name(event)
        assert name not in USED
        assert board.resolve(event, USED | {name}) == name


def test_a_sign_without_a_font_is_never_called_by_the_sign_of_another_key(monkeypatch):
    monkeypatch.setattr("silverball.app.keyboard.can_show", str.isascii)
    hebrew = {US_SCANCODES[sign]: sign for sign in SIGNS} | {US_SCANCODES["a"]: "n", US_SCANCODES["n"]: "ש"}
    assert keyboard(hebrew).labels({"a", "n"}) == {}
    russian = {US_SCANCODES["a"]: "ф"}
    assert keyboard(russian).labels({"q", "ф"}) == {"ф": "a"}


def test_on_a_us_keyboard_every_key_is_what_it_bears():
    board = keyboard({})
    for name in USED & set(SIGNS):
        assert board.resolve(press({}, US_SCANCODES[name]), USED) == name
    assert board.labels(USED) == {}


def test_a_key_of_another_writing_is_kept_by_its_place_and_works_on_a_latin_keyboard():
    russian = {US_SCANCODES["q"]: "й", US_SCANCODES["a"]: "ф"}
    name = keyboard(russian).new_name(press(russian, US_SCANCODES["q"]))
    assert name == "q"
    assert keyboard({}).resolve(press({}, US_SCANCODES["q"]), {*USED, name}) == name


def test_names_that_were_kept_before_still_mean_their_keys():
    french = {US_SCANCODES["/"]: "!", US_SCANCODES["a"]: "q", US_SCANCODES["q"]: "a"}
    board = keyboard(french)
    assert board.resolve(press(french, US_SCANCODES["/"]), {*USED, "!"}) == "!"
    assert board.resolve(press(french, US_SCANCODES["q"]), USED) == "a"
    assert board.resolve(press(french, US_SCANCODES["a"]), USED) == ""


@pytest.mark.parametrize("key", [pygame.K_LSHIFT, pygame.K_LEFT, pygame.K_F1, pygame.K_SPACE, pygame.K_KP5])
def test_keys_that_bear_no_sign_are_the_same_on_every_layout(key):
    name = pygame.key.name(key)
    place = next(place for place in range(4, 232) if sdl.keycode_at(place) == key)
    for bears in ({}, {US_SCANCODES["a"]: "ф"}):
        event = Press(key, place)
        assert keyboard(bears).resolve(event, {name}) == name
        assert keyboard(bears).new_name(event) == name


@pytest.mark.parametrize("sign", ["\u200b", "\u0f0b", "\u00a0"])
def test_the_space_bar_is_itself_whatever_a_layout_writes_with_it(sign):
    bears = {pygame.KSCAN_SPACE: sign}  # Khmer, Dzongkha, and those who like it so
    board = keyboard(bears)
    assert board.resolve(press(bears, pygame.KSCAN_SPACE), USED) == "space"
    assert "space" not in board.labels(USED)


def test_a_layout_that_changes_without_a_word_is_noticed_at_the_next_press():
    board = keyboard({})
    event = Press(ord("q"), US_SCANCODES["a"])
    assert board.learn(event)
    assert not board.learn(event)
    assert board.resolve(event, USED | {"q"}) == "q"


def test_a_press_without_a_place_goes_by_its_sign():
    board = keyboard({})
    assert board.resolve(Press(ord("d"), 0), USED) == "d"
    assert board.resolve(Press(ord("я"), 0), USED) == ""


@pytest.mark.parametrize(("sign", "name"), [("a", "a"), ("q", ""), ("ф", "a")])
def test_where_sdl_cannot_be_asked_signs_count_and_places_only_for_other_writings(monkeypatch, sign, name):
    monkeypatch.setattr(sdl, "keycode_at", lambda place: None)
    board = Keyboard()
    event = Press(ord(sign), US_SCANCODES["a"])
    assert not board.learn(event)
    assert board.resolve(event, USED) == name
    assert board.labels(USED) == {}


def test_shift_changes_nothing_but_a_sign_that_is_nowhere_else():
    french = {US_SCANCODES[","]: ";", US_SCANCODES["."]: ":", US_SCANCODES["m"]: ",", US_SCANCODES[";"]: "m"}
    board = keyboard(french)
    shift = pygame.KMOD_LSHIFT
    assert board.resolve(press(french, US_SCANCODES[","], shift), USED) == "."
    assert board.resolve(press(french, US_SCANCODES["."]), USED) == "."
    assert board.labels(USED) == {".": ":"}
    for place in {US_SCANCODES[sign] for sign in SIGNS} - {US_SCANCODES[","]}:
        assert board.resolve(press(french, place, shift), USED) == board.resolve(press(french, place), USED)


def test_the_letters_of_initials_are_typed_on_every_keyboard():
    russian = {US_SCANCODES["a"]: "ф", US_SCANCODES["."]: "ю", US_SCANCODES["/"]: "."}
    board = keyboard(russian)
    assert board.letter(press(russian, US_SCANCODES["a"])) == "A"
    assert board.letter(press(russian, US_SCANCODES["/"])) == "."
    assert board.letter(Press(pygame.K_SPACE, pygame.KSCAN_SPACE)) == " "
    assert board.letter(Press(pygame.K_KP7, 95)) == "7"
    assert board.letter(Press(pygame.K_LEFT, 80)) == ""
    for letter in string.ascii_uppercase + string.digits + "-":
        assert keyboard({}).letter(press({}, US_SCANCODES[letter.lower()])) == letter
