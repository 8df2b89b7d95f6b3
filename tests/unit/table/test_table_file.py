"""Tables are equal after saving and loading, and bad files are refused in one clear sentence."""

import math
import os
import subprocess
import sys

import pytest
from hypothesis import given, settings, strategies as st

from boards import RANDOM
from silverball.errors import OutputError, TableError, UnknownTable
from silverball.table import (
    Cylinder,
    TriangularPrism,
    check_table,
    dump_table,
    generate_table,
    load_table,
    parse_table,
    save_table,
    table_digest,
    table_names,
)

EIGHT_MISTAKES = """
format = 1
name = "Eight mistakes"
bumper = 3                                     # 1: the trade's word

[board]
gravty = 9.0                                   # 2: misspelled
ball_restitution = "high"                      # 3: no number

[[paddle]]
side = "left"
pivot = [-7.2, -2.5]
stroke = 0.05                                  # 4: as fast as the cap

[[triangular_prism]]
vertices = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]] # 5: flat

[[triangular_prism]]
vertices = [[0.0, 0.0], [1.0, 1.0]]            # 6: two corners

[[cylinder]]
center = [4.0, 0.0]
radius = 600                                   # 7: out of range

[[cylinder]]
center = [5.0, 0.0]
radius = 0.6

[[cylinder]]
center = [20.0, 0.2]                           # 8: beyond the board
radius = 0.6
"""


@pytest.mark.parametrize("name", table_names())
def test_the_built_in_tables_load_without_a_problem(name):
    table = load_table(name)
    assert check_table(table) == []
    assert parse_table(dump_table(table)) == table


def test_the_built_in_tables_are_these():
    assert table_names() == ("classic", "original", "parts", "random", "rolling", "silver_comet")


def test_the_rolling_table_has_the_parts_of_the_classic_one_where_they_are():
    def drawn(table):
        parts = [*table.slant_wall, *table.paddle, *table.triangular_prism, *table.cylinder]
        shape = {"name", "side", "start", "end", "thickness", "pivot", "length", "base", "rest_angle"}
        return [part.model_dump(include=shape | {"vertices", "center", "radius"}) for part in parts]

    rolling, classic = load_table("rolling"), load_table("classic")
    assert rolling.board.rolling
    assert drawn(rolling) == drawn(classic)


def test_the_classic_table_has_what_the_original_has_and_is_its_own_mirror_image():
    table = load_table("classic")
    assert len(table.triangular_prism) >= 4
    assert len(table.cylinder) >= 3
    assert len(table.paddle) == 2
    assert table.random is None

    def mirrored(places):
        return sorted(tuple(sorted((x, -z + 0.0) for x, z in place)) for place in places)

    walls = [(wall.start, wall.end) for wall in table.slant_wall]
    prisms = [prism.vertices for prism in table.triangular_prism]
    centers = [(cylinder.center,) for cylinder in table.cylinder]
    for places in (walls, prisms, centers):
        assert mirrored(places) == sorted(tuple(sorted(place)) for place in places)


@pytest.mark.parametrize("name", ["classic", "rolling"])
def test_no_edge_of_a_drawn_prism_is_within_ten_degrees_of_an_axis(name):
    for prism in load_table(name).triangular_prism:
        corners = prism.corners()
        for (ax, az), (bx, bz) in zip(corners, (*corners[1:], corners[0]), strict=True):
            assert 10.0 <= math.degrees(math.atan2(abs(bx - ax), abs(bz - az))) <= 80.0


numbers = st.floats(-9.0, 9.0)


@settings(max_examples=50)
@given(
    st.lists(st.tuples(numbers, numbers, st.floats(0.05, 10.0)), max_size=4),
    st.text(max_size=80).filter(lambda text: text.isprintable() or "\n" in text),
    st.floats(0.0, 100.0),
)
def test_a_dumped_table_loads_as_an_equal_one_with_an_equal_digest(circles, name, gravity):
    import tomllib

    from silverball.table import Table

    table = Table(
        name=name,
        board={"gravity": gravity},
        cylinder=[Cylinder(center=(x, z), radius=r) for x, z, r in circles],
        triangular_prism=[TriangularPrism(center=(x, z), size=r, rotation=7.5) for x, z, r in circles],
    )
    again = Table.model_validate(tomllib.loads(dump_table(table)))
    assert again == table
    assert table_digest(again) == table_digest(table)


