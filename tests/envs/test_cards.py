"""Do the cards of the environments say what holds?"""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from silverball.envs import IDS, OPTIONS
from silverball.envs.cards import HEADINGS, card

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("id_", IDS)
def test_a_card_has_gymnasiums_eight_headings_and_the_spaces_of_the_environment(id_):
    text = card(id_)
    assert [line.removeprefix("#### ") for line in text.splitlines() if line.startswith("#### ")] == [
        *HEADINGS
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


def test_the_page_for_agents_is_what_the_code_says():
    script = ROOT / "docs" / "make_agents.py"
    names: dict = {"__name__": "agents", "__file__": str(script)}
    exec(compile(script.read_text(encoding="utf-8"), script.name, "exec"), names)
    assert names["PAGE"].read_text(encoding="utf-8") == names["page"](), "run: python docs/make_agents.py"
