"""Flights that are hard for a search of contacts: grazes, slides, exact corners, ties, starts at rest,
jams."""

from __future__ import annotations

import math
from typing import Any

import pytest

from boards import (
    CONTACTS,
    LEFT,
    PADDLES,
    RIGHT,
    contacts,
    edited,
    first_contact,
    full_table,
    launched,
    moment,
    place,
    speed_of,
    table_of,
)
from silverball.physics.audit import deepest
from silverball.physics.tolerances import HOP
from silverball.table import Cylinder, Paddle, SlantWall, Table, TriangularPrism
from silverball.world import World

RADIUS = 0.25
DEPTH = 1e-9
"""[u] The promise: nothing is ever deeper inside anything."""


def play(world: World, ticks: int, press=lambda tick: {}) -> dict[str, float]:
    """Step on and look at every tick: nothing inside anything, nothing too fast, all finite."""
    seen = {"depth": 0.0, "speed": 0.0, "touched": 0}
    for tick in range(ticks):
        world.step(**press(tick))
        seen["touched"] += sum(event.kind in CONTACTS for event in world.events)
        seen["depth"] = max(seen["depth"], deepest(*world.records))
        for ball in world.balls:
            assert all(map(math.isfinite, (*ball.position, *ball.velocity)))
            seen["speed"] = max(seen["speed"], math.hypot(*speed_of(ball)))
        assert seen["depth"] <= DEPTH
        assert seen["speed"] <= world.table.board.speed_cap
    assert world.tick >= ticks
    return seen


@pytest.mark.parametrize("tick_rate", [10, 60, 240, 1000])
@pytest.mark.parametrize("inside", [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3])
def test_a_graze_of_a_cylinder_is_met_where_the_path_enters_it(inside: float, tick_rate: int) -> None:
    """The top of a parabola reaches `inside` into the circle on which the ball touches: x = top + ½·g·t²
    downward of it."""
    cylinder = Cylinder(center=(0.0, 0.0), radius=0.6, restitution=1.0, speed_factor=1.0)
    reach = 0.85
    # Horizontal flight past the lowest point of the circle: the ball rises to −reach + inside and falls
    # again.
    speed, before = 9.0, 0.2
    start = (-reach + inside - 5 * before**2, -speed * before, 10 * before, speed)
    world = launched(table_of(cylinder), start, tick_rate=tick_rate)
    event = first_contact(world, ticks=tick_rate)
    x, z = place(event)
    assert abs(math.hypot(x, z) - reach) <= 2e-13
    # The gap is about D = ½·κ·s² − inside at s seconds from the top, with κ = v²/r + g the relative bend of
    # path and circle.
    bend = speed**2 / reach + 10.0
    s = before - moment(world, event)
    assert 0.5 * bend * s * s == pytest.approx(inside, rel=0.02, abs=2e-13)
    assert deepest(*world.records) <= DEPTH


@pytest.mark.parametrize("outside", [1e-12, 1e-9, 1e-6, 1e-3])
def test_a_ball_that_passes_just_outside_of_a_cylinder_flies_on(outside: float) -> None:
    cylinder = Cylinder(center=(0.0, 0.0), radius=0.6)
    speed, before = 9.0, 0.2
    start = (-0.85 - outside - 5 * before**2, -speed * before, 10 * before, speed)
    world = launched(table_of(cylinder), start, tick_rate=60)
    for tick in range(1, 25):
        world.step()
        t = tick / 60
        assert not [event for event in world.events if event.part == "cylinder[0]"]
        assert place(world.balls[0]) == pytest.approx(
            (start[0] + 10 * before * t - 5 * t * t, start[1] + speed * t), abs=1e-12
        )


