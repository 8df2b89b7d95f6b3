"""Friction at a contact: Coulomb's law, computed here from vectors.

A contact pushes with the impulse P = (1 + e)·w along its normal n (by the mass). The ball's surface there
slides with s = v + ω × (−r·n) − u over a surface that moves with u. Friction J against it is what stops the
slide, or μ·P if that is less; it changes v by J and ω by (−r·n) × J / (2/5·r²). The playfield keeps y, so
along y J only turns the ball. Here the playfield is smooth: balls slide, and keep their spin in flight.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import LEFT, PADDLES, contacts, first_contact, full_table, launched, moment, speed_of, table_of
from oracle import Twin, cross, plus, pushed, rubbing, surface_slip
from silverball.table import Cylinder, SlantWall, TriangularPrism
from silverball.world import World
from spinning import energy, spin_balls, spinning

RADIUS = 0.25
GRAVITY = 10.0
FLOOR = SlantWall(start=(-8.9, -5.0), end=(-8.9, 5.0))
"""It keeps balls from the gutter."""

CLOSE = 1e-9
"""A few dozen operations; spins reach some 200 rad/s."""


def through_contact(velocity, spin, normal, friction, e, surface=(0.0, 0.0, 0.0), factor=1.0):
    """Velocity, spin and whether friction stopped the slide, after a contact with a part."""
    approach = -sum(n * (v - u) for n, v, u in zip(normal, velocity, surface, strict=True))
    push = (1 + e) * approach
    arm = tuple(-RADIUS * n for n in normal)
    slip = plus(surface_slip(velocity, spin, arm), surface, -1.0)
    impulse = rubbing(slip, normal, friction * push)
    after, turned = pushed(velocity, spin, arm, impulse)
    left = plus(surface_slip(after, turned, arm), surface, -1.0)
    along = cross((0.0, 1.0, 0.0), normal)
    roll_age = math.hypot(left[1], sum(a * b for a, b in zip(left, along, strict=True))) < 1e-9
    after = plus(after, normal, push)
    return tuple(factor * v for v in after), turned, roll_age


def at(world: World, time: float):
    """The velocity of the first ball now, less what gravity has done since `time`."""
    (vx, _, vz), spin = world.balls[0].velocity, world.balls[0].spin
    return (vx + GRAVITY * (world.time - time), 0.0, vz), spin


PLACES = {
    "board.left": ((0.0, -4.5), (0.0, -1.0), ()),
    "board.right": ((0.0, 4.5), (0.0, 1.0), ()),
    "board.top": ((9.5, 0.0), (1.0, 0.0), ()),
    "slant_wall[0]": ((0.5, 0.5), (-1.0, -1.0), (SlantWall(start=(2.0, -2.0), end=(-2.0, 2.0)),)),
    "cylinder[0]": (
        (2.0, 0.3), (-1.0, 0.1),
        (Cylinder(center=(0, 0), radius=1.5, speed_factor=1.3, restitution_falloff=0.05),),
    ),
    "triangular_prism[0]": (
        (0.4, 0.0), (-1.0, 0.0),
        (TriangularPrism(vertices=((0.0, -3.0), (0.0, 3.0), (-3.0, 0.0)), speed_factor=0.9),),
    ),
    "paddle.left": ((-5.9, -1.5), (-1.0, 0.0), (LEFT,)),
}  # fmt: skip
"""Where a ball starts, which way is towards the part, and the part."""


@pytest.mark.parametrize("part", PLACES)
def test_a_spinning_ball_leaves_a_part_as_coulomb_s_law_says(part: str) -> None:
    start, toward, parts = PLACES[part]
    rng = np.random.default_rng(11)
    seen = {True: 0, False: 0}
    for _ in range(60):
        friction = float(rng.choice([0.02, 0.1, 0.3, 1.0, 2.0]))
        turn, speed = math.atan2(*toward) + rng.uniform(-1.2, 1.2), rng.uniform(4.0, 15.0)
        velocity = (float(speed * math.sin(turn)), float(speed * math.cos(turn)))
        spin = tuple(rng.uniform(-60, 60, 3).tolist())
        table = table_of(*parts, friction=friction, wall_restitution=0.8, speed_cap=100)
        world = spinning(table, ((*start, *velocity), spin))
        event = next(contacts(world, 240), None)
        if event is None or event.part != part:
            continue
        assert event.kind == "hit"
        time = moment(world, event)
        path, _, index = part.partition("[")
        surface = getattr(table, path)[0] if index else LEFT if path == "paddle.left" else None
        e0, falloff = (0.8, 0.0) if surface is None else (surface.restitution, surface.restitution_falloff)
        before = (velocity[0] - GRAVITY * time, 0.0, velocity[1])
        expected, turned, roll_age = through_contact(
            before, spin, event.normal, friction, e0 / (1 + falloff * event.speed),
            factor=getattr(surface, "speed_factor", 1.0),
        )  # fmt: skip
        after, spin_after = at(world, time)
        assert after == pytest.approx(expected, abs=CLOSE)
        assert spin_after == pytest.approx(turned, abs=CLOSE / RADIUS)
        seen[roll_age] += 1
    assert min(seen.values()) >= 8, seen


@pytest.mark.parametrize(("friction", "roll_age"), [(1.0, True), (0.05, False)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_border_slows_a_sliding_ball_to_five_sevenths_or_by_all_of_its_friction(
    friction: float, roll_age: bool, side: float
) -> None:
    """Without spin: J = v/(7/2) stops the slide, and then r·ω_y is the speed along the border."""
    e, vx, vz = 0.8, 6.0, 6.0
    world = launched(table_of(friction=friction, wall_restitution=e), (0.0, side * 4.0, vx, side * vz))
    event = first_contact(world)
    time = moment(world, event)
    along = vx - GRAVITY * time
    lost = along * 2 / 7 if roll_age else friction * (1 + e) * vz
    (ax, _, az), (wx, wy, wz) = at(world, time)
    assert (ax, az) == pytest.approx((along - lost, -side * e * vz), abs=CLOSE)
    # The right border holds the ball's right side back while it flies up, so its upper side turns to the
    # right: from +x towards +z, which is ω_y < 0.
    assert wy == pytest.approx(-side * 2.5 * lost / RADIUS, abs=CLOSE)
    assert (wx, wz) == (0.0, 0.0)
    slide = along - lost - side * -RADIUS * wy
    assert (abs(slide) < CLOSE) == roll_age
    assert slide >= -CLOSE


@pytest.mark.parametrize(("friction", "stops"), [(0.1, False), (0.5, True)])
def test_a_ball_that_rolls_head_on_into_the_top_border_loses_spin_and_no_speed(friction, stops) -> None:
    """Its front goes down over the border with v; J = 2/5·v upwards stops that, if friction can give it.

    The playfield takes the upward impulse, so the speed is only turned round.
    """
    e, v = 0.8, 8.0
    world = launched(table_of(friction=friction, wall_restitution=e), (9.0, 0.0, v, 0.0))
    time_to_border = (v - math.sqrt(v * v - 2 * GRAVITY * (10 - 0.1 - RADIUS - 9.0))) / GRAVITY
    speed = v - GRAVITY * time_to_border
    spin_balls(world, (0.0, 0.0, -speed / RADIUS))
    event = first_contact(world)
    assert (event.part, event.normal) == ("board.top", (-1.0, 0.0, 0.0))
    (ax, _, az), spin = at(world, moment(world, event))
    assert (ax, az) == pytest.approx((-e * speed, 0.0), abs=CLOSE)
    impulse = 2 / 5 * speed if stops else friction * (1 + e) * speed
    assert spin == pytest.approx((0.0, 0.0, -speed / RADIUS + 2.5 * impulse / RADIUS), abs=CLOSE)
    assert (abs(spin[2]) < CLOSE) == stops


@pytest.mark.parametrize("paddle", PADDLES)
@pytest.mark.parametrize("friction", [0.002, 0.8])
@pytest.mark.parametrize("where", [0.4, 0.8])
def test_a_moving_paddle_drags_the_ball_along(paddle, friction: float, where: float) -> None:
    """A ball at rest above the flat of a lifting paddle, whose surface moves with ω × r at the contact."""
    side = 1.0 if paddle.side == "left" else -1.0
    omega = math.radians(paddle.up_angle - paddle.rest_angle) / paddle.stroke
    start = (paddle.pivot[0] + 0.9, paddle.pivot[1] + side * where * paddle.length)
    table = table_of(paddle, friction=friction, speed_cap=60)
    world = launched(table, (*start, 0.0, 0.0), tick_rate=240)
    event = first_contact(world, **{paddle.side: True})
    assert event.part == f"paddle.{paddle.side}"
    time = moment(world, event)
    assert time < paddle.stroke
    n = event.normal
    arm = (
        event.position[0] - RADIUS * n[0] - paddle.pivot[0],
        0.0,
        event.position[2] - RADIUS * n[2] - paddle.pivot[1],
    )
    surface = cross((0.0, side * omega, 0.0), arm)  # about +y a left paddle turns from z to x: it lifts
    e = paddle.restitution / (1 + paddle.restitution_falloff * event.speed)
    before = (-GRAVITY * time, 0.0, 0.0)
    expected, turned, roll_age = through_contact(before, (0.0, 0.0, 0.0), n, friction, e, surface)
    after, spin = at(world, time)
    assert after == pytest.approx(expected, abs=CLOSE)
    assert spin == pytest.approx(turned, abs=CLOSE)
    assert roll_age == (friction > 0.5)
    # In words: the surface that goes by takes the ball along, and turns it like a wheel.
    along = cross((0.0, 1.0, 0.0), n)
    relative = sum(a * (u - v) for a, u, v in zip(along, surface, before, strict=True))
    gained = sum(a * (v - b) for a, v, b in zip(along, after, before, strict=True))
    assert gained * relative > 0.0
    assert spin[1] * gained < 0.0


def meeting(friction: float, beside: float, va: float, spins, e: float = 0.95):
    """Two balls of which one meets the other, `beside` to the side; all before and after the contact."""
    table = table_of(friction=friction, ball_restitution=e, gravity=0.1, length=40, width=20, gutter=-19)
    a, b = (0.0, 0.0, va, 0.0), (2.0, beside, 0.0, 0.0)
    world = spinning(table, (a, spins[0]), (b, spins[1]), tick_rate=1000)
    event = next(event for event in contacts(world, 2000) if event.part == "ball")
    time = moment(world, event)
    before = [(ball[2] - 0.1 * time, 0.0, ball[3]) for ball in (a, b)]
    after = [(ball.velocity[0] + 0.1 * (world.time - time), 0.0, ball.velocity[2]) for ball in world.balls]
    return event.normal, before, after, [ball.spin for ball in world.balls]


NO_SPINS = ((0.0, 0.0, 0.0),) * 2


@pytest.mark.parametrize(("friction", "roll_age"), [(0.02, False), (1.5, True)])
@pytest.mark.parametrize("beside", [0.3, -0.3, 0.1, 0.45])
def test_balls_that_glance_off_each_other_take_each_other_along(friction, roll_age, beside) -> None:
    """Without spin: each has half of the slide, so J = v_t/7 stops it, and both turn the same way."""
    n, before, after, spins = meeting(friction, beside, 8.0, NO_SPINS)
    along = cross((0.0, 1.0, 0.0), n)
    approach = -sum(x * (p - q) for x, p, q in zip(n, *before, strict=True))
    slide = sum(x * (p - q) for x, p, q in zip(along, *before, strict=True))
    most = friction * (1 + 0.95) / 2 * approach
    assert (abs(slide) / 7 <= most) == roll_age
    impulse = -slide / 7 if roll_age else -math.copysign(most, slide)
    push = (1 + 0.95) / 2 * approach
    for ball, sign in ((0, 1.0), (1, -1.0)):
        expected = plus(plus(before[ball], n, sign * push), along, sign * impulse)
        assert after[ball] == pytest.approx(expected, abs=CLOSE)
    assert plus(*after) == pytest.approx(plus(*before), abs=CLOSE)  # the momentum
    # (−r·n) × (J·t) with t = ŷ × n is −r·J·ŷ for a; for b, both signs turn round.
    turn = -2.5 / RADIUS * impulse
    assert spins == [pytest.approx((0.0, turn, 0.0), abs=CLOSE)] * 2


def test_spinning_balls_meet_as_coulomb_s_law_says() -> None:
    rng = np.random.default_rng(5)
    seen = {True: 0, False: 0}
    for _ in range(60):
        friction, beside = float(rng.choice([0.03, 0.2, 1.0, 2.0])), float(rng.uniform(-0.4, 0.4))
        spins = [tuple(rng.uniform(-40, 40, 3).tolist()) for _ in range(2)]
        n, before, after, turned = meeting(friction, beside, 6.0, spins)
        arm = tuple(-RADIUS * x for x in n)
        other = tuple(RADIUS * x for x in n)
        slip = plus(surface_slip(before[0], spins[0], arm), surface_slip(before[1], spins[1], other), -1.0)
        approach = -sum(x * (p - q) for x, p, q in zip(n, *before, strict=True))
        push = (1 + 0.95) / 2 * approach
        impulse = rubbing(slip, n, friction * push, bodies=2)
        va, wa = pushed(before[0], spins[0], arm, impulse)
        vb, wb = pushed(before[1], spins[1], other, plus((0.0, 0.0, 0.0), impulse, -1.0))
        assert after[0] == pytest.approx(plus(va, n, push), abs=CLOSE)
        assert after[1] == pytest.approx(plus(vb, n, -push), abs=CLOSE)
        assert turned == [pytest.approx(wa, abs=CLOSE / RADIUS), pytest.approx(wb, abs=CLOSE / RADIUS)]
        seen[math.hypot(*impulse) < friction * push * (1 - 1e-9)] += 1
    assert min(seen.values()) >= 10, seen


# --- without friction


def test_a_spin_survives_a_board_without_friction_to_the_bit() -> None:
    spins = [(11.0, -7.0, 3.3), (-1.0, 20.0, 0.1)]
    world = spinning(
        full_table(), *zip([(1.5, 2.0, 6.0, 7.0), (6.5, -3.0, 1.0, 9.0)], spins, strict=True), tick_rate=60
    )
    met = 0
    for tick in range(600):
        world.step(left=tick % 40 < 20, right=tick % 50 < 20, jitter=tick % 100 == 0)
        met += sum(event.part not in ("", "gutter") for event in world.events)
        for ball in world.balls:
            assert ball.spin == spins[ball.id - 1]
    assert met > 20


def played(table, ticks: int = 900, seed: int = 4) -> str:
    """The digest of a game of random presses, its boards alike but for what the digest must not tell."""
    world = World(table, seed=seed, tick_rate=60)
    rng = np.random.default_rng(seed)
    for tick in range(ticks):
        if tick % 20 == 0 and len(world.balls) < 2:
            world.create_ball()
        left, right = (rng.random(2) < 0.3).tolist()
        world.step(left=left, right=right, jitter=tick % 90 == 0)
    return world.digest()


def test_without_friction_neither_the_slope_nor_rolling_changes_a_bit() -> None:
    table = full_table()
    boards = [
        {},
        {"slope": 30.0},
        {"friction": 0.0, "rolling": True},  # not to be had from a file; the physics need not care
    ]
    digests = {
        played(table.model_copy(update={"board": table.board.model_copy(update=update)})) for update in boards
    }
    assert len(digests) == 1
    other = table.model_copy(update={"board": table.board.model_copy(update={"friction": 0.01})})
    assert played(other) not in digests


@pytest.mark.parametrize("rolling", [False, True])
def test_a_tiny_friction_makes_a_tiny_difference(rolling: bool) -> None:
    """The first contacts on boards whose friction differs by 1e-13 lie within 1e-9 of one another."""
    seen = []
    for friction in (0.0, 1e-13):
        table = full_table(FLOOR, friction=friction)
        if friction:
            table = table.model_copy(update={"board": table.board.model_copy(update={"rolling": rolling})})
        world = spinning(
            table, ((1.5, 2.0, 6.0, 7.0), (5.0, 4.0, 3.0)), ((6.5, -3.0, 1.0, 9.0), (0.0, 9.0, 0.0))
        )
        seen.append(
            [(event.part, moment(world, event), *event.position) for event in contacts(world, 480)][:4]
        )
    assert len(seen[0]) == 4
    for without, tiny in zip(*seen, strict=True):
        assert without[0] == tiny[0]
        assert without[1:] == pytest.approx(tiny[1:], abs=1e-9)


def test_a_rough_contact_takes_energy_or_leaves_it() -> None:
    """One contact after the other, with any spin; only a touch may add its hop."""
    rng = np.random.default_rng(8)
    lost = []
    for _ in range(120):
        friction = float(rng.choice([0.01, 0.2, 2.0]))
        table = full_table(
            FLOOR, friction=friction, boost=1.0, restitution=1.0, speed_cap=200.0, hit_speed=0.01
        )
        start = (1.5, 2.0, *rng.uniform(-9, 9, 2).tolist())
        world = spinning(table, (start, tuple(rng.uniform(-80, 80, 3).tolist())))
        before = energy(world)
        for _ in contacts(world, 240):
            now = energy(world)
            assert now <= before + 1e-11
            lost.append(before - now)
            before = now
    assert len(lost) > 100
    assert sum(loss > 1e-3 for loss in lost) > 60


def test_rough_contacts_are_those_of_the_slow_twin() -> None:
    """Paddles in motion too; the twin knows friction as a law of vectors."""
    table = full_table(speed_cap=40, friction=0.25)
    rng = np.random.default_rng(21)
    probe = World(table)
    compared, parts = 0, set()
    for _ in range(45):
        balls = [
            (float(rng.uniform(-6.8, -5.0)), float(rng.uniform(-2, 2)), *rng.uniform(-12, 12, 2).tolist()),
            (float(rng.uniform(-1, 8)), float(rng.uniform(-4, 4)), *rng.uniform(-15, 15, 2).tolist()),
        ]
        if (
            min(probe.clearance(*ball[:2]) for ball in balls) < 0.01
            or math.dist(balls[0][:2], balls[1][:2]) < 0.6
        ):
            continue
        spins = [tuple(rng.uniform(-50, 50, 3).tolist()) for _ in balls]
        held = {"left": bool(rng.random() < 0.7), "right": bool(rng.random() < 0.7)}
        twin = Twin(table, balls, spins).run(0.2, held)
        world = spinning(table, *zip(balls, spins, strict=True), tick_rate=60)
        seen = list(contacts(world, 12, **held))
        for event, bounce in zip(seen[:4], twin[:4], strict=False):
            if min(event.speed, bounce.speed) < 1.0:
                break
            assert (event.part, event.ball) == (bounce.part, bounce.ball + 1)
            assert moment(world, event) == pytest.approx(bounce.time, abs=1e-6)
            assert event.position[::2] == pytest.approx((bounce.x, bounce.z), abs=1e-6)
            assert event.speed == pytest.approx(bounce.speed, abs=1e-4)
            compared += 1
            parts.add(event.part.split("[")[0])
    assert compared >= 30
    assert parts >= {"paddle.left", "paddle.right", "triangular_prism", "cylinder"}


def test_the_speeds_after_many_rough_bounces_are_finite_and_below_the_cap() -> None:
    world = spinning(
        full_table(friction=2.0, rolling=True, slope=1.0),
        ((1.5, 2.0, 6.0, 7.0), (1e6, -1e6, 1e6)),
        tick_rate=60,
    )
    for tick in range(300):
        world.step(left=tick % 40 < 20, right=tick % 40 < 20)
        for ball in world.balls:
            assert math.hypot(*speed_of(ball)) <= 22.0
            assert all(math.isfinite(turn) for turn in ball.spin)


def test_a_pinched_ball_that_is_held_loses_its_spin_too() -> None:
    """With next to no friction nothing but the holding takes the spin away."""
    paddle = LEFT.model_copy(update={"pivot": (0.0, -2.5), "up_angle": 60.0})
    table = table_of(paddle, SlantWall(start=(1.0, -3.0), end=(1.0, 3.0)), friction=1e-12)
    world = spinning(table, ((0.4, -1.2, 0.0, 0.0), (100.0, 200.0, -300.0)), tick_rate=60)
    while world.jams == 0:
        assert math.hypot(*world.balls[0].spin) > 300.0
        world.step(left=True)
    assert math.hypot(*world.balls[0].spin) < 1e-6


def test_nothing_is_left_of_a_spinning_ball_that_has_gone_through_the_gutter() -> None:
    """An empty slot is all zeros, so that equal worlds have equal digests."""
    world = spinning(table_of(friction=0.2), ((-8.5, 0.0, -5.0, 0.0), (10.0, 20.0, 30.0)))
    while world.balls:
        world.step()
    assert not any(world.records[0]["ball"].tobytes())
