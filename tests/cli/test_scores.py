"""`silverball scores`: what it prints, verifies, writes and removes, and how errors end."""

from __future__ import annotations

import json
import os
import re
import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import pytest

from holder import ALONE, held
from silverball.game.scores.store import FILE, Store
from silverball.table import load_table, table_digest


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The data folder of this test."""
    path = tmp_path / "data"
    monkeypatch.setenv("SILVERBALL_DATA", str(path))
    monkeypatch.setenv("COLUMNS", "100")
    return path


@pytest.fixture
def scores(folder: Path) -> dict[int, int]:
    """Some scores on two tables; number by score."""
    with Store(folder) as store:
        ids = {
            score: store.add_score("ABC", score, mode, name, name * 4, seed, f"replay of {score}\n")
            for score, mode, name, seed in (
                (300, "arcade", "Random", 7),
                (1200, "arcade", "Random", 2**63 - 1),
                (50, "arcade", "[red]Mine[/red]", 3),
                (70, "free", "Random", 4),
            )
        }
        store.rename(ids[300], "X.Y")
    return ids


def assert_refused(result, *words: str) -> None:
    assert result.returncode == 2, result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert "Traceback" not in result.stderr
    for word in words:
        assert word in result.stderr


def test_without_any_scores_it_says_so(silverball, folder):
    result = silverball("scores")
    assert (result.returncode, result.stdout.strip()) == (
        0,
        "there are no scores yet: play a game with `silverball`",
    )
    assert json.loads(silverball("scores", "--json").stdout) == []


def test_every_table_and_mode_has_a_list_with_the_best_first(silverball, scores):
    result = silverball("scores")
    assert (result.returncode, result.stderr) == (0, "")
    lines = [line.split() for line in result.stdout.splitlines() if line.strip()]
    titles = [line for line in lines if "·" in line]
    assert titles == [
        ["Random", "·", "arcade"],
        ["[red]Mine[/red]", "·", "arcade"],
        ["Random", "·", "free"],
    ]
    first, second = (
        line for line in lines[lines.index(titles[0]) : lines.index(titles[1])] if line[0] in "12"
    )
    assert (first[:4], first[-1]) == (["1", "1,200", "ABC", str(2**63 - 1)], str(scores[1200]))
    assert (second[:4], second[-1]) == (["2", "300", "X.Y", "7"], str(scores[300]))


def test_tables_modes_and_numbers_choose_what_is_shown(silverball, scores):
    def shown(*arguments: str) -> list[int]:
        return [row["score"] for row in json.loads(silverball("scores", "--json", *arguments).stdout)]

    assert shown() == [1200, 300, 50, 70]
    assert shown("--table", "random") == [1200, 300, 70]
    assert shown("--table", "Random", "--mode", "free") == [70]
    assert shown("--mode", "arcade", "--limit", "1") == [1200, 50]


def test_json_has_everything_about_a_score(silverball, scores):
    row = json.loads(silverball("scores", "--json", "--table", "Random", "--mode", "free").stdout)[0]
    when = row.pop("when")
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", when)
    assert row == {
        "place": 1,
        "id": scores[70],
        "initials": "ABC",
        "score": 70,
        "mode": "free",
        "table_name": "Random",
        "table_digest": "Random" * 4,
        "seed": 4,
        "verified": None,
        "why": "",
        "has_replay": True,
    }


def test_what_a_terminal_would_obey_is_shown_as_its_escape_and_can_be_asked_for(silverball, folder):
    nasty = "\x1b[31m\x9b\u202ered\n\x7f"
    with Store(folder) as store:
        number = store.add_score(nasty, 5, "arcade", nasty, nasty, 7, nasty)
    escaped = r"\x1b[31m\x9b\u202ered\n\x7f"
    outputs = [
        silverball("scores"),
        silverball("scores", "--verify"),
        silverball("scores", "--json"),
        silverball("scores", "--table", nasty),
        silverball("scores", "--table", escaped),
        silverball("scores", "--table", f"{nasty}?"),
        silverball("scores", "--remove", str(number)),
    ]
    assert [one.returncode for one in outputs] == [0, 1, 0, 0, 0, 2, 0]
    for one in outputs:
        output = one.stdout + one.stderr
        assert all(character.isprintable() or character == "\n" for character in output)
    assert all(escaped in one.stdout + one.stderr for one in outputs[:2] + outputs[3:])


def test_more_scores_than_are_shown_are_counted(silverball, scores):
    assert "and 1 more (see --limit)" in silverball("scores", "--limit", "1", "--mode", "arcade").stdout


def test_two_versions_of_a_table_are_told_apart(silverball, scores, folder):
    with Store(folder) as store:
        store.add_score("NEW", 5, "arcade", "Random", "0123456789abcdef", 0, "")
    assert "Random · arcade · version 01234567" in silverball("scores").stdout


def test_the_replay_of_a_score_is_written_and_nothing_is_overwritten_unasked(silverball, scores, tmp_path):
    out = tmp_path / "best.replay"
    arguments = ("scores", "--replay", str(scores[300]), "--export", str(out))
    assert silverball(*arguments).returncode == 0
    assert out.read_text() == "replay of 300\n"
    out.write_text("mine")
    assert_refused(silverball(*arguments), "this file exists", "--force")
    assert out.read_text() == "mine"
    assert silverball(*arguments, "--force").returncode == 0
    assert out.read_text() == "replay of 300\n"


def test_a_removed_score_is_gone(silverball, scores):
    result = silverball("scores", "--remove", str(scores[300]))
    assert result.stdout.strip() == f"removed score {scores[300]}: 300 by X.Y on Random"
    left = [row["score"] for row in json.loads(silverball("scores", "--json").stdout)]
    assert sorted(left) == [50, 70, 1200]


def test_an_invalid_call_ends_in_one_sentence(silverball, scores, tmp_path):
    out = str(tmp_path / "out.replay")
    assert_refused(silverball("scores", "--table", "nowhere"), "nowhere", "Random")
    assert_refused(silverball("scores", "--mode", "hard"), "arcade", "free", "hard")
    assert_refused(silverball("scores", "--remove", "99"), "there is no score 99")
    assert_refused(silverball("scores", "--remove", "first"), "first")
    for number in (2**63, -(2**63) - 1, 10**40):
        assert_refused(silverball("scores", "--remove", str(number)), f"there is no score {number}")
        assert_refused(
            silverball("scores", "--replay", str(number), "--export", out), f"there is no score {number}"
        )
    assert_refused(silverball("scores", "--replay", "99", "--export", out), "there is no score 99")
    assert_refused(silverball("scores", "--replay", "1"), "--replay ID --export FILE")
    assert_refused(silverball("scores", "--export", out), "--replay ID --export FILE")
    assert_refused(silverball("scores", "--replay", "1", "--export", str(tmp_path)), "folder")
    assert_refused(silverball("scores", "--replay", "1", "--export", f"{out}/x/y"), "does not exist")
    assert_refused(silverball("scores", "--remove", "1", "--json"), "--json does not go with --remove")
    assert_refused(silverball("scores", "--verify", "--remove", "1"), "--verify does not go with --remove")
    assert_refused(silverball("scores", "--force"), "--force is for --export")
    assert not Path(out).exists()
    assert len(json.loads(silverball("scores", "--json").stdout)) == len(scores)


def test_scores_of_a_newer_program_are_neither_shown_nor_touched(silverball, scores, folder):
    with closing(sqlite3.connect(folder / FILE)) as connection, connection:
        connection.execute("PRAGMA user_version = 9")
    result = silverball("scores")
    assert result.returncode == 0
    assert len(result.stderr.strip().splitlines()) == 1
    assert "newer Silverball" in result.stderr
    refused = silverball("scores", "--remove", str(scores[300]))
    assert refused.returncode == 2
    assert "nothing was changed" in refused.stderr


def test_unreadable_scores_are_not_called_verified(silverball, scores, folder):
    with closing(sqlite3.connect(folder / FILE)) as connection, connection:
        connection.execute("PRAGMA user_version = 9")
    refused = silverball("scores", "--verify")
    assert refused.returncode == 2
    assert "nothing was verified" in refused.stderr


@pytest.mark.parametrize("zone", ["Pacific/Kiritimati", "Pacific/Midway", "UTC"])
def test_scores_at_both_ends_of_the_calendar_are_shown(silverball, folder, zone):
    with Store(folder) as store:
        for when in (datetime(1970, 1, 1, tzinfo=UTC), datetime(9999, 12, 31, 23, 59, 59, tzinfo=UTC)):
            store.add_score("ABC", 5, "arcade", "Random", "d", 7, "", when)
    for arguments in ((), ("--verify",), ("--json",)):
        result = silverball("scores", *arguments, env=os.environ | {"TZ": zone})
        assert result.returncode == ("--verify" in arguments)
        assert "9999" in result.stdout
        assert result.stderr == ""


def test_a_file_that_another_program_holds_is_reported_in_one_sentence(
    silverball, scores, folder, monkeypatch
):
    monkeypatch.setattr("silverball.game.scores.database.BUSY_SECONDS", 0.3)
    with held(folder / FILE, ALONE):
        assert_refused(silverball("scores"), "another program holds it")
    with held(folder / FILE):
        assert len(json.loads(silverball("scores", "--json").stdout)) == len(scores)
        result = silverball("scores", "--remove", "1")
        assert result.returncode == 2
        assert "another program holds it" in result.stderr
        assert "Traceback" not in result.stderr
    assert len(json.loads(silverball("scores", "--json").stdout)) == len(scores)


def test_a_damaged_file_is_quarantined_with_a_sentence(silverball, folder):
    folder.mkdir()
    (folder / FILE).write_bytes(b"hello " * 1000)
    result = silverball("scores")
    assert result.returncode == 0
    assert len(result.stderr.strip().splitlines()) == 1
    assert "is damaged" in result.stderr
    assert silverball("scores").stderr == ""


def test_verify_marks_what_is_not_proven_and_ends_with_1(silverball, folder):
    games = pytest.importorskip("silverball.game.game")
    table = load_table("classic")
    with Store(folder) as store:
        for claimed in (0, 1):
            game = games.Game("classic", seed=5)
            while not game.score:
                if not game.view.on_board:
                    game.create_ball()
                game.step(left=game.tick % 100 < 50, right=game.tick % 100 > 50, ticks=10)
            game.end()
            store.add_score(
                "ABC",
                game.score + claimed,
                "arcade",
                table.name,
                table_digest(table),
                5,
                game.replay.to_text(),
            )
        store.rename(2, "BAD")
    right = silverball("scores", "--verify", "--limit", "1")
    assert right.returncode == 1
    assert f"score 2, {game.score + 1:,} by BAD: not proven: its replay reaches" in right.stdout
    assert "of 2 scores 1 are proven and 1 are not" in right.stdout
    assert "was proven" in silverball("scores").stdout  # a note; only trying again proves it
    assert {row["id"]: row["verified"] for row in json.loads(silverball("scores", "--json").stdout)} == {
        1: True,
        2: False,
    }
    silverball("scores", "--remove", "2")
    left = silverball("scores", "--verify", "--json")
    assert left.returncode == 0
    assert [row["verified"] for row in json.loads(left.stdout)] == [True]
