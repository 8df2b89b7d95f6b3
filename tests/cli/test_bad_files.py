"""Anything in place of an expected file: one sentence, exit code 2, at once, and no data is lost."""

from __future__ import annotations

import json
import os
import socket
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from holed import Holed, options_of
from hostile_text import obeyed_in
from patience import PATIENCE
from silverball.cli.app import run
from silverball.cli.shared_options import check_output
from silverball.errors import OutputError
from silverball.physics.records import MAX_BALLS
from silverball.soak import rounds as soak_module
from silverball.soak.campaign import soak
from silverball.soak.finding import Finding, reproduce
from silverball.table import dump_table, load_table

SOAK = ("soak", "--worlds", "1", "--frames", "1")

READERS: dict[str, Callable[[str], list[str]]] = {
    "check": lambda path: ["check", path],
    "show": lambda path: ["show", "--out", "x.png", "--table", path],
    "demo": lambda path: ["demo", "--out", "x.gif", "--table", path],
    "page": lambda path: ["page", "--out", "x.html", "--table", path],
    "page of a replay": lambda path: ["page", "--out", "x.html", "--replay", path],
    "simulate": lambda path: ["simulate", "--table", path],
    "feel": lambda path: ["feel", "--table", path],
    "marks": lambda path: ["marks", "--table", path],
    "design": lambda path: ["design", path, "--target", "ball_time=1±1"],
    "soak": lambda path: [*SOAK, "--table", path],
    "generate": lambda path: ["generate", "--table", path],
    "bench": lambda path: ["bench", "step", "--table", path],
    "play": lambda path: ["play", "--table", path],
    "replay": lambda path: ["replay", path],
    "again": lambda path: ["soak", "--again", path],
    "progress": lambda path: [*SOAK, "--progress", path],
}
"""Every command that reads a file: its arguments for a path."""

WRITERS: dict[str, Callable[[str], list[str]]] = {
    "show": lambda path: ["show", "--out", f"{path}.png", "--force"],
    "demo": lambda path: ["demo", "--out", f"{path}.gif", "--force"],
    "replay": lambda path: ["replay", "good.replay", "--out", f"{path}.png", "--force"],
    "page": lambda path: ["page", "--out", f"{path}.html", "--size", "100", "--force"],
    "page of a replay": lambda path: ["replay", "good.replay", "--out", f"{path}.html", "--force"],
    "generate": lambda path: ["generate", "--out", f"{path}.toml", "--force"],
    "progress": lambda path: [*SOAK, "--progress", path],
}


def pipe(path: str) -> None:
    os.mkfifo(path)


def listening(path: str) -> None:
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(path)


def folder(path: str) -> None:
    os.mkdir(path)


def circle(path: str) -> None:
    os.symlink(path, path)


def device(name: str) -> Callable[[str], None]:
    def link(path: str) -> None:
        if not os.path.exists(f"/dev/{name}"):
            pytest.skip(f"there is no device {name} here")
        os.symlink(f"/dev/{name}", path)

    return link


def content(data: bytes) -> Callable[[str], None]:
    return lambda path: Path(path).write_bytes(data) and None


def huge(path: str) -> None:
    with open(path, "wb") as file:
        file.truncate(2**40)


SPECIAL = {
    "pipe": pipe,
    "socket": listening,
    "folder": folder,
    **{f"/dev/{n}": device(n) for n in ("zero", "full", "null", "random", "tty")},
}
BAD = {
    **SPECIAL,
    "circle": circle,
    "huge": huge,
    "nothing": lambda path: None,
    "empty": content(b""),
    "zeros": content(bytes(1000)),
    "binary": content(bytes(range(256)) * 9),
    "no UTF-8": content("name = 'café'\n".encode("latin-1")),
    "UTF-16": content("format = 1\n".encode("utf-16")),
    "brackets": content(b"[" * 100_000),
    "braces": content(b'{"a":' * 50_000),
    "digits": content(b"9" * 100_000),
    "control characters": content(bytes(range(1, 32)) * 20),
    "line ends": content(b"\r" * 1000),
    "a program": content(b"#!/bin/sh\nrm -rf x\n"),
    "a page": content(b"<!DOCTYPE html><html></html>"),
}  # fmt: skip


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def refused(capfd) -> Callable[..., str]:
    """Run a command that must be refused; its sentence."""

    def command(*arguments: str, why: str = "") -> str:
        assert run(list(arguments)) == 2, why
        out, err = capfd.readouterr()
        assert obeyed_in(out + err) == set()
        assert out == ""
        assert 10 < len(err) < 2000
        return err

    return command


def what_is_there() -> dict[str, tuple[int, int]]:
    """Every name in this folder, the kind and the size of what it stands for."""
    return {
        name: (stat.S_IFMT(os.lstat(name).st_mode), os.lstat(name).st_size)
        for name in os.listdir()
        if name != "data"
    }


