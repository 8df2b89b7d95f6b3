"""A table with any bad value is refused in sentences, whatever its other values are.

The valid parts are checked too; a rule between two keys must not fail because one of them is missing.
"""

from __future__ import annotations

import copy
import datetime
import itertools
import math

import pytest
import tomli_w

from silverball.errors import TableError
from silverball.table import Table, parse_table
from silverball.table.kinds.part import Part
from silverball.table.parts import Arcade, Board, RandomRecipe
from silverball.table.table import PART_KINDS
from test_kinds import EXAMPLES

GOOD = {
    "name": "Everything",
    "board": {"friction": 0.2, "rolling": True, "wall_restitution": 0.9},
    "slant_wall": [{"start": [-4.5, -5.0], "end": [-6.87, -2.74], "points": 3}],
    "paddle": [
        {"side": "left", "pivot": [-7.2, -2.5], "rest_angle": -10.0, "up_angle": 45.0},
        {"side": "right", "pivot": [-7.2, 2.5], "rest_angle": -10.0, "up_angle": 45.0},
    ],
    "triangular_prism": [
        {"vertices": [[2.0, -1.0], [3.2, -1.4], [2.4, 0.2]]},
        {"center": [4.0, 3.0], "size": 0.8, "rotation": 15.0},
    ],
    "cylinder": [{"center": [6.0, -2.0], "radius": 0.6}],
    "random": {"triangular_prisms": 1, "cylinders": 1, "prism": {"points": 5}, "cylinder": {"points": 5}},
    "arcade": {"balls": 5, "tilt_limit": 2.0},
}
NASTY = [
    math.nan,
    math.inf,
    -1e308,
    5,
    10**30,
    0,
    -0.0,
    "text",
    "",
    True,
    [],
    [[]],
    {},
    {"a": 1},
    [1.0, 2.0, 3.0, 4.0],
    datetime.date(1979, 5, 27),
]
SECTIONS = [
    (("board",), Board),
    (("random",), RandomRecipe),
    (("arcade",), Arcade),
    *(((kind, 0), model) for kind, model in PART_KINDS.items() if kind in GOOD),
    (("triangular_prism", 1), PART_KINDS["triangular_prism"]),
    (("random", "prism"), RandomRecipe.model_fields["prism"].annotation),
    ((), Table),
]
KEYS = [(place, key) for place, model in SECTIONS for key in [*model.model_fields, "flipper"]]
NEW_KINDS = [kind for kind in PART_KINDS if kind not in GOOD]
NEW_KEYS = [
    (kind, number, field.alias or name)
    for kind in NEW_KINDS
    for number in range(len(EXAMPLES[kind]))
    for name, field in PART_KINDS[kind].model_fields.items()
    if name not in Part.model_fields or kind == "post"
]


def with_values(*changes):
    """The text of the good table with some values in other ones' places; None takes a key away."""
    data = copy.deepcopy(GOOD)
    for place, key, value in changes:
        section = data
        for step in place:
            section = section[step]
        if value is None:
            section.pop(key, None)
        else:
            section[key] = value
    return tomli_w.dumps(data)


def outcome(text):
    """A table, or its problems, each one sentence; anything else is raised, and fails the test."""
    try:
        return parse_table(text)
    except TableError as error:
        problems = error.problems
    assert problems
    assert all(problem.message and "\n" not in problem.message for problem in problems)
    return problems


def test_the_table_without_a_bad_value_is_good():
    assert isinstance(outcome(with_values()), Table)


@pytest.mark.parametrize(("place", "key"), KEYS, ids=lambda value: str(value))
def test_any_bad_value_of_any_key_is_refused_in_a_sentence(place, key):
    for value in [*NASTY, None]:
        outcome(with_values((place, key, value)))


@pytest.mark.parametrize(("kind", "number", "key"), NEW_KEYS)
def test_any_bad_value_of_a_part_of_format_2_is_refused_in_a_sentence(kind, number, key):
    for value in [*NASTY, None]:
        part = {**EXAMPLES[kind][number], key: value}
        if value is None:
            del part[key]
        outcome(tomli_w.dumps({"format": 2, kind: [part]}))


@pytest.mark.parametrize("kind", NEW_KINDS)
def test_an_unknown_key_of_a_part_of_format_2_is_answered(kind):
    (problem,) = outcome(tomli_w.dumps({"format": 2, kind: [{**EXAMPLES[kind][0], "flipper": 1}]}))
    assert problem.path == f"{kind}[0].flipper"
    assert "unknown key" in problem.message


@pytest.mark.parametrize("place", [place for place, _ in SECTIONS[:-1]], ids=str)
def test_any_two_bad_values_of_a_section_are_refused_in_sentences(place):
    keys = [key for where, key in KEYS if where == place]
    for number, pair in enumerate(itertools.combinations(keys, 2)):
        outcome(with_values(*((place, key, NASTY[(number + i) % len(NASTY)]) for i, key in enumerate(pair))))


@pytest.mark.parametrize("friction", [5, math.nan, -1.0, "high", [0.2], True])
def test_a_bad_friction_is_the_only_problem_of_a_ball_that_should_roll(friction):
    problems = outcome(with_values((("board",), "friction", friction)))
    assert [problem.path for problem in problems] == ["board.friction"]


def test_parts_beside_a_bad_board_key_are_checked_all_the_same():
    far = [50.0, 0.0]
    problems = outcome(with_values((("board",), "friction", 5), (("cylinder", 0), "center", far)))
    assert [problem.path for problem in problems] == ["board.friction", "cylinder[0].center"]


@pytest.mark.parametrize("kind", list(PART_KINDS))
def test_too_many_parts_beside_a_bad_key_are_refused_in_sentences(kind):
    part = GOOD[kind][0] if kind in GOOD else EXAMPLES[kind][0]
    text = tomli_w.dumps({"board": {"friction": 5}, kind: [part] * 4097})
    problems = {problem.path: problem.message for problem in outcome(text)}
    assert "board.friction" in problems
    assert problems[kind].startswith(("must have at most 4096 parts", "is new in format 2"))


def test_too_many_edges_of_walls_are_refused():
    points = [[0.001 * number, 0.0] for number in range(1000)]
    text = tomli_w.dumps({"format": 2, "wall": [{"points": points}] * 5})
    (problem,) = outcome(text)
    assert "4,995 shapes" in problem.message
    assert "at most 4,096" in problem.message
