"""The tables in the menu for any content of the user's folder, and the messages about them."""

from __future__ import annotations

import os
import threading
import time

import pytest

from evenings import LEAKY, Evening
from silverball.app.catalog import Catalog
from silverball.app.command_handlers import execute
from silverball.app.controls import Action
from silverball.app.menus import Button
from silverball.app.menus.commands import WatchScore
from silverball.app.program import FILE_CHECK_INTERVAL
from silverball.app.settings import Settings
from silverball.game.scores.store import Store
from silverball.game.view import Mode, Phase
from silverball.table import dump_table, load_table, table_names

GOOD = 'format = 1\nname = "{}"\n[[cylinder]]\ncenter = [3, {}]\nradius = 1.0\n'


BEING_READ = "is being read"


def all_read(catalog):
    """The entries, once all files have been read."""
    limit = time.monotonic() + 120.0
    while BEING_READ in {entry.description for entry in catalog.entries()}:
        assert time.monotonic() < limit
        time.sleep(0.05)
    return catalog.entries()


def write(folder, name="mine.toml", text=None, title="Mine", z=0.0):
    """A table file in the folder for one's own tables."""
    path = folder / "tables" / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(GOOD.format(title, z) if text is None else text, encoding="utf-8")
    return path


def nothing(path):
    path.write_bytes(b"")


def a_folder(path):
    path.unlink(missing_ok=True)
    path.mkdir()


def a_pipe(path):
    path.unlink(missing_ok=True)
    os.mkfifo(path)


def a_loop(path):
    path.unlink(missing_ok=True)
    path.symlink_to(path)


def a_dead_link(path):
    path.unlink(missing_ok=True)
    path.symlink_to(path.with_name("not there.toml.txt"))


def too_long(path):
    path.write_bytes(b"# long\n" * 200_000)


def a_text(text):
    def change(path):
        path.write_text(text, encoding="utf-8")

    return change


def latin(path):
    path.write_bytes('format = 1\nname = "Größe"\n'.encode("latin-1"))


BROKEN = {
    "nothing in it": nothing,
    "half a file": a_text(GOOD.format("Mine", 0)[:-9]),
    "no TOML": a_text("this is no table\n"),
    "an unknown key": a_text('format = 1\n[board]\ngravitation = 9\n'),
    "another format": a_text("format = 99\n"),
    "a wrong type": a_text('format = 1\n[board]\ngravity = "strong"\n'),
    "an impossible part": a_text('format = 1\n[[cylinder]]\ncenter = [0, 0]\nradius = -1\n'),
    "a mesh that is not there": a_text('format = 1\n[[cylinder]]\nmesh = "none.stl"\n'),
    "a recipe without room": a_text("format = 1\n[random]\narea = [[90, 90], [91, 91]]\n"),
    "other text than UTF-8": latin,
    "too long": too_long,
    "a folder": a_folder,
    "a pipe": a_pipe,
    "a link to itself": a_loop,
    "a link to nowhere": a_dead_link,
}  # fmt: skip


@pytest.fixture
def catalog(tmp_path):
    with Store(tmp_path) as store:
        yield Catalog(store, tmp_path)


@pytest.fixture
def mine(tmp_path):
    """An evening at a table of one's own, which has a file."""
    path = write(tmp_path)
    evening = Evening(tmp_path, Settings(table=str(path), mode="free"))
    evening.program.finish_loading()
    evening.path = path
    yield evening
    evening.store.close()


def entry_of(catalog, path):
    return next(entry for entry in all_read(catalog) if entry.name == str(path))


def center(evening) -> float:
    """Across, the cylinder of the board that is seen; that of the game, if there is one, is the same."""
    program = evening.program
    z = program.board.table.cylinder[0].center[1]
    if program.session is not None:
        assert program.session.game.table.cylinder[0].center[1] == z
    return z


def settle(evening, words: str | None = None) -> None:
    """Let the program look at the files until it has said something, or for three looks."""
    limit = time.monotonic() + 120.0
    evening.go(3.5 * FILE_CHECK_INTERVAL)
    while words is not None and not any(words in said for said in evening.said):
        assert time.monotonic() < limit, evening.said
        evening.go(FILE_CHECK_INTERVAL)


