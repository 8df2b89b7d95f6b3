"""The laws of a flight and of one contact, each computed here from the numbers of the table."""

from __future__ import annotations

import math

import pytest

from boards import LEFT, PADDLES, RIGHT, first_contact, launched, moment, place, speed_of, table_of
from silverball.physics.tolerances import HOP
from silverball.table import Board, Cylinder, Paddle, SlantWall, TriangularPrism
from silverball.world import World

RADIUS = 0.25
GRAVITY = 10.0
ROUNDING = 1e-12
"""A few dozen operations on numbers up to 22, each off by half of ulp(22) = 3.6e-15 at most."""


def velocity_after(vx: float, vz: float, nx: float, nz: float, e: float, ux: float = 0.0, uz: float = 0.0):
    """v′ = v + (1 + e)·w·n: the normal part turned round and weakened, the tangential part as it was."""
    w = -(nx * (vx - ux) + nz * (vz - uz))
    return vx + (1.0 + e) * w * nx, vz + (1.0 + e) * w * nz


def check_bounce(
    world: World, event, start, e: float, normal, factor: float = 1.0, surface=(0.0, 0.0)
) -> None:
    """The contact was that of a ball from `start` (x, z, vx, vz) with this normal, and the flight after it
    is right."""
    x, z, vx, vz = start
    h = event.offset + event.tick / world.tick_rate
    assert event.normal[::2] == pytest.approx(normal, abs=ROUNDING)
    assert place(event) == pytest.approx((x + vx * h - 0.5 * GRAVITY * h * h, z + vz * h), abs=ROUNDING)
    hit = (vx - GRAVITY * h, vz)
    out = velocity_after(*hit, *normal, e, *surface)
    left = world.time - h
    expected = (out[0] * factor - GRAVITY * left, out[1] * factor)
    assert speed_of(world.balls[0]) == pytest.approx(expected, abs=ROUNDING)


@pytest.mark.parametrize("tick_rate", [10, 60, 240, 1000])
def test_a_ball_falls_as_half_g_t_squared(tick_rate: int) -> None:
    world = launched(table_of(length=50, gutter=-24), (9.5, 1.0, 0.0, 0.0), tick_rate=tick_rate)
    for tick in range(1, 2 * tick_rate):
        world.step()
        t = tick / tick_rate
        ((x, _, z),) = [ball.position for ball in world.balls]
        assert abs(x - (9.5 - 0.5 * GRAVITY * t * t)) <= 1e-12
        assert z == 1.0
        assert abs(world.balls[0].velocity[0] + GRAVITY * t) <= 1e-12


def test_a_thrown_ball_draws_a_parabola_and_keeps_its_sideways_speed() -> None:
    world = launched(table_of(), (-2.0, -4.0, 9.0, 3.5))
    for tick in range(1, 400):
        world.step()
        t = tick / world.tick_rate
        x, z = place(world.balls[0])
        assert abs(x - (-2.0 + 9.0 * t - 0.5 * GRAVITY * t * t)) <= ROUNDING
        assert abs(z - (-4.0 + 3.5 * t)) <= ROUNDING
        assert world.balls[0].velocity[2] == 3.5


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_a_ball_is_gone_at_the_very_moment_its_centre_crosses_the_gutter(tick_rate: int) -> None:
    world = launched(table_of(gutter=-9.0), (3.0, 0.0, 2.0, 0.5), tick_rate=tick_rate)
    while world.balls:
        world.step()
    event = world.events[-1]
    # −9 = 3 + 2·t − 5·t²
    exact = (2.0 + math.sqrt(4.0 + 2.0 * GRAVITY * 12.0)) / GRAVITY
    assert event.kind == event.part == "gutter"
    # The flight is put together of up to 430 ticks, each rounded by at most ulp(10) = 1.8e-15, at 15 u/s.
    assert abs(moment(world, event) - exact) <= 1e-13
    assert abs(event.position[0] + 9.0) <= 1e-14
    assert abs(event.speed - math.sqrt(4.0 + 2.0 * GRAVITY * 12.0)) <= ROUNDING
    assert (world.drained, world.created) == (1, 1)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("degrees", [3, 17, 29, 41, 45, 58, 76, 90, 119, 163])
