"""Trained policies from files, played with NumPy alone: convolutions, memory and layers in this order.

`examples/train_benchmark.py` and `examples/train_sb3_benchmark.py` write them. A file has the names

* `id`, `contestant`, `command`, `steps`, `seed`: what was trained, and how;
* `options`: what the policy sees, as JSON (see `SEEN`);
* `filters0`, `offsets0`, `stride0`, `filters1`, …: convolutions [out, in, row, column], each with a ReLU;
* `memory_inputs`, `memory_states`, `memory_offsets`, `memory_state_offsets`: a gated recurrent unit, as
  PyTorch's;
* `weights0` [in, out], `biases0`, `weights1`, …: layers with tanh between them.

Convolutions, memory and options may be absent. The greatest output is the action.
"""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from silverball.envs import Options
from silverball.errors import SilverballError

SEEN: Final = ("observation", "size", "stack", "rgb", "channels", "sight")
"""The options that a policy may bring along: they change what it sees, and not what is played."""

BROKEN = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, TypeError, IndexError)
Floats = NDArray[np.float32]


class StoredPolicy:
    """A network from observations to actions.

    Args:
        path: The file.

    Raises:
        SilverballError: The file cannot be read, or is not a policy.

    Attributes:
        id: The environment that it was trained on.
        contestant: The name of what was trained; files of one name are its trainings.
        options: Of its environment, those in `SEEN`.
        steps: Of its training.
        seed: Of its training.
        command: With which it was trained.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            if path.exists() and not zipfile.is_zipfile(path):
                raise ValueError("it is no .npz file")
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            self.id, self.command = str(arrays["id"]), str(arrays["command"])
            self.contestant = str(arrays["contestant"])
            self.steps, self.seed = int(arrays["steps"]), int(arrays["seed"])
            self.options: dict[str, Any] = dict(json.loads(str(arrays.get("options", "{}"))))
            Options.of(self.options)
            self._filters = [
                (_floats(one, 4), _floats(arrays[f"offsets{number}"], 1), int(arrays[f"stride{number}"]))
                for number, one in enumerate(_numbered(arrays, "filters"))
            ]
            self._memory = Memory(arrays) if "memory_inputs" in arrays else None
            self._layers = [
                (_floats(one, 2), _floats(arrays[f"biases{number}"], 1))
                for number, one in enumerate(_numbered(arrays, "weights"))
            ]
        except BROKEN as error:
            raise SilverballError(
                f"{path} is not a policy written by `examples/train_benchmark.py --out`: {error}"
            ) from None
        if not self._layers:
            raise SilverballError(f"{path} has no layers that numbers can go through")
        others = [name for name in self.options if name not in SEEN]
        if others:
            raise SilverballError(f"{path} sets the option {others[0]!r}; expected one of {', '.join(SEEN)}")

    def __call__(self, envs: Any) -> StoredPlayer:
        """Play in these environments.

        Raises:
            SilverballError: Their observations or actions are not those that it was trained on.
        """
        player = StoredPlayer(self, envs.num_envs)
        shape, actions = envs.single_observation_space.shape, int(envs.single_action_space.n)
        try:
            outputs = self.outputs(np.zeros((envs.num_envs, *shape), np.float32), player.state)[0].shape[1]
        except ValueError:
            outputs = 0
        if outputs != actions:
            raise SilverballError(
                f"{self._path} was trained on {self.id}; it does not take observations of the shape {shape} "
                f"and give {actions} actions, as this environment asks"
            )
        return player

    def first_state(self, count: int) -> Floats:
        """What it remembers at the start of an episode [env, unit]."""
        return np.zeros((count, self._memory.units if self._memory else 0), np.float32)

    def outputs(self, observations: Any, state: Floats) -> tuple[Floats, Floats]:
        """The outputs [env, action], and what it remembers then."""
        values = np.asarray(observations, np.float32)
        for filters, offsets, stride in self._filters:
            values = np.maximum(convolved(values, filters, stride) + offsets[:, None, None], 0.0)
        values = values.reshape(len(values), -1)
        if self._memory is not None:
            values = state = self._memory.after(values, state)
        for number, (weights, biases) in enumerate(self._layers):
            values = (np.tanh(values) if number else values) @ weights + biases
        return values, state


class StoredPlayer:
    """A stored policy with what it remembers of each environment's episode.

    Args:
        policy: The policy.
        count: Number of environments.
    """

    def __init__(self, policy: StoredPolicy, count: int) -> None:
        self._policy, self.state = policy, policy.first_state(count)

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]: those with the greatest output."""
        del step
        outputs, self.state = self._policy.outputs(observations, self.state)
        chosen: NDArray[np.int64] = outputs.argmax(axis=1)
        return chosen


class Memory:
    """A gated recurrent unit; its arrays have the rows of the gates "reset", "update" and "new" in turn."""

    def __init__(self, arrays: dict[str, NDArray[Any]]) -> None:
        self._inputs, self._states = _floats(arrays["memory_inputs"], 2), _floats(arrays["memory_states"], 2)
        self._offsets = _floats(arrays["memory_offsets"], 1)
        self._state_offsets = _floats(arrays["memory_state_offsets"], 1)
        self.units = self._states.shape[1]

    def after(self, values: Floats, state: Floats) -> Floats:
        """The state [env, unit] after these inputs [env, input]."""
        reset, update, new = np.split(values @ self._inputs.T + self._offsets, 3, axis=1)
        old_reset, old_update, old_new = np.split(state @ self._states.T + self._state_offsets, 3, axis=1)
        kept = _sigmoid(update + old_update)
        fresh = np.tanh(new + _sigmoid(reset + old_reset) * old_new)
        after: Floats = (1.0 - kept) * fresh + kept * state
        return after


def convolved(pictures: Floats, filters: Floats, stride: int) -> Floats:
    """Pictures [env, in, row, column] under filters [out, in, row, column]: [env, out, row, column].

    There is no margin.
    """
    places = sliding_window_view(pictures, filters.shape[2:], axis=(2, 3))[:, :, ::stride, ::stride]
    sums: Floats = np.tensordot(places, filters, axes=((1, 4, 5), (1, 2, 3)))
    moved: Floats = np.moveaxis(sums, -1, 1)
    return moved


def _sigmoid(values: Floats) -> Floats:
    shares: Floats = 0.5 + 0.5 * np.tanh(0.5 * values)  # without overflow
    return shares


def _numbered(arrays: dict[str, NDArray[Any]], name: str) -> list[NDArray[Any]]:
    """The arrays `name`0, `name`1, … as far as they go."""
    found: list[NDArray[Any]] = []
    while f"{name}{len(found)}" in arrays:
        found.append(arrays[f"{name}{len(found)}"])
    return found


def _floats(array: NDArray[Any], axes: int) -> Floats:
    """An array of numbers with so many axes."""
    if array.ndim != axes:
        raise ValueError(f"an array has {array.ndim} axes instead of {axes}")
    return array.astype(np.float32)
