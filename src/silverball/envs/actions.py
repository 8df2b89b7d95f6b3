"""Which numbers are actions, and what do they hold? For one environment, for many, and for people's keys."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs.options import Options

KEYS = {"left": "a", "right": "d", "jitter": "z", "create": " "}
"""The key of each button, as in the window."""

LARGEST = 1024.0  # a float above it is no action; float16 can hold it


def as_whole(given: NDArray[Any], *, floats: bool) -> NDArray[np.int64] | None:
    """Actions as whole numbers; None where they are not.

    Args:
        given: Actions of any type and shape.
        floats: Whether floats will do, as in `MultiBinary`, which trainers hand such bits.
    """
    if given.dtype.kind in "iub":
        return given.astype(np.int64, copy=False)
    if (
        not floats
        or given.dtype.kind != "f"
        or not (given == np.floor(given)).all()
        or (abs(given) > LARGEST).any()
    ):
        return None
    return given.astype(np.int64)


def keys_to_action(options: Options) -> dict[tuple[str, ...], Any]:
    """For each set of pressed keys the action that holds their buttons, for `gymnasium.utils.play`."""
    buttons = options.buttons
    found: dict[tuple[str, ...], Any] = {}
    for bits in product((0, 1), repeat=len(buttons)):
        keys = tuple(KEYS[name] for name, bit in zip(buttons, bits, strict=True) if bit)
        code = sum(bit << place for place, bit in enumerate(bits))
        found[keys] = np.array(bits, np.int8) if options.actions == "multibinary" else code
    return found