@pytest.mark.parametrize("below", [False, True])
def test_a_slant_wall_reflects_about_its_normal_whichever_way_its_ends_are_given(
    degrees: float, swapped: bool, below: bool
) -> None:
    along_z, along_x = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    ends = ((2.0 - 2 * along_x, 0.3 - 2 * along_z), (2.0 + 2 * along_x, 0.3 + 2 * along_z))
    wall = SlantWall(start=ends[swapped], end=ends[not swapped], restitution=0.7, thickness=0.1)
    # To the left of the way from the first end to the second; a ball comes from there (or from the other
    # side).
    normal = (along_z, -along_x)
    if below:
        normal = (-normal[0], -normal[1])
    start = (2.0 + 1.5 * normal[0], 0.3 + 1.5 * normal[1], -7 * normal[0] + along_x, -7 * normal[1] + along_z)
    world = launched(table_of(wall), start)
    event = first_contact(world)
    assert (event.kind, event.part) == ("hit", "slant_wall[0]")
    check_bounce(world, event, start, 0.7, normal)
    dx, dz = event.position[0] - 2.0, event.position[2] - 0.3
    assert abs(normal[0] * dx + normal[1] * dz - (RADIUS + 0.1)) <= 1e-14


@pytest.mark.parametrize("swapped", [False, True])
def test_the_inward_normal_points_to_the_middle_of_the_board(swapped: bool) -> None:
    ends = ((-4.5, -5.0), (-6.88, -2.76))
    wall = SlantWall(start=ends[swapped], end=ends[not swapped])
    nx, nz = wall.inward_normal(Board())
    dx, dz = ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]
    assert abs(nx * dx + nz * dz) <= 1e-15
    assert math.hypot(nx, nz) == pytest.approx(1.0, abs=1e-15)
    assert nx * (0.0 - ends[0][0]) + nz * (0.0 - ends[0][1]) > 0.0


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("degrees", [-60, -20, 0, 35, 70])
def test_a_slant_wall_has_round_ends(end: int, degrees: float) -> None:
    ends = ((1.0, -2.0), (2.0, 1.5))
    outward = (ends[end][0] - ends[1 - end][0], ends[end][1] - ends[1 - end][1])
    turn = math.atan2(outward[0], outward[1]) + math.radians(degrees)
    from_x, from_z = math.sin(turn), math.cos(turn)  # the side of the end from which the ball comes
    x, z = ends[end]
    start = (x + 1.2 * from_x, z + 1.2 * from_z, -12 * from_x, -12 * from_z)
    world = launched(table_of(SlantWall(start=ends[0], end=ends[1], thickness=0.15)), start, tick_rate=1000)
    event = first_contact(world)
    assert event.part == "slant_wall[0]"
    px, pz = place(event)
    assert math.hypot(px - x, pz - z) == pytest.approx(RADIUS + 0.15, abs=1e-14)
    normal = ((px - x) / (RADIUS + 0.15), (pz - z) / (RADIUS + 0.15))
    check_bounce(world, event, start, 0.7, normal)


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("corner", [0, 1, 2])
@pytest.mark.parametrize("degrees", [-40, -15, 0, 25, 40])
def test_at_the_corner_of_a_prism_the_normal_points_from_the_corner_to_the_ball(
    corner: int, degrees: float, order: int
) -> None:
    corners = ((2.0, -1.0), (3.2, -1.4), (2.4, 0.2))
    middle = (sum(x for x, _ in corners) / 3, sum(z for _, z in corners) / 3)
    x, z = corners[corner]
    turn = math.atan2(x - middle[0], z - middle[1]) + math.radians(degrees)
    from_x, from_z = math.sin(turn), math.cos(turn)
    start = (x + 1.5 * from_x, z + 1.5 * from_z, -14 * from_x, -14 * from_z)
    prism = TriangularPrism(vertices=corners[::order], restitution=0.8, speed_factor=0.85)
    world = launched(table_of(prism), start, tick_rate=1000)
    event = first_contact(world)
    assert (event.kind, event.part) == ("hit", "triangular_prism[0]")
    px, pz = place(event)
    assert math.hypot(px - x, pz - z) == pytest.approx(RADIUS, abs=1e-14)
    check_bounce(world, event, start, 0.8, ((px - x) / RADIUS, (pz - z) / RADIUS), factor=0.85)


