"""What the keys do in a game, pressed through SDL's own queue."""

from __future__ import annotations

import math

import pygame
import pytest

from silverball.game.view import Mode

TICK = 1 / 240  # [s]


def angles(player):
    return [math.degrees(paddle.angle) for paddle in player.world.paddles]


@pytest.mark.parametrize(
    ("key", "side"),
    [
        (pygame.K_a, 0),
        (pygame.K_LEFT, 0),
        (pygame.K_LSHIFT, 0),
        (pygame.K_d, 1),
        (pygame.K_RIGHT, 1),
        (pygame.K_RSHIFT, 1),
    ],
)
def test_a_paddle_key_lifts_its_paddle_within_the_stroke_and_release_brings_it_back(player, key, side):
    paddle = player.program.board.table.paddle[side]
    rest, up = paddle.rest_angle, paddle.up_angle
    assert angles(player) == pytest.approx([rest, rest])
    player.press(key)
    player.frames(math.ceil(paddle.stroke / TICK), TICK)
    assert angles(player)[side] == pytest.approx(up)
    assert angles(player)[1 - side] == pytest.approx(rest)
    player.release(key)
    player.frames(math.ceil(paddle.return_stroke / TICK), TICK)
    assert angles(player)[side] == pytest.approx(rest)


def test_a_paddle_stays_up_while_one_of_its_two_pressed_keys_is_held(player):
    up = player.program.board.table.paddle[0].up_angle
    player.press(pygame.K_a)
    player.press(pygame.K_LEFT)
    player.seconds(0.2)
    player.release(pygame.K_a)
    player.seconds(0.2)
    assert angles(player)[0] == pytest.approx(up)


def test_a_tap_between_two_frames_lifts_the_paddle_for_one_tick(player):
    paddle = player.program.board.table.paddle[0]
    per_tick = (paddle.up_angle - paddle.rest_angle) / paddle.stroke * TICK
    player.press(pygame.K_a)
    player.release(pygame.K_a)
    player.frames(1, TICK)
    assert angles(player)[0] == pytest.approx(paddle.rest_angle + per_tick)


def test_a_tap_is_not_lost_in_a_beat_too_short_for_a_tick(player):
    rest = player.program.board.table.paddle[0].rest_angle
    player.press(pygame.K_a)
    player.release(pygame.K_a)
    player.window.poll_input(0.1 * TICK)
    assert angles(player)[0] == pytest.approx(rest)
    player.window.poll_input(TICK)
    assert angles(player)[0] > rest


def test_a_button_reaches_the_simulation_at_the_next_tick_not_at_the_next_picture(player):
    player.frames(10)
    tick = player.world.tick
    player.press(pygame.K_a)
    player.window.poll_input(TICK)
    assert player.world.tick == tick + 1
    assert player.world.paddles[0].angular_velocity > 0.0
    assert len(player.window.latency.to_tick) == 1
    assert not player.window.latency.to_picture
    player.frames(1, TICK)
    assert len(player.window.latency.to_picture) == 1


def test_losing_focus_pauses_the_game_and_releases_the_keys(player):
    player.tap(pygame.K_SPACE)
    player.press(pygame.K_a)
    player.press(pygame.K_d)
    player.seconds(0.1)
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    player.frames(1)
    assert player.program.is_paused
    tick = player.world.tick
    player.seconds(0.5)
    assert player.world.tick == tick
    player.tap(pygame.K_SPACE)  # "resume"
    assert not player.program.is_paused
    player.seconds(0.3)
    assert angles(player) == pytest.approx(
        [paddle.rest_angle for paddle in player.program.board.table.paddle]
    )


def test_space_brings_two_balls_at_most_and_says_why_no_third(player):
    for count in (1, 2):
        player.tap(pygame.K_SPACE)
        assert len(player.world.balls) == count
        assert not player.says
    player.tap(pygame.K_SPACE)
    assert len(player.world.balls) == 2
    assert player.says == "At most 2 balls at a time."


def test_z_changes_the_velocity_of_the_ball_and_without_a_ball_says_why_not(player):
    player.tap(pygame.K_z)
    assert "no ball" in player.says
    player.tap(pygame.K_SPACE)
    before = player.world.balls[0].velocity[2]
    player.tap(pygame.K_z)
    # Falling straight down alone would leave the sideways speed as it was.
    assert player.world.balls[0].velocity[2] != before


def test_p_stops_the_time_and_starts_it_again(player):
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_p)
    assert player.menus.page == "pause"
    digest = player.world.digest()
    player.seconds(0.5)
    assert player.world.digest() == digest
    player.tap(pygame.K_p)
    player.seconds(0.1)
    assert player.world.digest() != digest


