"""Whatever is wrong with the score file, play goes on and the player gets a warning of one sentence."""

from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from holder import ALONE, held
from silverball.errors import SilverballError
from silverball.game.scores import sqlite_file
from silverball.game.scores.store import FILE, SCHEMA, Store

REPLAY = "a line of a replay\n" * 100
NOBODY = 65534


def add(store: Store, score: int, replay: str = REPLAY) -> int:
    return store.add_score("AAA", score, "arcade", "random", "d" * 64, 7, replay)


def listed(store: Store) -> list[int]:
    return [score.score for score in store.scores(limit=-1)]


def assert_play_goes_on(store: Store) -> None:
    """All that a game asks of a store works, whether it lasts or not."""
    number = add(store, 123_456)
    assert store.high_score_rank(123_457, "arcade", "d" * 64) == 1
    store.rename(number, "NEW")
    store.save_verdicts({number: (True, "")})
    store.save_last_game("last")
    store.save_settings({"volume": 2})
    assert store.scores()[0][:3] == (number, "NEW", 123_456)
    assert store.replay(number) == REPLAY
    assert store.last_game() == "last"
    assert store.settings()["volume"] == 2


def assert_warned(store: Store, *words: str, is_persistent: bool) -> None:
    """One sentence with the place, what is wrong and, if nothing is kept, what to do."""
    assert len(store.warning.splitlines()) == 1
    remedy = () if is_persistent else ("nothing of this run is kept", "SILVERBALL_DATA")
    for word in (str(store.path), *words, *remedy):
        assert word in store.warning
    assert store.is_persistent == is_persistent


@pytest.fixture
def folder() -> Iterator[Path]:
    """A folder that other users may read."""
    path = Path(tempfile.mkdtemp())
    path.chmod(0o755)
    yield path
    shutil.rmtree(path)


@contextmanager
def without_the_rights_of_root() -> Iterator[None]:
    """Drop the rights of root, which may write read-only files, for a while."""
    if os.name != "posix":
        pytest.skip("needs the rights of POSIX")
    root = os.geteuid() == 0
    if root:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


def with_scores(folder: Path, *scores: int) -> Path:
    with Store(folder) as store:
        for score in scores:
            add(store, score)
        store.save_settings({"volume": 9, "muted": True})
    return folder / FILE


def test_a_read_only_folder(folder):
    folder.chmod(0o555)
    with without_the_rights_of_root(), Store(folder) as store:
        assert_warned(store, "it cannot be opened or created", is_persistent=False)
        assert_play_goes_on(store)
    assert list(folder.iterdir()) == []


def test_a_folder_that_cannot_be_created(folder):
    folder.chmod(0o555)
    with without_the_rights_of_root(), Store(folder / "new") as store:
        assert_warned(store, "permission denied", str(folder / "new"), is_persistent=False)
        assert_play_goes_on(store)


@pytest.mark.parametrize("below", ["", "data"])
def test_a_folder_that_is_a_file(tmp_path, below):
    (tmp_path / "file").write_text("something")
    with Store(tmp_path / "file" / below) as store:
        assert_warned(store, "file exists" if not below else "not a directory", is_persistent=False)
        assert_play_goes_on(store)
    assert (tmp_path / "file").read_text() == "something"


@pytest.mark.parametrize(
    ("name", "word"), [(FILE, "it cannot be opened or created"), (f"{FILE}-wal", "reading or writing fails")]
)
def test_a_folder_where_a_file_should_be(tmp_path, name, word):
    (tmp_path / name).mkdir()
    with Store(tmp_path) as store:
        assert_warned(store, word, is_persistent=False)
        assert_play_goes_on(store)


@pytest.mark.parametrize("folder_too", [False, True])
def test_a_read_only_file_is_still_read(folder, folder_too):
    path = with_scores(folder, 10, 20)
    before = path.read_bytes()
    path.chmod(0o444)
    folder.chmod(0o555 if folder_too else 0o777)
    with without_the_rights_of_root(), Store(folder) as store:
        assert_warned(store, "writing is not allowed", is_persistent=False)
        assert listed(store) == [20, 10]
        assert store.settings() == {"volume": 9, "muted": True}
        assert_play_goes_on(store)
    assert path.read_bytes() == before


def test_a_file_without_read_permission(folder):
    with_scores(folder, 10).chmod(0)
    with without_the_rights_of_root(), Store(folder) as store:
        assert_warned(store, "it cannot be opened or created", is_persistent=False)
        assert_play_goes_on(store)
    (folder / FILE).chmod(0o644)
    with Store(folder) as store:
        assert listed(store) == [10]


