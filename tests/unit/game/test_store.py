"""The store returns everything that was written, in the right order, and nothing else."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import pytest

from silverball.app.settings import Settings
from silverball.errors import SilverballError
from silverball.game.scores import store as stores
from silverball.game.scores.database import Database
from silverball.game.scores.store import FILE, PLACES, SCHEMA, Store

BOARD = {"mode": "arcade", "table_name": "random", "table_digest": "d" * 64}


def add(store: Store, score: int, initials: str = "AAA", **other: object) -> int:
    values = BOARD | {"seed": 7, "replay_text": f"replay of {score}\n"} | other
    return store.add_score(initials, score, **values)  # type: ignore[arg-type]


@pytest.fixture
def store(tmp_path: Path):
    with Store(tmp_path) as one:
        yield one
        assert one.warning == ""
        assert one.is_persistent


def test_a_score_is_complete_after_the_file_is_opened_again(tmp_path):
    when = datetime(2026, 2, 3, 4, 5, 6, tzinfo=UTC)
    with Store(tmp_path) as store:
        number = store.add_score("B.9", 4200, "arcade", "mine", "ab" * 32, 2**63 - 1, "the replay\n", when)
    with Store(tmp_path) as store:
        (score,) = store.scores("arcade")
        assert score == (
            number,
            "B.9",
            4200,
            "arcade",
            "mine",
            "ab" * 32,
            2**63 - 1,
            when,
            None,
            "",
            True,
            "",
            1,
            0,
        )
        assert store.score(number) == score
        assert store.replay(number) == "the replay\n"


def test_a_score_without_a_time_gets_the_present_one(store):
    before = int(datetime.now(UTC).timestamp())
    when = store.score(add(store, 1)).when.timestamp()
    assert before <= when <= datetime.now(UTC).timestamp()


def test_scores_are_ranked_and_of_equal_ones_the_earlier_comes_first(store):
    first, second, third, fourth = (add(store, score) for score in (20, 30, 20, 10))
    assert [score.id for score in store.scores()] == [second, first, third, fourth]
    assert [score.id for score in store.scores(limit=2)] == [second, first]


def test_modes_and_tables_have_lists_of_their_own(store):
    a = add(store, 10)
    b = add(store, 20, mode="free")
    c = add(store, 30, table_name="mine", table_digest="e" * 64)
    d = add(store, 40, table_name="mine", table_digest="f" * 64)

    def ids(**which: str) -> list[int]:
        return [score.id for score in store.scores(**which)]  # type: ignore[arg-type]

    assert ids(mode="arcade", table_digest="d" * 64) == [a]
    assert ids(mode="free") == [b]
    assert ids(table_digest="e" * 64) == [c]
    assert ids(table_name="mine") == [d, c]
    e = add(store, 20, table_name="mine", table_digest="e" * 64)
    store.remove(e)
    f, g = add(store, 30), add(store, 30, mode="free")
    assert ids(limit=4) == [d, c, f, g]  # type: ignore[arg-type]
    lists = [(one.mode, one.table_digest[0], one.length) for one in store.lists()]
    assert sorted(lists) == [("arcade", "d", 2), ("arcade", "e", 1), ("arcade", "f", 1), ("free", "d", 2)]


def test_all_boards_of_a_recipe_share_a_list_that_shows_their_seeds(store):
    for seed in (3, 1, 2):
        add(store, 10 * seed, seed=seed)
    assert [score.seed for score in store.scores("arcade", BOARD["table_digest"])] == [3, 2, 1]


def test_a_high_score_is_one_that_enters_the_shown_list(store):
    def place(score: int) -> int | None:
        return store.high_score_rank(score, "arcade", BOARD["table_digest"])

    assert place(1) == 1
    assert place(0) is None
    for score in range(10, 10 + PLACES):
        assert place(score) == 1
        add(store, score)
    assert place(10 + PLACES - 1) == 2  # the equal one came first
    assert place(11) == PLACES
    assert place(10) is None
    assert store.high_score_rank(1, "free", BOARD["table_digest"]) == 1


def test_the_predicted_rank_is_the_actual_rank(store):
    for score in (50, 20, 50, 70, 20, 60, 10):
        promised = store.high_score_rank(score, "arcade", BOARD["table_digest"])
        number = add(store, score)
        listed = [one.id for one in store.scores("arcade", BOARD["table_digest"])]
        assert listed.index(number) + 1 == promised


def test_a_score_saved_under_the_last_initials_is_renamed(store):
    number = add(store, 10, "OLD")
    other = add(store, 20, "OLD")
    store.rename(number, "NEW")
    assert store.score(number).initials == "NEW"
    assert store.score(other).initials == "OLD"


def test_marks_persist_and_can_be_undone(store):
    number, other = add(store, 10), add(store, 20)
    for mark in ((False, "its replay reaches 9"), (True, ""), (None, "")):
        store.save_verdicts({number: mark})
        assert (store.score(number).verified, store.score(number).why) == mark
        assert store.score(other).verified is None


def test_a_mark_for_a_removed_score_is_ignored(store):
    number, removed = add(store, 10), add(store, 20)
    store.remove(removed)
    store.save_verdicts({removed: (True, ""), number: (True, "")})
    assert [(score.id, score.verified) for score in store.scores()] == [(number, True)]


def test_a_rejected_score_ranks_below_all_others_and_blocks_none(store):
    points = [90, 80, 70, 60]
    ids = {score: add(store, score) for score in points}
    store.save_verdicts({ids[90]: (False, "why"), ids[70]: (True, ""), ids[80]: (False, "why")})
    assert [score.score for score in store.scores()] == [70, 60, 90, 80]
    for score in (95, 85, 65, 5):
        expected = sum(other >= score for other in (70, 60)) + 1
        assert store.high_score_rank(score, "arcade", BOARD["table_digest"]) == expected


def test_a_removed_score_is_gone_and_its_number_is_not_reused(store):
    kept, removed = add(store, 10), add(store, 20)
    store.remove(removed)
    assert [score.id for score in store.scores()] == [kept]
    assert add(store, 20) > removed


@pytest.mark.parametrize("what", ["score", "replay", "remove", "rename"])
@pytest.mark.parametrize("number", [5, 0, -1, 2**63 - 1, -(2**63), 2**63, -(2**63) - 1, 10**40])
def test_a_number_that_no_score_has_is_refused_in_one_sentence(store, what, number):
    arguments = {"rename": ("ABC",)}.get(what, ())
    with pytest.raises(SilverballError, match=f"there is no score {number};"):
        getattr(store, what)(number, *arguments)


def test_the_replay_of_every_score_is_kept_however_many_there_are(store):
    ids = {score: add(store, score) for score in (*range(1, 31), *range(60, 30, -1))}
    assert [score.score for score in store.scores("arcade", limit=-1)] == sorted(ids, reverse=True)
    for score, number in ids.items():
        assert store.replay(number) == f"replay of {score}\n"


def test_the_table_stays_with_its_list_until_a_score_replaces_it(store):
    add(store, 10)
    (one,) = store.lists()
    assert store.table_text(one.id) == ""
    for text, kept in (("first", "first"), ("", "first"), ("second", "second")):
        add(store, 10, table_text=text)
        assert store.table_text(one.id) == kept


def test_a_list_has_the_last_name_of_its_table(store):
    add(store, 10, table_name="before")
    add(store, 5, table_name="after")
    assert [one.table_name for one in store.lists()] == ["after"]


def test_the_last_game_is_kept_and_only_the_last(tmp_path):
    with Store(tmp_path) as store:
        assert store.last_game() is None
        store.save_last_game("first")
        store.save_last_game("second\n")
    with Store(tmp_path) as store:
        assert store.last_game() == "second\n"


def test_two_stores_see_what_the_other_has_written(tmp_path):
    with Store(tmp_path) as one, Store(tmp_path) as other:
        number = add(one, 10)
        other.rename(number, "TWO")
        assert one.scores()[0].initials == "TWO"


def test_writes_are_flushed_to_the_disk(store):
    """SQLite does so at every commit with these two: see "synchronous" on https://sqlite.org/pragma.html."""
    connection = store._database._connection
    assert connection.execute("PRAGMA synchronous").fetchone() == (2,)
    assert connection.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_the_data_folder_can_be_named_by_a_variable_of_the_environment(tmp_path, monkeypatch):
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path / "new" / "folder"))
    with Store() as store:
        add(store, 1)
    assert (tmp_path / "new" / "folder" / FILE).stat().st_size > 0


