"""A table that was saved and loaded is the same: equal parts, the same digest, the same arrays."""

from __future__ import annotations

import tomllib
from typing import Any, Literal, get_args, get_origin

import numpy as np
from hypothesis import assume, given, settings, strategies as st
from pydantic import ValidationError

from silverball.errors import TableError
from silverball.table import (
    Board,
    Cylinder,
    Paddle,
    SlantWall,
    Table,
    TriangularPrism,
    dump_table,
    expand,
    generate_table,
    table_digest,
)
from silverball.table.kinds.wall import ChainPointRule
from silverball.table.parts import RandomRecipe
from silverball.table.quantity import Count, FixedList, Interval, ItemList, Quantity
from silverball.table.table import PART_KINDS
from silverball.world.compile import compile_tables
from test_kinds import EXAMPLES

places = st.tuples(st.floats(-9, 9), st.floats(-4.5, 4.5))
surfaces = st.fixed_dictionaries(
    {},
    optional={
        "restitution": st.floats(0, 1),
        "restitution_falloff": st.floats(0, 10),
        "points": st.integers(0, 10**6),
        "name": st.text("abc äß–\"'\\\t\n#[]=", max_size=20),
    },
)
factors = st.fixed_dictionaries({}, optional={"speed_factor": st.floats(0.1, 3)})
boards = st.fixed_dictionaries(
    {},
    optional={
        "length": st.floats(20, 50),
        "width": st.floats(10, 50),
        "height": st.floats(0, 10),
        "gravity": st.floats(0, 100),
        "slope": st.floats(1, 60),
        "friction": st.floats(1e-3, 2),
        "ball_radius": st.floats(0.1, 2),
        "ball_restitution": st.floats(0, 1),
        "max_balls": st.integers(1, 8),
        "speed_cap": st.floats(1, 200),
        "hit_speed": st.floats(0.01, 10),
        "jitter": st.floats(0, 20),
        "gutter": st.floats(-9.5, -8),
        "wall_thickness": st.floats(0, 1),
        "wall_restitution": st.floats(0, 1),
    },
).flatmap(lambda board: st.booleans().map(lambda rolls: board | {"rolling": rolls and "friction" in board}))
walls = st.builds(
    lambda start, end, thickness, surface: SlantWall(start=start, end=end, thickness=thickness, **surface),
    places, places, st.floats(0, 1), surfaces,
)  # fmt: skip
prisms = st.builds(
    lambda center, size, rotation, surface, factor: TriangularPrism(
        center=center, size=size, rotation=rotation, **surface, **factor
    ),
    places, st.floats(0.05, 3), st.floats(-360, 360), surfaces, factors,
) | st.builds(
    lambda corners, surface: TriangularPrism(vertices=corners, **surface),
    st.tuples(places, places, places), surfaces,
)  # fmt: skip
cylinders = st.builds(
    lambda center, radius, surface, factor: Cylinder(center=center, radius=radius, **surface, **factor),
    places, st.floats(0.05, 3), surfaces, factors,
)  # fmt: skip
paddles = st.builds(
    lambda pivot, length, angles, strokes, surface: {
        "pivot": pivot, "length": length, "rest_angle": angles[0], "up_angle": angles[1],
        "stroke": strokes[0], "return_stroke": strokes[1],
    } | surface,
    places, st.floats(0.3, 10), st.tuples(st.floats(-85, 0), st.floats(1, 85)),
    st.tuples(st.floats(0.02, 1), st.floats(0.02, 1)), surfaces,
)  # fmt: skip


def check(table: Table) -> None:
    """A table is the same after a file."""
    again = Table.model_validate(tomllib.loads(dump_table(table)))
    assert again == table
    assert dump_table(again) == dump_table(table)
    assert table_digest(again) == table_digest(table)
    assert expand(again).rows == expand(table).rows
    if table.random is not None:
        return
    try:
        compiled = compile_tables([table])
    except TableError:  # parts without an outline: refused before and after
        assume(False)
    for one, other in zip(compiled, compile_tables([again]), strict=True):
        assert one.tobytes() == other.tobytes() if isinstance(one, np.ndarray) else one == other