@pytest.mark.parametrize("make", BAD.values(), ids=BAD)
@pytest.mark.parametrize("reader", READERS.values(), ids=READERS)
def test_what_is_no_such_file_is_refused_in_a_sentence_that_names_it(refused, reader, make):
    path = "there.toml"
    if make is BAD["nothing"] and reader is READERS["progress"]:
        pytest.skip("a soak without a file begins one")
    make(path)
    before = what_is_there()
    message = refused(*reader(path))
    assert message.startswith(path)
    assert len(message.splitlines()) <= 2 or "problems" in message
    assert what_is_there() == before


@pytest.mark.parametrize("make", SPECIAL.values(), ids=SPECIAL)
@pytest.mark.parametrize("writer", WRITERS.values(), ids=WRITERS)
def test_what_is_no_ordinary_file_is_never_written_over(refused, writer, make):
    path = "there"
    arguments = writer(path)
    target = next(word for word in arguments if word.startswith(path))
    if arguments[0] == "replay":
        from silverball.game.game import Game

        game = Game("classic", 1)
        game.create_ball()
        game.step(True, False, 10)
        Path("good.replay").write_text(game.replay.to_text(), encoding="utf-8")
    make(target)
    before = what_is_there()
    assert refused(*arguments).startswith(target)
    assert what_is_there() == before


@pytest.mark.parametrize("make", SPECIAL.values(), ids=SPECIAL)
def test_that_it_cannot_be_written_is_said_before_a_film_is_made(make):
    make("there.gif")
    with pytest.raises(OutputError, match=r"there\.gif"):
        check_output(Path("there.gif"), (".gif",), force=True)


@pytest.mark.parametrize("name", ["-", ""])
@pytest.mark.parametrize("reader", READERS.values(), ids=READERS)
def test_standard_input_and_nothing_are_refused(refused, reader, name):
    refused(*reader(name))
    assert what_is_there() == {}


def test_a_pipe_says_what_to_do(refused):
    os.mkfifo("from-another-program.toml")
    assert "save its output to a file" in refused("check", "from-another-program.toml")
    assert "save it to a file" in refused("check", "-")


LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_CPU, (100, 100))
import silverball.cli.app, silverball.soak.campaign, silverball.soak.finding, silverball.game.replay
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for arguments in sys.argv[1:]:
    assert silverball.cli.app.run(arguments.split()) == 2
