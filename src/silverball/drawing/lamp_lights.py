"""The lamps of a table in its picture: the baked playfield, with the light of each lamp added by its level.

The picture is kept from frame to frame and divided into tiles; a tile is lit anew when one of the lamps that
shine on it has changed. So a frame in which nothing changes costs nothing, and one in which all lamps do
costs each pixel once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels.patches import TILE, relight
from silverball.drawing.kernels.stage import Box
from silverball.drawing.pictures import AddedLight, BakedTable

FULL = 256  # the level of a lamp that is fully on


class LampLights:
    """The playfield with its lamps.

    Args:
        baked: The playfield without moving parts.

    Attributes:
        pixels: The playfield with the lamps at their last levels, RGB, uint8 [row, column, 3].
    """

    def __init__(self, baked: BakedTable) -> None:
        self.pixels = baked.pixels.copy() if baked.lamps else baked.pixels
        rows, columns = baked.pixels.shape[:2]
        self._still = baked.pixels.reshape(rows, 3 * columns)
        self._lit = self.pixels.reshape(rows, 3 * columns)
        self._changed = np.zeros(tile_shape(baked), np.uint8)
        self._tiles = lamp_tiles(baked.lamps, self._changed.shape)
        self._boxes = lamp_boxes(baked.lamps)
        self._light = np.concatenate([np.zeros(0, np.uint8), *(lamp.pixels.ravel() for lamp in baked.lamps)])
        self._levels = np.zeros((2, len(baked.lamps)), np.int64)

    def update(self, levels: NDArray[np.float64]) -> list[Box]:
        """Set the lamps to levels from 0 to 1; return the boxes of the pixels that have changed."""
        if not len(levels):
            return []
        before, now = self._levels
        before[:] = now
        np.rint(FULL * levels, out=now, casting="unsafe")
        if (before == now).all():
            return []
        relight(self._still, self._lit, self._tiles, self._boxes, self._light, self._levels, self._changed)
        return list(_runs(self._changed))


def tile_shape(baked: BakedTable) -> tuple[int, int]:
    """Return how many rows and columns of tiles a playfield has."""
    rows, columns = baked.pixels.shape[:2]
    return -(-rows // TILE), -(-columns // TILE)


def lamp_boxes(lamps: Sequence[AddedLight]) -> NDArray[np.int64]:
    """Return the BOX rows of the lamps, see `relight`."""
    boxes = np.zeros((len(lamps), 5), np.int64)
    start = 0
    for row, lamp in zip(boxes, lamps, strict=True):
        row[:] = (lamp.left, lamp.top, *lamp.pixels.shape[:2], start)
        start += lamp.pixels.size
    return boxes


def lamp_tiles(lamps: Sequence[AddedLight], shape: tuple[int, ...]) -> NDArray[np.int32]:
    """Return for each tile, and once more for the end, where its list begins; then the lists of lamps."""
    listed: list[list[int]] = [[] for _ in range(shape[0] * shape[1])]
    for number, lamp in enumerate(lamps):
        rows, columns = lamp.pixels.shape[:2]
        if rows and columns:
            for i in range(lamp.top // TILE, (lamp.top + rows - 1) // TILE + 1):
                for j in range(lamp.left // TILE, (lamp.left + columns - 1) // TILE + 1):
                    listed[i * shape[1] + j].append(number)
    starts = len(listed) + 1 + np.cumsum([0, *(len(numbers) for numbers in listed)])
    return np.concatenate([starts, *(np.array(numbers, np.int64) for numbers in listed)]).astype(np.int32)


def _runs(changed: NDArray[np.uint8]) -> Iterator[Box]:
    """Yield boxes [pixel] that cover the changed tiles, each once: runs of a row, continued downwards."""
    padded = np.zeros((changed.shape[0] + 1, changed.shape[1] + 2), np.int8)
    padded[:-1, 1:-1] = changed
    rows, edges = np.nonzero(padded[:, 1:] != padded[:, :-1])  # where runs begin, and where they end
    found: list[set[tuple[int, int]]] = [set() for _ in padded]
    for number, first, end in zip(rows[::2].tolist(), edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        found[number].add((first, end))
    open_runs: dict[tuple[int, int], int] = {}  # the runs of the row above, and where they began
    for number, runs in enumerate(found):
        for run in [run for run in open_runs if run not in runs]:
            yield run[0] * TILE, open_runs.pop(run) * TILE, run[1] * TILE, number * TILE
        for run in runs:
            open_runs.setdefault(run, number)
