"""The commands of `silverball bench` that print figures: each prints its own, with units."""

from __future__ import annotations

import json
from functools import partial

import pytest

import browser
from commandline import ran
from silverball.app import window
from silverball.benchmarks import domain_speed, replays, shot_rates, thresholds


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


def test_rules_are_timed_against_bare_worlds_in_the_same_situation():
    found = figures("rules", "--table", "classic", "--worlds", "64", "--rounds", "20")
    plain, ruled = (found[f"a frame {how} rules"] for how in ("without", "with"))
    assert plain[0] > 0.0
    idle = found["a frame of games in which no rule listens"]
    assert (plain[1], idle[1], ruled[1]) == ("ns", "ns", "ns")
    assert found["a frame takes longer with rules by"][1] == "%"
    assert found["a frame takes longer by, if no rule listens"][1] == "%"
    assert found["games with a ball in play"][0] > 90.0  # the next ball comes by itself


def test_replays_are_measured_verified_and_sought_in(monkeypatch):
    monkeypatch.setattr(replays, "GAME_SECONDS", 2.0)
    monkeypatch.setattr(replays, "ROUNDS", 1)
    monkeypatch.setattr(replays, "SEEKS", 5)
    found = figures("replays", "--minutes", "0.1")
    assert found["frantic: size per minute"][0] > found["reflex, arcade: size per minute"][0] > 0.0
    assert found["frantic: verified at real time"][0] > 1.0
    assert 0.0 < found["0.1 min, frantic: a seek, median"][0] <= found["0.1 min, frantic: a seek, 99 %"][0]


def test_thresholds_have_an_interval(monkeypatch):
    monkeypatch.setattr(thresholds, "FIRST_IDS", thresholds.FIRST_IDS[:1])
    found = figures("thresholds", "--episodes", "2")
    assert list(found) == [thresholds.FIRST_IDS[0], f"{thresholds.FIRST_IDS[0]}, ± 95 %"]
    assert found[thresholds.FIRST_IDS[0]][0] > 0.0


def test_the_pinball_domain_is_faster_than_its_published_rules_in_numpy(monkeypatch):
    monkeypatch.setattr(domain_speed, "MANY", 64)
    monkeypatch.setattr(domain_speed, "STEPS", 500)
    monkeypatch.setattr(domain_speed, "RULES_STEPS", 20)
    found = figures("domain", "--board", "wall", "--rounds", "1")
    rates = [
        found[f"wall, {name}"]
        for name in ("one environment", "64 environments", "the published rules in NumPy")
    ]
    assert {unit for _, unit in rates} == {"steps/s"}
    assert rates[0][0] > 3.0 * rates[2][0]


def test_a_well_timed_press_makes_more_shots_than_none(monkeypatch):
    monkeypatch.setattr(shot_rates, "STEPS", 40)
    found = figures("shots", "--episodes", "8")
    assert found["nothing"] == (0.0, "%")
    assert found["the best press"][0] > 10.0
    assert found["the best press, ± 95 %"][0] > 0.0


@pytest.mark.skipif(bool(browser.MISSING), reason=browser.MISSING)
def test_a_page_is_played_and_timed():
    found = figures("page", "--table", "classic", "--pictures", "30", "--size", "390", "844")
    assert 1.0 < found["size of the page"][0] < 2.0
    assert found["pictures"][0] > 0.0
    work = [found[f"work of a picture, {which}"][0] for which in ("median", "99 %", "longest")]
    assert 0.0 < work[0] <= work[1] <= work[2]


def test_a_page_is_not_timed_without_a_browser(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("SILVERBALL_CHROMIUM", raising=False)
    result = ran("bench", "page", "--table", "classic")
    assert result.returncode == 2
    assert "install Debian's package chromium" in " ".join(result.stderr.split())


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
