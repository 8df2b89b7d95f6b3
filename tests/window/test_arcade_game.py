"""A whole arcade game: from the menu to the initials to the score table, by keys and by gamepad."""

from __future__ import annotations

import pygame
import pytest
from machines import leaky

from silverball.game.replay.format import Replay
from silverball.game.replay.verify import verify
from silverball.game.scores.store import Store
from silverball.game.view import Mode, Phase


def play_all_balls(player, create) -> None:
    """Bring ball after ball until the game is over."""
    for _ in range(20):
        if player.game.is_over:
            return
        create()
        player.until(lambda: player.game.phase is not Phase.PLAY, 60.0)
    raise AssertionError("the game does not end")


def choose(player, label: str, hands=None) -> None:
    """Go to a row of the page that is open, and choose it."""
    do = hands or with_keys(player)
    for _ in player.menus.listing.rows:
        if player.menus.listing.rows[player.menus.listing.chosen].label == label:
            do["start"]()
            return
        do["right"]()
    raise AssertionError(f"{label} is not on the page {player.menus.page}")


def with_keys(player):
    return {
        "left": lambda: player.tap(pygame.K_a),
        "right": lambda: player.tap(pygame.K_d),
        "start": lambda: player.tap(pygame.K_SPACE),
    }


def with_pad(player):
    return {
        "left": lambda: player.tap_pad(pygame.CONTROLLER_BUTTON_LEFTSHOULDER),
        "right": lambda: player.tap_pad(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER),
        "start": lambda: player.tap_pad(pygame.CONTROLLER_BUTTON_A),
    }


@pytest.mark.parametrize("hands", [with_keys, with_pad])
def test_a_game_from_the_menu_to_the_score_table(open_window, tmp_path, hands):
    player = open_window(leaky(), seed=3, mode=None)
    do = hands(player)
    assert player.menus.page == "main"
    do["start"]()  # play
    assert player.program.is_playing
    assert player.game.mode is Mode.ARCADE
    play_all_balls(player, do["start"])
    score = player.game.score
    assert score > 0
    player.frames(1)
    with Store(tmp_path / "data") as other:  # kept before any page tells of it
        assert [row.score for row in other.scores()] == [score]
    player.until(lambda: player.menus.page == "initials")
    do["right"]()  # A → B
    do["start"]()
    do["start"]()  # the second letter stays
    do["right"]()
    do["right"]()
    do["start"]()
    do["start"]()  # END
    player.until(lambda: player.menus.page == "over", 5.0)
    choose(player, "MENU", do)
    assert player.menus.page == "main"
    choose(player, "SCORES", do)
    assert player.menus.page == "scores"
    shown = player.program._catalog.scores(player.program.settings.current.table, Mode.ARCADE)
    assert [(row.initials, row.score) for row in shown] == [("BAC", score)]
    with Store(tmp_path / "data") as other:
        (row,) = other.scores()
        assert (row.initials, row.score) == ("BAC", score)
        verdict = verify(Replay.from_text(other.replay(row.id)))
    assert verdict.ok
    assert verdict.score == score


def test_a_game_is_watched_again_from_its_last_page(open_window):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    score = player.game.score
    player.until(lambda: player.menus.page == "initials")
    player.tap(pygame.K_ESCAPE)
    player.until(lambda: player.menus.page in ("over", "initials"), 5.0)
    while player.menus.page == "initials":
        player.tap(pygame.K_SPACE)
    choose(player, "WATCH IT")
    assert player.menus.page == "transport"
    assert player.game.score == 0
    player.tap(pygame.K_d)
    assert player.program.speed == 2.0
    for _ in range(3):
        player.tap(pygame.K_d)
    assert player.program.speed == 16.0
    player.until(lambda: player.program.session.has_ended)
    assert player.game.score == score
    player.tap(pygame.K_a)  # at its end the paddles jump
    assert not player.program.session.has_ended
    player.tap(pygame.K_ESCAPE)
    assert player.menus.page == "over"


def test_a_replay_stands_still_and_goes_on_tick_by_tick(open_window):
    first = open_window(seed=5)
    first.tap(pygame.K_SPACE)
    first.press(pygame.K_a)
    first.seconds(3.0)
    replay = first.game.replay
    first.release(pygame.K_a)
    player = open_window(replay=replay, table=None, mode=None)
    assert player.menus.page == "transport"
    player.seconds(1.0)
    player.tap(pygame.K_SPACE)
    tick = player.world.tick
    player.seconds(0.5)
    assert player.world.tick == tick
    player.tap(pygame.K_n)
    assert player.world.tick == tick + 1
    player.tap(pygame.K_SPACE)
    player.until(lambda: player.program.session.has_ended)
    assert player.game.digest() == replay.digest


def test_a_remapped_key_works_at_once_and_at_the_next_start(open_window):
    player = open_window(mode=None)
    for label in ("SETTINGS", "KEYS", "LEFT PADDLE", "NEW KEY"):
        choose(player, label)
    player.until(lambda: player.menus.wants_key, 5.0)
    player.tap(pygame.K_q)
    player.frames(2)
    assert "q" in player.program.settings.current.keys["left"]
    player.window.close()
    again = open_window()
    rest = again.world.paddles[0].angle
    again.press(pygame.K_q)
    again.seconds(0.1)
    assert again.world.paddles[0].angle > rest
    again.release(pygame.K_q)
    again.frames(1)


