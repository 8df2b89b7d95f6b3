"""Region labelling: what it says of a cell is true, and it shares no code with the solver."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

from boards import full_table, table_of
from silverball.physics import audit
from silverball.physics.audit import depth_in_borders, depth_in_stationary
from silverball.soak import regions
from silverball.soak.hostile import hostile_table
from silverball.soak.regions import (
    BLOCKED,
    MAIN_REGION,
    OFF_BOARD,
    is_narrow,
    label_at,
    region_map,
    region_of,
)
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
    """The regions of one table."""

    def __init__(self, table) -> None:
        self.table, self.boards = table, compile_tables([table])
        self.map = region_map(self.boards.board, self.boards.collider)

    def label(self, x: float, z: float) -> int:
        return label_at(self.map.headers[0], self.map.labels, 0, x, z)

    def region(self, x: float, z: float) -> int:
        return region_of(self.label(x, z))

    def is_free(self, x: float, z: float) -> bool:
        board, colliders = self.boards.board[0], self.boards.collider
        return depth_in_borders(board, colliders, x, z) == depth_in_stationary(board, colliders, x, z) == 0.0


@pytest.mark.parametrize("module", [audit, regions])
def test_the_audit_imports_nothing_of_the_solver(module) -> None:
    tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    ours = {name for name in imported if name.startswith("silverball")}
    assert ours <= {f"silverball.physics.{name}" for name in ("kernel", "records", "for_devices", "audit")}


@pytest.mark.parametrize("name", TABLES)
def test_no_free_place_is_blocked_and_no_place_of_a_clear_cell_touches_anything(name: str) -> None:
    chart = Chart(TABLES[name])
    rng = np.random.default_rng(1)
    half = (chart.table.board.length / 2, chart.table.board.width / 2)
    seen = {"free": 0, "clear": 0, "blocked": 0}
    for x, z in rng.uniform(-1, 1, (20_000, 2)) * half:
        label, free = chart.label(x, z), chart.is_free(x, z)
        seen["free"] += free
        if free:
            assert label > BLOCKED
        if not is_narrow(label):
            seen["clear"] += 1
            assert free
        seen["blocked"] += label == BLOCKED
    # The map is worth something: most of what is free is clear, most of what is not is blocked.
    assert seen["clear"] > 0.6 * seen["free"] > 0
    assert seen["blocked"] > 0.4 * (20_000 - seen["free"]) > 0


@pytest.mark.parametrize("name", TABLES)
def test_where_balls_are_created_is_the_region_of_the_gutter(name: str) -> None:
    chart = Chart(TABLES[name])
    places, _ = ball_places(chart.table)
    found = [chart.region(x, z) for x, z in places if chart.is_free(x, z)]
    assert len(found) > 100
    assert set(found) == {MAIN_REGION}


@pytest.mark.parametrize("name", ["classic", "random", "full"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_behind_a_corner_wall_is_another_region(name: str, side: float) -> None:
    chart = Chart(TABLES[name])
    # In the corner, both borders 0.1 + 0.25 u away, but for 0.05 u.
    assert chart.region(9.6, side * 4.6) not in (BLOCKED, OFF_BOARD, MAIN_REGION)


def test_an_enclosed_area_is_another_region_and_an_open_one_is_not() -> None:
    corners = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]
    walls = [SlantWall(start=a, end=b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    closed, open_ = Chart(table_of(*walls)), Chart(table_of(*walls[1:]))
    assert (closed.region(0.0, 0.0), closed.region(5.0, 0.0)) == (MAIN_REGION + 1, MAIN_REGION)
    assert (open_.region(0.0, 0.0), open_.region(5.0, 0.0)) == (MAIN_REGION, MAIN_REGION)


@pytest.mark.parametrize(
    ("x", "z"), [(10.001, 0.0), (-10.001, 0.0), (0.0, 5.001), (0.0, -5.001), (np.nan, 0.0), (0.0, np.nan)]
)
def test_a_place_beyond_the_board_or_not_a_number_is_off_the_board(x: float, z: float) -> None:
    chart = Chart(TABLES["classic"])
    assert chart.label(x, z) == OFF_BOARD
    assert chart.region(x, z) == OFF_BOARD
    assert is_narrow(chart.label(x, z))


def test_many_boards_of_different_sizes_have_maps_of_their_own() -> None:
    tables = list(TABLES.values())
    boards = compile_tables(tables)
    together = region_map(boards.board, boards.collider)
    for number, table in enumerate(tables):
        alone = Chart(table).map
        first = together.headers["first"][number]
        assert np.array_equal(together.labels[first : first + len(alone.labels)], alone.labels)
