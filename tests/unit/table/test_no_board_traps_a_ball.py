"""Every ball drains by itself: balls dropped on boards with idle paddles, until all are in the gutter."""

from __future__ import annotations

import pytest

from silverball.players.rollout import play
from silverball.table import generate_table, load_table
from silverball.world import WorldBatch

PLACES = 20  # at which a ball is dropped on each board
PATIENCE = 60.0  # [s] simulated


def balls_left(tables):
    """How many of the balls dropped at 20 random places of each table are still there after a minute."""
    worlds = [table for table in tables for _ in range(PLACES)]
    batch = WorldBatch(worlds, len(worlds), seed=1000, tick_rate=60)
    assert batch.create_balls().all()
    played = play(batch, "idle", PATIENCE, balls=0)
    assert played.faults == 0
    return len(worlds) - played.drained


@pytest.mark.parametrize("recipe", ["original", "random"])
def test_a_ball_dropped_anywhere_on_a_generated_board_reaches_the_gutter_within_a_minute(recipe):
    assert balls_left([generate_table(seed, recipe) for seed in range(150)]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("recipe", ["original", "random"])
def test_a_ball_dropped_anywhere_on_a_thousand_generated_boards_reaches_the_gutter_within_a_minute(recipe):
    assert balls_left([generate_table(seed, recipe) for seed in range(1000)]) == 0


@pytest.mark.parametrize("name", ["classic", "rolling"])
def test_a_ball_dropped_anywhere_on_a_drawn_table_reaches_the_gutter_within_a_minute(name):
    assert balls_left([load_table(name)] * 25) == 0


def test_this_check_can_fail_where_a_cup_holds_the_ball():
    cup = load_table("classic").model_copy(update={"triangular_prism": (), "cylinder": ()})
    wall = cup.slant_wall[0]
    sides = (((0.0, 0.0), (2.0, -2.0)), ((0.0, 0.0), (2.0, 2.0)))  # a funnel without a hole
    cup = cup.model_copy(
        update={"slant_wall": tuple(wall.model_copy(update={"start": a, "end": b}) for a, b in sides)}
    )
    assert balls_left([cup]) > 0
