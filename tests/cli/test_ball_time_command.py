"""`silverball ball-time`, and the planner in `simulate` and `demo`."""

from __future__ import annotations

import json

import pytest

OF_REFLEX = "ball-time --table random --seed 3 --worlds 40 --seconds 60 --player reflex".split()


def test_the_ball_times_of_a_player_are_printed_with_their_intervals(silverball) -> None:
    report = json.loads(silverball(*OF_REFLEX, "--json").stdout)
    assert report["balls"] == 40 == report["drained"] + report["stalled"] + report["alive"]
    for name in ("mean", "score", "score_per_minute"):
        low, high = report[f"{name}_interval"]
        assert low < report[name] < high
    assert 0 < report["mean"] < report["seconds"] == 60
    text = silverball(*OF_REFLEX).stdout
    assert text.startswith("reflex on random: 40 balls, watched for 60 s at most")
    assert f"mean life so far  {report['mean']:.1f} s (95 %: " in text


def test_a_median_beyond_the_time_is_called_so(silverball) -> None:
    few = "ball-time --worlds 3 --seconds 0.5 --player idle".split()
    assert json.loads(silverball(*few, "--json").stdout)["median"] is None
    assert "median life       beyond 0.5 s" in silverball(*few).stdout


def test_the_planner_plays_in_simulate_and_in_the_demo(silverball, tmp_path) -> None:
    arguments = "simulate --player planner --seconds 3 --tick-rate 60 --json".split()
    first, again = (json.loads(silverball(*arguments).stdout) for _ in range(2))
    assert first["digest"] == again["digest"]
    assert first["balls_drained"] == first["faults"] == 0
    out = tmp_path / "planner.png"
    made = silverball(*"demo --player planner --seconds 1 --size 200 --out".split(), str(out))
    assert made.returncode == 0, made.stderr
    assert out.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("ball-time --balls 2", ("--balls", "silverball ball-time")),
        ("ball-time --seconds 0.01 --tick-rate 10", ("--seconds", "tick")),
        ("ball-time --player planer", ("planner",)),
        ("demo --player planer --out a.png", ("planner",)),
    ],
)
def test_a_mistake_is_one_clear_sentence(silverball, tmp_path, arguments, words) -> None:
    result = silverball(*arguments.split(), cwd=tmp_path)
    assert result.returncode == 2
    assert "Traceback" not in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    for word in words:
        assert word in result.stderr
    assert list(tmp_path.iterdir()) == []
