"""Skip-ahead, contacts cached in the record, and the grid save searches and change no bit.

All three only save time. So the tests compare bits with what is found without them, in games in which both
happen: long free flights, and contacts all the time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numba
import numpy as np
import pytest

from boards import FIRST_SHAPE, full_table, table_of
from silverball.physics.contact import find_contact
from silverball.physics.flight import time_to_shape
from silverball.physics.motion import start_flight
from silverball.physics.records import NOTHING, PLAIN_BALL, ROLL_START, BoardGeometry
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism, generate_table
from silverball.world import World, WorldBatch
from silverball.world.compile import Boards, compile_tables

RUBS = ({}, {"friction": 0.2}, {"friction": 0.2, "rolling": True}, {"friction": 0.02, "rolling": True})
"""No friction, friction at parts alone, rolling, and a playfield that is too smooth for rolling."""


def board_of(number: int) -> Table:
    """One of the boards to play on: with and without friction, gravity, paddles and much else."""
    table = generate_table(number) if number % 5 else full_table()
    update = RUBS[number % 4] | {"gravity": (10.0, 3.0, 30.0)[number % 3]}
    if number % 7 == 3:
        table = table.model_copy(update={"paddle": ()})
    return table.model_copy(update={"board": table.board.model_copy(update=update)})


def state_of(batch: WorldBatch) -> list[bytes]:
    """Every bit of the worlds, the flights of the balls included, and all hits."""
    return [batch.state.tobytes(), batch.tallies.tobytes()]


@pytest.mark.parametrize("tick_rate", [60, 240, 2000])
def test_skipping_many_ticks_gives_the_bits_of_one_tick_after_the_other(tick_rate: int) -> None:
    tables = [board_of(number) for number in range(40)]
    leaping, single = (WorldBatch(tables, len(tables), 7, tick_rate) for _ in range(2))
    rng = np.random.default_rng(tick_rate)
    for _ in range(60):
        for batch in (leaping, single):
            batch.create_balls()
        ticks = int(rng.integers(1, tick_rate // 2))
        held = rng.random((len(tables), 3)) < (0.4, 0.4, 0.1)
        leaping.step(held, ticks)
        events = int(leaping.logs["count"].sum() + leaping.logs["lost"].sum())
        for tick in range(ticks):
            single.step(held & (True, True, tick == 0), 1)
            events -= int(single.logs["count"].sum() + single.logs["lost"].sum())
        assert state_of(leaping) == state_of(single)
        assert events == 0
    assert leaping.state["drained"].sum() > 40
    assert not leaping.state["fault"].any()


def test_presses_and_shoves_in_the_middle_of_a_skip_come_in_their_own_ticks() -> None:
    tables = [board_of(number) for number in range(24)]
    leaping, single = (WorldBatch(tables, len(tables), 3, 120) for _ in range(2))
    rng = np.random.default_rng(9)
    for _ in range(20):
        for batch in (leaping, single):
            batch.create_balls()
        rows = rng.random((50, len(tables), 3)) < (0.3, 0.3, 0.03)
        leaping.step(rows, len(rows))
        for row in rows:
            single.step(row, 1)
        assert state_of(leaping) == state_of(single)


def test_a_skip_on_a_board_without_paddles_ends_at_the_contact() -> None:
    """Without a paddle only the contact bounds the skip."""
    world = World(table_of(length=50, gutter=-24))
    world.create_ball((20.0, 0.0), (-1.0, 4.0))
    world.step(ticks=400)
    time = (5.0 - 0.1 - 0.25) / 4.0
    (event,) = [event for event in world.events if event.kind == "hit"]
    assert event.tick / world.tick_rate + event.offset == pytest.approx(time, abs=1e-14)


# --- what the record holds of a flight


@numba.njit(error_model="numpy")
def _search(board, colliders, grid, ball, tick):  # pragma: no cover  (compiled)
    find_contact(BoardGeometry(board, colliders, grid), ball, 0, tick)


def is_same_flight(before, after) -> bool:
    """Whether a ball is still on the flight that it was on."""
    names = ("id", "start_x", "start_z", "start_vx", "start_vz", "accel_x", "accel_z", "motion", "offset")
    return all(before[name] == after[name] for name in names) and after["ticks"] > before["ticks"]


@pytest.mark.parametrize("rub", RUBS[:3], ids=str)
def test_the_cached_contact_is_what_a_search_from_the_start_of_the_flight_finds(rub) -> None:
    table = full_table(**rub)
    world = World(table, seed=1, tick_rate=240)
    boards = world._batch.boards
    board, colliders, grid = boards.board[0], boards.collider, boards.grid
    rng = np.random.default_rng(2)
    compared = met = 0
    for tick in range(3000):
        if len(world.balls) < 2 and tick % 10 == 0:
            world.create_ball()
        before = world.records[0]["ball"].copy()
        world.step(left=bool(rng.random() < 0.3), jitter=tick % 200 == 0)
        for old, ball in zip(before, world.records[0]["ball"].copy(), strict=True):
            if ball["id"] == 0 or not is_same_flight(old, ball) or ball["contact_age"] == old["contact_age"]:
                continue
            copy = np.zeros(1, ball.dtype)
            copy[0] = ball
            again = copy[0]
            again["contact_age"], again["contact_row"], again["age"] = 0.0, NOTHING, -again["offset"]
            for _ in range(500):
                _search(board, colliders, grid, again, 1 / 240)
                if again["contact_age"] >= ball["contact_age"] or again["contact_row"] != NOTHING:
                    break
            assert (again["contact_age"], again["contact_row"]) == (
                ball["contact_age"],
                ball["contact_row"],
            )
            compared += 1
            met += ball["contact_row"] != NOTHING
    assert compared > 60
    assert met > 10


@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_a_game_whose_flights_are_searched_again_in_every_tick_is_the_same_game(rub) -> None:
    """A flight whose held contact is forgotten finds it again, to rounding: searches begin at other ages."""
    worlds = [World(full_table(**rub), tick_rate=240) for _ in range(2)]
    for world in worlds:
        world.create_ball((1.5, 2.0), (12.0, 15.0))
        world.create_ball((6.5, -3.0), (3.0, 19.0))
    for _ in range(240):
        for ball in worlds[1].records[0]["ball"]:
            ball["contact_age"], ball["contact_row"] = max(ball["age"], 0.0), NOTHING
        for world in worlds:
            world.step()
        for one, other in zip(*(world.balls for world in worlds), strict=True):
            assert one.position == pytest.approx(other.position, abs=1e-9)
    assert sum(worlds[0].hits.values()) >= 4
    assert worlds[0].hits == worlds[1].hits


# --- the grid


def crowded(parts: int, seed: int, **board) -> Table:
    """A board full of parts of all kinds, of all sizes, wherever they come to lie."""
    rng = np.random.default_rng(seed)
    made = []
    for number in range(parts):
        x, z = rng.uniform(-10, 10), rng.uniform(-5, 5)
        size = float(rng.choice([0.1, 0.3, 1.0, 3.0]) * rng.uniform(0.5, 1.0) * (5 / parts) ** 0.25)
        way = rng.uniform(0, 2 * math.pi)
        end = (float(x + 2 * size * math.sin(way)), float(z + 2 * size * math.cos(way)))
        if number % 3 == 0:
            made.append(Cylinder(center=(float(x), float(z)), radius=max(size, 0.05)))
        elif number % 3 == 1:
            made.append(
                SlantWall(start=(float(x), float(z)), end=end, thickness=float(rng.choice([0.0, 0.1])))
            )
        else:
            side = (float(x + size * math.cos(way)), float(z - size * math.sin(way)))
            made.append(TriangularPrism(vertices=((float(x), float(z)), end, side)))
    return table_of(*made, **board)


@numba.njit(error_model="numpy")
def _begin(ball, board):  # pragma: no cover  (compiled)
    start_flight(ball, board, 0.0)


@numba.njit(error_model="numpy")
def _meets(c, ball, radius, start, limit):  # pragma: no cover  (compiled)
    return time_to_shape(c, ball, radius, start, limit)


@numba.njit(error_model="numpy")
def _first_shape(board, colliders, ball, start, limit):  # pragma: no cover  (compiled)
    """The first shape of all that a flight meets between two ages, without grid and without short cuts."""
    time, part = limit, NOTHING
    for index in range(board.collider_first + FIRST_SHAPE, board.collider_end):
        at, met = time_to_shape(colliders[index], ball, board.ball_radius, start, time)
        if met and at < time:
            time, part = at, index - board.collider_first
    return time, part


def random_ball(rng, boards: Boards, world: World):
    """A ball's record at the beginning of a flight in a free place, at any speed."""
    board = boards.board[0]
    while True:
        x, z = float(rng.uniform(-9.5, 9.5)), float(rng.uniform(-4.6, 4.6))
        if world.clearance(x, z) > 0.0:
            break
    ball = np.zeros(1, PLAIN_BALL)[0]
    speed, way = float(rng.choice([0.0, 0.3, 3.0, 22.0])) * rng.random(), rng.uniform(0, 2 * math.pi)
    ball["x"], ball["z"], ball["id"] = x, z, 1
    ball["vx"], ball["vz"] = speed * math.sin(way), speed * math.cos(way)
    ball["spin_x"], ball["spin_z"] = rng.uniform(-40, 40, 2) * float(rng.choice([0.0, 1.0]))
    _begin(ball, board)
    return ball