def test_a_saved_table_loads_as_an_equal_one_and_writes_only_what_is_special(tmp_path):
    table = generate_table(3, RANDOM)
    path = tmp_path / "mine.toml"
    save_table(table, path)
    assert load_table(path) == table
    text = path.read_text(encoding="utf-8")
    assert "restitution" not in text
    assert max(len(line) for line in text.splitlines()) < 80
    assert os.listdir(tmp_path) == ["mine.toml"]


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "mine.toml"
    save_table(load_table("classic"), path)
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match="No space left"):
        save_table(generate_table(1), path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["mine.toml"]


def test_saving_says_what_is_wrong_with_the_path(tmp_path):
    table = load_table("classic")
    with pytest.raises(OutputError, match=r"ends in \.toml"):
        save_table(table, tmp_path / "mine.txt")
    with pytest.raises(OutputError, match="does not exist; create it first"):
        save_table(table, tmp_path / "nowhere" / "mine.toml")


def test_eight_different_mistakes_are_all_reported_with_their_paths(tmp_path):
    path = tmp_path / "eight.toml"
    path.write_text(EIGHT_MISTAKES, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load_table(path)
    problems = {problem.path: problem.message for problem in caught.value.problems}
    assert problems.keys() == {
        "bumper",
        "board.gravty",
        "board.ball_restitution",
        "paddle[0].stroke",
        "triangular_prism[0].vertices",
        "triangular_prism[1].vertices",
        "cylinder[0].radius",
        "cylinder[2].center",
    }
    assert "cylinder" in problems["bumper"]
    assert "gravity" in problems["board.gravty"]
    assert "0.05 to 10 u, got 600" in problems["cylinder[0].radius"]
    assert "beyond the edge" in problems["cylinder[2].center"]
    assert "8 problems" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "path", "hint"),
    [
        ("[[flipper]]", "flipper", "`paddle`"),
        ("[[kicker]]", "kicker", "`hole`"),
        ("[[trigger]]", "trigger", "`rollover`"),
        ("[[ramp]]", "ramp", "`passage`"),
        ("[[bumpers]]", "bumpers", "`cylinder`"),
        ("[board]\ndrain = -9", "board.drain", "`gutter`"),
        ("[board]\nnudge = 1", "board.nudge", "new in format 2"),
        ("[board]\nBall-Radius = 1", "board.Ball-Radius", "`ball_radius`"),
        ("[board]\nflipper = 1", "board.flipper", "[[paddle]]"),
        ("gravity = 9", "gravity", "belongs in [board]"),
        ("stroke = 9", "stroke", "belongs in a part, for example [[paddle]]"),
        ("[[cylinder]]\ndiameter = 1\ncenter=[0,0]\nradius=1", "cylinder[0].diameter", "`radius`"),
        ("[random]\ncount = 4", "random.count", "known here are"),
        ("format = 3", "format", "must be 1 or 2, got 3"),
        ("board = 5", "board", "must be a section"),
        ("[slant_wall]\nthickness = 1", "slant_wall", "[[slant_wall]] with two brackets"),
        ("name = 5", "name", "must be text in quotes, got 5"),
        ("[board]\nrolling = 1", "board.rolling", "must be true or false, got 1"),
        ("[board]\nmax_balls = 3", "board.max_balls", "may be 3 in format 2 only"),
        ("[board]\nmax_balls = true", "board.max_balls", "got true"),
        ("[board]\ngravity = nan", "board.gravity", "must be 0 to 100 u/s²"),
        ("[[paddle]]\npivot = [-7, -2]", "paddle[0].side", "must be given"),
        ("[[paddle]]\nside = 'up'\npivot = [-7, 0]", "paddle[0].side", "'left' or 'right'"),
        ("[[cylinder]]\ncenter = [1, 2, 3]\nradius = 1", "cylinder[0].center", "[x, z]"),
        ("[random]\nprism_size = [2, 1]", "random.prism_size", "swap"),
        ("[random]\nprism = { restitution = 2 }", "random.prism.restitution", "0 to 1"),
        ('"a\\u0007b" = 1', '"a\\u0007b"', "unknown key"),
    ],
)
def test_a_mistake_comes_with_its_path_and_a_hint(text, path, hint):
    with pytest.raises(TableError) as caught:
        parse_table(text)
    problems = [problem for problem in caught.value.problems if problem.path == path]
    assert len(problems) == 1, caught.value
    assert hint in problems[0].message


