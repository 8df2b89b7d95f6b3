"""Train the missions network of the trained player: PPO on whole games of silver_comet, in one file.

pip install '.[rl]' torch
python examples/train_missions.py --minutes 45 --out missions.npz --curve missions.csv
python examples/train_missions.py --policy missions.npz --rate 3e-4 --out new.npz    # the table has changed

Half of the games are those of PinballMissions-v1, half are played as in a window, without sticky actions
and power supply. A step is rewarded by the root of its points: single shots pay from a hundred to a million.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from pathlib import Path

import gymnasium as gym
import numpy as np
import torch
from torch import nn
from torch.distributions import Categorical

import silverball.envs  # noqa: F401  (registers the environments)
from silverball.errors import SilverballError
from silverball.players.exact_layers import SCALE
from silverball.players.mission_features import feature_count, mission_features
from silverball.players.mission_policy import ACTIONS, NAMED, MissionPolicy

parser = argparse.ArgumentParser()
parser.add_argument("--steps", type=int, default=30_000_000, help="steps of all environments together")
parser.add_argument("--minutes", type=float, default=1e9, help="stop earlier, after so long")
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--envs", type=int, default=512)
parser.add_argument("--length", type=int, default=96, help="steps between two updates")
parser.add_argument("--width", type=int, default=192, help="of the hidden layers")
parser.add_argument("--rate", type=float, default=6e-4, help="learning rate at the start")
parser.add_argument("--power", type=float, default=0.5, help="rewards are points to this power")
begins = parser.add_mutually_exclusive_group()
begins.add_argument("--policy", default="", help="begin with this policy, .npz")
begins.add_argument("--init", default="", help="go on from this state, .pt")
parser.add_argument("--state", default="", help="file for the state of the training, .pt")
parser.add_argument("--out", default="", help="file for the policy, .npz")
parser.add_argument("--curve", default="", help="file for the learning curve, .csv")
chosen = parser.parse_args()
EPOCHS, PART, GAMMA, LAMBDA, CLIP, ENTROPY = 3, 4096, 0.997, 0.95, 0.2, 0.01
NORMALISED, SCALED = 15, 60  # updates after which the scales of features and of rewards are kept
LEAST_SPREAD = 0.1  # of a feature
WATCHED, LEARNS_WORTH = 400, 10  # steps in which a given policy is watched; updates before it is changed

torch.manual_seed(chosen.seed)
torch.set_num_threads(1)  # the layers are small
half = chosen.envs // 2
vectors = [
    gym.make_vec(
        "silverball/PinballMissions-v1", count, autoreset_mode="SAME_STEP", zero_copy=True, **options
    ).unwrapped
    for count, options in ((chosen.envs - half, {}), (half, {"sticky": 0.0, "recharge": 0.0}))
]
names = vectors[0].rule_names
switches = int(vectors[0].batch.boards.board[0]["switches"])
sizes = (*(len(names[kind]) for kind in NAMED), switches)
inputs = feature_count(*sizes)


def look() -> torch.Tensor:
    """The features of all games."""
    found = []
    for envs in vectors:
        batch = envs.batch
        boards = batch.boards
        own = (batch.state, envs.games.records, boards.board[batch.board_of], boards.collider)
        found.append(mission_features(*own, sizes, batch.tick_rate, envs.charge))
    return torch.from_numpy(np.concatenate(found).astype(np.float32))


def step(action: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which games are over, the scores now, and at the end of the step, before the next game begins."""
    done = [envs.step(own) for envs, own in zip(vectors, np.split(action, [chosen.envs - half]), strict=True)]
    over = [terminated | truncated for _, _, terminated, truncated, _ in done]
    now = [infos["score"].copy() for *_, infos in done]
    last = [score.copy() for score in now]
    for ended, score, (*_, infos) in zip(over, last, done, strict=True):
        if ended.any():
            score[ended] = infos["final_info"]["score"][ended]
    return np.concatenate(over), np.concatenate(now), np.concatenate(last)


