"""PPO in one file, in the style of CleanRL: the loop uses only Gymnasium's vector interface.

pip install '.[rl]' torch
python examples/train_torch.py --steps 500000
"""

from __future__ import annotations

import argparse

import gymnasium as gym
import numpy as np
import torch
from torch import nn
from torch.distributions import Categorical

import silverball.envs  # noqa: F401  (registers the environments)

parser = argparse.ArgumentParser()
parser.add_argument("--id", default="silverball/Pinball-v1")
parser.add_argument("--steps", type=int, default=500_000)
parser.add_argument("--envs", type=int, default=256)
parser.add_argument("--boards", type=int, default=64)
chosen = parser.parse_args()
LENGTH, EPOCHS, PARTS, GAMMA, LAMBDA, CLIP = 64, 4, 8, 0.995, 0.95, 0.2

torch.manual_seed(0)
# With NEXT_STEP, the default, the step after the end of an episode is a reset and is masked out of the loss.
envs = gym.make_vec(chosen.id, chosen.envs, boards=chosen.boards)
envs = gym.wrappers.vector.RecordEpisodeStatistics(envs)
columns, actions = envs.single_observation_space.shape[0], int(envs.single_action_space.n)


def network(outputs: int) -> nn.Module:
    """Two hidden layers."""
    return nn.Sequential(
        nn.Linear(columns, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), nn.Linear(64, outputs)
    )


actor, critic = network(actions), network(1)
optimizer = torch.optim.Adam([*actor.parameters(), *critic.parameters()], 1e-3)

seen, _ = envs.reset(seed=0)
begins = np.zeros(chosen.envs, bool)  # whether this step only begins an episode
for update in range(max(1, chosen.steps // (LENGTH * chosen.envs))):
    rows = {name: [] for name in ("seen", "action", "log", "value", "reward", "over", "begins")}
    returns = []
    for _ in range(LENGTH):
        with torch.no_grad():
            state = torch.from_numpy(seen)
            choice = Categorical(logits=actor(state))
            action = choice.sample()
            value = critic(state)[:, 0]
        seen, reward, terminated, truncated, infos = envs.step(action.numpy())
        if "episode" in infos:
            returns += infos["episode"]["r"][infos["_episode"]].tolist()
        over = terminated | truncated
        for name, part in zip(
            rows, (state, action, choice.log_prob(action), value, reward, over, begins), strict=True
        ):
            rows[name].append(torch.as_tensor(part))
        begins = over
    data = {name: torch.stack(parts) for name, parts in rows.items()}
    with torch.no_grad():
        later, gain = critic(torch.from_numpy(seen))[:, 0], torch.zeros(chosen.envs)
        gains = torch.zeros(LENGTH, chosen.envs)
        for t in reversed(range(LENGTH)):
            goes_on = 1.0 - data["over"][t].float()
            error = data["reward"][t].float() + GAMMA * later * goes_on - data["value"][t]
            gain = gains[t] = error + GAMMA * LAMBDA * goes_on * gain
            later = data["value"][t]
    counts = ~data["begins"].reshape(-1)
    flat = {name: part.flatten(0, 1)[counts] for name, part in data.items()}
    gains = gains.reshape(-1)[counts]
    targets = gains + flat["value"]
    for _ in range(EPOCHS):
        for part in torch.randperm(len(gains)).chunk(PARTS):
            choice = Categorical(logits=actor(flat["seen"][part]))
            ratio = (choice.log_prob(flat["action"][part]) - flat["log"][part]).exp()
            good = (gains[part] - gains[part].mean()) / (gains[part].std() + 1e-8)
            policy = -torch.min(ratio * good, ratio.clamp(1 - CLIP, 1 + CLIP) * good).mean()
            miss = (critic(flat["seen"][part])[:, 0] - targets[part]).square().mean()
            loss = policy + 0.5 * miss - 0.01 * choice.entropy().mean()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_([*actor.parameters(), *critic.parameters()], 0.5)
            optimizer.step()
    if returns:
        steps = (update + 1) * LENGTH * chosen.envs
        print(f"{steps:9,} steps: {100 * np.mean(returns):6.0f} points a ball", flush=True)
