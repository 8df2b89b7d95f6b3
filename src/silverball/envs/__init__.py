"""What an agent sees: environments for Gymnasium, registered when this package is imported.

    silverball/Pinball-v0         a random board for every episode; the state as a row of numbers
    silverball/PinballClassic-v0  the drawn table
    silverball/PinballPixels-v0   random boards, seen as the last four pictures of 84 × 84

`gymnasium.make(id)` makes one (`single.py`), `gymnasium.make_vec(id, num_envs)` thousands that move with
one call (`vector.py`). `options.py` says what can be chosen, `slots.py` what stands where in an
observation, `episode.py` what happens in a step. `sb3.py` and `puffer.py` fit them to Stable-Baselines3 and
PufferLib.
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
# The first that has AutoresetMode. The extra asks for a later one, whose own extras leave pygame-ce alone.
if [int(number) for number in re.findall(r"\d+", gymnasium.__version__)[:2]] < [1, 1]:
    raise OutdatedExtra("silverball.envs", "Gymnasium", plain(gymnasium.__version__), "1.1", "rl")

from silverball.envs.options import OPTIONS, Options
from silverball.envs.single import PinballEnv
from silverball.envs.slots import GROUPS
from silverball.envs.vector import PinballVectorEnv

__all__ = ["GROUPS", "IDS", "OPTIONS", "Options", "PinballEnv", "PinballVectorEnv"]

IDS: dict[str, dict[str, Any]] = {
    "silverball/Pinball-v0": {"table": "random"},
    "silverball/PinballClassic-v0": {"table": "classic"},
    "silverball/PinballPixels-v0": {"table": "random", "observation": "pixels"},
}
"""Every environment with the options in which it differs."""

REWARD_THRESHOLDS = {
    "silverball/Pinball-v0": 110.0,
    "silverball/PinballClassic-v0": 220.0,
    "silverball/PinballPixels-v0": 110.0,
}
"""The mean return from which an environment counts as solved, with the default options: what the trained
player makes there, rounded down to tens. Source: `silverball bench thresholds`."""

for _id in set(IDS) - set(gymnasium.registry):
    gymnasium.register(
        _id,
        entry_point="silverball.envs.single:PinballEnv",
        vector_entry_point="silverball.envs.vector:PinballVectorEnv",
        kwargs=IDS[_id],
        reward_threshold=REWARD_THRESHOLDS[_id],
        # The wrappers of `gymnasium.make` would take longer than the step. None is needed: the environment
        # itself asks for a reset, keeps its time limit and refuses impossible actions, and the tests let
        # Gymnasium's checker look at every id.
        disable_env_checker=True,
        order_enforce=False,
    )
