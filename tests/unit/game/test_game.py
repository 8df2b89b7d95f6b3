"""Games on real boards follow their rules."""

from __future__ import annotations

import numpy as np
import pytest
from games import IN_POCKET, POCKET, bare, bumper, hit_bumper, kinds, lose, put, reflex_game

from boards import PADDLES
from silverball.errors import BoardFull, SilverballError
from silverball.game.game import Game
from silverball.game.mechanisms import points_by_part
from silverball.game.view import GameEventKind, Mode, Phase
from silverball.referee.stillness import CHECK_RATE
from silverball.table import SlantWall, generate_table, load_table


def test_a_new_game_is_ready_for_its_first_ball():
    game = Game(bare())
    face = game.view
    assert (face.phase, face.ball, face.balls, face.on_board, face.score) == (Phase.READY, 1, 3, 0, 0)
    assert [(one.kind, one.value) for one in game.take_game_events()] == [(GameEventKind.BALL_READY, 1)]
    assert game.take_game_events() == []


def test_a_hit_scores_the_points_of_the_part():
    game = Game(bare(bumper(70)))
    game.create_ball()
    events = hit_bumper(game)
    assert [(one.kind, one.value, one.part) for one in events] == [(GameEventKind.SCORED, 70, "cylinder[0]")]
    assert game.score == 70


@pytest.mark.parametrize("table", [load_table("classic"), generate_table(3)], ids=["classic", "random"])
def test_every_part_that_the_world_counts_points_for_has_a_path(table):
    game = Game(table)
    board, colliders = game.world.records[1:]
    points = points_by_part(table)
    names = game.world.hits
    by_number = colliders["points"][board["collider_first"] : board["collider_end"]].tolist()
    assert [points.get(name, 0) for name in names] == by_number


def test_in_free_play_the_score_is_that_of_the_world():
    game = reflex_game("classic", 5, Mode.FREE, seconds=40)
    assert game.score == game.world.score > 0
    assert game.view.balls == 0


def test_free_play_has_any_number_of_balls_two_at_a_time():
    game = Game(bare(), mode=Mode.FREE)
    for number in range(1, 12):
        game.create_ball()
        assert game.view.ball == number
        lose(game)
    game.create_ball()
    game.create_ball()
    with pytest.raises(BoardFull, match="2 balls"):
        game.create_ball()
    assert not game.is_over


def test_a_ball_is_saved_in_its_first_seconds_but_not_again_after_its_return():
    game = Game(bare(ball_save=2.0))
    game.create_ball()
    assert game.view.save_left == 2.0
    assert kinds(lose(game)) == [GameEventKind.BALL_SAVED]
    face = game.view
    assert (face.on_board, face.ball, face.save_left, face.phase) == (1, 1, 0.0, Phase.PLAY)
    assert kinds(lose(game)) == [GameEventKind.BALL_LOST, GameEventKind.BALL_READY]
    assert game.view.ball == 2


def test_ball_is_not_saved_after_the_first_seconds():
    game = Game(bare(*POCKET, ball_save=2.0))
    game.create_ball()
    put(game, *IN_POCKET)
    game.step(ticks=2 * 240)
    assert game.view.save_left == 0.0
    assert kinds(lose(game))[0] is GameEventKind.BALL_LOST


def test_a_ball_can_be_saved_as_often_as_the_table_says():
    game = Game(bare(ball_save=60.0, ball_saves=3))
    game.create_ball()
    for _ in range(3):
        assert kinds(lose(game)) == [GameEventKind.BALL_SAVED]
    assert kinds(lose(game))[0] is GameEventKind.BALL_LOST


def test_hits_in_a_row_make_a_combo_and_a_pause_ends_it():
    game = Game(bare(bumper(10), combo_window=1.0, combo_step=1, combo_limit=3))
    game.create_ball()
    expected = 0
    for place in range(5):
        events = hit_bumper(game)
        worth = 10 * min(1 + place, 3)
        expected += worth
        assert [one.value for one in events] == [worth] + [place + 1] * (place > 0)
        assert game.view.combo == place + 1
        assert game.view.multiplier == min(1 + place, 3)
    assert game.score == expected
    put(game, 3.0, 4.0, vx=10.0)
    game.step(ticks=241)
    assert (game.view.combo, game.view.multiplier) == (0, 1)
    assert [one.value for one in hit_bumper(game)] == [10]


