"""`silverball replay` through the real entry point: what it prints, how it ends, and the films it makes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image, ImageSequence

import silverball as sb
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.view import Mode


@pytest.fixture(scope="module")
def played() -> Game:
    """A short game with presses, a shove and two balls."""
    game = Game("classic", 5, Mode.FREE)
    game.create_ball()
    for second in range(6):
        game.step(True, second % 2 == 0, 100)
        if second == 3:
            game.create_ball()
            game.jitter()
        game.step(False, False, 140)
    return game


@pytest.fixture
def good(played: Game, tmp_path: Path) -> str:
    path = tmp_path / "good.replay"
    path.write_text(played.replay.to_text(), encoding="utf-8")
    return str(path)


def with_other_press(game: Game) -> Replay:
    """The replay with one press of its third second a tick later."""
    lines = list(game.replay.lines)
    digests, inputs = lines[2].split(" ")
    assert inputs.startswith("a")
    lines[2] = f"{digests} b{inputs[1:]}"
    return replace(game.replay, lines=tuple(lines))


def test_verify_ends_with_0_for_a_true_replay(silverball, good: str, played: Game):
    result = silverball("replay", good, "--verify")
    assert result.returncode == 0, result.stderr
    assert f"equal in all 1440 ticks (6.0 s), score {played.score}" in result.stdout


def test_verify_ends_with_1_and_names_tick_and_field_where_it_differs(
    silverball, played: Game, tmp_path: Path
):
    path = tmp_path / "other.replay"
    path.write_text(with_other_press(played).to_text(), encoding="utf-8")
    result = silverball("replay", str(path), "--verify")
    assert result.returncode == 1
    assert "tick 720 (equal up to tick 480), " in result.stdout
    assert "expected" in result.stdout
    assert result.stderr == ""


def test_against_another_replay_names_the_very_tick_the_field_and_both_values(
    silverball, good: str, played: Game, tmp_path: Path
):
    path = tmp_path / "other.replay"
    path.write_text(with_other_press(played).to_text(), encoding="utf-8")
    result = silverball("replay", good, "--against", str(path), "--json")
    assert result.returncode == 1
    report = json.loads(result.stdout)["against"]
    assert (report["tick"], report["seen"]) == (480, 481)
    assert report["field"].startswith("paddle[")
    assert report["expected"] != report["got"]
    same = silverball("replay", good, "--against", good)
    assert (same.returncode, "the same game" in same.stdout) == (0, True)


def test_json_has_the_facts_of_the_replay(silverball, good: str, played: Game):
    result = silverball("replay", good, "--verify", "--json")
    report = json.loads(result.stdout)
    assert result.returncode == 0
    assert report["verify"]["ok"]
    expected = {"mode": "free", "table": "Classic", "seed": 5, "ticks": 1440, "ended": "running"}
    assert expected.items() <= report.items()
    assert report["score"] == played.score


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda text: text[: len(text) // 2], "cut off"),
        (lambda text: text.replace("score = ", "score = 9"), "changed or damaged"),
        (lambda text: text.replace("replay 1", "replay 9", 1), "newer Silverball"),
        (lambda _: "hello\n", "this is not a replay"),
        (lambda _: "", "empty"),
    ],
)
def test_a_bad_file_ends_with_2_and_one_sentence(silverball, good: str, damage, words: str):
    path = Path(good)
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    result = silverball("replay", good, "--verify")
    assert (result.returncode, result.stdout) == (2, "")
    assert words in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("options", [["--json"], ["--out", "film.gif"], []])
def test_a_bad_file_is_refused_whatever_is_asked_of_it(silverball, good: str, options: list[str]):
    path = Path(good)
    path.write_text("hello\n", encoding="utf-8")
    result = silverball("replay", good, *options, cwd=path.parent)
    assert (result.returncode, result.stdout) == (2, "")
    assert "this is not a replay" in result.stderr
    assert not (path.parent / "film.gif").exists()


def test_a_missing_file_ends_with_2(silverball, tmp_path: Path):
    result = silverball("replay", "nothing.replay", "--verify", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (
        2,
        "nothing.replay: there is no such file: check the path\n",
    )


def test_a_film_of_a_part_is_made(silverball, good: str, tmp_path: Path):
    film = tmp_path / "part.gif"
    result = silverball("replay", good, *f"--out {film} --from 2 --seconds 1.2 --size 200".split())
    assert result.returncode == 0, result.stderr
    assert f"wrote {film}" in result.stdout
    with Image.open(film) as image:
        shown = [frame.info["duration"] for frame in ImageSequence.Iterator(image)]
        assert sum(shown) == 1200
        assert image.size[1] == 200


def test_a_picture_shows_the_moment_asked_for(silverball, good: str, tmp_path: Path):
    names = {}
    for moment in (1.0, 5.0):
        names[moment] = tmp_path / f"{moment}.png"
        result = silverball("replay", good, *f"--out {names[moment]} --seconds {moment} --size 200".split())
        assert result.returncode == 0, result.stderr
    assert names[1.0].read_bytes() != names[5.0].read_bytes()


def test_a_film_from_beyond_the_end_is_refused(silverball, good: str, tmp_path: Path):
    result = silverball("replay", good, *f"--out {tmp_path / 'x.gif'} --from 6".split())
    assert (result.returncode, "before the game's end at 6.00 s" in result.stderr) == (2, True)


def test_last_names_the_last_game(silverball, played: Game, tmp_path: Path, monkeypatch):
    store = pytest.importorskip("silverball.game.scores.store")
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path))
    result = silverball("replay", "last", "--verify")
    assert (result.returncode, "no last game" in result.stderr) == (2, True)
    with store.Store() as kept:
        kept.save_last_game(played.replay.to_text())
    result = silverball("replay", "last", "--verify")
    assert result.returncode == 0, result.stderr


class Nothing(sb.FreeRules):
    """Nothing scores."""

    name = "nothing"

    def hit(self, config, state, tick, points, part):
        return state, ()


@pytest.mark.parametrize("options", [["--verify"], ["--out", "film.gif"]])
def test_a_replay_with_rules_of_its_own_ends_with_2_and_says_what_it_needs(
    silverball, tmp_path: Path, options: list[str]
):
    game = sb.Game("classic", rules=Nothing())
    game.create_ball()
    game.step(ticks=300)
    game.replay.save(tmp_path / "own.replay")
    result = silverball("replay", "own.replay", *options, cwd=tmp_path)
    assert (result.returncode, result.stdout) == (2, "")
    assert "custom rules, 'nothing'" in result.stderr
    assert "replay.verify(rules=…)" in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["own.replay"]
