"""The examples that need nothing but Silverball: short, and every one of them runs."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

from silverball.players import registered_names, unregister

EXAMPLES = Path(__file__).parents[1] / "examples"
SHOWN = {
    "listen.py": "hits",
    "make_table.py": "did you mean",
    "record_replay.py": "equal in all",
    "thousand_worlds.py": "branches",
    "picture.py": "table.png",
    "own_player.py": "sleepy kept the ball",
    "own_scoring.py": "points for",
    "own_reward.py": "callable:",
}
LINES = 25  # of code; blank lines count


@pytest.fixture(autouse=True)
def _no_players_left():
    yield
    for name in registered_names():
        unregister(name)


def test_every_short_example_is_run():
    names = {path.name for path in EXAMPLES.glob("*.py")}
    assert {name for name in names if not name.startswith(("train_", "collect_"))} == set(SHOWN)


@pytest.mark.parametrize("name", SHOWN)
def test_an_example_is_short_and_runs(name: str, tmp_path, monkeypatch, capsys):
    path = EXAMPLES / name
    assert len(path.read_text(encoding="utf-8").splitlines()) <= LINES
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert SHOWN[name] in capsys.readouterr().out
