"""While another program holds the score file, everything is spooled, shown, and saved in the end."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest

from holder import ALONE, WRITES, held
from silverball.errors import SilverballError
from silverball.game.scores import database
from silverball.game.scores.pending import NAME
from silverball.game.scores.store import FILE, Store

REPLAY = "a line of a replay\n" * 100
LIST = ("arcade", "random", "d" * 64)


def add(store: Store, score: int) -> int:
    return store.add_score("AAA", score, *LIST, 7, f"{score}\n{REPLAY}", table_text="the table")


def in_the_file(folder: Path) -> list[tuple[int, str]]:
    """What another program reads in the file: scores and initials, best first."""
    with closing(sqlite3.connect(folder / FILE)) as connection:
        return connection.execute("SELECT score, initials FROM score ORDER BY score DESC, id").fetchall()


def waiting_files(folder: Path) -> list[Path]:
    return list(folder.glob(f"{NAME}*"))


def listed(store: Store) -> list[tuple[int, str]]:
    return [(one.score, one.initials) for one in store.scores(limit=-1)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder in which there are two scores, a last game and settings."""
    with Store(tmp_path) as store:
        add(store, 20)
        add(store, 10)
        store.save_last_game("before")
        store.save_settings({"volume": 9, "muted": True})
    return tmp_path


def play_on(store: Store) -> int:
    """All that a game asks of a store works and shows; the number of the new score."""
    number = add(store, 15)
    assert store.high_score_rank(16, *LIST[::2]) == 2
    store.rename(number, "NEW")
    store.save_last_game("now")
    store.save_settings({"volume": 2})
    assert listed(store) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
    assert store.score(number).initials == "NEW"
    assert store.replay(number) == f"15\n{REPLAY}"
    assert (store.last_game(), store.settings()) == ("now", {"volume": 2, "muted": True})
    return number


def assert_all_is_saved(folder: Path) -> None:
    assert in_the_file(folder) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
    assert waiting_files(folder) == []
    with Store(folder) as store:
        assert (store.warning, store.is_persistent, store.has_pending) == ("", True, False)
        assert (store.last_game(), store.settings()) == ("now", {"volume": 2, "muted": True})
        assert [store.table_text(one.id) for one in store.lists()] == ["the table"]
        assert store.replay(store.scores()[1].id) == f"15\n{REPLAY}"


def test_a_nonblocking_store_does_not_wait_for_locks(folder):
    with Store(folder, nonblocking=True) as store:
        assert store._database._connection.execute("PRAGMA busy_timeout").fetchone() == (0,)


def test_data_is_spooled_while_the_file_is_held_and_saved_when_it_is_free(folder):
    with Store(folder, nonblocking=True) as store:
        with held(folder / FILE):
            number = play_on(store)
            assert store.has_pending
            assert store.is_spooled
            assert store.is_persistent
            (file,) = waiting_files(folder)
            assert "15" in file.read_text()
            assert not store.retry_pending()
            assert in_the_file(folder) == [(20, "AAA"), (10, "AAA")]
        assert store.retry_pending()
        assert not store.has_pending
        assert store.score(number).score == 15  # the number that was given out stays good
        assert store.replay(number) == f"15\n{REPLAY}"
        store.rename(number, "NEW")
        assert store.warning == ""
    assert_all_is_saved(folder)


@pytest.mark.parametrize("how", [WRITES, ALONE])
def test_a_file_that_is_held_at_the_start_is_used_when_it_is_free(folder, how, monkeypatch):
    monkeypatch.setattr(database, "BEGIN_SECONDS", 0.05)
    with held(folder / FILE, how):
        store = Store(folder, nonblocking=True)
        assert "another program holds it" in store.warning
        assert store.is_unreadable == (how == ALONE)
        if how == WRITES:
            play_on(store)
        else:
            store.rename(add(store, 15), "NEW")
            store.save_last_game("now")
            store.save_settings({"volume": 2})
            assert listed(store) == [(15, "NEW")]
        assert store.is_spooled
    assert store.retry_pending()
    assert store.warning == ""
    assert listed(store) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
    store.close()
    assert_all_is_saved(folder)


def test_data_pending_at_the_end_is_there_at_the_next_start(folder):
    with held(folder / FILE):
        with Store(folder, nonblocking=True) as store:
            play_on(store)
        (file,) = waiting_files(folder)
        assert file.name in store.exit_warning
    Store(folder, nonblocking=True).close()
    assert_all_is_saved(folder)


