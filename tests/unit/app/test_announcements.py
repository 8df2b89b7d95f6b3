"""A jackpot goes before a mission, a mission before a combo; the score stays in its place."""

import itertools

import numpy as np
import pytest

from rule_tables import comet
from silverball.app.announcements import Announcements, Rank, TableWords
from silverball.app.score_display import SCORE_ROWS, STATUS_Y, WIDE_ROWS, ScoreDisplay
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.table import load_table

WORDS = TableWords.of(comet())
MISSIONS = ("chase the comet", "land on the moon", "storm of Mars", "through the rings", "birth of a star")
KIND = GameEventKind
JACKPOT = GameEvent(KIND.CUE, 9, 0, "jackpot")
MISSION = GameEvent(KIND.MESSAGE, 9, 0, "landed")
COMBO = GameEvent(KIND.COMBO, 9, 4)
TEXTS = {JACKPOT: "JACKPOT", MISSION: "LANDED", COMBO: "COMBO 4"}
PLAYING = GameView(Mode.ARCADE, Phase.PLAY, 0, 1, 3, 1, 0, 1, 0.0, 0, False, 3)


@pytest.mark.parametrize("order", list(itertools.permutations((JACKPOT, MISSION, COMBO))))
def test_whatever_comes_first_the_higher_rank_is_shown_first(order):
    queue, shown = Announcements(WORDS), []
    for event in order:
        queue.add_event(event)
    for frame in range(400):
        queue.advance(frame / 60.0)
        if queue.current is not None and (not shown or shown[-1] != queue.current.text):
            shown.append(queue.current.text)
    assert shown[:2] == ["JACKPOT", "LANDED"]


@pytest.mark.parametrize(("high", "low"), [(JACKPOT, MISSION), (JACKPOT, COMBO), (MISSION, COMBO)])
def test_a_lower_rank_never_hides_a_higher_one_and_a_higher_one_appears_at_once(high, low):
    for first, second in ((high, low), (low, high)):
        queue = Announcements(WORDS)
        queue.add_event(first)
        queue.advance(0.0)
        queue.add_event(second)
        queue.advance(0.1)
        assert queue.current is not None
        assert queue.current.text == TEXTS[high]


def test_the_rules_of_a_table_say_what_their_messages_are_about():
    assert WORDS.messages["landed"] is Rank.MISSION
    assert WORDS.messages["too late"] is Rank.MISSION
    assert WORDS.messages["combo"] is Rank.COMBO
    assert WORDS.messages["extra ball"] is Rank.EXTRA_BALL
    assert WORDS.messages["multiball"] is Rank.MULTIBALL
    assert WORDS.cues == {"jackpot": Rank.JACKPOT, "super jackpot": Rank.JACKPOT}
    assert "storm of Mars" in WORDS.announced
    assert "skill" not in WORDS.missions


def test_a_timer_of_the_rules_is_not_announced():
    words = TableWords.of(load_table("silver_comet"))
    assert words.missions == {*MISSIONS, "silver comet"}
    assert not words.announced  # each of them begins with a message
    queue = Announcements(words)
    queue.add_event(GameEvent(KIND.MODE_STARTED, 9, 0, "left orbit shot"))
    queue.advance(0.0)
    assert queue.current is None


def test_the_points_of_a_jackpot_stand_below_it():
    queue = Announcements(WORDS)
    for event in (GameEvent(KIND.SCORED, 9, 50000, "spinner"), GameEvent(KIND.SCORED, 9, 10, "x"), JACKPOT):
        queue.add_event(event)
    queue.advance(0.0)
    assert queue.current is not None
    assert queue.current.detail == "50,000"


def test_the_upper_half_of_the_wide_display_shows_the_score_whatever_happens():
    display = ScoreDisplay(words=WORDS)
    view = PLAYING._replace(score=12345)
    rest = display.wide_frame(view, 0.0)[:SCORE_ROWS]
    assert rest.any()
    everything = [*TEXTS, GameEvent(KIND.BALL_SAVED, 9, 1), GameEvent(KIND.BALL_LOST, 9, 1)]
    display.add_events(everything)
    below = []
    for frame in range(1, 300):
        dots = display.wide_frame(view, frame / 60.0, modes={"land on the moon": 12.0})
        assert dots.shape[0] == WIDE_ROWS
        assert np.array_equal(dots[:SCORE_ROWS], rest)
        below.append(dots[SCORE_ROWS:].tobytes())
    assert len(set(below)) > 20
    display.add_events([GameEvent(KIND.TILT, 9)])
    tilted = display.wide_frame(view._replace(tilted=True), 6.0)
    assert np.array_equal(tilted[:SCORE_ROWS], rest)


def test_a_combo_does_not_hide_the_time_of_a_mission():
    display = ScoreDisplay(words=WORDS)
    display.wide_frame(PLAYING, 0.0)
    display.add_events([COMBO])
    seconds = [
        display.wide_frame(PLAYING, 0.2, modes={"land on the moon": left})[SCORE_ROWS:, 110:]
        for left in (9.5, 3.5)
    ]
    assert not np.array_equal(*seconds)
    display.add_events([JACKPOT])
    jackpots = [display.wide_frame(PLAYING, 2.0, modes={"land on the moon": left}) for left in (9.5, 3.5)]
    assert np.array_equal(*jackpots)


@pytest.mark.parametrize("event", [JACKPOT, GameEvent(KIND.MESSAGE, 9, 0, "landed")])
def test_a_message_in_the_lowest_line_covers_no_part_of_an_announcement(event):
    def shown(message: str) -> np.ndarray:
        display = ScoreDisplay(words=WORDS)
        display.add_events([GameEvent(KIND.SCORED, 9, 50000, "spinner"), event])
        if message:
            display.show_message(message)
        display.wide_frame(PLAYING, 0.0)
        return display.wide_frame(PLAYING, 1.2)[SCORE_ROWS:]

    line = STATUS_Y - 1
    alone, covered = shown(""), shown("hold a")
    assert (alone[line - 6 : line] > 0).any()  # the points reach down to there
    assert not (covered[line - 1] > 0).any()
    assert (covered[3:14] > 0).any()