@pytest.mark.parametrize("kind", BROKEN)
def test_a_file_that_cannot_be_used_is_offered_with_its_name_and_its_first_problem(catalog, tmp_path, kind):
    path = write(tmp_path)
    BROKEN[kind](path)
    write(tmp_path, "other.toml", title="Other")
    entry = entry_of(catalog, path)
    assert entry.title == "mine.toml"
    assert entry.problem
    assert "\n" not in entry.problem
    assert entry_of(catalog, tmp_path / "tables" / "other.toml").problem == ""


@pytest.mark.parametrize("kind", BROKEN)
def test_choosing_such_a_file_tells_what_is_wrong_and_the_command_that_tells_all_and_starts_nothing(
    tmp_path, kind
):
    path = write(tmp_path)
    BROKEN[kind](path)
    evening = Evening(tmp_path)
    evening.program.finish_loading()
    before = evening.program.board.table
    press(evening, Button.RIGHT, Button.RIGHT, Button.START)
    while display_name(evening) != str(path):
        press(evening, Button.RIGHT)
    assert evening.said == []
    press(evening, Button.START)
    assert f"silverball check {path}" in evening.said[-1]
    assert entry_of(evening.catalog, path).problem in evening.said[-1]
    assert evening.program.board.table == before
    assert evening.program.session is None
    assert evening.program.menus.page == "table"
    evening.store.close()


def press(evening, *buttons):
    for button in buttons:
        evening.program.press_menu(button)
        evening.program.menus.release(button)


def display_name(evening):
    """The item that the open page shows."""
    page = evening.program.menus.context.pages[-1]
    return page._current_items()[page.index].key


@pytest.mark.parametrize("kind", BROKEN)
def test_r_plays_the_old_table_when_the_file_has_been_broken_and_says_why(mine, kind):
    mine.program.play(Mode.FREE, str(mine.path))
    mine.tap(Action.CREATE)
    old = center(mine)
    BROKEN[kind](mine.path)
    mine.tap(Action.NEW_BOARD)
    assert center(mine) == old
    assert mine.program.is_playing
    assert mine.program.session.game.world.created == 0
    assert f"silverball check {mine.path}" in mine.said[-1]
    assert "previous version" in mine.said[-1]


@pytest.mark.parametrize("kind", BROKEN)
def test_a_file_that_is_broken_while_it_is_played_is_told_of_once(mine, kind):
    mine.program.play(Mode.FREE, str(mine.path))
    BROKEN[kind](mine.path)
    settle(mine, "mine.toml")
    said = len(mine.said)
    assert "cannot be played" in mine.said[-1]
    assert mine.program.is_playing
    mine.go(5.0)
    assert len(mine.said) == said


@pytest.mark.parametrize("kind", BROKEN)
def test_a_broken_table_that_was_chosen_is_not_begun_from_the_menu(mine, kind):
    BROKEN[kind](mine.path)
    mine.tap(Action.CREATE)  # "play"
    assert mine.program.session is None
    assert mine.program.menus.page == "main"
    assert "mine.toml cannot be played" in mine.said[-1]
    mine.path.is_dir() and mine.path.rmdir()
    mine.path.unlink(missing_ok=True)
    write(mine.path.parents[1], z=2.0)
    mine.tap(Action.CREATE)
    assert center(mine) == 2.0
    assert mine.program.is_playing


def in_place(path, text):
    path.write_text(text, encoding="utf-8")


def renamed_over(path, text):
    other = path.with_name("next.tmp")
    other.write_text(text, encoding="utf-8")
    os.replace(other, path)


def gone_and_back(path, text):
    path.unlink()
    path.write_text(text, encoding="utf-8")


def with_old_times(path, text):
    path.write_text(text, encoding="utf-8")
    os.utime(path, (1_000_000_000, 1_000_000_000))


def through_a_link(path, text):
    other = path.with_name("elsewhere.txt")
    other.write_text(text, encoding="utf-8")
    path.unlink()
    path.symlink_to(other)


