"""Checks, reachability and placement with the parts of format 2: shapes and responses, not kinds."""

import math
import time
import tracemalloc

import numpy as np
import pytest

from silverball.errors import TableError
from silverball.physics.forms import Response, Shape
from silverball.table import (
    Board,
    Cylinder,
    Paddle,
    RandomRecipe,
    SlantWall,
    Table,
    ball_places,
    check_table,
    dump_table,
    generate_table,
    parse_table,
)
from silverball.table.geometry import (
    Pieces,
    closed_corners,
    core_distances,
    distances,
    moving_pieces,
    near_pairs,
    pieces_of,
)
from silverball.table.kinds import DropTarget, Gate, Hole, Level, Passage, Plunger, Post, Slingshot, Wall
from silverball.table.placed_parts import Layout
from silverball.table.placement_rules import Surroundings
from silverball.table.primitive import Mover, Primitive
from silverball.table.reach import space

BOX = ((2.0, -2.0), (4.0, -2.0), (4.0, 2.0), (2.0, 2.0))
ROOF = [SlantWall(start=(-3.0, -5.0), end=(-2.0, 0.0)), SlantWall(start=(-2.0, 0.0), end=(-3.0, 5.0))]
SEALED_LANE = SlantWall(start=(-9.0, 4.0), end=(9.5, 4.0)), SlantWall(start=(9.4, 4.0), end=(9.4, 5.0))


def errors(table):
    return [(p.path, p.message) for p in check_table(table) if p.is_error]


def warnings(table):
    return [(p.path, p.message) for p in check_table(table) if not p.is_error]


def is_reached(table, x, z, level=0):
    return space(Layout.of(table)).reaches((x, z), level)


# Errors and warnings


def test_what_real_tables_have_is_a_warning_and_the_table_loads():
    overlapping = Table(
        cylinder=[Cylinder(center=(0, 0), radius=1), Cylinder(center=(1, 0), radius=1)],
        slant_wall=[SlantWall(start=(3, -2), end=(5, 2)), SlantWall(start=(5, -2), end=(3, 2))],
    )
    assert errors(overlapping) == []
    messages = " ".join(message for _, message in warnings(overlapping))
    assert "overlaps cylinder[0]" in messages
    assert "crosses slant_wall[0]" in messages
    assert "pocket" in messages
    assert parse_table(dump_table(overlapping)) == overlapping


def test_a_refused_table_names_its_errors_only():
    table = Table(
        cylinder=[Cylinder(center=(0, 0), radius=1), Cylinder(center=(1, 0), radius=1)],
        paddle=[Paddle(side="left", pivot=(-7.2, -4.8))],
    )
    assert warnings(table)
    with pytest.raises(TableError) as caught:
        parse_table(dump_table(table))
    assert all(problem.is_error for problem in caught.value.problems)


def test_two_parts_are_reported_once_however_many_edges_they_have():
    circle = [(2.0 * math.sin(a), 2.0 * math.cos(a)) for a in np.linspace(0.0, 6.2, 60)]
    star = Wall(points=tuple(circle), closed=True)
    table = Table(wall=[star], post=[Post(center=(2.0, 0.0), radius=0.5)])
    ((path, message),) = [(path, m) for path, m in warnings(table) if "overlaps" in m]
    assert (path, message) == ("post[0].center", "overlaps wall[0]: move one of the two")


def test_a_part_inside_a_closed_wall_overlaps_it():
    table = Table(wall=[Wall(points=BOX, closed=True)], post=[Post(center=(3.0, 0.0))])
    assert any("overlaps" in message for _, message in warnings(table))
    opened = Table(wall=[Wall(points=BOX)], post=[Post(center=(3.0, 0.0))])
    assert not any("overlaps" in message for _, message in warnings(opened))


