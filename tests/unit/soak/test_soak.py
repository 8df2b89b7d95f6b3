"""The checks of the soak report what should never happen, its driver plays, and its rounds find nothing."""

from __future__ import annotations

import itertools
import math
import tomllib

import numpy as np
import pytest

from boards import LEFT, PADDLES, RIGHT, full_table, table_of
from holed import hide_from_the_solver, options_of
from silverball.physics.records import Part
from silverball.soak.checks import (
    DEPTH,
    STUCK_AFTER,
    Found,
    PreviousBall,
    check_places,
    depth_of_meeting,
    max_sagitta,
)
from silverball.soak.driver import QUIET
from silverball.soak.hostile import hostile_table
from silverball.soak.rounds import SoakBatch, play_round, round_batch
from silverball.table import (
    Cylinder,
    SlantWall,
    Table,
    TriangularPrism,
    check_table,
    dump_table,
    load_table,
)

PRISM = TriangularPrism(center=(2.0, 0.0), size=0.8)
CYLINDER = Cylinder(center=(2.0, 0.0), radius=0.6)
WALL = SlantWall(start=(2.0, -1.0), end=(2.0, 1.0))
BOARD = full_table()


def first_shape(soaked: SoakBatch) -> int:
    """The row of the first stationary shape of the only board."""
    return int(soaked.batch.boards.board["shape_first"][0])


def still(table, *balls, tick_rate: int = 60, hostile: bool = False) -> SoakBatch:
    """One quiet world with balls (x, z, vx, vz), in which nothing is done for a minute."""
    soaked = SoakBatch([table], [0], tick_rate, hostile, [False])
    soaked.drivers.states["create_at"] = soaked.drivers.states["press_at"][:] = 2**60
    for slot, values in enumerate(balls):
        ball = soaked.batch.state["ball"][0, slot]
        ball["x"], ball["z"], ball["vx"], ball["vz"], ball["id"] = *values, slot + 1
    soaked.batch.state["created"] = len(balls)
    return soaked


def found(soaked: SoakBatch) -> Found:
    return Found(int(soaked.watches.states["found"][0]))


def checked(soaked: SoakBatch) -> Found:
    """What the watch sees before the solver does, which would name the fault of a ball that is put into
    something."""
    check_places(soaked.batch.state[0], soaked.truth(0), soaked.watches.states[0])
    return found(soaked)


# What the checks report


@pytest.mark.parametrize(
    ("where", "kind"),
    [
        ((9.55, -4.55), Found.ESCAPE),  # behind a corner wall
        ((9.55, 4.55), Found.ESCAPE),
        ((5.0, 0.9), Found.PENETRATION),  # cylinder
        ((2.6, -0.8), Found.PENETRATION),  # prism
        ((-5.7, -3.9), Found.PENETRATION),  # guide
        ((2.0, 4.7), Found.PENETRATION),  # border
        ((-7.4, -1.5), Found.PENETRATION),  # paddle
        ((7.0, 5.1), Found.FAULT),  # beyond the border
        ((math.nan, 0.0), Found.FAULT),
        ((4.0, -4.0), Found.NOTHING),
        ((-6.0, -4.5), Found.NOTHING),  # behind a guide: one can get there from below the paddles
    ],
)
@pytest.mark.parametrize("slot", [0, 1])
def test_a_ball_that_is_moved_somewhere_between_two_ticks_is_reported_at_once(where, kind, slot) -> None:
    soaked = still(BOARD, (7.0, 2.8, 0.0, 0.0), (7.0, -2.8, 0.0, 0.0))
    soaked.run(1)
    assert found(soaked) == Found.NOTHING
    soaked.batch.state["ball"]["x"][0, slot], soaked.batch.state["ball"]["z"][0, slot] = where
    if kind == Found.PENETRATION:
        assert checked(soaked) == kind
    soaked.run(1)
    assert found(soaked) == kind
    assert soaked.watches.states["slot"][0] == (slot if kind in (Found.ESCAPE, Found.PENETRATION) else 0)


def test_a_ball_that_is_put_into_the_other_one_is_reported() -> None:
    soaked = still(BOARD, (7.0, 0.0, 0.0, 0.0), (7.0, 1.0, 0.0, 0.0))
    soaked.run(1)
    soaked.batch.state["ball"]["z"][0, 1] = 0.4
    assert checked(soaked) == Found.PENETRATION
    assert soaked.watches.states["depth"][0] == pytest.approx(0.1, abs=1e-12)


@pytest.mark.parametrize("part", [CYLINDER, PRISM, WALL])
def test_a_ball_that_a_broken_solver_lets_through_a_part_within_a_tick_is_reported(part) -> None:
    # At 10 ticks a second and 20 u/s it is 1 u above the part before the tick and 1 u below it after it.
    ball = (3.0, 0.05, -20.0, 0.0)
    sound, broken = (still(table_of(part, gravity=0.1), ball, tick_rate=10) for _ in range(2))
    hide_from_the_solver(broken.batch, first_shape(broken))
    sound.run(1)
    broken.run(1)
    assert (found(sound), found(broken)) == (Found.NOTHING, Found.PASSAGE)
    assert broken.batch.state["ball"]["x"][0, 0] == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("side", [0, 1])
