"""Format 2: asked for where it is needed, by its keys, its values and the second paddle of a side."""

from __future__ import annotations

import pytest

import silverball as sb
from silverball.errors import TableError
from silverball.table import Table, dump_table, parse_table, save_table
from silverball.table.file import SIZE_LIMIT

REMEDY = "write format = 2 at the top of the file"


def problems_of(text: str) -> dict[str, str]:
    with pytest.raises(TableError) as refused:
        parse_table(text)
    return {
        problem.path: problem.message for problem in reversed(refused.value.problems)
    }  # the first of each


@pytest.mark.parametrize("head", ["", "format = 1\n"])
def test_every_key_of_format_2_in_a_file_of_format_1_is_one_problem(head: str):
    text = f"""{head}
[board]
max_balls = 5

[[slant_wall]]
start = [0, 0]
end = [1, 1]
friction = 0.3
kick = 2

[[paddle]]
side = "left"
pivot = [-7.2, -2.5]
rest_angle = -90
stroke = 0.015

[[post]]
center = [3, 0]
[[post]]
center = [5, 0]
"""
    problems = problems_of(text)
    new = {"slant_wall[0].friction", "slant_wall[0].kick", "post"}
    before = {"board.max_balls", "paddle[0].rest_angle", "paddle[0].stroke"}
    assert {path for path, message in problems.items() if message.endswith(REMEDY)} == new | before
    assert all(problems[path] == f"is new in format 2: {REMEDY}" for path in new)
    assert problems["board.max_balls"] == f"may be 5 in format 2 only: {REMEDY}"


def test_what_no_format_allows_is_told_with_its_range():
    assert "1 to 8 balls, got 9" in problems_of("[board]\nmax_balls = 9\n")["board.max_balls"]


def test_a_second_paddle_of_a_side_needs_format_2():
    paddles = '[[paddle]]\nside = "left"\npivot = [-7.2, -2.5]\n[[paddle]]\nside = "left"\npivot = [2, -3]\n'
    assert problems_of(paddles)["paddle[1].side"].endswith(REMEDY)
    table = Table(paddle=[sb.parts.Paddle(side="left", pivot=(x, -2.5)) for x in (-7.2, 2.0)])
    assert table.format == 2
    assert [part.name for part in table.parts()] == ["paddle.left", "paddle[1]"]


def test_a_table_made_in_python_has_the_format_that_it_needs(tmp_path):
    classic = sb.load_table("classic")
    assert classic.format == 1
    changed = classic.replace(post=[sb.parts.Post(center=(-6.0, 0.0))])
    assert changed.format == 2
    assert dump_table(changed).startswith("format = 2\n")
    save_table(changed, tmp_path / "changed.toml")
    assert sb.load_table(tmp_path / "changed.toml") == changed


def test_a_file_may_say_format_2_without_need():
    table = parse_table('format = 2\nname = "Plain"\n')
    assert parse_table(dump_table(table)) == table


def test_names_are_unique_in_format_2_only():
    posts = '[[slant_wall]]\nname = "one"\nstart = [0, 0]\nend = [1, 1]\n'
    twin = '[[cylinder]]\nname = "one"\ncenter = [4, 0]\nradius = 0.5\n'
    parse_table(posts + twin)
    problems = problems_of("format = 2\n" + posts + twin)
    assert problems == {"cylinder[0].name": "must not be 'one' again: slant_wall[0] has this name already"}


def test_a_level_is_given_in_one_way():
    start = "format = 2\n[[level]]\nnumber = 1\n[[level]]\nnumber = 2\n[[post]]\ncenter = [0, 0]\n"
    assert "one of the two" in problems_of(start + "level = 1\nlevels = [1, 2]\n")["post[0].levels"]
    assert parse_table(start + "levels = [2, 0, 2]\n").post[0].all_levels == (0, 2)


@pytest.mark.parametrize(
    ("text", "path", "message"),
    [
        ("[[wall]]\npoints = [[0, 0]]", "wall[0].points", "must be written"),
        ("[[wall]]\npoints = [[0, 0], [1, 0, 9]]", "wall[0].points", "must be -5 to 5"),
        ("[[wall]]\npoints = [[0, 0, 1e-5], [1, 0]]", "wall[0].points", "leave it out"),
        ("[[wall]]\npoints = [[0, 0], [0, 0]]", "wall[0]", "must not repeat a point"),
        ("[[wall]]\npoints = [[0, 0], [1, 0, 1]]", "wall[0]", "no arc follows"),
        ("[[wall]]\npoints = [[0, 0], [1, 0]]\nclosed = true", "wall[0]", "three points or an arc"),
        ("[[wall]]\npoints = [[0, 0], [1, 0]]\nkick = 1\nedges = [1]", "wall[0]", "has edges 0 to 0"),
        ("[[wall]]\npoints = [[0, 0], [1, 0]]\nedges = [0]", "wall[0]", "must have a `kick`"),
        ("[[target]]\nstart = [0, 0]\nend = [0, 0]", "target[0].end", "away from start"),
        ("[[rollover]]\nstart = [0, 0]\nradius = 1", "rollover[0]", "needs `start` and `end`"),
        ("[[gate]]\nstart = [0, 0]\nend = [0, 1]", "gate[0]", "needs `passes`"),
        ("[[gate]]\nstart = [0, 0]\nend = [0, 1]\nheld = true", "gate[0]", "must have a `name`"),
        ('[[gate]]\nstart = [0, 0]\nend = [0, 1]\npasses = "left"', "gate[0]", "must not lie along"),
        ("[[hole]]\ncenter = [0, 0]", "hole[0]", "needs `exit_velocity`"),
        ("[[hole]]\ncenter = [0, 0]\ndrain = true\nexit = [0, 1]", "hole[0]", "it is a drain"),
        ("[[passage]]\nstart = [0, 0]\nend = [0, 1]\nfrom = 1\nto = 1", "passage[0]", "another level"),
        ("[[passage]]\nstart = [0, 0]\nend = [0, 1]\nto = 1", "passage[0].from", "must be given"),
        ("[[level]]\nnumber = 0", "level[0].number", "must be 1 to 7"),
        (
            '[[paddle]]\nside = "left"\npivot = [-7, -2]\nshape = "capsule"\nbase = 0.3',
            "paddle[0]",
            "must not have `base`",
        ),
        (
            '[[paddle]]\nside = "left"\npivot = [-7, -2]\nshape = "capsule"\ntip_radius = 0.3',
            "paddle[0]",
            "at most base_radius",
        ),
        ("[[bumper]]\ncenter = [0, 0]", "bumper", "`cylinder`"),
        ("[[saucer]]\ncenter = [0, 0]", "saucer", "`hole`"),
        ("[[sensor]]\ncenter = [0, 0]", "sensor", "`rollover`"),
    ],
)
def test_what_a_part_cannot_be_is_said_in_a_sentence(text: str, path: str, message: str):
    assert message in problems_of("format = 2\n" + text + "\n")[path]


def test_a_file_has_at_most_256_kb(tmp_path):
    path = tmp_path / "long.toml"
    path.write_text("# " + "x" * SIZE_LIMIT)
    with pytest.raises(TableError, match="262,144"):
        sb.load_table(path)