def test_attract_mode_plays_by_itself_after_half_a_minute_and_any_button_ends_it(open_window):
    player = open_window(mode=None)
    player.seconds(29.0)
    assert player.menus.page == "main"
    player.seconds(3.0)
    assert player.menus.page == "attract"
    tick = player.world.tick
    player.seconds(3.0)
    assert player.world.tick > tick
    assert player.world.balls
    player.tap(pygame.K_a)
    assert player.menus.page == "main"


@pytest.mark.rehearsed
def test_the_planner_takes_over_the_show_and_can_be_watched_until_a_key_is_pressed(open_window):
    player = open_window(mode=None)
    player.window.player_warmup.wait(300.0)
    player.seconds(31.0)
    assert player.menus.page == "attract"
    assert player.program.session.player.name == "planner"
    player.tap(pygame.K_z)
    assert player.menus.page == "main"
    for key in (pygame.K_d, pygame.K_d, pygame.K_d, pygame.K_SPACE, pygame.K_d, pygame.K_SPACE):
        player.tap(key)
    assert player.menus.page == ""
    assert player.program.session.player.name == "trained"
    player.tap(pygame.K_a)
    player.tap(pygame.K_a)
    player.tap(pygame.K_SPACE)
    assert player.program.session.player.name == "planner"
    tick = player.world.tick
    player.seconds(1.0)
    assert player.world.tick > tick
    player.tap(pygame.K_r)
    assert player.menus.page == "watch"


def test_a_slowed_game_is_not_in_the_score_table(open_window):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    player.tap(pygame.K_COMMA)
    player.tap(pygame.K_PERIOD)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    player.until(lambda: player.menus.page == "over")
    assert player.window.store.scores() == []


def test_free_play_has_no_end_and_no_place_in_the_score_table(open_window):
    player = open_window(leaky(), seed=3)
    for _ in range(5):
        player.tap(pygame.K_SPACE)
        player.until(lambda: player.game.phase is not Phase.PLAY)
    assert not player.game.is_over
    assert player.window.store.scores() == []


def test_two_windows_on_one_score_database_lose_nothing(open_window, tmp_path):
    first = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(first, lambda: first.tap(pygame.K_SPACE))
    first.frames(1)
    second = open_window(leaky(), seed=4, mode=Mode.ARCADE)
    play_all_balls(second, lambda: second.tap(pygame.K_SPACE))
    second.frames(1)
    with Store(tmp_path / "data") as store:
        assert len(store.scores()) == 2


def key(player, key: int, unicode: str) -> None:
    """A key with what it writes, pressed and released."""
    scancode = pygame.KSCAN_A + key - pygame.K_a if pygame.K_a <= key <= pygame.K_z else 0
    for kind in (pygame.KEYDOWN, pygame.KEYUP):
        pygame.event.post(pygame.Event(kind, key=key, mod=0, unicode=unicode, scancode=scancode))
    player.frames(1)


@pytest.mark.parametrize("writes", [True, False])
@pytest.mark.parametrize("done", [pygame.K_RETURN, pygame.K_SPACE])
def test_initials_are_typed_and_letters_that_are_keys_of_the_game_do_nothing_else(
    open_window, tmp_path, writes, done
):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    player.until(lambda: player.menus.page == "initials")
    before = player.program.settings.current
    for letter in "mpr":  # mute, pause, new board
        key(player, ord(letter), letter if writes else "")
    assert player.menus.page == "initials"
    key(player, pygame.K_BACKSPACE, "\b" if writes else "")
    for letter in "da":
        key(player, ord(letter), letter if writes else "")
    key(player, done, "")
    assert player.menus.page == "over"
    assert player.program.settings.current == before.changed(initials="MPD")
    with Store(tmp_path / "data") as other:
        assert [row.initials for row in other.scores()] == ["MPD"]


def test_initials_that_nobody_enters_are_taken_as_offered_and_the_show_begins(open_window, tmp_path):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    player.until(lambda: player.menus.page == "initials")
    player.tap(pygame.K_F1)  # help that was left open is closed too
    player.seconds(32.0)
    assert player.menus.page == "attract"
    assert not player.window.input_handler.shows_help
    tick = player.world.tick
    player.seconds(1.0)
    assert player.world.tick > tick
    with Store(tmp_path / "data") as other:
        assert [row.initials for row in other.scores()] == ["AAA"]


def test_the_last_ball_leaves_the_picture_when_the_game_is_over(open_window):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    effects = player.window._picture.renderer.effects
    asked = []
    real = effects.sinking_balls
    effects.sinking_balls = lambda time: asked.append(list(real(time))) or iter(asked[-1])
    player.seconds(0.1)
    assert asked[0]  # it is on its way
    player.seconds(0.5)
    assert asked[-1] == []
    assert not player.world.balls


def test_going_back_in_a_replay_leaves_no_ball_behind_that_is_not_lost_yet(open_window):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
    replay = player.game.replay
    again = open_window(replay=replay, table=None, mode=None)
    again.until(lambda: again.program.session.has_ended)
    effects = again.window._picture.renderer.effects
    assert effects._sinking
    again.program.watching.jump(-0.5 * replay.ticks / replay.tick_rate)
    again.frames(2)
    assert not effects._sinking


@pytest.mark.parametrize("press", [
    lambda player: player.tap(pygame.K_SPACE), lambda player: player.tap_pad(pygame.CONTROLLER_BUTTON_A)
])  # fmt: skip
def test_a_second_ball_is_spent_by_a_second_press_only(open_window, press):
    player = open_window("classic", seed=3, mode=Mode.ARCADE)
    press(player)
    for _ in range(10):
        press(player)
    assert player.world.created == 1
    player.seconds(1.1)
    press(player)
    assert player.world.created == 1
    player.seconds(0.5)
    press(player)
    assert player.world.created == 2
