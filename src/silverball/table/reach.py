"""Reachability: where a ball can be on a table, and where one may be created.

The places of a ball's centre are sampled on a square grid, on each level. A sample is free if a ball there
touches no border, no part that stands still and no paddle at rest. It is reached if a ball can get from it to
the gutter or into a drain: over eight-connected samples, through passages, gates and drop targets, and by way
of holes. A lane is found if it is wider than a ball by about 0.45 ball radii; `check.py` warns of narrower
ones, so for a table without such a warning the result is exact. Real tables have narrow lanes, so in format 2
a finer grid is sampled too, with balls that are smaller by the distance to the nearest sample: every lane
that a ball fits is found, and some that are too narrow by a few hundredths of a unit.

The step of the grid is 5/16 of a ball radius. Four by four samples make a square cell of 1.25 ball radii. A
cell is smaller than any part with a ball's radius around it, so no cell extends through a wall.
"""

from __future__ import annotations

import functools
import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.forms import Shape
from silverball.table.geometry import (
    Bools,
    Floats,
    Indices,
    Pieces,
    Polygon,
    level_mask,
    moving_reach,
    outward_normals,
    paddle_at,
)
from silverball.table.placed_parts import Layout
from silverball.table.primitive import Point, Primitive

if TYPE_CHECKING:
    from silverball.table.kinds import Board
    from silverball.table.table import Table

CELL = 1.25  # [ball radii] side of a cell in which a ball may be created
SAMPLES = 4  # samples along each side of a cell
NEAR_SAMPLES = 4  # samples around a point that count as near it, in each direction
STEP = CELL / SAMPLES  # [ball radii] between two samples
PASSAGE_MARGIN = math.sqrt(2.0) * STEP  # [ball radii] by which a lane must be wider than a ball to be found
TIE = 1e-6  # [steps] a sample this close to an edge of a blocked interval is decided by its distance
CUT = 0.75  # [steps] on either side of a line: no two neighbours lie beyond it on different sides
BESIDE = 1.75  # [steps] beyond a line or gate, in which its neighbours lie
MAX_DETAIL = 8  # samples of the finer grid along a step of the coarse one
MAX_SAMPLES = 2**21  # of the finer grid, to bound time and memory
INTERVALS_AT_ONCE = 2**17  # pairs of a piece and a row of the grid measured at once, to bound the memory


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
    def of(cls, board: Board, floor: float) -> Grid:
        """Make the grid whose cells start at a height x [u]."""
        radius = board.ball_radius
        step = STEP * radius
        below = max(0, int((floor - board.gutter) / step))
        above = SAMPLES * max(0, math.ceil((0.5 * board.length - floor) / (CELL * radius)))
        across = SAMPLES * math.ceil(board.width / (CELL * radius))
        x = floor + (np.arange(-below, above, dtype=np.float64) + 0.5) * step
        z = (np.arange(across, dtype=np.float64) - 0.5 * (across - 1)) * step
        return cls(x, z, step, below)

    def finer(self, detail: int) -> Grid:
        """Return the grid with so many samples in place of each one, along either side."""
        shares = (np.arange(detail) + 0.5) / detail - 0.5
        x = (self.x[:, None] + shares * self.step).ravel()
        z = (self.z[:, None] + shares * self.step).ravel()
        return Grid(x, z, self.step / detail, self.floor_row * detail)

    def window(self, low: Sequence[float], high: Sequence[float]) -> tuple[slice, slice]:
        """Return the rows and columns of the samples within a box."""
        rows = slice(*np.searchsorted(self.x, [low[0], high[0]]).tolist())
        return rows, slice(*np.searchsorted(self.z, [low[1], high[1]]).tolist())


