"""Lists of near rows: what they leave out touches nothing."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

from boards import PLAYGROUND, full_table
from silverball.physics.audit import box, depth_in_stationary
from silverball.physics.records import Response
from silverball.soak import near_rows as near_module
from silverball.soak.hostile import hostile_table
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.near_rows import NearBoard, depth_near, near_rows
from silverball.soak.part_boards import part_table
from silverball.table import generate_table
from silverball.world.compile import compile_tables

TABLES = [
    full_table(), PLAYGROUND, generate_table(7), hostile_table(1), part_table(3), part_table(8),
    *map(hostile_part_table, range(6)),
]  # fmt: skip


def test_the_lists_share_no_code_with_the_solver() -> None:
    tree = ast.parse(Path(near_module.__file__).read_text(encoding="utf-8"))
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    ours = {name for name in imported if name.startswith("silverball.physics")}
    assert ours == {f"silverball.physics.{name}" for name in ("kernel", "records", "audit")}


def test_the_depth_is_that_of_all_rows() -> None:
    """At random places, and around each row, where its box is about a ball's radius away."""
    boards, rng = compile_tables(TABLES), np.random.default_rng(0)
    near = near_rows(boards.board, boards.collider)
    touched = 0
    for number, board in enumerate(boards.board):
        lists = NearBoard(near.headers[number], near.starts, near.rows)
        half = board["half_length"], board["half_width"]
        places = [rng.uniform(-1.0, 1.0, 2) * half for _ in range(300)]
        for row in range(board["collider_first"] + board["shape_first"], board["collider_end"]):
            low_x, high_x, low_z, high_z = box(boards.collider[row])
            reach = board["ball_radius"] * 1.2
            if low_x <= high_x:
                places += [
                    rng.uniform((low_x - reach, low_z - reach), (high_x + reach, high_z + reach))
                    for _ in range(30)
                ]
        for x, z in places:
            for level, off in ((0, 0), (1, 0), (0, -1)):
                depth = depth_in_stationary(board, boards.collider, x, z, level, off)
                assert depth_near(lists, board, boards.collider, x, z, level, off) == depth, (number, x, z)
                touched += depth > 0.0
    assert touched > 1000


@pytest.mark.parametrize("number", range(len(TABLES)))
def test_all_rows_that_are_crossed_are_listed(number: int) -> None:
    boards = compile_tables(TABLES)
    near, board = near_rows(boards.board, boards.collider), boards.board[number]
    header = near.headers[number]
    listed = near.rows[header["crossed_first"] : header["crossed_end"]].tolist()
    rows = range(board["collider_first"] + board["shape_first"], board["collider_end"])
    c = boards.collider
    assert listed == [row for row in rows if c[row]["response"] != Response.BOUNCE or c[row]["one_way"] != 0]
