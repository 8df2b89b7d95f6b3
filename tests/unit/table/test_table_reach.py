"""Balls are created only where they touch nothing and can reach the gutter."""

import time

import numpy as np
import pytest

from silverball.table import Board, Cylinder, SlantWall, Table, ball_places, generate_table, load_table
from silverball.table.geometry import border_gaps, distances

CLASSIC = load_table("classic")


def is_free(table, points):
    """Whether a ball at each point touches no border and no stationary part."""
    radius = table.board.ball_radius
    free = border_gaps(points, table.board).min(axis=-1) >= radius - 1e-12
    for part in (*table.slant_wall, *table.triangular_prism, *table.cylinder):
        core, thickness = part.outline()
        free &= distances(points, np.array(core)) >= thickness + radius - 1e-12
    return free


@pytest.mark.parametrize("table", [CLASSIC, generate_table(5), Table()], ids=lambda table: table.name)
def test_every_cell_has_a_free_place_out_of_the_paddles_reach(table):
    cells, side = ball_places(table)
    radius = table.board.ball_radius
    assert cells.dtype == np.float64
    assert side == pytest.approx(1.25 * radius)
    inside = (np.arange(16) + 0.5) / 16 * side - side / 2
    offsets = np.stack(np.meshgrid(inside, inside, indexing="ij"), axis=-1).reshape(-1, 2)
    assert is_free(table, cells[:, None, :] + offsets).any(axis=1).all()
    floor = max(
        (paddle.pivot[0] + paddle.reach for paddle in table.paddle), default=table.board.gutter + radius
    )
    assert cells[:, 0].min() - side / 2 >= floor + radius - 1e-9


def test_every_free_place_of_an_open_board_lies_in_a_cell():
    cells, side = ball_places(CLASSIC)
    points = np.random.default_rng(0).uniform((-4.85, -5.0), (10.0, 5.0), (20_000, 2))
    points = points[is_free(CLASSIC, points)]
    behind_a_corner = points[:, 0] + np.abs(points[:, 1]) > 12.5
    off = np.abs(points[:, None, :] - cells).max(axis=2).min(axis=1)
    assert (off[behind_a_corner] > side / 2).all()
    # A free place in a cell of which all sixteen samples are taken is possible, but rare.
    assert (off[~behind_a_corner] <= side / 2 + 1e-9).mean() > 0.995


def test_a_mirrored_table_has_the_mirrored_cells():
    cells, _ = ball_places(CLASSIC)
    assert {(x, round(z, 9)) for x, z in cells} == {(x, round(-z, 9)) for x, z in cells}


def test_no_cell_lies_in_a_sealed_pocket():
    hut = [
        SlantWall(start=(2.0, -1.5), end=(4.0, 0.0)),
        SlantWall(start=(4.0, 0.0), end=(2.0, 1.5)),
        SlantWall(start=(2.0, 1.5), end=(1.0, 0.0)),
        SlantWall(start=(1.0, 0.0), end=(2.0, -1.5)),
    ]
    cells, _ = ball_places(Table(slant_wall=hut))
    assert np.hypot(*(cells - (2.2, 0.0)).T).min() > 0.8


def test_a_board_without_room_has_no_cells():
    full = Table(board=Board(length=10.0, gutter=-4.9), cylinder=[Cylinder(center=(0, 0), radius=6.9)])
    assert len(ball_places(full)[0]) == 0


def test_the_cells_come_in_rows_from_below_and_from_left_to_right():
    cells, _ = ball_places(CLASSIC)
    assert [tuple(cell) for cell in cells] == sorted(tuple(cell) for cell in cells)


def test_finding_the_cells_takes_a_moment_only():
    ball_places(CLASSIC)
    times = []
    for _ in range(5):
        start = time.process_time()
        ball_places(CLASSIC)
        times.append(time.process_time() - start)
    assert min(times) < 0.015