def test_pending_data_survives_a_kill(folder):
    code = (
        "import os, signal, sys; from pathlib import Path; from test_store_locked import play_on, Store\n"
        "store = Store(Path(sys.argv[1]), nonblocking=True); play_on(store)\n"
        "os.kill(os.getpid(), signal.SIGKILL)"
    )
    paths = os.environ | {"PYTHONPATH": os.pathsep.join([*sys.path, str(Path(__file__).parent)])}
    with held(folder / FILE):
        done = subprocess.run([sys.executable, "-c", code, str(folder)], env=paths, check=False)
        assert done.returncode == -signal.SIGKILL
    assert in_the_file(folder) == [(20, "AAA"), (10, "AAA")]
    with Store(folder) as store:
        assert listed(store) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
    assert_all_is_saved(folder)


def test_a_program_killed_between_import_and_cleanup_imports_nothing_twice(folder):
    with Store(folder, nonblocking=True) as store:
        with held(folder / FILE):
            play_on(store)
            (file,) = waiting_files(folder)
            content = file.read_text()
        store.retry_pending()
    for initials in ("NEW", "XYZ"):
        file.write_text(content.replace('"NEW"', f'"{initials}"'))
        with Store(folder) as store:
            assert listed(store) == [(20, "AAA"), (15, initials), (10, "AAA")]
        assert waiting_files(folder) == []


def test_another_program_may_import_the_spool_of_this_one(folder):
    with Store(folder, nonblocking=True) as store:
        with held(folder / FILE):
            number = play_on(store)
        with Store(folder) as other:
            assert listed(other) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
        store.rename(number, "TWO")
        assert in_the_file(folder) == [(20, "AAA"), (15, "TWO"), (10, "AAA")]
        store.rename(number, "NEW")
    assert_all_is_saved(folder)


def test_data_added_after_another_program_has_imported_the_spool_is_not_lost(folder):
    with held(folder / FILE):
        store = Store(folder, nonblocking=True)
        play_on(store)
    Store(folder).close()
    with held(folder / FILE):
        add(store, 5)
        store.close()
    Store(folder).close()
    assert in_the_file(folder) == [(20, "AAA"), (15, "NEW"), (10, "AAA"), (5, "AAA")]


def test_initials_of_a_saved_score_are_spooled_too(folder):
    with Store(folder, nonblocking=True) as store:
        number = add(store, 15)
        with held(folder / FILE):
            store.rename(number, "NEW")
            assert listed(store) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
            assert store.score(number).initials == "NEW"
            assert in_the_file(folder)[1] == (15, "AAA")
            kept = store._spool.path.read_text()
        assert store.retry_pending()
        assert in_the_file(folder)[1] == (15, "NEW")
        store.rename(number, "ZZZ")
    (folder / f"{NAME}1.json").write_text(kept)  # as after a kill
    with Store(folder) as store:
        assert store.score(number).initials == "NEW"


def test_cached_lists_are_shown_while_the_file_cannot_be_read(folder):
    with Store(folder, nonblocking=True) as store:
        store._database._connection.execute("PRAGMA journal_mode = DELETE").fetchall()  # readers are kept out
        before = store.scores(*LIST[::2])
        id = before[0].id
        with held(folder / FILE):
            assert store.scores(*LIST[::2]) == before
            with pytest.raises(SilverballError, match="another program holds it"):
                store.replay(id)
            assert store.has_pending
            assert store.high_score_rank(15, *LIST[::2]) == 2
            play = add(store, 15)
            assert [one.id for one in store.scores(*LIST[::2])] == [before[0].id, play, before[1].id]
        assert store.retry_pending()
        assert store.replay(id) == f"20\n{REPLAY}"
    assert [score for score, _ in in_the_file(folder)] == [20, 15, 10]