@pytest.mark.parametrize("side", [0, 1, 2])
def test_the_normal_of_a_prism_s_side_points_outward(side: int) -> None:
    corners = ((2.0, -1.0), (3.2, -1.4), (2.4, 0.2))
    middle = (sum(x for x, _ in corners) / 3, sum(z for _, z in corners) / 3)
    (ax, az), (bx, bz) = corners[side], corners[(side + 1) % 3]
    length = math.hypot(bx - ax, bz - az)
    nx, nz = (bz - az) / length, -(bx - ax) / length
    if nx * (middle[0] - ax) + nz * (middle[1] - az) > 0:
        nx, nz = -nx, -nz
    start = ((ax + bx) / 2 + nx, (az + bz) / 2 + nz, -15 * nx, -15 * nz)
    prism = TriangularPrism(vertices=corners, restitution=0.6, speed_factor=1.0)
    world = launched(table_of(prism), start, tick_rate=1000)
    check_bounce(world, first_contact(world), start, 0.6, (nx, nz))


def tip_at(paddle: Paddle, angle: float) -> tuple[float, float]:
    """The tip of a paddle: `length` away from its pivot, at `angle` from the horizontal, mirrored on the
    right."""
    side = 1.0 if paddle.side == "left" else -1.0
    return (
        paddle.pivot[0] + paddle.length * math.sin(angle),
        paddle.pivot[1] + side * paddle.length * math.cos(angle),
    )


@pytest.mark.parametrize("paddle", PADDLES)
@pytest.mark.parametrize("degrees", [-40, -12, 0, 12, 40])
def test_at_the_tip_of_a_resting_paddle_the_normal_points_from_the_tip_to_the_ball(
    paddle: Paddle, degrees: float
) -> None:
    rest = math.radians(paddle.rest_angle)
    side = 1.0 if paddle.side == "left" else -1.0
    x, z = tip_at(paddle, rest)
    turn = rest + math.radians(degrees)
    from_x, from_z = math.sin(turn), side * math.cos(turn)
    start = (x + from_x, z + from_z, -9 * from_x, -9 * from_z)
    world = launched(table_of(paddle), start, tick_rate=1000)
    event = first_contact(world)
    assert event.part == f"paddle.{paddle.side}"
    px, pz = place(event)
    assert math.hypot(px - x, pz - z) == pytest.approx(RADIUS, abs=1e-14)
    normal = ((px - x) / RADIUS, (pz - z) / RADIUS)
    speed = -(normal[0] * (start[2] - GRAVITY * moment(world, event)) + normal[1] * start[3])
    check_bounce(world, event, start, 0.5 / (1 + 0.02 * speed), normal)


@pytest.mark.parametrize("paddle", PADDLES)
@pytest.mark.parametrize("ahead", [0.02, 0.05, 0.08])
@pytest.mark.parametrize("beyond", [0.0, 0.08, 0.14])
def test_the_tip_of_a_moving_paddle_hits_with_omega_cross_r(
    paddle: Paddle, ahead: float, beyond: float
) -> None:
    """A ball waits near where the tip will be in `ahead` seconds, `beyond` it by a part of its radius."""
    rest, up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
    omega = (up - rest) / paddle.stroke
    side = 1.0 if paddle.side == "left" else -1.0
    x, z = tip_at(paddle, rest + omega * ahead)
    angle = rest + omega * ahead
    # The tip moves along (cos θ, −side·sin θ); sideways of that lies the way out from the pivot.
    way = (math.cos(angle), -side * math.sin(angle))
    out = (math.sin(angle), side * math.cos(angle))
    start = (
        x + RADIUS * (way[0] + 0.3 * out[0]) + beyond * out[0] + 0.5 * GRAVITY * ahead * ahead,
        z + RADIUS * (way[1] + 0.3 * out[1]) + beyond * out[1],
        0.0,
        0.0,
    )
    world = launched(table_of(paddle, speed_cap=60), start, tick_rate=10)
    event = first_contact(world, **{paddle.side: True})
    assert event.part == f"paddle.{paddle.side}"
    tx, tz = tip_at(paddle, rest + omega * event.offset)
    px, pz = place(event)
    assert math.hypot(px - tx, pz - tz) == pytest.approx(RADIUS, abs=1e-14)
    nx, nz = (px - tx) / RADIUS, (pz - tz) / RADIUS
    assert event.normal[::2] == pytest.approx((nx, nz), abs=ROUNDING)
    # ω × r at the point of contact, the tip: ω·(r_z, −r_x) on the left, the mirror image on the right.
    ux, uz = omega * side * (tz - paddle.pivot[1]), -omega * side * (tx - paddle.pivot[0])
    speed = -(nx * (-GRAVITY * event.offset - ux) + nz * (0.0 - uz))
    assert event.speed == pytest.approx(speed, abs=ROUNDING)
    check_bounce(world, event, start, 0.5 / (1 + 0.02 * speed), (nx, nz), surface=(ux, uz))


