"""What the keys do in a window, pressed through SDL's own queue."""

from __future__ import annotations

import math

import pygame
import pytest

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
    stroke = player.window.table.paddle[side].stroke
    assert angles(player) == pytest.approx([-10.0, -10.0])
    player.press(key)
    player.frames(round(stroke / TICK), TICK)
    assert angles(player)[side] == pytest.approx(45.0)
    assert angles(player)[1 - side] == pytest.approx(-10.0)
    player.release(key)
    player.frames(round(player.window.table.paddle[side].return_stroke / TICK), TICK)
    assert angles(player)[side] == pytest.approx(-10.0)


def test_a_paddle_stays_up_while_one_of_its_two_pressed_keys_is_held(player):
    player.press(pygame.K_a)
    player.press(pygame.K_LEFT)
    player.seconds(0.2)
    player.release(pygame.K_a)
    player.seconds(0.2)
    assert angles(player)[0] == pytest.approx(45.0)


def test_a_tap_between_two_frames_lifts_the_paddle_for_one_tick(player):
    paddle = player.window.table.paddle[0]
    per_tick = (paddle.up_angle - paddle.rest_angle) / paddle.stroke * TICK
    player.press(pygame.K_a)
    player.release(pygame.K_a)
    player.frames(1, TICK)
    assert angles(player)[0] == pytest.approx(-10.0 + per_tick)


def test_a_tap_is_not_lost_in_a_frame_too_short_for_a_tick(player):
    player.press(pygame.K_a)
    player.release(pygame.K_a)
    player.frames(1, 0.1 * TICK)
    assert angles(player)[0] == pytest.approx(-10.0)
    player.frames(1, TICK)
    assert angles(player)[0] > -10.0


def test_losing_focus_releases_the_keys(player):
    player.press(pygame.K_a)
    player.press(pygame.K_d)
    player.seconds(0.2)
    assert angles(player) == pytest.approx([45.0, 45.0])
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    player.seconds(0.2)
    assert angles(player) == pytest.approx([-10.0, -10.0])


def test_space_brings_two_balls_at_most_and_says_why_no_third(player):
    for count in (1, 2):
        player.tap(pygame.K_SPACE)
        assert len(player.world.balls) == count
        assert not player.says
    player.tap(pygame.K_SPACE)
    assert len(player.world.balls) == 2
    assert player.says == "2 balls are the most."


def test_z_changes_the_velocity_of_the_ball_and_without_a_ball_says_why_not(player):
    player.tap(pygame.K_z)
    assert "no ball" in player.says
    ball = player.world.create_ball(position=(0.0, 0.0))
    player.tap(pygame.K_z)
    moved = player.world.balls[0]
    assert moved.id == ball.id
    # Falling straight down alone would leave the sideways speed at zero.
    assert moved.velocity[2] != 0.0


def test_p_stops_the_time_and_starts_it_again(player):
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_p)
    digest = player.world.digest()
    player.seconds(0.5)
    assert player.world.digest() == digest
    player.tap(pygame.K_SPACE)
    assert "paused" in player.says
    player.tap(pygame.K_p)
    player.seconds(0.1)
    assert player.world.digest() != digest


def test_the_help_stops_the_time_while_it_is_shown(player):
    player.tap(pygame.K_F1)
    tick = player.world.tick
    player.seconds(0.2)
    assert player.world.tick == tick
    player.tap(pygame.K_F1)
    player.seconds(0.2)
    assert player.world.tick > tick


def test_r_makes_a_new_board_and_shift_r_the_same_again(open_window):
    player = open_window("random", seed=11)
    first = player.window.table
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_r, pygame.KMOD_LSHIFT)
    assert (player.window.seed, player.window.table, player.world.tick > 4) == (11, first, False)
    player.tap(pygame.K_r)
    assert player.window.seed != 11
    assert player.window.table != first
    assert player.world.seed == player.window.seed
    assert not player.world.balls


def test_the_same_seed_and_keys_give_the_same_game(open_window):
    digests = []
    for _ in range(2):
        player = open_window("random", seed=5)
        player.tap(pygame.K_SPACE)
        player.press(pygame.K_d)
        player.seconds(1.0)
        digests.append((player.world.digest(), player.window.table))
    assert digests[0] == digests[1]


@pytest.mark.parametrize(
    ("key", "words"), [(pygame.K_m, "No sounds yet"), (pygame.K_g, "F1 shows the keys"), (pygame.K_7, "7")]
)
def test_a_key_that_does_nothing_useful_says_so(player, key, words):
    player.tap(key)
    assert words in player.says