def fill(store: Store, most: int = 3000) -> list[int]:
    """Keep scores with replays until that fails; those that were kept."""
    kept = []
    for score in range(1, most):
        add(store, score, REPLAY + "x" * score)
        if not store.is_persistent:
            return kept
        kept.append(score)
    raise AssertionError("the disk never was full")


def assert_all_goes_on_on_a_full_disk(folder: Path, word: str) -> list[int]:
    """Fill it up, play on, and see that all that was kept is there; what was kept."""
    with Store(folder) as store:
        store.save_settings({"volume": 9})
        kept = fill(store)
        assert_warned(store, word, is_persistent=False)
        assert listed(store) == [len(kept) + 1, *reversed(kept)]  # the last one as long as the program runs
        assert store.settings() == {"volume": 9}
        assert_play_goes_on(store)
    return kept


def test_a_file_size_limit_is_reached_during_a_write(tmp_path):
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, hard))
    try:
        kept = assert_all_goes_on_on_a_full_disk(tmp_path, "reading or writing fails")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    with Store(tmp_path) as store:
        assert store.warning == ""
        assert listed(store) == kept[::-1]


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 512 KiB."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=512k", "none", str(place)]
    if not shutil.which("mount") or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("only root can mount a small disk")
    yield place
    subprocess.run(["umount", str(place)], check=True)


def test_the_disk_becomes_full_during_a_write(small_disk):
    kept = assert_all_goes_on_on_a_full_disk(small_disk, "the disk is full")
    with Store(small_disk) as store:  # reads without a byte to spare
        assert set(kept) <= set(listed(store))


def test_the_disk_is_full_from_the_beginning(small_disk):
    with pytest.raises(OSError, match="No space"):
        (small_disk / "other").write_bytes(b"x" * 2**20)
    with Store(small_disk) as store:
        assert len(store.warning.splitlines()) == 1
        assert not store.is_persistent
        assert_play_goes_on(store)


def quarantined(folder: Path) -> Path:
    (path,) = folder.glob("silverball-set-aside-*.sqlite3")
    return path