def test_a_ball_that_a_broken_solver_lets_through_a_turning_paddle_is_reported(side: int) -> None:
    # Just above the outer half of the paddle, which is raised through it in one tick of 0.1 s.
    paddle = (LEFT, RIGHT)[side]
    sign = (1.0, -1.0)[side]
    middle = [(a + b) / 2 for a, b in zip(paddle.corners(20.0)[1], paddle.pivot, strict=True)]
    ball = (middle[0] + 0.2, middle[1] + sign * 0.4, 0.0, 0.0)
    sound, broken = (still(table_of(*PADDLES, gravity=0.1), ball, tick_rate=10) for _ in range(2))
    hide_from_the_solver(broken.batch, Part.LEFT_PADDLE + side)
    for soaked in (sound, broken):
        soaked.drivers.wild[:] = True  # so that the buttons are not let go
        soaked.drivers.states["shove_at"] = soaked.drivers.states["kick_at"][:] = 2**60
        soaked.drivers.actions["left"] = soaked.drivers.actions["right"] = 1
        soaked.run(1)
    assert (found(sound), found(broken)) == (Found.NOTHING, Found.PASSAGE)


def test_balls_that_pass_through_each_other_within_a_tick_overlap_on_their_paths() -> None:
    table = table_of(gravity=0.1)
    soaked = still(table, (0.0, -1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))
    a, b = soaked.batch.state["ball"][0, :2]
    previous_a, previous_b = PreviousBall(1, -0.3, -1.0), PreviousBall(2, 0.0, 1.0)
    a["x"], a["z"], b["x"], b["z"] = 0.3, 1.0, 0.0, -1.0
    # Seen from a, b goes from (0.3, 2) to (−0.3, −2): past a's centre.
    assert depth_of_meeting(previous_a, a, previous_b, b, 0.25) == pytest.approx(0.5, abs=1e-15)
    a["z"], b["z"] = -1.0, 1.0
    # Nobody moves across: the nearest they come is the distance 2 less nothing.
    assert depth_of_meeting(previous_a, a, previous_b, b, 0.25) == pytest.approx(0.5 - 2.0, abs=1e-12)


def test_a_contact_with_nothing_is_reported() -> None:
    # The solver's cylinder is larger by 0.01 u than the true one: the ball bounces 0.01 u away from it.
    soaked = still(table_of(CYLINDER), (4.0, 0.0, -20.0, 0.0))
    soaked.batch.boards.collider[first_shape(soaked)]["radius"] += 0.01
    soaked.run(20)
    assert found(soaked) == Found.PHANTOM
    assert soaked.watches.states["depth"][0] == pytest.approx(0.01, abs=1e-9)


def test_a_contact_inside_a_part_is_reported_although_the_ball_has_left_it_at_the_end_of_the_tick() -> None:
    soaked = still(table_of(CYLINDER), (4.0, 0.0, -20.0, 0.0))
    soaked.batch.boards.collider[first_shape(soaked)]["radius"] -= 1e-6
    soaked.run(20)
    assert found(soaked) == Found.PENETRATION
    assert soaked.watches.states["depth"][0] == pytest.approx(1e-6, abs=1e-9)
    assert soaked.watches.states["deepest"][0] == soaked.watches.states["depth"][0] > DEPTH


CRADLE = (
    SlantWall(start=(0.0, 0.0), end=(1.5, -1.5)),
    SlantWall(start=(0.0, 0.0), end=(1.5, 1.5)),
)


def test_a_ball_that_lies_for_more_than_a_minute_is_stuck() -> None:
    soaked = still(table_of(*CRADLE), (1.0, 0.3, 0.0, 0.0))
    soaked.run(round(STUCK_AFTER) * 60)
    assert found(soaked) == Found.NOTHING
    soaked.run(10 * 60)
    assert found(soaked) == Found.STUCK
    lain = (soaked.watches.states["frames"][0] - soaked.watches.states["since"][0]) / 60
    assert STUCK_AFTER < lain <= STUCK_AFTER + 2 / 60


def test_a_ball_is_not_stuck_that_was_counted_as_jammed_or_lies_on_a_hostile_board() -> None:
    jammed = still(table_of(*CRADLE), (1.0, 0.3, 0.0, 0.0))
    jammed.run(30 * 60)
    jammed.batch.state["jams"] += 1
    jammed.run(40 * 60)
    hostile = still(table_of(*CRADLE), (1.0, 0.3, 0.0, 0.0), hostile=True)
    hostile.run(70 * 60)
    assert (found(jammed), found(hostile)) == (Found.NOTHING, Found.NOTHING)
    jammed.run(4 * 60)  # 74 s in all: nothing is done before 75
    assert jammed.batch.state["tick"][0] < QUIET * 60


