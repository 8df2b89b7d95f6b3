"""A cabinet: the picture turned by a quarter, and the backglass on a second screen."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from silverball.app import sdl
from silverball.app.arrangement import arranged
from silverball.app.cabinet_mode import CabinetMode
from silverball.game.view import Mode
from silverball.table import load_table

TURNED = (CabinetMode.LEFT, CabinetMode.RIGHT)
QUARTERS = {CabinetMode.LEFT: 1, CabinetMode.RIGHT: -1}  # counter-clockwise, of rows and columns
SECOND = pygame.Rect(3000, 200, 1280, 720)


@pytest.fixture
def two_screens(monkeypatch) -> None:
    """A second screen beside the first; the dummy driver has only one."""
    monkeypatch.setattr(sdl, "screens", lambda: [pygame.Rect(0, 0, 3000, 2000), SECOND])


def window_of(player) -> pygame.Window:
    return player.window._screen._window


def rows_of_pixels(surface: pygame.Surface):
    return pygame.surfarray.array3d(surface).swapaxes(0, 1)


def click(player, window: pygame.Window, position) -> None:
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=position, button=1, window=window))
    player.frames(1)


def middle_of(player, label: str) -> tuple[int, int]:
    """Where a row of the list is on the surface with the backglass."""
    index = [row.label for row in player.menus.listing.rows].index(label)
    cells = player.window._backglass.list_view._cells
    return next(cell.area.center for cell in cells if cell.row == index)


@pytest.mark.parametrize("mode", TURNED)
def test_the_window_shows_the_upright_picture_turned_by_a_quarter(open_window, mode):
    player = open_window(cabinet=mode, size=(300, 500))
    assert window_of(player).size == (500, 300)
    assert player.window.size == (300, 500)
    shown = rows_of_pixels(window_of(player).get_surface())
    upright = rows_of_pixels(player.window._screen.surface)
    assert np.array_equal(shown, np.rot90(upright, QUARTERS[mode]))
    assert upright.std() > 10.0  # a table, not an empty picture


@pytest.mark.parametrize("mode", TURNED)
def test_a_turned_picture_is_the_one_of_a_window_that_is_not(open_window, tmp_path, mode):
    turned = open_window(cabinet=mode, size=(300, 500), folder=tmp_path / "turned")
    plain = open_window(size=(300, 500), folder=tmp_path / "plain")
    for player in (turned, plain):
        player.window._picture._resized = -1e9
        player.frames(3)
    assert turned.window._picture.arrangement == plain.window._picture.arrangement
    assert np.array_equal(
        rows_of_pixels(turned.window._screen.surface), rows_of_pixels(plain.window._screen.surface)
    )


@pytest.mark.parametrize("mode", list(CabinetMode))
def test_corners_of_the_window_are_corners_of_the_picture(mode):
    size, picture = (500, 300), mode.turned((500, 300))
    corners = {(x, y) for x in (0, size[0] - 1) for y in (0, size[1] - 1)}
    upright = {mode.to_upright(corner, size) for corner in corners}
    assert upright == {(x, y) for x in (0, picture[0] - 1) for y in (0, picture[1] - 1)}


@pytest.mark.parametrize("mode", TURNED)
def test_the_mouse_chooses_in_a_turned_list(open_window, mode):
    player = open_window(mode=None, cabinet=mode, size=(960, 540))  # turned, there is room for a backglass
    x, y = middle_of(player, "SCORES")
    place = (y, 959 - x) if mode is CabinetMode.LEFT else (539 - y, x)
    click(player, window_of(player), place)
    assert player.menus.page == "scores"


def test_the_menu_turns_the_picture_and_the_choice_is_kept(open_window):
    player = open_window(mode=None, size=(300, 500))
    player.program.settings.change(cabinet="left")
    player.frames(2)
    assert window_of(player).size == (300, 500)
    assert player.window.size == (500, 300)
    player.window.close()
    assert open_window(mode=None, size=(300, 500)).window.size == (300, 500)
    assert player.program.settings.current.cabinet is CabinetMode.LEFT


def test_the_backglass_fills_a_second_screen_and_the_table_its_own(open_window, two_screens):
    player = open_window(cabinet=CabinetMode.UPRIGHT, size=(540, 960))
    second = player.window._screen.second
    assert second.window.position == SECOND.topleft
    assert second.surface.get_size() == SECOND.size
    arrangement = player.window._picture.arrangement
    assert arrangement.is_apart
    assert arrangement.backglass == pygame.Rect((0, 0), SECOND.size)
    beside = arranged(load_table("classic").board, (540, 960)).table
    assert arrangement.table.width >= beside.width  # it has no panel
    before = rows_of_pixels(second.surface).astype(int)
    assert before.std() > 5.0
    player.program.display.show_message("HALLO", replace=True)
    player.frames(2)
    assert (np.abs(rows_of_pixels(second.surface) - before).max(axis=2) > 40).sum() > 100


def test_the_mouse_chooses_on_the_second_screen_and_not_on_the_first(open_window, two_screens):
    player = open_window(mode=None, cabinet=CabinetMode.LEFT, size=(540, 960))
    place = middle_of(player, "SCORES")
    click(player, window_of(player), place)
    assert player.menus.page == "main"
    click(player, player.window._screen.second.window, place)
    assert player.menus.page == "scores"


def test_keys_play_while_the_backglass_is_apart(open_window, two_screens):
    player = open_window(mode=Mode.FREE, cabinet=CabinetMode.RIGHT, size=(540, 960))
    player.tap(pygame.K_SPACE)
    assert len(player.world.balls) == 1
    player.press(pygame.K_a)
    player.frames(3)
    assert player.game.held[0]


@pytest.mark.parametrize("is_focused", [True, False])
def test_a_game_pauses_only_when_no_window_of_it_has_the_keys(
    open_window, two_screens, monkeypatch, is_focused
):
    player = open_window(mode=Mode.FREE, cabinet=CabinetMode.RIGHT, size=(540, 960))
    monkeypatch.setattr(pygame.key, "get_focused", lambda: is_focused)
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST, window=window_of(player)))
    player.frames(1)
    assert player.program.is_paused != is_focused


def test_without_cabinet_the_second_screen_closes_and_the_display_is_back_at_the_table(
    open_window, two_screens
):
    player = open_window(cabinet=CabinetMode.UPRIGHT, size=(540, 960))
    player.program.settings.change(cabinet="off")
    player.frames(2)
    assert player.window._screen.second is None
    arrangement = player.window._picture.arrangement
    assert arrangement.backglass is None
    assert not arrangement.is_apart


def test_with_one_screen_a_cabinet_keeps_the_display_at_the_table(open_window):
    player = open_window(cabinet=CabinetMode.UPRIGHT, size=(540, 960))
    assert player.window._screen.second is None
    assert player.window._picture.arrangement.backglass is None
