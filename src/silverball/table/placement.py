"""Placement of the obstacles of a recipe: finished boards from random numbers.

The parts of the recipe stay. Prisms and cylinders are placed one after the other, each at the first of some
random places that meets all rules of `placement_rules.py`. If there is none, or if the finished board fails a
check, the layout starts again.

The same seed makes the same board on every machine: the random numbers are the raw 64-bit words of PCG64 (a
stream that NumPy guarantees), places are rounded to thousandths before the rules are tested, and angles are
drawn from a list of tenths of a degree.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from silverball.errors import Problem, TableError
from silverball.table.check import check_layout
from silverball.table.geometry import Floats
from silverball.table.kinds import Cylinder, TriangularPrism
from silverball.table.placed_parts import Layout
from silverball.table.placement_rules import Surroundings, allowed_rotations, circle_distances
from silverball.table.recipe import RandomRecipe

if TYPE_CHECKING:
    from silverball.table.table import Table

PLACES = 64  # random places tried for one obstacle in one layout
LAYOUTS = 500  # layouts started before giving up
BOARDS = 20  # finished layouts that may fail the checks before giving up
ROUNDING = 1e-9  # [u] by which the rules are met more strictly, so that rounding cannot break them
_DECIMALS = 3  # decimals of the lengths [u] in a generated table

# The trial of a recipe spends a tenth of the effort that a game may spend on a board, so that the
# result does not depend on luck: a recipe of which one layout in a hundred can be played passes the trial and
# fails later with a chance of 4 in a million; for every other share the chance is less.
TRIAL_SHARE = 10
TRIAL_SEEDS = 8  # each of these seeds must make a board
FEW_TRIAL_SEEDS = 2  # for tables of which one board takes up to a second
MANY_PARTS = 100  # with this many parts or more it does


class _Placed(NamedTuple):
    """One obstacle: its bounding circle [u] and its rotation [deg], 0 for a cylinder."""

    x: float
    z: float
    size: float
    rotation: float


class _Prepared(NamedTuple):
    """What all seeds of a recipe share."""

    table: Table
    recipe: RandomRecipe
    around: Surroundings
    rotations: Floats
    warnings: frozenset[Problem]  # of the recipe itself; a board must not add any


def board_of(recipe: Table, seed: int, layouts: int = LAYOUTS, boards: int = BOARDS) -> Table:
    """Make the board of a seed from a recipe that passes `check_layout`.

    Args:
        recipe: A table with a ``[random]`` section.
        seed: An integer ≥ 0.
        layouts: The number of layouts to start before giving up.
        boards: The number of finished layouts that may fail the checks before giving up.

    Raises:
        TableError: No layout meets the rules; the problem's path names the rule that fails most.
    """
    prepared = _prepare(recipe)
    stream = np.random.PCG64(seed)
    problems: list[Problem] = []
    for _ in range(boards):
        table = _finish(prepared, seed, _layout(prepared, stream, layouts))
        problems = [p for p in check_layout(Layout.of(table)) if p not in prepared.warnings]
        if not problems:
            return table
    raise TableError(prepared.table.name, [_no_board(problems[0], boards)])


def try_recipe(table: Table) -> list[Problem]:
    """Try whether a recipe with valid parts makes boards.

    Returns:
        The problems of the first seed that makes no board; an empty list for a finished table.
    """
    if table.random is None:
        return []
    for seed in range(TRIAL_SEEDS if len(table.parts()) < MANY_PARTS else FEW_TRIAL_SEEDS):
        try:
            board_of(table, seed, layouts=LAYOUTS // TRIAL_SHARE, boards=BOARDS // TRIAL_SHARE)
        except TableError as error:
            return list(error.problems)
    return []


@functools.lru_cache(maxsize=16)
def _prepare(table: Table) -> _Prepared:
    """Prepare a recipe, once for all seeds."""
    assert table.random is not None
    layout = Layout.of(table)
    own = check_layout(layout._replace(random=None))
    warnings = frozenset(problem for problem in own if not problem.is_error)
    rotations = np.array(allowed_rotations(table.random))
    return _Prepared(table, table.random, Surroundings.of(layout), rotations, warnings)


def _layout(prepared: _Prepared, stream: np.random.PCG64, layouts: int) -> list[_Placed]:
    """Place all obstacles, prisms first, because they are larger."""
    recipe = prepared.recipe
    count = recipe.triangular_prisms + recipe.cylinders
    failures = {"random.wall_gap": 0, "random.gap": 0}
    for _ in range(layouts):
        x, z, size, rotation = _draw(prepared, count, stream)
        circles = list(prepared.around.obstacle_circles)
        placed: list[_Placed] = []
        for item in range(count):
            points = np.stack([x[item], z[item]], axis=-1)
            near = circle_distances(points, np.array(circles).reshape(-1, 3)) - size[item]
            apart = near >= recipe.gap + ROUNDING
            clear_of_walls = prepared.around.wall_distances(points) - size[item]
            far_enough = clear_of_walls >= recipe.wall_gap + ROUNDING
            places = np.nonzero(far_enough & apart)[0]
            if len(places) == 0:
                failures["random.wall_gap"] += int((apart & ~far_enough).sum())
                failures["random.gap"] += int((far_enough & ~apart).sum())
                break
            values = (float(row[item, places[0]]) for row in (x, z, size, rotation))
            placed.append(_Placed(*values))
            circles.append(np.array(placed[-1][:3]))
        else:
            return placed
    raise TableError(prepared.table.name, [_no_layout(recipe, failures, layouts)])


def _draw(prepared: _Prepared, count: int, stream: np.random.PCG64) -> tuple[Floats, Floats, Floats, Floats]:
    """Draw random places: x, z, size [u] and rotation [deg], shape [obstacle, place] each."""
    recipe = prepared.recipe
    words = stream.random_raw(4 * count * PLACES).reshape(4, count, PLACES)
    share = (words >> np.uint64(11)) * 2.0**-53  # doubles in [0, 1)
    (low_x, low_z), (high_x, high_z) = recipe.area
    bounds = [recipe.prism_size] * recipe.triangular_prisms + [recipe.cylinder_radius] * recipe.cylinders
    low, high = np.array(bounds, dtype=np.float64).reshape(-1, 2).T[:, :, None]
    x = np.round(low_x + share[0] * (high_x - low_x), _DECIMALS)
    z = np.round(low_z + share[1] * (high_z - low_z), _DECIMALS)
    # Rounding must not leave the range, which may end between two thousandths.
    size = np.clip(np.round(low + share[2] * (high - low), _DECIMALS), low, high)
    if len(prepared.rotations):
        rotation = prepared.rotations[(share[3] * len(prepared.rotations)).astype(np.int64)]
    else:
        rotation = np.zeros_like(size)
    return np.clip(x, low_x, high_x), np.clip(z, low_z, high_z), size, rotation


def _no_layout(recipe: RandomRecipe, failures: dict[str, int], layouts: int) -> Problem:
    """The problem of the rule that most places broke as the only one."""
    rule = max(failures, key=lambda key: failures[key])
    key = rule.removeprefix("random.")
    message = (
        f"could not be met at {getattr(recipe, key):g} u for {recipe.triangular_prisms} prisms and "
        f"{recipe.cylinders} cylinders in {layouts} layouts: make it smaller, enlarge random.area, or place "
        "fewer or smaller obstacles"
    )
    return Problem(rule, message)


def _no_board(last: Problem, boards: int) -> Problem:
    """The problem of a recipe whose boards meet the rules but fail the checks."""
    message = (
        f"makes boards that cannot be played, {boards} of {boards} tried; of the last one, "
        f"{last.path or 'the board'} {last.message}: enlarge random.area or "
        "random.gap, or place fewer obstacles"
    )
    return Problem("random", message)


def _finish(prepared: _Prepared, seed: int, placed: list[_Placed]) -> Table:
    """Make the finished table: the recipe with placed obstacles and without its `random` section."""
    recipe = prepared.recipe
    prism, cylinder = recipe.prism.model_dump(), recipe.cylinder.model_dump()
    prisms = tuple(
        TriangularPrism(center=(x, z), size=size, rotation=rotation, **prism)
        for x, z, size, rotation in placed[: recipe.triangular_prisms]
    )
    cylinders = tuple(
        Cylinder(center=(x, z), radius=size, **cylinder)
        for x, z, size, _ in placed[recipe.triangular_prisms :]
    )
    return prepared.table.model_copy(
        update={
            "name": f"{prepared.table.name} {seed}",
            "triangular_prism": (*prepared.table.triangular_prism, *prisms),
            "cylinder": (*prepared.table.cylinder, *cylinders),
            "random": None,
        }
    )
