"""Games on a table with a plunger: the ball waits on it, the launch button sends it off."""

from __future__ import annotations

import pytest

from silverball.app.controls import PaddleInput
from silverball.app.sessions import DemoSession, GameSession
from silverball.errors import NoRoom
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import ReplayPlayer
from silverball.game.view import GameEventKind, Mode
from silverball.players import make_player
from silverball.table import Table, load_table

START = (-6.0, 3.0)
PLUNGER = {"position": START, "launch": (8.0, 20.0), "charge": 1.0}
TABLE = Table.model_validate(
    {"name": "Lane", "paddle": load_table("classic").paddle, "plunger": [PLUNGER], "board": {"max_balls": 3}}
)
HOLD = 120  # ticks


def launched(hold: int = HOLD) -> Game:
    game = Game(TABLE, 5)
    game.create_ball()
    game.step(ticks=10)
    game.step(ticks=hold, launch=True)
    game.step(ticks=1)
    return game


def where(game: Game) -> tuple[float, float]:
    (ball,) = game.world.balls
    return ball.position[0], ball.position[2]


def test_a_new_ball_lies_on_the_plunger_and_nothing_shoves_it():
    game = Game(TABLE, 5)
    game.create_ball()
    game.step(ticks=240 * 60)
    assert where(game) == START
    assert not any(event.kind is GameEventKind.UNSTUCK for event in game.take_game_events())
    assert not game.has_still_ball


def test_there_is_no_place_for_a_second_ball_before_the_first_is_launched():
    game = Game(TABLE, 5)
    game.create_ball()
    with pytest.raises(NoRoom):
        game.create_ball()
    assert game.view.ball == 1


@pytest.mark.parametrize("hold", [24, 120, 240, 480])
def test_the_longer_the_button_is_held_the_faster_is_the_ball(hold):
    game = launched(hold)
    (released,) = [event for event in game.take_world_events() if event.kind == "released"]
    assert released.part == "plunger[0]"
    assert released.speed == pytest.approx(8.0 + 12.0 * min(hold / 240, 1.0), abs=0.1)
    assert where(game)[0] > START[0]


def test_a_launch_is_recorded_and_verified_and_can_be_watched_from_any_moment():
    game = launched()
    game.step(ticks=400)
    replay = Replay.from_text(game.replay.to_text())
    assert "^" in "".join(replay.lines) + replay.tail
    assert replay.verify().ok
    player = ReplayPlayer(replay)
    player.seek(100)
    assert player.game.is_launch_held
    player.seek(game.tick)
    assert player.game.digest() == game.digest()


@pytest.mark.parametrize("moment", [5, 60, 129, 131, 400])
def test_a_saved_game_continues_bit_for_bit(moment):
    def play(game: Game, first: int, end: int) -> None:
        for tick in range(first, end):
            game.step(ticks=1, launch=10 <= tick < 130)

    one, other = Game(TABLE, 5), Game(TABLE, 5)
    one.create_ball()
    play(one, 0, moment)
    other.restore(one.save())
    play(one, moment, 600)
    play(other, moment, 600)
    assert one.digest() == other.digest()


def test_many_ticks_at_once_are_the_same_as_one_by_one():
    one, other = Game(TABLE, 5), Game(TABLE, 5)
    for game in (one, other):
        game.create_ball()
    for launch, ticks in ((False, 77), (True, 200), (False, 900)):
        one.step(ticks=ticks, launch=launch)
        for _ in range(ticks):
            other.step(launch=launch)
    assert one.digest() == other.digest()
    assert one.replay.to_text() == other.replay.to_text()


def test_the_time_in_which_a_ball_is_saved_begins_at_its_launch():
    game = Game(TABLE, 5)
    game.create_ball()
    game.step(ticks=240 * 30)
    game.step(ticks=HOLD, launch=True)
    game.step(ticks=2)
    assert game.view.save_left == pytest.approx(TABLE.arcade.ball_save, abs=0.02)


def test_a_tap_of_the_button_launches_gently():
    session = GameSession(Game(TABLE, 5))
    session.create_ball("SPACE")
    session.advance(PaddleInput((False, False), (False, False), (True, False)), 3)
    released = [event for event in session.game.take_world_events() if event.kind == "released"]
    assert [event.speed for event in released] == [pytest.approx(8.0, abs=0.1)]


def test_the_paddles_are_dead_after_a_tilt_but_the_plunger_is_not():
    game = Game(TABLE, 5)
    game.create_ball()
    while not game.view.tilted:
        game.jitter()
        game.step()
    game.step(ticks=HOLD, launch=True)
    game.step(ticks=20)
    assert where(game)[0] > START[0]


@pytest.mark.parametrize("name", ["reflex", "idle"])
def test_a_demo_launches_its_balls_by_itself(name):
    session = DemoSession(TABLE, 3, make_player(name))
    session.advance(PaddleInput((False, False), (False, False)), 240 * 8)
    events = [event.kind for event in session.game.take_world_events()]
    assert events.count("released") >= 2
    assert session.game.mode is Mode.FREE
    assert session.game.replay.verify().ok
