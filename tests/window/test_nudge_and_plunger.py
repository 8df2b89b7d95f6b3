"""Nudging and launching on a whole machine, by keys and by a gamepad."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from silverball.drawing import Moment, Renderer, best_size
from silverball.game.view import Mode, Phase
from silverball.table import load_table
from silverball.world import World

COMET = load_table("silver_comet")
DIRECTIONS = [
    (pygame.K_z, (0.0, -1.0)),
    (pygame.K_x, (0.0, 1.0)),
    (pygame.K_UP, (1.0, 0.0)),
]


@pytest.fixture
def comet(open_window):
    """A window with an arcade game on the machine, whose first ball lies on the plunger."""
    player = open_window("silver_comet", mode=Mode.ARCADE)
    assert player.game.has_ball_to_launch
    return player


def launched(player, seconds: float = 0.4):
    """Launch the ball on the plunger, with Space held for some seconds."""
    assert player.game.has_ball_to_launch
    player.press(pygame.K_SPACE)
    player.frames(round(seconds * 60))
    player.release(pygame.K_SPACE)
    player.frames(2)


# --- The plunger


def test_space_held_draws_the_plunger_back_and_let_go_launches(comet):
    comet.seconds(1.0)
    assert comet.game.has_ball_to_launch  # it waits, however long
    comet.press(pygame.K_SPACE)
    comet.frames(30)
    assert comet.world.records[0]["launch_held"] == pytest.approx(120, abs=2)
    comet.release(pygame.K_SPACE)
    comet.frames(1)
    assert not comet.game.has_ball_to_launch
    (ball,) = comet.world.balls
    least, greatest = COMET.plunger[0].launch
    expected = least + (greatest - least) * 0.5 / COMET.plunger[0].charge
    assert ball.velocity[0] == pytest.approx(expected, abs=0.5)  # gravity has had some ticks


def test_space_brings_the_next_ball_and_does_not_launch_it_at_once(comet, monkeypatch):
    launched(comet)
    comet.until(lambda: comet.game.phase is Phase.READY or comet.game.is_over)
    assert comet.game.phase is Phase.READY
    said = []
    monkeypatch.setattr(comet.program.display, "show_message", lambda text, replace: said.append(text))
    comet.tap(pygame.K_SPACE)
    comet.seconds(0.5)
    assert comet.game.has_ball_to_launch
    assert said == ["HOLD SPACE, THEN LET GO"]
    launched(comet)
    assert not comet.game.has_ball_to_launch


def test_return_works_the_plunger_too(comet):
    comet.press(pygame.K_RETURN)
    comet.frames(30)
    comet.release(pygame.K_RETURN)
    comet.frames(2)
    assert not comet.game.has_ball_to_launch


def test_in_arcade_space_does_nothing_else_while_a_ball_is_in_play(comet):
    launched(comet)
    assert comet.game.state.used == 1
    for _ in range(4):
        comet.seconds(0.3)
        if comet.game.view.on_board:
            comet.tap(pygame.K_SPACE)
            comet.tap(pygame.K_SPACE)
        assert comet.game.state.used == 1
        assert len(comet.world.balls) == 1


def test_in_free_play_space_brings_more_balls(open_window):
    player = open_window("silver_comet")
    player.tap(pygame.K_SPACE)
    launched(player)
    player.seconds(0.3)
    player.tap(pygame.K_SPACE)
    assert player.game.view.on_board == 2
    assert player.game.has_ball_to_launch


def test_a_pause_lets_the_plunger_go_on_being_held_only_while_the_key_is(comet):
    comet.press(pygame.K_SPACE)
    comet.frames(10)
    comet.tap(pygame.K_p)
    comet.release(pygame.K_SPACE)
    comet.frames(5)
    comet.tap(pygame.K_p)
    comet.frames(2)
    assert not comet.game.has_ball_to_launch  # the key came up meanwhile: it is launched


def test_a_gamepads_button_launches_a_ball(comet):
    comet.pad(pygame.CONTROLLER_BUTTON_A)
    comet.frames(20)
    comet.pad(pygame.CONTROLLER_BUTTON_A, down=False)
    comet.frames(2)
    assert not comet.game.has_ball_to_launch


# --- The nudge


@pytest.mark.parametrize(("key", "direction"), DIRECTIONS)
def test_a_key_nudges_the_table_which_springs_back(comet, key, direction):
    launched(comet)
    comet.seconds(0.3)
    comet.tap(key)
    comet.frames(2)
    assert np.sign(comet.world.cabinet).tolist() == list(direction)
    comet.seconds(1.0)
    assert comet.world.cabinet == (0.0, 0.0)
    comet.program.session.game.end()
    assert comet.game.replay.verify().ok


def test_a_stick_nudges_once_for_each_flick(comet):
    launched(comet)
    comet.seconds(0.3)
    for value in (12000, 30000, 32000, 15000, 0):
        axis = pygame.CONTROLLER_AXIS_LEFTX
        pygame.event.post(pygame.Event(pygame.CONTROLLERAXISMOTION, instance_id=0, axis=axis, value=value))
        comet.frames(1)
    assert comet.world.cabinet[1] != 0.0
    assert comet.game.state.swing == 1.0  # of the tilt bob: one nudge


def test_three_quick_nudges_tilt(comet):
    launched(comet)
    comet.seconds(0.3)
    for key, _ in DIRECTIONS:
        comet.tap(key)
    assert comet.game.view.tilted
    before = comet.game.state.swing
    comet.tap(pygame.K_z)
    assert comet.game.state.swing == before


def test_on_a_table_without_a_nudge_all_three_keys_are_the_jitter(open_window):
    player = open_window("classic")
    player.tap(pygame.K_SPACE)
    for count, (key, _) in enumerate(DIRECTIONS, 1):
        draws = int(player.world.records[0]["draws"])
        player.tap(key)
        player.frames(1)
        assert player.world.records[0]["draws"] == draws + 1, count
    assert player.world.cabinet == (0.0, 0.0)


def test_in_the_menu_the_arrow_moves(comet):
    launched(comet)
    comet.tap(pygame.K_p)
    before = comet.menus.signature
    comet.tap(pygame.K_UP)
    assert comet.menus.signature != before
    comet.tap(pygame.K_p)
    comet.frames(2)
    assert comet.world.cabinet == (0.0, 0.0)


# --- The picture


def test_the_picture_moves_with_the_cabinet_by_6_pixels():
    size = best_size(COMET.board, 1152)
    renderer = Renderer(COMET, size, theme="clear", background=True)
    rest, world = Moment.before(COMET), World(COMET)
    world.step(nudge="right")
    swing = []
    for _ in range(60):
        swing.append(world.cabinet[1])
        world.step()
    assert round(max(swing) * renderer.camera.scale) == 6
    assert -3 <= round(min(swing) * renderer.camera.scale) < 0  # it swings back beyond its place, by less
    still = renderer.array(rest)
    moved = renderer.array(rest._replace(cabinet=(0.0, max(swing))))
    assert (moved[:, 6:] == still[:, :-6]).all()
    up = renderer.array(rest._replace(cabinet=(max(swing), 0.0)))
    assert (up[:-6] == still[6:]).all()
    assert (renderer.array(rest) == still).all()
    renderer.close()
