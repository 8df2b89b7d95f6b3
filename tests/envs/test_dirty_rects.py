"""A picture made by repairing dirty rectangles equals one that is drawn from scratch."""

from __future__ import annotations

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from silverball.envs import PinballVectorEnv

COUNT, STEPS = 48, 500


@pytest.mark.parametrize(
    "options",
    [
        {"boards": 3},
        {"boards": 3, "rgb": True, "size": (40, 60)},
        {"table": "classic", "size": (120, 84), "balls": 3, "create": "button", "jitter": True},
        {"table": "parts", "rgb": True},
    ],
    ids=str,
)
def test_repaired_pictures_equal_pictures_from_scratch(options):
    chosen = {"observation": "pixels", "stack": 1, "time_limit": 3.0, **options}
    # One picture in an array that stays is repaired; a new array has nothing to repair.
    repaired = PinballVectorEnv(COUNT, AutoresetMode.SAME_STEP, zero_copy=True, **chosen)
    whole = PinballVectorEnv(COUNT, AutoresetMode.SAME_STEP, zero_copy=False, **chosen)
    random = np.random.default_rng(1)
    repaired.reset(seed=3), whole.reset(seed=3)
    differing = 0
    for _ in range(STEPS):
        actions = random.integers(0, repaired.single_action_space.n, COUNT)
        one, *_, infos = repaired.step(actions)
        other, *_, its_infos = whole.step(actions)
        differing += int((one != other).sum())
        if "final_obs" in infos:
            ended = infos["_final_obs"]
            for row in np.flatnonzero(ended):
                assert (infos["final_obs"][row] == its_infos["final_obs"][row]).all()
    assert differing == 0
    assert (repaired._engine.rules["can_repair"][0], whole._engine.rules["can_repair"][0]) == (1, 0)


def test_each_picture_of_a_stack_is_the_one_picture_of_that_moment():
    chosen = {"observation": "pixels", "boards": 2, "time_limit": None}
    stacked = PinballVectorEnv(COUNT, zero_copy=True, stack=4, **chosen)
    alone = PinballVectorEnv(COUNT, zero_copy=False, stack=1, **chosen)
    random = np.random.default_rng(2)
    stacked.reset(seed=5)
    singles = [alone.reset(seed=5)[0]]
    since = np.zeros(COUNT, int)  # steps of an episode
    for _ in range(STEPS):
        actions = random.integers(0, 4, COUNT)
        shown, _, terminated, truncated, infos = stacked.step(actions)
        singles = [*singles[-3:], alone.step(actions)[0]]
        since = np.where((infos["created"] == 1) & (since < 0), 0, since + 1)
        for back in range(min(4, len(singles))):
            rows = np.flatnonzero(since >= back)
            assert (shown[rows, 3 - back] == singles[-1 - back][rows]).all()
        since[terminated | truncated] = -1
