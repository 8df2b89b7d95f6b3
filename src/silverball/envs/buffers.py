"""Output arrays of steps, reused once the caller no longer references them.

The results of a step must not change while the caller still holds them. A step therefore writes to new
arrays, or to those of an earlier step that are no longer referenced: first touching new memory takes longer
than drawing a picture.
"""

from __future__ import annotations

from sys import getrefcount
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs.pointers import OUTPUTS

MAX_TRACKED = 4  # outputs that may be reused


class StepOutput:
    """The arrays of one step's results.

    Attributes:
        arrays: Arrays by the names of `OUTPUTS`.
        observations, rewards, terminated, truncated, counts, frames, copies: The same arrays, as attributes.
        addresses: Addresses of the arrays, int64 [array].
        infos: Each count by its name, as a view [env], with Gymnasium's mask, which is True everywhere.
    """

    observations: NDArray[np.float32]
    rewards: NDArray[np.float64]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]
    counts: NDArray[np.int64]
    frames: NDArray[np.uint8]
    copies: NDArray[np.uint8]

    def __init__(
        self,
        arrays: dict[str, NDArray[Any]],
        returned: tuple[str, ...],
        info: tuple[str, ...],
        all_true: NDArray[np.bool_],
    ) -> None:
        self.arrays = arrays
        vars(self).update(arrays)
        self.addresses = np.array([arrays[name].ctypes.data for name in OUTPUTS], np.int64)
        self.infos: dict[str, Any] = {}
        for name, row in zip(info, self.counts.T, strict=True):
            self.infos[name], self.infos[f"_{name}"] = row, all_true
        self._returned = [*(arrays[name] for name in returned), *(self.infos[name] for name in info)]
        del row
        self._own_references = list(map(getrefcount, self._returned))

    def is_unreferenced(self) -> bool:
        """Whether nothing else refers to the returned arrays; their views and tensors count as references."""
        return list(map(getrefcount, self._returned)) == self._own_references

    def infos_copy(self) -> dict[str, Any]:
        """The infos of a step of all environments, as a new dict."""
        infos = self.infos.copy()
        infos["stalled"] = infos["stalled"] != 0
        return infos


class OutputPool:
    """The outputs of an engine's steps.

    Attributes:
        last: The output of the last step.
    """

    def __init__(
        self, first: dict[str, NDArray[Any]], returned: tuple[str, ...], info: tuple[str, ...]
    ) -> None:
        """Start with these arrays; a step returns those named in `returned`, counts by the names `info`."""
        self._returned, self._info = returned, info
        self._all_true = np.ones(len(first["rewards"]), np.bool_)
        self._all_true.flags.writeable = False
        self.last = StepOutput(first, returned, info, self._all_true)
        self._tracked = [self.last]

    def advance(self) -> None:
        """Set `last` to an unreferenced output, or to a new one."""
        for output in self._tracked:
            if output.is_unreferenced():
                self.last = output
                return
        arrays = {
            name: np.empty_like(array) if name in self._returned else array
            for name, array in self.last.arrays.items()
        }
        self.last = StepOutput(arrays, self._returned, self._info, self._all_true)
        self._tracked = [*self._tracked[-MAX_TRACKED + 1 :], self.last]

    def replace(self, **arrays: NDArray[Any]) -> None:
        """Replace some of the arrays that steps write to."""
        self.last = StepOutput(self.last.arrays | arrays, self._returned, self._info, self._all_true)
        self._tracked = [self.last]