def test_a_part_partly_beyond_the_board_is_a_warning_and_wholly_beyond_it_an_error():
    assert "beyond the edge" in warnings(Table(post=[Post(center=(0.0, 4.95))]))[0][1]
    ((path, message),) = errors(Table(post=[Post(center=(0.0, 7.0))]))
    assert path == "post[0].center"
    assert "onto the board" in message


@pytest.mark.parametrize(
    ("parts", "path", "words"),
    [
        ({"hole": [Hole(center=(0, 0), exit=(3, 0), exit_velocity=(1, 0))]}, "hole[0].exit", "is inside"),
        ({"hole": [Hole(center=(0, 0), exit=(0, 4.9), exit_velocity=(1, 0))]}, "hole[0].exit", "inside"),
        ({"plunger": [Plunger(position=(3.0, 0.0))]}, "plunger[0].position", "room for a ball"),
        ({"plunger": [Plunger(position=(1.6, 0.0))]}, "plunger[0].position", "room in front"),
        (
            {
                "passage": [Passage(start=(1.9, 0.0), end=(0.0, 0.0), from_level=1, to_level=0)],
                "level": [Level(number=1)],
            },
            "passage[0].end",
            "leads into a wall",
        ),
        ({"gate": [Gate(start=(2.0, -1.0), end=(2.0, 1.0), passes="up")]}, "gate[0].end", "no room"),
        ({"slingshot": [Slingshot(start=(-2, -2), end=(0, -3), kick=25.0)]}, "slingshot[0].kick", "cap"),
        ({"plunger": [Plunger(position=(0, 4), launch=(5, 40))]}, "plunger[0].launch", "speed cap"),
        ({"hole": [Hole(center=(0, 0), exit_velocity=(20, 20))]}, "hole[0].exit_velocity", "speed cap"),
        ({"post": [Post(center=(0, 0), level=3)]}, "post[0]", "levels of the table (0), got 3"),
        (
            {"paddle": [Paddle(side="left", pivot=(x, -2.0), length=0.5) for x in range(-8, 1)]},
            "paddle",
            "too many paddles: at most 8, got 9",
        ),
        (
            {"drop_target": [DropTarget(start=(6, -4 + i / 10), end=(6, -3.95 + i / 10)) for i in range(63)]},
            "",
            "too many drop targets",
        ),
    ],
)  # fmt: skip
def test_what_cannot_work_is_an_error_at_its_place(parts, path, words):
    found = errors(Table(wall=[Wall(points=BOX, closed=True)], **parts))
    assert any(place == path and words in message for place, message in found), found


def test_the_same_devices_in_free_places_are_no_errors():
    table = Table(
        wall=[Wall(points=BOX, closed=True)],
        hole=[Hole(center=(0, 0), exit=(-2, 0), exit_velocity=(1, 0))],
        plunger=[Plunger(position=(0.0, 4.0))],
        passage=[Passage(start=(6.0, -1.0), end=(6.0, 1.0), from_level=0, to_level=1)],
        level=[Level(number=1)],
        gate=[Gate(start=(-5.0, -2.0), end=(-4.8, -1.0), passes="up")],
    )
    assert errors(table) == []


def test_a_plunger_in_a_sealed_lane_does_not_lead_into_play():
    lane = Table(slant_wall=[SEALED_LANE[0]], plunger=[Plunger(position=(-8.0, 4.5))])
    bottom = SlantWall(start=(-8.8, 4.0), end=(-8.8, 5.0))
    sealed = lane.model_copy(update={"slant_wall": (*SEALED_LANE, bottom)})
    assert any("has no way out of its lane" in message for _, message in errors(sealed))
    assert not any("lane" in message for _, message in errors(lane))


def test_a_coil_makes_the_tip_twice_as_fast():
    keys = {"side": "left", "pivot": (-7.2, -2.5), "shape": "capsule"}
    reach = 2.1 + 0.12
    travel = math.radians(55) * reach
    stroke = travel / 15.0
    constant = Table(paddle=[Paddle(**keys, stroke=stroke, return_stroke=0.5)])
    coil = Table(paddle=[Paddle(**keys, stroke=stroke, return_stroke=0.5, profile="coil")])
    assert errors(constant) == []
    ((path, message),) = errors(coil)
    assert path == "paddle[0].stroke"
    assert "30.0 u/s" in message


