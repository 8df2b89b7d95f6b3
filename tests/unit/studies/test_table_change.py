"""Changes of one number of a table, and sweeps."""

from __future__ import annotations

import pytest

from silverball.errors import SilverballError
from silverball.studies.study_plan import arms_of
from silverball.studies.sweep_arms import swept
from silverball.studies.table_change import changed, parse_sweep
from silverball.table import Table, load_table

CLASSIC = load_table("classic")


def heart_radius(table: Table) -> float:
    return next(one for one in table.cylinder if one.name == "heart").radius


@pytest.mark.parametrize(
    ("path", "value", "read"),
    [
        ("board.gravity", 12.0, lambda table: table.board.gravity),
        ("paddle.length", 2.0, lambda table: table.paddle[1].length),
        ("paddle.right.length", 2.0, lambda table: table.paddle[1].length),
        ("paddle[1].length", 2.0, lambda table: table.paddle[1].length),
        ("cylinder.heart.radius", 0.4, heart_radius),
        ("cylinder[0].center[0]", 2.5, lambda table: table.cylinder[0].center[0]),
    ],
)  # fmt: skip
def test_a_number_is_changed_where_the_path_says(path, value, read):
    assert read(changed(CLASSIC, path, value)) == value
    assert read(CLASSIC) != value


def test_only_the_named_part_is_changed():
    assert changed(CLASSIC, "paddle.right.length", 2.0).paddle[0] == CLASSIC.paddle[0]


def test_a_recipe_has_numbers_too():
    recipe = changed(load_table("random"), "random.area[0][0]", -1.0).random
    assert recipe is not None
    assert recipe.area[0][0] == -1.0


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("board.gravty", 12.0, "did you mean `gravity`"),
        ("paddel.length", 2.0, "this table has no 'paddel'; it has board"),
        ("paddle.lenght", 2.0, "did you mean `length`"),
        ("paddle.top.length", 2.0, "there is no part named 'top'; there are left, right"),
        ("cylinder[99].radius", 1.0, "there are 7 of these, numbered from 0"),
        ("paddle.length", 500.0, "must be 0.3 to 10 u, got 500"),
        ("board.gravity[0]", 1.0, "there is no such place"),
        ("gravity", 1.0, "expected the path of a number"),
        ("board..gravity", 1.0, "expected the path of a number"),
        ("", 1.0, "expected the path of a number"),
        ("board.[0]", 1.0, "expected the path of a number"),
        ("random.gap", 1.0, "this table has no 'random'"),
        ("board.accel\x1b[2J", 1.0, "expected the path of a number"),
    ],
)
def test_what_cannot_be_changed_is_told_in_one_sentence(path, value, words):
    with pytest.raises(SilverballError, match=words.replace("[", r"\[")) as caught:
        changed(CLASSIC, path, value)
    assert "\n" not in str(caught.value)
    assert "\x1b" not in str(caught.value)


def test_a_sweep_is_a_range_or_a_list():
    assert parse_sweep("paddle.length=1.8:2.4:7").values == (1.8, 1.9, 2, 2.1, 2.2, 2.3, 2.4)
    assert parse_sweep("board.gravity=8,12").values == (8, 12)


@pytest.mark.parametrize(
    "text", ["", "a", "a=", "a=1", "=1,2", "a=1:2", "a=1:2:1", "a=1:2:99", "a=1:1:3", "a=nan,1", "a=1:inf:3",
             "a=1:2:3:4", "a=x,y", "a=1:2:1000000000"]
)  # fmt: skip
def test_another_sweep_is_refused_with_an_example(text):
    with pytest.raises(SilverballError, match=r"for example paddle\.length=1\.8:2\.4:7"):
        parse_sweep(text)


def test_sweeps_combine_with_tables_and_players():
    arms = arms_of([("classic", CLASSIC)], ["idle", "reflex"])
    found = swept(arms, [parse_sweep("board.gravity=8,10"), parse_sweep("paddle.length=2,2.2")])
    assert len(found) == 8
    assert found[0].label == "idle, board.gravity=8, paddle.length=2"
    assert found[1].table.board.gravity == 8.0
    assert found[1].table.paddle[0].length == 2.2
