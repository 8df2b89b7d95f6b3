"""The built-in rules follow the numbers of a table; every expected value is computed from those numbers."""

from __future__ import annotations

from hypothesis import given, strategies as st

from boards import table_of
from silverball.game import rules
from silverball.game.builtin_rules import ArcadeRules, FreeRules
from silverball.game.view import GameEventKind
from silverball.table import Arcade, Table

RATE = 240
numbers = st.integers


ARCADE, FREE = ArcadeRules(), FreeRules()


def config_of(play: rules.Rules = ARCADE, **arcade) -> rules.RuleConfig:
    table: Table = table_of().model_copy(update={"arcade": Arcade(**arcade)})
    return play.configure(table, RATE)


def with_balls(config: rules.RuleConfig, count: int, tick: int = 0) -> rules.RuleState:
    state = rules.RuleState()
    for number in range(1, count + 1):
        state, _ = ARCADE.started(config, state, tick, number)
    return state


@given(st.lists(numbers(1, 1000), max_size=20), numbers(1, 5), numbers(1, 6))
def test_hits_in_a_row_are_multiplied_by_the_factor_of_their_place(points, step, limit):
    config = config_of(combo_step=step, combo_limit=limit)
    state = with_balls(config, 1)
    expected = 0
    for place, worth in enumerate(points):
        expected += worth * min(1 + place // step, limit)
        state, events = ARCADE.hit(config, state, 10 * place, worth, "cylinder[0]")
        assert events[0].part == "cylinder[0]"
        assert (len(events) > 1) == (place > 0)
    assert state.score == expected


@given(st.lists(st.tuples(numbers(0, 600), numbers(1, 100)), max_size=20), st.floats(0.1, 2.0))
def test_a_combo_ends_when_the_time_for_the_next_hit_is_over(hits, window):
    config = config_of(combo_window=window, combo_step=1, combo_limit=100)
    state = with_balls(config, 1)
    tick, in_a_row, expected = 0, 0, 0
    for pause, worth in hits:
        tick += pause
        in_a_row = in_a_row + 1 if pause <= round(window * RATE) else 1
        expected += worth * in_a_row
        state, _ = ARCADE.hit(config, state, tick, worth, "")
    assert state.score == expected
    assert rules.running_combo(config, state, tick + round(window * RATE)) == in_a_row
    assert rules.running_combo(config, state, tick + round(window * RATE) + 1) == 0


@given(numbers(1, 9), numbers(1, 1000))
def test_two_balls_on_the_board_multiply_points_by_the_tables_factor(double, points):
    config = config_of(double=double, combo_window=0.0)
    one, _ = ARCADE.hit(config, with_balls(config, 1), 5, points, "")
    two, _ = ARCADE.hit(config, with_balls(config, 2), 5, points, "")
    assert (one.score, two.score) == (points, points * double)


def test_free_play_counts_plain_points_and_has_no_combos():
    config = config_of(FREE)
    state = with_balls(config, 2)
    for tick in range(9):
        state, events = FREE.hit(config, state, tick, 100, "")
        assert [one.kind for one in events] == [GameEventKind.SCORED]
    assert state.score == 900
    assert (state.combo, FREE.multiplier(config, state, 9)) == (0, 1)


def test_a_combo_window_of_zero_disables_combos():
    config = config_of(combo_window=0.0, combo_step=1)
    state = with_balls(config, 1)
    for _ in range(5):
        state, _ = ARCADE.hit(config, state, 7, 10, "")
    assert state.score == 50


@given(numbers(0, 3), numbers(0, 2000))
def test_a_ball_is_given_back_in_its_first_seconds_and_no_more_often_than_the_table_says(saves, tick):
    config = config_of(ball_save=4.0, ball_saves=saves)
    state = with_balls(config, 1)
    ball, given_back = 1, 0
    while True:
        state, events = ARCADE.drained(config, state, tick, ball)
        if not state.waiting:
            break
        assert events[0].kind is GameEventKind.BALL_SAVED
        given_back += 1
        ball += 1
        state, _ = ARCADE.returned(config, state, 0, ball)
    assert given_back == (saves if tick < 4 * RATE else 0)
    assert events[0].kind is GameEventKind.BALL_LOST


def test_a_saved_ball_counts_as_in_play_so_double_points_continue():
    config = config_of(ball_save=4.0)
    state = with_balls(config, 2)
    state, events = ARCADE.drained(config, state, 100, 1)
    assert [one.kind for one in events] == [GameEventKind.BALL_SAVED]
    assert ARCADE.multiplier(config, state, 100) == config.double


def test_a_second_ball_that_is_brought_early_is_not_saved():
    config = config_of(ball_save=4.0)
    state, events = ARCADE.drained(config, with_balls(config, 2), 100, 2)
    assert [one.kind for one in events] == [GameEventKind.BALL_LOST, GameEventKind.DOUBLE_OFF]
    assert state.waiting == ()


def test_double_points_are_reported_when_they_begin_and_when_they_end():
    config = config_of(ball_save=0.0)
    state, first = ARCADE.started(config, rules.RuleState(), 0, 1)
    state, second = ARCADE.started(config, state, 0, 2)
    assert [one.kind for one in (*first, *second)] == [GameEventKind.DOUBLE_ON]
    state, events = ARCADE.drained(config, state, 9, 1)
    assert [one.kind for one in events] == [GameEventKind.BALL_LOST, GameEventKind.DOUBLE_OFF]


@given(numbers(1, 6))
def test_a_game_has_as_many_balls_as_the_table_says_and_ends_with_the_last(balls):
    config = config_of(balls=balls, ball_save=0.0)
    state = rules.RuleState()
    for number in range(1, balls + 1):
        assert ARCADE.refusal(config, state) == ""
        state, _ = ARCADE.started(config, state, number, number)
        state, events = ARCADE.drained(config, state, number, number)
        last = [GameEventKind.OVER] if number == balls else [GameEventKind.BALL_READY]
        assert [one.kind for one in events] == [GameEventKind.BALL_LOST, *last]
        assert events[0].value == number
    assert state.over
    assert "over" in ARCADE.refusal(config, state)


def test_there_is_no_ball_beyond_the_last_while_it_is_in_play():
    config = config_of(balls=2)
    state = with_balls(config, 2)
    assert ARCADE.refusal(config, state) == "no ball is left: this is ball 2 of 2"
    assert not state.over


def test_free_play_has_any_number_of_balls():
    config = config_of(FREE, balls=1)
    state = rules.RuleState()
    for number in range(1, 50):
        state, _ = FREE.started(config, state, number, number)
        state, events = FREE.drained(config, state, number, number)
        assert [one.kind for one in events] == [GameEventKind.BALL_LOST, GameEventKind.BALL_READY]
    assert not state.over
    assert FREE.refusal(config, state) == ""


def test_shoves_are_free_in_free_play():
    config = config_of(FREE)
    state = with_balls(config, 1)
    for tick in range(100):
        state, events = FREE.shoved(config, state, tick)
        assert events == ()
    assert state.swing == 0.0


def test_the_third_of_three_quick_shoves_is_a_tilt_and_the_second_a_warning():
    config = config_of()
    state = with_balls(config, 1)
    reported = []
    for tick in (0, 24, 48):
        state, events = ARCADE.shoved(config, state, tick)
        reported.append([one.kind for one in events])
    assert reported == [[], [GameEventKind.WARNING], [GameEventKind.TILT]]
    assert state.tilted


@given(numbers(0, 5))
def test_a_table_gives_its_number_of_warnings_and_then_tilts(warnings):
    config = config_of(warnings=warnings, tilt_warning=0.5, tilt_limit=1000.0)
    state = with_balls(config, 1)
    reported = []
    for number in range(warnings + 1):
        state, events = ARCADE.shoved(config, state, 100_000 * number)
        reported += [(one.kind, one.value) for one in events]
    counted = [(GameEventKind.WARNING, number) for number in range(1, warnings + 1)]
    assert reported == [*counted, (GameEventKind.TILT, 0)]


def test_while_tilted_nothing_scores_no_ball_is_saved_and_none_starts():
    config = config_of(tilt_limit=0.5)
    state = with_balls(config, 2)
    state, _ = ARCADE.shoved(config, state, 0)
    assert state.tilted
    assert ARCADE.hit(config, state, 1, 100, "")[0].score == 0
    assert "tilt" in ARCADE.refusal(config, state)
    state, events = ARCADE.drained(config, state, 2, 1)
    assert events[0].kind is GameEventKind.BALL_LOST
    assert state.tilted
    state, _ = ARCADE.drained(config, state, 3, 2)
    assert not state.tilted


def test_warnings_are_forgotten_when_the_board_is_empty():
    config = config_of(tilt_warning=0.5, ball_save=0.0)
    state, _ = ARCADE.shoved(config, with_balls(config, 1), 0)
    assert state.warnings == 1
    state, _ = ARCADE.drained(config, state, 1, 1)
    assert state.warnings == 0


def test_a_combo_ends_with_its_ball():
    config = config_of(ball_save=0.0, combo_window=9.0)
    state, _ = ARCADE.hit(config, with_balls(config, 1), 10, 5, "")
    state, _ = ARCADE.drained(config, state, 20, 1)
    state, _ = ARCADE.started(config, state, 30, 2)
    assert rules.running_combo(config, state, 30) == 0
    assert ARCADE.hit(config, state, 40, 5, "")[0].combo == 1


def test_an_unknown_ball_changes_nothing():
    config = config_of()
    state = with_balls(config, 1)
    assert ARCADE.drained(config, state, 5, 77) == (state, ())


def test_a_game_that_is_ended_twice_ends_once():
    config = config_of()
    state, events = rules.ended(with_balls(config, 1), 5)
    assert [one.kind for one in events] == [GameEventKind.OVER]
    assert rules.ended(state, 6) == (state, ())
