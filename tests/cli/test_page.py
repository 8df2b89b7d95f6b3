"""`silverball page`, and `silverball replay --out FILE.html`, through the real entry point."""

from __future__ import annotations

import re

import pytest

from silverball.game.game import Game


@pytest.fixture
def saved(tmp_path):
    """A replay in a file."""
    game = Game("classic", seed=5)
    game.create_ball()
    game.step(left=True, ticks=500)
    path = tmp_path / "game.replay"
    game.replay.save(path)
    return path


def test_a_table_becomes_a_page(silverball, tmp_path):
    made = silverball("page", "--table", "classic", "--size", "200", "--out", "a.html", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert re.fullmatch(r"a\.html: 0\.\d\d MB, opens in any browser\n", made.stdout)
    assert "<title>Classic – Silverball</title>" in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_a_page_is_called_pinball_and_is_not_overwritten(silverball, tmp_path):
    assert silverball("page", "--size", "120", cwd=tmp_path).returncode == 0
    again = silverball("page", "--size", "120", cwd=tmp_path)
    assert again.returncode == 2
    assert "pinball.html: this file exists" in again.stderr
    assert silverball("page", "--size", "120", "--force", cwd=tmp_path).returncode == 0


def test_both_commands_make_the_same_page_of_a_replay(silverball, tmp_path, saved):
    one = silverball("page", "--replay", str(saved), "--size", "160", "--out", "a.html", cwd=tmp_path)
    other = silverball("replay", str(saved), "--size", "160", "--out", "b.html", cwd=tmp_path)
    assert (one.returncode, other.returncode) == (0, 0), one.stderr + other.stderr
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_a_page_shows_a_game_of_a_player(silverball, tmp_path):
    made = silverball(
        *"page --player reflex --seconds 2 --table random --seed 4 --size 120 --out p.html".split(),
        cwd=tmp_path,
    )
    assert made.returncode == 0, made.stderr


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ("--replay FILE --seed 3", "--replay brings its own game; leave --seed out"),
        ("--replay FILE --table classic --player idle", "leave --table and --player out"),
        ("--seconds 3", "--seconds is the length of the game of a --player; name one, or leave it out"),
        ("--theme pink", "--theme must be one of neon, parlour, clear, got 'pink'"),
        ("--out a.gif", "a.gif: the name must end in .html, got '.gif'"),
        ("--player nobody", "no player is called 'nobody'"),
    ],
)
def test_options_that_say_nothing_are_refused(silverball, tmp_path, saved, options, sentence):
    done = silverball("page", *options.replace("FILE", str(saved)).split(), cwd=tmp_path)
    assert done.returncode == 2
    assert sentence in done.stderr
    assert list(tmp_path.glob("*.html")) == []


@pytest.mark.parametrize("option", [("--from", "1"), ("--seconds", "1")])
def test_a_page_shows_a_whole_replay(silverball, tmp_path, saved, option):
    done = silverball("replay", str(saved), "--out", "a.html", *option, cwd=tmp_path)
    assert done.returncode == 2
    assert "a page shows the whole game; leave --from and --seconds out" in done.stderr