def test_a_capsule_paddle_that_turns_into_a_post_is_an_error():
    paddle = Paddle(side="right", pivot=(-7.0, 2.0), shape="capsule", rest_angle=-30, up_angle=30)
    for gap, touched in ((0.015, True), (0.03, False)):
        turn = math.radians(10.0)
        away = 2.1 + 0.12 + 0.1 + gap
        post = Post(center=(-7.0 + away * math.sin(turn), 2.0 - away * math.cos(turn)), radius=0.1)
        table = Table(paddle=[paddle], post=[post])
        assert bool([m for _, m in errors(table) if "clear of post[0]" in m]) == touched


def test_parts_on_different_levels_do_not_meet():
    post = {"center": (-7.0, -1.0), "radius": 0.2}
    paddle = [Paddle(side="left", pivot=(-7.2, -2.5))]
    assert errors(Table(paddle=paddle, post=[Post(**post)]))
    assert errors(Table(paddle=paddle, post=[Post(**post, level=1)], level=[Level(number=1)])) == []
    overlapping = Table(
        post=[Post(center=(0, 0), radius=1), Post(center=(1, 0), radius=1, level=1)], level=[Level(number=1)]
    )
    assert not any("overlaps" in message for _, message in warnings(overlapping))


# Ways out


def no_way_out(table):
    return any("no way to the gutter" in message for _, message in errors(table))


def test_drains_and_holes_are_ways_out_and_one_below_does_not_help():
    assert no_way_out(Table(slant_wall=ROOF))
    assert not no_way_out(Table(slant_wall=ROOF, hole=[Hole(center=(3, 0), drain=True)]))
    assert not no_way_out(
        Table(slant_wall=ROOF, hole=[Hole(center=(3, 0), exit=(-5, 0), exit_velocity=(1, 0))])
    )
    assert no_way_out(Table(slant_wall=ROOF, hole=[Hole(center=(-5, 0), exit=(3, 0), exit_velocity=(1, 0))]))


@pytest.mark.parametrize(("passes", "leads_out"), [("down", True), ("up", False)])
def test_a_gate_is_a_way_in_its_direction_only(passes, leads_out):
    walls = [SlantWall(start=(-2.0, -5.0), end=(-2.0, -1.0)), SlantWall(start=(-2.0, 1.0), end=(-2.0, 5.0))]
    gate = Gate(start=(-2.0, -1.0), end=(-2.0, 1.0), passes=passes)
    assert no_way_out(Table(slant_wall=walls, gate=[gate])) != leads_out


@pytest.mark.parametrize(("passes", "holds"), [("down", False), ("up", True)])
def test_a_gate_holds_a_ball_on_one_side_only(passes, holds):
    wall = SlantWall(start=(2.0, -1.0), end=(1.0, 0.0))
    pocket = Table(slant_wall=[wall], gate=[Gate(start=(1.0, 0.0), end=(2.0, 1.0), passes=passes)])
    level = Table(gate=[Gate(start=(-2.0, -1.0), end=(-2.0, 1.0), passes=passes)])
    assert any("pocket" in problem.message for problem in check_table(pocket)) == holds
    assert any("level within" in problem.message for problem in check_table(level)) == holds


def test_a_drop_target_and_a_held_gate_are_ways_in_both_directions():
    walls = [SlantWall(start=(-2.0, -5.0), end=(-2.0, -1.0)), SlantWall(start=(-2.0, 1.0), end=(-2.0, 5.0))]
    ends = {"start": (-2.0, -1.0), "end": (-2.0, 1.0)}
    assert not no_way_out(Table(slant_wall=walls, drop_target=[DropTarget(**ends)]))
    assert not no_way_out(Table(slant_wall=walls, gate=[Gate(**ends, held=True, name="lock")]))