class Space(NamedTuple):
    """The free space of a board, sampled.

    Attributes:
        grid: The positions of the samples.
        levels: The levels of the table, in order; the first is 0.
        free: Whether a ball there touches nothing, shape [level, row, column].
        reached: Whether it is free and leads out, shape [level, row, column].
        detail: How finely the samples of `detailed` lie: so many along a step of the grid.
        detailed: The same as `reached` for a finer grid, shape [level, detail · row, detail · column].
        swept: The circles (x, z, radius [u]) of the paddles within whose reach no ball is created.
    """

    grid: Grid
    levels: tuple[int, ...]
    free: Bools
    reached: Bools
    detail: int
    detailed: Bools
    swept: tuple[tuple[float, float, float], ...] = ()

    def reaches(self, point: Point, level: int = 0) -> bool:
        """Return whether a point is within a few samples of one that leads out."""
        if not len(self.grid.x):
            return False
        row = round((point[0] - float(self.grid.x[0])) / self.grid.step)
        column = round((point[1] - float(self.grid.z[0])) / self.grid.step)
        rows, columns = (
            slice(max(0, index - NEAR_SAMPLES) * self.detail, max(0, index + NEAR_SAMPLES + 1) * self.detail)
            for index in (row, column)
        )
        return bool(self.detailed[self.levels.index(level), rows, columns].any())

    def places(self) -> tuple[Floats, float]:
        """Return the cells in which a ball may be created, as `ball_places` does."""
        grid = self.grid
        cells = self.reached[0, grid.floor_row :]
        for x, z, radius in self.swept:
            near = (grid.x[grid.floor_row :, None] - x) ** 2 + (grid.z - z) ** 2 < radius * radius
            cells = cells & ~near
        rows, columns = cells.shape[0] // SAMPLES, cells.shape[1] // SAMPLES
        usable = cells.reshape(rows, SAMPLES, columns, SAMPLES).any(axis=(1, 3))
        row, column = np.nonzero(usable)
        middle = 0.5 * (SAMPLES - 1) * grid.step
        x_of = grid.x[grid.floor_row :: SAMPLES][row] + middle if rows else np.empty(0)
        z_of = grid.z[::SAMPLES][column] + middle
        return np.stack([x_of, z_of], axis=1), SAMPLES * grid.step


@functools.lru_cache(maxsize=64)
def ball_places(table: Table) -> tuple[Floats, float]:
    """Return the square cells of the board in which a ball may be created.

    In each cell a ball at one of the sixteen samples touches nothing and can get out; so no cell lies behind
    a corner wall or in a closed pocket. Other points of a cell may be occupied, so the place of a new ball
    must be tested.

    Args:
        table: A finished table, with or without paddles.

    Returns:
        The centres of the cells (x, z) [u], shape [cell, 2], row by row from the paddles to the top, each
        from left to right, read-only: the last tables are remembered; and the side of a cell [u].
    """
    centers, size = space(Layout.of(table)).places()
    centers.flags.writeable = False
    return centers, size


def creation_floor(layout: Layout) -> float:
    """Return the x [u] above which balls are created: beyond the paddles' reach, clear of the gutter.

    Of the paddles that one button moves, the lowest counts; the reach of the others is left out by itself.
    """
    board = layout.board
    lowest = _lowest_paddles(layout)
    if not lowest:
        return board.gutter + 2.0 * board.ball_radius
    return max(_pivot(paddle)[0] + moving_reach(paddle) for paddle in lowest) + board.ball_radius


def _lowest_paddles(layout: Layout) -> list[Primitive]:
    """The lowest paddle of each button."""
    lowest: dict[str, Primitive] = {}
    for _, paddle in layout.moving():
        assert paddle.mover is not None
        other = lowest.setdefault(paddle.mover.button, paddle)
        if _pivot(paddle)[0] < _pivot(other)[0]:
            lowest[paddle.mover.button] = paddle
    return list(lowest.values())


def _pivot(paddle: Primitive) -> Point:
    assert paddle.mover is not None
    return paddle.mover.pivot