def test_too_many_parts_are_refused():
    wall = "[[slant_wall]]\nstart = [0, 0]\nend = [1, 1]\n"
    with pytest.raises(TableError, match="at most 4096 parts, got 4097"):
        parse_table(wall * 4097)


def test_thousands_of_mistakes_do_not_make_thousands_of_lines():
    text = "\n".join(f"key{number} = 1" for number in range(5000))
    with pytest.raises(TableError, match="4,900 more problems") as caught:
        parse_table(text)
    assert len(caught.value.problems) <= 101


def test_a_file_of_100_mb_is_refused_unread(tmp_path):
    path = tmp_path / "huge.toml"
    with open(path, "wb") as file:
        file.truncate(100 * 10**6)
    with pytest.raises(TableError, match="100,000,000 bytes long"):
        load_table(path)


def test_unreadable_files_are_refused_in_one_sentence(tmp_path):
    (tmp_path / "empty.toml").write_text("  \n", encoding="utf-8")
    (tmp_path / "latin.toml").write_bytes(b'name = "caf\xe9"')
    (tmp_path / "broken.toml").write_text('format = 1\nname = "open\n', encoding="utf-8")
    (tmp_path / "deep.toml").write_text("x = " + "[" * 5000, encoding="utf-8")
    (tmp_path / "folder.toml").mkdir()
    os.mkfifo(tmp_path / "pipe.toml")
    for name, reason in {
        "empty": "is empty",
        "latin": "not UTF-8 text",
        "broken": "not valid TOML: .*line 2",
        "deep": "nested too deeply|not valid TOML",
        "folder": "is a folder",
        "pipe": "not a regular file",
        "missing": "no such file",
    }.items():
        with pytest.raises(TableError, match=reason) as caught:
            load_table(tmp_path / f"{name}.toml")
        assert len(caught.value.problems) == 1
        assert "\n" not in caught.value.problems[0].message


def test_a_path_with_a_zero_character_is_refused():
    with pytest.raises(TableError, match="cannot be read"):
        load_table("a\0b.toml")


def test_a_number_with_thousands_of_digits_is_refused():
    with pytest.raises(TableError):
        parse_table("format = " + "9" * 5000)


def test_an_unknown_name_is_answered_with_the_nearest_one_and_with_all_there_are():
    with pytest.raises(UnknownTable, match='did you mean "classic"') as caught:
        load_table("clasic")
    for name in table_names():
        assert name in str(caught.value)
    with pytest.raises(UnknownTable, match="Built in are"):
        load_table("quite another thing")


def test_the_digest_is_the_same_in_a_new_process_and_differs_for_another_table():
    code = "import silverball.table as t; print(t.table_digest(t.load_table('classic')))"
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    classic = load_table("classic")
    assert output.strip() == table_digest(classic)
    assert table_digest(generate_table(1)) != table_digest(generate_table(2))
    heavier = classic.model_copy(update={"board": classic.board.model_copy(update={"gravity": 11.0})})
    assert table_digest(heavier) != table_digest(classic)


def test_reading_tables_needs_neither_numba_nor_trimesh():
    code = (
        "import sys, silverball.table as t; t.load_table('classic'); t.generate_table(1);"
        "print([name for name in ('numba', 'trimesh', 'scipy', 'pygame') if name in sys.modules])"
    )
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert output.strip() == "[]"
