"""Do the rules count as a table's numbers say? Every value is computed from those numbers."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from boards import table_of
from silverball.game import rules
from silverball.game.view import GameEventKind, Mode
from silverball.table import Arcade, Table

RATE = 240
numbers = st.integers


def laws_of(mode: Mode = Mode.ARCADE, **arcade) -> rules.RuleConfig:
    table: Table = table_of().model_copy(update={"arcade": Arcade(**arcade)})
    return rules.RuleConfig.of(table, mode, RATE)


def with_balls(laws: rules.RuleConfig, count: int, tick: int = 0) -> rules.RuleState:
    now = rules.RuleState()
    for number in range(1, count + 1):
        now, _ = rules.started(laws, now, tick, number)
    return now


@given(st.lists(numbers(1, 1000), max_size=20), numbers(1, 5), numbers(1, 6))
def test_hits_in_a_row_are_multiplied_by_the_factor_of_their_place(points, step, limit):
    laws = laws_of(combo_step=step, combo_limit=limit)
    now = with_balls(laws, 1)
    expected = 0
    for place, worth in enumerate(points):
        expected += worth * min(1 + place // step, limit)
        now, news = rules.hit(laws, now, 10 * place, worth, "cylinder[0]")
        assert news[0].part == "cylinder[0]"
        assert (len(news) > 1) == (place > 0)
    assert now.score == expected


@given(st.lists(st.tuples(numbers(0, 600), numbers(1, 100)), max_size=20), st.floats(0.1, 2.0))
def test_a_combo_ends_when_the_time_for_the_next_hit_is_over(hits, window):
    laws = laws_of(combo_window=window, combo_step=1, combo_limit=100)
    now = with_balls(laws, 1)
    tick, in_a_row, expected = 0, 0, 0
    for pause, worth in hits:
        tick += pause
        in_a_row = in_a_row + 1 if pause <= round(window * RATE) else 1
        expected += worth * in_a_row
        now, _ = rules.hit(laws, now, tick, worth, "")
    assert now.score == expected
    assert rules.running_combo(laws, now, tick + round(window * RATE)) == in_a_row
    assert rules.running_combo(laws, now, tick + round(window * RATE) + 1) == 0


@given(numbers(1, 9), numbers(1, 1000))
def test_two_balls_on_the_board_multiply_points_by_the_tables_factor(double, points):
    laws = laws_of(double=double, combo_window=0.0)
    one, _ = rules.hit(laws, with_balls(laws, 1), 5, points, "")
    two, _ = rules.hit(laws, with_balls(laws, 2), 5, points, "")
    assert (one.score, two.score) == (points, points * double)


def test_free_play_counts_plain_points_and_has_no_combos():
    laws = laws_of(Mode.FREE)
    now = with_balls(laws, 2)
    for tick in range(9):
        now, news = rules.hit(laws, now, tick, 100, "")
        assert [one.kind for one in news] == [GameEventKind.SCORED]
    assert now.score == 900
    assert (now.combo, rules.multiplier(laws, now, 9)) == (0, 1)


def test_a_window_of_zero_means_no_combos():
    laws = laws_of(combo_window=0.0, combo_step=1)
    now = with_balls(laws, 1)
    for _ in range(5):
        now, _ = rules.hit(laws, now, 7, 10, "")
    assert now.score == 50


@given(numbers(0, 3), numbers(0, 2000))
def test_a_ball_is_given_back_in_its_first_seconds_and_no_more_often_than_the_table_says(saves, tick):
    laws = laws_of(ball_save=4.0, ball_saves=saves)
    now = with_balls(laws, 1)
    ball, given_back = 1, 0
    while True:
        now, news = rules.drained(laws, now, tick, ball)
        if not now.waiting:
            break
        assert news[0].kind is GameEventKind.BALL_SAVED
        given_back += 1
        ball += 1
        now, _ = rules.put_back(laws, now, 0, ball)
    assert given_back == (saves if tick < 4 * RATE else 0)
    assert news[0].kind is GameEventKind.BALL_LOST


def test_the_saved_ball_counts_as_one_in_play_so_that_double_points_go_on():
    laws = laws_of(ball_save=4.0)
    now = with_balls(laws, 2)
    now, news = rules.drained(laws, now, 100, 1)
    assert [one.kind for one in news] == [GameEventKind.BALL_SAVED]
    assert rules.multiplier(laws, now, 100) == laws.double


def test_a_second_ball_that_is_brought_early_is_not_saved():
    laws = laws_of(ball_save=4.0)
    now, news = rules.drained(laws, with_balls(laws, 2), 100, 2)
    assert [one.kind for one in news] == [GameEventKind.BALL_LOST, GameEventKind.DOUBLE_OFF]
    assert now.waiting == ()


def test_double_points_are_told_when_they_begin_and_when_they_end():
    laws = laws_of(ball_save=0.0)
    now, first = rules.started(laws, rules.RuleState(), 0, 1)
    now, second = rules.started(laws, now, 0, 2)
    assert [one.kind for one in (*first, *second)] == [GameEventKind.DOUBLE_ON]
    now, news = rules.drained(laws, now, 9, 1)
    assert [one.kind for one in news] == [GameEventKind.BALL_LOST, GameEventKind.DOUBLE_OFF]


@given(numbers(1, 6))
def test_a_game_has_as_many_balls_as_the_table_says_and_ends_with_the_last(balls):
    laws = laws_of(balls=balls, ball_save=0.0)
    now = rules.RuleState()
    for number in range(1, balls + 1):
        assert rules.refusal(laws, now) == ""
        now, _ = rules.started(laws, now, number, number)
        now, news = rules.drained(laws, now, number, number)
        last = [GameEventKind.OVER] if number == balls else [GameEventKind.BALL_READY]
        assert [one.kind for one in news] == [GameEventKind.BALL_LOST, *last]
        assert news[0].value == number
    assert now.over
    assert "over" in rules.refusal(laws, now)


def test_there_is_no_ball_beyond_the_last_while_it_is_in_play():
    laws = laws_of(balls=2)
    now = with_balls(laws, 2)
    assert rules.refusal(laws, now) == "no ball is left: this is ball 2 of 2"
    assert not now.over


def test_free_play_has_balls_without_end():
    laws = laws_of(Mode.FREE, balls=1)
    now = rules.RuleState()
    for number in range(1, 50):
        now, _ = rules.started(laws, now, number, number)
        now, news = rules.drained(laws, now, number, number)
        assert [one.kind for one in news] == [GameEventKind.BALL_LOST, GameEventKind.BALL_READY]
    assert not now.over
    assert rules.refusal(laws, now) == ""


def test_shoves_are_free_in_free_play():
    laws = laws_of(Mode.FREE)
    now = with_balls(laws, 1)
    for tick in range(100):
        now, news = rules.shoved(laws, now, tick)
        assert news == ()
    assert now.swing == 0.0


def test_the_third_of_three_quick_shoves_is_a_tilt_and_the_second_a_warning():
    laws = laws_of()
    now = with_balls(laws, 1)
    told = []
    for tick in (0, 24, 48):
        now, news = rules.shoved(laws, now, tick)
        told.append([one.kind for one in news])
    assert told == [[], [GameEventKind.WARNING], [GameEventKind.TILT]]
    assert now.tilted


@given(numbers(0, 5))
def test_a_table_gives_so_many_warnings_and_then_tilts(warnings):
    laws = laws_of(warnings=warnings, tilt_warning=0.5, tilt_limit=1000.0)
    now = with_balls(laws, 1)
    told = []
    for number in range(warnings + 1):
        now, news = rules.shoved(laws, now, 100_000 * number)
        told += [(one.kind, one.value) for one in news]
    counted = [(GameEventKind.WARNING, number) for number in range(1, warnings + 1)]
    assert told == [*counted, (GameEventKind.TILT, 0)]


def test_while_tilted_nothing_scores_nothing_is_saved_and_no_ball_is_brought():
    laws = laws_of(tilt_limit=0.5)
    now = with_balls(laws, 2)
    now, _ = rules.shoved(laws, now, 0)
    assert now.tilted
    assert rules.hit(laws, now, 1, 100, "")[0].score == 0
    assert "tilt" in rules.refusal(laws, now)
    now, news = rules.drained(laws, now, 2, 1)
    assert news[0].kind is GameEventKind.BALL_LOST
    assert now.tilted
    now, _ = rules.drained(laws, now, 3, 2)
    assert not now.tilted


def test_warnings_are_forgotten_when_the_board_is_empty():
    laws = laws_of(tilt_warning=0.5, ball_save=0.0)
    now, _ = rules.shoved(laws, with_balls(laws, 1), 0)
    assert now.warnings == 1
    now, _ = rules.drained(laws, now, 1, 1)
    assert now.warnings == 0


def test_a_combo_does_not_go_on_with_the_next_ball():
    laws = laws_of(ball_save=0.0, combo_window=9.0)
    now, _ = rules.hit(laws, with_balls(laws, 1), 10, 5, "")
    now, _ = rules.drained(laws, now, 20, 1)
    now, _ = rules.started(laws, now, 30, 2)
    assert rules.running_combo(laws, now, 30) == 0
    assert rules.hit(laws, now, 40, 5, "")[0].combo == 1


def test_a_ball_that_the_game_does_not_know_changes_nothing():
    laws = laws_of()
    now = with_balls(laws, 1)
    assert rules.drained(laws, now, 5, 77) == (now, ())


def test_a_game_that_is_ended_twice_ends_once():
    laws = laws_of()
    now, news = rules.ended(with_balls(laws, 1), 5)
    assert [one.kind for one in news] == [GameEventKind.OVER]
    assert rules.ended(now, 6) == (now, ())
