"""Every command escapes names from files and arguments, so that a terminal shows and never executes them."""

from __future__ import annotations

import json
import os
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from hostile_text import FEW, NAMES, NO_TEXT, obeyed_in, toml_string
from silverball.cli import app as cli
from silverball.cli.app import run
from silverball.errors import SilverballError, StateError, TableError
from silverball.game.game import Game
from silverball.game.replay.digest import OLDEST_PHYSICS
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import checksum
from silverball.game.view import Mode
from silverball.physics import PHYSICS_VERSION
from silverball.plain import plain
from silverball.table import dump_table, load_table, parse_table

some_names = pytest.mark.parametrize("name", [NAMES[key] for key in FEW], ids=FEW)

KEYS = {
    "at the top": "format = 1\n{} = 1\n",
    "of a part": "format = 1\n[[cylinder]]\n{} = 1\ncenter = [3.0, 0.0]\nradius = 0.5\n",
    "of a section": "format = 1\n[{}]\nx = 1\n",
    "of a section in a section": "format = 1\n[board.{}]\nx = 1\n",
    "of a list": "format = 1\n[[{}]]\nx = 1\n",
    "twice": "format = 1\n{0} = 1\n{0} = 2\n",
    "a value": "format = 1\n[board]\ngravity = {}\n",
    "a value in a list": "format = 1\n[[slant_wall]]\nstart = [{}, 0.0]\nend = [1.0, 1.0]\n",
    "a choice": "format = 1\n[[paddle]]\nside = {}\npivot = [0.0, 0.0]\nlength = 2.0\n",
    "the format": "format = {}\n",
    "a mesh": "format = 1\n[[cylinder]]\nmesh = {}\n",
    "a mesh of a known kind": "format = 1\n[[cylinder]]\nmesh = {}\n",
}


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def told(capfd):
    """Run a command in this process; returns its exit code and output."""

    def command(*arguments: str) -> tuple[int, str]:
        code = run(list(arguments))
        out, err = capfd.readouterr()
        assert obeyed_in(out + err) == set()
        assert len(err) < 4000
        return code, out + err

    return command


@pytest.fixture(scope="module")
def played() -> Replay:
    game = Game("classic", 5, Mode.FREE)
    game.create_ball()
    game.step(True, False, 300)
    return game.replay


def table_called(name: str) -> Path:
    """A valid table file whose table has this name."""
    path = Path("mine.toml")
    text = dump_table(load_table("classic"))
    path.write_text(text.replace('"Classic"', toml_string(name)), encoding="utf-8")
    return path


@pytest.mark.parametrize("place", KEYS)
def test_a_hostile_word_in_a_broken_table_is_shown(told, place: str):
    path = Path("mine.toml")
    for key, name in NAMES.items():
        word = toml_string(name + ".stl" if "known kind" in place else name)
        path.write_text(KEYS[place].format(word), encoding="utf-8")
        with pytest.raises(TableError) as caught:
            load_table(path)
        error = caught.value
        parts = (str(error), error.source, *(part for problem in error.problems for part in problem))
        assert [obeyed_in(part) for part in parts] == [set()] * len(parts)
        head, *problems = str(error).splitlines()
        assert head.startswith("mine.toml: ")
        assert problems
        assert all(line.startswith("  ") for line in problems), problems
        if key in FEW:
            assert told("check", "mine.toml") == (2, f"{error}\n")


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
def test_a_raw_control_character_in_a_table_file_is_shown(name: str):
    Path("mine.toml").write_bytes(f'format = 1\n{name} = "{name}"\n'.encode())
    with pytest.raises(TableError) as caught:
        load_table("mine.toml")
    assert obeyed_in(str(caught.value)) == set()


@some_names
def test_the_name_of_a_good_table_is_shown(told, name: str):
    path = table_called(name)
    assert load_table(path).name == name
    code, text = told("check", str(path))
    assert (code, text) == (0, f"mine.toml: no problems in {name!r}\n")


