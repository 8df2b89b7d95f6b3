"""Scores and settings while another program locks the file of the scores."""

from __future__ import annotations

import sqlite3
from contextlib import closing

import pytest

from evenings import LEAKY, Evening
from holder import ALONE, WRITES, held
from silverball.app.controls import Action
from silverball.app.game_archive import NOT_YET_SAVED, PENDING, REMIND_SECONDS, RETRY_SECONDS, SAVED
from silverball.app.player_games import GAME_OVER_SECONDS
from silverball.app.settings import Settings
from silverball.game.scores import database
from silverball.game.scores.store import FILE, Store
from silverball.game.scores.verify_score import verify_score
from silverball.game.view import Mode


def in_the_file(folder) -> list[tuple[int, str]]:
    with closing(sqlite3.connect(folder / FILE)) as connection:
        return connection.execute("SELECT score, initials FROM score").fetchall()


@pytest.fixture
def evening(tmp_path):
    made = Evening(tmp_path)
    made.program.finish_loading()
    yield made
    made.store.close()


def play(evening) -> int:
    """A game of arcade to its end; its score."""
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    assert evening.program.session.game.score > 0
    return evening.program.session.game.score


@pytest.mark.parametrize(("seconds", "page"), [(1, ""), (6, "initials"), (60, "attract")])
def test_a_score_waits_and_is_saved_when_the_file_is_free(evening, tmp_path, seconds, page):
    with held(tmp_path / FILE):
        score = play(evening)
        assert PENDING in evening.said
        assert [row.score for row in evening.program._catalog.scores("Leaky", Mode.ARCADE)] == [score]
        evening.go(seconds)
        assert evening.program.menus.page == page
        assert in_the_file(tmp_path) == []
        assert SAVED not in evening.said
    evening.go(RETRY_SECONDS + 0.1)
    assert evening.said[-1] == SAVED
    assert [points for points, _ in in_the_file(tmp_path)] == [score]
    (row,) = evening.store.scores()
    (one,) = evening.store.lists()
    assert verify_score(row, evening.store.replay(row.id), evening.store.table_text(one.id)) == (True, "")


def test_initials_that_are_given_while_the_file_is_held_are_saved_too(evening, tmp_path):
    with held(tmp_path / FILE):
        score = play(evening)
        evening.go(GAME_OVER_SECONDS + 0.1)
        evening.tap(Action.RIGHT, *[Action.CREATE] * 4)
        evening.go(1.0)
        assert evening.program.menus.page == "over"
    evening.go(RETRY_SECONDS + 0.1)
    assert in_the_file(tmp_path) == [(score, "BAA")]


def test_a_score_that_can_be_written_nowhere_is_called_not_yet_saved(evening, tmp_path, monkeypatch):
    def refuse(path, write):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr("silverball.game.scores.pending.write_whole", refuse)
    with held(tmp_path / FILE):
        score = play(evening)
        assert NOT_YET_SAVED in evening.said
        assert not any(words in evening.said for words in (PENDING, SAVED))
        evening.go(3 * REMIND_SECONDS + 1.0)
        assert evening.said.count(NOT_YET_SAVED) >= 3  # as long as it is so
    evening.go(RETRY_SECONDS + 0.1)
    assert evening.said[-1] == SAVED
    assert [points for points, _ in in_the_file(tmp_path)] == [score]


def test_settings_that_could_not_be_read_at_the_start_are_used_when_they_can_and_never_overwritten(
    tmp_path, monkeypatch
):
    kept = Settings(table="Leaky", volume=2, initials="ZZZ", theme="dusk")
    with Store(tmp_path) as store:
        store.save_settings(kept.model_dump(mode="json"))
    monkeypatch.setattr(database, "BEGIN_SECONDS", 0.05)
    with held(tmp_path / FILE, ALONE):
        evening = Evening(tmp_path)
        evening.program.finish_loading()
        evening.program.settings.change(volume=5)
        evening.go(2.0)
        assert evening.program.settings.current.theme == Settings().theme
    evening.go(RETRY_SECONDS + 0.1)
    assert evening.program.settings.current == kept.changed(volume=5)
    evening.store.close()
    with Store(tmp_path) as store:
        assert Settings.of(store.settings()) == kept.changed(volume=5)


@pytest.mark.parametrize("how", [WRITES, ALONE])
def test_a_game_that_ends_while_the_file_has_been_held_since_the_start_is_saved(tmp_path, monkeypatch, how):
    Store(tmp_path).close()
    monkeypatch.setattr(database, "BEGIN_SECONDS", 0.05)
    with held(tmp_path / FILE, how):
        evening = Evening(tmp_path, table=LEAKY)
        evening.program.finish_loading()
        score = play(evening)
        evening.go(GAME_OVER_SECONDS + 0.1)
    evening.go(RETRY_SECONDS + 0.1)
    assert [points for points, _ in in_the_file(tmp_path)] == [score]
    assert evening.store.last_game() is not None
    evening.store.close()