def test_text_that_looks_like_sql_is_text(store):
    nasty = "'); DROP TABLE score; --"
    number = add(store, 1, nasty, table_name=nasty, mode=nasty, table_digest=nasty, replay_text=nasty)
    assert store.replay(number) == nasty
    assert [score.initials for score in store.scores(nasty, nasty, nasty)] == [nasty]


def test_a_table_whose_path_is_not_valid_text_has_scores(store):
    add(store, 1, table_name="caf\udce9.toml")
    assert store.scores()[0].table_name == "caf?.toml"


def test_settings_round_trip(tmp_path):
    settings = Settings(
        theme="dusk", volume=3, muted=True, initials="ZZ.", keys={"left": ("a", "left shift")}
    )
    with Store(tmp_path) as store:
        assert Settings.of(store.settings()) == Settings()
        store.save_settings(settings.model_dump())
    with Store(tmp_path) as store:
        assert Settings.of(store.settings()) == settings


def test_other_settings_stay_as_they_are(store):
    store.save_settings({"volume": 3, "of_a_newer_program": {"a": [1, None]}})
    store.save_settings({"volume": 4})
    assert store.settings() == {"volume": 4, "of_a_newer_program": {"a": [1, None]}}


def test_settings_are_saved_all_or_none(store):
    store.save_settings({"volume": 3, "muted": True})
    with pytest.raises(TypeError):
        store.save_settings({"volume": 4, "muted": object()})
    with pytest.raises(sqlite3.Error):
        store.save_settings({"volume": 4, object(): 1})  # type: ignore[dict-item]
    assert store.settings() == {"volume": 3, "muted": True}