def with_a_mark_in_front(path, text):
    path.write_text(text, encoding="utf-8-sig")


def with_other_line_ends(path, text):
    path.write_bytes(text.replace("\n", "\r\n").encode())


def longer(path, text):
    path.write_text(text + "# a remark\n" * 50, encoding="utf-8")


def piece_by_piece(path, text):
    with open(path, "w", encoding="utf-8") as file:
        for piece in text.splitlines(keepends=True):
            file.write(piece)
            file.flush()


def appended(path, text):
    with open(path, "a", encoding="utf-8") as file:
        file.write("# first a remark\n")
    path.write_text(text, encoding="utf-8")


EDITS = (
    in_place, renamed_over, gone_and_back, with_old_times, through_a_link, with_a_mark_in_front,
    with_other_line_ends, longer, piece_by_piece, appended,
)  # fmt: skip


@pytest.mark.parametrize("edit", EDITS)
def test_r_reads_an_edited_file_again(mine, edit):
    mine.program.play(Mode.FREE, str(mine.path))
    edit(mine.path, GOOD.format("Mine", 2.0))
    mine.tap(Action.NEW_BOARD)
    assert center(mine) == 2.0
    assert mine.said[-1] == "mine.toml was read again"
    mine.tap(Action.NEW_BOARD)
    assert "no random parts" in mine.said[-1]


@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_file_is_noticed_while_it_is_played_and_told_of_once(mine, edit):
    mine.program.play(Mode.FREE, str(mine.path))
    edit(mine.path, GOOD.format("Mine", 2.0))
    settle(mine, "mine.toml has changed: R plays the new one")
    assert center(mine) == 0.0  # until somebody asks for it
    said = len(mine.said)
    mine.go(5.0)
    assert len(mine.said) == said


@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_file_is_seen_at_once_while_nobody_plays(mine, edit):
    edit(mine.path, GOOD.format("Mine", 2.0))
    limit = time.monotonic() + 120.0
    while center(mine) != 2.0:
        assert time.monotonic() < limit
        mine.go(FILE_CHECK_INTERVAL)
    assert mine.program.session is None


def test_a_file_that_is_written_anew_as_it_was_is_no_news(mine):
    mine.program.play(Mode.FREE, str(mine.path))
    said = len(mine.said)
    write(mine.path.parents[1])
    os.utime(mine.path)
    settle(mine)
    mine.go(3.0)
    assert len(mine.said) == said


def test_half_a_file_that_becomes_whole_within_a_look_is_not_called_broken(mine):
    mine.program.play(Mode.FREE, str(mine.path))
    text = GOOD.format("Mine", 2.0)
    mine.path.write_text(text[:-9], encoding="utf-8")
    mine.go(1.2 * FILE_CHECK_INTERVAL)
    mine.path.write_text(text, encoding="utf-8")
    settle(mine, "has changed")
    assert not any("cannot be played" in said for said in mine.said)


def test_a_mesh_that_has_changed_is_a_change_of_the_table(tmp_path):
    pytest.importorskip("trimesh")

    def post(radius):
        ring = [(radius, 0), (0, radius), (-radius, 0), (0, -radius)]
        points = [f"v {x} {y} {z}" for y in (0, 1) for x, z in ring]
        (tmp_path / "tables" / "post.obj").write_text("\n".join([*points, "f 1 2 3", "f 5 6 7", "f 1 5 8"]))

    path = write(tmp_path, text='format = 1\n[[cylinder]]\nmesh = "post.obj"\n')
    post(0.6)
    evening = Evening(tmp_path, Settings(table=str(path)))
    evening.program.finish_loading()
    evening.program.play(Mode.FREE, str(path))
    before = evening.program.board.table.cylinder[0].radius
    post(0.9)
    settle(evening, "mine.toml has changed")
    evening.tap(Action.NEW_BOARD)
    assert evening.program.board.table.cylinder[0].radius > before
    evening.store.close()


