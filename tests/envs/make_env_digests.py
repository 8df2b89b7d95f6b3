"""Write the digests of the registered environments again: `python tests/envs/make_env_digests.py`.

A digest that differs means that an id no longer gives the observations, rewards, ends and counts that it gave
when results on it were published, or that its table, rules or boards have changed. Then the id needs a new
version (`-v1`) and the old one must stay what it was. New ids and new runs may be added at any time.
"""

from __future__ import annotations

import hashlib
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

import gymnasium as gym
import numpy as np
import tomli_w

from silverball.envs import IDS
from silverball.table import generate_table, load_table, table_digest

FILE = Path(__file__).with_name("env_digests.toml")
REMEDY = (
    "an id gives what it gave: register a new version of it and leave the old one as it is; "
    "for new ids and runs run  python tests/envs/make_env_digests.py"
)
COUNTS = (
    "score", "created", "drained", "wall_hits", "slant_wall_hits", "paddle_hits", "triangular_prism_hits",
    "cylinder_hits", "ball_hits", "touches", "jams", "board", "stalled",
)  # fmt: skip
"""The keys of `info` that a digest covers: later ones may be added."""

DEVICES = {
    "format": 2,
    "name": "Devices",
    "board": {"max_balls": 3},
    "paddle": [
        {"side": "left", "pivot": [-4.5, -3.0], "length": 2.2},
        {"side": "right", "pivot": [-4.5, 2.2], "length": 2.2},
    ],
    "plunger": [{"position": [-6.0, 3.6], "launch": [6.0, 20.0], "charge": 1.0}],
    "drop_target": [{"start": [4.0, 3.2], "end": [4.0, 4.0], "bank": "top", "reset_after": 1.0}],
    "spinner": [{"start": [0.0, 3.0], "end": [0.0, 4.4]}],
    "cylinder": [{"center": [3.0, 1.0], "radius": 0.5}, {"center": [3.5, -1.5], "radius": 0.4}],
}
"""A table with devices, whose slots have places of their own in an observation."""

STATE_RUNS: dict[str, dict[str, Any]] = {
    "defaults": {},
    "four frames, three balls": {"frame_skip": 4, "balls": 3, "actions": "multibinary", "jitter": True},
    "own button, time": {"create": "button", "reward": "time", "stall": 4.0, "time_limit": 9.0},
    "by name, weights": {
        "observation": "dict", "tick_rate": 240,
        "reward": {"points": 0.1, "paddle_hits": 1.0, "drained": -3.0, "stalled": -1.0},
    },
}  # fmt: skip
PICTURE_RUNS: dict[str, dict[str, Any]] = {
    "defaults": {},
    "one in colour": {"rgb": True, "stack": 1, "size": (30, 20), "balls": 3},
    "two, four frames": {"stack": 2, "size": (24, 36), "frame_skip": 4},
}
GAME_RUNS: dict[str, dict[str, Any]] = {
    "defaults": {},
    "launched by hand, nudges": {"launch": "button", "jitter": True, "actions": "multibinary"},
    "by name, weights": {
        "observation": "dict", "tick_rate": 240,
        "reward": {"points": 0.1, "mode_started": 1.0, "counter bonus": 3.0, "mode skill": 2.0},
    },
}  # fmt: skip
VECTOR = {"time_limit": 2.0, "threads": 1}
STEPS, VECTOR_STEPS, ENVS, BOARDS = 400, 150, 5, 4


def runs(id_: str) -> dict[str, Any]:
    """What is recorded of an id: the digest of its table, of some boards, and of each run."""
    options = IDS[id_]
    table = load_table(options["table"])
    seeds = range(BOARDS) if table.random is not None else ()
    boards = [table_digest(generate_table(seed, table)) for seed in seeds]
    given = {"boards": BOARDS} if boards else {}
    recorded = {"table": table_digest(table)}
    if boards:
        recorded["boards"] = hashlib.sha256("".join(boards).encode()).hexdigest()
    shows_pictures = options.get("observation") == "pixels"
    chosen = PICTURE_RUNS if shows_pictures else GAME_RUNS if "rules" in options else STATE_RUNS
    for number, (name, run) in enumerate(chosen.items()):
        recorded[name] = of_one(gym.make(id_, **given, **run), seed=number)
    if chosen is STATE_RUNS:
        recorded["devices"] = of_one(gym.make(id_, table=DEVICES, balls=3), seed=7)
    for mode in ("NEXT_STEP", "SAME_STEP", "DISABLED"):
        envs = gym.make_vec(id_, ENVS, autoreset_mode=mode, **given, **VECTOR)
        recorded[f"vector, {mode}"] = of_many(envs, seed=11)
    return recorded