def space(layout: Layout) -> Space:
    """Return the free space for a ball between the parts that stand still and the paddles at rest."""
    lowest = _lowest_paddles(layout)
    grid = Grid.of(layout.board, creation_floor(layout))
    levels = tuple(sorted(layout.levels))
    free = _free(layout, grid, levels, 0.0)
    reached = _reached(layout, grid, levels, free)
    detail, detailed = 1, reached
    if layout.has_narrow_lanes:
        samples = max(1, free.size)
        detail = max(1, min(MAX_DETAIL, math.isqrt(MAX_SAMPLES // samples)))
        fine = grid.finer(detail)
        detailed = _reached(layout, fine, levels, _free(layout, fine, levels, math.sqrt(0.5) * fine.step))
        middle = slice(detail // 2, None, detail)
        reached |= free & detailed[:, middle, middle]
    swept = tuple(
        (*_pivot(paddle), moving_reach(paddle) + layout.board.ball_radius)
        for _, paddle in layout.moving()
        if paddle not in lowest and 0 in paddle.levels
    )
    return Space(grid, levels, free, reached, detail, detailed, swept)


def _free(layout: Layout, grid: Grid, levels: tuple[int, ...], slack: float) -> Bools:
    """The samples at which a ball overlaps nothing by more than a slack [u], [level, row, column]."""
    board = layout.board
    solids, polygons = layout.solids().joined(resting_pieces(layout)), layout.polygons()
    margin = board.wall_thickness + board.ball_radius - slack
    within = np.outer(grid.x <= 0.5 * board.length - margin, np.abs(grid.z) <= 0.5 * board.width - margin)
    radius = board.ball_radius - slack
    return np.stack(
        [
            within & ~_blocked(grid, solids.on_level(level), _polygons_on(polygons, level), radius)
            for level in levels
        ]
    )


def resting_pieces(layout: Layout) -> Pieces:
    """Return the pieces of the paddles at rest; their part is counted on from the parts that stand still."""
    paddles = layout.moving()
    resting = [
        (piece, len(layout.parts) + index, level_mask(paddle.levels))
        for index, (_, paddle) in enumerate(paddles)
        for piece in paddle_at(paddle, paddle.mover.rest_angle if paddle.mover else 0.0)
    ]
    return Pieces.of_pieces(resting)


def _polygons_on(polygons: Iterable[Polygon], level: int) -> list[Polygon]:
    return [polygon for polygon in polygons if polygon.levels >> level & 1]


def _blocked(grid: Grid, pieces: Pieces, polygons: list[Polygon], ball_radius: float) -> Bools:
    """The samples at which a ball overlaps a piece or lies in a polygon.

    In each row a convex piece blocks one interval of samples, which is added at its ends and summed up.
    """
    change = np.zeros((len(grid.x), len(grid.z) + 1), dtype=np.int32)
    radius = pieces.radius + ball_radius
    low = np.searchsorted(grid.x, pieces.core[..., 0].min(axis=1) - radius)
    high = np.searchsorted(grid.x, pieces.core[..., 0].max(axis=1) + radius)
    counts = high - low
    ends = np.cumsum(counts)
    piece_of = np.repeat(np.arange(len(counts)), counts)
    row_of = np.arange(len(piece_of)) - np.repeat(ends - counts, counts) + np.repeat(low, counts)
    for begin in range(0, len(piece_of), INTERVALS_AT_ONCE):
        piece, row = piece_of[begin : begin + INTERVALS_AT_ONCE], row_of[begin : begin + INTERVALS_AT_ONCE]
        first, last = _blocked_columns(grid, grid.x[row], pieces.core[piece], radius[piece])
        some = (first <= last) & (last >= 0) & (first < len(grid.z))
        np.add.at(change, (row[some], np.maximum(first[some], 0)), 1)
        np.add.at(change, (row[some], np.minimum(last[some] + 1, len(grid.z))), -1)
    for polygon in polygons:
        _add_polygon(change, grid, polygon.corners)
    blocked: Bools = np.cumsum(change[:, :-1], axis=1) > 0
    return blocked


def _blocked_columns(grid: Grid, x: Floats, core: Floats, radius: Floats) -> tuple[Indices, Indices]:
    """The first and the last column that convex pieces block in rows, shape [pair] each.

    The outline of an inflated core is made of circles around its points and of its edges, moved outwards.
    Both ends of an interval lie on one of them, and no point of them lies beyond an end.
    """
    rise = x[:, None] - core[..., 0]
    square = radius[:, None] ** 2 - rise**2
    half = np.sqrt(np.where(square >= 0.0, square, np.nan))
    out = outward_normals(core) * radius[:, None, None]
    start, end = core + out, core[:, [1, 2, 0]] + out
    length = end[..., 0] - start[..., 0]
    share = (x[:, None] - start[..., 0]) / np.where(length == 0.0, np.nan, length)
    share[~((share >= 0.0) & (share <= 1.0))] = np.nan
    edge = start[..., 1] + share * (end[..., 1] - start[..., 1])
    ends = np.concatenate([core[..., 1] - half, core[..., 1] + half, edge], axis=1)
    is_met = np.isfinite(ends).any(axis=1)
    low = np.where(np.isnan(ends), np.inf, ends).min(axis=1)
    high = np.where(np.isnan(ends), -np.inf, ends).max(axis=1)
    bounds = []
    for edge_of, towards in ((low, 1), (high, -1)):
        column = np.where(is_met, (edge_of - grid.z[0]) / grid.step, -1.0 if towards < 0 else 0.0)
        column = np.clip(column, -2.0, len(grid.z) + 1.0)
        nearest = np.rint(column)
        inner = np.where(towards > 0, np.ceil(column), np.floor(column)).astype(np.int64)
        is_tie = (np.abs(column - nearest) < TIE) & (nearest >= 0) & (nearest < len(grid.z)) & is_met
        tie = np.nonzero(is_tie)[0]
        if len(tie):
            at = nearest[tie].astype(np.int64)
            inner[tie] = np.where(_overlaps(x[tie], grid.z[at], core[tie], radius[tie]), at, at + towards)
        bounds.append(inner)
    return bounds[0], bounds[1]


def _overlaps(x: Floats, z: Floats, core: Floats, radius: Floats) -> Bools:
    """Whether points are nearer to cores than radii, bool [point]."""
    overlaps = np.zeros(len(x), dtype=bool)
    inside = np.ones(len(x), dtype=bool)
    for edge in range(3):
        (ax, az), (bx, bz) = core[:, edge].T, core[:, (edge + 1) % 3].T
        dx, dz = bx - ax, bz - az
        square = dx * dx + dz * dz
        along = np.clip(((x - ax) * dx + (z - az) * dz) / np.where(square == 0.0, 1.0, square), 0.0, 1.0)
        overlaps |= (x - ax - along * dx) ** 2 + (z - az - along * dz) ** 2 < radius * radius
        inside &= dz * (x - ax) - dx * (z - az) > 0.0
    return np.asarray(overlaps | inside)


def _add_polygon(change: NDArray[np.int32], grid: Grid, corners: Floats) -> None:
    """Add the samples inside a polygon: in each row, between every other pair of its crossings."""
    start, end = corners, np.roll(corners, -1, axis=0)
    rows = slice(*np.searchsorted(grid.x, [corners[:, 0].min(), corners[:, 0].max()]).tolist())
    x = grid.x[rows, None]
    row, edge = np.nonzero((start[:, 0] > x) != (end[:, 0] > x))
    share = (x[row, 0] - start[edge, 0]) / (end[edge, 0] - start[edge, 0])
    z = start[edge, 1] + share * (end[edge, 1] - start[edge, 1])
    order = np.lexsort((z, row))
    column = np.searchsorted(grid.z, z[order])
    sign = np.where(np.arange(len(order)) % 2 == 0, 1, -1)  # every row has an even number of crossings
    np.add.at(change, (row[order] + rows.start, column), sign)


class _Crossing(NamedTuple):
    """A line or gate that balls cross: its ends, half its width [u], and the links over it.

    Each link is (level, side) → (level, side); side 1 is the left of start → end, side −1 the right.
    """

    start: Point
    end: Point
    half_width: float
    is_cut: bool
    links: tuple[tuple[tuple[int, int], tuple[int, int]], ...]


def _crossings(layout: Layout, grid: Grid) -> list[_Crossing]:
    """The lines and gates of a table."""
    found = []
    for part in layout.parts:
        for p in part.primitives:
            if p.passage is not None and p.shape is Shape.LINE:
                before, after = p.passage
                links = (
                    ((before, -1), (after, 1)), ((after, 1), (before, -1)),
                    ((before, 1), (before, -1)), ((after, -1), (after, 1)),
                )  # fmt: skip
                found.append(_Crossing(p.points[0], p.points[1], CUT * grid.step, True, links))
            elif p.shape is Shape.CAPSULE and (p.one_way is not None or p.bank is not None or p.is_gate):
                (ax, az), (bx, bz) = p.points
                sides = [(-1, 1), (1, -1)]
                if p.one_way is not None:
                    # (dx, dz) to the left of start → end is (b − a) turned counter-clockwise.
                    to_left = (bz - az) * p.one_way[0] - (bx - ax) * p.one_way[1]
                    sides = [(-1, 1)] if to_left > 0.0 else [(1, -1)]
                gates = tuple(((level, one), (level, other)) for level in p.levels for one, other in sides)
                width = p.radius + layout.board.ball_radius
                found.append(_Crossing(p.points[0], p.points[1], width, False, gates))
    return found


def _reached(layout: Layout, grid: Grid, levels: tuple[int, ...], free: Bools) -> Bools:
    """The free samples from which a ball gets to the gutter or into a drain."""
    if free.size == 0:
        return free.copy()
    index = {level: i for i, level in enumerate(levels)}
    crossings = _crossings(layout, grid)
    open_ = free.copy()
    for crossing in crossings:
        if crossing.is_cut:
            rows, columns, across = _beside(grid, crossing, 0.0)
            for level in {level for link in crossing.links for level, _ in link} & index.keys():
                open_[index[level], rows, columns] &= ~(np.abs(across) <= crossing.half_width)
    runs, neighbours = _runs(open_)
    # Of each run, the runs and links from which it is entered; of each link, which is negative, the same.
    sources: dict[int, set[int]] = defaultdict(set)
    link = 0
    for crossing in crossings:
        rows, columns, across = _beside(grid, crossing, BESIDE * grid.step)
        far = np.abs(across) <= crossing.half_width + BESIDE * grid.step
        for (level, side), (to_level, to_side) in crossing.links:
            if level in index and to_level in index:
                link -= 1
                before = runs[index[level], rows, columns][far & (across * side > 0.0)]
                behind = runs[index[to_level], rows, columns][far & (across * to_side > 0.0)]
                sources[link] = set(before.tolist()) - {0}
                for run in set(behind.tolist()) - {0}:
                    sources[run].add(link)
    out = set(np.unique(runs[:, 0]).tolist())
    for part in layout.parts:
        for p in part.primitives:
            if p.hold is None:
                continue
            inside: set[int] = set()
            for level in set(p.levels) & index.keys():
                inside |= _runs_near(runs[index[level]], grid, p.points[0], max(p.radius, grid.step))
            if p.hold.is_drain:
                out |= inside
            elif p.hold.exit_level in index:
                for run in _runs_near(runs[index[p.hold.exit_level]], grid, p.hold.exit, 2.0 * grid.step):
                    sources[run] |= inside
    found = _closure(out - {0}, neighbours, sources)
    is_found = np.zeros(int(runs.max()) + 1, dtype=bool)
    is_found[[run for run in found if run > 0]] = True
    return is_found[runs]


def _closure(start: set[int], neighbours: dict[int, list[int]], sources: dict[int, set[int]]) -> set[int]:
    """All runs that lead to some runs."""
    found = set(start)
    front = list(found)
    while front:
        before = {run for known in front for run in (*neighbours.get(known, ()), *sources.get(known, ()))}
        front = list(before - found)
        found.update(front)
    return found


def _beside(grid: Grid, crossing: _Crossing, margin: float) -> tuple[slice, slice, Floats]:
    """The window around a line, and the signed distance of its samples, positive to the left.

    Samples that do not lie beside the line are infinitely far from it.
    """
    (ax, az), (bx, bz) = crossing.start, crossing.end
    reach = crossing.half_width + margin
    rows, columns = grid.window(
        (min(ax, bx) - reach, min(az, bz) - reach), (max(ax, bx) + reach, max(az, bz) + reach)
    )
    length = math.hypot(bx - ax, bz - az) or 1.0
    along_x, along_z = (bx - ax) / length, (bz - az) / length
    x, z = grid.x[rows, None] - ax, grid.z[None, columns] - az
    along = x * along_x + z * along_z
    beside = (along >= -grid.step) & (along <= length + grid.step)
    return rows, columns, np.where(beside, along_z * x - along_x * z, np.inf)


def _runs_near(runs: NDArray[np.int32], grid: Grid, point: Point, radius: float) -> set[int]:
    """The runs with a sample within a radius [u] of a point."""
    x, z = point
    rows, columns = grid.window((x - radius, z - radius), (x + radius, z + radius))
    near = (grid.x[rows, None] - x) ** 2 + (grid.z[None, columns] - z) ** 2 <= radius * radius
    return set(runs[rows, columns][near].tolist()) - {0}


def _runs(free: Bools) -> tuple[NDArray[np.int32], dict[int, list[int]]]:
    """Number the runs of adjacent free samples of all rows, and find which runs of adjacent rows touch.

    The runs make a graph that is small enough to traverse in Python.

    Returns:
        The number of the run of each sample, 0 where none is free, shape [level, row, column]; and the
        neighbours of each run.
    """
    begins = free.copy()
    begins[..., 1:] &= ~free[..., :-1]
    runs = np.where(free, np.cumsum(begins, dtype=np.int32).reshape(free.shape), 0)
    neighbours: dict[int, list[int]] = defaultdict(list)
    lower, upper = runs[:, :-1], runs[:, 1:]
    for low, high in (
        (lower, upper),
        (lower[..., :-1], upper[..., 1:]),
        (lower[..., 1:], upper[..., :-1]),
    ):
        for one, other in _touching(low, high):
            neighbours[one].append(other)
            neighbours[other].append(one)
    return runs, neighbours


def _touching(low: NDArray[np.int32], high: NDArray[np.int32]) -> list[tuple[int, int]]:
    """The pairs of runs that touch, most of them once."""
    pair = (low > 0) & (high > 0)
    pair[..., 1:] &= (low[..., 1:] != low[..., :-1]) | (high[..., 1:] != high[..., :-1])
    return list(zip(low[pair].tolist(), high[pair].tolist(), strict=True))
