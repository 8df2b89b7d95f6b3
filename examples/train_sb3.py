"""Train the player `trained` of the windows: PPO of Stable-Baselines3 on random boards, in 15 minutes.

It learns from features made by hand, without the sticky actions and the power supply of the v1 ids, which a
game does not have; `train_benchmark.py` and `train_sb3_benchmark.py` train on those.

pip install '.[rl]' stable-baselines3 matplotlib
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
from silverball.metrics.ball_time import time_balls
from silverball.players.features import COLUMNS, ENCODED, MIRRORED, encode
from silverball.players.trained import DECISIONS, Policy
from silverball.world import WorldBatch

HORIZON = 6.0  # [s] after which a reward is discounted to 1/e
UNSEEN = 1_000_000  # seed of the first board of the evaluation; training uses 0, 1, …
MEAN_OF = 1000  # balls in the moving average of the training curve
LONGEST = 300.0  # [s] after which a ball is stopped


class Seen(VecEnvWrapper):
    """Observations as the features of `players/features.py`; balls on the right are mirrored to the left."""

    def __init__(self, envs):
        super().__init__(envs, Box(-10.0, 10.0, (ENCODED,), np.float32))

    def _see(self, rows):
        seen, is_mirrored = encode(rows[:, COLUMNS])
        return seen.astype(np.float32), is_mirrored

    def reset(self):
        seen, self._is_mirrored = self._see(self.venv.reset())
        return seen

    def step_async(self, actions):
        self.venv.step_async(np.where(self._is_mirrored, MIRRORED[actions], actions))

    def step_wait(self):
        rows, rewards, ended, infos = self.venv.step_wait()
        for row in np.flatnonzero(ended):
            last = infos[row]["terminal_observation"]
            infos[row]["terminal_observation"] = self._see(last[None])[0][0]
        seen, self._is_mirrored = self._see(rows)
        return seen, rewards, ended, infos


def policy_of(model, command=""):
    """The policy network as plain arrays."""
    net = model.policy
    linear = [*(one for one in net.mlp_extractor.policy_net if hasattr(one, "weight")), net.action_net]
    return Policy.rounded(
        [(one.weight.detach().numpy().T, one.bias.detach().numpy()) for one in linear], command
    )


def evaluate(policy, envs):
    """Mean points and time [s] of one ball on each board, with half widths of the 95 % intervals."""
    rows, _ = envs.reset(seed=0)
    points, steps, plays = np.zeros(len(rows)), np.zeros(len(rows)), np.ones(len(rows), bool)
    while plays.any():
        rows, _, terminated, truncated, infos = envs.step(policy.actions(rows[:, COLUMNS]))
        steps += plays
        ended = plays & (terminated | truncated)
        if ended.any():
            points[ended] = infos["final_info"]["score"][ended]
            plays &= ~ended
    return [(one.mean(), 1.96 * one.std() / math.sqrt(len(rows))) for one in (points, steps / DECISIONS)]


class Curve(BaseCallback):
    """Records the balls of the training, and evaluates on unseen boards at intervals."""

    def __init__(self, minutes, unseen, every):
        super().__init__()
        self.seconds, self.envs, self.every = 60 * minutes, unseen, every
        self.balls, self.unseen, self.minutes = [], [], []
        self.began, self.paused = time.perf_counter(), 0.0

    def elapsed(self):
        """Training time without evaluations [s]."""
        return time.perf_counter() - self.began - self.paused

    def evaluate(self):
        """Play on unseen boards; this does not count as training time."""
        started = time.perf_counter()
        (points, spread), (life, life_spread) = evaluate(policy_of(self.model), self.envs)
        self.paused += time.perf_counter() - started
        self.unseen.append((self.num_timesteps, points, spread))
        print(
            f"{self.num_timesteps:10,} steps, {self.elapsed() / 60:4.1f} min: "
            f"on {self.envs.num_envs} unseen boards {points:6.0f} ± {spread:.0f} points a ball, "
            f"{life:5.1f} ± {life_spread:.1f} s",
            flush=True,
        )

    def _on_training_start(self):
        self.began = time.perf_counter()
        self.evaluate()

    def _on_step(self):
        self.balls += [(self.num_timesteps, info["score"]) for info in self.locals["infos"] if info]
        return self.elapsed() < self.seconds

    def _on_rollout_end(self):
        self.minutes.append((self.num_timesteps, self.elapsed() / 60))
        last = self.unseen[-1][0]
        if self.num_timesteps - last >= min(
            self.every, max(self.every / 10, 2 * last)
        ):  # more often at first
            self.evaluate()


def draw(curve, others, path):
    """Plot the learning curve, with the points of other players on the unseen boards."""
    figure, axes = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
    millions = lambda steps: np.asarray(steps) / 1e6  # noqa: E731
    if len(curve.balls) >= MEAN_OF:
        steps, points = np.array(curve.balls, float).T
        smooth = np.convolve(points, np.full(MEAN_OF, 1 / MEAN_OF), "valid")
        label = f"boards of the training, mean of {MEAN_OF} balls"
        axes.plot(millions(steps[MEAN_OF - 1 :]), smooth, color="#9aa7b8", linewidth=1, label=label)
    steps, points, spread = np.array(curve.unseen).T
    axes.plot(
        millions(steps), points, "o-", color="#1565c0", markersize=4, label="boards never seen, with 95 %"
    )
    axes.fill_between(
        millions(steps), points - spread, points + spread, color="#1565c0", alpha=0.25, linewidth=0
    )
    for (name, height), colour in zip(others.items(), ("#c62828", "#2e7d32"), strict=True):
        axes.axhline(height, color=colour, linestyle="--", label=f"the player {name} on these")
    last = millions(curve.minutes[-1][0])
    axes.set(xlabel="steps [million]", ylabel="points a ball", xlim=(0, 1.02 * last), ylim=(0, None))
    axes.yaxis.set_major_formatter("{x:,.0f}")
    steps, minutes = np.array([(0, 0.0), *curve.minutes]).T
    steps, minutes = (
        np.append(steps, 2 * steps[-1]),
        np.append(minutes, 2 * minutes[-1]),
    )  # extrapolated beyond the end
    clock = axes.secondary_xaxis(
        "top",
        functions=(
            lambda x: np.interp(x, millions(steps), minutes),
            lambda x: np.interp(x, minutes, millions(steps)),
        ),
    )
    clock.set_xlabel("minutes of training")
    axes.grid(alpha=0.3)
    axes.legend(loc="center right", bbox_to_anchor=(1, 0.6 * others["reflex"] / axes.get_ylim()[1]))
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


parser = argparse.ArgumentParser()
parser.add_argument("--minutes", type=float, default=15.0, help="of training, evaluations left out")
parser.add_argument("--steps", type=int, default=10**9, help="at most")
parser.add_argument("--envs", type=int, default=512)
parser.add_argument("--boards", type=int, default=512, help="to train on")
parser.add_argument("--balls", type=int, default=1000, help="to evaluate with, on as many unseen boards")
parser.add_argument(
    "--every", type=int, default=3_000_000, help="steps between two evaluations, fewer at first"
)
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--out", default="curve.png", help="picture of the learning curve")
parser.add_argument("--policy", help="file for the policy as plain arrays (.npz)")
chosen = parser.parse_args()

torch.set_num_threads(1)  # the network is too small for two threads
options = {"frame_skip": 60 // DECISIONS, "time_limit": LONGEST}
unseen = PinballVectorEnv(
    chosen.balls, "SameStep", own_boards=True, boards=chosen.balls, board_seed=UNSEEN, **options
)
worlds = {
    name: WorldBatch(unseen.batch.tables, chosen.balls, UNSEEN, tick_rate=60) for name in ("random", "reflex")
}
others = {name: time_balls(one, name, LONGEST).score[0] for name, one in worlds.items()}
for name, points in others.items():
    print(f"the player {name}: {points:.0f} points a ball", flush=True)

gamma = math.exp(-1 / DECISIONS / HORIZON)
envs = Seen(SilverballVecEnv(chosen.envs, seed=chosen.seed, boards=chosen.boards, **options))
curve = Curve(chosen.minutes, unseen, chosen.every)
model = PPO(
    "MlpPolicy",
    VecNormalize(envs, norm_obs=False, gamma=gamma),  # normalises the rewards
    n_steps=64,
    batch_size=min(8192, 64 * chosen.envs),
    n_epochs=4,
    gamma=gamma,
    # Decays towards the end, measured by time or by steps, whichever is sooner.
    learning_rate=lambda left: 1e-3 * max(0.02, min(left, 1 - curve.elapsed() / curve.seconds)),
    ent_coef=0.01,
    policy_kwargs={"net_arch": [64, 64], "activation_fn": torch.nn.ReLU},
    device="cpu",
    seed=chosen.seed,
)
model.learn(chosen.steps, callback=curve)
curve.evaluate()
points = curve.unseen[-1][1]
print(f"that is {points / others['random']:.1f} times the points of the player random")
draw(curve, others, chosen.out)
if chosen.policy:
    policy_of(model, "python " + " ".join(["examples/train_sb3.py", *sys.argv[1:]])).save(chosen.policy)
    print(f"wrote {chosen.policy}")