@pytest.mark.parametrize("paddle", PADDLES)
@pytest.mark.parametrize("where", [0.25, 0.5, 0.85])
@pytest.mark.parametrize("lifting", [True, False])
def test_the_flat_of_a_moving_paddle_hits_with_omega_cross_r(
    paddle: Paddle, where: float, lifting: bool
) -> None:
    """The upper side of a lifting paddle, the lower side of a returning one; `where` along it from base to
    tip."""
    side = 1.0 if paddle.side == "left" else -1.0
    angles = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
    begin, end = angles if lifting else angles[::-1]
    omega = (end - begin) / (paddle.stroke if lifting else paddle.return_stroke)
    ahead = 0.05
    angle = begin + omega * ahead
    # In the paddle's frame: along it and across it (up); the sides run from (0, ±base/2) to (length, 0).
    across = 1.0 if lifting else -1.0
    slope = math.atan2(paddle.base / 2, paddle.length)
    a = where * paddle.length + RADIUS * math.sin(slope)
    c = across * ((1 - where) * paddle.base / 2 + RADIUS * math.cos(slope))
    s, k = math.sin(angle), math.cos(angle)
    start = (
        paddle.pivot[0] + a * s + c * k + 0.5 * GRAVITY * ahead**2,
        paddle.pivot[1] + side * (a * k - c * s),
        0.0,
        0.0,
    )
    world = World(table_of(paddle, speed_cap=60), tick_rate=10)
    world.step(**{paddle.side: not lifting}, ticks=3)
    world.create_ball(start[:2], start[2:])
    world.step(**{paddle.side: lifting})
    (event, *_) = [event for event in world.events if event.kind in ("hit", "touch")]
    # The ball was put where it touches after `ahead` seconds: coordinates of 10 u at ω·a ≥ 5 u/s.
    assert abs(event.offset - ahead) <= 1e-14
    normal_a, normal_c = math.sin(slope), across * math.cos(slope)
    nx, nz = normal_a * s + normal_c * k, side * (normal_a * k - normal_c * s)
    rx, rz = (
        start[0] - 0.5 * GRAVITY * ahead**2 - RADIUS * nx - paddle.pivot[0],
        start[1] - RADIUS * nz - paddle.pivot[1],
    )
    ux, uz = omega * side * rz, -omega * side * rx
    speed = -(nx * (-GRAVITY * ahead - ux) - nz * uz)
    assert event.normal[::2] == pytest.approx((nx, nz), abs=ROUNDING)
    assert event.speed == pytest.approx(speed, abs=ROUNDING)
    out = velocity_after(-GRAVITY * ahead, 0.0, nx, nz, 0.5 / (1 + 0.02 * speed), ux, uz)
    rest = 0.1 - event.offset
    assert speed_of(world.balls[0]) == pytest.approx((out[0] - GRAVITY * rest, out[1]), abs=ROUNDING)


