"""`silverball scores`: what it prints, verifies, writes and removes, and how errors end."""

from __future__ import annotations

import json
import os
import re
import sqlite3
from contextlib import closing
from datetime import UTC, date, datetime
from pathlib import Path

import pytest

from holder import ALONE, held
from silverball.game.scores.daily import daily_seed
from silverball.game.scores.medals import medal_points
from silverball.game.scores.store import FILE, Store
from silverball.table import dump_table, load_table, table_digest


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
        "player": 1,
        "rank": 0,
        "day": None,
        "medal": None,
        "table_rank": 0,
    }


@pytest.fixture
def comet_scores(folder: Path) -> dict[str, int]:
    """Scores on a table with medals: one of a daily board, two of a match, and one in free play."""
    table = load_table("silver_comet")
    points = medal_points(table)
    assert points
    with Store(folder) as store:
        for score, mode, seed, player, rank in (
            (points["silver"], "arcade", daily_seed(date(2026, 1, 2)), 1, 2),
            (points["bronze"], "arcade", 4, 2, 1),
            (points["bronze"] - 1, "arcade", 4, 1, 0),
            (points["gold"], "free", 4, 1, 0),
        ):
            digest, text = table_digest(table), dump_table(table)
            store.add_score(
                "ABC", score, mode, table.name, digest, seed, "", table_text=text, player=player, rank=rank
            )
    return {str(medal): points[medal] for medal in points}


def test_a_list_tells_rank_medals_players_and_the_day(silverball, comet_scores):
    result = silverball("scores", "--mode", "arcade")
    assert (result.returncode, result.stderr) == (0, "")
    assert "rank 3" in result.stdout
    assert "medal: silver" in result.stdout
    assert f"gold at {comet_scores['gold']:,}" in result.stdout
    text = " ".join(result.stdout.split())
    for words in (
        f"{comet_scores['silver']:,} ABC",
        "silver, 2 missions, daily board of 2026-01-02",
        "bronze, 1 mission, player 2 of a match",
    ):
        assert words in text
    assert text.count("bronze") == 1


def test_the_same_is_in_json(silverball, comet_scores):
    rows = json.loads(silverball("scores", "--json").stdout)
    told = [(row["medal"], row["day"], row["player"], row["rank"], row["table_rank"]) for row in rows]
    assert told == [
        ("silver", "2026-01-02", 1, 2, 3),
        ("bronze", None, 2, 1, 3),
        (None, None, 1, 0, 3),
        (None, None, 1, 0, 0),  # free play wins no medals
    ]


def test_a_list_whose_scores_say_nothing_of_it_has_no_such_columns(silverball, scores):
    output = silverball("scores").stdout
    for word in ("medal", "missions", "player", "daily", "rank"):
        assert word not in output


def test_a_medal_needs_the_table_that_the_list_names(silverball, folder):
    table = load_table("silver_comet")
    easy = table.replace(arcade={"bronze": 1, "silver": 2, "gold": 3})
    with Store(folder) as store:
        store.add_score(
            "ABC", 5, "arcade", table.name, table_digest(table), 4, "", table_text=dump_table(easy)
        )
    assert json.loads(silverball("scores", "--json").stdout)[0]["medal"] is None


def test_a_day_chooses_the_scores_of_its_board(silverball, comet_scores):
    rows = json.loads(silverball("scores", "--json", "--day", "2026-01-02").stdout)
    assert [(row["place"], row["score"]) for row in rows] == [(1, comet_scores["silver"])]
    assert "no scores on that board yet" in silverball("scores", "--day", "2026-01-03").stdout
    assert "no scores on that board yet" in silverball("scores", "--day", "today").stdout


@pytest.mark.parametrize("day", ["yesterday", "29.11.2026", "2026-13-01", "\x1b[31m"])
def test_what_is_no_day_is_refused(silverball, comet_scores, day):
    assert_refused(silverball("scores", "--day", day), "--day", "2026-11-29", "today")


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
