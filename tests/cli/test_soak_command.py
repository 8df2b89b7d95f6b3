"""`silverball soak`: what it prints, how it ends, and that it continues where it was stopped."""

from __future__ import annotations

import json
import signal
import time
from pathlib import Path

import pytest

from commandline import started
from holed import Holed
from patience import PATIENCE
from silverball.cli.app import run
from silverball.soak import rounds as soak_module

SMALL = ["soak", "--worlds", "2", "--frames", "1"]  # one round: 2 worlds, 600 s


def test_a_soak_prints_what_it_did_and_does_not_do_it_twice(silverball, tmp_path):
    path = tmp_path / "new folder" / "soak.json"
    first = silverball(*SMALL, "--json", "--progress", str(path))
    assert first.returncode == 0, first.stderr
    report = json.loads(first.stdout)
    assert report["frames"] == 2 * 600 * 60
    assert report["balls_created"] > 10
    assert 0 < report["deepest_penetration"] <= 1e-9
    assert set(report["findings"].values()) == {0}
    kinds = {"escape", "penetration", "passage", "phantom", "fault", "stuck", "missed"}
    assert set(report["findings"]) == kinds
    assert report["files"] == []
    again = json.loads(silverball(*SMALL, "--json", "--progress", str(path)).stdout)
    assert again.pop("frames_per_second") == 0
    del report["frames_per_second"]
    assert again == report
    text = silverball(*SMALL, "--progress", str(path)).stdout
    assert "72,000 frames of 1/60 s on 1 boards" in text
    assert "escape 0" in text
    assert str(path) in text


def test_without_a_name_the_progress_is_kept_in_the_data_folder(silverball, tmp_path, monkeypatch):
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path))
    assert silverball(*SMALL).returncode == 0
    assert silverball(*SMALL, "--hostile").returncode == 0
    names = sorted(path.name for path in (tmp_path / "soak").iterdir())
    assert [name[:12] for name in names] == ["soak-hostile", "soak-random-"]


def test_a_finding_ends_in_exit_code_1_and_can_be_done_again(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(soak_module, "WorldBatch", Holed)
    arguments = [*SMALL, "--progress", str(tmp_path / "soak.json")]
    assert run(arguments) == 1
    printed = capsys.readouterr().out
    name = next(line for line in printed.splitlines() if "--again" in line).split()[-1]
    kind = json.loads(Path(name).read_text(encoding="utf-8"))["kind"]
    assert f", {kind} 0," not in printed
    assert run(["soak", "--again", name]) == 1
    assert "happens again" in capsys.readouterr().out
    monkeypatch.undo()
    assert run(["soak", "--again", name]) == 0
    assert "no longer happens" in capsys.readouterr().out
    assert run(["soak", "--again", name, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "kind": kind, "found": "nothing", "happens_again": False,
    }  # fmt: skip


def test_ctrl_c_costs_at_most_a_round(silverball, tmp_path):
    path = tmp_path / "soak.json"
    options = ["soak", "--worlds", "2", "--progress", str(path)]
    process = started(*options, "--frames", "1000000000000")
    limit = time.monotonic() + 300.0  # a first use compiles
    while not path.exists() and time.monotonic() < limit:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert str(path) in errors
    done = json.loads(path.read_text())["totals"]["frames"]
    assert done > 0
    report = json.loads(silverball(*options, "--frames", str(done + 1), "--json").stdout)
    assert report["frames"] == done + 2 * 600 * 60
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--player random", ("--player", "silverball soak")),
        ("--hostile --table classic", ("--table", "--hostile")),
        ("--hostile --table random", ("--table", "--hostile")),
        ("--again nowhere.json", ("nowhere.json", "no such file")),
        ("--again broken.json", ("broken.json", "not a finding")),
        ("--frames 1 --progress broken.json", ("broken.json", "not a progress file")),
        ("--table nowhere.toml", ("nowhere.toml",)),
    ],
)
def test_a_mistake_is_one_clear_sentence(silverball, tmp_path, arguments, words):
    (tmp_path / "broken.json").write_text("{", encoding="utf-8")
    result = silverball("soak", *arguments.split(), cwd=tmp_path)
    assert result.returncode == 2
    assert "Traceback" not in result.stderr
    for word in words:
        assert word in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["broken.json"]