def test_a_file_that_comes_into_the_folder_while_the_list_is_open_is_in_it_and_the_shown_one_stays(
    tmp_path,
):
    write(tmp_path, "m.toml", title="Middle")
    evening = Evening(tmp_path)
    press(evening, Button.RIGHT, Button.RIGHT, Button.START)
    while not display_name(evening).endswith("m.toml"):
        press(evening, Button.RIGHT)
    for name in ("a.toml", "b.toml", "z.toml"):
        write(tmp_path, name, title=name)
    (tmp_path / "tables" / ".hidden.toml").write_text("half of a fi")
    settle(evening)
    names = [os.path.basename(entry.name) for entry in evening.program.menus.context.tables]
    assert names[-4:] == ["a.toml", "b.toml", "m.toml", "z.toml"]
    assert display_name(evening).endswith("m.toml")
    press(evening, Button.START)
    assert evening.program.board.table.name == "Middle"
    (tmp_path / "tables" / "a.toml").unlink()
    settle(evening)
    assert not any(entry.title == "a.toml" for entry in evening.program.menus.context.tables)
    evening.store.close()


def test_files_of_equal_names_are_told_apart(catalog, tmp_path):
    for name in ("one.toml", "two.toml"):
        write(tmp_path, name, title="Twin")
    write(tmp_path, "three.toml", title="CLASSIC")
    titles = [entry.title for entry in all_read(catalog)]
    assert len({title.upper() for title in titles}) == len(titles)
    assert "Twin (one.toml)" in titles
    assert load_table("classic").name in titles


@pytest.mark.parametrize(
    "name",
    ["tab\there.toml", "line\nfeed.toml", "bell\x07.toml", "\x1b[31mred.toml", "right\u202eto left.toml",
     "c1\x9b.toml", "not \udcff text.toml"],
)  # fmt: skip
@pytest.mark.parametrize("text", [None, "format = 99"])
def test_names_that_would_steer_a_terminal_are_shown_and_not_obeyed(tmp_path, name, text):
    path = tmp_path / "tables" / name
    path.parent.mkdir()
    try:
        path.write_text(text or dump_table(LEAKY.model_copy(update={"name": "a\x1b[0m\u202eb\0"})))
    except OSError:
        pytest.skip("this disk takes no such name")
    evening = Evening(tmp_path, Settings(table=str(path)) if text is None else None)
    (entry,) = [one for one in all_read(evening.catalog) if one.name == str(path)]
    evening.program.finish_loading()
    evening.program.play(Mode.FREE, str(path))
    evening.tap(Action.NEW_BOARD)
    shown = "".join([entry.title, entry.problem, *evening.said])
    assert shown.isprintable()
    assert bool(entry.problem) == (text is not None)
    evening.store.close()


def test_five_hundred_files_are_all_offered_though_none_is_waited_for(tmp_path, monkeypatch):
    text = dump_table(load_table("classic"))
    for number in range(500):
        write(tmp_path, f"t{number:03}.toml", text.replace("Classic", f"Table {number}"))
    gate = threading.Event()
    monkeypatch.setattr("silverball.app.table_files.READ_PAUSE", 0.001)
    monkeypatch.setattr(
        "silverball.app.table_files.load_table", lambda name: gate.wait() and load_table(name)
    )
    with Store(tmp_path) as store:
        catalog = Catalog(store, tmp_path)
        own = [entry for entry in catalog.entries() if entry.name.startswith(str(tmp_path))]
        assert [entry.title for entry in own] == [f"t{number:03}.toml" for number in range(500)]
        assert {entry.description for entry in own} == {BEING_READ}
        gate.set()
        titles = {entry.title for entry in all_read(catalog)}
        assert {f"Table {number}" for number in range(500)} <= titles


