"""`silverball study`: started, stopped, gone on with, and given wrong arguments."""

from __future__ import annotations

import json
import signal
import sys
from pathlib import Path

import pytest

from commandline import ran, started
from patience import PATIENCE

SMALL = ("--games", "20", "--seconds", "5", "--no-playable")


def test_a_study_prints_figures_and_writes_a_report(tmp_path: Path):
    done = ran("study", "classic", *SMALL, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "seconds a ball" in done.stdout
    assert "after 20 games: reflex:" in done.stderr
    path = tmp_path / done.stdout.split("report: ")[1].strip()
    assert "<!doctype html>" in path.read_text(encoding="utf-8")


def test_the_same_command_does_not_play_again(tmp_path: Path):
    first = ran("study", *SMALL, "--out", "study", "--json", cwd=tmp_path)
    begun = {path: path.stat().st_mtime_ns for path in (tmp_path / "study" / "chunks").iterdir()}
    again = ran("study", *SMALL, "--out", "study", "--json", cwd=tmp_path)
    assert json.loads(first.stdout) == json.loads(again.stdout)
    assert {path: path.stat().st_mtime_ns for path in begun} == begun


def test_a_sweep_is_compared_with_its_first_value(tmp_path: Path):
    done = ran("study", *SMALL, "--sweep", "board.gravity=8:12:3", "--json", cwd=tmp_path)
    arms = json.loads(done.stdout)["arms"]
    assert list(arms) == ["board.gravity=8", "board.gravity=10", "board.gravity=12"]
    assert len(arms["board.gravity=12"]["minus_first"]["seconds_per_ball"]) == 3
    printed = ran("study", *SMALL, "--sweep", "board.gravity=8:12:3", cwd=tmp_path).stdout
    assert "Minus board.gravity=8" in printed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--sweep", "paddle.lenght=1:2:3"), "did you mean `length`"),
        (("--sweep", "paddle.length=1:2"), "expected PATH=FROM:TO:HOW_MANY"),
        (("--sweep", "paddle.length=1.9,99"), "must be 0.3 to 10 u, got 99"),
        (("--sweep", "board.gravity=8:12:11", "--sweep", "paddle.length=1.9:2.1:11"), "got 121: sweep fewer"),
        (("--player", "nobody"), "nobody"),
        (("--player", "idle", "--player", "idle"), "each player once"),
        (("clasic",), 'did you mean "classic"'),
        (("--games", "1"), "--games"),
        (("--out", "there/plan.json"), "cannot be written"),
    ],
)
def test_wrong_arguments_are_told_before_the_first_game(arguments, words, tmp_path: Path):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "plan.json").write_text("{}")
    done = ran("study", *arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stdout == ""
    assert [path.name for path in tmp_path.iterdir()] == ["there"]


def test_parquet_without_its_package_is_told_before_the_first_game(tmp_path: Path, monkeypatch):
    monkeypatch.setitem(sys.modules, "polars", None)
    done = ran("study", *SMALL, "--parquet", cwd=tmp_path)
    assert done.returncode == 2
    assert "pip install 'silverball[study]'" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_rows_are_written_as_parquet(tmp_path: Path):
    polars = pytest.importorskip("polars")
    done = ran("study", *SMALL, "--events", "--out", "study", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    balls, games, events = (
        polars.scan_parquet(tmp_path / "study" / name).collect() for name in ("balls", "games", "events")
    )
    assert len(games) == 20
    assert balls["score"].sum() == games["score"].sum()
    assert events.filter(polars.col("kind") == "hit").height == games["hits"].sum()
    assert "paddle.left" in events["part"].unique()


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal to another process")
def test_ctrl_c_says_how_to_go_on(tmp_path: Path):
    process = started("study", "classic", "--games", "1000000", "--out", "study", cwd=tmp_path)
    assert process.stderr is not None
    said = process.stderr.readline()
    assert said.startswith("after 40 games: reflex:")
    process.send_signal(signal.SIGINT)
    _, rest = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "what is done is in study; the same command goes on from there" in rest
    assert (tmp_path / "study" / "chunks" / "000000.npz").is_file()
    assert not list((tmp_path / "study" / "chunks").glob(".*"))
