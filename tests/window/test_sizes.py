"""Windows of any size, screens of any size and number, and the mouse pointer."""

from __future__ import annotations

import time

import pygame
import pytest

from silverball.app import sdl
from silverball.app.arrangement import fitted
from silverball.app.picture import MAX_DRAWN, SETTLE_TIME, Picture
from silverball.app.screen import DECORATION, FRAME_RATES, HIDE_AFTER, MIN_SIZE, TITLE_BAR, Screen
from silverball.app.settings import Settings
from silverball.drawing import Moment
from silverball.table import Board, load_table

SIDES = (1, 2, 3, 7, 16, 40, 170, 400)
SHAPES = [
    *((side, side) for side in SIDES),
    *((side, 2000) for side in SIDES),
    *((2000, side) for side in SIDES),
    (16384, 16), (16, 16384), (16384, 1), (1, 16384), (320, 240), (800, 480), (1080, 1920), (5120, 1440),
]  # fmt: skip
SCREENS = [
    (320, 240), (480, 320), (800, 480), (480, 800), (1024, 600), (1366, 768), (1080, 1920), (1280, 1024),
    (1920, 1080), (2560, 1080), (5120, 1440), (3840, 2160), (2160, 3840), (7680, 4320), (240, 3000),
]  # fmt: skip


def shrinkable(player) -> Screen:
    """The screen of a window that a desktop may make as small as it likes, as a tiling one does."""
    screen = player.window._screen
    screen._window.minimum_size = (1, 1)
    return screen


@pytest.mark.parametrize("extra", [None, pygame.K_F1, pygame.K_F3, pygame.K_p])
def test_a_window_survives_every_shape_with_all_that_can_be_shown_on_it(player, extra):
    screen = shrinkable(player)
    player.tap(pygame.K_SPACE)
    if extra is not None:
        player.tap(extra)
    for shape in SHAPES:
        screen.resize(shape)
        player.window.messages.show(f"a message on a window of {shape}")
        player.frames(2)
        assert player.window.size == shape
        assert pygame.Rect((0, 0), shape).contains(player.window._picture.area)
    screen.resize((300, 400))
    player.frames(2)
    assert player.window._picture.area.height == 400


@pytest.mark.parametrize("shape", [(1, 1), (2, 1), (1, 2000), (2000, 2), (9, 9)])
def test_a_tiny_window_is_drawn_anew_when_its_size_has_stood_and_comes_back_well(player, shape):
    screen = shrinkable(player)
    player.frames(1)
    before = pygame.surfarray.array3d(screen.surface)
    size = player.window.size
    for new in (shape, size):
        screen.resize(new)
        limit = time.monotonic() + 120.0
        player.frames(1)
        while player.window._picture.renderer.camera.size != player.window._picture.area.size:
            assert time.monotonic() < limit
            time.sleep(SETTLE_TIME / 5)
            player.frames(1, 0.0)
    player.tap(pygame.K_p)
    player.tap(pygame.K_p)
    player.frames(1)
    after = pygame.surfarray.array3d(screen.surface)
    assert after.shape == before.shape
    assert abs(after.astype(int) - before.astype(int)).mean() < 5.0


@pytest.mark.parametrize("window", [*SHAPES, (7680, 4320), (16384, 16384)])
def test_a_table_fits_into_every_window_and_is_at_least_a_pixel(window):
    for board in (Board(), Board(length=4.0, width=40.0), Board(length=50.0, width=2.0)):
        area = fitted(board, window)
        assert pygame.Rect((0, 0), window).contains(area)
        assert min(area.size) >= 1


def test_a_gigantic_window_takes_no_gigabyte():
    table = load_table("classic")
    picture = Picture((16384, 16384))
    picture.show(table, None, Settings())
    assert picture.renderer.camera.size[1] <= MAX_DRAWN < picture.area.height
    assert picture.renderer.camera.size[0] * picture.renderer.camera.size[1] < 16e6
    window = pygame.Surface((6000, 6000))
    picture.draw(Moment.before(table), window)
    picture.close()


