"""A wide window: the backglass fills what is beside the table; mouse, wheel and keys work its lists."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from rule_tables import comet
from silverball.app.arrangement import arranged, opening_size
from silverball.app.backglass.backglass import places
from silverball.drawing.themes import ROOM
from silverball.game.view import Mode
from silverball.table import Board, load_table

SIZE = (960, 540)
WIDE_SIZES = [(1920, 1080), (1366, 768), (800, 480), (2560, 1080), (5120, 1440), (480, 320)]


@pytest.fixture
def wide(open_window):
    def opener(table="classic", mode=None, size=SIZE, **options):
        player = open_window(table, mode=mode, **options)
        resize(player, size)
        return player

    return opener


def resize(player, size) -> None:
    player.window._screen._window.minimum_size = (1, 1)
    player.window._screen.resize(size)
    player.frames(1)
    player.window._picture._resized = -1e9  # as if the size had settled
    player.frames(2)


def pixels(player):
    return pygame.surfarray.array3d(player.window._screen.surface).astype(int)


def point(player, index: int, kind: int = pygame.MOUSEMOTION, button: int = 1, right: float = 0.5) -> None:
    """Move the mouse to a row of the list, or click on it."""
    cells = player.window._backglass.list_view._cells
    cell = next(cell.area for cell in cells if cell.row == index)
    position = round(cell.left + right * cell.width), cell.centery
    rest = {"rel": (3, 1), "buttons": (0, 0, 0)} if kind == pygame.MOUSEMOTION else {"button": button}
    pygame.event.post(pygame.Event(kind, pos=position, **rest))
    player.frames(1)


def click(player, index: int, button: int = 1, right: float = 0.5) -> None:
    point(player, index, pygame.MOUSEBUTTONDOWN, button, right)


def wheel(player, steps: int) -> None:
    pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=steps))
    player.frames(1)


def labels(player) -> list[str]:
    return [row.label for row in player.menus.listing.rows]


@pytest.mark.parametrize("size", WIDE_SIZES)
def test_a_wide_window_has_a_table_and_a_backglass_side_by_side(size):
    board = load_table("classic").board
    table, backglass, _ = arranged(board, size)
    assert backglass is not None
    window = pygame.Rect((0, 0), size)
    assert window.contains(table)
    assert window.contains(backglass)
    assert not table.colliderect(backglass)
    assert abs(table.height - size[1]) <= 1
    assert table.width > arranged(board, (size[1] // 2, size[1])).table.width  # no panel above the board
    at = places(backglass)
    for part in (at.title, at.display, at.cells, at.body, at.inner_body):
        assert backglass.contains(part)
        assert min(part.size) > 0


@pytest.mark.parametrize("size", [(390, 844), (1080, 1920), (700, 1000), (1000, 1000), (300, 200)])
def test_a_narrow_window_shows_the_table_alone(size):
    assert arranged(load_table("classic").board, size).backglass is None


def test_a_new_window_is_wide_on_a_wide_screen_and_narrow_on_a_narrow_one():
    board = load_table("classic").board
    assert opening_size(board, (1904, 992))[0] > 1.4 * 992
    assert opening_size(board, (1064, 1200))[0] < 1064
    for room in ((1904, 992), (464, 232), (1064, 1200), (5104, 1200)):
        size = opening_size(board, room)
        assert all(side <= most for side, most in zip(size, room, strict=True))
    assert arranged(Board(length=8.0, width=40.0), (1904, 992)).backglass is None


@pytest.mark.parametrize("size", [(960, 540), (1000, 400), (700, 690), (500, 500)])
def test_no_window_has_black_bars(wide, size):
    player = wide(size=size)
    seen = pixels(player)
    area = player.window._picture.area
    beside = np.concatenate([seen[: area.left].reshape(-1, 3), seen[area.right :].reshape(-1, 3)])
    assert len(beside) > 1000
    assert (beside.sum(axis=1) <= sum(ROOM)).mean() < 0.9
    assert len(np.unique(beside, axis=0)) > 30


def test_nothing_beside_the_table_is_drawn_again_that_has_not_changed(wide, monkeypatch):
    player = wide(mode=Mode.ARCADE)
    backglass = player.window._backglass
    player.frames(2)
    drawn = []
    pane = backglass._pane
    monkeypatch.setattr(backglass, "_pane", lambda window, area: drawn.append(area) or pane(window, area))
    player.frames(30)
    assert drawn == []
    player.tap(pygame.K_p)
    assert drawn


def test_what_is_drawn_in_parts_is_what_would_be_drawn_at_once(wide):
    player = wide(comet(), mode=Mode.ARCADE)
    player.tap(pygame.K_SPACE)
    for key in (None, pygame.K_p, pygame.K_DOWN, pygame.K_F1, pygame.K_F1, pygame.K_ESCAPE):
        if key is not None:
            player.tap(key)
        player.frames(20)
        player.frames(1, 0.0)
        before = pixels(player)
        player.window._backglass.invalidate()
        player.frames(1, 0.0)
        assert np.array_equal(before, pixels(player)), key


def test_the_mouse_selects_what_it_points_at_and_a_click_chooses_it(wide):
    player = wide()
    point(player, 4)
    assert player.menus.listing.chosen == 4
    click(player, labels(player).index("SETTINGS"))
    assert player.menus.page == "settings"
    click(player, 0, button=3)
    assert player.menus.page == "main"


def test_a_row_of_a_long_list_stays_under_the_mouse_that_points_at_it(wide):
    player = wide(size=(640, 360))
    cells = player.window._backglass.list_view._cells
    assert len(cells) < len(labels(player))
    for place in [cell.area.center for cell in (*cells, *reversed(cells))]:
        pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=place, rel=(3, 1), buttons=(0, 0, 0)))
        player.frames(2)
        hit = player.window._backglass.list_view.at(place)
        assert hit.row == player.menus.listing.chosen
    player.tap(pygame.K_DOWN)
    for _ in labels(player):  # keys reach all rows
        player.tap(pygame.K_DOWN)
        chosen = player.menus.listing.chosen
        assert chosen in {cell.row for cell in player.window._backglass.list_view._cells}


def test_a_page_that_opens_under_a_resting_pointer_keeps_its_selection(wide):
    player = wide()
    cell = player.window._backglass.list_view._cells[3].area
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=cell.center, rel=(0, 0), buttons=(0, 0, 0)))
    player.frames(1)
    assert player.menus.listing.chosen == 0


def test_a_click_on_play_begins_a_game_and_the_pause_is_a_list_too(wide):
    player = wide()
    click(player, 0)
    assert player.program.has_game
    player.tap(pygame.K_p)
    assert labels(player)[0] == "RESUME"
    click(player, 0)
    assert player.program.is_playing


def test_arrows_and_clicks_change_a_setting_in_both_directions(wide):
    player = wide()
    player.tap(pygame.K_DOWN)
    assert labels(player)[player.menus.listing.chosen] == "MODE"
    before = player.program.settings.current.mode
    player.tap(pygame.K_RIGHT)
    assert player.program.settings.current.mode != before
    player.tap(pygame.K_LEFT)
    assert player.program.settings.current.mode == before
    click(player, labels(player).index("SETTINGS"))
    point(player, 1)
    assert labels(player)[1] == "VOLUME"
    volume = player.program.settings.current.volume
    click(player, 1, right=0.99)
    assert player.program.settings.current.volume == volume + 1
    arrow = player.window._backglass.list_view._cells[1].arrow
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=arrow.center, button=1))
    player.frames(1)
    assert player.program.settings.current.volume == volume


def test_the_wheel_moves_through_a_list(wide):
    player = wide()
    for step, index in ((-1, 1), (-2, 3), (1, 2), (2, 0)):
        wheel(player, step)
        assert player.menus.listing.chosen == index
    player.seconds(2.0)
    assert player.menus.listing.chosen == 0  # it does not repeat as a held paddle does


def test_initials_are_typed_chosen_with_paddles_or_clicked(wide):
    player = wide()
    for typed in ("dad", "BAT"):
        player.menus.open_over(1000, 1)
        player.frames(1)
        for letter in typed:
            player.tap(pygame.key.key_code(letter))
        player.tap(pygame.K_RETURN)
        assert player.program.settings.current.initials == typed.upper()
        assert player.menus.page == "over"
    player.menus.open_over(1000, 1)
    player.frames(1)
    for letter in ("C", "A", "B"):
        click(player, labels(player).index(letter))
    click(player, labels(player).index("END"))
    assert player.program.settings.current.initials == "CAB"
    player.menus.open_over(1000, 1)
    player.frames(1)
    for _ in range(2):
        player.tap(pygame.K_RIGHT)
    for _ in range(4):
        player.tap(pygame.K_SPACE)
    assert player.program.settings.current.initials == "EAB"


def test_the_help_is_on_the_backglass_and_a_click_turns_it(wide):
    player = wide(mode=Mode.ARCADE)
    before = pixels(player)
    player.tap(pygame.K_F1)
    first = pixels(player)
    backglass = player.window._picture.arrangement.backglass
    assert (before[backglass.left :] != first[backglass.left :]).any()
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(5, 5), button=1))
    player.frames(1)
    assert player.window.input_handler.help_page == 1
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(5, 5), button=3))
    player.frames(1)
    assert not player.window.input_handler.shows_help


def test_a_click_ends_the_attract_mode(wide):
    player = wide()
    player.menus.open_attract()
    player.frames(2)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(5, 5), button=1))
    player.frames(1)
    assert player.menus.page == "main"


def test_the_window_may_become_narrow_and_wide_again_at_any_time(wide):
    player = wide(mode=Mode.ARCADE)
    player.tap(pygame.K_SPACE)
    for size in ((390, 844), SIZE, (500, 500), SIZE):
        resize(player, size)
        has_backglass = player.window._picture.arrangement.backglass is not None
        assert has_backglass == (size == SIZE)
        assert player.window._picture.renderer.camera.has_panel != has_backglass
        assert player.window._backglass.list_view.is_shown is False
