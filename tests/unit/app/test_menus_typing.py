"""Typing initials and seeds; paddle keys with letters stay paddles until another letter is typed."""

import string

import pytest
from hypothesis import given, strategies as st

from reading import reads
from silverball.app.menus import Button, Menus, TableEntry
from silverball.app.menus.commands import Initials, ShowBoard
from silverball.app.menus.entry import LETTERS
from silverball.app.settings import PlayerSettings, Settings

LEFT, RIGHT, START, BACK = Button
BUTTONS = {"a": LEFT, "d": RIGHT, " ": START}  # the keys that are buttons of the menus too
OTHERS = {"return": START, "left": LEFT, "right": RIGHT, "left shift": LEFT}


def initials_page(initials="OLD") -> Menus:
    menus = Menus(
        PlayerSettings(Settings(initials=initials, table="random")),
        (TableEntry("random", "Random", "", True),),
        lambda *_: (),
    )
    menus.open_over(1234, 1)
    menus.tick(1.0)
    return menus


def hit(menus: Menus, *keys: str):
    """Hit keys as the window passes them on; the last command."""
    last = None
    for key in keys:
        button = BUTTONS.get(
            key, {"return": START, "left": LEFT, "right": RIGHT, "left shift": LEFT}.get(key)
        )
        name = {" ": "space"}.get(key, key.lower())
        if menus.type(key if len(key) == 1 else "", name, is_button=key.lower() in BUTTONS):
            continue
        if button is not None:
            last = menus.press(button) or last
            menus.release(button)
    return last


def text(menus: Menus) -> str:
    return menus.context.pages[-1].text


@pytest.mark.parametrize("done", ["return", " "])
@pytest.mark.parametrize("word", ["mia", "BOB", "x-1", "Z.9", "não", "ÖZG"])
def test_three_typed_letters_and_enter_or_space_sign_the_score(word, done):
    menus = initials_page()
    plain = {"não": "NAO", "ÖZG": "OZG"}.get(word, word.upper())
    assert hit(menus, *word) is None
    assert text(menus) == plain
    assert hit(menus, done) == Initials(plain)
    assert menus.page == "over"


def test_a_and_d_turn_until_another_letter_has_been_typed_and_are_letters_then():
    menus = initials_page("AAA")
    hit(menus, "d", "d", "a")
    assert text(menus) == ""
    hit(menus, "n", "a", "d")
    assert text(menus) == "NAD"
    assert hit(menus, "return") == Initials("NAD")


def test_backspace_makes_a_and_d_letters_too():
    menus = initials_page()
    assert hit(menus, "backspace", "d", "a", "d", "return") == Initials("DAD")


def test_arrows_and_shift_turn_again_from_where_the_typing_stands():
    menus = initials_page("AAA")
    hit(menus, "m", "right", " ")  # A is offered next: B
    assert text(menus) == "MB"
    hit(menus, "left shift")
    assert text(menus) == "MB"
    hit(menus, "d")  # a paddle again
    assert text(menus) == "MB"


def test_backspace_takes_back_letter_by_letter_and_never_leaves():
    menus = initials_page()
    hit(menus, "m", "i", "backspace", "backspace", "backspace", "backspace")
    assert (menus.page, text(menus)) == ("initials", "")
    assert hit(menus, "b", "o", "b", "backspace", "o", "return") == Initials("BOO")


@pytest.mark.parametrize(("word", "signed"), [("m", "M  "), ("mi", "MI ")])
def test_fewer_than_three_letters_will_do(word, signed):
    menus = initials_page()
    assert hit(menus, *word, "return") == Initials(signed)


def test_nothing_typed_signs_as_offered():
    assert hit(initials_page(), "backspace", "return") == Initials("OLD")


@given(st.text(st.characters(blacklist_categories=("Cs",)), max_size=8))
def test_whatever_is_typed_the_initials_are_three_of_the_letters(keys):
    menus = initials_page()
    hit(menus, "x", *(key for key in keys if key != " "))
    command = hit(menus, "return")
    assert isinstance(command, Initials)
    assert len(command.text) == 3
    assert set(command.text) <= set(LETTERS)


def test_a_key_that_bears_no_latin_letter_counts_by_its_name():
    menus = initials_page()
    for written, name in (("п", "g"), ("", "h"), ("", "[7]")):
        assert menus.type(written, name, is_button=False)
    assert text(menus) == "GH7"


@pytest.mark.parametrize("key", ["?", ",", "€"])
def test_a_character_that_cannot_be_had_is_refused_with_a_word(key):
    menus = initials_page()
    assert menus.type(key, key, is_button=False)
    assert text(menus) == ""
    frames = [menus.draw(1.0 + tick / 5) for tick in range(20)]
    assert any(reads(dots, "ONLY LETTERS") for dots in frames)


@pytest.mark.parametrize("name", ["f1", "f11", "escape", "tab", "return", "left ctrl"])
def test_keys_that_bear_no_letter_stay_what_they_are(name):
    assert not initials_page().type("", name, is_button=False)


def test_no_key_is_a_letter_on_other_pages():
    menus = initials_page()
    menus.open_main()
    assert not menus.wants_text
    assert not any(menus.type(letter, letter, is_button=False) for letter in string.ascii_lowercase)


def test_a_seed_is_typed_by_its_digits():
    menus = initials_page()
    menus.open_main()
    for buttons in ((RIGHT, RIGHT, START), (RIGHT, START), (RIGHT, START)):
        for button in buttons:
            menus.press(button)
            menus.release(button)
    while menus.page == "board":  # from whatever item
        menus.press(RIGHT)
        menus.press(START)
    assert menus.page == "seed"
    assert hit(menus, "return") is None
    hit(menus, "4", "x", "7", "1", "backspace", "1")
    assert hit(menus, "return") == ShowBoard(471)
    assert menus.context.seed == 471


def test_the_page_says_that_letters_can_be_typed_and_which_keys_turn():
    menus = initials_page()
    frames = [menus.draw(1.0 + tick / 5) for tick in range(40)]
    for words in ("A D ◄ ►: TURN", "KEYS: TYPE"):
        assert any(reads(dots, words) for dots in frames), words
    hit(menus, "m")
    assert any(reads(menus.draw(1.0 + tick / 5), "SPACE: DONE") for tick in range(40))
