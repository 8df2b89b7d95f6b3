"""A rollout of a random policy with TorchRL, on the vector environment.

pip install '.[rl]' torchrl
python examples/collect_torchrl.py
"""

from __future__ import annotations

import gymnasium as gym
from torchrl.envs import GymWrapper

import silverball.envs  # noqa: F401  (registers the environments)

# TorchRL needs environments that are reset in the step in which an episode ends.
envs = GymWrapper(
    gym.make_vec("silverball/PinballClassic-v1", 16, autoreset_mode=gym.vector.AutoresetMode.SAME_STEP)
)
rollout = envs.rollout(200, break_when_any_done=False)
print(rollout["next", "reward"].sum().item() * 100, "points in", rollout.numel(), "steps")
