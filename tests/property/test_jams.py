"""A jam stops the jammed ball only: the other ball continues unchanged, and stays outside of it."""

from __future__ import annotations

import contextlib
import math
import random
from collections import Counter

import pytest

from boards import LEFT, RIGHT, table_of
from silverball.errors import BoardFull, NoRoom
from silverball.physics.audit import deepest
from silverball.physics.records import Motion
from silverball.soak.hostile import hostile_table
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism
from silverball.world import World

DEPTH = 1e-9
QUICK = {"stroke": 0.05, "return_stroke": 0.05, "restitution": 0.0}
HIGH_LEFT = LEFT.model_copy(update={"pivot": (0.0, -2.5), "up_angle": 60.0, **QUICK})
HIGH_RIGHT = RIGHT.model_copy(update={"pivot": (0.0, 2.5), "up_angle": 60.0, **QUICK})
ANVILS = {
    "wall": SlantWall(start=(1.0, -3.0), end=(1.0, 0.5), restitution=1.0),
    "cylinder": Cylinder(center=(1.3, -1.2), radius=0.6, restitution=1.0),
    "prism": TriangularPrism(vertices=((0.7, -2.0), (0.8, 0.0), (2.0, -1.0)), restitution=1.0),
}
RUBS = (
    {},
    {"friction": 0.2},
    {"friction": 0.2, "rolling": True},
    {"gravity": 100.0, "ball_restitution": 0.0},
)


def board(anvil: str, rub) -> Table:
    """A left paddle that presses a ball against something, and a right one that does not."""
    return table_of(HIGH_LEFT, HIGH_RIGHT, ANVILS[anvil], **rub)


class Beside:
    """A world, and beside it two more in which each of its balls is by itself."""

    def __init__(self, table: Table, seed: int, tick_rate: int) -> None:
        self.world, *self.twins = (World(table, seed, tick_rate) for _ in range(3))
        self.seen: Counter[str] = Counter()

    def step(self, **held: bool) -> None:
        """One tick; what is seen is counted.

        A ball by itself must go the same way, if the other one is jammed in this tick and it is not, and it
        meets neither the other ball nor a paddle, which may stall.
        """
        world, seen = self.world, self.seen
        before = world.records[0].copy()
        far = [is_far(world, slot) for slot in range(2)]
        world.step(**held)
        assert deepest(*world.records) <= DEPTH
        assert Motion.HELD not in world.records[0]["ball"]["motion"]
        jammed = {event.ball for event in world.events if event.kind == "jam"}
        seen["jams"] += len(jammed)
        met = {event.ball for event in world.events if event.part.startswith("paddle")}
        if world.events_lost or any(event.kind.startswith("ball_") for event in world.events):
            met = set(before["ball"]["id"].tolist())
        for slot, twin in enumerate(self.twins):
            id_ = before["ball"]["id"][slot]
            if not jammed or id_ == 0 or id_ in jammed or (id_ in met and not far[slot]):
                continue
            twin._batch.state[0] = before
            twin.records[0]["ball"][1 - slot] = 0
            twin.step(**held)
            assert world.records[0]["ball"][slot].tobytes() == twin.records[0]["ball"][slot].tobytes()
            seen["compared"] += 1
            seen["met something"] += bool(twin.events)


JAMMING = (53, 66, 148, 157, 208, 245, 246, 252, 259, 275, 301, 322)
"""Hostile boards on which there are many jams."""


def is_far(world: World, slot: int) -> bool:
    """Whether a ball can meet neither the other ball nor a paddle in the next tick."""
    board, balls = world.table.board, world.records[0]["ball"]
    way = (
        board.speed_cap + (1.0 + board.friction * 60.0) * board.gravity / world.tick_rate
    ) / world.tick_rate
    x, z = balls["x"][slot], balls["z"][slot]
    pivots = [(*paddle.pivot, paddle.reach + board.ball_radius + way) for paddle in world.table.paddle]
    other = (balls["x"][1 - slot], balls["z"][1 - slot], 2.0 * (board.ball_radius + way))
    return all(math.hypot(x - px, z - pz) > reach for px, pz, reach in (*pivots, other))


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize("rub", RUBS, ids=str)
@pytest.mark.parametrize("anvil", ANVILS)
def test_a_ball_flies_on_bit_for_bit_while_the_other_one_is_jammed(anvil: str, rub, tick_rate: int) -> None:
    beside = Beside(board(anvil, rub), 0, tick_rate)
    empty, seen = beside.world.save(), beside.seen
    for number in range(12):
        pick, world = random.Random(number), beside.world
        world.restore(empty)
        put(world, pick, (-0.4, 0.6), (-2.4, -1.0), 0.0)
        put(world, pick, (3.0, 9.0), (-4.0, 4.0), 9.0)
        for tick in range(2 * tick_rate):
            beside.step(left=tick < tick_rate)
    assert seen["jams"] > 10
    assert seen["compared"] > 10


def put(world: World, pick: random.Random, xs, zs, speed: float) -> None:
    """A ball at a free place in these bounds, at most so fast in each direction."""
    for _ in range(1000):
        place = pick.uniform(*xs), pick.uniform(*zs)
        with contextlib.suppress(NoRoom):
            world.create_ball(place, (pick.uniform(-speed, speed), pick.uniform(-speed, speed)))
            return
    raise AssertionError("no room in these bounds")


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_the_same_on_hostile_boards_on_which_anything_can_be_jammed(tick_rate: int) -> None:
    seen: Counter[str] = Counter()
    for number in JAMMING:
        beside = Beside(hostile_table(number), number, tick_rate)
        pick, left = random.Random(number), False
        for _ in range(5 * tick_rate):
            with contextlib.suppress(NoRoom, BoardFull):
                beside.world.create_ball()
            left ^= pick.random() < 6.0 / tick_rate
            beside.step(left=left, right=not left)
        seen += beside.seen
    assert seen["jams"] > 20
    assert seen["compared"] > 5


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize("rub", RUBS, ids=str)
def test_a_ball_that_is_thrown_at_a_jammed_one_bounces_off_and_gets_into_nothing(rub, tick_rate: int) -> None:
    """The jammed ball may be held until the tick is over; it is like a wall then, and may be jammed again."""
    beside = Beside(board("wall", rub), 0, tick_rate)
    pick, world = random.Random(5), beside.world
    put(world, pick, (-0.4, 0.6), (-2.4, -1.0), 0.0)
    put(world, pick, (3.0, 9.0), (-4.0, 4.0), 0.0)
    start, hits = world.save(), 0
    record = world.records[0]
    thrown = record["ball"][:2]
    for tick in range(6 * tick_rate):
        if 0 in thrown["id"].tolist():
            hits += int(record["ball_hits"])
            world.restore(start)
        turn, away = pick.uniform(0, 2 * math.pi), pick.uniform(0.501, 0.8)
        x, z = thrown["x"][0] + away * math.sin(turn), thrown["z"][0] + away * math.cos(turn)
        if tick % max(2, tick_rate // 12) == 0 and world.clearance(x, z) > 1e-6:
            speed = -pick.uniform(1.0, 20.0)
            thrown["x"][1], thrown["z"][1] = x, z
            thrown["vx"][1], thrown["vz"][1] = speed * math.sin(turn), speed * math.cos(turn)
        beside.step(left=True)
    assert beside.seen["jams"] > 10
    assert hits + record["ball_hits"] > 5
