"""Train on a reward of your own: weights of what happened in a step, or any callable."""

import gymnasium as gym
import numpy as np

import silverball.envs

weights = {"points": 0.01, "drained": -5.0}  # runs inside the compiled step
envs = gym.make_vec("silverball/Pinball-v1", num_envs=64, reward=weights)
envs.reset(seed=0)
total = np.zeros(64)
for _ in range(600):
    _, rewards, *_ = envs.step(envs.action_space.sample())
    total += rewards
print(f"weights: {total.mean():.2f} on average; terms: {', '.join(silverball.envs.TERMS)}")


def long_balls(terms):
    """A reward for time in play and nothing else."""
    return terms["seconds"] - terms["drained"]


env = gym.make("silverball/Pinball-v1", reward=long_balls)
env.reset(seed=0)
print(f"callable: {env.step(3)[1]:.4f} in the first step")
