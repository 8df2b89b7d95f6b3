"""Gymnasium's spec of an environment, with the environment's step limit and values that JSON can hold."""

from __future__ import annotations

import copy
import enum
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.envs.registration import EnvSpec

from silverball.envs.rewards import import_path
from silverball.table import Table


def with_step_limit(spec: EnvSpec | None, max_steps: int | None) -> EnvSpec | None:
    """A copy of Gymnasium's spec with the step limit, which the environment applies itself.

    The registered spec has no limit, because Gymnasium would wrap the environment in a second step counter.

    Args:
        spec: The spec that `gymnasium.make` filled in.
        max_steps: The steps after which the environment truncates an episode; None: never.
    """
    if spec is None:
        return None
    own = copy.copy(spec)
    own.max_episode_steps = max_steps
    own.kwargs = {name: _for_json(value) for name, value in spec.kwargs.items()}
    if callable(own.kwargs.get("reward")):
        own.__class__ = _SpecWithCallable
    return own


class _SpecWithCallable(EnvSpec):
    """The spec of an environment whose reward is a callable without an import path."""

    def to_json(self) -> str:
        """Raise an error that lists the rewards that JSON can hold.

        Raises:
            ValueError: Always.
        """
        raise ValueError(
            f"the spec of {self.id} cannot be written as JSON: its reward is a callable that cannot be "
            "imported; use a function at the top of a module, its import path 'module:name', or weights"
        )


def _for_json(value: Any) -> Any:
    """An option in a form that JSON can hold and that makes the same environment."""
    if isinstance(value, Table):
        keys = value.model_dump(mode="json", exclude_defaults=True, exclude_none=True)
        return {"format": value.format, "name": value.name, **keys}
    if isinstance(value, Mapping):
        return {name: _for_json(one) for name, one in value.items()}
    if callable(value):
        return import_path(value) or value
    if isinstance(value, (list, tuple)):
        return type(value)(_for_json(one) for one in value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, enum.Enum):
        return value.value
    return os.fspath(value) if isinstance(value, os.PathLike) else value
