"""Targets and ranges of a design, as they are written on the command line."""

from __future__ import annotations

import math

import pytest

from silverball import load_table
from silverball.errors import SilverballError
from silverball.metrics.statistics import Estimate
from silverball.studies.goals import figure_names, parse_range, parse_target, usual_ranges
from silverball.studies.summary import ArmSummary
from silverball.studies.table_change import changed

CLASSIC = load_table("classic")


@pytest.mark.parametrize(
    "text", ["ball_time=30±2", "ball_time = 30 ± 2", "ball_time=30+-2", "ball_time=3e1+/-2.0"]
)
def test_a_target_is_read_as_people_write_it(text):
    target = parse_target(text)
    assert (target.figure, target.value, target.within) == ("seconds_per_ball", 30.0, 2.0)
    assert str(target) == "ball_time=30±2"


def test_a_target_is_reached_within_its_distance():
    target = parse_target("ball_time=30±2")
    for value, miss in ((30.0, 0.0), (32.0, 1.0), (26.0, 2.0), (math.nan, math.inf), (math.inf, math.inf)):
        assert target.miss({"seconds_per_ball": Estimate(value, 0.0, 1.0)}) == miss
    assert target.miss({}) == math.inf


@pytest.mark.parametrize(
    "text", ["", "ball_time", "ball_time=30", "ball_time=30±", "ball_time=x±2", "ball_time=30±0",
             "ball_time=30±-1", "ball_time=nan±1", "ball_time=30±inf", "=30±2"]
)  # fmt: skip
def test_what_is_no_target_is_refused(text):
    with pytest.raises(SilverballError, match="expected FIGURE=VALUE±DISTANCE, for example ball_time=30±2"):
        parse_target(text)


def test_an_unknown_figure_is_refused_with_the_nearest_name():
    with pytest.raises(SilverballError, match=r"'ball_tme'; did you mean 'ball_time'\?"):
        parse_target("ball_tme=30±2")


def test_every_figure_of_a_study_can_be_a_target():
    summary = ArmSummary()
    assert summary.games == 0
    for name in figure_names():
        assert parse_target(f"{name}=1±1").name == name


def test_a_range_is_of_a_number_of_the_table():
    one = parse_range("paddle.length=1.8:2.4", CLASSIC)
    assert (one.at(0.0), one.at(0.5), one.at(1.0), one.at(7.0)) == (1.8, 2.1, 2.4, 2.4)
    whole = parse_range("random.cylinders=0:5", load_table("random"))
    assert [whole.at(share) for share in (0.0, 0.29, 0.31, 0.99)] == [0, 1, 2, 5]
    assert all(isinstance(whole.at(share), int) for share in (0.0, 0.3))


@pytest.mark.parametrize(
    "text", ["", "paddle.length", "paddle.length=2", "paddle.length=2:1", "paddle.length=1:x"]
)
def test_what_is_no_range_is_refused(text):
    with pytest.raises(SilverballError, match="expected PATH=LEAST:GREATEST"):
        parse_range(text, CLASSIC)


def test_a_range_of_whole_numbers_has_whole_ends():
    with pytest.raises(SilverballError, match=r"this is a whole number, got '0:2\.5'"):
        parse_range("random.cylinders=0:2.5", load_table("random"))


@pytest.mark.parametrize("name", ["classic", "random", "silver_comet"])
def test_the_usual_ranges_hold_what_the_table_has(name):
    table = load_table(name)
    for one in usual_ranges(table):
        assert one.low < one.high
        changed(table, one.path, one.at(0.5))
