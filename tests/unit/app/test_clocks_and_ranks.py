"""What display and backglass tell of missions: the time that is left, and the rank that is kept."""

from __future__ import annotations

from itertools import pairwise

import pytest

from evenings import Evening
from reading import reads
from silverball.app.announcements import Rank, TableWords
from silverball.app.backglass.content import ContentReader
from silverball.app.score_display import HURRY, ScoreDisplay
from silverball.app.settings import Settings
from silverball.drawing.dotmatrix.canvas import FULL, Dots
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode
from silverball.table import load_table
from unit.app.test_score_display import FACE

VIEW = FACE._replace(score=123_400)
WORDS = TableWords(
    {"SPINNER": Rank.NOTICE, "METEORS WON": Rank.MISSION}, {}, frozenset({"meteors"}), frozenset()
)


def shown(*, seconds: float = 1.0, left: float | None = 22.4, view: GameView = VIEW, event: str = "") -> Dots:
    display = ScoreDisplay(words=WORDS)
    display.frame(view, seconds - 1.0)
    if event:
        display.add_events([GameEvent(GameEventKind.MESSAGE, 1, 0, part=event)])
    for at in (seconds - 1.0, seconds):
        dots = display.frame(view, at, modes={"meteors": left, "always": None})
    return dots


@pytest.mark.parametrize("multiplier", [1, 2])
@pytest.mark.parametrize("event", ["", "SPINNER"])
def test_the_clock_of_a_mission_is_there_while_a_ball_is_in_play(multiplier, event):
    dots = shown(view=VIEW._replace(multiplier=multiplier), event=event)
    assert reads(dots, "23")
    assert reads(dots, "123,400")
    assert reads(dots, "BALL 1/3")
    assert reads(dots, event or "METEORS")


def test_without_a_mission_and_in_modes_without_a_time_there_is_no_clock():
    assert not reads(shown(left=None), "METEORS")
    assert (shown(left=None).pixels == shown(left=None, seconds=5.0).pixels).all()


def test_a_message_leaves_the_clock_in_its_place():
    for message in ("HOLD A OR D … LET GO", "A MESSAGE THAT IS LONGER THAN THE WHOLE DISPLAY"):
        display = ScoreDisplay(words=WORDS)
        display.show_message(message)
        for at in (0.0, 2.0):
            dots = display.frame(VIEW, at, modes={"meteors": 22.4})
            assert reads(Dots(dots.pixels[23:, 145:].copy()), "23")
    assert reads(shown(), "23")


def test_what_is_worth_more_than_a_mission_still_fills_the_display():
    assert reads(shown(event="METEORS WON"), "METEORS WON")


def test_the_clock_counts_down_and_blinks_at_its_end():
    for left in (39.9, 12.0, 0.2):
        assert reads(shown(left=left), str(int(left) + 1))
    for left, levels in ((HURRY + 1.0, 1), (HURRY - 1.0, 2)):
        ends = {int(shown(left=left, seconds=10.0 + step / 10).pixels[24:, 145:].max()) for step in range(5)}
        assert len(ends) == levels
        assert max(ends) == FULL


def test_text_and_clock_never_overlap():
    long = TableWords({}, {}, frozenset({"a mission with a very long name"}), frozenset())
    display = ScoreDisplay(words=long)
    dots = display.frame(VIEW, 1.0, modes={"a mission with a very long name": 30.0})
    assert reads(dots, "31")
    assert reads(dots, "BALL 1/3")
    columns = dots.pixels[24:].any(axis=0)
    gaps = [after - before for before, after in pairwise(columns.nonzero()[0])]
    assert max(gaps) >= 4  # between the ball and the name, and between the name and the clock


def test_the_program_passes_the_modes_of_the_game_on(tmp_path):
    table = load_table("silver_comet")
    evening = Evening(tmp_path, Settings(arcade_table="silver_comet"), table)
    evening.program.finish_loading()
    evening.program.play(Mode.ARCADE, "silver_comet", 3)
    evening.go(0.2)
    seen = []
    evening.program.display.frame = lambda *given: seen.append(given) or Dots()
    evening.program.dots(evening.seconds)
    assert seen[0][3] == evening.program.session.game.modes


def test_the_backglass_tells_the_kept_rank_and_that_of_the_game(tmp_path, monkeypatch):
    table = load_table("silver_comet")
    evening = Evening(tmp_path, Settings(arcade_table="silver_comet"), table)
    key = evening.program._catalog.score_key(table)
    for rank in (2, 1):
        evening.store.add_score("AAA", 10, "arcade", key.title, key.digest, 1, "", rank=rank)
    evening.program.finish_loading()
    evening.program.play(Mode.ARCADE, "silver_comet", 3)
    game = evening.program.session.game
    assert rank_cell(evening) == "3"
    monkeypatch.setattr(type(game), "counters", {"rank": 2})
    assert rank_cell(evening) == "3 + 2"


def rank_cell(evening: Evening) -> str:
    cells = ContentReader(evening.program)._cells()
    return next(cell.value for cell in cells if cell.label == "RANK")
