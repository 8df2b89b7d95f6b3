"""The dot panel: every dot is a light at every size, and unchanged dots are not drawn again."""

import numpy as np
import pygame
import pytest

from silverball.drawing.dotmatrix import panel as dotpanel
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.panel import DotPanel

SIZES = [(690, 138), (1600, 320), (333, 80), (160, 32), (100, 20), (31, 7), (1, 1), (700, 40), (40, 300)]


def pixels(surface: pygame.Surface) -> np.ndarray:
    """Red, green and blue, shape [row, column, 3]."""
    return pygame.surfarray.array3d(surface).swapaxes(0, 1).astype(int)


def drawn(dots: Dots, size: tuple[int, int], bits: int = 32, **options) -> np.ndarray:
    """A panel in a picture of its own size."""
    masks = (0xFF, 0xFF00, 0xFF0000, 0) if bits == 24 else (0xFF0000, 0xFF00, 0xFF, 0)
    target = pygame.Surface(size, 0, bits, masks)
    DotPanel(pygame.Rect((0, 0), size), **options).draw(target, dots)
    return pixels(target)


@pytest.mark.parametrize("size", SIZES)
def test_it_draws_inside_its_area_only_at_any_size(size):
    dots = Dots()
    dots.clear(255)
    target = pygame.Surface((size[0] + 20, size[1] + 20), 0, 32)
    target.fill((1, 2, 3))
    DotPanel(pygame.Rect((10, 10), size)).draw(target, dots)
    picture = pixels(target)
    inside = np.zeros(picture.shape[:2], bool)
    inside[10 : 10 + size[1], 10 : 10 + size[0]] = True
    assert (picture[~inside] == (1, 2, 3)).all()
    assert (picture[inside] != (1, 2, 3)).any(axis=-1).all()


@pytest.mark.parametrize("size", [(690, 138), (400, 80), (160, 32), (100, 20)])
def test_a_dot_that_is_lit_shines_at_its_place(size):
    dark, lit = Dots(), Dots()
    lit.box(40, 8, 4, 4)
    difference = drawn(lit, size, frame=None).sum(axis=2) - drawn(dark, size, frame=None).sum(axis=2)
    row, column = np.unravel_index(int(difference.argmax()), difference.shape)
    # The dots lie in the middle of the area, with equal margins.
    spacing = min(size[0] / WIDTH, size[1] / HEIGHT)
    assert abs((column + 0.5 - size[0] / 2) / spacing - (42 - WIDTH / 2)) < 5.5
    assert abs((row + 0.5 - size[1] / 2) / spacing - (10 - HEIGHT / 2)) < 3.0
    assert difference.max() > 150


@pytest.mark.parametrize("size", [(700, 200), (900, 140), (500, 99), (150, 90)])
def test_the_dots_lie_in_the_middle_of_their_area(size):
    dots = Dots()
    dots.clear(255)
    light = drawn(dots, size, background=(0, 0, 0), frame=None).sum(axis=2) > 100
    for axis in (0, 1):
        lit = np.flatnonzero(light.any(axis=axis))
        before, after = lit[0], light.shape[1 - axis] - 1 - lit[-1]
        assert abs(before - after) <= 2


def test_brighter_dots_give_more_light_and_dark_ones_a_little():
    light = []
    for level in (0, 60, 130, 255):
        dots = Dots()
        dots.clear(level)
        light.append(int(drawn(dots, (690, 138), frame=None, background=(0, 0, 0)).sum()))
    assert light == sorted(set(light))
    assert 0 < light[0] < 0.2 * light[-1]


def test_a_lit_dot_throws_light_on_the_glass_around_it():
    dark, lit = Dots(), Dots()
    lit.dot(80, 16)
    more = (drawn(lit, (1280, 256), frame=None) - drawn(dark, (1280, 256), frame=None)).sum(axis=2)
    beside = more[128:136, 632:640]  # the dot to the left, which is off
    far = more[128:136, 400:408]
    assert beside.max() > 0
    assert far.max() == 0


def test_small_panels_show_the_average_of_dots():
    stripes = Dots()
    stripes.pixels[:, ::2] = 255
    small = drawn(stripes, (WIDTH // 2, HEIGHT // 2), frame=None)
    assert np.ptp(small[2:-2, 2:-2].sum(axis=2)) < 40  # even grey, no stripes
    full, dark = Dots(), Dots()
    full.clear(255)
    size = (WIDTH // 2, HEIGHT // 2)
    assert drawn(dark, size, frame=None).mean() < small.mean() < drawn(full, size, frame=None).mean()


def test_the_colour_is_that_of_the_theme():
    dots = Dots()
    dots.clear(160)
    red = drawn(dots, (690, 138), color=(255, 0, 0), background=(0, 0, 0), frame=None)
    assert red[..., 0].max() > 150
    assert red[..., 1].max() < 60


def test_all_picture_formats_show_the_same():
    dots = Dots()
    dots.text("HELLO", 3, 3)
    assert (drawn(dots, (690, 138), 24) == drawn(dots, (690, 138), 32)).all()


def test_it_works_only_when_the_dots_have_changed(monkeypatch):
    calls = []
    light = dotpanel._glow
    monkeypatch.setattr(dotpanel, "_glow", lambda levels: calls.append(1) or light(levels))
    dots, target = Dots(), pygame.Surface((690, 138), 0, 32)
    panel = DotPanel(target.get_rect())
    panel.draw(target, dots)
    panel.draw(target, dots.copy())
    assert len(calls) == 1
    dots.dot(5, 5)  # the same object, another picture
    panel.draw(target, dots)
    assert len(calls) == 2


def test_it_never_paints_onto_the_dots():
    dots = Dots()
    dots.text("HELLO", 3, 3, brightness=77)
    before = dots.pixels.copy()
    drawn(dots, (690, 138))
    assert (dots.pixels == before).all()
