"""PPO of Stable-Baselines3 on random boards, and the training curve as a picture.

pip install 'silverball[rl]' stable-baselines3 matplotlib
python examples/train_sb3.py --steps 1000000 --out curve.png
"""

from __future__ import annotations

import argparse

import matplotlib.pyplot as plt
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from silverball.envs.sb3 import SilverballVecEnv


class Curve(BaseCallback):
    """Notes down how the episodes that ended since the last rollout went."""

    def _on_training_start(self) -> None:
        self.steps: list[int] = []
        self.returns: list[float] = []
        self._ended: list[float] = []

    def _on_step(self) -> bool:
        self._ended += [info["episode"]["r"] for info in self.locals["infos"] if info]
        return True

    def _on_rollout_end(self) -> None:
        if self._ended:
            self.steps.append(self.num_timesteps)
            self.returns.append(float(np.mean(self._ended)))
            print(f"{self.num_timesteps:9,} steps: {100 * self.returns[-1]:6.0f} points a ball", flush=True)
            self._ended = []


parser = argparse.ArgumentParser()
parser.add_argument("--steps", type=int, default=1_000_000)
parser.add_argument("--envs", type=int, default=256)
parser.add_argument("--boards", type=int, default=64)
parser.add_argument("--out", default="curve.png")
chosen = parser.parse_args()

envs = SilverballVecEnv(chosen.envs, seed=0, boards=chosen.boards, frame_skip=4)
model = PPO("MlpPolicy", envs, n_steps=64, batch_size=2048, n_epochs=4, gamma=0.995, device="cpu", seed=0)
curve = Curve()
model.learn(chosen.steps, callback=curve)

plt.plot(curve.steps, [100 * value for value in curve.returns])
plt.xlabel("steps")
plt.ylabel("points a ball")
plt.savefig(chosen.out, dpi=120)
print(f"wrote {chosen.out}")
