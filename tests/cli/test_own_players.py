"""Registered players and those of installed packages on the command line."""

from __future__ import annotations

import json
import os

import pytest

from own_players import LEFTY, Swatter, install
from silverball.players import register

pytestmark = pytest.mark.usefixtures("unregistered")


def test_a_registered_player_plays_in_simulate_ball_time_and_demo(silverball, tmp_path) -> None:
    register("swatter", Swatter)
    played = silverball(*"simulate --player swatter --seconds 20 --tick-rate 60 --worlds 2 --json".split())
    report = json.loads(played.stdout)
    assert (report["player"], report["faults"]) == ("swatter", 0)
    assert report["score"] > 0
    timed = silverball(*"ball-time --player swatter --worlds 2 --seconds 5 --tick-rate 60".split())
    assert timed.stdout.startswith("swatter on classic: 2 balls"), timed.stderr
    made = silverball(*"demo --player swatter --seconds 0.5 --size 200 --out a.png".split(), cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_the_player_of_an_installed_package_plays_in_a_process_of_its_own(silverball, tmp_path) -> None:
    install(tmp_path, "left-hand", "lefty = left_hand:Lefty", LEFTY)
    env = os.environ | {"PYTHONPATH": str(tmp_path)}
    played = silverball(*"simulate --player lefty --seconds 1 --json".split(), env=env)
    assert played.returncode == 0, played.stderr
    assert json.loads(played.stdout)["player"] == "lefty"
    wrong = silverball(*"simulate --player leftie --seconds 1".split(), env=env)
    assert wrong.returncode == 2
    assert "trained, lefty; did you mean 'lefty'?" in wrong.stderr


@pytest.mark.parametrize("arguments", ["simulate", "ball-time", "demo --out a.png"])
def test_a_player_that_cannot_be_imported_is_one_sentence(silverball, site, tmp_path, arguments) -> None:
    install(site, "left-hand", "lefty = left_hand:Lefty", "import nowhere_at_all")
    refused = silverball(*arguments.split(), "--player", "lefty", cwd=tmp_path)
    assert refused.returncode == 2
    assert refused.stdout == ""
    assert "player 'lefty' of left-hand: left_hand:Lefty cannot be imported, ModuleNotFound" in refused.stderr
    assert "Traceback" not in refused.stderr
    assert not (tmp_path / "a.png").exists()