def test_a_message_goes_away(player):
    player.tap(pygame.K_m)
    player.seconds(8.0)
    assert player.says == ""


def test_shortcuts_of_the_desktop_are_left_alone(player):
    player.tap(pygame.K_r, pygame.KMOD_LCTRL)
    player.tap(pygame.K_g, pygame.KMOD_LALT)
    assert (player.window.seed, player.says) == (7, "")


@pytest.mark.parametrize("event", [pygame.QUIT, pygame.WINDOWCLOSE])
def test_closing_the_window_ends_the_game(player, event):
    pygame.event.post(pygame.Event(event))
    player.frames(1)
    assert player.window.is_over


def test_escape_goes_back_one_step_before_it_ends_the_game(player):
    window = player.window
    for key in (pygame.K_F11, pygame.K_p, pygame.K_F1):
        player.tap(key)
    seen = []
    for _ in range(4):
        seen.append((window.shows_help, window.is_paused, window._screen.is_full, window.is_over))
        player.tap(pygame.K_ESCAPE)
    assert seen == [
        (True, True, True, False),
        (False, True, True, False),
        (False, False, True, False),
        (False, False, False, False),
    ]
    assert window.is_over


def test_p_while_the_help_is_shown_pauses_nothing_unseen(player):
    player.tap(pygame.K_F1)
    player.tap(pygame.K_p)
    assert not player.window.is_paused
    assert "F1 goes on" in player.says
    player.tap(pygame.K_F1)
    assert not player.says


@pytest.mark.parametrize("key", [pygame.K_p, pygame.K_F1])
def test_taps_on_a_paddle_while_the_game_waits_are_forgotten_but_a_held_key_counts(player, key):
    player.tap(key)
    player.tap(pygame.K_a)
    player.press(pygame.K_d)
    player.frames(1)
    player.press(key)
    player.frames(1, TICK)
    assert angles(player)[0] == pytest.approx(-10.0)
    assert angles(player)[1] > -10.0


def type_at(player, place, label):
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(label), mod=0, unicode=label, scancode=place))
    player.seconds(0.1)


def test_without_latin_letters_keys_go_by_their_place(player):
    type_at(player, pygame.KSCAN_A, "ф")
    type_at(player, pygame.KSCAN_D, "в")
    assert angles(player) == pytest.approx([45.0, 45.0])
    up = pygame.Event(pygame.KEYUP, key=ord("ф"), mod=0, unicode="", scancode=pygame.KSCAN_A)
    pygame.event.post(up)
    player.seconds(0.3)
    assert angles(player) == pytest.approx([-10.0, 45.0])
    type_at(player, pygame.KSCAN_Z, "я")
    assert "no ball to shove" in player.says
    type_at(player, pygame.KSCAN_P, "з")
    assert player.window.is_paused


def test_a_key_without_a_latin_letter_and_without_a_use_says_so(player):
    type_at(player, pygame.KSCAN_G, "п")
    assert player.says.startswith("This key does nothing here")


def test_a_latin_label_goes_before_the_place(player):
    type_at(player, pygame.KSCAN_A, "q")  # as on a French keyboard
    assert angles(player) == pytest.approx([-10.0, -10.0])
    assert player.says.startswith("Q does nothing")
    type_at(player, pygame.KSCAN_Z, "ż")
    assert player.says.startswith("Ż does nothing")


def test_shift_r_lifts_no_paddle(open_window):
    player = open_window("random", seed=11)
    player.press(pygame.K_LSHIFT)
    player.frames(3)
    player.press(pygame.K_r, pygame.KMOD_LSHIFT)
    player.frames(1)
    player.seconds(0.3)
    assert angles(player) == pytest.approx([-10.0, -10.0])


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
        gone |= player.window.messages.strength < 0.5
    assert gone


def test_a_message_while_a_ball_is_in_play_is_gone_after_two_and_a_half_seconds(player):
    player.world.create_ball(position=(8.0, 0.0))
    player.window.messages.say("a long message " * 10)
    player.frames(151)
    assert player.world.balls
    assert player.says == ""


def test_a_ball_that_lies_still_for_three_seconds_brings_the_hint_to_press_z(open_window):
    # Two slant walls that meet in a valley, where a ball comes to rest.
    from boards import table_of
    from silverball.table import SlantWall

    valley = [SlantWall(start=(-5.0, z), end=(-6.0, 0.0), restitution=0.2) for z in (-5.0, 5.0)]
    player = open_window(table_of(*valley))
    player.world.create_ball(position=(-5.5, 0.0))
    player.seconds(2.9)
    assert player.says == ""
    player.seconds(3.0)
    assert "Z gives it a shove" in player.says
