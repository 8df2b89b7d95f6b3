"""Rewards: a name, weights of the terms of a step, or a callable.

A step is described by its *terms*, the numbers in `TERMS`. Weights are applied inside the compiled step; a
callable receives the terms and returns the reward.
"""

from __future__ import annotations

import difflib
import importlib
import math
import sys
from collections.abc import Callable, Iterable, Mapping
from numbers import Real
from typing import Any, NoReturn, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.envs.state import COUNTS, HAPPENINGS
from silverball.plain import plain

Reward: TypeAlias = str | Mapping[str, float] | Callable[[dict[str, Any]], Any]
"""A name in `REWARDS`, the import path of a callable ("module:name"), weights by term, or a callable."""

POINT = 0.01  # reward of a point: a cylinder of a hundred points is worth 1
POINTS, SECONDS, STALLED, FIRST_COUNT = range(4)  # indices in `TERMS`
TERMS = ("points", "seconds", "stalled", *COUNTS[1:])
"""The terms of a step: points gained; its seconds if a ball is on the board at its end, else 0; 1 if the ball
stalled; then the growth of each count of `info` except the score."""

OF_GAMES = ("mode ", "counter ")
"""How the further terms of games begin, before the name of a mode, which has started, or of a counter, which
has grown; what happens in a game (`HAPPENINGS`) is a term too."""

REWARDS: dict[str, dict[str, float]] = {"score": {"points": POINT}, "time": {"seconds": 1.0}}
"""The rewards that have names, as weights."""


def resolve_reward(reward: Any) -> dict[str, float] | Callable[[dict[str, Any]], Any]:
    """The weights of a reward, or the callable itself.

    Raises:
        ValueError: It is neither, a term is unknown, a weight is not a finite number, or an import path leads
            to nothing.
    """
    if isinstance(reward, str):
        if reward in REWARDS:
            return REWARDS[reward]
        if ":" in reward:
            reward = _imported(reward)
    if isinstance(reward, Mapping):
        return _checked_weights(reward)
    if callable(reward):
        return reward  # type: ignore[no-any-return]
    names = " or ".join(map(repr, REWARDS))
    raise ValueError(
        f"reward must be {names}, weights like {{'points': {POINT}, 'drained': -1.0}}, a callable "
        f"or its import path 'module:name', got {reward!r}"
    )


def did_you_mean(name: Any, known: Iterable[str]) -> str:
    """Text for an error message that suggests the nearest known name; empty if none is near."""
    near = difflib.get_close_matches(str(name)[:60], known, 1)
    return f"did you mean {near[0]!r}? " if near else ""


def _checked_weights(weights: Mapping[Any, Any]) -> dict[str, float]:
    for name, weight in weights.items():
        if name not in TERMS and name not in HAPPENINGS and not str(name).startswith(OF_GAMES):
            _refuse_term(name, TERMS)
        if isinstance(weight, bool) or not isinstance(weight, Real) or not math.isfinite(weight):
            raise ValueError(f"reward: the weight of {name!r} must be a finite number, got {weight!r}")
    if not weights:
        raise ValueError(f"reward must weigh at least one of {', '.join(TERMS)}, got an empty dict")
    return {name: float(weight) for name, weight in weights.items()}


def check_terms(reward: Mapping[str, float], own_terms: tuple[str, ...]) -> None:
    """Reject weights of terms that an environment does not have.

    Args:
        reward: The weights.
        own_terms: The terms beyond `TERMS`, of games with rules.

    Raises:
        ValueError: A term is unknown.
    """
    for name in reward:
        if name in TERMS or name in own_terms:
            continue
        if not own_terms:
            raise ValueError(f"reward: the term {name!r} is one of games: set the option rules=True")
        _refuse_term(name, (*TERMS, *own_terms))


def _refuse_term(name: Any, terms: tuple[str, ...]) -> NoReturn:
    raise ValueError(
        f"reward: unknown term {plain(repr(name))}; {plain(did_you_mean(name, terms))}"
        f"expected some of {plain(', '.join(terms))}"
    )


def _imported(path: str) -> Any:
    """The callable at an import path."""
    module, _, name = path.partition(":")
    try:
        found: Any = importlib.import_module(module)
        for part in name.split("."):
            found = getattr(found, part)
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(f"reward {path!r} cannot be imported: {error}") from None
    if not callable(found):
        raise ValueError(f"reward {path!r} must lead to a callable, got {type(found).__name__}")
    return found


def import_path(function: Any) -> str | None:
    """The path by which other processes can import a callable; None if they cannot."""
    module, name = getattr(function, "__module__", None), getattr(function, "__qualname__", "")
    if not isinstance(module, str) or module == "__main__" or "<" in name:
        return None
    found: Any = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    return f"{module}:{name}" if found is function else None


def call_reward(reward: Callable[[dict[str, Any]], Any], terms: dict[str, float]) -> float:
    """Call a reward callable for one environment.

    Raises:
        ValueError: It is not a finite number.
    """
    value = reward(terms)
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"the reward callable must return a finite number, got {value!r}")
    return number


def call_batch_reward(
    reward: Callable[[dict[str, Any]], Any], names: tuple[str, ...], terms: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Call a reward callable with named terms [env, term]; returns the rewards, float64 [env].

    Raises:
        ValueError: It is not a finite number for each environment.
    """
    value = reward(dict(zip(names, terms.T.copy(), strict=True)))
    try:
        rewards = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise ValueError(
            f"the reward callable must return numbers [{len(terms)}], got {type(value).__name__}"
        ) from None
    if rewards.shape != (len(terms),):
        raise ValueError(f"the reward callable must return the shape ({len(terms)},), got {rewards.shape}")
    if not np.isfinite(rewards).all():
        raise ValueError(
            f"the reward callable must return finite numbers, got {rewards[~np.isfinite(rewards)][0]}"
        )
    return rewards
