"""Over a million frames of random play: nothing inside anything, nothing too fast, nothing that is not a
number."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
import pytest

from boards import full_table
from silverball.physics.audit import deepest, part_gap
from silverball.physics.records import EventKind, Kind, Part
from silverball.soak.hostile import hostile_table
from silverball.table import Table, generate_table
from silverball.world import WorldBatch

DEPTH = 1e-9


@numba.njit(error_model="numpy")
def _look(worlds, boards, board_of, colliders, logs, angles, seen):  # pragma: no cover  (compiled)
    """Raise the deepest, the fastest (as a share of the cap), and note a ball that is not on the board.

    At the end of a tick balls are mostly in flight; so every contact of the tick is checked too: the ball
    must stand at the surface there (a paddle is checked only if it stood still in this tick).
    """
    for index in range(len(worlds)):
        world, board = worlds[index], boards[board_of[index]]
        seen[0] = max(seen[0], deepest(world, board, colliders))
        for slot in range(2):
            ball = world.ball[slot]
            if ball.id == 0:
                continue
            seen[1] = max(seen[1], np.sqrt(ball.vx**2 + ball.vz**2) / board.speed_cap)
            if not (abs(ball.x) < board.half_length and abs(ball.z) < board.half_width):
                seen[2] += 1.0
        first = board.collider_first
        for number in range(logs[index].count):
            event = logs[index].event[number]
            if event.kind not in (EventKind.HIT, EventKind.TOUCH):
                continue
            c = colliders[first + event.part]
            angle = 0.0
            if c.kind == Kind.PADDLE:
                angle = world.paddle[event.part - Part.LEFT_PADDLE].angle
                if angles[index, event.part - Part.LEFT_PADDLE] != angle:
                    continue
            gap = part_gap(c, angle, event.x, event.z)
            if c.kind == Kind.WALL:
                gap = (event.x - c.x) * c.inward_x if c.inward_z == 0.0 else (event.z - c.z) * c.inward_z
            gap -= board.ball_radius
            seen[0] = max(seen[0], -gap)
            seen[3] = max(seen[3], gap)
            seen[4] += 1.0


class Soak(NamedTuple):
    """What was seen."""

    frames: int
    depth: float
    fastest: float
    outside: float
    faults: int
    jams: int
    created: int
    paddles_beyond: int
    hits: int
    contacts: int
    early: float


def soak(tables: list[Table], ticks: int, tick_rate: int = 60, seed: int = 0, wild: bool = True) -> Soak:
    """Random play with two balls: buttons and shoves at random, and now and then a ball thrown at a random
    speed."""
    count = len(tables)
    batch = WorldBatch(tables, count=count, seed=seed, tick_rate=tick_rate)
    rng = np.random.default_rng(seed)
    seen = np.zeros(5)
    held = np.zeros((1, count, 3), np.bool_)
    rows = batch.boards.board["collider_first"][batch.board_of][:, None] + [3, 4]
    rest, up = batch.boards.collider["angle_rest"][rows], batch.boards.collider["angle_up"][rows]
    cap = batch.boards.board["speed_cap"][batch.board_of][:, None]
    beyond = 0
    ball = batch.state["ball"][:, :2]
    for tick in range(ticks):
        batch.create_balls()
        held[0, :, :2] ^= rng.random((count, 2)) < 6.0 / tick_rate
        held[0, :, 2] = rng.random(count) < 1.0 / tick_rate
        if wild and tick % 7 == 0:
            turn, speed = rng.uniform(0, 2 * np.pi, (count, 2)), rng.random((count, 2)) * cap * (1 - 1e-12)
            thrown = (ball["id"] > 0) & (rng.random((count, 2)) < 0.1)
            ball["vx"] = np.where(thrown, speed * np.sin(turn), ball["vx"])
            ball["vz"] = np.where(thrown, speed * np.cos(turn), ball["vz"])
        before = batch.state["paddle"]["angle"][:, :2].copy()
        batch.step_unchecked(held, 1)
        _look(
            batch.state, batch.boards.board, batch.board_of, batch.boards.collider, batch.logs, before, seen
        )
        angle = batch.state["paddle"]["angle"][:, :2]
        beyond += int(((angle < rest) | (angle > up)).sum())
    hits = sum(
        int(batch.state[name].sum())
        for name in ("paddle_hits", "cylinder_hits", "triangular_prism_hits", "ball_hits")
    )
    state = batch.state
    return Soak(
        count * ticks, float(seen[0]), float(seen[1]), float(seen[2]), int((state["fault"] != 0).sum()),
        int((state["jams"] > 0).sum()), int(state["created"].sum()), beyond, hits, int(seen[4]),
        float(seen[3]),
    )  # fmt: skip


def check(seen: Soak) -> None:
    print(f"soak: {seen}")
    assert seen.depth <= DEPTH
    assert seen.early <= 2e-13  # a graze may end at CONTACT_GAP = 1e-13 u, and the coordinates are rounded
    assert seen.fastest <= 1.0
    assert (seen.outside, seen.faults, seen.paddles_beyond) == (0, 0, 0)


def test_nothing_is_inside_anything_and_nothing_too_fast_in_a_million_frames() -> None:
    seen = soak([generate_table(seed) for seed in range(256)], 4000)
    assert seen.frames >= 1_000_000
    check(seen)
    # It was a game: many balls, many hits, the cap reached, and no ball pinched.
    assert seen.created > 1000
    assert seen.hits > 20_000
    assert seen.fastest > 0.999
    assert seen.jams == 0


@pytest.mark.parametrize("tick_rate", [10, 240])
def test_the_same_at_other_tick_rates(tick_rate: int) -> None:
    check(soak([generate_table(seed) for seed in range(64)], 2000, tick_rate, seed=tick_rate))


@pytest.mark.parametrize(
    "board",
    [
        {"ball_radius": 0.28, "gravity": 40.0},
        {"ball_radius": 0.1, "gravity": 0.5, "jitter": 6.0},
        {"ball_restitution": 0.0, "wall_restitution": 1.0, "speed_cap": 60.0},
        {"wall_thickness": 0.0, "hit_speed": 0.3, "gravity": 100.0},
        {"friction": 0.3},
        {"gravity": 0.0},
        {"gravity": 0.0, "ball_restitution": 0.0, "wall_restitution": 0.0},
        {"gravity": 0.0, "friction": 0.2, "rolling": True},
        {"gravity": 1e-9, "friction": 0.2, "rolling": True},
        {"friction": 0.2, "rolling": True},
        {"friction": 0.02, "rolling": True, "ball_restitution": 0.0},
        {"friction": 2.0, "rolling": True, "slope": 1.0, "speed_cap": 60.0},
    ],
)
def test_the_same_on_boards_of_other_kinds(board) -> None:
    seen = soak([full_table(**board)] * 64, 1500, seed=5)
    check(seen)
    assert seen.created >= 128
    assert seen.jams < 5  # a ball of radius 0.1 fits between a guide and a paddle, and can be pinched there


def test_the_same_with_slow_wide_and_with_bouncy_paddles() -> None:
    table = full_table()
    for change in (
        {"stroke": 0.3, "base": 1.0, "restitution": 0.0},
        {"return_stroke": 0.105, "restitution": 1.0},
    ):
        paddles = tuple(paddle.model_copy(update=change) for paddle in table.paddle)
        check(soak([table.model_copy(update={"paddle": paddles})] * 64, 1500, seed=6))


RUBS = (
    {"friction": 0.2},
    {"friction": 0.2, "rolling": True},
    {"friction": 0.02, "rolling": True},
    {"friction": 2.0, "rolling": True, "slope": 1.0},
)


def rough(table: Table, rub) -> Table:
    """The same table with friction."""
    return table.model_copy(update={"board": table.board.model_copy(update=rub)})


@pytest.mark.parametrize("tick_rate", [10, 60])
@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_the_same_on_hostile_boards_that_rub(rub, tick_rate: int) -> None:
    """Slips end in the middle of ticks in which balls, parts and paddles meet; parts overlap and pinch."""
    seen = soak([rough(hostile_table(seed), rub) for seed in range(96)], 1000, tick_rate, seed=5)
    check(seen)
    assert seen.contacts > 10_000


@pytest.mark.slow
@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_nothing_is_inside_anything_in_ten_million_frames_of_boards_that_rub(rub) -> None:
    check(soak([rough(generate_table(seed), rub) for seed in range(512)], 20_000, seed=1))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_inside_anything_in_ten_million_frames(seed: int) -> None:
    check(soak([generate_table(1000 * seed + number) for number in range(512)], 20_000, seed=seed))
