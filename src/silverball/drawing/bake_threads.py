"""The threads that bake pictures, a few rows at a time, so that the work can be cancelled at any moment.

Kernels release Python's lock, so a game can run at the same time. On Linux the threads also get a lower
priority.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.kernels import bake
from silverball.drawing.kernels.bake import Canvas
from silverball.drawing.kernels.stage import Scene

ROWS = 4  # baked by one call, in about 20 ms
NICENESS = 10  # priority of threads that bake while a game is played


class BakeCancelled(Exception):
    """The picture is no longer wanted."""


class BakeThreads:
    """Bakes pictures on several threads.

    Args:
        threads: Number of threads; by default one for each processor.
        stop: Cancels the work when it is set: `bake` and `run_rows` then raise `BakeCancelled`.
        progress: Called with the share of the planned rows that is done, 0 to 1.
        in_background: Whether the threads run at low priority.
    """

    def __init__(
        self,
        threads: int | None = None,
        *,
        stop: threading.Event | None = None,
        progress: Callable[[float], None] = lambda share: None,
        in_background: bool = False,
    ) -> None:
        self._threads = threads or os.cpu_count() or 1
        self._stop = stop or threading.Event()
        self._lower_priority = lower_priority if in_background else (lambda: None)
        self.progress = progress
        self._done = self._planned = 0

    def plan(self, rows: int) -> None:
        """Add to the number of rows that the progress counts as the whole work."""
        self._planned += rows

    def bake(self, scene: Scene, canvas: Canvas, inner: NDArray[np.bool_] | None = None) -> None:
        """Bake the pixels of a canvas' mask, then refine those at edges.

        Args:
            scene: The table.
            canvas: Receives the picture.
            inner: The pixels to refine; by default all of the mask. Whether a pixel is refined depends on its
                neighbours, so a patch is baked one pixel wider than it is used.
        """
        rows = np.flatnonzero(canvas.mask.any(axis=1))
        if not len(rows):
            return
        first, end = int(rows[0]), int(rows[-1]) + 1
        self.rows(bake.bake_rows, (scene, canvas, canvas.shown, 1), first, end)
        refined = canvas if inner is None else canvas._replace(mask=inner)
        self.rows(bake.bake_rows, (scene, refined, canvas.shown.copy(), bake.FINE), first, end)

    def rows(self, kernel: Callable[..., None], arguments: tuple[Any, ...], first: int, end: int) -> None:
        """Call kernel(*arguments, first, end) for slices of the rows first … end − 1, on all threads.

        Raises:
            BakeCancelled: The work was cancelled.
        """

        def bake_slice(row: int) -> None:
            if not self._stop.is_set():
                kernel(*arguments, row, min(row + ROWS, end))
                self._advance(min(ROWS, end - row))

        self._map(bake_slice, range(first, end, ROWS))

    def _map(self, task: Callable[[int], None], numbers: Iterable[int]) -> None:
        if self._threads == 1:
            for number in numbers:
                task(number)
        else:
            with ThreadPoolExecutor(self._threads, "silverball bake", self._lower_priority) as pool:
                for _ in pool.map(task, numbers):
                    pass
        if self._stop.is_set():
            raise BakeCancelled

    def _advance(self, rows: int) -> None:
        self._done += rows
        if self._planned:
            self.progress(min(self._done / self._planned, 1.0))


def lower_priority() -> None:
    """Lower the priority of this thread. Only Linux can do that for a single thread."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)
