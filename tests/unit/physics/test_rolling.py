"""A ball on a playfield with friction: slipping, rolling, and the change from one to the other.

Laws of a solid sphere on a slope, by its mass: gravity g down the slope, the playfield pressed with
p = g/tan(slope), friction f at the lowest point, at most μ·p. The lowest point moves with u = v − q, where
q = (−r·ω_z, r·ω_x) is the velocity that the spin alone would roll with, and

    dv/dt = g + f,   dq/dt = −5/2·f,   so   du/dt = g + 7/2·f.

So w = (5·v + 2·q)/7, which is the angular momentum about a point of the playfield, changes by 5/7·g·t
whatever friction does, and v = w + 2/7·u.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from boards import Paddle, first_contact, launched, moment, place, speed_of, table_of
from oracle import Body, Twin
from silverball.physics.records import Motion
from silverball.physics.tolerances import MIN_SLIP_SPEED
from silverball.table import Cylinder, Table, TriangularPrism
from silverball.world import World
from spinning import Spin, energy, spin_balls, spinning, touch_speed

RADIUS = 0.25
ROUNDING = 1e-11
"""A new flight starts in every tick while a ball slips: a few hundred times some ulp(22)."""


def plain(friction: float = 0.2, **board: float) -> Table:
    """A large board with nothing on it but its borders, which rubs."""
    return table_of(
        **({"length": 50, "width": 50, "gutter": -24, "friction": friction, "rolling": True} | board)
    )


def grip_of(table: Table) -> float:
    """The greatest acceleration by friction, μ·p [u/s²]."""
    return table.board.friction * table.board.gravity / math.tan(math.radians(table.board.slope))


def rolling_velocity(spin: Spin, radius: float = RADIUS) -> tuple[float, float]:
    """q: the velocity with which a ball of this spin would roll."""
    return -radius * spin[2], radius * spin[0]


def rolling_spin(vx: float, vz: float) -> Spin:
    """The spin of a ball that rolls."""
    return vz / RADIUS, 0.0, -vx / RADIUS


def mean_velocity(velocity, spin: Spin) -> tuple[float, float]:
    """w = (5·v + 2·q)/7."""
    q = rolling_velocity(spin)
    return tuple((5.0 * v + 2.0 * r) / 7.0 for v, r in zip(velocity, q, strict=True))


def motion_of(world: World, slot: int = 0) -> Motion:
    """How a ball moves."""
    return Motion(int(world.records[0]["ball"]["motion"][slot]))


def slip_time(start, spin: Spin, table: Table) -> float:
    """When the slip ends: T = (A·|u| + g·u)/(A² − g²), A = 7/2·μ·p > g.

    For d|u|/dt = g·u/|u| − A and d(g·u)/dt = g² − A·g·u/|u|; so A·|u| + g·u falls at the rate A² − g².
    """
    full, gravity = 3.5 * grip_of(table), table.board.gravity
    q = rolling_velocity(spin)
    ux, uz = start[2] - q[0], start[3] - q[1]
    return (full * math.hypot(ux, uz) - gravity * ux) / (full * full - gravity * gravity)


def play_until_it_rolls(world: World, most: int = 4000) -> float:
    """Play until the ball rolls; the time at which it began to [s], which lies within the last tick."""
    for _ in range(most):
        world.step()
        if motion_of(world) == Motion.ROLLING:
            return world.time - float(world.records[0]["ball"]["age"][0])
    raise AssertionError("the ball never rolls")


# --- down the slope from rest


@pytest.mark.parametrize("slope", [1.0, 6.5, 30.0])
@pytest.mark.parametrize("above", [1.001, 1.5, 10.0])
def test_a_ball_with_enough_friction_rolls_down_with_five_sevenths_of_gravity(slope, above) -> None:
    """Rolling takes f = 2/7·g, so μ·p ≥ 2/7·g, or μ ≥ 2/7·tan(slope); more friction changes nothing."""
    friction = above * 2 / 7 * math.tan(math.radians(slope))
    world = launched(plain(friction, slope=slope), (20.0, 1.0, 0.0, 0.0))
    for tick in range(1, 480):
        world.step()
        t = tick / world.tick_rate
        (ball,) = world.balls
        assert place(ball) == pytest.approx((20.0 - 5 / 7 * 10.0 * t * t / 2, 1.0), abs=ROUNDING)
        assert speed_of(ball) == pytest.approx((-5 / 7 * 10.0 * t, 0.0), abs=ROUNDING)
        assert ball.spin == pytest.approx((0.0, 0.0, 5 / 7 * 10.0 * t / RADIUS), abs=ROUNDING / RADIUS)


@pytest.mark.parametrize("slope", [1.0, 6.5, 30.0])
@pytest.mark.parametrize("share", [0.999, 0.5, 0.05])
def test_a_ball_with_too_little_friction_slips_down_forever(slope, share) -> None:
    """f = μ·p up the slope: v = −(g − μ·p)·t, and the spin grows by 5/(2r)·μ·p·t."""
    table = plain(share * 2 / 7 * math.tan(math.radians(slope)), slope=slope)
    grip = grip_of(table)
    world = launched(table, (20.0, 1.0, 0.0, 0.0))
    for tick in range(1, 400):
        world.step()
        t = tick / world.tick_rate
        (ball,) = world.balls
        assert place(ball) == pytest.approx((20.0 - (10.0 - grip) * t * t / 2, 1.0), abs=ROUNDING)
        assert speed_of(ball) == pytest.approx((-(10.0 - grip) * t, 0.0), abs=ROUNDING)
        assert ball.spin == pytest.approx((0.0, 0.0, 2.5 * grip * t / RADIUS), abs=ROUNDING / RADIUS)
        assert motion_of(world) == Motion.SLIPPING


def test_a_ball_that_spins_upwards_on_too_smooth_a_board_stops_slipping_up_and_slips_down() -> None:
    """Its slip ends on the way down through none at all, and friction turns round from down to up."""
    friction = 0.5 * 2 / 7 * math.tan(math.radians(6.5))
    table = plain(friction)
    grip = grip_of(table)
    start, spin = (10.0, 0.0, 0.0, 0.0), (0.0, 0.0, 12.0)  # u = r·ω_z = 3 u/s upwards
    over = 3.0 / (10.0 + 3.5 * grip)  # u falls by gravity and friction both
    world = spinning(table, (start, spin))
    for tick in range(1, 300):
        world.step()
        t = tick / world.tick_rate
        early, late = min(t, over), max(0.0, t - over)
        down = (10.0 + grip) * early + (10.0 - grip) * late
        turn = 12.0 + 2.5 * grip / RADIUS * (late - early)
        (ball,) = world.balls
        assert speed_of(ball) == pytest.approx((-down, 0.0), abs=ROUNDING)
        assert ball.spin == pytest.approx((0.0, 0.0, turn), abs=ROUNDING / RADIUS)


@pytest.mark.parametrize("velocity", [(6.0, 0.0), (-3.0, 0.0), (0.0, 5.0), (4.0, -3.0)])
def test_a_ball_that_rolls_goes_on_rolling_with_five_sevenths_of_gravity(velocity) -> None:
    start = (5.0, 0.0, *velocity)
    world = spinning(plain(), (start, rolling_spin(*velocity)))
    for tick in range(1, 240):
        world.step()
        t = tick / world.tick_rate
        (ball,) = world.balls
        vx = velocity[0] - 50 / 7 * t
        assert place(ball) == pytest.approx(
            (5.0 + velocity[0] * t - 25 / 7 * t * t, velocity[1] * t), abs=ROUNDING
        )
        assert speed_of(ball) == pytest.approx((vx, velocity[1]), abs=ROUNDING)
        assert ball.spin == pytest.approx(rolling_spin(vx, velocity[1]), abs=ROUNDING / RADIUS)
        assert motion_of(world) == Motion.ROLLING


# --- from slipping to rolling

WAYS = [0.0, 0.7, math.pi / 2, 2.5, math.pi, -1.0]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    "spin", [(0.0, 0.0, 0.0), (8.0, -3.0, -20.0), (0.0, 50.0, 40.0)], ids=["none", "some", "much"]
)
@pytest.mark.parametrize("tick_rate", [10, 240])
def test_what_friction_does_leaves_the_angular_momentum_about_a_point_of_the_playfield(
    way, spin, tick_rate
) -> None:
    """w = (5·v + 2·q)/7 changes by 5/7·g·t at all times, so it is the velocity once the ball rolls."""
    start = (0.0, 0.0, 8.0 * math.sin(way), 8.0 * math.cos(way))
    table = plain(0.3)
    world = spinning(table, (start, spin), tick_rate=tick_rate)
    w = mean_velocity(start[2:], spin)
    assert motion_of(world) == Motion.SLIPPING
    while motion_of(world) == Motion.SLIPPING or world.time < 1.0:
        world.step()
        (ball,) = world.balls
        expected = (w[0] - 50 / 7 * world.time, w[1])
        assert mean_velocity(speed_of(ball), ball.spin) == pytest.approx(expected, abs=ROUNDING)
        assert ball.spin[1] == spin[1]  # the ball turns on a point
    assert speed_of(world.balls[0]) == pytest.approx(expected, abs=ROUNDING)


@pytest.mark.parametrize("way", WAYS)
def test_a_ball_launched_without_spin_soon_rolls_with_five_sevenths_of_its_speed(way: float) -> None:
    """In the limit of small gravity, after T = 2·v/(7·μ·p): here g/(μ·p) = tan(1°)/1 = 0.017."""
    table = plain(1.0, gravity=0.1, slope=1.0)
    speed = 6.0
    world = launched(table, (0.0, 0.0, speed * math.sin(way), speed * math.cos(way)), tick_rate=1000)
    began = play_until_it_rolls(world)
    small = 0.1 / grip_of(table)
    assert began == pytest.approx(2 * speed / (7 * grip_of(table)), rel=small)
    assert math.hypot(*speed_of(world.balls[0])) == pytest.approx(5 / 7 * speed, rel=small)


@pytest.mark.parametrize("backspin", [0.5, 2.5, 4.0])
def test_a_ball_with_backspin_rolls_with_what_is_left_and_comes_back_if_that_is_less_than_nothing(
    backspin: float,
) -> None:
    """Across: (5·v − 2·r·|ω|)/7 with r·|ω| = backspin·v, so it comes back above 5/2."""
    start, spin = (0.0, 0.0, 0.0, 4.0), (-backspin * 4.0 / RADIUS, 0.0, 0.0)
    world = spinning(plain(0.3), (start, spin))
    play_until_it_rolls(world)
    assert speed_of(world.balls[0])[1] == pytest.approx((5 - 2 * backspin) * 4.0 / 7, abs=ROUNDING)


@pytest.mark.parametrize("tick_rate", [10, 60, 977])
@pytest.mark.parametrize("vx", [9.0, -5.0])
@pytest.mark.parametrize("turn", [0.0, -20.0, 90.0])
def test_along_the_slope_a_slip_ends_exactly_when_it_should_at_any_tick_rate(tick_rate, vx, turn) -> None:
    """The direction of slip does not turn, so that holding it for a tick is no error at all."""
    table = plain(0.15)
    start, spin = (5.0, 0.0, vx, 0.0), (0.0, 0.0, turn)
    began = play_until_it_rolls(spinning(table, (start, spin), tick_rate=tick_rate))
    assert began == pytest.approx(slip_time(start, spin, table), abs=ROUNDING)


def tiny_steps(start, spin: Spin, table: Table, seconds: float, step: float = 5e-5) -> Body:
    """Where a ball without obstacles is after some time, in tiny steps."""
    ball = Body(*start, spin)
    for _ in range(round(seconds / step)):
        ball = ball.moved(step, table.board)
    return ball


@pytest.mark.parametrize(("way", "turn"), [(0.3, 0.0), (1.2, 10.0), (-0.5, -15.0)])
def test_the_error_of_the_held_direction_goes_to_zero_with_the_tick(way: float, turn: float) -> None:
    """Twice as many ticks a second, half the error of the place after the slip; the slip itself ends within a
    tick of when it should."""
    table = plain(0.08, gravity=4.0)
    start, spin = (0.0, 0.0, 5.0 * math.sin(way), 5.0 * math.cos(way)), (turn, 0.0, 0.0)
    exact = slip_time(start, spin, table)
    assert 0.3 < exact < 1.4
    reference = tiny_steps(start, spin, table, 1.5)
    late, off = [], []
    for tick_rate in (50, 100, 200, 400):
        world = spinning(table, (start, spin), tick_rate=tick_rate)
        late.append(abs(play_until_it_rolls(world) - exact) * tick_rate)
        world.step(ticks=3 * tick_rate // 2 - world.tick)
        off.append(math.dist(place(world.balls[0]), (reference.x, reference.z)))
    print(f"held direction: slip ends off by {late} ticks, the place after 1.5 s by {off} u")
    assert max(late) < 1.0
    assert off[0] < 1e-2
    for one, half in pairwise(off):
        assert half == pytest.approx(one / 2, rel=0.25)


def test_what_is_left_across_the_slip_at_its_end_is_no_more_than_gravity_makes_in_a_tick() -> None:
    """At the end of a slip it is taken away at once: the speed jumps by 2/7 of it, at most."""
    table = plain(0.05, gravity=10.0)
    for way in np.linspace(0.05, 3.0, 12):
        start = (0.0, 0.0, 3.0 * math.sin(way), 3.0 * math.cos(way))
        world = launched(table, start, tick_rate=60)
        before = energy(world)
        while motion_of(world) != Motion.ROLLING:
            slip = touch_speed(world)
            world.step()
            lost = before - energy(world)
            # Friction's work is at most f times the way of the lowest point, the jump's ½·2/7·(g·h)².
            h = 1 / 60
            assert (
                -ROUNDING <= lost <= grip_of(table) * (slip + 10.0 * h) * h + (10.0 * h) ** 2 / 7 + ROUNDING
            )
            before = energy(world)


def test_a_ball_whose_slip_is_below_creep_rolls() -> None:
    for share, expected in ((0.5, Motion.ROLLING), (2.0, Motion.SLIPPING)):
        world = spinning(plain(), ((0.0, 0.0, 0.0, share * MIN_SLIP_SPEED), (0.0, 0.0, 0.0)))
        assert motion_of(world) == expected


# --- with the rest of the table


def test_a_rolling_ball_comes_back_from_a_border_slipping_and_rolls_again() -> None:
    """Head-on it comes away with e·v, its spin less by what friction turns: 5/(2r)·μ·(1 + e)·v."""
    e, friction, speed = 0.8, 0.15, 6.0
    table = plain(friction, gravity=0.1, wall_restitution=e, slope=1.0)
    start = (0.0, 20.0, 0.0, speed)
    world = spinning(table, (start, rolling_spin(0.0, speed)), tick_rate=1000)
    event = first_contact(world)
    assert event.part == "board.right"
    turn = rolling_spin(0.0, speed)[0] - 2.5 / RADIUS * friction * (1 + e) * speed
    left = world.time - moment(world, event)
    grip = grip_of(table)
    assert world.balls[0].spin[0] == pytest.approx(turn - 2.5 / RADIUS * grip * left, rel=1e-3)
    play_until_it_rolls(world)
    # (5·v + 2·q)/7 with v = −e·v₀ and q = r·ω after the border.
    w = (-5 * e * speed + 2 * RADIUS * turn) / 7
    assert speed_of(world.balls[0])[1] == pytest.approx(w, abs=0.01)


def test_a_slipping_ball_does_not_mind_a_busy_ball_elsewhere() -> None:
    """One ball lies by a paddle that lifts it; the other one slips far away, in whichever slot it is."""
    paddle = Paddle(side="left", pivot=(-15.0, -6.0))
    table = plain().model_copy(update={"paddle": (paddle,)})
    slipping, lying = (5.0, 0.0, 3.0, 7.0), (-14.5, -5.0, 0.0, 0.0)
    worlds = [
        launched(table, *balls, tick_rate=60) for balls in ((slipping,), (slipping, lying), (lying, slipping))
    ]
    for _ in range(30):
        for world in worlds:
            world.step(left=True)
        seen = [
            next((ball.position, ball.velocity, ball.spin) for ball in world.balls if ball.position[0] > 0)
            for world in worlds
        ]
        assert seen[0] == seen[1] == seen[2]
    assert worlds[1].hits["paddle.left"] == worlds[2].hits["paddle.left"] > 0


def test_a_shove_makes_a_rolling_ball_slip_and_leaves_its_spin() -> None:
    world = spinning(plain(), ((0.0, 0.0, 2.0, 1.0), rolling_spin(2.0, 1.0)), tick_rate=1000)
    world.step()
    before = world.balls[0].spin
    world.step(jitter=True)
    assert motion_of(world) == Motion.SLIPPING
    assert world.balls[0].spin == pytest.approx(
        before, abs=2.5 * grip_of(world.table) / 1000 / RADIUS * 1.001
    )
    assert touch_speed(world) > 1.0


def test_a_spin_given_from_outside_is_felt_in_the_next_tick() -> None:
    """A rolling ball with a new spin slips: the flight that its record held is none of its own."""
    world = spinning(plain(), ((0.0, 0.0, 0.0, 4.0), rolling_spin(0.0, 4.0)))
    world.step(ticks=50)
    vz = speed_of(world.balls[0])[1]
    spin_balls(world, (-30.0, 0.0, 0.0))
    world.step()
    slope = speed_of(world.balls[0])[1] - vz
    assert slope == pytest.approx(-grip_of(world.table) / 240, rel=0.1)


ROUND = (
    Cylinder(center=(3.0, -2.0), radius=1.5, speed_factor=1.0),
    TriangularPrism(center=(-3.0, 4.0), size=2.0),
    Cylinder(center=(-2.0, -6.0), radius=1.0, speed_factor=1.2, restitution_falloff=0.03),
)


def test_slipping_balls_meet_what_the_slow_twin_says() -> None:
    """In the limit of small ticks: at 5000 a second the held direction is off by 1e-3 at 2 u/s of slip."""
    table = plain(0.25, width=20, length=20, gutter=-9).model_copy(
        update={"cylinder": (ROUND[0], ROUND[2]), "triangular_prism": (ROUND[1],)}
    )
    rng = np.random.default_rng(3)
    compared, met = 0, set()
    for _ in range(60):
        balls, spins = [], []
        for low in (-7.0, 1.0):
            way = rng.uniform(0, 2 * math.pi)
            balls.append(
                (
                    float(rng.uniform(-6, 7)),
                    float(rng.uniform(low, low + 5)),
                    12 * math.sin(way),
                    12 * math.cos(way),
                )
            )
            spins.append(tuple(rng.uniform(-30, 30, 3).tolist()))
        probe = World(table)
        if min(probe.clearance(*ball[:2]) for ball in balls) < 0.01:
            continue
        world = spinning(table, *zip(balls, spins, strict=True), tick_rate=5000)
        twin = Twin(table, balls, spins).run(0.4, {})
        seen = []
        for _ in range(20):
            world.step(ticks=100)
            seen += [event for event in world.events if event.kind in ("hit", "ball_hit")]
        for event, bounce in zip(seen[:2], twin[:2], strict=False):
            if min(event.speed, bounce.speed) < 2.0:
                break
            assert (event.part, event.ball) == (bounce.part, bounce.ball + 1)
            assert moment(world, event) == pytest.approx(bounce.time, abs=2e-3)
            assert place(event) == pytest.approx((bounce.x, bounce.z), abs=5e-3)
            assert event.speed == pytest.approx(bounce.speed, abs=0.05)
            compared += 1
            met.add(event.part.split("[")[0])
    assert compared >= 12
    assert len(met) >= 3


@pytest.mark.parametrize("slipping_first", [True, False])
@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_balls_that_meet_before_a_slip_ends_in_the_same_tick_meet_slipping(slipping_first, tick_rate) -> None:
    """Up the slope, so in closed form: one slips with −(g + μ·p), the other one rolls down from rest."""
    table = plain(0.3)
    speed, gap, grip = 5.0, 0.09, grip_of(table)
    bend = (10.0 + grip - 50 / 7) / 2  # gap − v·t + bend·t² = 0
    time = 2 * gap / (speed + math.sqrt(speed * speed - 4 * bend * gap))
    assert time < 0.5 * speed / (3.5 * grip + 10.0) < 0.1
    balls = ((0.0, 0.0, speed, 0.0), (2 * RADIUS + gap, 0.0, 0.0, 0.0))
    world = launched(table, *(balls if slipping_first else balls[::-1]), tick_rate=tick_rate)
    event = first_contact(world)
    assert moment(world, event) == pytest.approx(time, abs=ROUNDING)
    assert event.speed == pytest.approx(speed - 2 * bend * time, abs=ROUNDING)


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_a_slip_may_end_in_the_tick_of_a_contact_with_a_border(tick_rate: int) -> None:
    """Head-on to the top: slipping, then rolling, then the border; each in closed form, whatever the tick."""
    table = plain(0.3, length=20, gutter=-9)
    speed, grip = 5.0, grip_of(table)
    over = speed / (3.5 * grip + 10.0)
    way = speed * over - (10.0 + grip) / 2 * over * over
    rolls = speed - (10.0 + grip) * over
    more = 0.05
    on = 2 * more / (rolls + math.sqrt(rolls * rolls - 2 * 50 / 7 * more))
    assert over + on < 0.1
    world = launched(table, (10 - 0.1 - RADIUS - way - more, 0.0, speed, 0.0), tick_rate=tick_rate)
    event = first_contact(world)
    assert event.part == "board.top"
    assert moment(world, event) == pytest.approx(over + on, abs=ROUNDING)
    assert event.speed == pytest.approx(rolls - 50 / 7 * on, abs=ROUNDING)


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_a_ball_whose_spin_drives_it_down_catches_up_with_one_that_rolls(tick_rate: int) -> None:
    """Both start at rest: g + μ·p against 5/7·g, so that they meet though neither comes nearer at first."""
    table, gap = plain(0.3), 0.1
    bend = 10.0 + grip_of(table) - 50 / 7
    world = spinning(
        table,
        ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ((2 * RADIUS + gap, 0.0, 0.0, 0.0), (0.0, 0.0, 150.0)),
        tick_rate=tick_rate,
    )
    event = first_contact(world)
    assert event.part == "ball"
    assert moment(world, event) == pytest.approx(math.sqrt(2 * gap / bend), abs=ROUNDING)
    assert event.speed == pytest.approx(math.sqrt(2 * gap * bend), abs=ROUNDING)
