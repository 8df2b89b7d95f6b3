"""`check_table` finds what makes a table unplayable, and nothing else."""

import math
import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from boards import RANDOM
from silverball.errors import TableError
from silverball.physics.tolerances import HOP
from silverball.table import (
    Board,
    Cylinder,
    Paddle,
    RandomRecipe,
    SlantWall,
    Table,
    TriangularPrism,
    check_table,
    dump_table,
    generate_table,
    parse_table,
)
from silverball.table.geometry import core_distances, distances, moving_pieces
from silverball.table.placed_parts import Layout
from silverball.table.reach import resting_pieces, space
from silverball.table.traps import Terrain, pockets

EMPTY = RANDOM.model_copy(update={"random": None})  # guides, corners and paddles


def with_parts(base=EMPTY, **parts):
    """The base table with more parts."""
    return base.model_copy(update={kind: (*getattr(base, kind), *more) for kind, more in parts.items()})


def problems_at(table, path):
    return [problem.message for problem in check_table(table) if problem.path.startswith(path)]


def test_there_is_no_false_alarm_on_200_generated_boards():
    for seed in range(200):
        assert check_table(generate_table(seed)) == []


def test_a_table_without_paddles_can_be_checked_too():
    assert check_table(Table(cylinder=[Cylinder(center=(0, 0), radius=1)])) == []


# Overlaps and edges


def test_overlapping_obstacles_are_reported_at_the_later_one():
    first = Cylinder(center=(2.0, 0.0), radius=0.6)
    second = TriangularPrism(vertices=((2.2, 0.3), (3.5, 0.5), (2.5, 1.6)))
    (message,) = problems_at(with_parts(cylinder=[first], triangular_prism=[second]), "cylinder[0]")
    assert "overlaps triangular_prism[0]" in message


def test_a_small_obstacle_wholly_inside_another_overlaps_it():
    inside = Cylinder(center=(2.5, 0.0), radius=0.1)
    around = TriangularPrism(center=(2.5, 0.0), size=1.5, rotation=15)
    assert problems_at(with_parts(cylinder=[inside], triangular_prism=[around]), "cylinder[0]")


def test_a_wall_that_runs_through_a_prism_overlaps_it():
    wall = SlantWall(start=(0.0, -2.0), end=(3.0, 2.0))
    prism = TriangularPrism(center=(1.5, 0.0), size=0.9, rotation=15)
    assert problems_at(with_parts(slant_wall=[wall], triangular_prism=[prism]), "triangular_prism[0]")


def test_walls_may_meet_at_their_ends_but_not_cross():
    meeting = [SlantWall(start=(0, -1), end=(2, 0)), SlantWall(start=(2, 0), end=(0, 1))]
    crossing = [SlantWall(start=(0, -1), end=(2, 1)), SlantWall(start=(0, 1), end=(2, -1))]
    assert problems_at(with_parts(slant_wall=meeting), "slant_wall") == []
    assert any(
        "crosses slant_wall[4]" in message for message in problems_at(with_parts(slant_wall=crossing), "")
    )


@pytest.mark.parametrize(
    "part",
    [
        {"cylinder": [Cylinder(center=(0.0, 4.5), radius=0.6)]},
        {"cylinder": [Cylinder(center=(9.8, 0.0), radius=0.6)]},
        {"triangular_prism": [TriangularPrism(center=(0.0, -4.8), size=0.8, rotation=15)]},
        {"slant_wall": [SlantWall(start=(0.0, 3.0), end=(2.0, 5.5))]},
    ],
)
def test_what_reaches_over_the_edge_is_reported(part):
    messages = problems_at(with_parts(**part), next(iter(part)))
    assert sum("beyond the edge of the board" in message for message in messages) == 1


def test_flat_parts_are_reported_and_do_not_disturb_the_other_checks():
    flat = TriangularPrism(vertices=((0, 0), (1, 1), (2, 2)))
    point = SlantWall(start=(1, 1), end=(1, 1))
    table = with_parts(triangular_prism=[flat], slant_wall=[point])
    assert [problem.path for problem in check_table(table)] == [
        "slant_wall[4].end",
        "triangular_prism[0].vertices",
    ]


