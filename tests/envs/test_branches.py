"""A step, a restore and the same step again give the same bits, after every kind of step.

A state is saved after steps of every kind: a ball in the gutter, a stall, the time limit, the beginning of an
episode, a ball created by its button, a shove, and plain ones; in all three autoreset modes, with states and
with pictures, in one process and in another.
"""

from __future__ import annotations

import hashlib
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from silverball.envs import PinballEnv, PinballVectorEnv

COUNT = 6
AHEAD = 40  # steps that are compared after going back
OFTEN = 3  # times that each kind is tried
JITTER, CREATE = 4, 8
KINDS = {"plain", "gutter", "stalled", "time limit", "begun", "created", "shoved"}
GAME = {
    "boards": 3,
    "balls": 2,
    "jitter": True,
    "create": "button",
    "stall": 3.0,
    "time_limit": 6.0,
    "frame_skip": 2,
}
SIGHTS = {
    "state": {},
    "dict": {"observation": "dict"},
    "pictures": {"observation": "pixels", "size": (20, 12), "stack": 3},
    "a picture": {"observation": "pixels", "size": (20, 12), "stack": 1, "rgb": True},
}


def plain(value):
    """A nested result as something that can be compared and hashed."""
    if isinstance(value, dict):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, tuple) or (isinstance(value, np.ndarray) and value.dtype == object):
        return [plain(part) for part in value]
    return (value.dtype.str, value.shape, value.tobytes()) if isinstance(value, np.ndarray) else value


def actions(seed: int, steps: int, choices: int = 16) -> np.ndarray:
    """Buttons [step, env] that are held for a while; most balls end in the gutter or wait to be created."""
    random = np.random.default_rng(seed)
    some = random.integers(0, choices, (steps // 8 + 1, COUNT))
    some[random.random(some.shape) < 0.3] &= ~CREATE
    return np.repeat(some, 8, axis=0)[:steps]


def step(envs: PinballVectorEnv, row: np.ndarray) -> list:
    """A step, and the resets of ended episodes if autoreset is disabled."""
    result = envs.step(row)
    told = [plain(result)]
    over = result[2] | result[3]
    if envs.autoreset_mode is AutoresetMode.DISABLED and over.any():
        told.append(plain(envs.reset(options={"reset_mask": over})))
    return [*told, result]


def future(envs: PinballVectorEnv, rows: np.ndarray) -> list:
    return [step(envs, row)[:-1] for row in rows]


def digest(trace: list) -> str:
    return hashlib.sha256(pickle.dumps(trace)).hexdigest()


def kinds_of(result: tuple, before: dict, row: np.ndarray, begun: np.ndarray) -> set[str]:
    """What kinds of steps the environments have just made; `begun`: whose first step it was."""
    _, _, terminated, truncated, infos = result
    ended = terminated | truncated
    finals = infos.get("final_info", infos)
    last = {name: np.where(ended, finals[name], infos[name]) for name in ("stalled", "drained")}
    goes_on = ~ended & ~begun
    created = goes_on & (infos["created"] > before["created"])
    is_shoved = row & JITTER != 0
    found = {
        "gutter": terminated & (last["drained"] == GAME["balls"]),
        "stalled": terminated & (last["stalled"] != 0),
        "time limit": truncated,
        "begun": begun,
        "created": created,
        "shoved": goes_on & is_shoved & (infos["created"] > infos["drained"]),
        "plain": goes_on & ~created & ~is_shoved,
    }
    return {kind for kind, where in found.items() if where.any()}


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("mode", AutoresetMode)
def test_going_back_after_every_kind_of_step(mode, sight):
    options = GAME | SIGHTS[sight]
    envs, other = PinballVectorEnv(COUNT, mode, **options), PinballVectorEnv(COUNT, mode, **options)
    _, before = envs.reset(seed=5)
    other.reset(seed=99)
    tried = dict.fromkeys(KINDS, 0)
    was_over = np.zeros(COUNT, bool)
    for number, row in enumerate(actions(0, 2500)):
        start = envs.save_state()
        *told, result = step(envs, row)
        ended = result[2] | result[3]
        kinds = kinds_of(result, before, row, was_over if mode is AutoresetMode.NEXT_STEP else ended)
        was_over, before = ended, {"created": result[4]["created"].copy()}
        if all(tried[kind] >= OFTEN for kind in kinds):
            continue
        for kind in kinds:
            tried[kind] += 1
        after, seen = envs.save_state(), plain(envs.observe())
        ahead = actions(1000 + number, AHEAD)
        came = future(envs, ahead)
        for one in (envs, other):
            one.restore_state(after)  # from far ahead, or from another game: nothing there is right by chance
            assert plain(one.observe()) == seen, "the observation is valid at once"
            assert future(one, ahead) == came, f"what comes after a {kinds} step"
            one.restore_state(start)
            assert step(one, row)[:-1] == told, f"the {kinds} step itself, made again"
            assert one.save_state().tobytes() == after.tobytes()
        envs.restore_state(after)
    assert all(times >= OFTEN for times in tried.values()), tried


def test_going_back_before_the_first_step():
    for options in ({"boards": 2}, GAME):
        env = PinballEnv(**options)
        first, _ = env.reset(seed=3)
        state = env.save_state()
        came = [plain(env.step(action)) for action in (1, 2, 3, 0)]
        env.restore_state(state)
        assert plain(env.observe()) == plain(first)
        assert [plain(env.step(action)) for action in (1, 2, 3, 0)] == came


THERE = """
import pickle, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from test_branches import gone_on
print(*(gone_on(*case) for case in pickle.loads(Path(sys.argv[2]).read_bytes())), sep="\\n")
"""


def gone_on(mode: str, options: dict, states: np.ndarray) -> str:
    """What a vector environment that has seen nothing yet makes of states."""
    envs = PinballVectorEnv(COUNT, mode, **options)
    envs.restore_state(states)
    return digest([plain(envs.observe()), future(envs, actions(4, 150))])


def test_it_goes_on_the_same_in_another_process(tmp_path):
    cases, here = [], []
    for mode in AutoresetMode:
        for sight in SIGHTS.values():
            envs = PinballVectorEnv(COUNT, mode, **GAME, **sight)
            envs.reset(seed=5)
            future(envs, actions(3, 150))
            cases.append((mode.value, GAME | sight, envs.save_state()))
            here.append(digest([plain(envs.observe()), future(envs, actions(4, 150))]))
    place = tmp_path / "states.pickle"
    place.write_bytes(pickle.dumps(cases))
    run = [sys.executable, "-c", THERE, str(Path(__file__).parent), str(place)]
    there = subprocess.run(run, capture_output=True, text=True, check=True).stdout.split()
    assert there == here
    assert len(set(here)) == len(cases)
