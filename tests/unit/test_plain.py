"""Text from outside is shown, never obeyed."""

import sys
import unicodedata

import pytest

from silverball.plain import plain

OBEYED = [
    chr(code) for code in range(sys.maxunicode + 1) if unicodedata.category(chr(code)) in "Cc Cf Cs Zl Zp"
]


def test_nothing_that_steers_a_terminal_or_cannot_be_encoded_is_left():
    shown = plain("".join(OBEYED))
    assert shown.isascii()
    assert shown.isprintable()
    assert len(OBEYED) > 2000  # half surrogates alone are as many


@pytest.mark.parametrize("text", ["", "Classic", "Küste 10 × 20 u", "ピンボール", "a\\b", "two  spaces"])
def test_text_that_is_only_text_stays_as_it_is(text):
    assert plain(text) == text


def test_an_escape_says_which_character_stood_there():
    assert plain("a\x1b[31mb\u202ec\ud800") == "a\\x1b[31mb\\u202ec\\ud800"


def test_lines_of_a_message_stay_lines_where_they_are_asked_for():
    assert plain("one\ntwo\x07", keep="\n") == "one\ntwo\\x07"
    assert plain("one\ntwo") == "one\\ntwo"
