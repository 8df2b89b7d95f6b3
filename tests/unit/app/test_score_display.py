"""The score display announces events without hiding the score for long."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from reading import reads
from silverball.app.score_display import MIN_VISIBLE_TIME, ScoreDisplay
from silverball.drawing.dotmatrix.fonts import BOLD, HUGE
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase

FACE = GameView(
    mode=Mode.ARCADE,
    phase=Phase.PLAY,
    score=120,
    ball=1,
    balls=3,
    on_board=1,
    combo=0,
    multiplier=1,
    save_left=0.0,
    warnings=0,
    tilted=False,
    max_balls=2,
)


def film(
    face: GameView,
    news: tuple[GameEvent, ...] = (),
    seconds: float = 4.0,
    rate: int = 15,
    high_score: int = 0,
):
    """The pictures of some seconds after news."""
    display = ScoreDisplay()
    display.frame(face, 0.0)
    display.add_events(news)
    return [display.frame(face, 10.0 + tick / rate, high_score) for tick in range(round(seconds * rate))]


def news(kind: GameEventKind, value: int = 0) -> tuple[GameEvent, ...]:
    return (GameEvent(kind, 1, value),)


def test_the_score_is_large_and_the_ball_is_told():
    dots = film(FACE)[0]
    assert reads(dots, "120", (HUGE,))
    assert reads(dots, "BALL 1/3")


def test_scores_of_any_size_are_shown():
    for score in (0, 7, 999_999_999, 1_234_567_890, 10**15):
        dots = film(FACE._replace(score=score))[0]
        assert reads(dots, f"{score:,}")


def test_free_play_shows_the_balls_on_the_board_instead_of_a_number():
    face = FACE._replace(mode=Mode.FREE, balls=0)
    one, two = film(face)[0], film(face._replace(on_board=2))[0]
    assert reads(one, "●○"[0])
    assert reads(one, "○")
    assert not reads(two, "○")
    assert not reads(one, "BALL")


def test_before_a_ball_it_says_which_key_brings_one():
    display = ScoreDisplay("RETURN")
    assert reads(display.frame(FACE._replace(phase=Phase.READY), 0.0), "PRESS RETURN")


def test_before_the_first_points_it_tells_the_score_to_beat():
    display = ScoreDisplay()
    face = FACE._replace(phase=Phase.READY, score=0)
    frames = [display.frame(face, tick / 4, 98_760) for tick in range(20)]
    assert any(reads(dots, "BEST 98,760") for dots in frames)
    assert any(reads(dots, "BALL 1 OF 3") for dots in frames)
    frames = [display.frame(FACE._replace(phase=Phase.READY), 9.0 + tick / 4, 98_760) for tick in range(20)]
    assert not any(reads(dots, "BEST") for dots in frames)


def test_messages_are_written_in_capitals():
    display = ScoreDisplay()
    display.show_message("Sound off")
    assert reads(display.frame(FACE, 1.0), "SOUND OFF")


def test_a_key_with_a_long_name_still_fits():
    display = ScoreDisplay("RIGHT SHIFT")
    assert reads(display.frame(FACE._replace(phase=Phase.READY), 0.0), "PRESS RIGHT SHIFT")


def test_double_points_are_shown_as_long_as_they_last():
    assert all(reads(dots, "×2") for dots in film(FACE._replace(multiplier=2), seconds=1.0))
    assert not reads(film(FACE)[0], "×2")


def test_ball_save_blinks_while_it_lasts():
    shown = [reads(dots, "BALL SAVE") for dots in film(FACE._replace(save_left=5.0), seconds=2.0)]
    assert any(shown)
    assert not all(shown)
    assert not any(reads(dots, "BALL SAVE") for dots in film(FACE, seconds=1.0))


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (news(GameEventKind.BALL_SAVED), "BALL SAVED"),
        (news(GameEventKind.DOUBLE_ON), "DOUBLE POINTS"),
        (news(GameEventKind.COMBO, 3), "COMBO 3"),
        (news(GameEventKind.COMBO, 5), "COMBO 5"),
        (news(GameEventKind.WARNING, 1), "WARNING!"),
        (news(GameEventKind.BALL_LOST, 2), "BALL 2 LOST"),
        (news(GameEventKind.SCORED, 250), "+250"),
        (news(GameEventKind.UNSTUCK), "STUCK BALL SHOVED"),
        ((GameEvent(GameEventKind.MESSAGE, 1, 0, "lock is lit"),), "LOCK IS LIT"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_news_are_told_beside_the_score(told, says):
    frames = film(FACE, told)
    assert any(reads(dots, says) and reads(dots, "120") for dots in frames)
    assert not reads(frames[-1], says)


def test_tilt_fills_the_display_and_the_score_comes_back_between():
    frames = film(FACE._replace(tilted=True), news(GameEventKind.TILT), seconds=3.0)
    filled = [dots for dots in frames if not reads(dots, "120")]
    assert filled
    assert max((dots.pixels > 0).mean() for dots in filled) > 0.5
    assert any(reads(dots, "TILT") and reads(dots, "120") for dots in frames)


def test_the_end_says_game_over_with_the_score():
    dots = film(FACE._replace(phase=Phase.OVER))[0]
    assert reads(dots, "GAME OVER")
    assert reads(dots, "120", (HUGE,))


def test_a_beaten_high_score_is_told_once_and_only_when_there_was_one():
    display = ScoreDisplay()
    before = [display.frame(FACE._replace(score=99), tick / 30, 100) for tick in range(30)]
    after = [display.frame(FACE, 1.0 + tick / 10, 100) for tick in range(50)]
    later = [display.frame(FACE._replace(score=500), 6.0 + tick / 10, 100) for tick in range(50)]
    assert not any(reads(dots, "HIGH SCORE!") for dots in before)
    assert any(reads(dots, "HIGH SCORE!") for dots in after)
    assert not any(reads(dots, "HIGH SCORE!") for dots in later)
    assert not any(reads(dots, "HIGH SCORE!") for dots in film(FACE, high_score=0))


def test_the_score_counts_up_and_arrives():
    display = ScoreDisplay()
    display.frame(FACE, 0.0)
    half = display.frame(FACE._replace(score=1120), 1.0)
    display.frame(FACE._replace(score=1120), 1.1)
    assert not reads(half, "1,120")
    assert reads(display.frame(FACE._replace(score=1120), 1.5), "1,120")


def test_a_new_game_begins_at_its_own_score_at_once():
    display = ScoreDisplay()
    display.frame(FACE, 0.0)
    assert reads(display.frame(FACE._replace(score=0), 1.0), "0", (HUGE,))


def test_messages_follow_each_other_and_long_ones_scroll_to_their_end():
    display = ScoreDisplay()
    display.frame(FACE, 0.0)
    display.show_message("FIRST")
    display.show_message("THEN A MESSAGE THAT IS FAR TOO LONG FOR ONE LINE")
    frames = [display.frame(FACE, 1.0 + tick / 10) for tick in range(160)]
    first = [reads(dots, "FIRST") for dots in frames]
    end = [reads(dots, "ONE LINE") for dots in frames]
    assert first.index(True) < end.index(True)
    assert not reads(frames[-1], "ONE LINE")
    assert all(reads(dots, "120") for dots in frames)


@pytest.mark.parametrize(
    ("face", "says"),
    [
        (FACE, "BALL SAVED"),
        (FACE._replace(phase=Phase.READY), "PRESS SPACE"),
        (FACE._replace(phase=Phase.OVER), "GAME OVER"),
        (FACE._replace(tilted=True), "TILT"),
    ],
)
def test_a_message_hides_neither_the_score_nor_what_stands_above_it(face, says):
    display = ScoreDisplay()
    display.frame(face, 0.0)
    display.add_events(news(GameEventKind.BALL_SAVED) if says == "BALL SAVED" else ())
    display.show_message("THE BOARD IS KEPT")
    frames = [display.frame(face, 5.0 + tick / 10) for tick in range(20)]
    seen = [dots for dots in frames if reads(dots, "120")]
    assert seen
    assert all(reads(dots, says) and reads(dots, "THE BOARD IS KEPT") for dots in seen)


def test_a_calm_display_never_hides_the_score_and_never_flashes():
    display = ScoreDisplay(is_calm=True)
    display.frame(FACE, 0.0)
    display.add_events((*news(GameEventKind.DOUBLE_ON), *news(GameEventKind.BALL_SAVED)))
    faces = [FACE] * 60 + [FACE._replace(tilted=True)] * 60
    frames = [display.frame(face, 5.0 + tick / 15, 50) for tick, face in enumerate(faces)]
    assert all(reads(dots, "120") for dots in frames)
    assert max((dots.pixels > 0).mean() for dots in frames) < 0.5
    assert any(reads(dots, "BALL SAVED") for dots in frames)
    assert reads(frames[-1], "TILT")


def test_of_many_messages_the_newest_are_told():
    display = ScoreDisplay()
    display.frame(FACE, 0.0)
    for number in range(30):
        display.show_message(f"MESSAGE {number}")
    frames = [display.frame(FACE, 1.0 + tick / 5) for tick in range(80)]
    told = [number for number in range(30) if any(reads(dots, f"MESSAGE {number}") for dots in frames[::8])]
    assert told[-1] == 29
    assert len(told) <= 5
    assert not reads(frames[-1], "MESSAGE")


def test_more_important_news_interrupt_and_less_important_ones_wait():
    display = ScoreDisplay()
    display.frame(FACE, 0.0)
    display.add_events(news(GameEventKind.COMBO, 3))
    display.frame(FACE, 1.0)
    display.add_events((*news(GameEventKind.BALL_SAVED), *news(GameEventKind.WARNING, 1)))
    frames = [display.frame(FACE, 1.1 + tick / 10) for tick in range(60)]
    saved = [reads(dots, "BALL SAVED") for dots in frames]
    warned = [reads(dots, "WARNING!") for dots in frames]
    assert True in saved
    assert saved.index(True) < warned.index(True)


KINDS = st.builds(
    GameEvent,
    st.sampled_from(list(GameEventKind)),
    st.just(1),
    st.integers(0, 12),
    st.sampled_from(["", "cylinder[0]"]),
)
FACES = st.builds(
    FACE._replace,
    phase=st.sampled_from(list(Phase)),
    mode=st.sampled_from(list(Mode)),
    combo=st.integers(0, 12),
    multiplier=st.integers(1, 4),
    save_left=st.floats(0.0, 8.0),
    tilted=st.booleans(),
    on_board=st.integers(0, 2),
)
MOMENTS = st.lists(
    st.tuples(st.lists(KINDS, max_size=3), FACES, st.integers(1, 25), st.booleans()), min_size=1, max_size=5
)


def played(moments, rate: float, scores: tuple[int, int]) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """The same story told by two displays that differ in the score alone: times and both pictures."""
    one, other = ScoreDisplay(), ScoreDisplay()
    seconds, frames = 3.0, []
    for told, face, count, says in moments:
        for display in (one, other):
            display.add_events(told)
            if says:
                display.show_message("MORE THAN ONE CAN READ AT ONCE ON THIS DISPLAY")
        for _ in range(count):
            seconds += 1.0 / rate
            pictures = [
                display.frame(face._replace(score=score), seconds, 50).pixels
                for display, score in zip((one, other), scores, strict=True)
            ]
            frames.append((seconds, *pictures))
    return frames


@settings(max_examples=20, deadline=None)
@given(moments=MOMENTS, rate=st.sampled_from([10.0, 30.0, 60.0]))
def test_the_score_is_never_hidden_for_more_than_a_second_nor_again_at_once(moments, rate):
    hidden_since, seen_since = None, None
    for seconds, one, other in played(moments, rate, (888_888, 111_111)):
        # Where two different scores give much the same picture, no score is seen: six eights or six ones,
        # in the smaller of the two fonts of scores, differ in 150 dots and more.
        if (one != other).sum() > 120:
            seen_since = seconds if hidden_since is not None else seen_since
            hidden_since = None
        elif hidden_since is None:
            hidden_since = seconds
            assert seen_since is None or seconds - seen_since >= MIN_VISIBLE_TIME
        else:
            assert seconds - hidden_since <= 1.0


@settings(max_examples=10, deadline=None)
@given(moments=MOMENTS)
def test_the_same_news_at_the_same_times_show_the_same_dots(moments):
    for _, one, other in played(moments, 30.0, (4321, 4321)):
        assert (one == other).all()


def test_a_combo_climbs_on_its_meters():
    lit = [int((film(FACE._replace(combo=combo))[0].pixels[:23, :4] > 0).sum()) for combo in range(2, 9)]
    assert lit == sorted(lit)
    assert len(set(lit)) == len(lit)


def test_large_words_are_written_in_the_bold_font():
    assert any(reads(dots, "WARNING!!", (BOLD,)) for dots in film(FACE, news(GameEventKind.WARNING, 2)))
