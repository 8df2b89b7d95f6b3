"""Which parts are near a place? The board in cells, each with the list of what is within a distance of it.

One array holds it: one number a cell and one more, where the list of that cell begins, then the lists.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.solids import footprint
from silverball.drawing.kernels.stage import Form
from silverball.physics.kernel import inlined, kernel


def list_cells(
    stage: NDArray[Any], looks: NDArray[Any], shapes: NDArray[Any], distance: float
) -> NDArray[np.int32]:
    """The lists of all cells, of the parts within a distance [u] of any point of the cell."""
    cells = int(stage[0]["rows"] * stage[0]["columns"])
    lists = np.zeros(cells + 1 + 8 * cells, np.int32)
    need = fill_cells(stage, looks, shapes, distance, lists)
    if need > len(lists):
        lists = np.zeros(need, np.int32)
        fill_cells(stage, looks, shapes, distance, lists)
    return lists[:need]


@kernel
def fill_cells(stage: Any, looks: Any, shapes: Any, distance: float, lists: Any) -> Any:
    """Write the lists as far as there is room; returns how many numbers they take."""
    s = stage[0]
    cells = s.rows * s.columns
    side = 1.0 / s.cell_scale
    reach = distance + 0.7072 * side  # half a cell's diagonal, rounded up
    end = cells + 1
    for cell in range(cells):
        x = s.low_x + (cell // s.columns + 0.5) * side
        z = s.low_z + (cell % s.columns + 0.5) * side
        lists[cell] = end
        for index in range(len(looks)):
            if looks[index].form != Form.ABSENT and footprint(looks[index], shapes[index], x, z) < reach:
                if end < len(lists):
                    lists[end] = index
                end += 1
    lists[cells] = end
    return end


@inlined
def cell_at(s: Any, x: float, z: float) -> Any:
    """The number of the cell that holds (x, z); of the nearest one beyond the board."""
    row = int((x - s.low_x) * s.cell_scale)
    column = int((z - s.low_z) * s.cell_scale)
    return min(max(row, 0), s.rows - 1) * s.columns + min(max(column, 0), s.columns - 1)