def test_a_second_ball_early_uses_one_of_the_balls_left_and_doubles_the_points():
    game = Game(bare(bumper(100), ball_save=0.0, combo_window=0.0))
    game.create_ball()
    hit_bumper(game)
    put(game, 0.0, 3.0, vx=5.0)
    game.create_ball()
    assert kinds(game.take_game_events()) == [GameEventKind.DOUBLE_ON]
    assert (game.view.ball, game.view.on_board, game.view.multiplier) == (2, 2, 2)
    put(game, 5.0, -3.0, slot=1)
    assert [one.value for one in hit_bumper(game)] == [200]
    assert game.score == 300
    with pytest.raises(BoardFull):
        game.create_ball()
    assert kinds(lose(game, 1)) == [GameEventKind.BALL_LOST, GameEventKind.DOUBLE_OFF]
    game.create_ball()
    lose(game, 0)
    with pytest.raises(SilverballError, match="no ball is left: this is ball 3 of 3"):
        game.create_ball()
    assert kinds(lose(game, 1)) == [GameEventKind.BALL_LOST, GameEventKind.OVER]
    assert game.is_over


def test_after_three_balls_the_game_is_over_and_nothing_moves():
    game = Game(bare(ball_save=0.0))
    for number in (1, 2, 3):
        assert game.view.ball == number
        game.create_ball()
        lose(game)
    assert (game.phase, game.ended) == (Phase.OVER, "over")
    digest = game.digest()
    game.step(True, True, ticks=100)
    assert not game.jitter()
    with pytest.raises(SilverballError, match="the game is over"):
        game.create_ball()
    assert game.digest() == digest


def test_a_game_ends_when_the_player_leaves_it():
    game = Game(bare(bumper(10)))
    game.create_ball()
    hit_bumper(game)
    game.end()
    assert [(one.kind, one.value) for one in game.take_game_events()] == [(GameEventKind.OVER, 10)]
    assert (game.phase, game.ended) == (Phase.OVER, "stopped")
    game.end()
    assert game.take_game_events() == []


def test_a_shove_moves_the_ball_and_two_in_one_tick_are_one():
    game = Game(bare(*POCKET))
    game.create_ball()
    put(game, *IN_POCKET)
    game.step(ticks=240)
    game.take_world_events()
    assert game.jitter()
    assert not game.jitter()
    game.step()
    assert [event.kind for event in game.take_world_events()].count("jitter") == 1


def test_a_shove_needs_a_ball():
    game = Game(bare())
    with pytest.raises(SilverballError, match="no ball to shove"):
        game.jitter()


def test_shoves_cause_a_warning_and_then_a_tilt_but_nothing_in_free_play():
    for mode, expected in ((Mode.ARCADE, [GameEventKind.WARNING, GameEventKind.TILT]), (Mode.FREE, [])):
        game = Game(bare(*POCKET), mode=mode)
        game.create_ball()
        game.take_game_events()
        put(game, *IN_POCKET)
        for _ in range(3):
            game.jitter()
            game.step(ticks=24)
        assert kinds(game.take_game_events()) == expected
        assert game.view.tilted == bool(expected)


def test_after_a_tilt_the_paddles_are_dead_until_the_board_is_empty():
    game = Game(bare(*PADDLES, *POCKET, tilt_limit=0.5, ball_save=60.0))
    game.create_ball()
    put(game, *IN_POCKET)
    rest = [paddle.angle for paddle in game.world.paddles]
    game.step(True, True, ticks=48)
    up = [paddle.angle for paddle in game.world.paddles]
    assert min(up) > max(rest)
    game.jitter()
    assert game.view.tilted
    game.step(True, True, ticks=48)
    assert [paddle.angle for paddle in game.world.paddles] == rest
    assert not game.jitter()
    with pytest.raises(SilverballError, match="tilt"):
        game.create_ball()
    put(game, game.table.board.gutter + 0.05, 0.0, vx=-5.0)
    game.take_game_events()
    game.step(True, True, ticks=60)
    assert kinds(game.take_game_events()) == [GameEventKind.BALL_LOST, GameEventKind.BALL_READY]
    assert [paddle.angle for paddle in game.world.paddles] == up


LOW_POCKET = (
    SlantWall(start=(-6.0, -1.5), end=(-7.5, 0.0)),
    SlantWall(start=(-7.5, 0.0), end=(-6.0, 1.5)),
)  # within reach of the paddles
IN_LOW_POCKET = (-6.6, 0.0)


def checks(seconds: float) -> int:
    """The ticks until a ball that lies still from the start must have been shoved: two looks more."""
    return round((seconds + 2 / CHECK_RATE) * 240)


def test_a_still_ball_is_shoved_by_the_machine_again_and_again():
    game = Game(bare(*POCKET, un_stick=2.0))
    game.create_ball()
    put(game, *IN_POCKET)
    game.step(ticks=240)  # it comes to rest
    game.take_game_events()
    game.take_world_events()
    start = game.tick
    game.step(ticks=checks(2.0))
    (unstuck,) = game.take_game_events()
    assert unstuck.kind is GameEventKind.UNSTUCK
    assert 240 < unstuck.tick - start <= checks(2.0)
    assert [event.tick for event in game.take_world_events() if event.kind == "jitter"] == [unstuck.tick]
    assert game.view.warnings == 0


