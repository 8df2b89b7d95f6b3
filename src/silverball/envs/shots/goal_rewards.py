"""What goals give: the reward, the end and the truncation of one goal or of many, as `GoalEnv` defines them.

A goal is a row with a 1 at its shot and 0 elsewhere; an achieved goal has no 1 until a shot is made. The last
axis is that of shots, and results have the shape of the others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

INFO_OF_SHOTS = ("is_success", "shot", "struck", "lost", "out_of_time")
"""The keys of `info`."""


class GoalRewards:
    """The functions that relabel episodes, for the environments that derive from it."""

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: Any) -> Any:
        """The reward: 1.0 where the achieved goal is the desired one, else 0.0.

        Args:
            achieved_goal: One goal [shot], or many […, shot].
            desired_goal: The goals that were wanted, of the same shape.
            info: Not used.
        """
        del info
        rewards = _is_made(achieved_goal, desired_goal).astype(np.float64)
        return float(rewards) if rewards.ndim == 0 else rewards

    def compute_terminated(self, achieved_goal: Any, desired_goal: Any, info: Any) -> Any:
        """Whether the episode ends: a shot has been made, whichever was wanted, or the ball is lost.

        Args:
            achieved_goal: One goal [shot], or many […, shot].
            desired_goal: Not used.
            info: That of a step; for many goals a list of them, or the infos of a vector.
        """
        del desired_goal
        ended = np.asarray(achieved_goal).any(axis=-1) | _flags(info, "lost")
        return bool(ended) if ended.ndim == 0 else ended

    def compute_truncated(self, achieved_goal: Any, desired_goal: Any, info: Any) -> Any:
        """Whether the episode is cut off by its time limit, without an end in the same step.

        Args:
            achieved_goal: One goal [shot], or many […, shot].
            desired_goal: Not used.
            info: That of a step; for many goals a list of them, or the infos of a vector.
        """
        ended = np.asarray(self.compute_terminated(achieved_goal, desired_goal, info))
        cut = _flags(info, "out_of_time") & ~ended
        return bool(cut) if cut.ndim == 0 else cut


def goal_rows(shots: NDArray[np.int64], count: int) -> NDArray[np.float32]:
    """The goals of shots, float32 [env, shot]; of −1 a row without a 1."""
    rows: NDArray[np.float32] = (np.arange(count) == shots[:, None]).astype(np.float32)
    return rows


def _is_made(achieved: Any, desired: Any) -> NDArray[np.bool_]:
    """Whether goals are the same shot."""
    same: NDArray[np.bool_] = np.sum(np.multiply(achieved, desired), axis=-1) > 0.5
    return np.asarray(same)


def _flags(info: Any, key: str) -> NDArray[np.bool_]:
    """A flag of an info, of a list of infos, or of the infos of a vector."""
    if isinstance(info, dict):
        return np.asarray(info[key], np.bool_)
    return np.array([one[key] for one in info], np.bool_)
