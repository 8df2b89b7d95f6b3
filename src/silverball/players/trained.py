"""The trained player: a small neural network, trained on random boards, chooses the buttons.

`examples/train_sb3.py` trains it. This module holds its weights and evaluates it, with NumPy alone.

All sums are exact, so the player presses the same on every machine, whatever the order in which a library
adds: all numbers are multiples of 1/SCALE, their products multiples of 1/SCALE², and no sum comes near
2⁵³/SCALE² (a test adds up the greatest possible ones).
"""

from __future__ import annotations

import zipfile
from functools import cache
from importlib import resources
from os import PathLike
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from silverball.errors import SilverballError
from silverball.physics.records import LEFT, RIGHT, BoardRecord, Colliders, Part
from silverball.players.features import ENCODED, MIRRORED, Rows, encode, first_paddles, raw_features
from silverball.world import World, WorldBatch

SCALE = 4096  # weights and values are rounded to multiples of 1/SCALE
MAX_WEIGHT = 2**17  # greatest weight, in multiples of 1/SCALE
DECISIONS = 15  # decisions per second
ACTIONS = 4  # none, left, right, both
ROWS = 64  # rows evaluated at once; for more a BLAS starts threads, which mostly wait

Layer = tuple[NDArray[np.int32], NDArray[np.int32]]
"""Weights [in, out] and biases [out], in multiples of 1/SCALE."""


class Policy:
    """A network of a few layers with ReLU between them; it presses the action with the largest output.

    Args:
        layers: From ENCODED features to ACTIONS outputs.
        command: The command that trained it.

    Raises:
        ValueError: The layers do not fit each other, or hold anything but small 32-bit integers.
    """

    def __init__(self, layers: list[Layer], command: str = "") -> None:
        widths = [ENCODED, *(weights.shape[-1] for weights, _ in layers)]
        shapes = [
            (weights.shape, biases.shape) == ((before, after), (after,))
            for (weights, biases), before, after in zip(layers, widths, widths[1:], strict=False)
        ]
        if not all(shapes) or widths[-1] != ACTIONS:
            raise ValueError(
                f"the layers have {widths} numbers, expected {ENCODED} at first, {ACTIONS} at last"
            )
        if any(part.dtype != np.int32 for layer in layers for part in layer):
            raise ValueError("its numbers are not 32-bit integers")
        if any(np.abs(part).max() > MAX_WEIGHT for layer in layers for part in layer):
            raise ValueError(f"a number is beyond ±{MAX_WEIGHT / SCALE:g}")
        self.layers, self.command = layers, command
        self._exact = [(weights / SCALE, biases / SCALE) for weights, biases in layers]

    @classmethod
    def rounded(cls, layers: list[tuple[Any, Any]], command: str = "") -> Policy:
        """A policy of floating-point layers, rounded."""
        clipped = [
            tuple(
                np.clip(np.rint(np.asarray(part) * SCALE), -MAX_WEIGHT, MAX_WEIGHT).astype(np.int32)
                for part in one
            )
            for one in layers
        ]
        return cls(cast(list[Layer], clipped), command)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Policy:
        """Read a policy from a file that `save` has written.

        Raises:
            SilverballError: The file cannot be read, or is not a policy.
        """
        try:
            with np.load(path, allow_pickle=False) as file:
                count = len([name for name in file.files if name.startswith("weights")])
                layers = [(file[f"weights{number}"], file[f"biases{number}"]) for number in range(count)]
                return cls(layers, str(file["command"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, IndexError, TypeError) as error:
            raise SilverballError(
                f"{path} is not a policy written by `examples/train_sb3.py --policy`: {error}"
            ) from None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the policy to a file, whose name ends in .npz."""
        arrays: dict[str, Any] = {"command": np.array(self.command)}
        for number, (weights, biases) in enumerate(self.layers):
            arrays[f"weights{number}"], arrays[f"biases{number}"] = weights, biases
        np.savez_compressed(path, **arrays)

    def actions(self, raw: Rows) -> NDArray[np.int64]:
        """The actions for raw features [row, Raw]: bits [row], 1 left, 2 right."""
        bits = np.zeros(len(raw), np.int64)
        for first in range(0, len(raw), ROWS):
            bits[first : first + ROWS] = self._few_actions(raw[first : first + ROWS])
        return bits

    def _few_actions(self, raw: Rows) -> NDArray[np.int64]:
        values, is_mirrored = encode(raw)
        for number, (weights, biases) in enumerate(self._exact):
            if number > 0:
                values = np.maximum(values, 0.0)
            values = np.rint(values * SCALE) / SCALE @ weights + biases
        chosen: NDArray[np.int64] = values.argmax(axis=1)
        return np.where(is_mirrored, MIRRORED[chosen], chosen)


@cache
def stored_policy() -> Policy:
    """The policy that comes with the program."""
    with resources.as_file(resources.files("silverball.players") / "trained.npz") as path:
        return Policy.load(path)


def ticks_per_decision(tick_rate: int) -> int:
    """Ticks between two decisions."""
    return max(1, round(tick_rate / DECISIONS))


class Trained:
    """The trained player for a single world.

    It has no state of its own: between two decisions it holds what the paddles are commanded, so a game can
    be continued from any snapshot.

    Args:
        policy: The network; None: the one that comes with the program.
    """

    name = "trained"

    def __init__(self, policy: Policy | None = None) -> None:
        self._policy = policy or stored_policy()

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        state, board, colliders = world.records
        if world.tick % ticks_per_decision(world.tick_rate) != 0:
            return is_lifted(state, board, colliders, LEFT), is_lifted(state, board, colliders, RIGHT)
        bits = int(self._policy.actions(raw_features(np.array([state]), np.array([board]), colliders))[0])
        return bits & 1 != 0, bits & 2 != 0


def is_lifted(state: Any, board: BoardRecord, colliders: Colliders, button: int) -> bool:
    """Whether the paddles of a button, LEFT or RIGHT, are commanded to be up."""
    number = int(first_paddles(np.array([board]), colliders, button)[0])
    if number < 0:
        return False
    collider = colliders[board["collider_first"] + Part.FIRST_PADDLE + number]
    commanded = state["paddle"][number]["angle_commanded"]
    return bool(commanded == collider["angle_up"] != collider["angle_rest"])


def press_batch(batch: WorldBatch, policy: Policy | None = None) -> NDArray[np.bool_]:
    """The buttons (left, right) to hold until the next decision in every world, bool [world, 2]."""
    boards = batch.boards
    raw = raw_features(batch.state, boards.board[batch.board_of], boards.collider)
    bits = (policy or stored_policy()).actions(raw)
    return np.stack((bits & 1 != 0, bits & 2 != 0), axis=1)
