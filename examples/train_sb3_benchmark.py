"""DQN and QR-DQN of Stable-Baselines3 on a benchmark id, from its raw state or from small pictures.

pip install '.[rl]' stable-baselines3 sb3-contrib
python examples/train_sb3_benchmark.py --algorithm qr-dqn --seed 0 --out qr_dqn_0.npz --curve qr_dqn_0.csv
silverball bench agents silverball/PinballClassic-v1 --policy qr_dqn_0.npz

Of their parts only the exploration is another one: theirs draws once for all environments whether a step
is random, here each environment draws for itself.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
import time
from pathlib import Path

import numpy as np
import torch
from sb3_contrib import QRDQN
from stable_baselines3 import DQN
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from stable_baselines3.common.vec_env import VecNormalize
from torch import nn

from silverball.envs.sb3 import SilverballVecEnv

parser = argparse.ArgumentParser()
parser.add_argument("--algorithm", choices=("dqn", "qr-dqn"), default="dqn")
parser.add_argument("--id", default="silverball/PinballClassic-v1")
parser.add_argument("--steps", type=int, default=300_000, help="steps of all environments together")
parser.add_argument("--minutes", type=float, default=1e9, help="stop earlier, after so long")
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--envs", type=int, default=256)
parser.add_argument("--updates", type=int, default=16, help="of a round")
parser.add_argument("--pictures", action="store_true", help="learn from pictures, whatever the id")
parser.add_argument("--width", type=int, default=128, help="of the two hidden layers")
parser.add_argument("--out", default="", help="file for the policy, .npz")
parser.add_argument("--curve", default="", help="file for the learning curve, .csv")
chosen = parser.parse_args()
ARE_PICTURES = "Pixels" in chosen.id or chosen.pictures
OPTIONS = {"observation": "pixels", "size": (40, 20), "stack": 2} if ARE_PICTURES else {}
QUANTILES = 25
EVERY = 4  # steps of the vector between two rounds of updates
PART = 512  # transitions of an update
MIDDLE, SPREAD = 0.18, 0.1  # of the pixels of a picture


class EachExplores:
    """Draws for each environment whether its action is random."""

    def predict(self, observation, state=None, episode_start=None, deterministic=False):
        """The actions, some of them random unless they shall be deterministic."""
        actions, state = self.policy.predict(observation, state, episode_start, deterministic=True)
        if not deterministic:
            is_random = np.random.rand(len(actions)) < self.exploration_rate
            actions = np.where(is_random, np.random.randint(self.action_space.n, size=len(actions)), actions)
        return actions, state


class ExploringDQN(EachExplores, DQN):
    """DQN with many environments."""


class ExploringQRDQN(EachExplores, QRDQN):
    """QR-DQN with many environments."""


class Curve(BaseCallback):
    """Records the mean points of the balls that ended within 100,000 steps."""

    EACH = 100_000
    FEWEST = 50  # balls of the last row

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[tuple[int, float, float, int]] = []
        self.points: list[int] = []
        self.started = time.perf_counter()

    def _on_step(self) -> bool:
        self.points += [info["score"] for info in self.locals["infos"] if info]
        if self.num_timesteps // self.EACH > (self.num_timesteps - chosen.envs) // self.EACH:
            self.add_row()
        return time.perf_counter() - self.started < 60.0 * chosen.minutes

    def _on_training_end(self) -> None:
        if len(self.points) >= self.FEWEST or not self.rows:
            self.add_row()

    def add_row(self) -> None:
        """Record the balls since the last row."""
        if not self.points:
            return
        steps, seconds = self.num_timesteps, time.perf_counter() - self.started
        mean = float(np.mean(self.points))
        print(f"{steps:11,} steps, {seconds:6.0f} s: {mean:7.0f} points a ball", flush=True)
        self.rows.append((steps, round(seconds, 1), round(mean, 1), len(self.points)))
        self.points = []


class Eyes(BaseFeaturesExtractor):
    """A convolution over patches that do not overlap, and a layer that sees them all."""

    def __init__(self, space, width: int) -> None:
        super().__init__(space, width)
        self.filters = nn.Conv2d(space.shape[0], 16, 4, 4)
        inputs = self.filters(torch.zeros(1, *space.shape)).numel()
        self.layers = nn.Sequential(nn.ReLU(), nn.Flatten(), nn.Linear(inputs, width), nn.Tanh())

    def forward(self, pictures: torch.Tensor) -> torch.Tensor:
        """Pictures with values from 0 to 1 as features."""
        return self.layers(self.filters((pictures - MIDDLE) / SPREAD))


def store(path: str) -> None:
    """Write the network as plain arrays, which `silverball bench agents --policy` plays."""
    net = model.q_net if chosen.algorithm == "dqn" else model.quantile_net
    layers = [
        (one.weight.detach().numpy().T, one.bias.detach().numpy())
        for one in net.modules()
        if isinstance(one, nn.Linear)
    ]
    if chosen.algorithm == "qr-dqn":  # the mean of the quantiles is linear too
        weights, biases = layers[-1]
        layers[-1] = (
            weights.reshape(chosen.width, QUANTILES, -1).mean(1),
            biases.reshape(QUANTILES, -1).mean(0),
        )
    arrays = {
        "id": chosen.id,
        "options": json.dumps(OPTIONS),
        "contestant": f"{chosen.algorithm} pictures" if ARE_PICTURES else chosen.algorithm,
        "command": " ".join(["python", *sys.argv]),
        "steps": model.num_timesteps,
        "seed": chosen.seed,
    }
    if ARE_PICTURES:  # the first layer takes bytes then
        filters = net.features_extractor.filters
        weights = filters.weight.detach().numpy() / SPREAD
        arrays["filters0"] = weights / 255.0
        arrays["offsets0"] = filters.bias.detach().numpy() - MIDDLE * weights.sum((1, 2, 3))
        arrays["stride0"] = filters.stride[0]
    else:  # and raw observations here
        weights, biases = layers[0]
        middle, spread = envs.obs_rms.mean, np.sqrt(envs.obs_rms.var + envs.epsilon)
        layers[0] = (weights / spread[:, None], biases - (middle / spread) @ weights)
    for number, (weights, biases) in enumerate(layers):
        arrays[f"weights{number}"] = weights.astype(np.float32)
        arrays[f"biases{number}"] = biases.astype(np.float32)
    np.savez_compressed(path, **arrays)


torch.set_num_threads(1)  # the layers are small
envs = SilverballVecEnv(chosen.id, chosen.envs, seed=1000 * chosen.seed, **OPTIONS)
network = {"net_arch": [chosen.width, chosen.width], "activation_fn": nn.Tanh}
if ARE_PICTURES:
    network = {
        "net_arch": [chosen.width],
        "activation_fn": nn.Tanh,
        "features_extractor_class": Eyes,
        "features_extractor_kwargs": {"width": chosen.width},
    }
else:  # nothing is clipped, so that the first layer can take raw observations
    envs = VecNormalize(envs, norm_reward=False, clip_obs=1e6, epsilon=1e-4)
algorithm = ExploringDQN if chosen.algorithm == "dqn" else ExploringQRDQN
if chosen.algorithm == "qr-dqn":
    network["n_quantiles"] = QUANTILES
model = algorithm(
    "CnnPolicy" if ARE_PICTURES else "MlpPolicy",
    envs,
    learning_rate=lambda left: 5e-4 * (0.1 + 0.9 * left),
    buffer_size=300_000,
    learning_starts=min(50_000, chosen.steps // 10),
    batch_size=PART,
    gamma=0.99,
    train_freq=EVERY,
    gradient_steps=chosen.updates,
    n_steps=15,  # a second
    target_update_interval=EVERY * chosen.envs * 50,
    exploration_fraction=0.2,
    exploration_final_eps=0.01,
    policy_kwargs=network,
    device="cpu",
    seed=chosen.seed,
)
curve = Curve()
model.learn(chosen.steps, callback=curve)
if chosen.out:
    store(chosen.out)
    print(f"wrote {chosen.out}")
if chosen.curve:
    with Path(chosen.curve).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["steps", "seconds", "points_a_ball", "balls"])
        writer.writerows(curve.rows)