def test_no_input_method_has_the_letters_whatever_is_done_to_the_window(player):
    from silverball.app import sdl

    def is_typing() -> bool:
        return bool(sdl._function("SDL_IsTextInputActive")())

    assert not is_typing()
    screen = player.window._screen
    for do in (
        screen.toggle_fullscreen,
        screen.toggle_fullscreen,
        lambda: screen.resize((300, 500)),
        lambda: pygame.event.post(pygame.Event(pygame.WINDOWFOCUSGAINED)),
        lambda: pygame.event.post(pygame.Event(pygame.WINDOWSIZECHANGED, x=300, y=500)),
        lambda: pygame.event.post(pygame.Event(pygame.WINDOWSHOWN)),
    ):
        pygame.key.start_text_input()  # as SDL does by itself
        do()
        player.frames(1)
        assert not is_typing()


def test_a_key_that_comes_up_as_another_letter_lets_go_of_what_it_held(player):
    pygame.event.post(
        pygame.Event(pygame.KEYDOWN, key=pygame.K_a, mod=0, unicode="", scancode=pygame.KSCAN_A)
    )
    player.frames(1)
    assert player.window.input_handler.buttons.held == (True, False)
    pygame.event.post(pygame.Event(pygame.KEYUP, key=pygame.K_q, mod=0, unicode="", scancode=pygame.KSCAN_A))
    player.frames(1)
    assert player.window.input_handler.buttons.held == (False, False)


def test_a_key_that_loses_its_use_while_it_is_held_lets_go(player):
    player.press(pygame.K_a)
    player.frames(1)
    player.program.settings.change(keys={"left": ("left",)})
    player.frames(1)
    player.release(pygame.K_a)
    player.frames(1)
    assert player.window.input_handler.buttons.held == (False, False)


def test_the_help_stops_the_time_while_it_is_shown(player):
    player.tap(pygame.K_F1)
    tick = player.world.tick
    player.seconds(0.2)
    assert player.world.tick == tick
    player.tap(pygame.K_SPACE)
    assert "press F1 to continue" in player.says
    player.tap(pygame.K_F1)
    player.seconds(0.2)
    assert player.world.tick > tick
    assert not player.world.balls


@pytest.mark.parametrize("name", ["space", "a", "left", "right shift", "up", "down", "return"])
def test_the_help_has_two_pages_that_paddles_space_and_arrows_turn(open_window, name):
    player = open_window(mode=None)
    page = player.menus.signature
    player.tap(pygame.K_F1)
    for expected in (1, 0, 1):
        player.tap(pygame.key.key_code(name))
        assert player.window.input_handler.help_page == expected
    assert player.menus.signature == page  # nothing was chosen behind it
    player.tap(pygame.K_F1)
    player.tap(pygame.K_F1)
    assert player.window.input_handler.help_page == 0


def test_the_first_page_of_the_help_says_how_to_score_on_this_table(open_window, monkeypatch):
    from silverball.app import overlay

    written = []
    real = overlay.line
    monkeypatch.setattr(overlay, "line", lambda text, *rest: written.append(text) or real(text, *rest))
    player = open_window("classic", mode=Mode.ARCADE)
    overlay._rules.cache_clear()
    player.tap(pygame.K_F1)
    text = " ".join(written)
    arcade = player.program.board.table.arcade
    for word in ("HOW TO SCORE", f"×{arcade.double}", f"{arcade.ball_save:g} s", "paddles are dead"):
        assert word in text


@pytest.mark.parametrize(
    "size", [(1280, 720), (300, 900), (900, 300), (400, 400), (170, 340), (60, 90), (20, 30)]
)
@pytest.mark.parametrize("page", [0, 1])
def test_the_help_fits_a_window_of_any_shape(player, size, page, monkeypatch):
    from silverball.app import overlay
    from silverball.app.scoring import how_to_score

    placed = []
    monkeypatch.setattr(overlay, "_place", lambda target, image, *rest: placed.append(image.get_size()))
    rules = how_to_score(player.program.board.table, Mode.ARCADE)
    help_ = overlay.Help(page, 7, player.window.input_handler.controls, rules)
    overlay.draw_help(pygame.Surface(size), size[0] / 11.0, help_)
    ((width, height),) = placed
    assert width <= size[0]
    assert height <= size[1]


def test_r_makes_a_new_board_and_shift_r_the_same_again(open_window):
    player = open_window("random", seed=11)
    first = player.program.board.table
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_r, pygame.KMOD_LSHIFT)
    assert (player.program.board.seed, player.program.board.table, player.world.tick > 4) == (
        11,
        first,
        False,
    )
    player.tap(pygame.K_r)
    assert player.program.board.seed != 11
    assert player.program.board.table != first
    assert player.world.seed == player.program.board.seed
    assert not player.world.balls


def test_shift_r_lifts_no_paddle(open_window):
    player = open_window("random", seed=11)
    player.press(pygame.K_LSHIFT)
    player.frames(3)
    player.press(pygame.K_r, pygame.KMOD_LSHIFT)
    player.frames(1)
    player.seconds(0.3)
    assert angles(player) == pytest.approx(
        [paddle.rest_angle for paddle in player.program.board.table.paddle]
    )