@some_names
def test_a_table_is_printed_as_toml_that_is_safe_and_means_the_same(told, name: str):
    Path("mine.toml").write_text(f"format = 1\nname = {toml_string(name)}\n[random]\n", encoding="utf-8")
    code, text = told("generate", "--table", "mine.toml", "--seed", "3")
    assert code == 0
    assert name in tomllib.loads(text)["name"]


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
def test_the_text_of_a_table_is_safe_and_means_the_same(name: str):
    table = load_table("classic").model_copy(update={"name": name})
    assert obeyed_in(dump_table(table)) == set()
    assert parse_table(dump_table(table)) == table


@some_names
def test_file_names_and_table_names_are_shown_as_arguments(told, name: str):
    name = name.replace("/", "|")
    for path in (f"{name}.toml", f"nowhere-{name}/x"):
        for command in (
            ["check", path],
            ["show", "--out", "x.png", "--table", path],
            ["show", "--out", path],
            ["demo", "--out", path],
            ["demo", "--table", path, "--out", "x.gif"],
            ["demo", "--theme", path],
            ["demo", "--player", path, "--out", "x.gif"],
            ["page", "--out", path],
            ["page", "--table", path, "--out", "x.html"],
            ["page", "--replay", path, "--out", "x.html"],
            ["page", "--theme", path],
            ["page", "--player", path, "--out", "x.html"],
            ["simulate", "--table", path],
            ["simulate", "--player", path],
            ["feel", "--table", path],
            ["marks", "--table", path],
            ["ball-time", "--table", path],
            ["soak", "--table", path],
            ["soak", "--again", path],
            ["soak", "--again", path, "--json"],
            ["generate", "--table", path],
            ["bench", "step", "--table", path],
            ["bench", "peers", "--out", path],
            ["replay", path],
            ["replay", path, "--json"],
            ["play", "--table", path],
            ["scores", "--table", path],
            ["scores", "--remove", path],
            ["scores", "--mode", path],
            ["check", "classic", path],
            ["simulate", "--seconds", path],
            ["simulate", f"--{path}"],
            [path],
        ):
            code, text = told(*command)
            assert code == 2, (command, text)
            assert text.strip()


@some_names
def test_what_is_written_is_named_as_it_is(told, name: str):
    name = name.replace("/", "|")
    code, text = told("generate", "--seed", "7", "--out", f"{name}.toml")
    assert (code, text) == (0, f"wrote {plain(name)}.toml\n")
    assert [path.name for path in Path().glob("*.toml")] == [f"{name}.toml"]


@some_names
def test_a_replay_shows_the_names_in_it(told, played: Replay, name: str):
    path = Path("mine.replay")
    table = played.table.model_copy(update={"name": name})
    text = replace(played, table=table).to_text()
    assert obeyed_in(text) == set()
    path.write_text(text, encoding="utf-8")
    for options in (["--json"], ["--verify"], ["--verify", "--json"], ["--against", "mine.replay"]):
        code, shown = told("replay", str(path), *options)
        assert code == 0
        if "--json" in options:
            assert json.loads(shown)["table"] == name


def with_lines(lines: list[str]) -> str:
    """The text of a replay of these lines, with the checksum that belongs to them."""
    body = "\n".join(lines) + "\n"
    return f"{body}checksum = {checksum(body)}\n"


def refusal_of(text: str) -> str:
    """The error message for the text of a replay; empty if it is accepted."""
    try:
        Replay.from_text(text)
    except StateError as error:
        return str(error)
    return ""


def test_the_program_line_of_a_replay_is_shown(told, played: Replay):
    lines = played.to_text().splitlines()[:-1]
    assert lines[1].startswith("program = ")
    assert lines[2] == f"physics = {PHYSICS_VERSION}"
    for key, name in NAMES.items():
        if "\n" in name:
            continue
        lines[1] = f"program = {name}"
        game = Replay.from_text(with_lines(lines))
        assert game.program == plain(name)
        older = [*lines[:2], f"physics = {OLDEST_PHYSICS - 1}", *lines[3:]]
        with pytest.raises(StateError) as caught:
            Replay.from_text(with_lines(older))
        assert f"play it with Silverball {plain(name)}, which wrote it" in str(caught.value)
        if key in FEW:
            Path("mine.replay").write_bytes(with_lines(lines).encode())
            assert json.loads(told("replay", "mine.replay", "--json")[1])["program"] == plain(name)
            Path("mine.replay").write_bytes(with_lines(older).encode())
            assert told("replay", "mine.replay")[0] == 2


