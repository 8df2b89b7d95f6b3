"""Networks whose sums are exact, so that they answer the same on every machine.

All numbers are multiples of 1/SCALE, their products multiples of 1/SCALE², and no sum comes near 2⁵³/SCALE²
(tests add up the greatest possible ones). So it does not matter in which order a library adds.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

SCALE = 4096  # weights and values are rounded to multiples of 1/SCALE
MAX_WEIGHT = 2**17  # greatest weight, in multiples of 1/SCALE
ROWS = 64  # rows evaluated at once; for more a BLAS starts threads, which mostly wait
SQUARINGS = 10  # of a number near 1, for a power of e

Layer = tuple[NDArray[np.int32], NDArray[np.int32]]
"""Weights [in, out] and biases [out], in multiples of 1/SCALE."""


class ExactLayers:
    """A few layers with ReLU between them.

    Args:
        layers: From `inputs` numbers to `outputs` numbers.
        inputs: Numbers that go in.
        outputs: Numbers that come out.

    Raises:
        ValueError: The layers do not fit each other, or hold anything but small 32-bit integers.
    """

    def __init__(self, layers: list[Layer], inputs: int, outputs: int) -> None:
        widths = [inputs, *(weights.shape[-1] for weights, _ in layers)]
        shapes = [
            (weights.shape, biases.shape) == ((before, after), (after,))
            for (weights, biases), before, after in zip(layers, widths, widths[1:], strict=False)
        ]
        if not all(shapes) or widths[-1] != outputs:
            raise ValueError(
                f"the layers have {widths} numbers, expected {inputs} at first, {outputs} at last"
            )
        if any(part.dtype != np.int32 for layer in layers for part in layer):
            raise ValueError("its numbers are not 32-bit integers")
        if any(np.abs(part).max() > MAX_WEIGHT for layer in layers for part in layer):
            raise ValueError(f"a number is beyond ±{MAX_WEIGHT / SCALE:g}")
        self._exact = [(weights / SCALE, biases / SCALE) for weights, biases in layers]

    def best(self, values: NDArray[np.float64]) -> NDArray[np.int64]:
        """The number of the greatest output for each row of inputs [row, input]."""
        found: NDArray[np.int64] = self.outputs(values).argmax(axis=1)
        return found

    def drawn(
        self, values: NDArray[np.float64], chance: NDArray[np.float64], sharpness: float
    ) -> NDArray[np.int64]:
        """The number of an output for each row of inputs [row, input]: drawn, the likelier the greater it is.

        Args:
            values: The inputs.
            chance: Random numbers from 0 to below 1 [row].
            sharpness: An output that is greater by 1 is e to this power times as likely.
        """
        outputs = self.outputs(values)
        below = (outputs - outputs.max(axis=1, keepdims=True)) * sharpness
        shares = np.cumsum(_power_of_e(below), axis=1)
        found: NDArray[np.int64] = (shares <= chance[:, None] * shares[:, -1:]).sum(axis=1)
        return found

    def outputs(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The outputs for each row of inputs [row, input]."""
        pieces = [self._few_outputs(values[first : first + ROWS]) for first in range(0, len(values), ROWS)]
        return np.concatenate(pieces) if pieces else np.zeros((0, self._exact[-1][1].shape[0]))

    def _few_outputs(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        for number, (weights, biases) in enumerate(self._exact):
            if number > 0:
                values = np.maximum(values, 0.0)
            values = np.rint(values * SCALE) / SCALE @ weights + biases
        return values


def _power_of_e(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """About e to the power of numbers ≤ 0, by products alone: those have the same bits on every machine."""
    found = np.maximum(1.0 + values / 2.0**SQUARINGS, 0.0)
    for _ in range(SQUARINGS):
        found = found * found
    return found


def rounded_layers(layers: list[tuple[Any, Any]]) -> list[Layer]:
    """Floating-point layers, rounded."""
    clipped = [
        tuple(
            np.clip(np.rint(np.asarray(part) * SCALE), -MAX_WEIGHT, MAX_WEIGHT).astype(np.int32)
            for part in one
        )
        for one in layers
    ]
    return cast(list[Layer], clipped)


def read_layers(file: Any) -> list[Layer]:
    """The layers in an open .npz file."""
    count = len([name for name in file.files if name.startswith("weights")])
    return [(file[f"weights{number}"], file[f"biases{number}"]) for number in range(count)]


def arrays_of(layers: list[Layer]) -> dict[str, Any]:
    """The layers as arrays for a .npz file."""
    arrays: dict[str, Any] = {}
    for number, (weights, biases) in enumerate(layers):
        arrays[f"weights{number}"], arrays[f"biases{number}"] = weights, biases
    return arrays
