"""Which numbers are actions, and what do they hold? For one environment, for many, and for people's keys."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs.options import Options

KEYS = {"left": "a", "right": "d", "jitter": "z", "create": " "}
"""The key of each button, as in the window."""


def as_array(given: Any) -> NDArray[Any]:
    """Actions as an array, whatever they are."""
    try:
        return np.asarray(given)
    except ValueError:  # rows of different lengths
        return np.asarray(given, object)


def as_bits(given: NDArray[Any]) -> NDArray[np.bool_] | None:
    """The bits, if all are 0 or 1; of any type, floats too, as `MultiBinary` has it."""
    on: NDArray[np.bool_] = given == 1
    return on if np.all(np.logical_or(given == 0, on)) else None


def keys_to_action(options: Options) -> dict[tuple[str, ...], Any]:
    """For each set of pressed keys the action that holds their buttons, for `gymnasium.utils.play`.

    Of no key at all `play` wants to hear nothing; it takes 0 then, which holds no button.
    """
    buttons = options.buttons
    found: dict[tuple[str, ...], Any] = {}
    for bits in product((0, 1), repeat=len(buttons)):
        keys = tuple(KEYS[name] for name, bit in zip(buttons, bits, strict=True) if bit)
        code = sum(bit << place for place, bit in enumerate(bits))
        if keys:
            found[keys] = np.array(bits, np.int8) if options.actions == "multibinary" else code
    return found
