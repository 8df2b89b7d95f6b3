"""The contestants of the benchmark by name; `stored_policies.py` has trained policies from files.

Players that read worlds (`reflex`, `beginner`, `trained`) decide fifteen times a second and know nothing of
sticky actions and of the power supply, but for `trained` on `PinballMissions-v1`; `planner` is that of
`lookahead.py`. `blind` plays the rhythm that is the best of 200 on `PinballClassic-v1` and on `Pinball-v1`.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.agents.lookahead import Lookahead, simple_actions
from silverball.benchmarks.agents.rhythms import Blind, RandomPresses, Rhythm
from silverball.benchmarks.agents.trials import Entrant
from silverball.physics.records import LEFT, RIGHT
from silverball.players.batch_policies import TrainedPolicy
from silverball.players.simple import LOOK_AHEAD, PlayerKind

BEST_RHYTHM: Final = Rhythm("in turn", 2, 3)
"""Source: `silverball bench blind`, on both ids."""

REACTION = 3  # [step] 0.2 s between what the beginner sees and what it presses


class Simple:
    """A simple player, from the state of the worlds."""

    def __init__(self, kind: PlayerKind, envs: Any) -> None:
        self._kind, self._envs = kind, envs

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]."""
        del observations, step
        return simple_actions(self._envs, self._kind)


class Beginner:
    """Presses what the reflex player would have pressed a reaction time ago, looking ahead by as much."""

    def __init__(self, envs: Any) -> None:
        self._envs = envs
        self._decided = np.zeros((REACTION, envs.num_envs), np.int64)
        self._ahead = LOOK_AHEAD + REACTION * envs.options.step_seconds

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]."""
        del observations
        now = step % REACTION
        pressed: NDArray[np.int64] = self._decided[now].copy()
        self._decided[now] = simple_actions(self._envs, PlayerKind.REFLEX, self._ahead)
        return pressed


class Trained:
    """The trained player of the windows; its network for random boards knows of no sticky actions."""

    def __init__(self, envs: Any) -> None:
        self._envs, self._policy = envs, TrainedPolicy(envs.batch, envs.games)

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]."""
        del observations, step
        self._policy.decide(self._envs.charge)
        actions: NDArray[np.int64] = self._policy.buttons @ np.array([LEFT, RIGHT])
        return actions


CONTESTANTS: Final[dict[str, Entrant]] = {
    "idle": partial(Simple, PlayerKind.IDLE),
    "random": RandomPresses,
    "blind": partial(Blind, BEST_RHYTHM),
    "beginner": Beginner,
    "reflex": partial(Simple, PlayerKind.REFLEX),
    "trained": Trained,
    "planner": Lookahead,
}
"""Who plays when nobody is named, from the weakest to the strongest."""