@pytest.mark.parametrize("is_down", [True, False])
def test_a_passage_changes_the_level_in_its_direction(is_down):
    """Below a wall with one opening lies a roof, but only on level 0: a ball must get down to level 1."""
    ends = ((3.0, 2.0), (3.0, -2.0)) if is_down else ((3.0, -2.0), (3.0, 2.0))  # its left is down, or up
    halves = [
        SlantWall(start=(3.0, -5.0), end=(3.0, -2.0), levels=(0, 1)),
        SlantWall(start=(3.0, 2.0), end=(3.0, 5.0), levels=(0, 1)),
    ]
    passage = Passage(start=ends[0], end=ends[1], from_level=0, to_level=1)
    table = Table(slant_wall=[*ROOF, *halves], passage=[passage], level=[Level(number=1)])
    assert is_reached(table, 8.0, 0.0) == is_down
    assert is_reached(table, -8.0, 0.0)


def test_lanes_that_a_ball_barely_fits_lead_out_in_format_2_with_a_warning():
    walls = [
        Wall(points=((-2.0, -5.0), (-2.0, -0.33), (2.0, 0.67)), thickness=0.05),
        Wall(points=((-2.0, 5.0), (-2.0, 0.3), (2.0, 1.3)), thickness=0.05),
    ]
    table = Table(wall=walls)
    assert not no_way_out(table)
    assert any("barely fits" in message for _, message in warnings(table))


def test_no_ball_is_created_in_a_closed_wall_or_in_reach_of_an_upper_paddle():
    paddles = [Paddle(side="left", pivot=(-7.2, -2.5)), Paddle(side="left", pivot=(3.0, -4.0), length=1.0)]
    cells, _ = ball_places(Table(paddle=paddles, wall=[Wall(points=BOX, closed=True)]))
    assert cells[:, 0].min() < 0.0
    inside = (cells[:, 0] > 2.2) & (cells[:, 0] < 3.8) & (np.abs(cells[:, 1]) < 1.8)
    assert not inside.any()
    assert np.hypot(*(cells - (3.0, -4.0)).T).min() > 1.0


# Geometry


def sampled_arc(primitive, count=400):
    arc = primitive.arc
    turns = np.linspace(-arc.half_angle, arc.half_angle, count)
    (cx, cz), (mx, mz) = arc.center, arc.middle
    x = cx + arc.radius * (mx * np.cos(turns) + mz * np.sin(turns))
    return np.stack([x, cz + arc.radius * (mz * np.cos(turns) - mx * np.sin(turns))], axis=1)


@pytest.mark.parametrize("bulge", [0.05, 0.414, 1.0, 2.5, -0.2, -1.0])
def test_the_chain_of_an_arc_lies_within_a_thousandth_of_it(bulge):
    arc = Primitive(Shape.ARC, ((0.0, -1.0), (0.5, 2.0)), 0.1, bulge=bulge)
    pieces = Pieces.of([[arc]])
    gaps = distances(sampled_arc(arc)[:, None, :], pieces.core[None]).min(axis=1)
    assert gaps.max() < 1.001e-3
    assert (pieces.core[0, 0].tolist(), pieces.core[-1, 1].tolist()) == ([0.0, -1.0], [0.5, 2.0])
    to_center = pieces.core.mean(axis=1) - np.array(arc.arc.center)
    assert ((to_center * pieces.outer).sum(axis=1) > 0.0).all()


