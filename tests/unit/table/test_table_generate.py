"""A seed makes the same board everywhere, and every board meets the rules."""

import math
import subprocess
import sys

import pytest

from boards import CLASSIC
from silverball.errors import Problem, TableError, UnknownTable
from silverball.table import (
    Table,
    check_table,
    dump_table,
    generate_table,
    load_table,
    parse_table,
    placement as placing,
    save_table,
    table_digest,
)
from silverball.table.placement import try_recipe

RECIPE = load_table("random")
RULES = RECIPE.random


def circles(table):
    """The bounding circles of all obstacles: x, z, radius."""
    prisms = [(*prism.center, prism.size) for prism in table.triangular_prism]
    return prisms + [(*cylinder.center, cylinder.radius) for cylinder in table.cylinder]


def distance_to_segment(point, start, end):
    """By angles: beyond either end the end is nearest, else the height over the line."""
    to_start, to_end, length = math.dist(point, start), math.dist(point, end), math.dist(start, end)
    if to_end**2 >= to_start**2 + length**2:
        return to_start
    if to_start**2 >= to_end**2 + length**2:
        return to_end
    half = (to_start + to_end + length) / 2  # Heron
    area = math.sqrt(max(0.0, half * (half - to_start) * (half - to_end) * (half - length)))
    return 2.0 * area / length


def broken_rules(table):
    """The rules of the recipe that a board breaks, by formulas of this test alone."""
    broken = []
    board, obstacles = table.board, circles(table)
    (low_x, low_z), (high_x, high_z) = RULES.area
    for index, (x, z, radius) in enumerate(obstacles):
        if not (low_x <= x <= high_x and low_z <= z <= high_z):
            broken.append("area")
        borders = (board.width / 2 - abs(z), board.length / 2 - x)
        if min(borders) - board.wall_thickness - radius < RULES.wall_gap:
            broken.append("wall_gap to a border")
        for wall in table.slant_wall:
            # Heron is good to 1e-7 for a sliver, far above the rounding that the rule allows for.
            if (
                distance_to_segment((x, z), wall.start, wall.end) - wall.thickness - radius
                < RULES.wall_gap - 1e-6
            ):
                broken.append("wall_gap to a slant wall")
        for paddle in table.paddle:
            if math.dist((x, z), paddle.pivot) - paddle.length - radius < RULES.wall_gap:
                broken.append("wall_gap to a paddle")
        for other_x, other_z, other_radius in obstacles[:index]:
            if math.dist((x, z), (other_x, other_z)) - radius - other_radius < RULES.gap:
                broken.append("gap")
    for prism in table.triangular_prism:
        if not (RULES.prism_size[0] <= prism.size <= RULES.prism_size[1]):
            broken.append("prism_size")
        if not (RULES.rotation[0] <= prism.rotation <= RULES.rotation[1]):
            broken.append("rotation")
        corners = prism.corners()
        for (ax, az), (bx, bz) in zip(corners, (*corners[1:], corners[0]), strict=True):
            steepness = math.degrees(math.atan2(abs(bx - ax), abs(bz - az)))
            if not 10.0 - 1e-9 <= steepness <= 80.0 + 1e-9:
                broken.append("edge off the axes")
    for cylinder in table.cylinder:
        if not (RULES.cylinder_radius[0] <= cylinder.radius <= RULES.cylinder_radius[1]):
            broken.append("cylinder_radius")
    return broken


def assert_board_keeps_the_rules(seed):
    table = generate_table(seed)
    assert table.random is None
    assert len(table.triangular_prism) == RULES.triangular_prisms
    assert len(table.cylinder) == RULES.cylinders
    assert broken_rules(table) == [], f"seed {seed}"


def test_300_boards_keep_all_rules():
    for seed in range(300):
        assert_board_keeps_the_rules(seed)


@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param(range(300, 3000), marks=pytest.mark.slow),
        pytest.param(range(3000, 10_000), marks=pytest.mark.campaign),
    ],
    ids=str,
)
def test_10_000_boards_keep_all_rules(seeds):
    for seed in seeds:
        assert_board_keeps_the_rules(seed)


def test_boards_differ_and_use_the_whole_area():
    tables = [generate_table(seed) for seed in range(100)]
    assert len({table_digest(table) for table in tables}) == 100
    places = [circle for table in tables for circle in circles(table)]
    assert min(x for x, _, _ in places) < -1.0
    assert max(x for x, _, _ in places) > 7.5
    assert min(z for _, z, _ in places) < -3.0
    assert max(z for _, z, _ in places) > 3.0


def test_a_board_is_named_after_its_seed_and_reads_well():
    table = generate_table(7)
    assert table.name == "Random 7"
    numbers = [word.strip("[],") for word in dump_table(table).split() if "." in word]
    assert all(len(number.partition(".")[2]) <= 3 for number in numbers)