def test_the_chosen_file_is_read_before_all_the_others_that_wait(tmp_path, monkeypatch):
    chosen = write(tmp_path, "zz.toml", title="Chosen")
    for number in range(50):
        write(tmp_path, f"t{number:03}.toml")
    read, gate = [], threading.Event()

    def slow(name):
        read.append(os.path.basename(name))
        gate.wait()
        return load_table(name)

    monkeypatch.setattr("silverball.app.table_files.load_table", slow)
    with Store(tmp_path) as store:
        catalog = Catalog(store, tmp_path)
        catalog.refresh(whole=True)  # one of the fifty is being read, and takes its time
        catalog.watch_file(str(chosen))
        catalog.refresh(whole=False)
        gate.set()
        limit = time.monotonic() + 120.0
        while "zz.toml" not in read:
            assert time.monotonic() < limit
            time.sleep(0.01)
        assert read.index("zz.toml") == 1


def test_a_file_with_a_space_in_its_name_is_told_apart_from_the_sentence(tmp_path):
    path = write(tmp_path, "a table.toml")
    evening = Evening(tmp_path, Settings(table=str(path), mode="free"))
    evening.program.finish_loading()
    evening.program.play(Mode.FREE, str(path))
    write(tmp_path, "a table.toml", z=2.0)
    settle(evening, "'a table.toml' has changed")
    evening.store.close()


def test_the_names_in_the_folder_may_be_anything_and_the_folder_may_be_a_file(tmp_path):
    (tmp_path / "tables").write_text("not a folder")
    with Store(tmp_path) as store:
        assert [entry.problem for entry in Catalog(store, tmp_path).entries()] == [""] * len(table_names())


def test_a_file_that_breaks_the_reader_is_one_that_cannot_be_read(catalog, tmp_path, monkeypatch):
    path = write(tmp_path)
    monkeypatch.setattr("silverball.app.table_files.load_table", lambda name: 1 / 0)
    assert "ZeroDivisionError" in entry_of(catalog, path).problem


def test_the_scores_follow_what_the_file_says_and_a_game_goes_by_what_it_was_played_on(tmp_path):
    path = write(tmp_path, text=dump_table(LEAKY))
    evening = Evening(tmp_path, Settings(table=str(path), mode="arcade"))
    evening.program.finish_loading()
    program, catalog = evening.program, evening.catalog
    program.play(Mode.ARCADE, str(path), 3)
    old = catalog.score_key(program.board.recipe)
    changed = LEAKY.model_copy(update={"cylinder": LEAKY.cylinder[:2]})
    path.write_text(dump_table(changed), encoding="utf-8")
    settle(evening, "has changed")
    evening.play_to_the_end()
    score = program.session.game.score
    assert score > 0
    (row,) = evening.store.scores()
    assert row.table_digest == old.digest  # the file has changed, the game has not
    assert catalog.best(old, Mode.ARCADE) == score
    assert catalog.scores(str(path), Mode.ARCADE) == []
    path.write_text(dump_table(LEAKY), encoding="utf-8")  # as it was
    settle(evening)
    assert [one.score for one in catalog.scores(str(path), Mode.ARCADE)] == [score]
    path.write_text(dump_table(changed), encoding="utf-8")
    execute(WatchScore(str(row.id)), program)
    assert program.board.table.cylinder == LEAKY.cylinder  # the replay has its own
    program.watching.end()
    assert program.board.table.cylinder == changed.cylinder
    evening.store.close()


def test_a_game_that_ends_as_r_is_pressed_is_listed_under_the_table_it_was_played_on(tmp_path):
    path = write(tmp_path, text=dump_table(LEAKY))
    evening = Evening(tmp_path, Settings(table=str(path), mode="arcade"))
    evening.program.finish_loading()
    evening.program.play(Mode.ARCADE, str(path), 3)
    old = evening.catalog.score_key(evening.program.board.recipe)
    game = evening.program.session.game
    while not game.is_over:
        if game.phase is not Phase.PLAY:
            evening.press(Action.CREATE)
        evening.advance(8)
    path.write_text(dump_table(LEAKY.model_copy(update={"cylinder": LEAKY.cylinder[:2]})), encoding="utf-8")
    evening.press(Action.NEW_BOARD)  # before any picture has shown the end
    assert [row.score for row in evening.store.scores()] == [game.score]
    assert {row.table_digest for row in evening.store.scores()} == {old.digest}
    evening.store.close()