@pytest.mark.parametrize(("base", "tip"), [(0.5, 0.2), (0.2, 0.2), (0.2, 0.5)])
def test_a_tapered_capsule_is_the_hull_of_its_circles(base, tip):
    shape = Primitive(Shape.TAPERED, ((0.0, 0.0), (0.3, 2.0)), base, tip_radius=tip)
    pieces = Pieces.of([[shape]])
    shares = np.linspace(0.0, 1.0, 2001)
    points = np.random.default_rng(1).uniform(-1.5, 3.5, (200, 2))
    axis = shares[:, None] * np.array([0.3, 2.0])
    hull = np.min(
        np.hypot(*(points[:, None] - axis).transpose(2, 0, 1)) - (base + shares * (tip - base)), axis=1
    )
    found = (distances(points[:, None, :], pieces.core[None]) - pieces.radius).min(axis=1)
    outside = hull > 0.01
    assert found[outside] == pytest.approx(hull[outside], abs=2e-3)
    assert (found[hull < -0.01] <= 0.0).all()


def test_the_pieces_of_a_turning_capsule_turn_with_it():
    mover = Mover((1.0, 2.0), -1.0, 0.0, 1.0, 0.1, 0.1, "right")
    paddle = Primitive(Shape.TAPERED, ((0.0, 0.0), (0.0, 2.0)), 0.2, tip_radius=0.1, mover=mover)
    cores, radii = moving_pieces(paddle, np.array([0.0, 0.5]))
    assert radii.tolist() == [0.2, 0.1, 0.0, 0.0]
    assert cores[0, 1, 0] == pytest.approx((1.0, 0.0))
    assert cores[1, 1, 0] == pytest.approx((1.0 + 2.0 * math.sin(0.5), 2.0 - 2.0 * math.cos(0.5)))


def test_a_closed_chain_has_an_inside_even_if_it_is_concave():
    u_shape = Wall(points=((0, 0), (0, 3), (3, 3), (3, 2), (1, 2), (1, 1), (3, 1), (3, 0)), closed=True)
    layout = Layout.of(Table(wall=[u_shape]))
    (polygon,) = layout.polygons()
    points = np.array([[0.5, 1.5], [2.0, 1.5], [2.0, 0.5], [2.0, 2.5], [4.0, 1.0]])
    assert polygon.contains(points).tolist() == [True, False, True, True, False]
    assert closed_corners(Layout.of(Table(wall=[u_shape.replace(closed=False)])).parts[0].solid) is None


def random_pieces(seed, count=60):
    numbers = np.random.default_rng(seed)
    bodies = [
        [Primitive(Shape.CAPSULE, tuple(map(tuple, numbers.uniform(-5, 5, (2, 2)))), numbers.uniform(0, 0.3))]
        for _ in range(count)
    ]
    bodies += [[Primitive(Shape.CIRCLE, (tuple(numbers.uniform(-5, 5, 2)),), 0.4)] for _ in range(count)]
    return Pieces.of(bodies)


def test_near_pairs_are_those_that_all_comparisons_find():
    pieces = random_pieces(3)
    found = near_pairs(pieces, 0.6, 10**6)
    gap = core_distances(pieces.core[:, None], pieces.core[None])
    gap = gap - pieces.radius[:, None] - pieces.radius
    expected = np.argwhere(np.triu(gap < 0.6, 1))
    assert np.stack([found.first, found.second], axis=1).tolist() == expected.tolist()
    assert found.gap == pytest.approx(gap[tuple(expected.T)])
    assert found.is_complete
    assert not near_pairs(pieces, 0.6, 10).is_complete


@pytest.mark.parametrize("seed", range(4))
def test_free_samples_are_those_that_every_distance_leaves(seed):
    """Also where samples lie exactly a ball's radius from a wall: on such a tie a sample is free."""
    numbers = np.random.default_rng(seed)
    walls = [
        SlantWall(start=tuple(numbers.uniform(-8, 8, 2) / 2), end=tuple(numbers.uniform(-8, 8, 2) / 2))
        for _ in range(8)
    ]
    column = 33 * 0.0390625  # of samples, half a unit from the middle of this wall
    upright = SlantWall(start=(-5.0, column - 0.5), end=(5.0, column - 0.5), thickness=0.25)
    table = Table(slant_wall=[*walls, upright], cylinder=[Cylinder(center=(6.0, -2.0), radius=0.9)])
    layout = Layout.of(table)
    where = space(layout)
    points = np.stack(np.meshgrid(where.grid.x, where.grid.z, indexing="ij"), axis=-1)
    pieces = layout.solids()
    gaps = np.stack([distances(points, core) for core in pieces.core], axis=-1) - pieces.radius
    margin = 0.1 + 0.25
    expected = (gaps >= 0.25 - 1e-15).all(axis=-1)
    expected &= (points[..., 0] <= 10.0 - margin) & (np.abs(points[..., 1]) <= 5.0 - margin)
    assert (where.free[0] == expected).all()


