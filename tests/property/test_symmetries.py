"""Invariances: mirror, direction of time and tick rate do not matter, and the energy does not grow.

A path between round obstacles magnifies the smallest difference at each bounce. Where it would magnify
1e-13 u to more than 1e-10 u within the five bounces, rounding alone decides what comes out, so such starts
are left out (a second flight beside the first tells).
"""

from __future__ import annotations

import math

import numpy as np
from hypothesis import assume, given, settings, strategies as st

from boards import CONTACTS, edited, full_table, launched, mirrored, moment, place, speed_of
from silverball.physics.tolerances import HOP, HOP_SHARE
from silverball.table import SlantWall, Table, generate_table
from silverball.world import World
from spinning import Spin, energy, spinning

BOUNCES = 5
SAME = 1e-9
BESIDE = 1e-13  # [u] how far beside the first flight the second one starts

starts = st.tuples(
    st.floats(-4.5, 9.0), st.floats(-4.5, 4.5), st.floats(0, 2 * math.pi), st.floats(2, 16)
).map(lambda s: (s[0], s[1], s[3] * math.sin(s[2]), s[3] * math.cos(s[2])))
spins = st.tuples(*[st.floats(-60, 60)] * 3)
rubs = st.sampled_from(
    [
        {},
        {"friction": 0.2},
        {"friction": 0.2, "rolling": True},
        {"friction": 0.02, "rolling": True},
        {"friction": 1.0, "rolling": True, "slope": 2.0},
    ]
)
buttons = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=12)


def is_free(table: Table, *balls) -> bool:
    world = World(table)
    apart = len(balls) < 2 or math.dist(balls[0][:2], balls[1][:2]) > 0.51
    return apart and all(world.clearance(*ball[:2]) > 1e-3 for ball in balls)


