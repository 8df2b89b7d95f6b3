"""The tasks beside the score give what they gave when results on them were published.

A digest that differs means that an id needs a new version (`-v2`), and that the old one must stay what it
was. `python tests/envs/test_task_digests.py` prints the digests.
"""

from __future__ import annotations

import hashlib
from random import Random
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import silverball.envs  # noqa: F401  (registers)

DOMAIN, SHOTS = "silverball/PinBallDomain-v1", "silverball/PinballShots-v1"
STEPS = 400
RUNS: dict[str, tuple[str, dict[str, Any]]] = {
    "open": (DOMAIN, {"board": "open"}),
    "wall": (DOMAIN, {"board": "wall"}),
    "steps": (DOMAIN, {"board": "steps", "max_steps": 150}),
    "rooms": (DOMAIN, {"board": "rooms", "max_steps": 90}),
    "classic": (SHOTS, {"frame_skip": 4, "sticky": 0.25, "recharge": 0.0}),
    "own shots": (
        SHOTS,
        {"shots": ["left slingshot", "heart"], "frame_skip": 1, "sticky": 0.0, "recharge": 0.0},
    ),
}
RECORDED = {
    "open": "c02e6a7a0c61541b798c37103996431d3e8800c8205b8437d7d049e617607478",
    "wall": "2c772fc4eff7c9535c5140ef377776a5244910309a7713a1d4beb2329f76f2f0",
    "steps": "ea8c11130f5bc7bacd779f642be18f2a07bfeb62cc3a1f4011dadee28552c52d",
    "rooms": "40aec399f7ca7d33a7e3e3d16990134e63a5fab5bfabb1caea34a9f4448bb8c4",
    "classic": "5a98a4f54bf3038f3a0e2bc2a396d978896616683e1b0af7f9f670e587716739",
    "own shots": "4d5f17954c7bd35bd5dfb9b7933eee938ebf05fe42ad3fca3063e0d12b0fcc9e",
}


def digest(id_: str, options: dict[str, Any]) -> str:
    """The digest of some hundred steps, with resets where episodes end."""
    env, random = gym.make(id_, **options), Random(1)
    codes = int(env.action_space.n)  # type: ignore[attr-defined]
    found = hashlib.sha256(bytes_of(env.reset(seed=1)))
    for number in range(STEPS):
        if number % 5 == 0:
            action = int(random.random() * codes)
        step = env.step(action)
        found.update(bytes_of(step))
        if step[2] or step[3]:
            found.update(bytes_of(env.reset()))
    return found.hexdigest()


def bytes_of(value: Any) -> bytes:
    """The bytes of observations, rewards, ends and infos."""
    if isinstance(value, dict):
        return b"".join(bytes_of(value[name]) for name in sorted(value))
    if isinstance(value, tuple):
        return b"".join(map(bytes_of, value))
    return np.ascontiguousarray(value).tobytes()


@pytest.mark.parametrize("name", RUNS)
def test_a_task_gives_what_it_gave(name):
    assert digest(*RUNS[name]) == RECORDED[name], "the id needs a new version, or the old behaviour again"


def test_a_digest_notices_another_board_and_limit():
    others = [digest(DOMAIN, {"board": "open", "max_steps": limit}) for limit in (20, 21)]
    assert len({RECORDED["open"], RECORDED["wall"], *others}) == 4


if __name__ == "__main__":
    for run, (id_of_run, options_of_run) in RUNS.items():
        print(f'    "{run}": "{digest(id_of_run, options_of_run)}",')