def test_the_gutter_and_the_pivots_lie_on_the_board():
    assert problems_at(EMPTY.model_copy(update={"board": Board(gutter=-10.5)}), "board.gutter")
    outside = EMPTY.paddle[0].model_copy(update={"pivot": (-9.5, -2.5)})
    assert problems_at(EMPTY.model_copy(update={"paddle": (outside, EMPTY.paddle[1])}), "paddle[0].pivot")


def test_a_gap_that_a_ball_only_just_fits_is_reported_and_a_closed_or_a_wide_one_is_not():
    def pair(gap):
        left = Cylinder(center=(2.0, -0.5 - gap / 2), radius=0.5)
        right = Cylinder(center=(3.0, 0.5 + gap / 2), radius=0.5)
        between = math.dist(left.center, right.center) - 1.0
        return with_parts(cylinder=[left, right]), between

    for gap, is_tight in ((0.1, False), (0.15, True), (0.5, False)):
        table, between = pair(gap)
        assert (0.5 <= between < 0.61) == is_tight
        assert bool(problems_at(table, "cylinder[1]")) == is_tight, between


# Paddles


def test_a_paddle_as_fast_as_the_cap_is_refused_with_a_stroke_that_works():
    fast = EMPTY.paddle[0].model_copy(update={"stroke": 0.06})
    table = EMPTY.model_copy(update={"paddle": (fast, EMPTY.paddle[1])})
    ((path, message, severity),) = check_table(table)
    assert severity == "error"
    assert path == "paddle[0].stroke"
    assert f"{math.radians(55) / 0.06 * 2.1:.1f} u/s" in message
    assert "22 u/s" in message
    works = float(message.split("make it ")[1].split(" s")[0])
    tip = math.radians(55) / works * 2.1
    assert tip + math.sqrt(2 * (10 + tip**2 / 2.1) * HOP) < 22.0
    mended = fast.model_copy(update={"stroke": works})
    assert check_table(EMPTY.model_copy(update={"paddle": (mended, EMPTY.paddle[1])})) == []
    barely = fast.model_copy(update={"stroke": works - 0.001})
    assert check_table(EMPTY.model_copy(update={"paddle": (barely, EMPTY.paddle[1])})) != []


def test_the_way_back_is_a_stroke_too():
    fast = EMPTY.paddle[1].model_copy(update={"return_stroke": 0.05})
    ((path, *_),) = check_table(EMPTY.model_copy(update={"paddle": (EMPTY.paddle[0], fast)}))
    assert path == "paddle[1].return_stroke"


def test_two_paddles_on_one_side_need_format_2():
    twice = EMPTY.paddle[0].model_copy(update={"pivot": (2.0, -2.5)})
    (message,) = problems_at(with_parts(paddle=[twice]), "paddle[2].side")
    assert "format = 2" in message


def test_a_guide_that_the_turning_paddle_would_touch_is_refused():
    near = EMPTY.slant_wall[0].model_copy(update={"end": (-7.0, -2.62)})
    table = EMPTY.model_copy(update={"slant_wall": (near, *EMPTY.slant_wall[1:])})
    (message,) = problems_at(table, "paddle[0]")
    assert "clear of slant_wall[0] in its swing" in message


def test_an_obstacle_that_is_only_touched_half_way_up_is_found():
    # It lies off the paddle at rest and off the paddle up, in the middle of the turn.
    turn = math.radians(17.5)
    place = (-7.2 + 2.4 * math.sin(turn), -2.5 + 2.4 * math.cos(turn))
    for radius, touched in ((0.35, True), (0.27, False)):
        post = Cylinder(center=place, radius=radius)
        messages = problems_at(with_parts(cylinder=[post]), "paddle[0]")
        assert bool(messages) == touched
        assert all("cylinder[0]" in message for message in messages)


def test_a_post_thinner_than_the_steps_of_the_search_is_found():
    for angle in np.linspace(-9.0, 44.0, 40):
        place = (-7.2 + 2.0 * math.sin(math.radians(angle)), -2.5 + 2.0 * math.cos(math.radians(angle)))
        assert problems_at(with_parts(cylinder=[Cylinder(center=place, radius=0.05)]), "paddle[0]")


