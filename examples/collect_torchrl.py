"""TorchRL takes the vector environment as it is; a rollout of a random policy.

pip install '.[rl]' torchrl
python examples/collect_torchrl.py
"""

from __future__ import annotations

import gymnasium as gym
from torchrl.envs import GymWrapper

import silverball.envs  # noqa: F401  (registers the environments)

# TorchRL wants episodes to begin anew in the step in which they end.
envs = GymWrapper(
    gym.make_vec("silverball/PinballClassic-v0", 16, autoreset_mode=gym.vector.AutoresetMode.SAME_STEP)
)
rollout = envs.rollout(200, break_when_any_done=False)
print(rollout["next", "reward"].sum().item() * 100, "points in", rollout.numel(), "steps")