@pytest.mark.parametrize(
    "value", ["{", "", "nine", "[" * 100_000, "\x00", b"\xff\xfe", '"loud"', "99", "null"]
)
def test_a_damaged_setting_falls_back_to_its_default_and_the_others_stay(tmp_path, value):
    with Store(tmp_path) as store:
        store.save_settings(Settings(volume=3, muted=True).model_dump())
    with closing(sqlite3.connect(tmp_path / FILE)) as connection, connection:
        connection.execute("UPDATE setting SET value = ? WHERE name = 'volume'", (value,))
    with Store(tmp_path) as store:
        assert Settings.of(store.settings()) == Settings(muted=True)
        assert store.warning == ""


NEXT = SCHEMA._replace(
    migrations=(*SCHEMA.migrations, ("ALTER TABLE score ADD COLUMN balls INTEGER NOT NULL DEFAULT 3",)),
    tables=SCHEMA.tables | {"score": (*SCHEMA.tables["score"], "balls")},
)


def test_a_file_of_an_older_version_is_migrated_with_its_records(tmp_path, monkeypatch):
    with Store(tmp_path) as store:
        number = add(store, 42)
    monkeypatch.setattr(stores, "SCHEMA", NEXT)
    for _ in range(2):
        with Store(tmp_path) as store:
            assert (store.warning, store.is_persistent) == ("", True)
            assert store.score(number).score == 42
            assert store._database.read("SELECT balls FROM score") == [(3,)]


def test_scores_of_a_file_of_version_1_are_all_there_and_without_a_table(tmp_path, monkeypatch):
    with closing(sqlite3.connect(tmp_path / FILE)) as old, old:
        for statement in SCHEMA.migrations[0]:
            old.execute(statement)
        old.execute(f"PRAGMA application_id = {SCHEMA.application}")
        old.execute("PRAGMA user_version = 1")
        old.execute("INSERT INTO list VALUES (3, 'arcade', 'digest', 'Mine')")
        for score, replay in ((20, "the replay"), (10, None)):
            old.execute(
                "INSERT INTO score (list, initials, score, seed, played, replay)"
                " VALUES (3, 'ABC', ?, 7, 0, ?)",
                (score, replay),
            )
    for _ in range(2):
        with Store(tmp_path) as store:
            assert (store.warning, store.is_persistent) == ("", True)
            assert [(one.score, one.has_replay) for one in store.scores()] == [(20, True), (10, False)]
            assert store.table_text(3) == ""
            with pytest.raises(SilverballError, match="its replay was not kept"):
                store.replay(store.scores()[1].id)


def test_a_file_keeps_its_version_if_its_migration_fails(tmp_path):
    with Store(tmp_path) as store:
        add(store, 42)
    broken = NEXT._replace(migrations=(*NEXT.migrations, ("SELECT * FROM nowhere",)))
    with pytest.raises(sqlite3.OperationalError, match="nowhere"):
        Database(tmp_path / FILE, broken)
    with Store(tmp_path) as store:
        assert store.warning == ""
        assert [score.score for score in store.scores()] == [42]