def test_paddles_that_touch_each_other_or_a_border_are_refused():
    longer = tuple(
        paddle.model_copy(update={"length": 2.52, "stroke": 0.2, "return_stroke": 0.2})
        for paddle in EMPTY.paddle
    )
    assert any(
        "clear of paddle[0]" in m
        for m in problems_at(EMPTY.model_copy(update={"paddle": longer}), "paddle[1]")
    )
    aside = EMPTY.paddle[0].model_copy(update={"pivot": (-7.2, -4.8)})
    messages = problems_at(Table(paddle=[aside]), "paddle[0]")
    assert any("the left border" in message for message in messages)


# The way out, and traps


def test_paddles_that_close_the_way_between_them_leave_no_way_to_the_gutter():
    longer = tuple(
        paddle.model_copy(update={"length": 2.35, "stroke": 0.2, "return_stroke": 0.2})
        for paddle in EMPTY.paddle
    )
    assert 5.0 - 2 * 2.35 * math.cos(math.radians(10)) < 0.5  # between the tips at rest: less than a ball
    (message, *_) = problems_at(EMPTY.model_copy(update={"paddle": longer}), "board")
    assert "no way to the gutter" in message


def test_a_roof_over_most_of_the_board_leaves_that_without_a_way_to_the_gutter():
    roof = [SlantWall(start=(-3.0, -5.0), end=(-2.0, 0.0)), SlantWall(start=(-2.0, 0.0), end=(-3.0, 5.0))]
    (message,) = problems_at(with_parts(slant_wall=roof), "board")
    assert "no way to the gutter" in message


def test_a_board_that_is_full_has_no_room():
    big = Cylinder(center=(0.0, 0.0), radius=6.9)
    table = Table(board=Board(length=10.0, gutter=-4.9), cylinder=[big])
    (message,) = problems_at(table, "board")
    assert "no free place for a ball" in message


@pytest.mark.parametrize("slope", [0.0, 1.5, -1.5])
def test_a_level_face_is_a_trap_on_walls_and_on_prisms(slope):
    rise = 2.0 * math.tan(math.radians(slope))
    wall = SlantWall(start=(1.0, -1.0), end=(1.0 + rise, 1.0))
    prism = TriangularPrism(vertices=((3.0, -1.0), (3.0 + rise, 1.0), (2.0, 0.2)))
    messages = problems_at(with_parts(slant_wall=[wall], triangular_prism=[prism]), "")
    assert len(messages) == 2
    assert all("level within" in message for message in messages)


def test_a_face_that_is_level_but_looks_down_or_slopes_enough_is_none():
    steep = SlantWall(start=(1.0, -1.0), end=(1.0 + 2.0 * math.tan(math.radians(2.5)), 1.0))
    hanging = TriangularPrism(vertices=((3.0, -1.0), (3.0, 1.0), (4.0, 0.2)))
    assert check_table(with_parts(slant_wall=[steep], triangular_prism=[hanging])) == []


def test_a_paddle_whose_upper_side_is_level_at_rest_is_a_trap():
    level = math.degrees(math.atan2(0.25, 2.1))
    paddles = tuple(paddle.model_copy(update={"rest_angle": level}) for paddle in EMPTY.paddle)
    messages = problems_at(EMPTY.model_copy(update={"paddle": paddles}), "paddle")
    assert sum("level within" in message for message in messages) == 2


def test_a_bowl_between_two_walls_is_a_pocket():
    bowl = [SlantWall(start=(2.0, -1.0), end=(1.0, 0.0)), SlantWall(start=(1.0, 0.0), end=(2.0, 1.0))]
    messages = problems_at(with_parts(slant_wall=bowl), "slant_wall[4]")
    # The ball's centre is √2·(ball radius + thickness) above the corner.
    (message,) = messages
    assert f"[{1.0 + math.sqrt(2.0) * 0.35:.2f}, 0.00]" in message.replace("-0.00", "0.00")


