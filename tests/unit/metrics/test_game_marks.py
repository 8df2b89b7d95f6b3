"""The marks of a table: what is noted of whole games, and what is made of it."""

from __future__ import annotations

import json

import numpy as np
import pytest

import silverball as sb
from silverball.cli.marks import build_report, print_report
from silverball.game.game_batch import GameBatch
from silverball.metrics.game_marks import Mark, measure_marks
from silverball.metrics.marked_games import NEVER_RAN, STEP, play_marked_games
from silverball.metrics.statistics import UNKNOWN, Estimate, quotient

TABLE = sb.load_table("silver_comet")


def test_games_that_are_noted_are_the_games_of_a_batch_and_every_ball_is_lost_by_one_way():
    noted = play_marked_games(TABLE, "idle", 20, seed=5)
    assert noted.games["over"].all()
    lost = noted.mark["by_outlane"] + noted.mark["by_centre"]
    assert (lost >= 3).all()  # some are saved
    assert (lost <= 8).all()
    batch = GameBatch(TABLE, 20, 5)
    again = play_marked_games(TABLE, "idle", 20, seed=5)
    assert np.array_equal(noted.games, again.games)
    assert len(batch.books.modes[0]) == noted.modes.shape[1]
    skill = batch.books.modes[0].index("skill")
    assert (noted.modes[:, skill] >= 0).all()
    multiball = batch.books.modes[0].index("multiball")
    assert (noted.modes[:, multiball] == NEVER_RAN).all()


def test_time_in_play_does_not_count_a_ball_that_lies_on_the_plunger():
    def minutes(longest: float) -> float:
        return float(play_marked_games(TABLE, "idle", 4, longest=longest).minutes.sum())

    assert minutes(0.3) == 0.0  # the plunger is pulled for longer
    assert minutes(4.0) > 0.0
    assert STEP / 240 < 0.02


def test_a_mark_is_met_within_its_limits():
    def mark(value: float, low: float, high: float) -> Mark:
        return Mark("a mark", Estimate(value, value, value), low, high)

    assert mark(8.0, 8.0, 15.0).is_met
    assert mark(0.0, 0.0, 0.0).is_met
    assert not mark(16.0, 8.0, 15.0).is_met
    assert not mark(7.9, 8.0, 15.0).is_met


def test_silver_comet_meets_the_marks_of_players_that_do_not_aim():
    measured = measure_marks(TABLE, 300, players=("idle", "random", "beginner"))
    assert len(measured.marks) == 7
    assert not [mark for mark in measured.marks if not mark.is_met and "that no player" not in mark.name]
    random, beginner = measured.players["random"], measured.players["beginner"]
    assert beginner.figures["points_per_minute"].low > 1.2 * random.figures["points_per_minute"].high


def test_a_beginner_wins_a_mission_in_half_of_the_games_and_often_sees_a_multiball():
    (found,) = measure_marks(TABLE, 300, players=("beginner",)).players.values()
    assert 0.4 < found.reached["rank (counter)"].value < 0.7
    assert 0.2 < found.reached["multiball"].value < 0.45
    assert found.reached["silver comet"].value < 0.02
    assert found.seeds["skill"] == 0


def test_a_seed_leads_to_a_game_in_which_it_is_seen():
    seen = measure_marks(TABLE, 40, players=("beginner",)).players["beginner"]
    (again,) = measure_marks(TABLE, 2, seed=seen.seeds["multiball"], players=("beginner",)).players.values()
    assert again.seeds["multiball"] == seen.seeds["multiball"]
    assert seen.games.modes[seen.seeds["multiball"]].max() > 0


def test_the_report_says_in_which_game_a_mode_was_seen(capsys):
    players = ("idle", "random", "beginner")
    report = build_report(measure_marks(TABLE, 20, seed=100, players=players))
    assert json.loads(json.dumps(report)) == report
    seen = report["players"]["random"]["first_seeds"]["storm of Mars"]
    assert 100 <= seen < 120
    print_report({"table": "silver_comet", "seed": 100, "games": 20, "planner_games": 0} | report)
    lines = capsys.readouterr().out.splitlines()
    (line,) = [line for line in lines if line.strip().startswith("silver comet ")]
    assert line.rstrip().endswith("none")
    (line,) = [line for line in lines if line.strip().startswith("skill  ")]
    assert line.rstrip().endswith("idle, seed 100")


def test_a_quotient_has_the_interval_of_repeated_experiments():
    rng = np.random.default_rng(0)
    above, below = rng.normal(100.0, 2.0, 100_000), rng.normal(10.0, 0.3, 100_000)
    low, high = np.quantile(above / below, [0.025, 0.975]).tolist()
    found = quotient(
        Estimate(100.0, 100.0 - 1.96 * 2.0, 100.0 + 1.96 * 2.0),
        Estimate(10.0, 10.0 - 1.96 * 0.3, 10.0 + 1.96 * 0.3),
    )
    assert found.value == pytest.approx(10.0)
    assert found.low == pytest.approx(low, rel=0.01)
    assert found.high == pytest.approx(high, rel=0.01)
    assert quotient(found, Estimate(0.0, 0.0, 0.0)) == UNKNOWN
