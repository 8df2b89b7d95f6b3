"""The benchmark of agents: rhythms, contestants, trials and the table of results."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from silverball.benchmarks.agents import results_table, rhythms
from silverball.benchmarks.agents.contestants import CONTESTANTS
from silverball.benchmarks.agents.lookahead import Lookahead
from silverball.benchmarks.agents.rhythms import RHYTHMS, Blind, Heard, RandomPresses, Rhythm
from silverball.benchmarks.agents.trials import Trial, make_trial, play_trial
from silverball.metrics.statistics import Estimate

CLASSIC, BOARDS = "silverball/PinballClassic-v1", "silverball/Pinball-v1"


def test_there_are_two_hundred_different_rhythms():
    presses = {tuple(rhythm.action(step) for step in range(240)) for rhythm in RHYTHMS}
    assert len(RHYTHMS) == len(presses) == 200


def test_a_rhythm_holds_its_buttons_for_as_long_as_it_says():
    assert [Rhythm("both", 1, 2).action(step) for step in range(6)] == [3, 0, 0, 3, 0, 0]
    assert [Rhythm("left", 2, 1).action(step) for step in range(4)] == [1, 1, 0, 1]
    assert [Rhythm("in turn", 1, 3).action(step) for step in range(8)] == [1, 0, 2, 0, 1, 0, 2, 0]


def test_a_trial_plays_each_test_board_once_and_counts_strokes():
    envs = make_trial(BOARDS, 6, "test", time_limit=6.0)
    assert envs._engine.pool.seeds.tolist() == list(range(1_000_000, 1_000_006))
    trial = play_trial(lambda own: Blind(Rhythm("both", 2, 2), own), envs, 5)
    idle = play_trial(CONTESTANTS["idle"], envs, 5)
    assert (trial.scores >= 0).all()
    assert ((trial.seconds > 0.0) & (trial.seconds <= 6.0)).all()
    assert (idle.strokes == 0).all()
    strokes = trial.strokes / np.maximum(trial.seconds, 1.0)
    assert 0.5 < strokes.mean() <= 1.0 / 0.8 + 0.2


def test_the_same_trial_gives_the_same_scores():
    envs = make_trial(CLASSIC, 8, "test", time_limit=10.0)
    first, second = (play_trial(RandomPresses, envs, 3) for _ in range(2))
    assert first.scores.tolist() == second.scores.tolist()
    assert play_trial(RandomPresses, envs, 4).scores.tolist() != first.scores.tolist()


def test_reflex_makes_more_than_the_best_rhythm():
    envs = make_trial(CLASSIC, 200, "test", time_limit=20.0)
    blind, reflex = (play_trial(CONTESTANTS[name], envs, 0).scores.mean() for name in ("blind", "reflex"))
    assert reflex > 1.5 * blind


def test_the_planner_keeps_the_ball_longer_than_random_presses():
    envs = make_trial(CLASSIC, 3, "test", time_limit=8.0)
    before = envs.save_state()
    planned, random = (play_trial(entrant, envs, 20) for entrant in (Lookahead, RandomPresses))
    assert planned.seconds.mean() > random.seconds.mean()
    assert planned.scores.mean() > random.scores.mean()
    assert before.shape == envs.save_state().shape


def test_the_planner_does_not_move_the_environments():
    envs = make_trial(CLASSIC, 2, "test")
    observations, _ = envs.reset(seed=0)
    before = envs.save_state()
    Lookahead(envs).act(observations, 0)
    np.testing.assert_array_equal(envs.save_state(), before)


def trial_of(*scores):
    count = len(scores)
    return Trial(np.array(scores), np.full(count, 10.0), np.full(count, 5))


def test_scores_are_scaled_from_blind_to_planner(tmp_path):
    trials = {
        "blind": [trial_of(100, 100, 100, 100)],
        "ppo": [trial_of(200, 200, 200, 200), trial_of(400, 400, 400, 400)],
        "planner": [trial_of(500, 500, 500, 500)],
    }
    blind, ppo, planner = results_table.summarise(trials)
    assert (blind.score, ppo.score, planner.score) == (0.0, 0.5, 1.0)
    assert (ppo.runs, ppo.balls, ppo.strokes) == (2, 4, 0.5)
    assert "| ppo | 2 × 4 | 300" in results_table.markdown([blind, ppo, planner])
    results_table.write_csv(tmp_path / "all.csv", CLASSIC, trials)
    with (tmp_path / "all.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 16
    assert sum(int(row["points"]) for row in rows if row["contestant"] == "ppo") == 2400


def test_the_best_rhythm_is_that_of_the_finals_and_is_compared_with_random_presses():
    def heard(rhythm, is_final, points):
        return Heard(rhythm, is_final, 10, Estimate(points, points - 1, points + 1), Estimate(1, 1, 1))

    lucky, good = Rhythm("both", 1, 1), Rhythm("both", 2, 1)
    found = [
        heard(None, False, 50.0), heard(lucky, False, 999.0), heard(good, False, 150.0),
        heard(None, True, 100.0), heard(lucky, True, 110.0), heard(good, True, 120.0),
    ]  # fmt: skip
    assert rhythms.best_rhythm(found).rhythm == good
    assert rhythms.blind_share(found).value == pytest.approx(1.2)