@pytest.fixture
def full(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether the disk is full; a test may change it."""
    is_full = [True]
    whole = "silverball.game.scores.pending.write_whole"
    from silverball.wholefile import write_whole

    def write(path, work):
        if is_full[0]:
            raise OSError(28, "No space left on device")
        write_whole(path, work)

    monkeypatch.setattr(whole, write)
    return is_full


def test_data_only_in_memory_is_not_called_persistent_and_is_saved_when_the_file_is_free(folder, full):
    with Store(folder, nonblocking=True) as store:
        with held(folder / FILE):
            play_on(store)
            assert not store.is_spooled
            assert not store.is_persistent
            assert not store.retry_pending()
        assert store.retry_pending()
        assert store.is_spooled
        assert store.is_persistent
    assert_all_is_saved(folder)


def test_data_only_in_memory_is_spooled_as_soon_as_the_disk_has_space(folder, full):
    with held(folder / FILE):
        store = Store(folder, nonblocking=True)
        play_on(store)
        full[0] = False
        assert not store.retry_pending()
        assert store.is_spooled
        store.close()
    Store(folder).close()
    assert_all_is_saved(folder)


def test_at_the_end_data_only_in_memory_is_retried_for_some_time(folder, full, monkeypatch):
    with held(folder / FILE) as program:
        store = Store(folder, nonblocking=True)
        play_on(store)
        monkeypatch.setattr(time, "sleep", lambda seconds: program.communicate())  # it ends meanwhile
        store.close()
        assert store.exit_warning == ""
    monkeypatch.undo()
    assert_all_is_saved(folder)


def test_lost_data_is_reported(folder, full, monkeypatch):
    monkeypatch.setattr(database, "BUSY_SECONDS", 0.1)
    with held(folder / FILE):
        store = Store(folder, nonblocking=True)
        play_on(store)
        store.close()
        assert "is lost" in store.exit_warning


def test_a_full_disk_leaves_pending_data_in_the_spool(folder, monkeypatch):
    with Store(folder, nonblocking=True) as store:
        with held(folder / FILE):
            play_on(store)
        connection = store._database._connection
        connection.execute(f"PRAGMA max_page_count = {connection.execute('PRAGMA page_count').fetchone()[0]}")
        store._spool.pending.scores[0].replay += "x" * 100_000
        store._spool.write()
        assert store.retry_pending()
        assert not store.is_persistent
        assert "the disk is full" in store.warning
        assert listed(store) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
        assert len(waiting_files(folder)) == 1
    Store(folder).close()
    assert in_the_file(folder) == [(20, "AAA"), (15, "NEW"), (10, "AAA")]
    assert waiting_files(folder) == []


def waiting_content(folder: Path) -> dict:
    with held(folder / FILE), Store(folder, nonblocking=True) as store:
        play_on(store)
    (file,) = waiting_files(folder)
    content = json.loads(file.read_text())
    file.unlink()
    return content


CHANGES = {
    "empty": lambda content: "",
    "cut off": lambda content: json.dumps(content)[:-20],
    "no object": lambda content: "[]",
    "deep": lambda content: "[" * 100_000,
    "no text": lambda content: b"\xff\xfe\x00",
    "a later format": lambda content: json.dumps(content | {"format": 2}),
    "something more": lambda content: json.dumps(content | {"more": 1}),
    "initials are a number": lambda content: json.dumps(content | {"initials": {"1": 5}}),
    "the last game is a list": lambda content: json.dumps(content | {"last_game": []}),
}
for key, value in (
    ("score", 2**63),
    ("score", "7"),
    ("score", 1.5),
    ("seed", None),
    ("played", -1),
    ("played", 10**15),
):
    CHANGES[f"{key} is {value!r}"] = lambda content, key=key, value=value: json.dumps(
        content | {"scores": [content["scores"][0] | {key: value}]}
    )


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_an_unreadable_spool_is_quarantined_with_a_sentence(folder, change):
    text = change(waiting_content(folder))
    text = text if isinstance(text, bytes) else text.encode()
    (folder / f"{NAME}1.json").write_bytes(text)
    with Store(folder) as store:
        assert len(store.warning.splitlines()) == 1
        (aside,) = folder.glob("silverball-set-aside-*.json")
        assert aside.name in store.warning
        assert aside.read_bytes() == text
        assert store.is_persistent
    with Store(folder) as store:
        assert store.warning == ""
    assert in_the_file(folder) == [(20, "AAA"), (10, "AAA")]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
def test_a_spool_that_is_not_a_file_is_left_alone(folder):
    os.mkfifo(folder / f"{NAME}1.json")
    (folder / f"{NAME}2.json").mkdir()
    (folder / f"{NAME}3.json").symlink_to("/dev/zero")
    with Store(folder) as store:
        assert (store.warning, store.is_persistent) == ("", True)


def test_a_blocking_store_that_waited_in_vain_says_so_in_a_sentence(folder, monkeypatch):
    monkeypatch.setattr(database, "BUSY_SECONDS", 0.1)
    with held(folder / FILE, ALONE), Store(folder) as store:
        for ask in (store.scores, store.lists, lambda: store.score(1), lambda: store.replay(1)):
            with pytest.raises(SilverballError, match="another program holds it; try again") as error:
                ask()
            assert len(str(error.value).splitlines()) == 1
    with Store(folder) as store, held(folder / FILE):
        for change in (lambda: store.remove(1), lambda: store.save_verdicts({1: (True, "")})):
            with pytest.raises(SilverballError, match="another program holds it; try again"):
                change()
        add(store, 15)  # what cannot be done again is not lost
    Store(folder).close()
    assert [score for score, _ in in_the_file(folder)] == [20, 15, 10]
