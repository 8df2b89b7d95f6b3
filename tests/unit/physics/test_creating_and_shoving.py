"""New balls and shoves: where, how many, how random, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import PADDLES, edited, full_table, launched, place, speed_of, table_of
from silverball.errors import BoardFull, NoRoom, StateError
from silverball.physics.audit import deepest
from silverball.physics.balls import create_ball
from silverball.physics.records import Outcome
from silverball.table import Cylinder, SlantWall
from silverball.world import World, WorldBatch

REACH = -7.2 + 2.1  # [u] the highest that a paddle of the default table can reach: its pivot and its length
WORLDS = 4000


@pytest.fixture(scope="module")
def crowd() -> WorldBatch:
    """Many worlds with two new balls each."""
    batch = WorldBatch(full_table(), count=WORLDS, seed=100)
    assert batch.create_balls().all()
    assert batch.create_balls().all()
    return batch


def test_new_balls_overlap_nothing_and_are_at_rest(crowd: WorldBatch) -> None:
    board, colliders = crowd.boards.board[0], crowd.boards.collider
    assert max(deepest(world, board, colliders) for world in crowd.state) == 0.0
    assert not crowd.state["ball"]["vx"].any()
    assert not crowd.state["ball"]["vz"].any()
    assert (crowd.state["ball"]["id"] == [1, 2]).all()


def test_new_balls_appear_above_the_paddles_reach(crowd: WorldBatch) -> None:
    assert crowd.state["ball"]["x"][:, :2].min() >= REACH + 0.25


def test_new_balls_are_spread_evenly_over_the_free_board(crowd: WorldBatch) -> None:
    """χ² against the free area of each cell, measured with points of our own; 2 % of it for a cell's ragged
    edge."""
    balls = crowd.state["ball"][:, 0]  # the second ball keeps off the first
    rng = np.random.default_rng(4)
    world = launched(full_table())
    edges = np.linspace(REACH + 0.25, 9.65, 9), np.linspace(-4.65, 4.65, 7)
    points = rng.uniform((REACH + 0.25, -4.65), (9.65, 4.65), (30_000, 2))
    free = points[[world.clearance(x, z) > 0 for x, z in points.tolist()]]
    # Behind the corner guides at the top a ball could never come out.
    free = free[np.abs(free[:, 1]) + free[:, 0] < 13.0 - 0.35 * math.sqrt(2)]
    area = np.histogram2d(*free.T, edges)[0]
    count = np.histogram2d(balls["x"], balls["z"], edges)[0]
    expected = area / area.sum() * WORLDS
    assert count.sum() == WORLDS
    assert count.min() > 0
    deviation = (count - expected) ** 2 / (expected * (1 + WORLDS / len(free)) + (0.02 * expected) ** 2)
    assert deviation.sum() < 47 + 5 * math.sqrt(2 * 47)


def test_the_same_seed_gives_the_same_places() -> None:
    one, other = (World(full_table(), seed=9) for _ in range(2))
    assert [one.create_ball(), one.create_ball()] == [other.create_ball(), other.create_ball()]
    assert World(full_table(), seed=10).create_ball().position != one.balls[0].position


def test_every_new_ball_and_every_shove_draws_new_numbers() -> None:
    """A world that drew the same numbers again would create all balls in one place."""
    world = World(table_of(max_balls=1), seed=9)
    places, shoves = set(), set()
    for _ in range(12):
        places.add(world.create_ball().position)
        while world.balls:
            world.step(jitter=True, ticks=20)
            shoves |= {event.normal for event in world.events if event.kind == "jitter"}
    assert len(places) == 12
    assert len(shoves) > 60


@pytest.mark.parametrize("max_balls", [1, 2])
def test_one_ball_too_many_is_refused_and_nothing_changes(max_balls: int) -> None:
    world = World(full_table(max_balls=max_balls), seed=5)
    for _ in range(max_balls):
        world.create_ball()
    before, state = world.digest(), world.save()
    for position in (None, (3.0, 3.0)):
        with pytest.raises(BoardFull, match=f"{max_balls} ball"):
            world.create_ball(position)
        assert (world.digest(), world.save()) == (before, state)


def test_a_board_with_no_room_refuses_and_nothing_changes() -> None:
    world = World(table_of(*PADDLES, Cylinder(center=(3.0, 0.0), radius=9.6)), seed=5)
    before = world.digest()
    with pytest.raises(NoRoom, match="no free place"):
        world.create_ball()
    assert world.digest() == before
    assert world.events == ()
    assert not WorldBatch(world.table, count=3).create_balls().any()


def crowded(hole: tuple[float, float]) -> WorldBatch:
    """Worlds on a board where a ball fits only into one hole between cylinders, 0.02 u wide."""
    around = [
        Cylinder(center=(hole[0] + 1.27 * math.sin(turn), hole[1] + 1.27 * math.cos(turn)), radius=1.0)
        for turn in np.linspace(0, 2 * math.pi, 12, endpoint=False)
    ]
    batch = WorldBatch(table_of(*around), count=1)
    # One square place around the hole, 2.4 u wide, in the place of the table's own (which lead to the
    # gutter).
    batch.boards.board["place_first"], batch.boards.board["place_end"] = 0, 1
    batch.boards.board["place_size"] = 2.4
    batch.boards.place[0] = hole
    return batch


def create_in(batch: WorldBatch, seed: int) -> int:
    batch.state[0] = 0
    batch.state["seed"] = seed
    boards = batch.boards
    return create_ball(batch.state[0], boards.board[0], boards.collider, boards.place, batch.logs[0])


def test_the_search_finds_the_last_hole_when_random_tries_do_not() -> None:
    """The hole lies on one of the sixteen points that the search looks at; 32 random tries hit it once in
    600 boards."""
    hole = (3.0, 1.0)
    batch = crowded((hole[0] + 0.3, hole[1] + 0.3))
    batch.boards.place[0] = hole
    batch.boards.board["place_lowest"] = 1.0  # the origin is no candidate
    for seed in range(50):
        assert create_in(batch, seed) == Outcome.CREATED
        ball = batch.state[0]["ball"][0]
        assert math.dist((ball["x"], ball["z"]), (3.3, 1.3)) < 0.03
        assert deepest(batch.state[0], batch.boards.board[0], batch.boards.collider) == 0.0
        assert batch.state[0]["draws"] <= 96


def test_no_hole_is_refused_with_the_random_generator_where_it_was() -> None:
    batch = crowded((3.3, 1.3))
    batch.boards.place[0] = (3.3 - 0.15, 1.3)  # none of the sixteen points lies in the hole
    batch.boards.board["place_size"] = 0.2
    batch.boards.board["place_lowest"] = 1.0  # and the origin is below the places
    create_in(batch, 0)
    before = batch.state.copy()
    assert create_in(batch, 1) == Outcome.NO_ROOM
    before["seed"] = 1
    assert batch.state.tobytes() == before.tobytes()


def test_after_the_random_tries_the_origin_is_the_first_candidate() -> None:
    batch = crowded((3.3, 1.3))
    batch.boards.place[0] = (3.3 - 0.15, 1.3)
    batch.boards.board["place_size"] = 0.2
    assert create_in(batch, 1) == Outcome.CREATED
    assert batch.state["ball"][0, 0][["x", "z"]].tolist() == (0.0, 0.0)


@pytest.mark.parametrize(
    ("position", "named"),
    [
        ((5.0, 1.0), r"cylinder\[0\]"),
        ((2.5, -0.8), r"triangular_prism\[0\]"),
        ((-5.7, -3.9), r"slant_wall\[0\]"),
        ((-7.2, -2.0), r"paddle\.left"),
        ((-7.2, 2.0), r"paddle\.right"),
        ((0.0, 4.8), r"board\.right"),
        ((0.0, -4.8), r"board\.left"),
        ((9.8, 0.0), r"board\.top"),
        ((-9.5, 0.0), r"gutter"),
        ((3.0, 3.1), r"other ball"),
    ],
)
def test_a_place_that_overlaps_something_is_refused_by_its_name_and_nothing_changes(
    position, named: str
) -> None:
    world = launched(full_table(), (3.0, 3.5, 0.0, 0.0))
    before = world.digest()
    with pytest.raises(NoRoom, match=named):
        world.create_ball(position)
    assert world.digest() == before


@pytest.mark.parametrize(
    ("position", "velocity"),
    [
        ((math.nan, 0.0), (0.0, 0.0)),
        ((0.0, math.inf), (0.0, 0.0)),
        ((0.0, 3.0, 1.0), (0.0, 0.0)),
        ("ab", (0.0, 0.0)),
        (3, (0.0, 0.0)),
        ((3.0, 0.0), (22.0, 0.1)),
        ((3.0, 0.0), (math.nan, 0.1)),
        ((1e300, 0.0), (0.0, 0.0)),
    ],
)
def test_a_place_or_velocity_that_cannot_be_is_refused_and_nothing_changes(position, velocity) -> None:
    world = World(full_table())
    before = world.digest()
    with pytest.raises((ValueError, NoRoom)):
        world.create_ball(position, velocity)
    assert world.digest() == before


def test_a_shove_has_its_size_and_any_direction() -> None:
    """Directions: sums of n unit vectors stay below 4·√n; χ² of 16 sectors: 15 ± 5.5."""
    count = 4000
    batch = WorldBatch(table_of(jitter=1.5), count=count, seed=3, tick_rate=60)
    batch.create_balls()
    batch.create_balls()
    before = batch.state["ball"].copy()
    batch.step(np.tile([False, False, True], (count, 1)), ticks=0)
    assert (batch.state["ball"] == before).all()
    batch.step(np.tile([False, False, True], (count, 1)), ticks=1)
    # After one tick of free fall the shove is the change of the velocity, but for gravity's.
    dx = batch.state["ball"]["vx"][:, :2] + 10.0 / 60
    dz = batch.state["ball"]["vz"][:, :2]
    flying = (batch.state["touches"] == 0) & (batch.state["ball_hits"] == 0) & (batch.state["wall_hits"] == 0)
    dx, dz = dx[flying].ravel(), dz[flying].ravel()
    assert len(dx) > 1.8 * count
    assert np.abs(np.hypot(dx, dz) - 1.5).max() < 1e-14
    assert math.hypot(dx.sum(), dz.sum()) < 4 * 1.5 * math.sqrt(len(dx))
    sectors = np.histogram(np.arctan2(dx, dz), 16, (-math.pi, math.pi))[0]
    expected = len(dx) / 16
    assert ((sectors - expected) ** 2 / expected).sum() < 15 + 5 * math.sqrt(30)
    # The two balls of one world are shoved independently: their cosine averages to nothing.
    flying = np.flatnonzero(flying)
    one, other = (
        (batch.state["ball"]["vx"][flying, slot] + 1 / 6) + 1j * batch.state["ball"]["vz"][flying, slot]
        for slot in (0, 1)
    )
    assert abs((one * other.conjugate()).real.mean()) < 4 * 1.5**2 / math.sqrt(2 * len(flying))


def test_a_shove_comes_once_at_the_start_of_the_first_tick_and_is_written_down() -> None:
    world = launched(table_of(), (5.0, 0.0, 0.0, 0.0), (5.0, 3.0, 0.0, 0.0), tick_rate=60)
    world.step(jitter=True, ticks=3)
    shoves = [event for event in world.events if event.kind == "jitter"]
    assert [(event.ball, event.tick, event.offset) for event in shoves] == [(1, 0, 0.0), (2, 0, 0.0)]
    for event, ball in zip(shoves, world.balls, strict=True):
        assert math.hypot(*event.normal) == pytest.approx(1.0, abs=1e-15)
        expected = (1.5 * event.normal[0] - 10 * 3 / 60, 1.5 * event.normal[2])
        assert speed_of(ball) == pytest.approx(expected, abs=1e-14)


def test_a_shove_cannot_break_the_cap() -> None:
    for seed in range(20):
        world = launched(table_of(jitter=20.0), (5.0, 0.0, 0.0, 21.9), seed=seed, tick_rate=1000)
        world.step(jitter=True)
        assert math.hypot(*speed_of(world.balls[0])) <= 22.0


def test_two_overlapping_balls_of_a_state_are_moved_apart_equally() -> None:
    world = launched(table_of(*PADDLES), (2.0, 1.0, 3.0, 1.0), (2.0, 2.0, -1.0, 0.5))

    def overlap(record) -> None:
        record["ball"]["x"][1], record["ball"]["z"][1] = 2.1, 1.2

    world.restore(edited(world, overlap))
    (ax, az), (bx, bz) = (place(ball) for ball in world.balls)
    assert ((ax + bx) / 2, (az + bz) / 2) == pytest.approx((2.05, 1.1), abs=1e-14)
    assert math.hypot(ax - bx, az - bz) == pytest.approx(0.5, abs=2e-9)
    assert (ax - bx) * 0.2 - (az - bz) * 0.1 == pytest.approx(0.0, abs=1e-14)  # along the line of centres
    assert [speed_of(ball) for ball in world.balls] == [(3.0, 1.0), (-1.0, 0.5)]
    assert deepest(*world.records) == 0.0
    world.step(ticks=100)
    assert world.fault is None


def test_two_balls_in_one_place_are_moved_apart_too() -> None:
    world = launched(table_of(), (2.0, 1.0, 0.0, 0.0), (2.0, 2.0, 0.0, 0.0))

    def overlap(record) -> None:
        record["ball"]["z"][1] = 1.0

    world.restore(edited(world, overlap))
    assert math.dist(*(place(ball) for ball in world.balls)) == pytest.approx(0.5, abs=2e-9)


def test_a_state_whose_balls_could_only_part_into_a_wall_is_refused_and_nothing_changes() -> None:
    world = launched(
        table_of(SlantWall(start=(0, -4), end=(0, 4))), (0.36, 1.0, 0.0, 0.0), (2.0, 2.0, 0.0, 0.0)
    )

    def overlap(record) -> None:
        record["ball"]["x"][1], record["ball"]["z"][1] = 0.7, 1.0

    bad = edited(world, overlap)
    before = world.digest()
    with pytest.raises(StateError, match="overlapping"):
        world.restore(bad)
    assert world.digest() == before