def numbers(seed: int, codes: int) -> Iterator[int]:
    """Actions for ever, each held for some steps; Python's `random` gives the same ones in every version."""
    random = Random(seed)
    while True:
        action = int(random.random() * codes)
        for _ in range(1 + int(random.random() * 12)):
            yield action


def bytes_of(value: Any) -> bytes:
    """The bytes of an observation, reward, end or info."""
    if isinstance(value, dict):
        return b"".join(bytes_of(value[name]) for name in sorted(value))
    return np.ascontiguousarray(value).tobytes()


def counts_of(info: dict[str, Any]) -> dict[str, Any]:
    """The counts of an info as int64, in the form that every version has."""
    return {name: np.asarray(info[name], np.int64) for name in COUNTS}


def of_one(env: gym.Env[Any, Any], seed: int) -> str:
    """The digest of some hundred steps of one environment, with resets where episodes end."""
    space: Any = env.action_space
    is_bits = isinstance(space, gym.spaces.MultiBinary)
    actions = numbers(seed, 1 << space.n if is_bits else int(space.n))
    observation, info = env.reset(seed=seed)
    found = hashlib.sha256(bytes_of(observation) + bytes_of(counts_of(info)))
    for _ in range(STEPS):
        code = next(actions)
        action = [code >> bit & 1 for bit in range(space.n)] if is_bits else code
        observation, reward, terminated, truncated, info = env.step(action)
        assert env.observation_space.contains(observation)
        for value in (observation, float(reward), terminated, truncated, counts_of(info)):
            found.update(bytes_of(value))
        if terminated or truncated:
            observation, info = env.reset()
            found.update(bytes_of(observation) + bytes_of(counts_of(info)))
    return found.hexdigest()


def of_many(envs: gym.vector.VectorEnv[Any, Any, Any], seed: int) -> str:
    """The digest of some hundred steps of a vector, whose environments get actions of their own."""
    space: Any = envs.single_action_space
    actions = [numbers(seed + number, int(space.n)) for number in range(ENVS)]
    observations, infos = envs.reset(seed=seed)
    found = hashlib.sha256(bytes_of(observations) + bytes_of(counts_of(infos)))
    for _ in range(VECTOR_STEPS):
        held = np.array([next(one) for one in actions])
        observations, rewards, terminated, truncated, infos = envs.step(held)
        for value in (observations, rewards, terminated, truncated, counts_of(infos)):
            found.update(bytes_of(value))
        if "final_obs" in infos:
            for row in np.flatnonzero(infos["_final_obs"]):
                found.update(bytes_of(infos["final_obs"][row]))
            found.update(bytes_of(counts_of(infos["final_info"])))
        over = terminated | truncated
        if over.any() and envs.metadata["autoreset_mode"] is gym.vector.AutoresetMode.DISABLED:
            observations, _ = envs.reset(options={"reset_mask": over})
            found.update(bytes_of(observations))
    return found.hexdigest()


def read() -> dict[str, dict[str, str]]:
    """The recorded digests, by id and run."""
    return tomllib.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}


if __name__ == "__main__":
    before, after = read(), {id_: runs(id_) for id_ in IDS}
    changed = [
        f"{id_}: {name}"
        for id_, recorded in before.items()
        for name, value in recorded.items()
        if after.get(id_, {}).get(name) != value
    ]
    FILE.write_text(tomli_w.dumps(after), encoding="utf-8")
    print(f"{len(after)} ids; changed: {', '.join(changed) or 'none'}", file=sys.stderr)