def test_no_flight_has_a_larger_sagitta_than_the_checks_allow() -> None:
    soaked = still(table_of(gravity=10.0))
    # A parabola sags by a·t²/8 in its middle.
    assert max_sagitta(soaked.truth(0).board, 0.1) >= 10.0 * 0.1**2 / 8


# How worlds are driven


def test_a_wild_world_is_kicked_up_to_the_cap_and_pressed_for_all_times() -> None:
    soaked = round_batch(options_of(), 0, 1)
    pressed, speeds, balls = [], [], []
    for _ in range(6000):
        soaked.run(1)
        action = soaked.drivers.actions[0]
        pressed.append((int(action["left"]), int(action["right"])))
        speeds += list(np.hypot(action["vx"], action["vz"])[action["kick"] == 1])
        balls.append(int((soaked.batch.state["ball"]["id"][0] != 0).sum()))
    cap = load_table("random").board.speed_cap
    # About one kick a second of each ball; a quarter of them at the cap, the others anywhere below.
    assert 100 < len(speeds) < 300
    assert max(speeds) == pytest.approx(cap, rel=1e-15)
    assert 0.1 < np.mean(np.array(speeds) > 0.999 * cap) < 0.4
    assert min(speeds) < 0.1 * cap
    runs = [len(list(run)) for _, run in itertools.groupby(left for left, _ in pressed)]
    assert min(runs) == 1
    assert max(runs) > 30
    assert set(pressed) == {(0, 0), (0, 1), (1, 0), (1, 1)}
    changes = [(a[0] != b[0], a[1] != b[1]) for a, b in itertools.pairwise(pressed)]
    # Of a fifth of the presses both buttons have the same; by chance it would be one change in fifty.
    assert sum(left and right for left, right in changes) > 0.05 * sum(
        left or right for left, right in changes
    )
    assert np.mean(balls) > 1.8


def test_a_quiet_world_is_left_alone_for_more_than_a_minute_and_then_played() -> None:
    soaked = round_batch(options_of(), 0, 0)
    done = []
    for _ in range(100 * 60):
        soaked.run(1)
        action = soaked.drivers.actions[0]
        done.append(int(action["left"] + action["right"] + action["shove"]))
        assert action["kick"].sum() == 0
    quiet = round(QUIET * 60)
    assert STUCK_AFTER < QUIET
    assert sum(done[:quiet]) == 0
    assert sum(done[quiet:]) > 100


# Rounds


def test_a_short_soak_of_random_boards_finds_nothing_and_is_a_real_game() -> None:
    totals, places = play_round(options_of(worlds=8), 0)
    assert places == []
    assert set(totals.found.values()) == {0}
    assert totals.frames == 8 * 600 * 60
    assert totals.boards == 2
    assert totals.created > 500
    assert totals.hits > 10_000
    assert 0.0 < totals.deepest <= DEPTH


def test_a_short_soak_of_hostile_boards_finds_nothing_but_jams(short_rounds) -> None:
    totals, places = play_round(options_of(hostile=True, worlds=40), 0)
    assert places == []
    assert totals.boards == 40
    assert totals.jams > 0
    assert totals.deepest <= DEPTH


@pytest.mark.slow
def test_a_soak_of_a_hundred_hostile_boards_finds_nothing() -> None:
    totals, places = play_round(options_of(hostile=True, worlds=100), 1)
    assert (places, totals.boards) == ([], 100)


@pytest.mark.parametrize("hostile", [False, True])
def test_a_world_of_a_round_is_the_same_alone_and_among_the_others(short_rounds, hostile: bool) -> None:
    options = options_of(hostile, worlds=6)
    together = round_batch(options, 2)
    together.run(700)
    for world in (0, 5):
        alone = round_batch(options, 2, world)
        for _ in range(7):
            alone.run(100)
        assert alone.batch.digests()[0] == together.batch.digests()[world]
        assert alone.watches.states[0].tobytes() == together.watches.states[world].tobytes()


def test_rounds_and_seeds_make_boards_of_their_own() -> None:
    names = {
        round_batch(options_of(seed=seed, worlds=8), number).tables[world].name
        for seed in (0, 1)
        for number in (0, 1)
        for world in (0, 7)
    }
    assert len(names) == 8


@pytest.mark.parametrize("seed", range(12))
def test_a_hostile_board_breaks_the_rules_but_makes_a_table_that_can_be_written_and_read(seed: int) -> None:
    table = hostile_table(seed)
    assert table == hostile_table(seed) != hostile_table(seed + 1)
    assert check_table(table) != []
    assert Table.model_validate(tomllib.loads(dump_table(table))) == table
