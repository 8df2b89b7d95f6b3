"""A game in a window while another program locks the file of the scores."""

from __future__ import annotations

import pygame
from machines import leaky
from test_arcade_game import play_all_balls

from holder import held
from silverball.app.game_archive import PENDING, SAVED
from silverball.game.scores.store import FILE, Store
from silverball.game.view import Mode


def test_a_score_that_waits_is_saved_while_the_window_is_open(open_window, tmp_path):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    with held(tmp_path / "data" / FILE):
        play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
        score = player.game.score
        player.frames(1)
        assert player.window.messages.text == f"{PENDING[0].upper()}{PENDING[1:]}."
        player.until(lambda: player.menus.page == "initials")
    player.seconds(1.5)
    assert player.window.messages.text == f"{SAVED[0].upper()}{SAVED[1:]}."
    with Store(tmp_path / "data") as other:
        assert [row.score for row in other.scores()] == [score]


def test_a_score_that_still_waits_when_the_window_closes_is_there_at_the_next_start(
    open_window, tmp_path, capsys
):
    player = open_window(leaky(), seed=3, mode=Mode.ARCADE)
    with held(tmp_path / "data" / FILE):
        play_all_balls(player, lambda: player.tap(pygame.K_SPACE))
        score = player.game.score
        player.frames(1)
        player.window.close()
        (file,) = (tmp_path / "data").glob("silverball-waiting-*")
        assert file.name in capsys.readouterr().err
    again = open_window(leaky(), seed=3, mode=None)
    assert [row.score for row in again.program._catalog.scores("Leaky", Mode.ARCADE)] == [score]
