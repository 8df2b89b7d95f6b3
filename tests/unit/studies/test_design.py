"""Design by search: it finds what there is, and never a board that `check` refuses."""

from __future__ import annotations

import numpy as np
import pytest

from silverball import check_table, load_table
from silverball.errors import SilverballError
from silverball.studies import design
from silverball.studies.chunk import run_chunk
from silverball.studies.design import HELD_OUT, Wish, judge, search
from silverball.studies.goals import parse_range, parse_target, usual_ranges
from silverball.studies.run import play_here
from silverball.studies.study_plan import Arm, Plan

pytest.importorskip("cmaes")

CLASSIC = load_table("classic")
PATH = "paddle.length=1.7:2.2"


def wish(*targets, ranges=(PATH,), games=20, tables=24, player="idle", table=CLASSIC, seed=0):
    varied = tuple(parse_range(text, table) for text in ranges)
    return Wish(table, player, tuple(map(parse_target, targets)), varied, games, tables, seed)


def known(length_to_seconds):
    """A runner whose games last as long as a function of the length of the paddles says [s]."""

    some = run_chunk(next(Plan((Arm("", CLASSIC, "idle"),), 2, longest=1.0).chunks()))

    def play(chunks):
        for chunk in chunks:
            columns = dict(some)
            seconds = length_to_seconds(chunk.table.paddle[0].length)
            columns["game.ticks"] = np.full(2, round(240 * seconds))
            columns["ball.game"] = columns["game.seed"]
            for name in columns:
                if name.startswith("ball.") and name != "ball.game":
                    columns[name] = np.ones(2, np.int64)
            yield chunk.number, columns

    return play


def test_the_search_finds_a_known_place():
    looked_for = wish("ball_time=30±0.5", tables=120)
    tried = search(looked_for, known(lambda length: 10.0 + 40.0 * (length - 1.7)), enough=3)  # 2.2: 30 s
    best = min(tried, key=lambda one: one.miss)
    assert best.miss <= 1.0
    assert dict(best.values)["paddle.length"] == pytest.approx(2.2, abs=0.5 / 40.0 + 1e-9)
    assert len(tried) <= 120
    assert [one.number for one in tried] == list(range(1, len(tried) + 1))


def test_the_same_seed_finds_the_same_tables():
    first, again, other = (
        [(one.values, one.miss) for one in search(wish("ball_time=3±1", tables=6, games=4, seed=seed))]
        for seed in (1, 1, 2)
    )
    assert first == again
    assert first != other


def test_tables_that_cannot_be_played_are_neither_played_nor_found():
    """Paddles of this range overlap each other from some length on."""
    played = []

    def noting(chunks):
        for chunk in chunks:
            played.append(chunk.table)
            yield from play_here([chunk])

    looked_for = wish("ball_time=1±1", ranges=["paddle.length=2.0:4.0"], games=4, tables=18)
    tried = search(looked_for, noting)
    assert any(one.table is None and one.miss == float("inf") for one in tried)
    found = judge(looked_for, tried, noting)
    for table in (*played, *(one.tried.table for one in found)):
        assert not [problem for problem in check_table(table) if problem.is_error]


def test_what_is_found_is_judged_by_other_games():
    seeds = []

    def noting(chunks):
        for chunk in chunks:
            seeds.append(chunk.first_seed)
            yield from play_here([chunk])

    looked_for = wish("ball_time=1±1", games=4, tables=6)
    tried = search(looked_for, noting)
    assert max(seeds) < HELD_OUT
    seeds.clear()
    found = judge(looked_for, tried, noting)
    assert min(seeds) >= HELD_OUT
    assert len({seed - seed % 20 for seed in seeds}) == design.JUDGED_SETS
    assert len(found) <= design.KEPT
    order = [(not one.reaches(looked_for.targets), one.miss(looked_for.targets)) for one in found]
    assert order == sorted(order)


def test_a_path_that_leads_to_nothing_is_refused_before_the_first_game():
    with pytest.raises(SilverballError, match="lenth"):
        search(wish("ball_time=1±1", ranges=["paddle.lenth=1:2"]), None)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_design_reaches_its_target_in_games_of_seeds_that_it_never_saw(seed):
    looked_for = Wish(
        CLASSIC, "beginner", (parse_target("ball_time=20±2"),), tuple(usual_ranges(CLASSIC)), 200, 100, seed
    )
    found = judge(looked_for, search(looked_for))
    assert found[0].reaches(looked_for.targets)
    assert len(found[0].sets) == 3