class Net(nn.Module):
    """The network of the player, and another head that says what a situation is worth."""

    def __init__(self) -> None:
        super().__init__()
        width = chosen.width
        self.first, self.second, self.last = (
            nn.Linear(inputs, width), nn.Linear(width, width), nn.Linear(width, ACTIONS)
        )  # fmt: skip
        self.worth = nn.Sequential(nn.Linear(width, width), nn.ReLU(), nn.Linear(width, 1))
        for layer in (self.first, self.second, self.last, self.worth[0], self.worth[2]):
            nn.init.orthogonal_(layer.weight, 0.01 if layer is self.last else 2**0.5)
            nn.init.zeros_(layer.bias)

    def forward(self, features: torch.Tensor) -> tuple[Categorical, torch.Tensor]:
        """How likely each action is, and what the situation is worth."""
        with torch.autocast("cpu", torch.bfloat16):  # three times as fast, where the processor has it
            seen = self.first(features).relu()
            logits, worth = self.last(self.second(seen).relu()), self.worth(seen)[:, 0]
        return Categorical(logits=logits.float(), validate_args=False), worth.float()


def store(path: str) -> None:
    """Write the policy as the player reads it."""
    layers = [(layer.weight.detach(), layer.bias.detach()) for layer in (net.first, net.second, net.last)]
    weights, biases = layers[0]
    layers[0] = weights / spread, biases - weights @ (middle / spread)  # it takes features as they are
    arrays = [(weights.numpy().T, biases.numpy()) for weights, biases in layers]
    policy = MissionPolicy.rounded(arrays, names, switches, " ".join(["python", *sys.argv]))
    policy.save(path)


def begin_with(path: str) -> tuple[torch.Tensor, torch.Tensor]:
    """Begin with a policy, and return the scales of the features that are seen while it plays."""
    try:
        policy = MissionPolicy.load(path)
        policy.check(vectors[0].games.books, vectors[0].batch.boards.board)
    except SilverballError as error:
        parser.error(f"--policy: {error}")
    widths = [biases.size for _, biases in policy.layers]
    if widths != [chosen.width, chosen.width, ACTIONS]:
        parser.error(
            f"--policy {path}: its layers have {widths} outputs, expected {[chosen.width] * 2 + [ACTIONS]}: "
            f"add --width {widths[0]}, or give a policy of two equal hidden layers"
        )
    own = (net.first, net.second, net.last)
    for layer, (weights, biases) in zip(own, policy.layers, strict=True):
        layer.weight.data = torch.from_numpy(weights.T / SCALE).float().contiguous()
        layer.bias.data = torch.from_numpy(biases / SCALE).float()
    total, squares = torch.zeros(inputs, dtype=torch.float64), torch.zeros(inputs, dtype=torch.float64)
    for _ in range(WATCHED):
        features = look()
        with torch.no_grad():
            step(net(features)[0].sample().numpy())
        total += features.mean(0)
        squares += features.double().square().mean(0)
    middle = total / WATCHED
    spread = (squares / WATCHED - middle.square()).clamp(min=0.0).sqrt().clamp(min=LEAST_SPREAD)
    net.first.bias.data += net.first.weight.data @ middle.float()
    net.first.weight.data *= spread.float()
    return middle.float(), spread.float()


net = Net()
optimizer = torch.optim.Adam(net.parameters(), chosen.rate, eps=1e-5)
middle, spread = torch.zeros(inputs), torch.ones(inputs)
variance, before = 1.0, 0  # of discounted rewards; steps of earlier runs
if chosen.init:
    state = torch.load(chosen.init)
    net.load_state_dict(state["net"])
    optimizer.load_state_dict(state["optimizer"])
    middle, spread, variance, before = (state[name] for name in ("middle", "spread", "variance", "steps"))
for number, envs in enumerate(vectors):
    envs.reset(seed=1000 * chosen.seed + 100_000 * number + 1)
if chosen.policy:
    middle, spread = begin_with(chosen.policy)