def test_a_corner_between_a_wall_and_a_border_is_a_pocket():
    shelf = SlantWall(start=(1.0, -5.0), end=(2.0, -3.5))
    (message,) = problems_at(with_parts(slant_wall=[shelf]), "slant_wall[4]")
    assert "the left border" in message


def test_two_cylinders_nearer_than_a_ball_hold_one_only_if_neither_lets_it_roll_off():
    def beside(rise):
        pair = [Cylinder(center=(2.0, -0.6), radius=0.5), Cylinder(center=(2.0 + rise, 0.6), radius=0.5)]
        return problems_at(with_parts(cylinder=pair), "cylinder[0]")

    # Side by side, one holds from the left and one from the right; at 45 degrees the ball rolls off.
    assert len(beside(0.0)) == 1
    assert len(beside(0.3)) == 1
    assert beside(1.0) == []


def test_a_dent_that_every_touch_hops_out_of_is_no_pocket():
    # The ball leans on the guide's end and on the paddle's upper corner, left of it by a hair.
    guide = SlantWall(start=(-4.5, -5.0), end=(-6.88, -2.76))
    corner = EMPTY.paddle[0].corners(-10.0)[2]
    apart = math.dist(guide.end, corner)
    share = (apart**2 + 0.35**2 - 0.25**2) / (2.0 * apart)  # from the guide's end along to the corner
    height = math.sqrt(0.35**2 - share**2)
    along = ((corner[0] - guide.end[0]) / apart, (corner[1] - guide.end[1]) / apart)
    ball = (
        guide.end[0] + share * along[0] + height * along[1],
        guide.end[1] + share * along[1] - height * along[0],
    )
    assert ball[1] < corner[1]
    assert 0.0 < corner[0] + 0.25 - ball[0] < 1e-4
    assert check_table(EMPTY.model_copy(update={"slant_wall": (guide, *EMPTY.slant_wall[1:])})) == []


def test_a_pocket_that_no_ball_can_reach_is_none():
    # The corner above the left top corner wall has room for a ball, but no way in.
    assert check_table(EMPTY) == []
    opened = EMPTY.model_copy(
        update={"slant_wall": (*EMPTY.slant_wall[:2], SlantWall(start=(7.0, -5.0), end=(9.1, -2.9)))}
    )
    assert any("pocket" in message for message in problems_at(opened, "slant_wall[2]"))


def naive_distance(point, part):
    """From a point to a part's surface, by brute force along its edges."""
    core, radius = part.outline()
    best = math.inf
    for a, b in zip(core, (*core[1:], core[0]), strict=True):
        share = np.linspace(0.0, 1.0, 2001)[:, None]
        along = np.array(a) + share * (np.array(b) - np.array(a))
        best = min(best, float(np.hypot(*(along - point).T).min()))
    return best - radius


def random_clutter(seed):
    """A board with obstacles wherever they fall, so that some make pockets."""
    numbers = np.random.default_rng(seed)
    parts = [
        Cylinder(center=tuple(numbers.uniform((-3, -4), (8, 4))), radius=numbers.uniform(0.2, 0.8))
        for _ in range(7)
    ]
    prisms = [
        TriangularPrism(
            center=tuple(numbers.uniform((-3, -4), (8, 4))),
            size=numbers.uniform(0.4, 1.0),
            rotation=numbers.uniform(0, 360),
        )
        for _ in range(7)
    ]
    return with_parts(cylinder=parts, triangular_prism=prisms)


def exact_pockets(table):
    layout = Layout.of(table)
    where = space(layout)
    pieces = layout.solids().joined(resting_pieces(layout))
    return where, pockets(Terrain(pieces, [], table.board, where))