@pytest.mark.parametrize("speed", [0.6, 3.0, 9.0, 18.0])
@pytest.mark.parametrize("falloff", [0.0, 0.02, 0.3])
def test_restitution_falls_with_the_speed_of_the_impact(speed: float, falloff: float) -> None:
    cylinder = Cylinder(center=(0, 0), radius=1, restitution=0.9, restitution_falloff=falloff, speed_factor=1)
    start = (-1.5, 0.0, math.sqrt(speed**2 + 2 * GRAVITY * 0.25), 0.0)
    world = launched(table_of(cylinder), start)
    event = first_contact(world)
    assert event.speed == pytest.approx(speed, abs=ROUNDING)
    check_bounce(world, event, start, 0.9 / (1 + falloff * speed), (-1.0, 0.0))


@pytest.mark.parametrize("factor", [0.4, 0.85, 1.25])
def test_a_hit_multiplies_the_whole_velocity_by_the_speed_factor(factor: float) -> None:
    cylinder = Cylinder(center=(0, 0), radius=1, restitution=0.9, speed_factor=factor, points=70)
    start = (2.0, 0.7, -6.0, 0.5)
    world = launched(table_of(cylinder), start)
    event = first_contact(world)
    px, pz = place(event)
    check_bounce(world, event, start, 0.9, (px / 1.25, pz / 1.25), factor=factor)
    assert (event.kind, world.score) == ("hit", 70)


@pytest.mark.parametrize("factor", [0.4, 1.25])
@pytest.mark.parametrize("speed", [0.2, 0.49])
def test_a_touch_gives_no_points_no_boost_and_takes_no_speed(factor: float, speed: float) -> None:
    cylinder = Cylinder(center=(0, 0), radius=1, restitution=0.9, speed_factor=factor, points=70)
    start = (-1.26, 0.0, math.sqrt(speed**2 + 2 * GRAVITY * 0.01), 0.0)
    world = launched(table_of(cylinder), start)
    event = first_contact(world)
    check_bounce(world, event, start, 0.9, (-1.0, 0.0))
    assert (event.kind, world.score) == ("touch", 0)
    assert sum(world.hits.values()) == 0


def test_a_cylinder_can_give_more_speed_than_it_got() -> None:
    world = launched(table_of(Cylinder(center=(0, 0), radius=1)), (3.0, 0.0, -8.0, 0.0))
    event = first_contact(world)
    left = world.time - moment(world, event)
    assert event.speed * 0.9 * 1.25 == pytest.approx(
        world.balls[0].velocity[0] + GRAVITY * left, abs=ROUNDING
    )
    assert world.balls[0].velocity[0] > event.speed


@pytest.mark.parametrize(
    ("start", "part", "normal"),
    [
        ((0.0, -3.0, 2.0, -9.0), "board.left", (0.0, 1.0)),
        ((0.0, 3.0, 2.0, 9.0), "board.right", (0.0, -1.0)),
        ((8.0, 1.0, 12.0, 4.0), "board.top", (-1.0, 0.0)),
    ],
)
def test_a_border_reflects_at_ball_radius_plus_thickness_from_the_edge(start, part, normal) -> None:
    world = launched(table_of(wall_thickness=0.1, wall_restitution=0.8), start)
    event = first_contact(world)
    assert event.part == part
    edge = 10.0 if part == "board.top" else 5.0
    assert -(normal[0] * event.position[0] + normal[1] * event.position[2]) == pytest.approx(
        edge - 0.1 - RADIUS, abs=1e-14
    )
    check_bounce(world, event, start, 0.8, normal)


