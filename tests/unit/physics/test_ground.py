"""The audit's map of a board: does it never lie, and does it share nothing with the solver?"""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

from boards import full_table, table_of
from silverball.physics import audit
from silverball.physics.audit import depth_in_borders, depth_in_stationary
from silverball.soak import regions as ground
from silverball.soak.hostile import hostile_table
from silverball.soak.regions import BLOCKED, MAIN_GROUND, OFF_BOARD, ground_of, is_narrow, mark_at, survey
from silverball.table import SlantWall, ball_places, generate_table, load_table
from silverball.world.compile import compile_tables

TABLES = {
    "classic": load_table("classic"),
    "random": generate_table(7),
    "full": full_table(),
    "hostile 1": hostile_table(1),
    "hostile 2": hostile_table(2),
}


class Chart:
    """The map of one table and what is needed to ask it."""

    def __init__(self, table) -> None:
        self.table, self.boards = table, compile_tables([table])
        self.grounds = survey(self.boards.board, self.boards.collider)

    def mark(self, x: float, z: float) -> int:
        return mark_at(self.grounds.site[0], self.grounds.mark, x, z)

    def ground(self, x: float, z: float) -> int:
        return ground_of(self.mark(x, z))

    def is_free(self, x: float, z: float) -> bool:
        board, colliders = self.boards.board[0], self.boards.collider
        return depth_in_borders(board, colliders, x, z) == depth_in_stationary(board, colliders, x, z) == 0.0


@pytest.mark.parametrize("module", [audit, ground])
def test_the_audit_imports_nothing_of_the_solver(module) -> None:
    tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    ours = {name for name in imported if name.startswith("silverball")}
    assert ours <= {"silverball.physics.kernel", "silverball.physics.records", "silverball.physics.audit"}


@pytest.mark.parametrize("name", TABLES)
def test_no_free_place_is_blocked_and_no_place_of_a_clear_cell_touches_anything(name: str) -> None:
    chart = Chart(TABLES[name])
    rng = np.random.default_rng(1)
    half = (chart.table.board.length / 2, chart.table.board.width / 2)
    seen = {"free": 0, "clear": 0, "blocked": 0}
    for x, z in rng.uniform(-1, 1, (20_000, 2)) * half:
        mark, free = chart.mark(x, z), chart.is_free(x, z)
        seen["free"] += free
        if free:
            assert mark > BLOCKED
        if not is_narrow(mark):
            seen["clear"] += 1
            assert free
        seen["blocked"] += mark == BLOCKED
    # The map is worth something: most of what is free is clear, most of what is not is blocked.
    assert seen["clear"] > 0.6 * seen["free"] > 0
    assert seen["blocked"] > 0.4 * (20_000 - seen["free"]) > 0


@pytest.mark.parametrize("name", TABLES)
def test_where_balls_are_created_is_the_ground_of_the_gutter(name: str) -> None:
    chart = Chart(TABLES[name])
    places, _ = ball_places(chart.table)
    grounds = [chart.ground(x, z) for x, z in places if chart.is_free(x, z)]
    assert len(grounds) > 100
    assert set(grounds) == {MAIN_GROUND}


@pytest.mark.parametrize("name", ["classic", "random", "full"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_behind_a_corner_wall_is_another_ground(name: str, side: float) -> None:
    chart = Chart(TABLES[name])
    # In the corner, both borders 0.1 + 0.25 u away, but for 0.05 u.
    assert chart.ground(9.6, side * 4.6) not in (BLOCKED, OFF_BOARD, MAIN_GROUND)


def test_a_room_without_a_door_is_another_ground_and_one_with_a_door_is_not() -> None:
    corners = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]
    walls = [SlantWall(start=a, end=b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    closed, open_ = Chart(table_of(*walls)), Chart(table_of(*walls[1:]))
    assert (closed.ground(0.0, 0.0), closed.ground(5.0, 0.0)) == (MAIN_GROUND + 1, MAIN_GROUND)
    assert (open_.ground(0.0, 0.0), open_.ground(5.0, 0.0)) == (MAIN_GROUND, MAIN_GROUND)


@pytest.mark.parametrize(
    ("x", "z"), [(10.001, 0.0), (-10.001, 0.0), (0.0, 5.001), (0.0, -5.001), (np.nan, 0.0), (0.0, np.nan)]
)
def test_a_place_beyond_the_board_or_nowhere_is_off_the_board(x: float, z: float) -> None:
    chart = Chart(TABLES["classic"])
    assert chart.mark(x, z) == OFF_BOARD
    assert chart.ground(x, z) == OFF_BOARD
    assert is_narrow(chart.mark(x, z))


def test_many_boards_of_different_sizes_have_maps_of_their_own() -> None:
    tables = list(TABLES.values())
    boards = compile_tables(tables)
    together = survey(boards.board, boards.collider)
    for number, table in enumerate(tables):
        alone = Chart(table).grounds
        first = together.site["first"][number]
        assert np.array_equal(together.mark[first : first + len(alone.mark)], alone.mark)
