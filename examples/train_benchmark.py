"""PPO on a benchmark id, in one file: trains with one seed and stores the policy and its learning curve.

pip install '.[rl]' torch
python examples/train_benchmark.py --steps 10000000 --out ppo.npz --curve ppo.csv
silverball bench agents silverball/PinballClassic-v1 --policy ppo.npz

It sees the raw observation and nothing else. Pictures (of PinballPixels-v1, or of any id with
--option observation=pixels) go through a convolution over patches that do not overlap. With --memory a
gated recurrent unit remembers what was seen, as it must with --option sight=positions.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import json
import sys
import time
from pathlib import Path

import gymnasium as gym
import numpy as np
import torch
from torch import nn
from torch.distributions import Categorical

import silverball.envs  # noqa: F401  (registers the environments)

parser = argparse.ArgumentParser()
parser.add_argument("--id", default="silverball/PinballClassic-v1")
parser.add_argument("--steps", type=int, default=10_000_000, help="steps of all environments together")
parser.add_argument("--minutes", type=float, default=1e9, help="stop earlier, after so long")
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--envs", type=int, default=256)
parser.add_argument("--length", type=int, default=128, help="steps between two updates")
parser.add_argument("--part", type=int, default=4096, help="steps of a minibatch")
parser.add_argument("--epochs", type=int, default=4, help="of an update")
parser.add_argument("--width", type=int, default=128, help="of the two hidden layers")
parser.add_argument("--memory", action="store_true", help="a recurrent unit before the heads")
parser.add_argument(
    "--rate", type=float, default=5e-4, help="learning rate at the start; it falls to a tenth"
)
parser.add_argument(
    "--option",
    action="append",
    default=[],
    metavar="NAME=VALUE",
    help="what is seen: sight=positions, stack=4",
)
parser.add_argument("--out", default="", help="file for the policy, .npz")
parser.add_argument("--curve", default="", help="file for the learning curve, .csv")
chosen = parser.parse_args()
GAMMA, LAMBDA, CLIP, ENTROPY = 0.995, 0.95, 0.2, 0.01
REWARD = 0.1  # factor of rewards, so that returns are of the order of 1
NORMALISED = 10  # updates after which the scale of observations is kept

torch.manual_seed(chosen.seed)
torch.set_num_threads(1)  # the layers are small


def value_of(text: str) -> object:
    """A value on the command line: JSON, or else a word."""
    try:
        return json.loads(text)
    except ValueError:
        return text


options = {name: value_of(text) for name, _, text in (one.partition("=") for one in chosen.option)}
are_pictures = "Pixels" in chosen.id or options.get("observation") == "pixels"
if are_pictures:
    options = {"observation": "pixels", "size": (40, 20), "stack": 2} | options
envs = gym.make_vec(chosen.id, chosen.envs, autoreset_mode="SAME_STEP", **options)
shape, actions = envs.single_observation_space.shape, int(envs.single_action_space.n)


def body() -> tuple[nn.Module, int]:
    """What makes numbers of an observation, and how many; actor and critic share it."""
    if not are_pictures:
        return nn.Identity(), shape[0]
    layers = nn.Sequential(nn.Conv2d(shape[0], 16, 4, 4), nn.ReLU(), nn.Flatten())
    inputs = layers(torch.zeros(1, *shape)).shape[1]
    if chosen.memory:
        return layers, inputs
    return layers.extend([nn.Linear(inputs, chosen.width), nn.Tanh()]), chosen.width


def head(inputs: int, outputs: int, gain: float) -> nn.Module:
    """Layers with two hidden ones, or with one behind those that actor and critic share."""
    is_shared = are_pictures or chosen.memory
    sizes = (inputs, chosen.width) if is_shared else (inputs, chosen.width, chosen.width)
    layers: list[nn.Module] = []
    for before, after in itertools.pairwise(sizes):
        layers += [nn.Linear(before, after), nn.Tanh()]
    layers.append(nn.Linear(sizes[-1], outputs))
    for layer in layers[::2]:
        nn.init.orthogonal_(layer.weight, gain if layer is layers[-1] else 2**0.5)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(*layers)


eyes, features = body()
for layer in eyes.modules():
    if isinstance(layer, (nn.Conv2d, nn.Linear)):
        nn.init.orthogonal_(layer.weight, 2**0.5)
        nn.init.zeros_(layer.bias)
memory = nn.GRUCell(features, chosen.width) if chosen.memory else None
if memory is not None:
    features = chosen.width
actor, critic = head(features, actions, 0.01), head(features, 1, 1.0)
shared = [*eyes.parameters(), *(memory.parameters() if memory else ())]
parameters = [*shared, *actor.parameters(), *critic.parameters()]
optimizer = torch.optim.Adam(parameters, chosen.rate, eps=1e-5)


def look(observations: np.ndarray | torch.Tensor) -> torch.Tensor:
    """Observations as the input of the heads."""
    return eyes((torch.as_tensor(np.asarray(observations)) - middle) / spread)


def remember(inputs: torch.Tensor, state: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """The input of the heads, and what is remembered after it."""
    if memory is None:
        return inputs, state
    state = memory(inputs, state)
    return state, state


def parts() -> list[torch.Tensor]:
    """The minibatches of an epoch, as numbers of steps; with memory each has whole rows of environments."""
    if memory is None:
        return list(torch.randperm(batch).split(chosen.part))
    groups = torch.randperm(chosen.envs).split(max(1, chosen.part // chosen.length))
    return [(torch.arange(chosen.length)[:, None] * chosen.envs + group).flatten() for group in groups]


def look_at(part: torch.Tensor) -> torch.Tensor:
    """The input of the heads for a minibatch; memory goes through its steps again."""
    inputs = look(flat[part.numpy()])
    if memory is None:
        return inputs
    group = part[: len(part) // chosen.length]
    state, remembered = first_state[group], []
    for step, row in enumerate(inputs.view(chosen.length, len(group), -1)):
        state = memory(row, state)
        remembered.append(state)
        state = state * (1.0 - over[step, group])[:, None]
    return torch.cat(remembered)


def store(path: str, steps: int) -> None:
    """Write the actor as plain arrays, which `silverball bench agents --policy` plays."""
    arrays = {
        "id": chosen.id,
        "options": json.dumps(options),
        "contestant": name,
        "command": " ".join(["python", *sys.argv]),
        "steps": steps,
        "seed": chosen.seed,
    }
    filters = [layer for layer in eyes.modules() if isinstance(layer, nn.Conv2d)]
    layers = [layer for layer in (*eyes.modules(), *actor.modules()) if isinstance(layer, nn.Linear)]
    for number, layer in enumerate([*filters, *layers]):
        weights, biases = layer.weight.detach(), layer.bias.detach()
        if number == 0 and (filters or memory is None):  # it takes raw observations then
            weights, shift = weights / spread, weights * (middle / spread)
            biases = biases - shift.flatten(1).sum(1)
        if layer in filters:
            arrays[f"filters{number}"], arrays[f"offsets{number}"] = weights.numpy(), biases.numpy()
            arrays[f"stride{number}"] = layer.stride[0]
        else:
            place = number - len(filters)
            arrays[f"weights{place}"], arrays[f"biases{place}"] = weights.numpy().T, biases.numpy()
    if memory is not None:
        inputs, offsets = memory.weight_ih.detach(), memory.bias_ih.detach()
        if not filters:
            inputs, offsets = inputs / spread, offsets - inputs @ (middle / spread)
        arrays["memory_inputs"], arrays["memory_offsets"] = inputs.numpy(), offsets.numpy()
        arrays["memory_states"] = memory.weight_hh.detach().numpy()
        arrays["memory_state_offsets"] = memory.bias_hh.detach().numpy()
    np.savez_compressed(path, **arrays)


seen_as = ["pictures"] * are_pictures + [str(options.get("sight", ""))] + ["memory"] * chosen.memory
name = " ".join(["ppo", *filter(None, seen_as)])
rows: list[tuple[int, float, float, float]] = []
seen, _ = envs.reset(seed=1000 * chosen.seed)
middle, spread = torch.zeros(shape[-1]), torch.ones(shape[-1])  # of the columns of a state
if are_pictures:  # of all pixels
    middle, spread = torch.tensor(seen.mean(dtype=np.float32)), torch.tensor(seen.std(dtype=np.float32))
state = torch.zeros(chosen.envs, chosen.width)
total, started, batch = np.zeros(chosen.envs), time.perf_counter(), chosen.envs * chosen.length
updates = max(1, chosen.steps // batch)
for update in range(updates):
    late = (time.perf_counter() - started) / (60.0 * chosen.minutes)
    left = max(0.0, 1.0 - max(update / updates, late))
    optimizer.param_groups[0]["lr"] = chosen.rate * (0.1 + 0.9 * left)
    kept = np.empty((chosen.length, *seen.shape), seen.dtype)
    taken = torch.empty(chosen.length, chosen.envs, dtype=torch.int64)
    logs, values, rewards, over = (torch.empty(chosen.length, chosen.envs) for _ in range(4))
    returns: list[float] = []
    first_state = state
    for step in range(chosen.length):
        with torch.no_grad():
            inputs, state = remember(look(seen), state)
            choice = Categorical(logits=actor(inputs), validate_args=False)
            action = choice.sample()
            taken[step], logs[step] = action, choice.log_prob(action)
            values[step] = critic(inputs)[:, 0]
        kept[step] = seen
        seen, reward, terminated, truncated, infos = envs.step(action.numpy())
        total += reward
        reward = REWARD * reward
        ended = terminated | truncated
        if truncated.any():  # an episode that was only cut short goes on in the critic's eyes
            with torch.no_grad():
                last = np.stack([infos["final_obs"][row] for row in np.flatnonzero(truncated)])
                inputs, _ = remember(look(last), state[torch.from_numpy(truncated)])
                reward[truncated] += GAMMA * critic(inputs)[:, 0].numpy()
        rewards[step], over[step] = torch.from_numpy(reward), torch.from_numpy(ended)
        state = state * (1.0 - over[step])[:, None]
        returns += total[ended].tolist()
        total[ended] = 0.0
    with torch.no_grad():
        later = critic(remember(look(seen), state)[0])[:, 0]
        gain, gains = torch.zeros(chosen.envs), torch.empty_like(values)
        for step in reversed(range(chosen.length)):
            goes_on = 1.0 - over[step]
            error = rewards[step] + GAMMA * later * goes_on - values[step]
            gain = gains[step] = error + GAMMA * LAMBDA * goes_on * gain
            later = values[step]
    if not are_pictures and update < NORMALISED:
        columns = torch.from_numpy(kept.reshape(batch, -1))
        share = 1.0 / (update + 1)
        middle = middle + share * (columns.mean(0) - middle)
        spread = spread + share * (columns.std(0).clamp(min=1e-2) - spread)
    targets, gains = (gains + values).reshape(-1), gains.reshape(-1)
    flat = kept.reshape(batch, *seen.shape[1:])
    taken, logs = taken.reshape(-1), logs.reshape(-1)
    for _ in range(chosen.epochs):
        for part in parts():
            inputs = look_at(part)
            choice = Categorical(logits=actor(inputs), validate_args=False)
            ratio = (choice.log_prob(taken[part]) - logs[part]).exp()
            good = (gains[part] - gains[part].mean()) / (gains[part].std() + 1e-8)
            policy = -torch.min(ratio * good, ratio.clamp(1 - CLIP, 1 + CLIP) * good).mean()
            miss = (critic(inputs)[:, 0] - targets[part]).square().mean()
            loss = policy + 0.5 * miss - ENTROPY * left * choice.entropy().mean()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_([*shared, *actor.parameters()], 0.5)
            nn.utils.clip_grad_norm_(critic.parameters(), 0.5)
            optimizer.step()
    steps, seconds = (update + 1) * batch, time.perf_counter() - started
    if returns:
        rows.append((steps, round(seconds, 1), round(100 * float(np.mean(returns)), 1), len(returns)))
        if update % 10 == 0 or update == updates - 1:
            print(f"{steps:11,} steps, {seconds:6.0f} s: {rows[-1][2]:7.0f} points a ball", flush=True)
    if seconds > 60.0 * chosen.minutes:
        break
if chosen.out:
    store(chosen.out, steps)
if chosen.curve:
    with Path(chosen.curve).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["steps", "seconds", "points_a_ball", "balls"])
        writer.writerows(rows)