@pytest.mark.parametrize("e", [0.1, 0.3, 0.95, 1.0])
@pytest.mark.parametrize("degrees", [0, 20, 55, 80])
def test_two_balls_of_equal_mass_exchange_their_normal_speeds(e: float, degrees: float) -> None:
    s, k = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    other = (1.0 + 1.5 * s, 1.5 * k, 3.0 - 5 * s + 0.6 * k, -1.0 - 5 * k - 0.6 * s)
    world = launched(table_of(ball_restitution=e), (1.0, 0.0, 3.0, -1.0), other)
    a, b = ((*place(ball), *speed_of(ball)) for ball in world.balls)
    event = first_contact(world)
    h = moment(world, event)
    (ax, az), (bx, bz) = ((x + vx * h - 0.5 * GRAVITY * h * h, z + vz * h) for x, z, vx, vz in (a, b))
    assert math.hypot(ax - bx, az - bz) == pytest.approx(2 * RADIUS, abs=1e-14)
    nx, nz = (ax - bx) / (2 * RADIUS), (az - bz) / (2 * RADIUS)
    assert event.normal[::2] == pytest.approx((nx, nz), abs=ROUNDING)
    w = -(nx * (a[2] - b[2]) + nz * (a[3] - b[3]))
    assert event.speed == pytest.approx(w, abs=ROUNDING)
    out_a, out_b = (speed_of(ball) for ball in world.balls)
    t = world.time
    # Each takes half of (1 + e)·w along n; so the sum (momentum) and the tangential parts stay.
    push = 0.5 * (1 + e) * w
    assert out_a == pytest.approx((a[2] + push * nx - GRAVITY * t, a[3] + push * nz), abs=ROUNDING)
    assert out_b == pytest.approx((b[2] - push * nx - GRAVITY * t, b[3] - push * nz), abs=ROUNDING)
    rebound = nx * (out_a[0] - out_b[0]) + nz * (out_a[1] - out_b[1])
    assert rebound == pytest.approx(e * w, abs=ROUNDING)


def test_equal_balls_without_loss_swap_their_speeds_head_on() -> None:
    world = launched(table_of(ball_restitution=1.0), (0.0, -2.0, 0.0, 6.0), (0.0, 2.0, 0.0, -2.0))
    first_contact(world)
    assert [ball.velocity[2] for ball in world.balls] == pytest.approx([-2.0, 6.0], abs=ROUNDING)


def test_a_boost_ends_at_the_cap_and_keeps_the_direction() -> None:
    cylinder = Cylinder(center=(0, 0), radius=1, restitution=1.0, speed_factor=3.0)
    start = (2.0, 0.5, -15.0, 1.0)
    world = launched(table_of(cylinder), start, tick_rate=1000)
    event = first_contact(world)
    px, pz = place(event)
    h = moment(world, event)
    out = velocity_after(-15.0 - GRAVITY * h, 1.0, px / 1.25, pz / 1.25, 1.0)
    left = world.time - h
    vx, vz = speed_of(world.balls[0])
    scale = 22.0 / math.hypot(*out)
    assert scale * 3.0 > 1.0
    # After the bounce at the cap; the rest of the tick under gravity, and the cap again at its end.
    at_end = (out[0] * scale - GRAVITY * left, out[1] * scale)
    scale = min(1.0, 22.0 / math.hypot(*at_end))
    assert (vx, vz) == pytest.approx((at_end[0] * scale, at_end[1] * scale), abs=ROUNDING)


def test_a_falling_ball_never_ends_a_tick_above_the_cap() -> None:
    world = launched(table_of(length=50, gutter=-24.5, speed_cap=12.0), (24.0, 0.0, 0.0, 5.0))
    fastest = 0.0
    while world.balls:
        for ball in world.balls:
            fastest = max(fastest, math.hypot(*speed_of(ball)))
            assert math.hypot(*speed_of(ball)) <= 12.0
        world.step()
    assert fastest > 11.99


def test_a_ball_still_leaves_a_moving_paddle_when_the_cap_cuts_its_speed() -> None:
    """Only the tangential part is cut: along the normal the ball stays faster than the paddle.

    The ball runs outward along the lifting paddle and is met near the tip, which lifts at 17 u/s.
    """
    paddle = LEFT.model_copy(update={"restitution": 0.1, "restitution_falloff": 0.0})
    world = launched(table_of(paddle), (-6.36, -1.6, 0.0, 18.0), tick_rate=1000)
    event = first_contact(world, left=True)
    assert event.part == "paddle.left"
    nx, nz = event.normal[::2]
    omega = math.radians(55) / 0.1
    rx, rz = event.position[0] - RADIUS * nx + 7.2, event.position[2] - RADIUS * nz + 2.5
    surface = omega * (nx * rz - nz * rx)
    hit = (-GRAVITY * moment(world, event), 18.0)
    along = -nz * hit[0] + nx * hit[1]
    out = surface + 0.1 * event.speed
    # Scaled down as a whole, the ball would be slower than the paddle and be met again at once.
    assert math.hypot(out, along) > 22.0
    assert out * 22.0 / math.hypot(out, along) < surface < out < 22.0
    left = world.time - moment(world, event)
    cut = math.sqrt(22.0**2 - out**2)
    expected = (nx * out - nz * cut - GRAVITY * left, nz * out + nx * cut)
    assert speed_of(world.balls[0]) == pytest.approx(expected, abs=ROUNDING)
    world.step(left=True, ticks=20)
    assert not [later for later in world.events if later.part == "paddle.left"]