def test_the_same_seed_and_keys_give_the_same_game(open_window):
    digests = []
    for _ in range(2):
        player = open_window("random", seed=5)
        player.tap(pygame.K_SPACE)
        player.press(pygame.K_d)
        player.seconds(1.0)
        digests.append((player.world.digest(), player.program.board.table))
        player.release(pygame.K_d)
        player.frames(1)
    assert digests[0] == digests[1]


@pytest.mark.parametrize(("key", "words"), [(pygame.K_g, "F1 shows the keys"), (pygame.K_7, "7")])
def test_a_key_that_does_nothing_says_so(player, key, words):
    player.tap(key)
    assert words in player.says


@pytest.mark.parametrize(("letter", "named"), [("п", "П"), ("ö", "Ö"), ("\U00012000", "This key")])
def test_a_key_of_another_writing_without_a_use_says_so(player, letter, named):
    key = pygame.Event(pygame.KEYDOWN, key=ord(letter), mod=0, unicode=letter, scancode=pygame.KSCAN_G)
    pygame.event.post(key)
    player.frames(1)
    assert player.says.startswith(f"{named} does nothing here")


def test_m_turns_the_sounds_off_and_on_and_it_is_kept(player):
    player.tap(pygame.K_m)
    assert player.says == "Sounds are off."
    assert player.window.store.settings()["muted"] is True
    player.tap(pygame.K_m)
    assert player.window.store.settings()["muted"] is False


def test_a_message_goes_away(player):
    player.tap(pygame.K_m)
    player.seconds(8.0)
    assert player.says == ""


def test_shortcuts_of_the_desktop_are_left_alone(player):
    player.tap(pygame.K_r, pygame.KMOD_LCTRL)
    player.tap(pygame.K_g, pygame.KMOD_LALT)
    assert (player.program.board.seed, player.says) == (7, "")


@pytest.mark.parametrize("event", [pygame.QUIT, pygame.WINDOWCLOSE])
def test_closing_the_window_ends_the_program(player, event):
    pygame.event.post(pygame.Event(event))
    player.frames(1)
    assert player.window.is_over


def test_escape_goes_back_step_by_step_and_never_ends_a_game_at_once(player):
    player.tap(pygame.K_F1)
    player.tap(pygame.K_ESCAPE)
    assert not player.window.input_handler.shows_help
    player.tap(pygame.K_ESCAPE)
    assert player.menus.page == "pause"
    player.tap(pygame.K_ESCAPE)
    assert not player.menus.is_open
    assert not player.window.is_over


@pytest.mark.parametrize("key", [pygame.K_p, pygame.K_F1])
def test_taps_on_a_paddle_while_the_game_waits_are_forgotten_but_a_held_key_counts(player, key):
    rest = player.program.board.table.paddle[0].rest_angle
    player.tap(key)
    player.tap(pygame.K_a)
    player.tap(pygame.K_LEFT)
    player.press(pygame.K_d)
    player.frames(1)
    player.press(key)
    player.frames(2, TICK)
    assert angles(player)[0] == pytest.approx(rest)
    assert angles(player)[1] > rest


def test_a_table_without_a_paddle_says_so(open_window):
    from silverball.table import Table

    player = open_window(Table(paddle=()))
    player.tap(pygame.K_a)
    assert player.says == "This table has no left paddle."
    player.tap(pygame.K_RIGHT)
    assert player.says == "This table has no right paddle."


def test_the_same_message_again_and_again_does_not_stay_for_ever(player):
    for _ in range(2):
        player.tap(pygame.K_SPACE)
    gone = False
    for _ in range(30):
        player.tap(pygame.K_SPACE)
        player.seconds(0.1)
        gone |= player.window.messages.opacity < 0.5
    assert gone


@pytest.mark.parametrize("mode", list(Mode))
def test_slow_motion_slows_the_world_and_an_arcade_game_says_that_it_no_longer_counts(open_window, mode):
    player = open_window(mode=mode)
    player.tap(pygame.K_COMMA)
    assert ("no longer counts" in player.says) == (mode is Mode.ARCADE)
    player.tap(pygame.K_COMMA)
    tick = player.world.tick
    player.seconds(1.0)
    assert player.world.tick - tick == pytest.approx(60, abs=2)
    for _ in range(5):
        player.tap(pygame.K_PERIOD)
    assert player.program.speed == 1.0


def test_n_moves_a_paused_game_on_by_one_tick(player):
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_n)
    assert "paused" in player.says
    player.tap(pygame.K_p)
    tick = player.world.tick
    for count in (1, 2, 3):
        player.tap(pygame.K_n)
        assert player.world.tick == tick + count