print("grown by", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="there is no /dev/zero here")
def test_an_endless_file_takes_neither_memory_nor_time():
    huge("huge.toml")
    os.mkfifo("pipe.toml")
    commands = [
        " ".join(reader(path))
        for reader in READERS.values()
        for path in ("/dev/zero", "huge.toml", "pipe.toml")
    ]
    result = subprocess.run(
        [sys.executable, "-c", LIMITED, *commands],
        capture_output=True, text=True, timeout=PATIENCE, check=False,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    grown = int(result.stdout.split()[-1])  # [kB]
    assert grown < 100_000


# ── files of a soak ─────────────────────────────────────────────────────────────────────────────────────


@pytest.fixture(scope="module")
def soaked(tmp_path_factory) -> Path:
    """A folder with the log of a soak and a finding of it."""
    path = tmp_path_factory.mktemp("soak") / "soak.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(soak_module, "WorldBatch", Holed)
        patch.setattr(soak_module, "ROUND_SECONDS", 20.0)
        log = soak(options_of(), 1, path)
    (path.parent / log.findings[0]).rename(path.with_name("finding.json"))
    assert log.findings
    return path.parent


def damages(good: dict[str, Any]) -> dict[str, str]:
    """Texts that are not quite this object, by what is wrong with them."""
    text = json.dumps(good)
    bad: dict[str, str] = {
        "cut off": text[: len(text) // 2],
        "twice": text + text,
        "a list": json.dumps([good]),
        "null": "null",
        "a number": "1",
        "a text": json.dumps(text),
        "a key twice": text[:-1] + ', "format": 1}',
        "an unknown key": json.dumps(good | {"\x1b[31m": 1}),
        "a later version": json.dumps(good | {"format": 2}),
        "a much later version": json.dumps(good | {"format": 10**400}),
        "a version that is none": json.dumps(good | {"format": True}),
        "of another program": json.dumps({"format": 1, "name": "x", "scripts": {"a": "b"}}),
        "only its version": '{"format": 1}',
    }  # fmt: skip
    wrong = (
        None,
        True,
        -1,
        1.5,
        float("nan"),
        float("inf"),
        2**63,
        10**400,
        "",
        "x" * 100_000,
        "\x1b]0;t\x07\u202e",
        [],
        [[]],
        [1],
        {},
        {"a": 1},
    )
    for key, value in good.items():
        bad[f"without {key}"] = json.dumps({other: good[other] for other in good if other != key})
        for one in wrong:
            if key == "format" or is_as_good(key, value, one):
                continue
            bad[f"{key} {repr(one)[:12]}"] = json.dumps(good | {key: one})
    return bad


def is_as_good(key: str, value: Any, other: Any) -> bool:
    """Whether a value may well stand in the place of another."""
    if key in ("program", "code"):  # any text
        return isinstance(other, str) and len(other) < 100
    if key in ("depth", "deepest"):
        return type(other) in (int, float) and 0 <= other < float("inf")
    return (type(other) is type(value) and other == value) or (key, other) in (
        ("findings", []),
        ("actions", []),
        ("hostile", True),
    )


def test_the_undamaged_files_are_read(soaked: Path):
    finding = Finding.load(soaked / "finding.json")
    reproduce(finding)
    assert soak(options_of(), 1, soaked / "soak.json").rounds == 1


def test_every_damaged_finding_is_refused_in_one_sentence(refused, soaked: Path):
    good = json.loads((soaked / "finding.json").read_text(encoding="utf-8"))
    bad = damages(good)
    for at, what in (
        (0, 2),
        (4, [1]),
        (4, [1, 2, 3]),
        (4, "ab"),
        (4, ["1", "2"]),
        (4, [1e400, 0]),
        (5, {}),
        (3, True),
    ):
        actions = [list(action) for action in good["actions"]]
        actions[-1][at] = what
        bad[f"action {at} {what}"] = json.dumps(good | {"actions": actions})
    state = good["state"]
    table = good["table_text"]
    bad |= {
        "an action too short": json.dumps(good | {"actions": [[0, 0, 0, 0, None]]}),
        "an action too long": json.dumps(good | {"actions": [[0, 0, 0, 0, *[None] * (MAX_BALLS + 1)]]}),
        "devices too large": json.dumps(good | {"actions": [[0, 0, 0, 0, 4, None, None]]}),
        "devices true": json.dumps(good | {"actions": [[0, 0, 0, 0, True, None, None]]}),
        "state cut off": json.dumps(good | {"state": state[:-2]}),
        "state of another kind": json.dumps(good | {"state": "00" * 500}),
        "state changed": json.dumps(good | {"state": state[:300] + "01"[state[300] == "0"] + state[301:]}),
        "state in capitals": json.dumps(good | {"state": state.upper()}),
        "another rate": json.dumps(good | {"tick_rate": good["tick_rate"] + 1}),
        "another table": json.dumps(good | {"table_text": dump_table(load_table("classic"))}),
        "a recipe": json.dumps(good | {"table_text": dump_table(load_table("random"))}),
        "a broken table": json.dumps(good | {"table_text": table + "\n[nonsense]\n"}),
        "no table": json.dumps(good | {"table_text": "[" * 100_000}),
        "half a character": json.dumps(good | {"table_text": "\ud800"}),
        "a kind of its own": json.dumps(good | {"kind": "nothing"}),
    }  # fmt: skip
    assert len(bad) > 200
    for what, text in bad.items():
        Path("finding.json").write_text(text, encoding="utf-8")
        message = refused("soak", "--again", "finding.json", why=what)
        assert message.startswith("finding.json: "), what
        assert len(message.splitlines()) == 1, what
        assert len(message) < 400, what


def test_every_damaged_progress_file_is_refused_in_one_sentence_and_kept(refused, soaked: Path):
    good = json.loads((soaked / "soak.json").read_text(encoding="utf-8"))
    bad = damages(good)
    for name, text in damages(good["totals"] | {"format": 1}).items():
        if name.split()[0] in good["totals"] or name.removeprefix("without ") in good["totals"]:
            values = json.loads(text)
            values.pop("format", None)
            bad[f"totals: {name}"] = json.dumps(good | {"totals": values})
    for part in ("options", "totals"):
        for key in good[part]:
            for one in (None, -1, "x", [], 1e400, float("nan"), 2**70):
                if not is_as_good(key, good[part][key], one):
                    bad[f"{part}.{key} {one}"] = json.dumps(good | {part: good[part] | {key: one}})
    for name in ("", ".", "..", "/etc/passwd", "../x.json", "a/b.json", "x", "x\0.json", 1, None):
        bad[f"file {name!r}"] = json.dumps(good | {"findings": [name]})
    bad["too many files"] = json.dumps(good | {"findings": ["x.json"] * 1000})
    assert len(bad) > 200
    options = options_of()
    command = [
        "soak",
        "--frames",
        "1",
        "--worlds",
        str(options.worlds),
        "--seed",
        str(options.seed),
    ]
    command += ["--tick-rate", str(options.tick_rate)]
    for what, text in bad.items():
        Path("soak.json").write_text(text, encoding="utf-8")
        message = refused(*command, "--progress", "soak.json", why=what)
        assert message.startswith("soak.json: "), what
        assert len(message.splitlines()) == 1, what
        assert len(message) < 400, what
        assert Path("soak.json").read_text(encoding="utf-8") == text
