"""The planner of the benchmark: plays copies of the environments ahead, and does what ended best.

The planner of the players reads a world and knows nothing of sticky actions and of the supply. This one
uses the environments alone: it saves their states, restores each into some branches, gives every branch a
plan (when each button is pressed, and for how long) and lets them play for some seconds by the compiled
step. After its first strokes a branch plays like the reflex player. The plan of the best branch is tried
again in the next step, so a shot has been tried in hundreds of ways when the ball arrives.

It does not foresee chance: every branch gets another seed, and with it other sticky actions. So it shows what
can be made by looking ahead, and is the upper end of the benchmark's scale.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.envs import PinballVectorEnv
from silverball.players.simple import LOOK_AHEAD, PlayerKind, press_all, press_reflexes

PLANS = 24  # tried for each environment in a step
LUCKS = 2  # branches of each plan, with different chance
HORIZON = 60  # [step] that a branch plays
PLANNED = 24  # [step] of these by the plan, then like the reflex player
LOSS = 60.0  # return that a lost ball costs: about that of a minute's good play
FADE = 0.985  # factor by which a step later counts less
MAX_WAIT, MAX_HOLD = 20, 8  # [step] before a button is pressed and while it is held


class Lookahead:
    """Plans in copies of the environments.

    Args:
        envs: The environments, a `PinballVectorEnv` of `make_trial`.
        seed: Of its plans and of the chance in its branches.
    """

    def __init__(self, envs: Any, seed: int = 0) -> None:
        self._envs, self._rng = envs, np.random.default_rng(seed)
        self._branches = PLANS * LUCKS
        options = envs.options.kwargs() | {"observation": "state"}
        self._ahead = PinballVectorEnv(envs.num_envs * self._branches, zero_copy=True, **options)
        self._ahead.reset(seed=0)
        self._best = np.zeros((envs.num_envs, PLANNED), np.int64)

    def act(self, observations: Any, step: int) -> NDArray[np.int64]:
        """The actions [env]: the first ones of the best plans."""
        del observations, step
        plans = self._plans()
        values = self._values(np.repeat(plans.reshape(-1, PLANNED), LUCKS, axis=0))
        chosen = values.reshape(len(plans), PLANS, LUCKS).mean(axis=2).argmax(axis=1)
        best = plans[np.arange(len(plans)), chosen]
        self._best = np.concatenate((best[:, 1:], np.zeros((len(best), 1), np.int64)), axis=1)
        actions: NDArray[np.int64] = best[:, 0].copy()
        return actions

    def _plans(self) -> NDArray[np.int64]:
        """The plans to try, actions [env, plan, step]: the last best one, none, variations, new ones."""
        count = self._envs.num_envs
        plans = self._drawn(count * PLANS).reshape(count, PLANS, PLANNED)
        plans[:, 0] = self._best
        plans[:, 1] = 0
        earlier = np.concatenate((self._best[:, 1:], np.zeros((count, 1), np.int64)), axis=1)
        later = np.concatenate((np.zeros((count, 1), np.int64), self._best[:, :-1]), axis=1)
        plans[:, 2], plans[:, 3] = earlier, later
        plans[:, 4], plans[:, 5] = self._best & 1, self._best & 2
        return plans

    def _drawn(self, count: int) -> NDArray[np.int64]:
        """Plans that press each button once, or not at all, [plan, step]."""
        steps = np.arange(PLANNED)
        drawn = np.zeros((count, PLANNED), np.int64)
        for button in (1, 2):
            wait = self._rng.integers(0, MAX_WAIT, (count, 1))
            hold = self._rng.integers(1, MAX_HOLD, (count, 1))
            presses = self._rng.random((count, 1)) < 0.6
            drawn |= np.where(presses & (steps >= wait) & (steps < wait + hold), button, 0)
        return drawn

    def _values(self, plans: NDArray[np.int64]) -> NDArray[np.float64]:
        """What each branch comes to with its plan [branch]."""
        ahead, count = self._ahead, len(plans)
        ahead.restore_state(np.repeat(self._envs.save_state(), self._branches, axis=0))
        ahead.batch.state["seed"] = self._rng.integers(0, 2**62, count)
        values, playing, weight = np.zeros(count), np.ones(count, bool), 1.0
        for step in range(HORIZON):
            actions = plans[:, step] if step < PLANNED else reflex_actions(ahead)
            _, rewards, terminated, truncated, _ = ahead.step(actions)
            values += weight * rewards * playing
            values -= weight * LOSS * (playing & terminated)
            playing &= ~(terminated | truncated)
            weight *= FADE
        return values


def reflex_actions(envs: Any) -> NDArray[np.int64]:
    """What the reflex player presses in each environment [env]."""
    return simple_actions(envs, PlayerKind.REFLEX)


def simple_actions(envs: Any, kind: PlayerKind, ahead: float = LOOK_AHEAD) -> NDArray[np.int64]:
    """What a simple player presses in each environment [env]; reflex predicts the ball `ahead` [s]."""
    batch = envs.batch
    boards = batch.boards
    pressed = np.zeros((1, batch.count, 3), np.bool_)
    tick = 1.0 / batch.tick_rate
    if kind == PlayerKind.REFLEX:
        press_reflexes(batch.state, boards.board, batch.board_of, boards.collider, ahead, pressed)
    else:
        press_all(int(kind), batch.state, boards.board, batch.board_of, boards.collider, tick, pressed)
    actions: NDArray[np.int64] = pressed[0, :, 0] + 2 * pressed[0, :, 1].astype(np.int64)
    return actions
