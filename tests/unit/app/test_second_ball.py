"""In arcade a second ball is one of three, and only a second press spends it."""

from __future__ import annotations

import pytest

from evenings import NOTHING, Evening
from reading import reads
from silverball.app.controls import Action
from silverball.app.sessions import CONFIRM_WITHIN, NEW_BALL_LOCK, GameSession
from silverball.app.settings import Settings
from silverball.errors import BoardFull, SilverballError
from silverball.game.game import Game
from silverball.game.replay.verify import verify
from silverball.game.view import Mode, Phase
from silverball.table import Arcade, Board, Table

RATE = 240
LONG = Table(name="Long", board=Board(gravity=0.1), arcade=Arcade(balls=3, ball_save=0))


def playing(mode=Mode.ARCADE, table=LONG) -> GameSession:
    return GameSession(Game(table, 5, mode))


def wait(session: GameSession, seconds: float) -> None:
    session.advance(NOTHING, round(seconds * RATE))


def balls(session: GameSession) -> int:
    return session.game.world.created


def test_the_first_ball_comes_at_once():
    session = playing()
    assert session.create_ball("SPACE") == ""
    assert balls(session) == 1


@pytest.mark.parametrize("tenths", range(0, 10, 3))
def test_within_a_second_of_a_ball_no_press_brings_another_nor_asks_for_it(tenths):
    session = playing()
    session.create_ball("SPACE")
    wait(session, tenths / 10)
    for _ in range(5):
        assert "IN PLAY" in session.create_ball("SPACE")
    assert balls(session) == 1
    wait(session, NEW_BALL_LOCK)
    assert "AGAIN" in session.create_ball("SPACE")  # those presses have asked nothing
    assert balls(session) == 1


@pytest.mark.parametrize("first", [1.0, 1.5, 3.0])
@pytest.mark.parametrize("second", [0.0, 0.1, 1.0, 2.9, 3.1, 7.0])
def test_a_press_asks_and_another_one_within_some_seconds_is_the_answer(first, second):
    session = playing()
    session.create_ball("SPACE")
    wait(session, first)
    assert session.create_ball("SPACE") == "SPACE AGAIN: BALL 2 OF 3"
    assert balls(session) == 1
    wait(session, second)
    words = session.create_ball("SPACE")
    assert balls(session) == (2 if second <= CONFIRM_WITHIN else 1)
    assert bool(words) == (balls(session) == 1)


@pytest.mark.parametrize("hertz", [2, 5, 10, 30])
def test_hammering_on_space_spends_no_ball_within_the_first_second(hertz):
    session = playing()
    for _ in range(hertz):
        session.create_ball("SPACE")
        assert balls(session) == 1
        wait(session, 1.0 / hertz - 1.0 / RATE)


def test_every_further_ball_is_asked_for_again():
    session = playing(table=LONG.model_copy(update={"board": Board(gravity=0.1, max_balls=2)}))
    session.create_ball("SPACE")
    wait(session, 2.0)
    session.create_ball("SPACE")
    session.create_ball("SPACE")
    wait(session, 2.0)
    with pytest.raises(BoardFull):
        session.create_ball("SPACE")


def test_with_the_last_ball_in_play_there_is_nothing_to_ask():
    session = playing(table=LONG.model_copy(update={"arcade": Arcade(balls=1)}))
    session.create_ball("SPACE")
    with pytest.raises(SilverballError, match="no ball is left"):
        session.create_ball("SPACE")


def test_in_free_play_nothing_is_asked():
    session = playing(Mode.FREE)
    assert [session.create_ball("SPACE"), session.create_ball("SPACE")] == ["", ""]
    assert balls(session) == 2


def test_a_tilted_table_says_so_and_asks_nothing():
    session = playing()
    session.create_ball("SPACE")
    wait(session, 2.0)
    for _ in range(5):
        session.game.jitter()
        wait(session, 0.1)
    assert session.game.view.tilted
    with pytest.raises(SilverballError, match="tilt"):
        session.create_ball("SPACE")


def test_a_game_with_questions_is_the_same_game_and_its_replay_is_whole():
    session = playing()
    plain = Game(LONG, 5, Mode.ARCADE)
    session.create_ball("SPACE")
    plain.create_ball()
    wait(session, 1.5)
    plain.step(ticks=360)
    session.create_ball("SPACE")
    session.create_ball("SPACE")
    plain.create_ball()
    wait(session, 2.0)
    plain.step(ticks=480)
    assert session.game.digest() == plain.digest()
    assert verify(session.game.replay).ok


def test_the_display_asks_with_the_key_that_was_chosen(tmp_path):
    settings = Settings(table="Long", keys={"create": ("return",)})
    evening = Evening(tmp_path, settings, LONG)
    evening.program.finish_loading()
    evening.program.play(Mode.ARCADE, "Long", 3)
    evening.tap(Action.CREATE)
    evening.tap(Action.CREATE)
    assert reads(evening.program.dots(evening.seconds), "BALL 1 IS IN PLAY")
    evening.go(1.2)
    evening.tap(Action.CREATE)
    assert reads(evening.program.dots(evening.seconds), "RETURN AGAIN: BALL 2 OF 3")  # not behind the other
    assert evening.program.session.game.phase is Phase.PLAY
    assert len(evening.program.session.game.world.balls) == 1
    evening.tap(Action.CREATE)
    assert len(evening.program.session.game.world.balls) == 2
    evening.store.close()