@pytest.mark.parametrize("size", SCREENS)
def test_the_first_window_fits_every_screen(open_window, monkeypatch, size):
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [size])
    monkeypatch.setattr(sdl, "display_bounds", lambda screen: pygame.Rect((0, 0), size))
    for bars in ((0, 0), (0, 60), (80, 0), (70, 140)):
        usable = pygame.Rect(bars, (size[0] - bars[0], size[1] - bars[1]))
        monkeypatch.setattr(sdl, "usable_bounds", lambda screen, usable=usable: usable)
        screen = Screen("a test", without_display=True)
        room = screen.max_initial_size
        assert room[0] <= usable.width
        assert room[1] <= usable.height - TITLE_BAR
        assert room[1] <= size[1] - DECORATION
        area = fitted(load_table("classic").board, room)
        screen.open(area.size)
        assert screen.surface.get_size() == area.size
        least = screen._window.minimum_size
        assert all(one <= min(most) for one, *most in zip(least, MIN_SIZE, area.size, strict=True))
        screen.close()


def test_the_first_window_of_a_wide_table_is_not_wider_than_the_screen(monkeypatch):
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [(1080, 1920)])
    screen = Screen("a test", without_display=True)
    assert fitted(Board(length=8.0, width=40.0), screen.max_initial_size).width <= 1080
    screen.close()


def monitors(monkeypatch, rates, sizes) -> None:
    """Pretend monitors side by side; SDL's dummy driver has but one."""
    monkeypatch.setattr(pygame.display, "get_desktop_refresh_rates", lambda: list(rates))
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: list(sizes))
    monkeypatch.setattr(sdl, "display_index", lambda window: None)


@pytest.mark.parametrize("rates", [(60, 144), (144, 60), (75, 240), (60, 0), (0, 120), (30, 500)])
def test_the_rate_is_that_of_the_monitor_on_which_the_window_stands(player, monkeypatch, rates):
    monitors(monkeypatch, rates, [(1920, 1080), (2560, 1440)])
    window = player.window._screen._window
    for x, monitor in ((100, 0), (2500, 1), (0, 0), (1920, 1), (-50, 0), (9999, 1)):
        window.position = (x, 50)
        expected = min(max(rates[monitor], FRAME_RATES[0]), FRAME_RATES[1])
        assert player.window.frame_rate == expected


def test_a_monitor_that_is_unplugged_leaves_a_rate(player, monkeypatch):
    monitors(monkeypatch, (60, 144), [(1920, 1080), (2560, 1440)])
    player.window._screen._window.position = (2500, 200)
    assert player.window.frame_rate == 144
    monitors(monkeypatch, (75,), [(1920, 1080)])
    assert player.window.frame_rate == 75
    monitors(monkeypatch, (), [])
    assert player.window.frame_rate == FRAME_RATES[0]


def test_where_sdl_knows_the_monitor_it_is_believed(player, monkeypatch):
    monitors(monkeypatch, (60, 144), [(1920, 1080), (2560, 1440)])
    monkeypatch.setattr(sdl, "display_bounds", lambda screen: pygame.Rect(0, 0, 1, 1))
    for number, rate in ((1, 144), (0, 60), (2, FRAME_RATES[0])):
        monkeypatch.setattr(sdl, "display_index", lambda window, number=number: number)
        assert player.window.frame_rate == rate


def move(player) -> None:
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=(5, 5), rel=(1, 0), buttons=(0, 0, 0)))
    player.frames(1)


def test_the_pointer_hides_after_two_seconds_and_comes_back_when_it_is_moved(player):
    move(player)
    for _ in range(2):
        player.frames(round(10 * (HIDE_AFTER - 0.2)), 0.1)
        assert pygame.mouse.get_visible()
        player.frames(4, 0.1)
        assert not pygame.mouse.get_visible()
        move(player)
        assert pygame.mouse.get_visible()


@pytest.mark.parametrize("full", [False, True])
def test_the_pointer_comes_back_for_a_pause_and_stays_while_the_window_has_no_focus(player, full):
    if full:
        player.tap(pygame.K_F11)
    player.seconds(HIDE_AFTER + 0.2)
    assert not pygame.mouse.get_visible()
    player.tap(pygame.K_p)
    assert pygame.mouse.get_visible()
    player.seconds(HIDE_AFTER + 0.2)
    assert not pygame.mouse.get_visible()
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    player.seconds(HIDE_AFTER + 1.0)
    assert pygame.mouse.get_visible()
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSGAINED))
    player.seconds(HIDE_AFTER + 0.2)
    assert not pygame.mouse.get_visible()


def test_keys_alone_do_not_bring_the_pointer_back(player):
    player.seconds(HIDE_AFTER + 0.2)
    player.tap(pygame.K_a)
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=(5, 5), rel=(0, 0), buttons=(0, 0, 0)))
    player.frames(2)
    assert not pygame.mouse.get_visible()