def test_sensors_and_holes_are_not_solid():
    table = Table(hole=[Hole(center=(0, 0), exit_velocity=(1, 0))])
    assert len(Layout.of(table).solids().radius) == 0
    disc = table.hole[0].primitives(Board())[0]
    assert (disc.response, len(pieces_of(disc))) == (Response.HOLD, 1)


# Placement


def test_a_recipe_of_format_2_is_placed_around_all_of_its_parts():
    recipe = Table(
        board=Board(),
        wall=[Wall(points=((0.5, -4.0), (6.0, -4.0), (6.0, 0.0), (0.5, 0.0)), closed=True)],
        post=[Post(center=(8.0, 2.0), radius=0.3), Post(center=(8.2, 2.3), radius=0.3)],  # they overlap
        hole=[Hole(center=(4.0, 3.5), exit=(-2.0, 0.0), exit_velocity=(1, 0))],
        random=RandomRecipe(
            triangular_prisms=2, cylinders=3, cylinder_radius=(0.3, 0.5), prism_size=(0.5, 0.6)
        ),
    )
    own = set(check_table(recipe.model_copy(update={"random": None})))
    assert own
    for seed in range(5):
        board = generate_table(seed, recipe)
        assert set(check_table(board)) <= own
        for cylinder in board.cylinder:
            x, z = cylinder.center
            assert not (0.5 < x < 6.0 and -4.0 < z < 0.0)
            assert math.dist((x, z), (4.0, 3.5)) > 0.3 + 0.9
            assert math.dist((x, z), (-2.0, 0.0)) > 0.25 + 0.9


def test_a_place_in_a_closed_wall_is_no_place_for_an_obstacle():
    around = Surroundings.of(Layout.of(Table(wall=[Wall(points=BOX, closed=True)])))
    inside, outside = around.wall_distances(np.array([[3.0, 0.0], [0.0, 0.0]]))
    assert inside == -math.inf
    assert outside == pytest.approx(2.0 - 0.05)


# Time and memory


def crossing_walls():
    ends = np.random.default_rng(0).uniform((-9.5, -4.9), (9.5, 4.9), (4000, 2, 2))
    return Table(slant_wall=[SlantWall(start=tuple(a), end=tuple(b)) for a, b in ends.tolist()])


def rich_table():
    """Forty closed walls of a hundred short edges each."""
    walls = []
    for number in range(40):
        x, z = -20.0 + number // 6 * 6.0, -18.0 + number % 6 * 7.0
        turns = np.linspace(0.0, 2.0 * math.pi, 101)[:-1]
        radii = 2.0 + 0.25 * np.sin(5.0 * turns)
        points = np.stack([x + radii * np.sin(turns), z + radii * np.cos(turns)], axis=1)
        walls.append(Wall(points=tuple(map(tuple, points.tolist())), closed=True, thickness=0.0))
    return Table(board=Board(length=50.0, width=44.0, gutter=-24.5), wall=walls)


@pytest.mark.parametrize("make", [crossing_walls, rich_table])
def test_thousands_of_edges_are_checked_in_seconds_and_in_little_memory(make):
    table = make()
    start = time.process_time()
    check_table(table)
    assert time.process_time() - start < 60.0, "it takes three, but for machines that are very busy"
    tracemalloc.start()
    try:
        check_table(table)
        assert tracemalloc.get_traced_memory()[1] < 200e6
    finally:
        tracemalloc.stop()
