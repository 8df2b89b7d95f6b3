"""Broken lines stay within their width at every size, and no letter is lost."""

import pytest
from hypothesis import given, strategies as st

from silverball.drawing.text import line, text_width, wrapped


@given(
    text=st.text("abc /-.WMil", max_size=120),
    size=st.sampled_from([8, 9, 11, 16, 24, 29, 30, 40]),
    width=st.integers(40, 400),
)
def test_no_line_is_wider_than_it_may_be_and_no_letter_is_lost(text, size, width):
    lines = wrapped(text, size, width)
    for one in lines:
        assert line(one, size, (255, 255, 255)).get_width() <= width
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")


@pytest.mark.parametrize("size", range(8, 40))
def test_a_sentence_fits_its_width_at_every_size(size):
    words = "typo.toml cannot be played: board.gravitation: unknown key: did you mean `gravity`?"
    for width in range(12 * size, 24 * size, size // 2):
        for one in wrapped(words, size, width):
            assert line(one, size, (255, 255, 255)).get_width() <= width


@pytest.mark.parametrize("size", [8, 11, 29, 30, 50])
def test_the_width_of_a_text_is_the_width_of_its_picture(size):
    assert (
        abs(text_width("silverball check", size) - line("silverball check", size, (0, 0, 0)).get_width()) <= 1
    )


def test_words_are_kept_whole_where_they_fit():
    whole = "every word of this is short"
    assert " ".join(wrapped(whole, 12, 90)) == whole