def test_the_same_seed_makes_the_same_board_in_a_new_process():
    code = (
        "import silverball.table as t; print(*(t.table_digest(t.generate_table(s)) for s in (0, 7, 2**70)))"
    )
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert output.split() == [table_digest(generate_table(seed)) for seed in (0, 7, 2**70)]


def test_a_recipe_may_be_named_or_given():
    assert generate_table(7) == generate_table(7, "random") == generate_table(7, RECIPE)


def test_a_recipe_may_be_a_file_and_keeps_its_stationary_parts(tmp_path):
    crowded = CLASSIC.model_copy(
        update={
            "cylinder": CLASSIC.cylinder[:1],
            "random": RULES.model_copy(update={"triangular_prisms": 1, "cylinders": 1, "wall_gap": 0.8}),
        }
    )
    save_table(crowded, tmp_path / "mine.toml")
    table = generate_table(1, tmp_path / "mine.toml")
    assert table.slant_wall == crowded.slant_wall
    assert table.cylinder[:1] == crowded.cylinder
    assert (len(table.triangular_prism), len(table.cylinder)) == (5, 2)
    assert check_table(table) == []


def recipe_with(**changes):
    return RECIPE.model_copy(update={"random": RULES.model_copy(update=changes)})


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"gap": 5.0}, "random.gap"),
        ({"cylinders": 32}, "random.gap"),
        ({"wall_gap": 6.0}, "random.wall_gap"),
        ({"rotation": (21.0, 39.0)}, "random.rotation"),
    ],
)
def test_what_cannot_be_placed_names_the_rule_that_could_not_be_met(changes, rule):
    with pytest.raises(TableError) as caught:
        generate_table(0, recipe_with(**changes))
    assert [problem.path for problem in caught.value.problems] == [rule]


def test_nothing_to_place_is_no_problem():
    table = generate_table(0, recipe_with(triangular_prisms=0, cylinders=0))
    assert table.cylinder == ()


def test_a_finished_table_is_no_recipe():
    with pytest.raises(TableError, match=r"without a \[random\] section"):
        generate_table(0, "classic")
    with pytest.raises(UnknownTable, match='did you mean "random"'):
        generate_table(0, "randon")


@pytest.mark.parametrize("seed", [-1, 1.5, "7", True])
def test_a_seed_is_a_whole_number_from_0(seed):
    with pytest.raises(TableError, match="must be an integer ≥ 0"):
        generate_table(seed)


def test_rules_can_be_empty_of_parts():
    bare = Table(name="Bare", random={"triangular_prisms": 1, "cylinders": 1})
    assert check_table(generate_table(3, bare)) == []


NASTY_AREAS = [
    ((-3.0, -4.0), (-1.87, 4.9)),  # as low as the paddles
    ((0.0, -2.0), (1.0, 2.0)),
    ((-2.0, -1.0), (8.0, 1.0)),
    ((4.0, -4.0), (6.5, 4.0)),
    ((2.0, 2.0), (2.0, 2.0)),
    ((-9.0, -5.0), (10.0, 5.0)),
]


@pytest.mark.parametrize("area", NASTY_AREAS, ids=str)
@pytest.mark.parametrize(("prisms", "cylinders"), [(1, 0), (2, 1), (4, 3), (3, 5)])
@pytest.mark.parametrize("gap", [0.62, 0.9, 1.5])
def test_a_recipe_that_is_good_makes_a_board_of_every_seed(area, prisms, cylinders, gap):
    table = recipe_with(area=area, triangular_prisms=prisms, cylinders=cylinders, gap=gap)
    problems = check_table(table)
    if problems:  # then it says which rule is in the way, and what may be changed
        assert all(problem.path.startswith("random") for problem in problems)
        with pytest.raises(TableError):
            parse_table(dump_table(table))
        return
    assert parse_table(dump_table(table)) == table
    for seed in range(40):
        assert len(circles(generate_table(1000 + seed, table))) == prisms + cylinders


def test_a_recipe_that_makes_boards_of_few_seeds_only_is_refused_before_anybody_plays_it():
    crowded = [recipe_with(cylinders=count) for count in range(1, 20)]
    good = [not check_table(table) for table in crowded]
    assert good[0]
    assert not good[-1]
    assert good == sorted(good, reverse=True), "the more obstacles, the less room"
    message = check_table(crowded[-1])[0].message
    assert "could not be met" in message
    assert "enlarge random.area" in message


def test_what_the_last_board_had_is_told_when_no_board_passes(monkeypatch):
    def refuse(layout):
        return [Problem("board", "has no way to the gutter")]

    monkeypatch.setattr(placing, "check_layout", refuse)
    ((path, message, _),) = try_recipe(RECIPE)
    assert path == "random"
    assert "board has no way to the gutter" in message