def test_a_ball_held_on_a_raised_paddle_is_left_alone_until_the_stall_time():
    table = bare(*PADDLES, *LOW_POCKET, bumper(), un_stick=2.0, stall=8.0)
    for held, expected in ((True, 8.0), (False, 2.0)):
        game = Game(table)
        game.create_ball()
        put(game, *IN_LOW_POCKET)
        game.take_game_events()
        while not (events := game.take_game_events()):
            game.step(left=held)
            assert game.tick < 3000
        assert kinds(events) == [GameEventKind.UNSTUCK]
        assert expected * 240 <= events[0].tick <= (expected + 1.0) * 240


def test_a_released_ball_is_not_shoved_immediately():
    game = Game(bare(*PADDLES, *LOW_POCKET, bumper(), un_stick=2.0, stall=60.0))
    game.create_ball()
    put(game, *IN_LOW_POCKET)
    game.take_game_events()
    game.step(left=True, ticks=5 * 240)
    assert game.take_game_events() == []
    released = game.tick
    game.step(ticks=5 * 240)
    assert released + 2 * 240 <= game.take_game_events()[0].tick <= released + checks(2.0)


def test_a_ball_held_too_long_is_shoved_repeatedly_but_not_at_every_check():
    game = Game(bare(*PADDLES, *LOW_POCKET, bumper(), un_stick=2.0, stall=5.0))
    game.create_ball()
    put(game, *IN_LOW_POCKET)
    game.take_game_events()
    for _ in range(12 * 240):
        game.step(left=True)
        put(game, *IN_LOW_POCKET)
    ticks = [one.tick for one in game.take_game_events()]
    assert [tick // 240 for tick in ticks] == [5, 7, 9, 11]


def test_a_ball_out_of_reach_is_shoved_whatever_the_paddles_do():
    game = Game(bare(*PADDLES, *POCKET, un_stick=2.0))
    game.create_ball()
    put(game, *IN_POCKET)
    game.take_game_events()
    for _ in range(240):
        game.step(True, False, ticks=2)
        game.step(False, True, ticks=2)
    assert GameEventKind.UNSTUCK in kinds(game.take_game_events())


def test_on_a_table_without_points_a_moving_ball_is_left_alone():
    game = Game(bare(*PADDLES, stall=1.0))
    game.create_ball()
    put(game, 0.0, 0.0, vx=12.0)
    game.take_game_events()
    game.step(ticks=600)
    assert game.view.on_board == 1
    assert kinds(game.take_game_events()) == []


def test_in_free_play_the_machine_never_shoves_but_a_still_ball_shows():
    game = Game(bare(*POCKET), mode=Mode.FREE)
    game.create_ball()
    put(game, *IN_POCKET)
    game.take_game_events()
    assert not game.has_still_ball
    game.step(ticks=6 * 240)
    assert game.has_still_ball
    assert kinds(game.take_game_events()) == []


def test_a_fault_of_the_world_ends_the_game_and_the_replay_names_it():
    game = Game(bare())
    game.create_ball()
    game.step(ticks=10)
    put(game, np.nan, 0.0)
    game.take_game_events()
    game.step(ticks=10)
    assert (game.fault, game.phase, game.ended) == ("not_finite", Phase.OVER, "not_finite")
    assert kinds(game.take_game_events()) == [GameEventKind.OVER]
    assert game.replay.ended == "not_finite"


def test_queues_that_are_not_read_drop_the_oldest_events():
    game = Game(bare(bumper(), ball_save=0.0, balls=99), mode=Mode.FREE)
    game.create_ball()
    for _ in range(4300):
        put(game, 0.0, 1.2, vz=-10.0)
        game.step(ticks=15)
    assert len(game.take_game_events()) == 4096
    assert len(game.take_world_events()) <= 4096


def test_hits_and_drained_balls_beyond_the_event_log_count(monkeypatch):
    game = Game(bare(bumper(30), ball_save=0.0))
    game.create_ball()
    monkeypatch.setattr(type(game.world), "events", ())
    monkeypatch.setattr(type(game.world), "events_lost", 1)
    put(game, 0.0, 1.2, vz=-10.0)
    for _ in range(15):
        game.step()
    assert game.score == 30
    put(game, game.table.board.gutter + 0.05, 0.0, vx=-5.0)
    for _ in range(5):
        game.step()
    assert (game.view.on_board, game.phase) == (0, Phase.READY)


def test_bad_arguments_are_refused():
    with pytest.raises(ValueError, match="tick_rate must be 10 to 1000"):
        Game(bare(), tick_rate=5000)
    with pytest.raises(ValueError, match="seed"):
        Game(bare(), seed=-1)