def bounces(world: World, pressed=((False, False),), seconds: float = 2.5, count: int = BOUNCES):
    """The first contacts: time, part, ball, place, velocity of the ball at the end of that tick. A button
    stays for 0.1 s."""
    seen = []
    for tick in range(round(seconds * world.tick_rate)):
        left, right = pressed[tick * 10 // world.tick_rate % len(pressed)]
        world.step(left=left, right=right)
        assert world.fault is None
        seen += [
            (moment(world, e), e.part, e.ball, *place(e), e.speed) for e in world.events if e.kind in CONTACTS
        ]
        if len(seen) >= count:
            break
    return seen[:count]


def difference(one, other) -> float:
    """The largest difference of two lists of bounces; infinite if they are of different parts."""
    if [row[1:3] for row in one] != [row[1:3] for row in other]:
        return math.inf
    return max(
        (
            abs(x - y)
            for a, b in zip(one, other, strict=True)
            for x, y in zip(a[3:] + a[:1], b[3:] + b[:1], strict=True)
        ),
        default=0.0,
    )


def is_tame(
    table: Table, balls, seen, pressed=((False, False),), turns: tuple[Spin, ...] = (), **how
) -> bool:
    """Whether a flight that starts a little beside meets the same, a little beside."""
    (x, z, vx, vz), *rest = balls
    start = ((x + BESIDE, z - BESIDE, vx, vz), *rest)
    beside = bounces(start_of(table, start, turns, **how), pressed)
    return difference(seen, beside) < 1000 * BESIDE


def start_of(table: Table, balls, turns: tuple[Spin, ...] = (), **how) -> World:
    """A world with balls, and with these spins if there are any."""
    if not turns:
        return launched(table, *balls, **how)
    return spinning(table, *zip(balls, turns, strict=True), **how)


def rubbing(table: Table, rub) -> Table:
    """The same table with friction."""
    return table.model_copy(update={"board": table.board.model_copy(update=rub)})


@settings(max_examples=80)
@given(st.integers(0, 30), rubs, starts, starts, spins, spins, st.booleans(), buttons)
def test_the_mirrored_board_with_swapped_buttons_gives_the_mirrored_path(
    board, rub, one, other, turn, other_turn, two, pressed
) -> None:
    """A spin is mirrored too: as a pseudovector it keeps its part along z alone."""
    table = rubbing(generate_table(board), rub)
    balls, turns = ((one, other), (turn, other_turn)) if two else ((one,), (turn,))
    assume(is_free(table, *balls))
    world = start_of(table, balls, turns)
    seen = bounces(world, pressed)
    assume(seen and is_tame(table, balls, seen, pressed, turns))
    swap = {"board.left": "board.right", "paddle.left": "paddle.right"}
    swap |= {value: key for key, value in swap.items()}
    flipped = [(x, -z, vx, -vz) for x, z, vx, vz in balls]
    unturned = tuple((-wx, -wy, wz) for wx, wy, wz in turns)
    mirror = start_of(mirrored(table), flipped, unturned)
    reflected = bounces(mirror, [(right, left) for left, right in pressed])
    back = [(t, swap.get(part, part), ball, x, -z, speed) for t, part, ball, x, z, speed in reflected]
    assert difference(seen, back) <= SAME
    for ball, image in zip(world.balls, mirror.balls, strict=True):
        wx, wy, wz = image.spin
        assert math.dist(ball.spin, (-wx, -wy, wz)) <= SAME / table.board.ball_radius * 100


def test_a_mirrored_paddle_mirrors_to_the_bit() -> None:
    table = full_table().model_copy(update={"triangular_prism": ()})
    rng = np.random.default_rng(2)
    world, other = World(table), World(mirrored(table))
    world.create_ball((2.0, 3.0), (1.0, 2.0))
    other.create_ball((2.0, -3.0), (1.0, -2.0))
    for _ in range(600):
        left, right = (rng.random(2) < 0.5).tolist()
        world.step(left=left, right=right)
        other.step(left=right, right=left)
        assert world.paddles == other.paddles[::-1]
        for a, b in zip(world.balls, other.balls, strict=True):
            assert (place(a), speed_of(a)) == ((place(b)[0], -place(b)[1]), (speed_of(b)[0], -speed_of(b)[1]))


def elastic_table() -> Table:
    """Everything gives back what it gets; the cap is far away, and everything is a hit."""
    return full_table(boost=1.0, restitution=1.0, speed_cap=200.0, hit_speed=0.01)


@settings(max_examples=40)
@given(starts, starts, st.booleans())
def test_with_restitution_one_time_runs_back_as_well(one, other, two) -> None:
    table = elastic_table()
    balls = (one, other) if two else (one,)
    assume(is_free(table, *balls))
    world = launched(table, *balls)
    seen = bounces(world)
    assume(len(seen) == BOUNCES and len(world.balls) == len(balls) and min(row[-1] for row in seen) > 0.05)
    assume(is_tame(table, balls, seen))

    def turn_back(record) -> None:
        record["ball"]["vx"] *= -1.0
        record["ball"]["vz"] *= -1.0

    # From the state at the end, with all velocities turned round, the same number of ticks leads to the
    # start.
    ticks = world.tick
    world.restore(edited(world, turn_back))
    world.step(ticks=ticks)
    for ball, (x, z, vx, vz) in zip(world.balls, balls, strict=True):
        assert math.dist(place(ball), (x, z)) <= SAME
        assert (
            math.dist(speed_of(ball), (-vx, -vz)) <= 10 * SAME
        )  # in 1/10 s it changes as much as the place in one


@settings(max_examples=40)
@given(st.integers(0, 30), starts, starts, st.booleans())
def test_the_tick_rate_does_not_matter_while_no_tick_end_clamp_plays_a_part(board, one, other, two) -> None:
    table = generate_table(board)
    table = table.model_copy(update={"board": table.board.model_copy(update={"speed_cap": 100.0})})
    balls = (one, other) if two else (one,)
    assume(is_free(table, *balls))
    seen = bounces(launched(table, *balls, tick_rate=60))
    assume(seen and is_tame(table, balls, seen, tick_rate=60))
    for tick_rate in (10, 240, 1000):
        assert difference(seen, bounces(launched(table, *balls, tick_rate=tick_rate))) <= SAME


@settings(max_examples=60)
@given(st.none() | st.integers(0, 30), rubs, starts, starts, spins, spins)
def test_energy_never_grows_without_a_moving_paddle_a_boost_or_a_hop(
    board, rub, one, other, turn, other_turn
) -> None:
    """Energy of motion, of spin and of height. A touch may add that of a hop, ½·(hop speed)²; all else takes
    energy or leaves it. On the elastic board nothing but friction takes any."""
    table = rubbing(elastic_table() if board is None else generate_table(board), rub)
    calm = tuple(part.model_copy(update={"speed_factor": 1.0, "restitution": 1.0}) for part in table.cylinder)
    table = table.model_copy(update={"cylinder": calm})
    assume(is_free(table, one, other))
    world = spinning(table, (one, turn), (other, other_turn), tick_rate=60)
    g = table.board.gravity
    press = g / math.tan(math.radians(table.board.slope)) if table.board.rolling else 0.0
    hop = min((g + table.board.friction * press) * HOP, 0.5 * (HOP_SHARE * table.board.hit_speed) ** 2)
    before, touches = energy(world), 0
    while world.balls and world.tick < 600:
        count = len(world.balls)
        world.step()
        if len(world.balls) < count:  # the energy of a ball that is gone goes with it
            before, touches = energy(world), int(world.records[0]["touches"])
        now = int(world.records[0]["touches"])
        # Rounding: each contact at 22 u/s by some ulp(22²/2) = 3e-14.
        assert energy(world) <= before + (now - touches) * hop * (1 + 1e-9) + 1e-11
        before, touches = energy(world), now


def test_elastic_bouncing_keeps_its_energy_for_a_thousand_seconds() -> None:
    """Restitution 1 everywhere, gutter out of reach of the flight: 0.5·v² + g·x stays to rounding."""
    table = full_table(
        SlantWall(start=(-8.9, -5.0), end=(-8.9, 5.0)),
        boost=1.0,
        restitution=1.0,
        speed_cap=200.0,
        hit_speed=0.01,
    )
    world = launched(table, (1.5, 2.0, 6.0, 7.0), tick_rate=60)
    first = 0.5 * (36.0 + 49.0) + 10.0 * 1.5
    worst = 0.0
    for _ in range(1000):
        world.step(ticks=60)
        ((x, _), (vx, vz)) = place(world.balls[0]), speed_of(world.balls[0])
        worst = max(worst, abs(0.5 * (vx * vx + vz * vz) + 10.0 * x - first))
    hits = sum(world.hits.values())
    print(
        f"energy: off by {worst:.1e} of {first} u²/s² after 1000 s, {hits} bounces "
        f"and {world.records[0]['touches']} touches"
    )
    assert hits > 2000
    # 60,000 ticks, each rounding a speed by half of ulp(8) = 1.8e-15 at most, always the same way at worst,
    # at 10 u/s; a touch below 0.01 u/s may add its hop.
    assert worst <= 60_000 * 0.5 * 1.8e-15 * 10 + int(world.records[0]["touches"]) * 0.5 * (0.9 * 0.01) ** 2
