"""Reachability: where a ball can be on the board, and where one may be created.

The places of a ball's centre are sampled on a square grid. A sample is free if a ball there touches no
border, no stationary part and no paddle at rest. It is reached if it is eight-connected to the gutter. A
passage is found if it is wider than a ball by about 0.45 ball radii; `check.py` refuses narrower ones, so for
a checked table the result is exact.

The step of the grid is 5/16 of a ball radius. Four by four samples make a square cell of 1.25 ball radii. A
cell is smaller than any part with a ball's radius around it, so no cell extends through a wall.
"""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.table.geometry import Bools, Floats
from silverball.table.kinds import Board, Paddle
from silverball.table.model import Outline, Triangle

if TYPE_CHECKING:
    from silverball.table.table import Table

CELL = 1.25  # [ball radii] side of a cell in which a ball may be created
SAMPLES = 4  # samples along each side of a cell
NEAR_SAMPLES = 4  # samples around a point that count as near it, in each direction
STEP = CELL / SAMPLES  # [ball radii] between two samples
PASSAGE_MARGIN = (
    math.sqrt(2.0) * STEP
)  # [ball radii] by which a passage must be wider than a ball to be found


class Grid(NamedTuple):
    """The samples of one board.

    Attributes:
        x: The x of each row [u], from just above the gutter to the top, shape [row].
        z: The z of each column [u], symmetric about the middle, shape [column].
        step: The distance between neighbours [u].
        floor_row: The first row in which balls may be created: out of the paddles' reach.
    """

    x: Floats
    z: Floats
    step: float
    floor_row: int

    @classmethod
    def of(cls, board: Board, paddles: tuple[Paddle, ...]) -> Grid:
        """Make the grid whose cells start right above the reach of the paddles."""
        radius = board.ball_radius
        step = STEP * radius
        floor = creation_floor(board, paddles)
        below = max(0, int((floor - board.gutter) / step))
        above = SAMPLES * max(0, math.ceil((0.5 * board.length - floor) / (CELL * radius)))
        across = SAMPLES * math.ceil(board.width / (CELL * radius))
        x = floor + (np.arange(-below, above, dtype=np.float64) + 0.5) * step
        z = (np.arange(across, dtype=np.float64) - 0.5 * (across - 1)) * step
        return cls(x, z, step, below)


class Space(NamedTuple):
    """The free space of a board, sampled.

    Attributes:
        grid: The positions of the samples.
        free: Whether a ball there touches nothing, shape [row, column].
        reached: Whether it is free and leads to the gutter, shape [row, column].
    """

    grid: Grid
    free: Bools
    reached: Bools

    def reaches(self, point: tuple[float, float]) -> bool:
        """Return whether a point is within a few samples of one that leads to the gutter."""
        row = round((point[0] - float(self.grid.x[0])) / self.grid.step) if len(self.grid.x) else 0
        column = round((point[1] - float(self.grid.z[0])) / self.grid.step)
        rows, columns = (
            slice(max(0, index - NEAR_SAMPLES), max(0, index + NEAR_SAMPLES + 1)) for index in (row, column)
        )
        return bool(self.reached[rows, columns].any())

    def places(self) -> tuple[Floats, float]:
        """Return the cells in which a ball may be created, as `ball_places` does."""
        grid = self.grid
        cells = self.reached[grid.floor_row :]
        rows, columns = cells.shape[0] // SAMPLES, cells.shape[1] // SAMPLES
        usable = cells.reshape(rows, SAMPLES, columns, SAMPLES).any(axis=(1, 3))
        row, column = np.nonzero(usable)
        middle = 0.5 * (SAMPLES - 1) * grid.step
        x = grid.x[grid.floor_row :: SAMPLES][row] + middle if rows else np.empty(0)
        z = grid.z[::SAMPLES][column] + middle
        return np.stack([x, z], axis=1), SAMPLES * grid.step


def creation_floor(board: Board, paddles: tuple[Paddle, ...]) -> float:
    """Return the x [u] above which balls are created: beyond the paddles' reach, clear of the gutter."""
    if not paddles:
        return board.gutter + 2.0 * board.ball_radius
    return max(paddle.pivot[0] + paddle.reach for paddle in paddles) + board.ball_radius


