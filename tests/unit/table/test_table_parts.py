"""Parts return their outlines, however they were specified."""

import math

import pytest
from hypothesis import given, strategies as st
from pydantic import ValidationError

from silverball.table import Board, Cylinder, Paddle, SlantWall, Table, TriangularPrism

coordinates = st.floats(-9.0, 9.0)
points = st.tuples(coordinates, coordinates)
angles = st.floats(-85.0, 85.0)


def turn(corners):
    """The sum of the specification: positive for counter-clockwise."""
    following = (*corners[1:], corners[0])
    return sum(zi * xj - xi * zj for (xi, zi), (xj, zj) in zip(corners, following, strict=True))


@given(st.tuples(points, points, points))
def test_corners_run_counter_clockwise_in_whatever_order_the_vertices_are_given(vertices):
    corners = TriangularPrism(vertices=vertices).corners()
    assert sorted(corners) == sorted((x + 0.0, z + 0.0) for x, z in vertices)
    assert turn(corners) >= -1e-12  # the sum itself rounds at 81·2⁻⁵³ and more


@given(points, st.floats(0.05, 10.0), st.floats(-360.0, 360.0))
def test_an_equilateral_prism_is_equilateral_and_counter_clockwise(center, size, rotation):
    corners = TriangularPrism(center=center, size=size, rotation=rotation).corners()
    assert turn(corners) > 0.0
    for one, other in zip(corners, (*corners[1:], corners[0]), strict=True):
        assert math.dist(one, other) == pytest.approx(math.sqrt(3.0) * size, rel=1e-9)
        assert math.dist(one, center) == pytest.approx(size, rel=1e-9)


def test_rotation_is_the_direction_of_the_first_corner_from_right_towards_up():
    to_the_right = TriangularPrism(center=(1.0, 2.0), size=1.0, rotation=0.0).corners()[0]
    up = TriangularPrism(center=(1.0, 2.0), size=1.0, rotation=90.0).corners()[0]
    assert to_the_right == pytest.approx((1.0, 3.0))
    assert up == pytest.approx((2.0, 2.0))


@given(angles, st.floats(-8.0, 8.0), st.floats(-4.0, 4.0))
def test_the_right_paddle_is_the_exact_mirror_image_of_the_left(angle, x, z):
    left = Paddle(side="left", pivot=(x, z)).corners(angle)
    right = Paddle(side="right", pivot=(x, -z)).corners(angle)
    assert sorted(right) == sorted((a, -b + 0.0) for a, b in left)
    assert turn(left) > 0.0
    assert turn(right) > 0.0


@given(angles, st.floats(0.3, 5.0), st.floats(0.05, 5.0))
def test_a_paddle_is_isosceles_about_its_pivot_and_its_tip_points_where_the_angle_says(angle, length, base):
    paddle = Paddle(side="left", pivot=(0.0, 0.0), length=length, base=base)
    lower, tip, upper = paddle.corners(angle)
    assert tip == pytest.approx(
        (length * math.sin(math.radians(angle)), length * math.cos(math.radians(angle)))
    )
    assert math.dist(lower, tip) == pytest.approx(math.dist(upper, tip))
    assert math.dist(lower, upper) == pytest.approx(base)
    assert (lower[0] + upper[0], lower[1] + upper[1]) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert paddle.reach == pytest.approx(max(math.hypot(*corner) for corner in (lower, tip, upper)))


@given(points, points)
def test_the_inward_normal_points_to_the_centre_for_either_order_of_the_ends(start, end):
    if math.dist(start, end) < 1e-3:
        return
    board = Board()
    normal = SlantWall(start=start, end=end).inward_normal(board)
    assert normal == SlantWall(start=end, end=start).inward_normal(board)
    assert math.hypot(*normal) == pytest.approx(1.0)
    along = (end[0] - start[0]) * normal[0] + (end[1] - start[1]) * normal[1]
    assert along == pytest.approx(0.0, abs=1e-9)
    assert -start[0] * normal[0] - start[1] * normal[1] > -1e-9


def test_a_wall_through_the_centre_has_one_normal_all_the_same():
    ends = (-1.0, -2.0), (1.0, 2.0)
    normals = {SlantWall(start=a, end=b).inward_normal(Board()) for a, b in (ends, ends[::-1])}
    assert len(normals) == 1
    assert normals.pop()[0] > 0.0  # up, by convention


@pytest.mark.parametrize("value", [True, "1.0", None, [1.0], math.nan, math.inf, -math.inf, 10**400])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(ValidationError, match="must be"):
        Board(gravity=value)


def test_whole_numbers_are_numbers_and_become_floats():
    board = Board(gravity=9)
    assert isinstance(board.gravity, float)
    assert board == Board(gravity=9.0)


def test_every_number_says_its_unit_its_range_and_what_it_is():
    schema = Table.model_json_schema()
    numbers = [
        field
        for model in schema["$defs"].values()
        for field in model["properties"].values()
        if field.get("type") in {"number", "integer"}
    ]
    assert len(numbers) > 40
    for field in numbers:
        assert {"minimum", "maximum", "description"} <= field.keys()
        if field.get("unit"):
            assert f"[{field['unit']}]" in field["description"]


def test_defaults_lie_in_their_own_ranges():
    Board.model_validate(Board().model_dump())
    table = Table.model_validate({"random": {}})
    assert Table.model_validate(table.model_dump()) == table


def test_a_part_is_given_in_exactly_one_way():
    vertices = [[0, 0], [1, 0], [0, 1]]
    for mistaken in (
        {},
        {"vertices": vertices, "mesh": "wedge.stl"},
        {"vertices": vertices, "rotation": 10},
        {"center": [0, 0]},
        {"size": 1},
    ):
        with pytest.raises(ValidationError, match="needs"):
            TriangularPrism(**mistaken)
    for mistaken in ({}, {"center": [0, 0]}, {"radius": 1}, {"mesh": "post.stl", "radius": 1}):
        with pytest.raises(ValidationError, match="needs"):
            Cylinder(**mistaken)


def test_a_paddle_lifts():
    with pytest.raises(ValidationError, match="above rest_angle"):
        Paddle(side="left", pivot=(0, 0), rest_angle=20, up_angle=20)


def test_tables_never_change_and_can_be_keys():
    table = Table(name="Still")
    with pytest.raises(ValidationError, match="frozen"):
        table.name = "Moved"
    assert {table: 1}[Table(name="Still")] == 1
