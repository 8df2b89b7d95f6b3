"""Does what is drawn on the dots stand where it was asked for, and never elsewhere?"""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots, blend, picture, scroll, wipe
from silverball.drawing.dotmatrix.fonts import BOLD, FONTS, HUGE, NORMAL, TINY, fitting

FAR = st.integers(-400, 400)


def lit_columns(dots: Dots) -> tuple[int, int]:
    """The first and the last column with a lit dot."""
    columns = np.flatnonzero(dots.pixels.any(axis=0))
    return int(columns[0]), int(columns[-1])


def some_picture(seed: int) -> Dots:
    return Dots(np.random.default_rng(seed).integers(0, 256, (HEIGHT, WIDTH)).astype(np.uint8))


def test_a_text_starts_ends_or_has_its_middle_where_it_was_asked_for():
    text = "HUH"  # its first and last columns are lit
    width = NORMAL.width(text)
    for align, first in (("left", 50), ("right", 50 - width), ("center", 50 - width // 2)):
        dots = Dots()
        assert dots.text(text, 50, 4, NORMAL, align) == width
        assert lit_columns(dots) == (first, first + width - 1)


def test_a_text_twice_as_large_has_four_times_as_many_dots():
    small, large = Dots(), Dots()
    small.text("TILT", 5, 5, BOLD)
    large.text("TILT", 5, 5, BOLD, scale=2)
    assert np.count_nonzero(large.pixels) == 4 * np.count_nonzero(small.pixels)


@given(text=st.text(max_size=12), x=FAR, y=FAR, font=st.sampled_from(FONTS), scale=st.integers(1, 3))
def test_whatever_is_written_anywhere_is_cut_off_and_never_an_error(text, x, y, font, scale):
    whole, window = Dots(), Dots()
    whole.text(text, x, y, font, scale=scale)
    window.text(text, x, y, font, scale=scale, window=(30, 70))
    assert not window.pixels[:, :30].any()
    assert not window.pixels[:, 70:].any()
    assert (window.pixels[:, 30:70] == whole.pixels[:, 30:70]).all()


@given(x0=FAR, y0=FAR, x1=FAR, y1=FAR, level=st.integers(0, FULL))
def test_shapes_anywhere_are_cut_off_and_never_an_error(x0, y0, x1, y1, level):
    dots = Dots()
    dots.line(x0, y0, x1, y1, level)
    dots.box(x0, y0, x1, y1, level)
    dots.frame(x0, y0, x1, y1, level)
    dots.dot(x0, y0, level)
    dots.sprite(np.full((5, 5), level, np.uint8), x0, y0)
    dots.invert(x0, y0, x1, y1)
    dots.dim(0.5, x0, y0, x1, y1)
    assert dots.pixels.shape == (HEIGHT, WIDTH)
    assert dots.pixels.dtype == np.uint8


def test_a_box_that_begins_outside_keeps_only_what_is_inside():
    dots = Dots()
    dots.box(-3, -2, 5, 4)
    assert np.count_nonzero(dots.pixels) == 2 * 2
    assert dots.pixels[:2, :2].all()


@pytest.mark.parametrize("font", FONTS, ids=lambda font: font.name)
def test_letters_that_are_missing_show_a_box(font):
    for character in "\ufdd0\x85\x00":
        assert font.glyph(character) is font.box
        assert not font.has(character)


@pytest.mark.parametrize("font", [BOLD, NORMAL], ids=lambda font: font.name)
def test_letters_of_other_keyboards_are_drawn_and_told_from_their_likes(font):
    for characters in ("AÄÁ", "OÖÓ", "CÇ", "ФВЯЗКЬТБЮ", "ΔΠΨΩ"):
        drawn = [font.glyph(character) for character in characters]
        assert all(glyph is not font.box and glyph.any() for glyph in drawn)
        assert all(len(glyph) >= font.height for glyph in drawn)
        pictures = {(glyph.shape, glyph.tobytes()) for glyph in drawn}
        assert len(pictures) == len(characters)


def test_the_small_fonts_have_all_letters_digits_and_common_signs():
    for (
        character
    ) in "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:;!?'\"-+*/\\=()[]<>%&#@_":
        assert TINY.has(character), character
        assert character in NORMAL.glyphs, character
    for character in "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:!?'-+/()×&◄►":
        assert character in BOLD.glyphs, character
    for character in "0123456789,":
        assert character in HUGE.glyphs, character


@pytest.mark.parametrize("font", FONTS, ids=lambda font: font.name)
def test_no_two_signs_look_alike(font):
    seen: dict[bytes, str] = {}
    alike = {frozenset("0O"), frozenset("’'"), frozenset("-–"), frozenset("–—")}
    for character, glyph in font.glyphs.items():
        other = seen.setdefault(bytes([glyph.shape[1]]) + glyph.tobytes(), character)
        assert other == character or frozenset((other, character)) in alike, (other, character)


@pytest.mark.parametrize("font", FONTS, ids=lambda font: font.name)
def test_digits_are_equally_wide_so_that_a_counting_score_stands_still(font):
    assert len({font.glyph(digit).shape[1] for digit in "0123456789"}) == 1


@given(value=st.integers(0, 10**24), width=st.integers(60, WIDTH))
def test_a_number_fits_or_has_the_narrowest_font(value, width):
    dots = Dots()
    font = dots.number(value, WIDTH // 2, 0, width)
    text = f"{value:,}"
    assert font is TINY or font.width(text) <= width
    larger = FONTS[FONTS.index(font) + 1 :]
    assert all(one.width(text) > width for one in larger)


def test_scores_below_a_thousand_million_are_written_large():
    assert Dots().number(999_999_999, WIDTH // 2, 1) is HUGE
    assert Dots().number(1_000_000_000_000, WIDTH // 2, 1) is not HUGE


def test_fitting_takes_the_first_font_that_is_narrow_enough():
    assert fitting("PLAY", WIDTH) is BOLD
    assert fitting("A" * 20, WIDTH) is NORMAL
    assert fitting("A" * 200, WIDTH) is TINY


def test_inverting_twice_changes_nothing():
    dots = some_picture(1)
    before = dots.copy()
    dots.invert(10, 3, 70, 9)
    assert (dots.pixels != before.pixels).any()
    dots.invert(10, 3, 70, 9)
    assert (dots.pixels == before.pixels).all()


def test_of_a_sprite_and_the_ground_the_brighter_dot_wins():
    dots = Dots()
    dots.clear(100)
    dots.sprite(picture("#. .+", ".+#"), 20, 10)
    assert dots.pixels[10:12, 20:22].tolist() == [[254, 100], [100, 127]]


@pytest.mark.parametrize("change", [blend, wipe, scroll])
def test_a_change_begins_with_the_old_picture_and_ends_with_the_new_one(change):
    before, after = some_picture(1), some_picture(2)
    assert (change(before, after, 0.0).pixels == before.pixels).all()
    assert (change(before, after, 1.0).pixels == after.pixels).all()
    half = change(before, after, 0.5).pixels
    assert (half != before.pixels).any()
    assert (half != after.pixels).any()


@pytest.mark.parametrize("direction", ["left", "right", "up", "down"])
@pytest.mark.parametrize("change", [wipe, scroll])
def test_changes_run_in_all_directions_and_end_there(change, direction):
    before, after = some_picture(3), some_picture(4)
    assert (change(before, after, 0.0, direction).pixels == before.pixels).all()
    assert (change(before, after, 1.0, direction).pixels == after.pixels).all()


def test_a_wipe_to_the_right_leaves_the_new_picture_on_the_left():
    before, after = Dots(), Dots()
    after.clear(50)
    half = wipe(before, after, 0.5, "right").pixels
    edge = int(np.argmax(half[0]))
    assert half[0, edge] == FULL
    assert (half[:, :edge] == 50).all()
    assert not half[:, edge + 1 :].any()


def test_scrolling_up_moves_the_old_picture_up_and_the_new_one_behind_it():
    before, after = some_picture(5), some_picture(6)
    half = scroll(before, after, 0.25, "up").pixels
    assert (half[: HEIGHT - 8] == before.pixels[8:]).all()
    assert (half[HEIGHT - 8 :] == after.pixels[:8]).all()