@pytest.mark.parametrize("tick_rate", [10, 60, 1000])
@pytest.mark.parametrize("degrees", [20, 45, 70, 89])
def test_a_ball_slides_down_a_slant_wall_as_free_of_friction_as_it_should(
    degrees: float, tick_rate: int
) -> None:
    """Hops included, it gains g·sin along the wall, and never leaves it by more than a hop's height along
    the normal."""
    s, k = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    wall = SlantWall(start=(5 * s - 2, 4.5 * k), end=(-5 * s - 2, -4.5 * k), restitution=0.0)
    dx, dz = wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]
    long = math.hypot(dx, dz)
    along = (dx / long, dz / long)
    normal = (-along[1], along[0]) if -along[1] > 0 else (along[1], -along[0])
    gap = RADIUS + 0.1 + 1e-7
    x = wall.start[0] + 0.35 * dx + gap * normal[0]
    z = wall.start[1] + 0.35 * dz + gap * normal[1]
    world = launched(table_of(wall, wall_thickness=0.0), (x, z, 0.0, 0.0), tick_rate=tick_rate)
    highest = 0.0
    for tick in range(1, tick_rate // 2 + 1):
        world.step()
        t = tick / tick_rate
        bx, bz = place(world.balls[0])
        way = (bx - x) * along[0] + (bz - z) * along[1]
        if way > 0.5 * long:
            break
        # No force acts along the wall but gravity's part: the hops are along the normal.
        assert way == pytest.approx(0.5 * 10.0 * abs(along[0]) * t * t, abs=1e-9)
        out = (bx - x) * normal[0] + (bz - z) * normal[1]
        highest = max(highest, out)
        assert out >= -1e-7 - DEPTH
    # A hop of speed √(2·g·HOP) against the normal part of gravity alone: height HOP / cos.
    assert highest <= HOP / normal[0] * (1 + 1e-6) + 1e-7


@pytest.mark.parametrize("what", ["tip of a prism", "tip of both paddles", "two cylinders", "notch"])
@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_an_exactly_symmetric_drop_stays_sound(what: str, tick_rate: int) -> None:
    parts: dict[str, list[Any]] = {
        "tip of a prism": [TriangularPrism(vertices=((1.0, -1.0), (1.0, 1.0), (3.0, 0.0)))],
        "tip of both paddles": [
            LEFT.model_copy(update={"pivot": (-7.2, -2.25)}),
            RIGHT.model_copy(update={"pivot": (-7.2, 2.25)}),
        ],
        "two cylinders": [Cylinder(center=(0, -0.7), radius=0.5), Cylinder(center=(0, 0.7), radius=0.5)],
        "notch": [SlantWall(start=(-3, 0), end=(0, -3)), SlantWall(start=(-3, 0), end=(0, 3))],
    }
    world = launched(table_of(*parts[what]), (6.0, 0.0, 0.0, 0.0), tick_rate=tick_rate)
    play(world, 5 * tick_rate)
    assert world.fault is None
    if what == "tip of a prism":
        assert world.balls[0].position[2] == 0.0  # nothing pushes it to a side, and it never falls off


def test_a_ball_dropped_exactly_onto_a_corner_bounces_straight_up() -> None:
    prism = TriangularPrism(vertices=((1.0, -1.0), (1.0, 1.0), (3.0, 0.0)), restitution=0.8, speed_factor=1.0)
    world = launched(table_of(prism), (6.0, 0.0, 0.0, 0.0))
    event = first_contact(world)
    assert event.normal == (1.0, 0.0, 0.0)
    fallen = 6.0 - 3.25
    assert moment(world, event) == pytest.approx(math.sqrt(2 * fallen / 10), abs=1e-14)
    again = next(contacts(world, 1000))
    up = 0.8 * math.sqrt(2 * 10 * fallen)
    assert moment(world, again) - moment(world, event) == pytest.approx(2 * up / 10, abs=1e-13)


@pytest.mark.parametrize("tick_rate", [10, 60, 240])
@pytest.mark.parametrize(
    "part",
    [
        Cylinder(center=(0, 0), radius=1.0),
        TriangularPrism(vertices=((0.0, -1.0), (0.0, 1.0), (-1.0, 0.0))),
        SlantWall(start=(0, -2), end=(0, 2)),
        SlantWall(start=(0, -2), end=(0, 2), thickness=0.0),
    ],
)
def test_a_ball_that_starts_at_rest_against_something_stays_there(part: Any, tick_rate: int) -> None:
    """D next to nothing, D′ = 0."""
    top = {"Cylinder": 1.0, "TriangularPrism": 0.0, "SlantWall": getattr(part, "thickness", 0.0)}[
        type(part).__name__
    ]
    world = launched(table_of(part), (top + RADIUS + 2e-9, 0.0, 0.0, 0.0), tick_rate=tick_rate)
    play(world, 10 * tick_rate)
    x, z = place(world.balls[0])
    assert top + RADIUS - DEPTH <= x <= top + RADIUS + HOP + 3e-9
    assert z == 0.0
    assert (world.score, world.jams) == (0, 0)


@pytest.mark.parametrize("velocity", [(0.0, 7.0), (0.0, 1e-9), (-1e-9, 0.0), (1e-12, -3.0)])
def test_a_start_along_a_surface_is_no_hit(velocity) -> None:
    world = launched(table_of(SlantWall(start=(0, -4), end=(0, 4))), (0.35 + 2e-9, 0.0, *velocity))
    play(world, 60)
    assert world.score == 0
    assert sum(world.hits.values()) == 0


@pytest.mark.parametrize("opening", [4, 15, 40, 90])
@pytest.mark.parametrize("tick_rate", [10, 60, 240])
def test_a_ball_comes_to_rest_in_a_narrow_v(opening: float, tick_rate: int) -> None:
    s, k = math.sin(math.radians(opening / 2)), math.cos(math.radians(opening / 2))
    walls = [SlantWall(start=(-4, 0), end=(-4 + 6 * k, side * 6 * s)) for side in (-1, 1)]
    # A V of this opening holds the ball at a height of (radius + thickness) / sin.
    height = -4 + 0.35 / s
    world = launched(
        table_of(*walls, hit_speed=0.5), (max(height + 2.0, 0.0), 0.01, 0.0, 0.0), tick_rate=tick_rate
    )
    assert height < 0 or opening < 15
    play(world, 20 * tick_rate)
    if opening >= 15:
        x, z = place(world.balls[0])
        # Two hops at once raise it by more than one: two normals of speed h add up to h / sin.
        hop = math.sqrt(2 * 10 * HOP)
        assert abs(z) < 0.1
        assert x - height <= (hop / s) ** 2 / (2 * 10) * 1.1 + 2e-3


def test_overlapping_obstacles_let_no_ball_in() -> None:
    parts = [
        Cylinder(center=(0.0, 0.0), radius=0.8),
        Cylinder(center=(0.3, 0.9), radius=0.7),
        TriangularPrism(vertices=((-0.5, -1.5), (1.0, -0.2), (1.2, -1.4))),
        SlantWall(start=(0.2, -3), end=(-0.4, 3)),
    ]
    for number in range(12):
        world = World(table_of(*parts, *PADDLES, jitter=6.0), seed=number, tick_rate=60)

        def press(tick: int, world=world, number=number):
            if len(world.balls) < 2:
                world.create_ball()
            return {"jitter": (tick + number) % 9 == 0}

        play(world, 900, press)


@pytest.mark.parametrize("tick_rate", [10, 60, 1000, 100_000])
def test_a_cylinder_s_boost_between_narrow_walls_ends_at_the_cap(tick_rate: int) -> None:
    """A pump: every hit of the cylinder gives speed, and the ball is back at once."""
    parts = [
        Cylinder(center=(0, 0), radius=1, restitution=1.0, speed_factor=3.0, points=1),
        SlantWall(start=(-3, 1.8), end=(3, 1.8), restitution=1.0, thickness=0.2),
    ]
    world = launched(table_of(*parts), (0.01, 1.3, 0.0, 9.0), tick_rate=tick_rate)
    seen = play(world, min(8000, 4 * tick_rate))
    assert seen["speed"] > 21.9
    assert seen["touched"] > 3


@pytest.mark.parametrize("tick_rate", [10, 60, 1000])
@pytest.mark.parametrize("speed_cap", [22.0, 200.0])
def test_the_fastest_ball_passes_through_nothing(speed_cap: float, tick_rate: int) -> None:
    """A thin wall across the whole board, hit at the cap from below again and again."""
    wall = SlantWall(start=(0.0, -5.0), end=(0.3, 5.0), thickness=0.0, restitution=1.0)
    table = table_of(wall, speed_cap=speed_cap, wall_restitution=1.0, gutter=-9.5)
    for number in range(20):
        turn = -0.6 + number * 0.06
        v = speed_cap * (1 - 1e-12)
        world = launched(
            table, (-5.0, 0.2 * number - 2, v * math.cos(turn), v * math.sin(turn)), tick_rate=tick_rate
        )
        for _ in range(tick_rate // 2):
            world.step()
            for ball in world.balls:
                x, z = place(ball)
                assert x < 0.15 + 0.03 * z - RADIUS * math.cos(math.atan(0.03)) + DEPTH
        assert any(world.hits.values())


def jammed_tables() -> dict[str, Table]:
    fast = {"stroke": 0.1, "return_stroke": 0.1}
    lifting = Paddle(side="left", pivot=(0.0, -2.5), up_angle=60, **fast)
    other = Paddle(side="right", pivot=(0.0, 2.5), up_angle=60, **fast)
    return {
        "two paddles": table_of(
            lifting.model_copy(update={"pivot": (0.0, -2.25), "rest_angle": -40, "up_angle": 0}),
            other.model_copy(update={"pivot": (0.0, 2.25), "rest_angle": -40, "up_angle": 0}),
        ),
        "paddle and wall above": table_of(lifting, SlantWall(start=(1.0, -3.0), end=(1.0, 3.0))),
        "paddle and cylinder": table_of(lifting, Cylinder(center=(1.3, -1.2), radius=0.6)),
        "paddle and prism": table_of(
            lifting, TriangularPrism(vertices=((0.7, -2.0), (0.8, 0.0), (2.0, -1.0)))
        ),
        "paddle and border": table_of(Paddle(side="left", pivot=(0.0, 3.0), length=1.8, up_angle=20, **fast)),
        "paddle coming down onto a wall": table_of(
            lifting.model_copy(update={"rest_angle": -40}), SlantWall(start=(-1.2, -3), end=(-1.2, 3))
        ),
    }


@pytest.mark.parametrize("tick_rate", [10, 60, 240, 1000])
@pytest.mark.parametrize("what", sorted(jammed_tables()))
def test_a_pinched_ball_is_held_and_pressed_into_nothing(what: str, tick_rate: int) -> None:
    table = jammed_tables()[what]
    jams = 0
    for number in range(0, 40, 4 if tick_rate == 1000 else 1):
        world = World(table, seed=number, tick_rate=tick_rate)
        x, z = -0.4 + 0.035 * number, -2.0 + 0.1 * (number * 7 % 40)
        if what == "two paddles":
            x, z = -1.0 + 0.02 * number, -0.1 + 0.02 * (number % 10)
        if what == "paddle and border":
            z = 4.0 + 0.03 * (number * 7 % 20)
        if what == "paddle coming down onto a wall":
            world.step(left=True, ticks=tick_rate)
            x = -0.85 + 0.02 * (number % 10)
        for dz in (0.0, 0.6):
            if world.clearance(x, z + dz) > 1e-6 and not any(
                math.dist((x, z + dz), place(ball)) < 0.51 for ball in world.balls
            ):
                world.create_ball((x, z + dz))
        if not world.balls:
            continue
        start = world.tick
        hold = tick_rate // 3 + 1

        def press(tick: int, hold=hold):
            down = tick // hold % 2 == 0
            return (
                {"left": down, "right": down}
                if what != "paddle coming down onto a wall"
                else {"left": not down}
            )

        play(world, 4 * hold, press)
        assert world.tick == start + 4 * hold
        jams += world.jams
        # Whatever was pinched: with the buttons let go (or held) the paddles come to their stops again.
        world.step(left=what == "paddle coming down onto a wall", ticks=tick_rate)
        if what != "paddle coming down onto a wall":
            rest = math.radians(table.paddle[0].rest_angle)
            assert world.paddles[0].angle == pytest.approx(rest, abs=1e-12)
    if what != "paddle and border":
        assert jams > 0


def test_a_stalled_paddle_stands_still_and_goes_on_when_the_ball_is_gone() -> None:
    table = jammed_tables()["paddle and wall above"]
    world = launched(table, (0.5, -1.4, 0.0, 0.0), tick_rate=240)
    for _ in range(240):
        world.step(left=True)
        if world.jams:
            break
    assert world.jams > 0
    assert any(event.kind == "jam" for event in world.events)
    held = world.paddles[0].angle
    assert math.radians(-10) < held < math.radians(60)
    assert world.paddles[0].angular_velocity == 0.0
    world.step(left=True, ticks=20)
    assert world.paddles[0].angle < math.radians(60)

    def gone(record) -> None:
        record["ball"][0] = 0

    world.restore(edited(world, gone))
    world.step(left=True, ticks=60)
    assert world.paddles[0].angle == math.radians(60)


def test_a_free_game_has_no_jam() -> None:
    world = World(full_table(), seed=11, tick_rate=60)

    def press(tick: int):
        if len(world.balls) < 2:
            world.create_ball()
        return {"left": tick % 23 < 9, "right": tick % 31 < 12, "jitter": tick % 97 == 0}

    play(world, 6000, press)
    assert world.jams == 0
    assert world.drained > 0


def test_a_free_ball_flies_on_while_the_other_is_pinched() -> None:
    world = launched(jammed_tables()["paddle and wall above"], (0.5, -1.4, 0.0, 0.0), (8.0, 3.0, 0.0, 0.0))
    world.step(left=True, ticks=240)
    assert world.jams > 10
    assert place(world.balls[1]) == pytest.approx((8.0 - 5.0, 3.0), abs=1e-12)
