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
    assert player.says.startswith("2 balls are on the board already")


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
    ("key", "words"), [(pygame.K_m, "no sounds yet"), (pygame.K_g, "F1 shows the keys"), (pygame.K_7, "7")]
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


def test_escape_ends_the_game(player):
    player.tap(pygame.K_ESCAPE)
    assert player.window.is_over


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
