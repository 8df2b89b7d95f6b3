"""A player for boards that it has never seen: PPO of Stable-Baselines3 on random boards, in 15 minutes.

pip install 'silverball[rl]' stable-baselines3 matplotlib
python examples/train_sb3.py --minutes 15 --out curve.png --policy policy.npz
"""

from __future__ import annotations

import argparse
import math
import sys
import time

import matplotlib.pyplot as plt
import numpy as np
import torch
from gymnasium.spaces import Box
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecEnvWrapper, VecNormalize

from silverball.envs import PinballVectorEnv
from silverball.envs.sb3 import SilverballVecEnv
from silverball.players.sight import MIRRORED, SEEN, see
from silverball.players.trained import DECISIONS, Policy

HORIZON = 6.0  # [s] in which what is to come loses its weight: 1/e
UNSEEN = 1_000_000  # seed of the first board that is played on but never trained on
COLUMNS = [1, 2, 3, 4, 10, 11, 12, 13, 14, 15]  # of a state observation: the ball and the paddles


class Seen(VecEnvWrapper):
    """Shows what `players/sight.py` makes of an observation; balls on the right are seen in the mirror."""

    def __init__(self, envs):
        super().__init__(envs, Box(-10.0, 10.0, (SEEN,), np.float32))

    def _see(self, rows):
        seen, is_mirrored = see(rows[:, COLUMNS].astype(np.float64))
        return seen.astype(np.float32), is_mirrored

    def reset(self):  # noqa: D102  (what SB3 says of it)
        seen, self._is_mirrored = self._see(self.venv.reset())
        return seen

    def step_async(self, actions):  # noqa: D102
        self.venv.step_async(np.where(self._is_mirrored, MIRRORED[actions], actions))

    def step_wait(self):  # noqa: D102
        rows, rewards, ended, infos = self.venv.step_wait()
        for row in np.flatnonzero(ended):
            last = infos[row]["terminal_observation"]
            infos[row]["terminal_observation"] = self._see(last[None])[0][0]
        seen, self._is_mirrored = self._see(rows)
        return seen, rewards, ended, infos


def policy_of(model, command=""):
    """The network that chooses, as plain arrays."""
    net = model.policy
    linear = [*(one for one in net.mlp_extractor.policy_net if hasattr(one, "weight")), net.action_net]
    return Policy.rounded(
        [(one.weight.detach().numpy().T, one.bias.detach().numpy()) for one in linear], command
    )


def evaluate(act, balls):
    """Points of a ball and its life [s] on unseen boards, a board for each ball: means and 95 % intervals."""
    envs = PinballVectorEnv(
        balls, "SameStep", boards=balls, board_seed=UNSEEN, frame_skip=60 // DECISIONS, zero_copy=True
    )
    rows, _ = envs.reset(seed=0)
    points, steps, plays = np.zeros(balls), np.zeros(balls), np.ones(balls, bool)
    while plays.any():
        rows, _, terminated, truncated, infos = envs.step(act(rows))
        steps += plays
        ended = plays & (terminated | truncated)
        if ended.any():
            points[ended] = infos["final_info"]["score"][ended]
            plays &= ~ended
    lives = steps / DECISIONS
    return [(one.mean(), 1.96 * one.std() / math.sqrt(balls)) for one in (points, lives)]


class Curve(BaseCallback):
    """Writes down how it goes: the balls of each rollout, and now and then balls on unseen boards."""

    def __init__(self, minutes, balls, every):
        super().__init__()
        self.seconds, self.balls, self.every = 60 * minutes, balls, every
        self.trained, self.unseen, self.paused, self.began = [], [], 0.0, time.perf_counter()

    def elapsed(self):
        """Seconds of training, evaluations left out."""
        return time.perf_counter() - self.began - self.paused

    def _on_training_start(self):
        self._ended = []
        self._evaluate()

    def _evaluate(self):
        started, policy = time.perf_counter(), policy_of(self.model)
        (points, spread), (life, _) = evaluate(
            lambda rows: policy.actions(rows[:, COLUMNS].astype(float)), self.balls
        )
        self.paused += time.perf_counter() - started
        self.unseen.append((self.num_timesteps, points, spread))
        print(
            f"{self.num_timesteps:10,} steps, {self.elapsed() / 60:4.1f} min: on unseen boards "
            f"{points:6.0f} ± {spread:.0f} points a ball, {life:5.1f} s",
            flush=True,
        )

    def _on_step(self):
        self._ended += [info["score"] for info in self.locals["infos"] if info]
        return self.elapsed() < self.seconds

    def _on_rollout_end(self):
        if self._ended:
            self.trained.append((self.num_timesteps, np.mean(self._ended)))
            self._ended = []
        if self.num_timesteps - self.unseen[-1][0] >= self.every:
            self._evaluate()


