"""Broad phase: cheap tests for which parts a ball can touch soon.

The grid cuts the board into cells. Each cell lists, in the order of the table, every part that a ball whose
centre is in the cell can touch before it has travelled `skin`. One array of 32-bit integers holds the grids
of all boards: for each board one offset a cell and one more, where the cell's list begins, then the lists.
Borders and paddles are not in the grid; they are tested by their coordinates.
"""

from __future__ import annotations

from silverball.physics.kernel import inlined, kernel
from silverball.physics.records import BallMotion, BoardRecord, ColliderRecord, Colliders, Grid
from silverball.physics.shapes import distance
from silverball.physics.tolerances import SPEED_MARGIN


@inlined
def cell_of(board: BoardRecord, x: float, z: float) -> int:
    """Compute the number of the cell that holds (x, z), or of the nearest cell if that is off the board."""
    row = int((x + board.half_length) * board.grid_scale)
    column = int((z + board.half_width) * board.grid_scale)
    row = min(max(row, 0), board.grid_rows - 1)
    column = min(max(column, 0), board.grid_columns - 1)
    return board.grid_first + row * board.grid_columns + column


@kernel
def fill_grid(board: BoardRecord, colliders: Colliders, grid: Grid) -> int:
    """Write a board's cells and lists into `grid` from `board.grid_first` on, as far as they fit.

    Returns:
        How many numbers the board's grid takes. If that is more than fit, call again with a larger array.
    """
    side = 1.0 / board.grid_scale
    reach = board.ball_radius + board.skin + 0.7072 * side  # half a cell's diagonal, rounded up
    cells = board.grid_rows * board.grid_columns
    end = board.grid_first + cells + 1
    for cell in range(cells):
        x = (cell // board.grid_columns + 0.5) * side - board.half_length
        z = (cell % board.grid_columns + 0.5) * side - board.half_width
        if board.grid_first + cell < len(grid):
            grid[board.grid_first + cell] = end
        for index in range(board.collider_first + board.shape_first, board.collider_end):
            gap, _, _ = distance(colliders[index], x, z)
            if gap < reach:
                if end < len(grid):
                    grid[end] = index - board.collider_first
                end += 1
    if board.grid_first + cells < len(grid):
        grid[board.grid_first + cells] = end
    return end - board.grid_first


@inlined
def is_culled(c: ColliderRecord, state: BallMotion, speed: float, travel: float, sagitta: float) -> bool:
    """Whether a ball certainly misses a part's bounding circle.

    `travel` [u] bounds the ball's path, `sagitta` [u] its deviation from the straight line. The line's
    distance from the circle's centre is  √(d² − (d·v)²/v²),  or d if the ball moves away.
    """
    dx, dz = state.x - c.x, state.z - c.z
    square = dx * dx + dz * dz
    if square > (c.reach + travel) * (c.reach + travel):
        return True
    outside = square - (c.reach + sagitta) * (c.reach + sagitta)
    toward = -(dx * state.vx + dz * state.vz)
    return outside > 0.0 and (toward <= 0.0 or outside * speed * speed > toward * toward)


@inlined
def is_near(x: float, z: float, px: float, pz: float, reach: float) -> bool:
    """Whether two points are closer to each other than a positive distance."""
    return (x - px) * (x - px) + (z - pz) * (z - pz) < reach * reach


@inlined
def max_travel(board: BoardRecord, start: float, end: float) -> float:
    """Bound a ball's travel [u] between two times of a tick [s] that it began below the speed cap."""
    return (end - start) * (board.speed_cap * SPEED_MARGIN + board.max_accel * end)
