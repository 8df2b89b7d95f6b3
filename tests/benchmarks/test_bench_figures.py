"""`silverball bench planner|replays|thresholds|window`: each prints its figures, with units."""

from __future__ import annotations

import json
from functools import partial

import pytest

from commandline import ran
from silverball.app import window
from silverball.benchmarks import replays, thresholds


def figures(*arguments: str) -> dict[str, tuple[float, str]]:
    """The figures that a benchmark prints, by name."""
    result = ran("bench", *arguments, "--json")
    assert result.returncode == 0, result.stderr
    return {one["name"]: (one["value"], one["unit"]) for one in json.loads(result.stdout)}


def test_the_planner_is_timed_at_every_decision():
    found = figures("planner", "--seconds", "0.5")
    assert found["decisions"][0] == 30
    for kind in ("processor time", "wall time"):
        mean, longest = (found[f"{kind} of a decision, {which}"] for which in ("mean", "longest"))
        assert 0.0 < mean[0] <= longest[0]
        assert mean[1] == "ms"
    assert found["steps of a decision, longest"][0] > 100


def test_fewer_branches_take_fewer_steps():
    few, many = (
        figures("planner", "--seconds", "0.5", *options) for options in (("--branches", "2"), ())
    )  # fmt: skip
    assert few["steps of a decision, mean"][0] < 0.5 * many["steps of a decision, mean"][0]


def test_replays_are_measured_verified_and_sought_in(monkeypatch):
    monkeypatch.setattr(replays, "GAME_SECONDS", 2.0)
    monkeypatch.setattr(replays, "ROUNDS", 1)
    monkeypatch.setattr(replays, "SEEKS", 5)
    found = figures("replays", "--minutes", "0.1")
    assert found["frantic: size per minute"][0] > found["reflex, arcade: size per minute"][0] > 0.0
    assert found["frantic: verified at real time"][0] > 1.0
    assert 0.0 < found["0.1 min, frantic: a seek, median"][0] <= found["0.1 min, frantic: a seek, 99 %"][0]


def test_thresholds_have_an_interval(monkeypatch):
    monkeypatch.setattr(thresholds, "IDS", list(thresholds.IDS)[:1])
    found = figures("thresholds", "--episodes", "2")
    assert list(found) == [thresholds.IDS[0], f"{thresholds.IDS[0]}, ± 95 %"]
    assert found[thresholds.IDS[0]][0] > 0.0


@pytest.mark.parametrize("player", [(), ("--player", "planner")])
def test_the_window_is_played_and_timed(monkeypatch, player):
    small = partial(window.Window, height=300, without_display=True)
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setattr(window, "Window", small)
    found = figures("window", "--seconds", "1", *player)
    assert 1.0 < found["frames, dummy"][0] <= 61.0
    assert found["work per frame, 50 %"][0] <= found["work per frame, longest"][0]
    assert 0.0 < found["start of Python to first picture"][0] <= found["start of Python to play"][0]
    timed = {name.split(",")[0] for name in found}
    assert ("a decision" in timed) == bool(player)
    assert not player or "button to tick" not in timed  # a second may be too short for a press