def test_y_never_changes() -> None:
    world = World(table_of(*PADDLES, Cylinder(center=(2, 0.3), radius=0.6), height=1.5), seed=3)
    for tick in range(600):
        if len(world.balls) < 2:
            world.create_ball()
        world.step(left=tick % 50 < 20, right=tick % 70 < 30, jitter=tick % 40 == 0)
        assert all(ball.position[1] == 1.5 and ball.velocity[1] == 0.0 for ball in world.balls)
        assert all(event.position[1] == 1.5 and event.normal[1] == 0.0 for event in world.events)


def test_a_ball_at_rest_on_a_level_raised_paddle_stays_and_hops_no_higher_than_it_may() -> None:
    # The upper side of the paddle is level when it is raised by the slope of that side.
    up = math.degrees(math.atan2(0.25, 2.1))
    world = World(table_of(LEFT.model_copy(update={"up_angle": up})), tick_rate=240)
    world.step(left=True, ticks=240)
    top = -7.2 + 0.25 / math.cos(0.0) * math.cos(math.radians(up)) + RADIUS
    world.create_ball((top + 1e-6, -1.6))
    highest = lowest = top
    for _ in range(240 * 60):
        world.step(left=True)
        x, z = place(world.balls[0])
        highest, lowest = max(highest, x), min(lowest, x)
        assert abs(z + 1.6) < 1e-9
    assert lowest >= top - 1e-9
    # A hop of speed √(2·g·HOP) rises by HOP; the drop from 1e-6 u adds nothing to it.
    assert highest - top <= HOP * (1 + 1e-9)
    assert highest - top >= 0.5 * HOP
    assert world.score == 0
    assert sum(world.hits.values()) == 0


@pytest.mark.parametrize("gravity", [0.1, 10.0, 100.0])
def test_a_touch_adds_at_most_the_energy_of_its_hop(gravity: float) -> None:
    cylinder = Cylinder(center=(0, 0), radius=1, restitution=0.0)
    world = launched(table_of(cylinder, gravity=gravity), (1.25 + 1e-7, 0.0, 0.0, 0.0))
    floor = gravity * 1.25
    for _ in range(4000):
        world.step()
        (ball,) = world.balls
        energy = 0.5 * ball.velocity[0] ** 2 + gravity * ball.position[0]
        assert energy - floor <= gravity * HOP * (1 + 1e-9) + 1e-12


@pytest.mark.parametrize("paddle", [LEFT, RIGHT])
def test_a_paddle_reaches_its_stop_in_its_stroke_and_comes_back(paddle: Paddle) -> None:
    world = World(table_of(LEFT, RIGHT), tick_rate=1000)
    number = 0 if paddle.side == "left" else 1
    rest, up = math.radians(-10), math.radians(45)
    for tick in range(1, 201):
        world.step(**{paddle.side: tick <= 100})
        expected = rest + (up - rest) * (tick / 100 if tick <= 100 else 2 - tick / 100)
        assert world.paddles[number].angle == pytest.approx(expected, abs=1e-13)
        assert world.paddles[1 - number] == (rest, 0.0)
    world.step()
    assert world.paddles[number] == (rest, 0.0)
    world.step(**{paddle.side: True}, ticks=101)
    assert world.paddles[number] == (up, 0.0)


def test_a_button_changed_in_mid_stroke_turns_the_paddle_back_from_where_it_is() -> None:
    world = World(table_of(LEFT), tick_rate=1000)
    omega = math.radians(55) / 0.1
    world.step(left=True, ticks=30)
    world.step(ticks=10)
    assert world.paddles[0].angle == pytest.approx(math.radians(-10) + omega * 0.02, abs=1e-13)
    assert world.paddles[0].angular_velocity == pytest.approx(-omega, abs=1e-12)
