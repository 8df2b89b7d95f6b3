"""How many steps a second do the environments make here, and how many do others?

Every figure is a median of rounds after a warm-up, with random actions and the environments as anybody gets
them from `gymnasium.make` and `gymnasium.make_vec`. Other environments are measured in the same run where
their packages are installed: Gymnasium's CartPole (its fastest), Atari's VideoPinball (ale-py), the latter
with EnvPool too.
"""

from __future__ import annotations

import importlib
import statistics
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from silverball.errors import MissingExtra

STATE, CLASSIC, PIXELS = (
    "silverball/Pinball-v0",
    "silverball/PinballClassic-v0",
    "silverball/PinballPixels-v0",
)
STATES = 8192  # environments side by side
PICTURES = 1024
BOARDS = 16
WARM_UP = 60  # steps
LONG_ENOUGH = 0.3  # [s] of a round


class Rate(NamedTuple):
    """A measured rate.

    Attributes:
        name: What was measured.
        value: Steps of all environments together per second, or for `unit` "µs" the time of one call.
        slowest: That of the slowest round.
        unit: "steps/s" or "µs".
        ours: Whether it is ours.
    """

    name: str
    value: float
    slowest: float
    unit: str
    ours: bool


def measure_envs(rounds: int, told: Callable[[str], None] = lambda _: None) -> list[Rate]:
    """Measure them all; `told` hears what comes next.

    Raises:
        MissingExtra: Gymnasium is not installed.
    """
    try:
        importlib.import_module("gymnasium")
    except ModuleNotFoundError:
        raise MissingExtra("bench --envs", "rl") from None
    rates: list[Rate] = []
    for name, unit, ours, make in _contestants():
        told(name)
        try:
            step, count = make()
        except (ModuleNotFoundError, ImportError):
            continue
        rates.append(_timed(name, unit, ours, step, count, rounds))
    return rates


def _timed(name: str, unit: str, ours: bool, step: Callable[[], None], count: int, rounds: int) -> Rate:
    for _ in range(WARM_UP):
        step()
    calls = 1
    while True:
        started = time.perf_counter()
        for _ in range(calls):
            step()
        if time.perf_counter() - started > LONG_ENOUGH / 2:
            break
        calls *= 2
    seconds = []
    for _ in range(rounds):
        started = time.perf_counter()
        for _ in range(calls):
            step()
        seconds.append((time.perf_counter() - started) / calls)
    middle, worst = statistics.median(seconds), max(seconds)
    if unit == "µs":
        return Rate(name, 1e6 * middle / count, 1e6 * worst / count, unit, ours)
    return Rate(name, count / middle, count / worst, unit, ours)


Made = tuple[Callable[[], None], int]


def _contestants() -> Iterator[tuple[str, str, bool, Callable[[], Made]]]:
    yield "one environment through gymnasium.make", "steps/s", True, lambda: _one(CLASSIC)
    yield "save_state", "µs", True, _saving
    yield "restore_state", "µs", True, _restoring
    for zero_copy in (False, True):
        how = "the same arrays" if zero_copy else "new arrays"
        yield (
            f"state, {STATES} environments, {how}",
            "steps/s",
            True,
            _many(STATE, STATES, zero_copy=zero_copy, boards=BOARDS),
        )
    for stack in (1, 4):
        for zero_copy in (False, True):
            how = "the same arrays" if zero_copy else "new arrays"
            yield (
                f"pictures 84 × 84 × {stack}, {PICTURES} environments, {how}",
                "steps/s",
                True,
                _many(PIXELS, PICTURES, zero_copy=zero_copy, boards=BOARDS, stack=stack),
            )
    yield "Gymnasium CartPole, one environment", "steps/s", False, lambda: _one("CartPole-v1")
    yield f"Gymnasium CartPole, {STATES} environments", "steps/s", False, _many("CartPole-v1", STATES)
    yield "Atari VideoPinball (ALE), one environment", "steps/s", False, _atari_one
    yield "Atari VideoPinball (ALE), 16 environments, 4 × 84 × 84", "steps/s", False, _atari_many
    yield "Atari VideoPinball (EnvPool), 16 environments, 4 × 84 × 84", "steps/s", False, _envpool


def _one(id_: str, **options: Any) -> Made:
    import gymnasium

    import silverball.envs  # noqa: F401  (registers)

    return _stepped(gymnasium.make(id_, **options))


def _stepped(env: Any) -> Made:
    """A thousand steps of one environment; a call of a function for every step would count too."""
    env.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, env.action_space.n, 1000).tolist()

    def step() -> None:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return step, len(actions)


def _many(id_: str, count: int, **options: Any) -> Callable[[], Made]:
    def make() -> Made:
        import gymnasium

        import silverball.envs  # noqa: F401  (registers)

        return _stepped_together(gymnasium.make_vec(id_, count, **options))

    return make


def _stepped_together(envs: Any) -> Made:
    envs.reset(seed=0)
    random = np.random.default_rng(0)
    choices = int(envs.single_action_space.n)
    actions = [random.integers(0, choices, envs.num_envs) for _ in range(16)]
    turn = iter(range(2**62))
    return lambda: envs.step(actions[next(turn) % 16]), int(envs.num_envs)


def _saving() -> Made:
    env = _unwrapped()

    def step() -> None:
        for _ in range(1000):
            env.save_state()

    return step, 1000


def _restoring() -> Made:
    env = _unwrapped()
    state = env.save_state()

    def step() -> None:
        for _ in range(1000):
            env.restore_state(state)

    return step, 1000


def _unwrapped() -> Any:
    import gymnasium

    import silverball.envs  # noqa: F401  (registers)

    env = gymnasium.make(CLASSIC).unwrapped
    env.reset(seed=0)
    return env


def _atari_one() -> Made:
    import gymnasium

    gymnasium.register_envs(importlib.import_module("ale_py"))
    return _stepped(gymnasium.make("ALE/VideoPinball-v5"))


def _atari_many() -> Made:
    vector = importlib.import_module("ale_py.vector_env")
    return _stepped_together(vector.AtariVectorEnv("video_pinball", 16))


def _envpool() -> Made:
    envpool = importlib.import_module("envpool")
    envs = envpool.make_gymnasium("VideoPinball-v5", num_envs=16)
    actions = np.random.default_rng(0).integers(0, envs.action_space.n, 16).astype(np.int32)
    envs.reset()
    return lambda: envs.step(actions), 16
