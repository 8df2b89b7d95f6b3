"""`silverball design`: table files, pictures and what is known of them, or a sentence."""

from __future__ import annotations

import json

import pytest

from silverball import load_table

pytest.importorskip("cmaes")

PATH = "paddle.length=1.7:2.2"


def test_the_command_writes_tables_pictures_and_what_is_known(silverball, tmp_path):
    out = tmp_path / "found"
    arguments = ["design", "classic", "--target", "ball_time=2±30", "--player", "idle", "--games", "10",
                 "--tables", "10", "--vary", PATH, "--no-pictures", "--out", str(out)]  # fmt: skip
    made = silverball(*arguments)
    assert made.returncode == 0, made.stderr
    assert "is reached, also in games of other seeds" in made.stdout
    report = json.loads((out / "design.json").read_text())
    assert report["reached"] is True
    assert report["targets"] == ["ball_time=2±30"]
    assert 1 <= len(report["tables"]) <= 10
    for row in report["tables"]:
        table = load_table(out / row["file"])
        assert table.paddle[0].length == row["changes"]["paddle.length"]
    refused = silverball(*arguments)
    assert refused.returncode == 2
    assert "this folder is not empty" in refused.stderr


def test_a_target_that_nobody_can_reach_is_told_in_a_sentence(silverball, tmp_path):
    made = silverball(
        "design", "classic", "--target", "ball_time=900±1", "--player", "idle", "--games", "10",
        "--tables", "10", "--vary", PATH, "--no-pictures", "--out", str(tmp_path / "found"),
    )  # fmt: skip
    assert made.returncode == 1, made.stderr
    assert "no table in these ranges reaches ball_time=900±1: the nearest of" in made.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "give a --target, for example ball_time=30±2; the figures are ball_time,"),
        (["--target", "fun=3±1"], "no figure is called 'fun'"),
        (["--target", "ball_time=3±1", "--player", "nobody"], "no player is called 'nobody'"),
        (["--target", "ball_time=3±1", "--vary", "paddle.size=1:2"], "paddle.size"),
        (["--target", "ball_time=3±1", "--vary", "paddle.length=80:90"], "paddle.length"),
        (["--target", "ball_time=3±1", "--vary", PATH, "--vary", PATH], "each number once"),
    ],
)
def test_what_cannot_be_searched_is_refused_in_a_sentence(silverball, tmp_path, arguments, words):
    made = silverball("design", "classic", *arguments, "--out", str(tmp_path / "x"))
    assert made.returncode == 2
    assert words in made.stderr
    assert len(made.stderr.splitlines()) == 1
    assert not (tmp_path / "x").exists()
