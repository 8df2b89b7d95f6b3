"""What a step has returned does not change, and memory that is no longer referenced is reused."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from silverball.envs import PinballVectorEnv

COUNT = 8
KINDS: list[dict[str, Any]] = [
    {},
    {"observation": "dict"},
    {"observation": "pixels", "stack": 1, "size": (20, 12)},
    {"observation": "pixels", "stack": 3, "size": (20, 12)},
]


def stepped(envs, number):
    return envs.step(np.full(COUNT, number % 4))


def first_part(observations):
    return next(iter(observations.values())) if isinstance(observations, dict) else observations


def home(array: np.ndarray) -> np.ndarray:
    """The array that owns the memory of a view."""
    while isinstance(array.base, np.ndarray):
        array = array.base
    return array


@pytest.mark.parametrize("options", KINDS, ids=str)
def test_results_that_are_referenced_never_change(options):
    envs = PinballVectorEnv(COUNT, boards=2, time_limit=1.0, **options)
    envs.reset(seed=0)
    results, copies = [], []
    for number in range(30):
        results.append(stepped(envs, number))
        copies.append(copy.deepcopy(results[-1]))
    for result, kept in zip(results, copies, strict=True):
        np.testing.assert_equal(result, kept)


@pytest.mark.parametrize(
    "hold",
    [
        lambda result: first_part(result[0])[2:3],  # a view
        lambda result: memoryview(first_part(result[0])),
        lambda result: result[1],
        lambda result: result[2][::2],
        lambda result: result[4]["score"],
        lambda result: result[4]["wall_hits"][1:],
    ],
    ids=["part", "memory", "rewards", "terminated", "score", "hits"],
)
@pytest.mark.parametrize("options", KINDS, ids=str)
def test_a_reference_to_a_part_is_enough(options, hold):
    envs = PinballVectorEnv(COUNT, boards=2, stall=1.0, **options)
    envs.reset(seed=0)
    held = hold(stepped(envs, 1))
    before = np.array(held, copy=True)
    for number in range(300):
        newest = hold(stepped(envs, number))
        if not np.array_equal(newest, before):
            break
    else:
        pytest.fail("nothing has happened that could have changed what is held")
    np.testing.assert_equal(np.asarray(held), before)


@pytest.mark.parametrize("options", KINDS, ids=str)
def test_memory_that_is_not_referenced_is_reused(options):
    envs = PinballVectorEnv(COUNT, boards=2, **options)
    envs.reset(seed=0)
    places = {home(first_part(stepped(envs, number)[0])).ctypes.data for number in range(20)}
    assert len(places) == 1
    last, places = None, set()
    for number in range(20):
        last = first_part(stepped(envs, number)[0])  # holds the one before while the step is made
        places.add(home(last).ctypes.data)
    assert len(places) == 2
