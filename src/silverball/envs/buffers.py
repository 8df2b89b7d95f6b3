"""Which arrays does a step write to, and when may they be written to again?

What a step has returned must stay as it is for as long as anybody can see it. So a step writes to new arrays,
or to those of an earlier step that nobody refers to any more: memory that is new to a program costs more
time than a picture.
"""

from __future__ import annotations

from sys import getrefcount
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs.spaces import INFO

WRITTEN = ("observations", "rewards", "terminated", "truncated", "counts", "frames", "copies")
"""The arrays that a step writes to, in the order of their addresses in ADDRESSES."""

MOST_HANDED_OUT = 4  # outputs that are looked after, in case that they come back


class Output:
    """The arrays of one step's results.

    Attributes:
        arrays: By the names of `WRITTEN`.
        observations, rewards, terminated, truncated, counts, frames, copies: The same.
        addresses: Where they are, int64 [array].
        infos: Each count by its name, a view [env], and where it holds: everywhere.
    """

    observations: NDArray[np.float32]
    rewards: NDArray[np.float64]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]
    counts: NDArray[np.int64]
    frames: NDArray[np.uint8]
    copies: NDArray[np.uint8]

    def __init__(
        self, arrays: dict[str, NDArray[Any]], handed_out: tuple[str, ...], everywhere: NDArray[np.bool_]
    ) -> None:
        self.arrays = arrays
        for name in WRITTEN:
            setattr(self, name, arrays[name])
        self.addresses = np.array([arrays[name].ctypes.data for name in WRITTEN], np.int64)
        self.infos: dict[str, Any] = {}
        for name, row in zip(INFO, self.counts.T, strict=True):
            self.infos[name], self.infos[f"_{name}"] = row, everywhere
        self._seen = [*(arrays[name] for name in handed_out), *(self.infos[name] for name in INFO)]
        del row
        self._holders = list(map(getrefcount, self._seen))

    def is_unheld(self) -> bool:
        """Whether nobody else refers to what a step returns; views and tensors of an array do."""
        return list(map(getrefcount, self._seen)) == self._holders

    def told(self) -> dict[str, Any]:
        """The infos of a step in which all environments took part, as a new dict."""
        infos = self.infos.copy()
        infos["stalled"] = infos["stalled"] != 0
        return infos


class Outputs:
    """The outputs of an engine's steps.

    Attributes:
        last: That of the last step.
    """

    def __init__(self, first: dict[str, NDArray[Any]], handed_out: tuple[str, ...]) -> None:
        """Begin with these arrays; those named in `handed_out` are what a step returns."""
        self._handed_out = handed_out
        self._everywhere = np.ones(len(first["rewards"]), np.bool_)
        self._everywhere.flags.writeable = False
        self.last = Output(first, handed_out, self._everywhere)
        self._kept = [self.last]

    def renew(self) -> None:
        """Let `last` be one that nobody else sees."""
        for output in self._kept:
            if output.is_unheld():
                self.last = output
                return
        arrays = {
            name: np.empty_like(array) if name in self._handed_out else array
            for name, array in self.last.arrays.items()
        }
        self.last = Output(arrays, self._handed_out, self._everywhere)
        self._kept = [*self._kept[-MOST_HANDED_OUT + 1 :], self.last]

    def replace(self, **arrays: NDArray[Any]) -> None:
        """Write to these arrays from now on."""
        self.last = Output(self.last.arrays | arrays, self._handed_out, self._everywhere)
        self._kept = [self.last]