def overwrite_the_middle(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[4096:-4096] = os.urandom(len(content) - 8192)
    path.write_bytes(content)


def lose_a_table(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("DROP TABLE setting")


def belong_to_another_program(path: Path) -> None:
    path.unlink()
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("CREATE TABLE score (id INTEGER PRIMARY KEY)")


def forget_its_version(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("PRAGMA user_version = 0")


DAMAGES: dict[str, Callable[[Path], object]] = {
    "not a database at all": lambda path: path.write_bytes(b"hello " * 1000),
    "the first half": lambda path: os.truncate(path, path.stat().st_size // 2),
    "the middle overwritten": overwrite_the_middle,
    "the head overwritten": lambda path: path.write_bytes(os.urandom(100) + path.read_bytes()[100:]),
    "a table is missing": lose_a_table,
    "without a version": forget_its_version,
    "of another program": belong_to_another_program,
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_an_unfit_file_is_quarantined_and_a_new_one_begun(tmp_path, damage):
    path = with_scores(tmp_path, *range(1, 40))
    damage(path)
    content = path.read_bytes()
    with Store(tmp_path) as store:
        assert quarantined(tmp_path).read_bytes() == content
        word = "another program" if damage is belong_to_another_program else "is damaged"
        assert_warned(store, word, quarantined(tmp_path).name, is_persistent=True)
        assert listed(store) == []
        assert_play_goes_on(store)
    with Store(tmp_path) as store:
        assert store.warning == ""
        assert listed(store) == [123_456]


def test_damaged_characters_hide_nothing_else(tmp_path):
    path = with_scores(tmp_path, 10, 20)
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE score SET initials = CAST(x'41ff42' AS TEXT) WHERE score = 20")
    with Store(tmp_path) as store:
        assert [score.initials for score in store.scores()] == ["A\ufffdB", "AAA"]
        assert store.warning == ""


def test_an_empty_file_is_a_new_one(tmp_path):
    (tmp_path / FILE).touch()
    with Store(tmp_path) as store:
        assert (store.warning, store.is_persistent) == ("", True)
        assert_play_goes_on(store)


def test_a_file_that_becomes_damaged_while_the_program_runs(tmp_path):
    path = with_scores(tmp_path, *range(1, 40))
    with Store(tmp_path) as store:
        store._database._connection.execute("PRAGMA cache_size = 0")  # it would not notice before it reads
        overwrite_the_middle(path)
        assert_play_goes_on(store)
        assert_warned(store, "is damaged", quarantined(tmp_path).name, is_persistent=True)
    with Store(tmp_path) as store:
        assert listed(store) == [123_456]


def test_a_program_with_an_open_file_switches_to_the_new_one_when_another_quarantines_it(tmp_path):
    path = with_scores(tmp_path, *range(1, 40))
    with Store(tmp_path) as first:
        add(first, 50)
        overwrite_the_middle(path)
        with Store(tmp_path) as second:
            assert_warned(second, "is damaged", is_persistent=True)
            aside = quarantined(tmp_path)
            assert aside.with_name(f"{aside.name}-wal").stat().st_size > 0  # with what was written last
            assert_play_goes_on(first)
            assert_warned(first, "was removed or replaced", is_persistent=True)
            assert listed(second) == [123_456]


def test_a_file_that_is_removed_while_the_program_runs(tmp_path):
    with_scores(tmp_path, 10)
    with Store(tmp_path) as store:
        shutil.rmtree(tmp_path)
        assert_play_goes_on(store)
        assert_warned(store, "was removed", is_persistent=True)
    with Store(tmp_path) as store:
        assert listed(store) == [123_456]


def test_two_programs_that_find_the_damage_at_once_quarantine_one_file_and_lose_nothing(tmp_path):
    (tmp_path / FILE).write_bytes(b"hello " * 1000)
    found: list[object] = []

    def open_it() -> None:
        with Store(tmp_path) as store:
            found.append((store.warning, listed(store)))

    with closing(sqlite3.connect(tmp_path / "silverball.mending", isolation_level=None)) as lock:
        lock.execute("BEGIN EXCLUSIVE")  # as the other program does
        thread = threading.Thread(target=open_it)
        thread.start()
        time.sleep(0.2)
        assert not found
        (tmp_path / FILE).rename(tmp_path / "silverball-set-aside-by-the-other.sqlite3")
        with_scores(tmp_path, 10)
        lock.execute("ROLLBACK")
        thread.join()
    assert found == [("", [10])]
    assert quarantined(tmp_path).name == "silverball-set-aside-by-the-other.sqlite3"


def test_a_file_that_is_locked_when_it_is_opened_is_retried(tmp_path, monkeypatch):
    """As when four programs begin a new file at once: SQLite does not wait by itself then."""
    prepare, calls = sqlite_file.prepare, []

    def busy_at_first(*arguments: object) -> None:
        calls.append(arguments)
        if len(calls) < 3:
            error = sqlite3.OperationalError("database is locked")
            error.sqlite_errorcode = sqlite3.SQLITE_BUSY
            raise error
        prepare(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(sqlite_file, "prepare", busy_at_first)
    with Store(tmp_path) as store:
        assert (store.warning, store.is_persistent, len(calls)) == ("", True, 3)


def test_a_reader_without_write_ahead_log_is_waited_for(tmp_path):
    path = with_scores(tmp_path, 10)
    with closing(sqlite3.connect(path, isolation_level=None, check_same_thread=False)) as other:
        other.execute("PRAGMA journal_mode = DELETE")
        other.execute("BEGIN")
        other.execute("SELECT * FROM score").fetchall()
        later = threading.Timer(0.3, lambda: other.execute("COMMIT"))
        later.start()
        with Store(tmp_path) as store:
            assert (store.warning, store.is_persistent) == ("", True)
            assert listed(store) == [10]
        later.join()


def test_a_file_of_a_newer_program_is_left_as_it_is(tmp_path):
    path = with_scores(tmp_path, 10)
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("PRAGMA user_version = 9")
        connection.execute("ALTER TABLE score RENAME TO games")
    before = path.read_bytes()
    with Store(tmp_path) as store:
        assert_warned(store, "newer Silverball", "version 9", f"up to {SCHEMA.version}", is_persistent=False)
        assert listed(store) == []
        assert_play_goes_on(store)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == [FILE]


def test_an_error_of_the_caller_is_not_a_problem_of_the_file(tmp_path):
    with Store(tmp_path) as store:
        for wrong in (None, "many"):
            with pytest.raises(sqlite3.IntegrityError):
                add(store, wrong)  # type: ignore[arg-type]
        with pytest.raises(OverflowError):
            add(store, 2**63)
        with pytest.raises(SilverballError):
            store.rename(1, "ABC")
        assert (store.warning, store.is_persistent, listed(store)) == ("", True, [])


@pytest.mark.filterwarnings("error")
def test_opening_the_file_raises_no_warning_of_python(tmp_path):
    path = with_scores(tmp_path, 10)  # written
    with held(path, ALONE), Store(tmp_path, nonblocking=True) as store:  # locked
        assert store.has_pending
    path.write_bytes(b"hello " * 1000)
    with Store(tmp_path) as store:  # quarantined
        assert store.is_persistent
    path.unlink()
    path.mkdir()
    with Store(tmp_path) as store:  # in memory
        assert not store.is_persistent