def test_a_hostile_word_anywhere_in_a_replay_is_shown(told, played: Replay):
    lines = played.to_text().splitlines()[:-1]
    play = lines.index("--- play")
    for number in (*range(9), play, play + 1, *range(len(lines) - 5, len(lines))):
        head = lines[number].partition(" = ")[0]
        for key, name in NAMES.items():
            for changed in (f"{head} = {name}", name, lines[number] + name):
                text = with_lines([*lines[:number], changed, *lines[number + 1 :]])
                refusal = refusal_of(text)
                assert obeyed_in(refusal) == set()
                assert "\n" not in refusal
                assert refusal or head in ("program", "seed", "score", "digest")  # what only playing can tell
                if key == "red":
                    Path("mine.replay").write_bytes(text.encode())
                    assert told("replay", "mine.replay", "--verify")[0] in (0, 1, 2)


@some_names
def test_a_simulation_names_the_file_of_its_table(told, name: str):
    path = f"{name.replace('/', '|')}.toml"
    os.rename(table_called(name), path)
    for command, *options in (
        ["simulate"], ["simulate", "--json"], ["ball-time"], ["ball-time", "--json"],
    ):  # fmt: skip
        code, text = told(command, "--table", path, "--seconds", "0.1", *options)
        assert code == 0
        if "--json" in options:
            assert json.loads(text)["table"] == path
        else:
            assert plain(path) in text


def test_files_whose_names_are_no_text_are_read_and_written(told, played: Replay):
    table, film, game = f"{NO_TEXT}.toml", f"{NO_TEXT}.png", f"{NO_TEXT}.replay"
    os.rename(table_called("Mine"), table)
    Path(game).write_text(played.to_text(), encoding="utf-8")
    log = f"{NO_TEXT}.json"
    small = ["--worlds", "1", "--frames", "1"]
    for command, word in (
        (["check", table], plain(table)),
        (["show", "--table", table, "--out", film, "--size", "100"], f"wrote {plain(film)}"),
        (["replay", game, "--verify"], plain(game)),
        (["replay", game, "--json"], "\\udce9"),
        (["replay", game, "--against", game], plain(game)),
        (["replay", game, "--out", f"b{film}", "--size", "100"], f"wrote b{plain(film)}"),
        (["generate", "--out", f"b{table}"], f"wrote b{plain(table)}"),
        (["simulate", "--table", table, "--seconds", "1", "--json"], "\\udce9"),
        (["soak", *small, "--table", table, "--progress", log], plain(log)),
        (["soak", *small, "--table", table, "--progress", log, "--json"], "\\udce9"),
    ):
        code, text = told(*command)
        assert code == 0, text
        assert word in text


def test_a_table_of_a_hostile_name_is_drawn(told):
    for name in ("\0", "".join(NAMES.values())[:80], "🧙\u200d♂️", NAMES["selector"], NAMES["pile"]):
        table_called(name)
        assert told("show", "--table", "mine.toml", "--out", "x.png", "--size", "100", "--force")[0] == 0


def test_errors_of_the_library_are_as_safe_as_those_of_commands():
    for name in NAMES.values():
        assert str(SilverballError(name)) == plain(name)


def test_a_message_never_floods_the_terminal(told):
    for long in ("x" * 100_000, "\x1b" * 30_000):
        for command in (["check", long], ["replay", long], ["simulate", "--seconds", long], [f"--{long}"]):
            code, text = told(*command)
            assert code == 2
            assert len(text) < 3 * cli.MAX_LINE_LENGTH
