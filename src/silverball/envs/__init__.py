"""Pinball as Gymnasium environments for learning agents, registered when this package is imported.

    silverball/Pinball-v0         a random board for every episode; the state as a row of numbers
    silverball/PinballClassic-v0  the built-in table `classic`
    silverball/PinballPixels-v0   random boards; the last four pictures of 84 × 84

and the same as version v1, the benchmark: fifteen decisions a second, sticky actions and paddles that need
time between two strokes, so that nothing is gained without looking (docs/benchmark.md).

    silverball/PinballAtari-v1     pictures of 210 × 160 and lives, for programs that play Atari games
    silverball/PinballMissions-v1  whole games on `silver_comet` by its rules: missions, locks, multiball

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
from silverball.envs.protocol import BENCHMARK, BUDGETS, SEEDS, SPLITS, at_level
from silverball.envs.rewards import TERMS
from silverball.envs.single import PinballEnv
from silverball.envs.vector import PinballVectorEnv

__all__ = [
    "BENCHMARK", "BUDGETS", "GROUPS", "IDS", "OPTIONS", "SEEDS", "SPLITS", "TERMS", "Options", "PinballEnv",
    "PinballVectorEnv", "at_level",
]  # fmt: skip

IDS: dict[str, dict[str, Any]] = {
    "silverball/Pinball-v0": {"table": "random"},
    "silverball/PinballClassic-v0": {"table": "classic"},
    "silverball/PinballPixels-v0": {"table": "random", "observation": "pixels"},
    "silverball/Pinball-v1": {"table": "random", "boards": "train", **BENCHMARK},
    "silverball/PinballClassic-v1": {"table": "classic", **BENCHMARK},
    "silverball/PinballPixels-v1": {
        "table": "random",
        "boards": "train",
        "observation": "pixels",
        **BENCHMARK,
    },
    "silverball/PinballAtari-v1": {
        "table": "classic",
        "observation": "pixels",
        "size": (210, 160),
        "rgb": True,
        "stack": 1,
        "balls": 3,
        "lives": True,
        **BENCHMARK,
        "frame_skip": 1,
    },
    "silverball/PinballMissions-v1": {
        "table": "silver_comet",
        "rules": True,
        "balls": 3,
        "launch": "auto",
        "reward": {"points": 0.0001},
        "time_limit": 600.0,
        **BENCHMARK,
    },
}
"""The registered environments, with the options that each sets."""

REWARD_THRESHOLDS = {
    "silverball/Pinball-v0": 110.0,
    "silverball/PinballClassic-v0": 220.0,
    "silverball/PinballPixels-v0": 110.0,
    "silverball/Pinball-v1": 40.0,
    "silverball/PinballClassic-v1": 70.0,
    "silverball/PinballPixels-v1": 40.0,
    "silverball/PinballMissions-v1": 500.0,
}
"""The mean return at which an environment with default options counts as solved, rounded down to tens.

Of v0 ids it is that of the trained player (source: `silverball bench thresholds`), of v1 ids that of the
reflex player (source: `silverball bench agents`), of missions that of the table's gold medal.
"""

gymnasium.register(
    "silverball/PinballShots-v1",
    entry_point="silverball.envs.shots.shot_single:PinballShotsEnv",
    vector_entry_point="silverball.envs.shots.shot_vector:PinballShotsVectorEnv",
    kwargs={"table": "classic", **BENCHMARK},
    disable_env_checker=True,
    order_enforce=False,
)

gymnasium.register(
    "silverball/PinBallDomain-v1",
    entry_point="silverball.envs.domain.domain_single:PinBallDomainEnv",
    vector_entry_point="silverball.envs.domain.domain_vector:PinBallDomainVectorEnv",
    disable_env_checker=True,
    order_enforce=False,
)

for _id in set(IDS) - set(gymnasium.registry):
    gymnasium.register(
        _id,
        entry_point="silverball.envs.single:PinballEnv",
        vector_entry_point="silverball.envs.vector:PinballVectorEnv",
        kwargs=IDS[_id],
        reward_threshold=REWARD_THRESHOLDS.get(_id),
        # The wrappers of `gymnasium.make` would take longer than a step, and none is needed: the environment
        # itself demands a reset, applies its time limit and rejects invalid actions. The tests run
        # Gymnasium's checker on every id.
        disable_env_checker=True,
        order_enforce=False,
    )