@settings(max_examples=60)
@given(
    st.text(max_size=80).filter(lambda text: text.isprintable() or "\n" in text),
    boards,
    st.lists(walls, max_size=3),
    st.lists(prisms, max_size=3),
    st.lists(cylinders, max_size=3),
    st.sampled_from([(), ("left",), ("left", "right")]),
    paddles,
)
def test_any_table_is_the_same_after_a_file(name, board, slant_wall, prism, cylinder, sides, paddle) -> None:
    check(
        Table(
            name=name,
            board=Board(**board),
            slant_wall=tuple(slant_wall),
            triangular_prism=tuple(prism),
            cylinder=tuple(cylinder),
            paddle=tuple(Paddle(side=side, **paddle) for side in sides),
        )
    )


@settings(max_examples=20)
@given(st.integers(0, 2**63 - 1))
def test_any_generated_board_is_the_same_after_a_file(seed) -> None:
    check(generate_table(seed))


@settings(max_examples=30)
@given(boards, st.integers(0, 32), st.integers(0, 32), st.floats(0.2, 1), st.floats(1, 5))
def test_any_recipe_is_the_same_after_a_file(board, prism_count, cylinder_count, least, most) -> None:
    recipe = RandomRecipe(
        triangular_prisms=prism_count,
        cylinders=cylinder_count,
        prism_size=(least, most),
        cylinder_radius=(least, most),
    )
    check(Table(board=Board(**board), random=recipe))


def of_rule(rule: Any) -> st.SearchStrategy[Any]:
    """Values that a rule allows."""
    match rule:
        case Quantity():
            return st.floats(rule.low, rule.high)
        case Count():
            return st.integers(rule.low, rule.high)
        case FixedList():
            return st.tuples(*[of_rule(rule.item)] * rule.count)
        case ItemList():
            return st.lists(of_rule(rule.item), min_size=rule.least, max_size=min(rule.most, 6)).map(tuple)
        case Interval():
            return st.tuples(of_rule(rule.item), of_rule(rule.item)).map(lambda pair: tuple(sorted(pair)))
        case ChainPointRule():
            return places | st.tuples(st.floats(-9, 9), st.floats(-4.5, 4.5), st.floats(0.001, 5))
    raise AssertionError(f"no values for {rule}")


def of_type(annotation: Any, metadata: tuple[Any, ...] = ()) -> st.SearchStrategy[Any]:
    """Values of a field's type."""
    rules = [item for item in metadata if type(item).__module__.startswith("silverball.")]
    if rules:
        return of_rule(rules[0])
    if annotation is bool:
        return st.booleans()
    if annotation is str:
        return st.text("abc äß–\"'\\\t\n#[]=", max_size=20)
    if annotation is type(None):
        return st.none()
    if get_origin(annotation) is Literal:
        return st.sampled_from(get_args(annotation))
    if hasattr(annotation, "__metadata__"):
        return of_type(get_args(annotation)[0], annotation.__metadata__)
    return st.one_of(*map(of_type, get_args(annotation)))


@settings(max_examples=150)
@given(st.data(), st.sampled_from(sorted(PART_KINDS)))
def test_any_part_of_any_kind_is_the_same_after_a_file(data, kind) -> None:
    model = PART_KINDS[kind]
    part = dict(data.draw(st.sampled_from(EXAMPLES[kind])))
    fields = {name: field for name, field in model.model_fields.items() if name != "mesh"}
    for name in data.draw(st.lists(st.sampled_from(sorted(fields)), max_size=3, unique=True)):
        field = fields[name]
        part[field.alias or name] = data.draw(of_type(field.annotation, tuple(field.metadata)))
    try:
        table = Table.model_validate({kind: [part]})
    except ValidationError:  # values that do not go together
        assume(False)
    check(table)
