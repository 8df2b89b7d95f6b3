"""Who bakes? A few threads, some rows at a time, so that the work can be stopped at any moment.

Kernels let go of Python's lock, so a game goes on beside them; on Linux the threads also stand back behind
it.
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

ROWS = 4  # baked in one call: some 20 ms
NICENESS = 10  # of threads that bake behind a game


class BakeCancelled(Exception):
    """Nobody wants the picture any more."""


class BakeThreads:
    """Bakes, on some threads.

    Args:
        threads: How many; None: as many as there are processors.
        stop: When it is set, the work ends with `BakeCancelled`.
        progress: Told the share of the work that is done, 0 to 1.
        in_background: Whether a game is played meanwhile.
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
        """Say how many rows more there will be to bake, for the progress."""
        self._planned += rows

    def bake(self, scene: Scene, canvas: Canvas, inner: NDArray[np.bool_] | None = None) -> None:
        """Bake what a canvas' mask asks for, and refine it.

        Args:
            scene: What is seen.
            canvas: Where to.
            inner: The pixels to refine, if not all of the mask: a pixel is refined by the look of its
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
        """Call a kernel for the rows first … end − 1, a few at a time, on all threads.

        Raises:
            BakeCancelled: The picture is not wanted any more.
        """

        def some(row: int) -> None:
            if not self._stop.is_set():
                kernel(*arguments, row, min(row + ROWS, end))
                self._advance(min(ROWS, end - row))

        self._all(some, range(first, end, ROWS))

    def _all(self, task: Callable[[int], None], numbers: Iterable[int]) -> None:
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
    """Let this thread give way to all others. Only Linux can do that for a single thread."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)
