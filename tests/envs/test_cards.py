"""The reference in docs/environments.md is what the environments are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import GROUPS, IDS, OPTIONS
from silverball.envs.observations import fields


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    """The names of docs/make_environments.py, which is not a module of the package."""
    path = Path(__file__).parents[2] / "docs" / "make_environments.py"
    names: dict[str, Any] = {"__name__": "environments", "__file__": str(path)}
    exec(compile(path.read_text(encoding="utf-8"), path.name, "exec"), names)
    return names


@pytest.mark.parametrize("id_", IDS)
def test_a_card_has_gymnasiums_eight_headings_and_the_spaces_of_the_environment(id_, script):
    text = script["card"](id_)
    assert [line.removeprefix("#### ") for line in text.splitlines() if line.startswith("#### ")] == [
        *script["HEADINGS"]
    ]
    env = gym.make(id_, **({} if "Classic" in id_ else {"boards": 2}))
    space = env.observation_space
    low = -1 if space.dtype == np.float32 else 0
    assert f"`Box({low}, {space.high.max():g}, {space.shape}, {space.dtype})`" in text
    assert space.low.min() == low
    assert f"`{env.action_space}`" in text
    _, info = env.reset(seed=0)
    assert all(f"`{name}`" in text for name in info)
    assert all(f"| `{name}` |" in text for name, *_ in OPTIONS)


def test_the_table_of_slots_has_a_row_for_every_slot(script):
    rows = script["slot_table"](
        fields({"balls": 2, "paddles": 2, "game": 1, "triangular_prisms": 4, "cylinders": 3})
    ).splitlines()
    assert len(rows) == 2 + sum(len(group.slots) for group in GROUPS)


def test_the_page_of_environments_is_what_the_code_says(script):
    written = script["PAGE"].read_text(encoding="utf-8")
    assert written == script["page"](), "run: python docs/make_environments.py"