@pytest.mark.parametrize("seed", range(12))
def test_pockets_are_those_that_a_ball_going_only_down_and_sideways_cannot_leave(seed):
    """Against a flood of the samples that climbs from the gutter: what it misses, no ball leaves."""
    table = random_clutter(seed)
    where, found = exact_pockets(table)
    reached = where.reached[0]
    drains = np.zeros_like(reached)
    row = reached[0].copy()
    for index, free in enumerate(reached):
        row = free & (row if index == 0 else row | np.roll(row, 1) | np.roll(row, -1))
        for _ in range(len(row)):  # along the row, both ways
            wider = free & (row | np.roll(row, 1) | np.roll(row, -1))
            if (wider == row).all():
                break
            row = wider
        drains[index] = row
    step = where.grid.step
    trapped = np.argwhere(reached & ~drains)
    centers = np.stack([where.grid.x[trapped[:, 0]], where.grid.z[trapped[:, 1]]], axis=1)
    deep = [center for center in centers if _is_lowest(center, centers, step)]
    for center in deep:  # the lowest sample of each trapped region lies just above an exact pocket
        if _beside_a_slit(table, center):
            continue  # a ball gets through between two samples; such a gap is a problem of its own
        assert any(math.dist(center, pocket.ball) < 4 * step for pocket in found), center
    for pocket in found:
        if len(centers) == 0 or np.hypot(*(centers - pocket.ball).T).min() > 4 * step:
            # Too small for the samples: by any sideways step of a tenth of one it does not go down.
            assert _cannot_sink(table, pocket.ball)


def _is_lowest(center, centers, step):
    near = centers[np.hypot(*(centers - center).T) < 6 * step]
    return center[0] <= near[:, 0].min() and len(near) > 12


def _beside_a_slit(table, center):
    parts = [*table.slant_wall, *table.triangular_prism, *table.cylinder]
    near = [part.outline() for part in parts if naive_distance(center, part) < 0.5]
    gaps = [
        float(core_distances(np.array(a), np.array(b))) - r - s
        for index, (a, r) in enumerate(near)
        for b, s in near[:index]
    ]
    return any(0.5 <= gap < 0.62 for gap in gaps)


def _cannot_sink(table, ball):
    parts = [*table.slant_wall, *table.triangular_prism, *table.cylinder]
    resting = [TriangularPrism(vertices=paddle.corners(paddle.rest_angle)) for paddle in table.paddle]
    margin = table.board.ball_radius
    for turn in np.linspace(-89.0, 89.0, 9):
        direction = np.array([-math.cos(math.radians(turn)), math.sin(math.radians(turn))])
        moved = np.array(ball) + 1e-2 * direction
        gaps = [naive_distance(moved, part) - margin for part in (*parts, *resting)]
        side = table.board.width / 2 - table.board.wall_thickness - margin - abs(moved[1])
        if min(*gaps, side) > 1e-6 and abs(turn) < 60:
            return False
    return True


# Measures, against slower ones


numbers = st.floats(-3.0, 3.0)
corners = st.tuples(*[st.tuples(numbers, numbers)] * 3)


@settings(max_examples=100, deadline=None)
@given(corners, st.tuples(numbers, numbers))
def test_the_distance_to_a_triangle_is_that_of_its_nearest_sample(vertices, point):
    prism = TriangularPrism(vertices=vertices)
    (a, b, c), p = prism.corners(), np.array(point)
    measured = float(distances(p, np.array(prism.corners())))
    sides = [
        (s[1] - r[1]) * (p[0] - r[0]) - (s[0] - r[0]) * (p[1] - r[1]) for r, s in ((a, b), (b, c), (c, a))
    ]
    if min(sides) > 1e-9:
        assert measured == 0.0
    elif min(sides) < -1e-9:
        assert measured == pytest.approx(naive_distance(p, prism), abs=5e-3)  # samples 4e-3 u apart


@settings(max_examples=100, deadline=None)
@given(corners, corners)
def test_the_distance_of_two_triangles_is_symmetric_and_no_more_than_that_of_their_corners(first, second):
    one, other = (np.array(TriangularPrism(vertices=part).corners()) for part in (first, second))
    forth, back = float(core_distances(one, other)), float(core_distances(other, one))
    assert forth == back
    corner_distances = np.hypot(*(one[:, None] - other[None]).reshape(-1, 2).T)
    assert forth <= corner_distances.min() + 1e-12