seen, score, rows = look(), np.zeros(chosen.envs, np.int64), []
gathered, returns = np.zeros(chosen.envs), np.zeros(0)
ends: tuple[list[int], list[int]] = ([], [])
started, batch = time.perf_counter(), chosen.envs * chosen.length
updates = max(1, chosen.steps // batch)
for update in range(updates):
    left = 1.0 - max(update / updates, min(1.0, (time.perf_counter() - started) / 60.0 / chosen.minutes))
    optimizer.param_groups[0]["lr"] = chosen.rate * (0.1 + 0.9 * left)
    kept = torch.empty(chosen.length, chosen.envs, inputs)
    taken = torch.empty(chosen.length, chosen.envs, dtype=torch.int64)
    logs, values, rewards, over = (torch.empty(chosen.length, chosen.envs) for _ in range(4))
    for number in range(chosen.length):
        with torch.no_grad():
            choice, values[number] = net((seen - middle) / spread)
            taken[number] = choice.sample()
            logs[number] = choice.log_prob(taken[number])
        kept[number] = seen
        ended, now, last = step(taken[number].numpy())
        seen, gain = look(), (np.maximum(last - score, 0) / 1000.0) ** chosen.power
        score, gathered = now, GAMMA * gathered + gain
        if update < SCALED and not chosen.init:
            returns = np.append(returns, gathered[::16])
            variance = float(returns.var()) + 1e-8
        gathered[ended] = 0.0
        rewards[number], over[number] = torch.from_numpy(gain / variance**0.5), torch.from_numpy(ended)
        for game in np.flatnonzero(ended):
            ends[int(game >= chosen.envs - half)].append(int(last[game]))
    with torch.no_grad():
        later = net((seen - middle) / spread)[1]
        gain_of, gains = torch.zeros(chosen.envs), torch.empty_like(values)
        for number in reversed(range(chosen.length)):
            goes_on = 1.0 - over[number]
            error = rewards[number] + GAMMA * later * goes_on - values[number]
            gain_of = gains[number] = error + GAMMA * LAMBDA * goes_on * gain_of
            later = values[number]
    features = kept.reshape(batch, inputs)
    if update < NORMALISED and not (chosen.init or chosen.policy):
        share = 1.0 / (update + 1)
        middle = middle + share * (features.mean(0) - middle)
        spread = spread + share * (features.std(0).clamp(min=LEAST_SPREAD) - spread)
    targets, gains = (gains + values).reshape(-1), gains.reshape(-1)
    gains = (gains - gains.mean()) / (gains.std() + 1e-8)
    taken, logs, inputs_of = taken.reshape(-1), logs.reshape(-1), (features - middle) / spread
    for _ in range(EPOCHS):
        for part in torch.randperm(batch).split(PART):
            choice, worth = net(inputs_of[part])
            ratio, good = (choice.log_prob(taken[part]) - logs[part]).exp(), gains[part]
            policy = -torch.min(ratio * good, ratio.clamp(1 - CLIP, 1 + CLIP) * good).mean()
            miss = (worth - targets[part]).square().mean()
            loss = policy + 0.5 * miss - ENTROPY * left * choice.entropy().mean()
            optimizer.zero_grad()
            loss.backward()
            if chosen.policy and update < LEARNS_WORTH:
                for layer in (net.first, net.second, net.last):
                    layer.weight.grad = layer.bias.grad = None
            nn.utils.clip_grad_norm_(net.parameters(), 0.5)
            optimizer.step()
    steps, seconds = before + (update + 1) * batch, time.perf_counter() - started
    if (update % 10 == 9 or update == updates - 1) and all(ends):
        means = [round(float(np.mean(one[-1000:])), 1) for one in ends]
        rows.append((steps, round(seconds, 1), *means))
        print(
            f"{steps:11,} steps, {seconds:6.0f} s: {means[0]:10,.0f} points a game, "
            f"{means[1]:10,.0f} as in a window",
            flush=True,
        )
    if seconds > 60.0 * chosen.minutes:
        break
if chosen.out:
    store(chosen.out)
    print(f"wrote {chosen.out}")
if chosen.state:
    own = {"net": net.state_dict(), "optimizer": optimizer.state_dict(), "variance": variance}
    torch.save(own | {"middle": middle, "spread": spread, "steps": steps}, chosen.state)
if chosen.curve:
    with Path(chosen.curve).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["steps", "seconds", "points_a_game", "points_a_game_in_a_window"])
        writer.writerows(rows)
