"""`Table.replace`: a changed table is checked like a file, and refused in the words of the file."""

from __future__ import annotations

import pytest

import silverball as sb
from silverball.table import parse_table
from silverball.table.parts import Cylinder

CLASSIC = sb.load_table("classic")
RECIPE = sb.load_table("random")


def refusal(table: sb.Table, **changes: object) -> list[str]:
    with pytest.raises(sb.TableError) as caught:
        table.replace(**changes)
    return [str(problem) for problem in caught.value.problems]


def test_a_dict_changes_only_the_fields_that_it_names() -> None:
    heavy = CLASSIC.replace(name="Heavy", board={"gravity": 12})
    assert heavy.board == CLASSIC.board.replace(gravity=12.0)
    assert heavy.model_dump(exclude={"name", "board"}) == CLASSIC.model_dump(exclude={"name", "board"})
    assert (heavy.name, CLASSIC.board.gravity) == ("Heavy", 10.0)


def test_a_dict_reaches_models_inside_models() -> None:
    other = RECIPE.replace(random={"prism": {"points": 7}})
    assert RECIPE.random is not None
    assert other.random == RECIPE.random.replace(prism=RECIPE.random.prism.replace(points=7))


@pytest.mark.parametrize("as_dict", [True, False])
def test_a_list_of_parts_takes_the_place_of_the_old_one(as_dict: bool) -> None:
    part = {"center": (5.0, 1.5), "radius": 0.6}
    table = CLASSIC.replace(cylinder=[part if as_dict else Cylinder(**part)], triangular_prism=[])
    assert (len(table.cylinder), table.triangular_prism) == (1, ())
    assert table.cylinder[0] == Cylinder(**part)


def test_a_model_takes_the_place_of_the_old_one() -> None:
    assert RECIPE.replace(board=sb.parts.Board(gravity=11.0)).board == sb.parts.Board(gravity=11.0)


def test_a_section_can_be_taken_away_and_added() -> None:
    bare = RECIPE.replace(random=None)
    assert bare.random is None
    surface = sb.parts.PrismSurface(points=7)
    recipe = bare.replace(random={"cylinders": 1, "prism": surface}).random
    assert recipe == sb.parts.RandomRecipe(cylinders=1, prism=surface)


@pytest.mark.parametrize("name", sb.table_names())
def test_without_changes_it_is_the_same_table(name: str) -> None:
    table = sb.load_table(name)
    assert table.replace() == table


REFUSALS = {
    "an unknown section": ({"cylindre": []}, ["cylindre: unknown key: did you mean `cylinder`?"]),
    "an unknown field": ({"board": {"gravty": 12}}, ["board.gravty: unknown key: did you mean `gravity`?"]),
    "a field of another section": ({"gravity": 12}, ["gravity: unknown key: `gravity` belongs in [board]"]),
    "the trade's word": (
        {"bumper": []},
        ["bumper: unknown key: did you mean `cylinder`? That is its name here"],
    ),
    "a wrong type": (
        {"cylinder": 5},
        ["cylinder: must be a list of parts, each under [[cylinder]] with two brackets, got 5"],
    ),
    "a part that is none": (
        {"cylinder": [5]},
        ["cylinder[0]: must be a section with keys and values, got 5"],
    ),
    "a value out of range": ({"board": {"gravity": -1}}, ["board.gravity: must be 0 to 100 u/s², got -1"]),
    "nothing": ({"board": None}, ["board: must be a section with keys and values, got None"]),
    "two mistakes": (
        {"board": {"gravity": "x", "max_balls": 9}},
        [
            "board.gravity: must be a number, 0 to 100 u/s², got 'x'",
            "board.max_balls: must be 1 to 8 balls, got 9",
        ],
    ),
    "a part beyond the board": (
        {"cylinder": [{"center": [20.0, 0.0], "radius": 0.5}]},
        ["cylinder[0].center: lies beyond the edge of the board: move it onto the board"],
    ),
    "a mesh that is missing": (
        {"cylinder": [{"mesh": "no.stl"}]},
        ["cylinder[0].mesh: cannot be read: no.stl (No such file or directory)"],
    ),
}


@pytest.mark.parametrize("why", REFUSALS)
def test_what_cannot_be_is_refused_in_the_words_of_the_file(why: str) -> None:
    changes, problems = REFUSALS[why]
    assert refusal(CLASSIC, **changes) == problems


def test_a_recipe_that_makes_no_board_is_refused() -> None:
    (problem,) = refusal(RECIPE, random={"gap": 5.0, "cylinders": 32})
    assert problem.startswith("random.gap: could not be met at 5 u")


def test_the_same_change_in_a_file_is_refused_with_the_same_words() -> None:
    text = 'format = 1\nname = "x"\n[board]\ngravty = 1\nwidth = 900\n'
    with pytest.raises(sb.TableError) as caught:
        parse_table(text)
    expected = [str(problem) for problem in caught.value.problems]
    assert refusal(sb.Table(name="x"), board={"gravty": 1, "width": 900}) == expected


def test_a_part_is_changed_by_its_own_replace() -> None:
    part = CLASSIC.triangular_prism[0]
    assert part.replace(points=7).points == 7
    assert part.replace(points=7).corners() == part.corners()
    with pytest.raises(ValueError, match="pionts"):
        part.replace(pionts=7)