def ball_places(table: Table) -> tuple[Floats, float]:
    """Return the square cells of the board in which a ball may be created.

    In each cell a ball at one of the sixteen samples touches nothing and can get to the gutter; so no cell
    lies behind a corner wall or in a closed pocket. Other points of a cell may be occupied, so the place of a
    new ball must be tested.

    Args:
        table: A finished table, with or without paddles.

    Returns:
        The centres of the cells (x, z) [u], shape [cell, 2], row by row from the paddles to the top, each
        from left to right; and the side of a cell [u].
    """
    return space(table.board, table.paddle, [part.outline() for part in table.stationary_parts]).places()


def space(board: Board, paddles: tuple[Paddle, ...], stationary: list[Outline]) -> Space:
    """Return the free space for a ball between the stationary parts and the paddles at rest."""
    grid = Grid.of(board, paddles)
    resting = [(paddle.corners(paddle.rest_angle), 0.0) for paddle in paddles]
    margin = board.wall_thickness + board.ball_radius
    free = np.outer(grid.x <= 0.5 * board.length - margin, np.abs(grid.z) <= 0.5 * board.width - margin)
    for core, radius in [*stationary, *resting]:
        _block(free, grid, core, radius + board.ball_radius)
    return Space(grid, free, _connected_to_first_row(free))


def _block(free: Bools, grid: Grid, core: Triangle, radius: float) -> None:
    """Mark the samples within `radius` of a core as blocked, in place."""
    xs, zs = [x for x, _ in core], [z for _, z in core]
    rows = slice(*np.searchsorted(grid.x, [min(xs) - radius, max(xs) + radius]))
    columns = slice(*np.searchsorted(grid.z, [min(zs) - radius, max(zs) + radius]))
    x, z = grid.x[rows, None], grid.z[None, columns]
    edges = [(a, b) for a, b in zip(core, (*core[1:], core[0]), strict=True) if a != b]
    if not edges:  # a single point
        edges = [(core[0], core[0])]
    elif core[1] == core[2]:  # two points
        edges = edges[:1]
    outside = np.ones((x.shape[0], z.shape[1]), dtype=bool)
    inside = np.ones_like(outside)
    for (ax, az), (bx, bz) in edges:
        dx, dz = bx - ax, bz - az
        square = dx * dx + dz * dz
        along = np.clip(((x - ax) * dx + (z - az) * dz) / (square or 1.0), 0.0, 1.0)
        outside &= (x - ax - along * dx) ** 2 + (z - az - along * dz) ** 2 >= radius * radius
        inside &= dz * (x - ax) - dx * (z - az) > 0.0
    if len(edges) == 3:
        outside &= ~inside
    free[rows, columns] &= outside


def _connected_to_first_row(free: Bools) -> Bools:
    """Region labelling: the free samples that are eight-connected to the first row.

    Adjacent free samples of a row make a run; the runs of adjacent rows that touch make a graph, small enough
    to traverse in Python.
    """
    if free.size == 0:
        return free
    begins = free.copy()
    begins[:, 1:] &= ~free[:, :-1]
    runs = np.where(free, np.cumsum(begins, dtype=np.int32).reshape(free.shape), 0)
    neighbours: dict[int, list[int]] = defaultdict(list)
    lower, upper = runs[:-1], runs[1:]
    for low, high in ((lower, upper), (lower[:, :-1], upper[:, 1:]), (lower[:, 1:], upper[:, :-1])):
        for one, other in _touching(low, high):
            neighbours[one].append(other)
            neighbours[other].append(one)
    found = set(np.unique(runs[0]).tolist()) - {0}
    front = list(found)
    while front:
        front = list({run for known in front for run in neighbours[known]} - found)
        found.update(front)
    is_found = np.zeros(int(runs.max()) + 1, dtype=bool)
    is_found[list(found)] = True
    return is_found[runs]


def _touching(low: NDArray[np.int32], high: NDArray[np.int32]) -> list[tuple[int, int]]:
    """The pairs of runs that touch, most of them once."""
    pair = (low > 0) & (high > 0)
    pair[:, 1:] &= (low[:, 1:] != low[:, :-1]) | (high[:, 1:] != high[:, :-1])
    return list(zip(low[pair].tolist(), high[pair].tolist(), strict=True))
