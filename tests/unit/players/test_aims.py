"""What hits are worth to a player that aims: what the rules would pay now, and what they lead to."""

from __future__ import annotations

import numpy as np
import pytest

import silverball as sb
from rule_tables import Bench, with_rules
from silverball.game.game import Game
from silverball.game.game_batch import GameBatch
from silverball.physics.records import EventKind
from silverball.players.aims import aim_rows, weigh_parts
from silverball.players.batch_policies import batch_policy
from silverball.players.planner import Planner
from silverball.table import Table

RULES = """
[[lamp]]
name = "lock"
[[lamp]]
name = "a"
group = "letters"
[[lamp]]
name = "b"
group = "letters"
[[counter]]
name = "turns"
[[mode]]
name = "hunt"
seconds = 20.0
[[rule]]
on_down = "middle"
blink = "lock"
[[rule]]
on_hit = "saucer"
if_lit = "lock"
award = 1000
[[rule]]
on_hit = "spinner"
add = { turns = 1 }
[[rule]]
on_count = { turns = 4 }
award = 3000
[[rule]]
on_hit = "side target"
start = "hunt"
[[rule]]
on_start = "hunt"
award = 2000
[[rule]]
on_hit = "left bumper"
light = "a"
[[rule]]
on_hit = "right bumper"
light = "b"
[[rule]]
on_complete = "letters"
award = 2000
times = "in_play"
"""
UNIT = 2000.0  # the mean of the awards


def worths(one: Bench) -> dict[str, float]:
    """What each part is worth, in points."""
    rows = one.game.rule_rows
    assert rows is not None
    found = np.zeros((1, len(one.names)))
    weigh_parts(rows[0], np.zeros(1, np.int64), aim_rows(rows[1]), found)
    points = found[0] * UNIT
    return {name: float(points[one.number(name)]) for name in NAMED}


NAMED = ("saucer", "spinner", "side target", "left bumper", "right bumper", "left drop target")


def test_what_is_not_lit_is_worth_nothing_and_what_is_lit_its_award():
    one = Bench(RULES)
    assert worths(one)["saucer"] == 0.0
    one.hit(*(f"{name} drop target" for name in ("left", "middle", "right")))
    assert worths(one)["saucer"] == pytest.approx(1000.0)


def test_a_drop_target_is_worth_its_share_of_what_the_bank_lights():
    one = Bench(RULES)
    assert worths(one)["left drop target"] == pytest.approx(UNIT / 3)
    one.hit("right drop target")
    assert worths(one)["left drop target"] == pytest.approx(UNIT / 2)


def test_a_counter_is_worth_the_more_the_nearer_it_is():
    one = Bench(RULES)
    found = []
    for _ in range(4):
        found.append(worths(one)["spinner"])
        one.happen(EventKind.SPIN, "spinner")
    assert found == pytest.approx([3000 / 4, 3000 / 3, 3000 / 2, 3000])
    assert worths(one)["spinner"] == 0.0  # reached


def test_what_a_mode_pays_as_it_starts_counts_until_it_runs():
    one = Bench(RULES)
    assert worths(one)["side target"] == pytest.approx(2000.0)
    one.hit("side target")
    assert worths(one)["side target"] == 0.0


def test_a_lamp_of_a_group_is_worth_its_share_of_what_the_group_pays():
    one = Bench(RULES)
    assert worths(one)["left bumper"] == pytest.approx(1000.0)
    one.hit("right bumper")
    found = worths(one)
    assert (found["left bumper"], found["right bumper"]) == pytest.approx((2000.0, 0.0))


def test_nothing_is_worth_anything_on_a_tilted_table():
    one = Bench(RULES)
    for _ in range(3):
        one.keeper.shoved()
    assert one.game.view.tilted
    assert set(worths(one).values()) == {0.0}


@pytest.mark.parametrize("table", ["classic", with_rules("")])
def test_on_a_table_with_the_standard_rules_nothing_is_worth_an_aim(table: str | Table):
    rows = Game(table).rule_rows
    assert rows is not None
    assert aim_rows(rows[1]).units.tolist() == [0.0]


def test_rules_in_python_show_no_rows():
    class Own(sb.ArcadeRules):
        name = "own"

    assert Game("classic", rules=Own()).rule_rows is None


def test_a_planner_that_sees_the_rules_makes_lit_shots():
    """Six games of 20 s each: over twice the 54,000 points a minute of buttons pressed at random."""
    batch = GameBatch("silver_comet", 6, seed=0)
    policy = batch_policy("planner", batch, 30)
    assert policy is not None
    held = np.zeros((1, 6, 4), np.bool_)
    for step in range(20 * 60):
        policy.decide()
        held[0, :, :2], held[0, :, 3] = policy.buttons, step % 90 < 60
        batch.step(held[0], policy.every)
    assert batch.games["score"].sum() > 2 * 2 * 54_000  # in two minutes
    locks = batch.books.counters[0].index("locks")
    assert batch.games["counter"][:, locks].any()


def test_a_planner_plays_a_game_that_it_watches_as_in_a_batch():
    game, batch = Game("silver_comet", seed=3), GameBatch("silver_comet", 1, seed=3)
    planner, policy = Planner(8), batch_policy("planner", batch, 8)
    planner.watch(game)
    assert policy is not None
    game.create_ball()
    for step in range(6 * 60):
        launch = 20 < step < 60
        policy.decide()
        pressed = planner.press(game.world)
        assert pressed == tuple(policy.buttons[0].tolist())
        game.step(*pressed, 4, launch=launch)
        batch.step([[*pressed, False, launch]], 4)
    assert game.score == int(batch.games["score"][0])
    assert planner.state.memories["aims"][0] == 1
