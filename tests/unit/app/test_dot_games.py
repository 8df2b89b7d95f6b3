"""The tiny pinball on the dots, played while the physics is compiled."""

from __future__ import annotations

import math

import numpy as np
import pytest

from evenings import Evening
from reading import reads
from silverball.app.controls import Action
from silverball.app.dot_game import (
    ALL_LAMPS_POINTS,
    BALL,
    BUMPER,
    BUMPER_POINTS,
    BUMPER_SPEED,
    BUMPERS,
    FASTEST,
    GRAVITY,
    LAMP_POINTS,
    LAMPS,
    LEFT,
    MIDDLE,
    PAUSE,
    RIGHT,
    SIDES,
    STEP,
    TOP,
    DotGame,
)
from silverball.app.startup import Progress
from silverball.drawing.dotmatrix.canvas import HEIGHT, Dots
from silverball.game.view import Mode

FRAME = 1 / 30


def begun() -> DotGame:
    game = DotGame()
    game.press("start")
    game.advance(0.0)
    return game


def put(game: DotGame, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> None:
    game._x, game._y, game._vx, game._vy = x, y, vx, vy


def drawn(game: DotGame) -> Dots:
    dots = Dots()
    game.draw(dots)
    return dots


def play(game: DotGame, seconds: float, start: float = 0.0, presses=lambda game: ()) -> list[int]:
    """Play, and return the points of each lost ball."""
    lost, was_lost = [], False
    for frame in range(1, round(seconds / FRAME) + 1):
        held = presses(game)
        for side in SIDES:
            (game.press if side in held else game.release)(side)
        game.advance(start + frame * FRAME)
        is_lost = game._lost_for is not None
        if is_lost and not was_lost:
            lost.append(game.points)
        was_lost = is_lost
    return lost


def watchful(game: DotGame) -> tuple[str, ...]:
    """Raises the paddle on the side of a ball that comes down to it."""
    if game._y < 22.0 or game._vy < 5.0:
        return ()
    return ("left",) if game._x < MIDDLE else ("right",)


def test_nothing_moves_before_a_button_is_pressed():
    game = DotGame()
    before = drawn(game).pixels.copy()
    for second in range(5):
        game.advance(float(second))
    assert (drawn(game).pixels == before).all()
    game.press("left")
    play(game, 0.5, start=5.0)
    assert (drawn(game).pixels != before).any()


def test_a_free_ball_falls_as_gravity_says():
    game = begun()
    put(game, MIDDLE + 8.0, 18.0)
    play(game, 0.2)
    steps = round(0.2 / STEP)
    assert game._y == pytest.approx(18.0 + GRAVITY * STEP**2 * steps * (steps + 1) / 2, abs=1e-6)


def test_a_raised_paddle_throws_the_ball_up_and_one_at_rest_does_not():
    heights = {}
    for held in (("left",), ()):
        game = begun()
        put(game, MIDDLE - 9.0, 24.0, 0.0, 10.0)
        highest = HEIGHT
        for frame in range(1, 20):
            game.press("left") if held and frame > 2 else None
            game.advance(frame * FRAME)
            highest = min(highest, game._y)
        heights[held] = highest
    assert heights["left",] < 15.0
    assert heights[()] > 21.0


@pytest.mark.parametrize("number", range(len(BUMPERS)))
def test_a_bumper_scores_and_sends_the_ball_away(number):
    game = begun()
    x, y = BUMPERS[number]
    put(game, x, y + BUMPER + BALL + 0.2, 0.0, -20.0)
    game.advance(STEP * 2.5)
    assert game.points == BUMPER_POINTS
    assert game._vy == pytest.approx(BUMPER_SPEED, abs=2.0 * GRAVITY * STEP)


def test_each_lamp_scores_once_and_all_of_them_more():
    game = begun()
    for lamp in range(LAMPS):
        for _ in range(2 if lamp < LAMPS - 1 else 1):
            put(game, LEFT + (lamp + 0.5) * (RIGHT - LEFT) / LAMPS, TOP + BALL + 0.1, 0.0, -30.0)
            game._step()
    assert game.points == LAMPS * LAMP_POINTS + ALL_LAMPS_POINTS
    assert not game._lit


def test_a_lost_ball_counts_for_the_best_score_and_another_one_comes():
    game = begun()
    game.points = 70
    put(game, MIDDLE, HEIGHT - 1.0, 0.0, 20.0)
    play(game, 0.2)
    assert game.best == 70
    play(game, PAUSE + 0.1, start=0.2)
    assert game._lost_for is None
    assert game.points < 70
    assert reads(drawn(game), "70")


def test_the_ball_stays_on_the_board_and_no_faster_than_it_may_whoever_plays():
    random = np.random.default_rng(1)

    def at_random(game: DotGame) -> tuple[str, ...]:
        assert math.hypot(game._vx, game._vy) <= FASTEST + 1e-9
        assert LEFT - 1e-9 <= game._x <= RIGHT + 1e-9
        assert game._y >= TOP
        return tuple(side for side in SIDES if random.random() < 0.3)

    assert len(play(begun(), 300.0, presses=at_random)) > 10


def test_who_hits_the_ball_gets_more_than_who_does_nothing():
    best = {}
    for name, presses in (("watchful", watchful), ("idle", lambda game: ())):
        game = begun()
        play(game, 60.0, presses=presses)
        best[name] = max(game.best, game.points)
    assert best["watchful"] > 3 * best["idle"] > 0


def waiting(tmp_path) -> Evening:
    """A program that compiles, with a game that waits for it."""
    evening = Evening(tmp_path)
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.program.progress = Progress(8.0, 0.3)
    return evening


def test_the_paddle_keys_play_on_the_dots_while_a_game_waits(tmp_path):
    evening = waiting(tmp_path)
    assert reads(evening.program.dots(0.0), "HOLD A OR D")
    assert reads(evening.program.dots(0.0), "COMPILING 8/27 S")
    evening.press(Action.LEFT)
    before = evening.program.dots(0.1).pixels
    evening.go(0.5)
    assert evening.program.dot_game.is_begun
    assert (evening.program.dots(evening.seconds).pixels[10:] != before[10:]).sum() > 10
    assert not reads(evening.program.dots(evening.seconds), "HOLD A OR D")


def test_the_best_score_on_the_dots_is_kept_and_the_real_game_begins(tmp_path):
    evening = waiting(tmp_path)
    evening.tap(Action.CREATE)
    evening.program.dot_game.points = 120
    evening.program.progress = None
    evening.program.finish_loading()
    assert evening.program.is_playing
    again = Evening(tmp_path, evening.program.settings.current.of(evening.store.settings()))
    assert again.program.dot_game.best == 120


def test_escape_leads_from_the_dots_to_the_menu(tmp_path):
    evening = waiting(tmp_path)
    evening.tap(Action.LEFT)
    evening.tap(Action.BACK)
    assert evening.program.menus.page == "main"
    assert not evening.program.is_compiling_for_game