def test_the_vectorised_paddle_is_the_paddle():
    for side in ("left", "right"):
        paddle = Paddle(side=side, pivot=(-7.2, -2.5), base=0.7)
        angles = np.linspace(-80.0, 80.0, 33)
        cores, _ = moving_pieces(paddle.primitives(Board())[0], np.radians(angles))
        for angle, core in zip(angles, cores[:, 0], strict=True):
            assert core == pytest.approx(np.array(paddle.corners(angle)), abs=1e-14)


# Recipes


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"gap": 0.3}, "random.gap"),
        ({"wall_gap": 0.5}, "random.wall_gap"),
        ({"wall_gap": 5.0}, "random.wall_gap"),
        ({"rotation": (25.0, 35.0)}, "random.rotation"),
        ({"area": ((11.0, 0.0), (12.0, 1.0))}, "random.area"),
        ({"area": ((-8.0, -4.5), (-7.0, -4.0))}, "random.wall_gap"),
    ],
)
def test_a_recipe_that_cannot_work_names_the_rule(changes, path):
    recipe = RandomRecipe().model_copy(update=changes)
    table = RANDOM.model_copy(update={"random": recipe})
    assert [problem.path for problem in check_table(table)] == [path]
    with pytest.raises(TableError, match=path.replace(".", r"\.")):
        parse_table(dump_table(table))


@pytest.mark.parametrize("gravity", [1.0, 10.0, 100.0])
def test_a_hit_speed_that_a_ball_at_rest_would_reach_by_hopping_is_refused(gravity):
    hop = math.sqrt(2.0 * gravity * HOP)
    for hit_speed, is_refused in ((0.99 * hop, True), (1.2 * hop, False)):
        board = Board(gravity=gravity, hit_speed=hit_speed)
        assert bool(problems_at(Table(board=board), "board.hit_speed")) == is_refused


def fan(i):
    return SlantWall(start=(0, 0), end=(4.9 * math.cos(i), 4.9 * math.sin(i)))


def arc(i):
    places = [(4.0 * math.cos(turn / 60), 4.0 * math.sin(turn / 60)) for turn in (i, i + 1)]
    return SlantWall(start=places[0], end=places[1])


MANY = {
    "one wall again and again": lambda i: SlantWall(start=(-4.5, -5), end=(-6.87, -2.74)),
    "a fan of walls": fan,
    "an arc of walls": arc,
    "level walls": lambda i: SlantWall(start=(i / 13 - 9, -5), end=(i / 13 - 9, 5), thickness=0),
    "upright walls": lambda i: SlantWall(start=(-9, i / 26 - 5), end=(9, i / 26 - 5), thickness=0),
    "paddles in one place": lambda i: Paddle(side="left", pivot=(-7.2, -2.5)),
    "cylinders in a heap": lambda i: Cylinder(center=(0, 0), radius=0.5),
    "cylinders in rows": lambda i: Cylinder(center=(i // 16 - 6, i % 16 * 0.6 - 4.5), radius=0.06),
}


@pytest.mark.parametrize("recipe", [None, RandomRecipe(triangular_prisms=32, cylinders=32)], ids=["", "more"])
@pytest.mark.parametrize("what", MANY)
def test_many_parts_are_checked_in_seconds_and_in_little_memory(what, recipe):
    parts = tuple(MANY[what](i) for i in range(256))
    key = {SlantWall: "slant_wall", Paddle: "paddle", Cylinder: "cylinder"}[type(parts[0])]
    table = Table(random=recipe, **{key: parts})
    start = time.process_time()
    check_table(table)
    assert time.process_time() - start < 60.0, "it takes two, but for machines that are very busy"
    tracemalloc.start()
    try:
        check_table(table)
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()


def test_parts_by_the_thousand_pairs_without_room_for_a_ball_between_them_are_a_warning():
    walls = tuple(fan(i) for i in range(250))
    assert any(
        (problem.path, problem.severity) == ("board", "warning") and "pairs of edges" in problem.message
        for problem in check_table(Table(slant_wall=walls))
    )
    few = Table(slant_wall=tuple(arc(i) for i in range(250)))
    assert not any("pairs of edges" in problem.message for problem in check_table(few))
