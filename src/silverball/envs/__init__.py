"""Pinball as Gymnasium environments for learning agents, registered when this package is imported.

    silverball/Pinball-v0         a random board for every episode; the state as a row of numbers
    silverball/PinballClassic-v0  the built-in table `classic`
    silverball/PinballPixels-v0   random boards; the last four pictures of 84 × 84

`gymnasium.make(id)` makes one environment (`single.py`), `gymnasium.make_vec(id, num_envs)` thousands that
step in one call (`vector.py`). `options.py` has the options, `observations.py` the slots of an
observation, `rewards.py` the rewards, `episode.py` the step. `sb3.py` and `puffer.py` are adapters for
Stable-Baselines3 and PufferLib.
"""

from __future__ import annotations

import re
from typing import Any

from silverball.errors import MissingExtra, OutdatedExtra
from silverball.plain import plain

try:
    import gymnasium
except ModuleNotFoundError:
    raise MissingExtra("silverball.envs", "rl") from None
# The first version with AutoresetMode. The extra asks for a later one, which does not replace pygame-ce.
if [int(number) for number in re.findall(r"\d+", gymnasium.__version__)[:2]] < [1, 1]:
    raise OutdatedExtra("silverball.envs", "Gymnasium", plain(gymnasium.__version__), "1.1", "rl")

from silverball.envs.observations import GROUPS
from silverball.envs.options import OPTIONS, Options
from silverball.envs.rewards import TERMS
from silverball.envs.single import PinballEnv
from silverball.envs.vector import PinballVectorEnv

__all__ = ["GROUPS", "IDS", "OPTIONS", "TERMS", "Options", "PinballEnv", "PinballVectorEnv"]

IDS: dict[str, dict[str, Any]] = {
    "silverball/Pinball-v0": {"table": "random"},
    "silverball/PinballClassic-v0": {"table": "classic"},
    "silverball/PinballPixels-v0": {"table": "random", "observation": "pixels"},
}
"""The registered environments, with the options that each sets."""

REWARD_THRESHOLDS = {
    "silverball/Pinball-v0": 110.0,
    "silverball/PinballClassic-v0": 220.0,
    "silverball/PinballPixels-v0": 110.0,
}
"""The mean return at which an environment with default options counts as solved: that of the trained player,
rounded down to tens. Source: `silverball bench thresholds`."""

for _id in set(IDS) - set(gymnasium.registry):
    gymnasium.register(
        _id,
        entry_point="silverball.envs.single:PinballEnv",
        vector_entry_point="silverball.envs.vector:PinballVectorEnv",
        kwargs=IDS[_id],
        reward_threshold=REWARD_THRESHOLDS[_id],
        # The wrappers of `gymnasium.make` would take longer than a step, and none is needed: the environment
        # itself demands a reset, applies its time limit and rejects invalid actions. The tests run
        # Gymnasium's checker on every id.
        disable_env_checker=True,
        order_enforce=False,
    )
