"""Solve a board of the PinBall domain with Sarsa(λ) and a Fourier basis, in NumPy, on one core.

    python examples/train_domain.py --board open

Values are linear in cosines of the state, up to order 3 in each of its four numbers. The step size shrinks
whenever an update would overshoot. Sources: G. Konidaris, S. Osentoski and P. Thomas, "Value function
approximation in reinforcement learning using the Fourier basis" (2011); W. Dabney and A. Barto, "Adaptive
step-size for online temporal difference learning" (2012).
"""

from __future__ import annotations

import argparse
import itertools
import time

import gymnasium as gym
import numpy as np

import silverball.envs  # noqa: F401  (registers)

ORDER, TRACE, EXPLORATION = 3, 0.9, 0.01


class Sarsa:
    """An agent that learns the value of each action from the steps that it makes."""

    def __init__(self, space: gym.spaces.Box, actions: int, seed: int) -> None:
        self.low, self.width = space.low.astype(float), (space.high - space.low).astype(float)
        self.waves = np.pi * np.array(list(itertools.product(range(ORDER + 1), repeat=len(self.low))))
        length = np.linalg.norm(self.waves, axis=1) / np.pi
        self.rates = 1.0 / np.where(length == 0.0, 1.0, length)  # high frequencies learn slowly
        self.weights = np.zeros((actions, len(self.waves)))
        self.traces, self.step_size = np.zeros_like(self.weights), 1.0
        self.rng = np.random.default_rng(seed)

    def features(self, observation: np.ndarray) -> np.ndarray:
        """The cosines of a state."""
        return np.cos(self.waves @ ((observation - self.low) / self.width))

    def choose(self, features: np.ndarray, exploration: float) -> int:
        """The action of the greatest value, or sometimes any."""
        if self.rng.random() < exploration:
            return int(self.rng.integers(len(self.weights)))
        return int(np.argmax(self.weights @ features))

    def learn(self, features: np.ndarray, action: int, reward: float, next_value: float, change: np.ndarray):
        """Move the values towards the reward and the value of what came next; both undiscounted."""
        self.traces *= TRACE
        self.traces[action] += features
        overshoot = abs(float(np.sum(self.traces * self.rates * change)))
        if overshoot > 0.0:
            self.step_size = min(self.step_size, 1.0 / overshoot)
        error = reward + next_value - self.weights[action] @ features
        self.weights += (self.step_size * error) * self.traces * self.rates


def play(env: gym.Env, agent: Sarsa, *, learns: bool) -> tuple[float, int, bool]:
    """Play an episode; returns its return, its steps, and whether the ball reached the target."""
    observation, _ = env.reset()
    agent.traces[:] = 0.0
    exploration = EXPLORATION if learns else 0.0
    features = agent.features(observation)
    action, total, over = agent.choose(features, exploration), 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(action)
        total, over = total + reward, terminated or truncated
        after = agent.features(observation)
        next_action = agent.choose(after, exploration)
        if learns:
            change = np.zeros_like(agent.weights)
            change[action] -= features
            if not terminated:
                change[next_action] += after
            next_value = 0.0 if terminated else float(agent.weights[next_action] @ after)
            agent.learn(features, action, reward, next_value, change)
        features, action = after, next_action
    return total, info["steps"], info["in_target"]


def main() -> None:
    """Learn for a number of episodes, then play greedily."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--board", default="open", help="a built-in board or a .cfg file")
    parser.add_argument("--episodes", type=int, default=200, help="episodes of learning")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    env = gym.make("silverball/PinBallDomain-v1", board=arguments.board)
    env.reset(seed=arguments.seed)
    agent = Sarsa(env.observation_space, int(env.action_space.n), arguments.seed)
    start, block = time.perf_counter(), max(1, arguments.episodes // 10)
    recent: list[tuple[float, int, bool]] = []
    for episode in range(1, arguments.episodes + 1):
        recent.append(play(env, agent, learns=True))
        if episode % block == 0:
            returns, steps, solved = (np.mean(column) for column in zip(*recent[-block:], strict=True))
            head = f"{episode:5} episodes {time.perf_counter() - start:6.1f} s"
            print(f"{head}: return {returns:8.0f}, {steps:6.0f} steps, {solved:4.0%} solved", flush=True)
    total, steps, solved = play(env, agent, learns=False)
    print(
        f"greedy: return {total:.0f} in {steps} steps, {'in the target' if solved else 'not in the target'}"
    )


if __name__ == "__main__":
    main()
