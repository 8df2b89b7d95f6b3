"""Are the environments compared as the table says?"""

from __future__ import annotations

import json

import pytest

from silverball.benchmarks.envs import environments, measure, rate_table
from silverball.benchmarks.envs.environments import Candidate
from silverball.cli.app import run


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Few environments and short rounds: what is measured is not the point here."""
    monkeypatch.setattr(environments, "BOARDS", 2)
    monkeypatch.setattr(environments, "SINGLE_STEPS", 20)
    monkeypatch.setattr(environments, "STATES", [(3, {"threads": 1}), (3, {"zero_copy": True})])
    monkeypatch.setattr(environments, "GAMES", [(1, {}), (3, {"threads": 1, "rules": False})])
    monkeypatch.setattr(environments, "PICTURES", [(1, 2, {}), (4, 2, {"frame_skip": 4})])
    monkeypatch.setattr(measure, "MIN_ROUND_TIME", 1e-4)
    monkeypatch.setattr(measure, "WARM_UP", 2)


class Clock:
    """A clock that goes on by what those who are measured say that they take."""

    def __init__(self) -> None:
        self.now = 0.0

    def perf_counter(self) -> float:
        return self.now

    def sleeper(self, seconds: float, steps: int, **about) -> Candidate:
        def sleep() -> None:
            self.now += seconds

        return Candidate(f"{steps} steps in {seconds} s", lambda: (sleep, steps), **about)


@pytest.fixture
def clock(monkeypatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(measure, "time", clock)
    return clock


def absent() -> environments.Workload:
    raise ModuleNotFoundError("No module named 'elsewhere'")


def test_ours_are_all_measured():
    ours = [one for one in environments.candidates() if one.ours]
    result = measure.run(2, chosen=ours)
    assert [rate.name for rate in result.rates] == [one.name for one in ours]
    assert all(rate.value > 0 for rate in result.rates)
    for rate in result.rates:
        assert rate.slowest <= rate.value if rate.unit == "steps/s" else rate.slowest >= rate.value
    assert result.missing == []
    assert {"Python", "silverball", "gymnasium", "numba"} <= result.versions.keys()


def test_a_call_of_many_steps_counts_as_many(clock):
    one, ten = measure.run(3, chosen=[clock.sleeper(2e-3, 1), clock.sleeper(2e-3, 10)]).rates
    assert (one.value, ten.value) == pytest.approx((500.0, 5000.0))
    call = measure.run(3, chosen=[clock.sleeper(2e-3, 10, unit="µs")]).rates[0]
    assert (call.value, call.slowest) == pytest.approx((200.0, 200.0))


def test_the_median_round_counts(clock, monkeypatch):
    slow = iter(
        [0.0, 0.0, 0.0, 1e-3, 0.0, 9e-3, 1e-3, 2e-3]
    )  # two to warm up, one to count calls, five rounds

    def step() -> None:
        clock.now += 1e-3 + next(slow)

    result = measure.run(5, chosen=[Candidate("uneven", lambda: (step, 1))])
    assert result.rates[0].value == pytest.approx(1 / 2e-3)
    assert result.rates[0].slowest == pytest.approx(1 / 10e-3)


def test_who_is_not_installed_is_named_and_left_out(clock):
    strangers = [
        Candidate("elsewhere", absent, ours=False, yardstick="Elsewhere", package="elsewhere"),
        Candidate("elsewhere, twice", absent, ours=False, package="elsewhere"),
    ]
    heard = []
    result = measure.run(1, heard.append, [clock.sleeper(1e-4, 1), *strangers])
    assert len(result.rates) == 1
    assert result.missing == ["elsewhere"]
    assert heard == [one.name for one in (clock.sleeper(1e-4, 1), *strangers)]
    assert "Not installed: elsewhere." in rate_table.footer(result)
    assert rate_table.headers(rate_table.yardsticks(result)) == ["environment", "steps/s"]


def rate(value: float, sees: str, ours: bool = True, yardstick: str = "", unit: str = "steps/s"):
    return measure.Rate(f"{sees} {value}", value, value, unit, sees, ours, yardstick)


RESULT = measure.Result(
    [
        rate(5000.0, "state"),
        rate(200.0, "pictures"),
        rate(0.5, "", unit="µs"),
        rate(10.0, "pictures", ours=False, yardstick="Atari"),
        rate(1000.0, "state", ours=False, yardstick="breakout"),
        rate(400.0, "state", ours=False),
    ],
    5,
    [],
    "a machine",
    {"Python": "3"},
)


def test_pictures_are_not_compared_with_states_but_states_with_pictures():
    atari, breakout = rate_table.yardsticks(RESULT)
    assert [rate_table.ratio(one, atari) for one in RESULT.rates] == [500.0, 20.0, None, 1.0, None, None]
    assert [rate_table.ratio(one, breakout) for one in RESULT.rates] == [5.0, None, None, None, 1.0, None]


def test_the_table_is_told_in_markdown_and_in_json():
    lines = rate_table.markdown(RESULT).splitlines()
    assert lines[0] == "| environment | steps/s | beside Atari | beside breakout |"
    assert lines[2] == "| state 5000.0 | 5,000 | 500 × | 5.00 × |"
    assert lines[3] == "| pictures 200.0 | 200 | 20 × |  |"
    assert lines[4] == "|  0.5 | 0.500 µs |  |  |"
    assert len({line.count("|") for line in lines[:8]}) == 1
    assert lines[9] == "Medians of 5 rounds, random actions; a machine; Python 3."
    told = json.loads(rate_table.as_json(RESULT))
    assert told["rates"][0]["beside"] == {"Atari": 500.0, "breakout": 5.0}
    assert told["rates"][2]["beside"] == {"Atari": None, "breakout": None}


def test_the_command_writes_the_table(tmp_path, monkeypatch, capsys):
    idle = Candidate("idle", lambda: (lambda: None, 1), ours=False, yardstick="an idler")
    monkeypatch.setattr(environments, "others", lambda: [idle])
    place = tmp_path / "envs.md"
    assert run(["bench", "envs", "--rounds", "1", "--out", str(place)]) == 0
    told = capsys.readouterr()
    assert "beside an idler" in place.read_text(encoding="utf-8")
    assert "one, through gymnasium.make" in told.out
    assert f"wrote {place}" in told.err


def test_another_ending_is_refused_before_anything_is_measured(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(measure, "run", None)
    assert run(["bench", "envs", "--out", str(tmp_path / "envs.png")]) == 2
    assert "the name must end in .md" in capsys.readouterr().err
