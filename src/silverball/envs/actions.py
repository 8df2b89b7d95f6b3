"""Actions: their space, and conversions between button bits, numbers and pressed keys."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.options import Options

KEYS = {
    "left": "a", "right": "d", "jitter": "z", "nudge_left": "z", "nudge_right": "x", "nudge_up": "w",
    "create": " ", "launch": "\r",
}  # fmt: skip
"""The key of each button, as in the window; only the arrow of a nudge up is none that `play` knows."""


def action_space(options: Options, buttons: tuple[str, ...]) -> spaces.Space[Any]:
    """The space of one environment's actions with these buttons."""
    count = len(buttons)
    return spaces.MultiBinary(count) if options.actions == "multibinary" else spaces.Discrete(1 << count)


def as_array(actions: Any) -> NDArray[Any]:
    """Actions of any type as an array."""
    try:
        return np.asarray(actions)
    except ValueError:  # rows of different lengths
        return np.asarray(actions, object)


def as_bits(actions: NDArray[Any]) -> NDArray[np.bool_] | None:
    """Actions as bits; None if one is neither 0 nor 1. Any dtype is accepted, like by `MultiBinary`."""
    bits: NDArray[np.bool_] = actions == 1
    return bits if np.all(np.logical_or(actions == 0, bits)) else None


def meanings(buttons: tuple[str, ...]) -> list[str]:
    """The buttons of each discrete action in capitals: NOOP, LEFT, RIGHT, LEFT+RIGHT and so on."""
    names = [name.upper() for name in buttons]
    codes = range(1 << len(names))
    held = [[name for bit, name in enumerate(names) if code >> bit & 1] for code in codes]
    return ["+".join(those) or "NOOP" for those in held]


def keys_to_action(options: Options, buttons: tuple[str, ...]) -> dict[tuple[str, ...], Any]:
    """The action of every set of pressed keys, for `gymnasium.utils.play`.

    The empty set is omitted: `play` does not expect it and uses 0 instead, which holds no button.
    """
    found: dict[tuple[str, ...], Any] = {}
    for bits in product((0, 1), repeat=len(buttons)):
        keys = tuple(KEYS[name] for name, bit in zip(buttons, bits, strict=True) if bit)
        code = sum(bit << position for position, bit in enumerate(bits))
        if keys:
            found[keys] = np.array(bits, np.int8) if options.actions == "multibinary" else code
    return found