def searches(boards: Boards, ball, tick: float) -> Iterator[tuple[float, float, int]]:
    """Search on until something is met: from which age, to which age, and what."""
    for _ in range(60):
        start = float(ball["contact_age"])
        _search(boards.board[0], boards.collider, boards.grid, ball, tick)
        yield start, float(ball["contact_age"]), int(ball["contact_row"])
        if ball["contact_row"] != NOTHING or ball["contact_age"] == start:
            return


@pytest.mark.parametrize("parts", [5, 20, 60, 250])
@pytest.mark.parametrize("rub", RUBS[::2], ids=str)
def test_the_grid_misses_no_contact(parts: int, rub) -> None:
    """Whatever a search with the grid says, a look at all parts says too, to the bit."""
    table = crowded(parts, parts, ball_radius=0.12, **rub)
    boards = compile_tables([table])
    world = World(table)
    rng = np.random.default_rng(parts)
    met = free = 0
    for _ in range(250):
        ball = random_ball(rng, boards, world)
        for start, end, part in searches(boards, ball, 0.25):
            time, first = _first_shape(boards.board[0], boards.collider, ball, start, end)
            if part >= FIRST_SHAPE:
                assert first == NOTHING  # none before it, and it is met at the very age
                again, is_met = _meets(boards.collider[part], ball, 0.12, start, end + 1.0)
                assert (again, is_met) == (end, True)
                met += 1
            else:
                assert first == NOTHING, (start, end, part, time, first)
                free += part == NOTHING
            assert part != ROLL_START or rub
    assert met > 10
    assert free > 50


def test_the_first_of_all_shapes_would_be_seen() -> None:
    """The look at all parts does find contacts: those of the searches, a moment before and after them."""
    table = crowded(60, 1, ball_radius=0.12)
    boards, world, rng = compile_tables([table]), World(table), np.random.default_rng(0)
    found = 0
    for _ in range(100):
        ball = random_ball(rng, boards, world)
        *_, (start, end, part) = searches(boards, ball, 0.25)
        if part >= FIRST_SHAPE and end > start:
            assert _first_shape(boards.board[0], boards.collider, ball, start, end + 1e-6) == (end, part)
            found += 1
    assert found > 30