def draw(curve, random_points, path):
    """The learning curve as a picture."""
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    axes.plot(*np.array(curve.trained).reshape(-1, 2).T, color="#9aa7b8", label="boards of the training")
    steps, points, spread = np.array(curve.unseen).T
    axes.plot(steps, points, "o-", color="#1565c0", markersize=3, label="boards never seen, 95 %")
    axes.fill_between(steps, points - spread, points + spread, color="#1565c0", alpha=0.2, linewidth=0)
    axes.axhline(random_points, color="#c62828", linestyle="--", label="pressing at random")
    axes.set(xlabel="steps", ylabel="points a ball", xlim=(0, None), ylim=(0, None))
    axes.set_title(f"{curve.elapsed() / 60:.0f} minutes of PPO on random boards", loc="left")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left", frameon=False)
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


parser = argparse.ArgumentParser()
parser.add_argument("--minutes", type=float, default=15.0)
parser.add_argument("--steps", type=int, default=10**9)
parser.add_argument("--envs", type=int, default=512)
parser.add_argument("--boards", type=int, default=512, help="to train on")
parser.add_argument("--balls", type=int, default=1000, help="to evaluate with, each on a board of its own")
parser.add_argument("--every", type=int, default=2_000_000, help="steps between two evaluations")
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--out", default="curve.png", help="picture of the learning curve")
parser.add_argument("--policy", help="file for the policy as plain arrays (.npz)")
chosen = parser.parse_args()

torch.set_num_threads(2)
envs = Seen(SilverballVecEnv(chosen.envs, chosen.seed, boards=chosen.boards, frame_skip=60 // DECISIONS))
model = PPO(
    "MlpPolicy",
    VecNormalize(envs, norm_obs=False, gamma=(gamma := math.exp(-1 / DECISIONS / HORIZON))),
    n_steps=64,
    batch_size=min(8192, 64 * chosen.envs),
    n_epochs=4,
    gamma=gamma,
    learning_rate=1e-3,
    ent_coef=0.01,
    policy_kwargs={"net_arch": [64, 64], "activation_fn": torch.nn.ReLU},
    device="cpu",
    seed=chosen.seed,
)
random = np.random.default_rng(chosen.seed)
(random_points, spread), _ = evaluate(lambda rows: random.integers(0, 4, len(rows)), chosen.balls)
print(f"pressing at random: {random_points:.0f} ± {spread:.0f} points a ball", flush=True)
curve = Curve(chosen.minutes, chosen.balls // 2, chosen.every)
model.learn(chosen.steps, callback=curve)

policy = policy_of(model, "python " + " ".join(["examples/train_sb3.py", *sys.argv[1:]]))
actions = lambda rows: policy.actions(rows[:, COLUMNS].astype(float))  # noqa: E731
(points, spread), (life, life_spread) = evaluate(actions, chosen.balls)
print(
    f"after {curve.elapsed() / 60:.1f} min and {model.num_timesteps:,} steps, "
    f"{chosen.balls} balls on unseen boards: {points:.0f} ± {spread:.0f} points a ball, "
    f"{life:.1f} ± {life_spread:.1f} s, {points / random_points:.1f} times as much as at random"
)
draw(curve, random_points, chosen.out)
if chosen.policy:
    policy.save(chosen.policy)
    print(f"wrote {chosen.policy}")
