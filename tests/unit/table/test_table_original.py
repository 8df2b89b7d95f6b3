"""The table `original` has every number of the brief, and no part that the brief does not have.

The numbers here are copied from the brief, not from the table or the defaults.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from silverball.table import ball_places, check_table, generate_table, load_table
from silverball.table.geometry import distances
from silverball.world import World

ORIGINAL = load_table("original")
SEEDS = range(60)
PRISMS, CYLINDERS = 4, 3
MAX_BALLS = 2
CAP = 22.0  # [u/s]
REST, UP = -10.0, 45.0  # [deg]
TURNED = (10.0, 80.0)  # [deg]
FALLBACK = (0.0, 0.0)  # x and z of (0, 1, 0)
HEIGHT = 1.0  # y of it


def boards():
    return (generate_table(seed, "original") for seed in SEEDS)


def test_the_board_is_that_of_the_brief():
    board = ORIGINAL.board
    assert board.max_balls == MAX_BALLS
    assert (board.speed_cap, board.height) == (CAP, HEIGHT)
    assert board.gravity > 0.0  # towards -x; how much, the brief leaves open
    assert board.jitter > 0.0
    assert not board.rolling
    assert board.friction == 0.0


def test_two_slant_walls_funnel_to_two_paddles_and_nothing_else_stands_on_the_recipe():
    left, right = ORIGINAL.slant_wall
    for wall, side in ((left, -1.0), (right, 1.0)):
        high, low = sorted((wall.start, wall.end), reverse=True)
        assert side * high[1] > side * low[1] > 0.0, "it leads inwards on its way down"
    assert [(paddle.side, paddle.rest_angle, paddle.up_angle) for paddle in ORIGINAL.paddle] == [
        ("left", REST, UP),
        ("right", REST, UP),
    ]
    assert ORIGINAL.triangular_prism == ORIGINAL.cylinder == ()


def test_the_right_side_is_the_mirror_image_of_the_left():
    def mirrored(point):
        return (point[0], -point[1])

    left, right = ORIGINAL.paddle
    assert left.model_copy(update={"side": "right", "pivot": mirrored(left.pivot)}) == right
    one, other = ORIGINAL.slant_wall
    places = {"name": other.name, "start": mirrored(one.start), "end": mirrored(one.end)}
    assert one.model_copy(update=places) == other


def test_every_board_has_four_prisms_and_three_cylinders():
    for board in boards():
        assert (len(board.triangular_prism), len(board.cylinder)) == (PRISMS, CYLINDERS)
        assert check_table(board) == []


def test_prisms_take_speed_away_and_cylinders_give_some():
    for board in boards():
        assert all(prism.speed_factor < 1.0 for prism in board.triangular_prism)
        assert all(cylinder.speed_factor > 1.0 for cylinder in board.cylinder)


def test_prisms_are_turned_by_10_to_80_degrees_and_use_all_of_it():
    turned = [prism.rotation for board in boards() for prism in board.triangular_prism]
    assert all(TURNED[0] <= angle <= TURNED[1] for angle in turned)
    assert min(turned) < TURNED[0] + 3.0
    assert max(turned) > TURNED[1] - 3.0


def test_obstacles_stand_apart_by_their_bounding_circles_so_that_a_ball_passes():
    for board in boards():
        circles = [(*prism.center, prism.size) for prism in board.triangular_prism]
        circles += [(*cylinder.center, cylinder.radius) for cylinder in board.cylinder]
        for (ax, az, a), (bx, bz, b) in itertools.combinations(circles, 2):
            assert math.hypot(ax - bx, az - bz) - a - b > 2.0 * board.board.ball_radius


def gap_at(board, x, z):
    """[u] from a ball at (x, z) to the nearest obstacle; below 0 it overlaps one."""
    away = [math.dist((x, z), cylinder.center) - cylinder.radius for cylinder in board.cylinder]
    away += [
        float(distances(np.array((x, z)), np.array(prism.corners()))) for prism in board.triangular_prism
    ]
    return min(away) - board.board.ball_radius


def test_the_fallback_place_is_one_of_the_places_for_balls_where_nothing_stands_on_it():
    bare = ORIGINAL.model_copy(update={"random": None})
    places, size = ball_places(bare)
    assert (np.abs(places - FALLBACK).max(axis=1) <= 0.5 * size).any()
    x, y, z = World(bare, seed=1).create_ball(FALLBACK).position
    assert (x, y, z) == (FALLBACK[0], HEIGHT, FALLBACK[1])


def test_where_the_fallback_place_is_taken_balls_come_elsewhere_and_overlap_nothing():
    taken = 0
    for seed, board in zip(SEEDS, boards(), strict=True):
        taken += gap_at(board, *FALLBACK) < 0.0
        world = World(board, seed=seed)
        ((ax, _, az), (bx, _, bz)) = (world.create_ball().position for _ in range(MAX_BALLS))
        assert min(gap_at(board, ax, az), gap_at(board, bx, bz)) >= 0.0
        assert math.hypot(ax - bx, az - bz) >= 2.0 * board.board.ball_radius
    assert taken > 0, "no board of these shows what the brief warns of"


@pytest.mark.parametrize("seed", [7, 8])
def test_y_never_changes_and_no_ball_is_faster_than_the_cap(seed):
    world = World("original", seed=seed)
    for tick in range(20 * world.tick_rate):
        if tick % 480 == 0 and len(world.balls) < MAX_BALLS:
            world.create_ball()
        world.step(left=tick % 200 < 60, right=tick % 170 < 60, jitter=tick % 700 == 0)
        for ball in world.balls:
            assert ball.position[1] == HEIGHT
            assert math.hypot(*ball.velocity) <= CAP * (1.0 + 1e-12)
