"""The candidates of the benchmark: Silverball's environments in several configurations, and others.

Others are measured where their packages are installed: Gymnasium's CartPole (the fastest of Gymnasium),
Atari's VideoPinball by ale-py and by EnvPool, and PufferLib's breakout in C. Vectors that use threads get one
per core. Actions are random.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.world.threads import cores

CLASSIC, RANDOM, PIXELS, MISSIONS = (
    "silverball/PinballClassic-v0",
    "silverball/Pinball-v0",
    "silverball/PinballPixels-v0",
    "silverball/PinballMissions-v1",
)
FEW, MANY = 2048, 8192  # environments with state observations: their records fit the cache, or do not
FEW_PICTURED, MANY_PICTURED = 256, 1024  # environments with pictures: the same
ATARIS = 16
BREAKOUTS = 1024
BOARDS = 16
SINGLE_STEPS = 1000  # of one environment in one call, so that the cost of the call is negligible
ACTIONS = 16  # rows of random actions, reused in turn

Workload = tuple[Callable[[], object], int]
"""A callable to time, and the number of steps that one call makes."""


class Candidate(NamedTuple):
    """A configuration of an environment to measure.

    Attributes:
        name: Name shown in the table.
        make: Builds the environment and returns its workload.
        sees: The kind of observation: "state" or "pictures"; "" if nothing is observed.
        ours: Whether it is one of Silverball's.
        yardstick: Its name as a baseline, which gets a column of ratios; "" if it is not a baseline.
        package: The package that it needs; without it `make` raises ImportError.
        unit: "steps/s", or "µs" for the time of one call.
    """

    name: str
    make: Callable[[], Workload]
    sees: str = "state"
    ours: bool = True
    yardstick: str = ""
    package: str = "gymnasium"
    unit: str = "steps/s"


def candidates() -> list[Candidate]:
    """All candidates, Silverball's first."""
    return [
        Candidate("one, through gymnasium.make", lambda: _one(CLASSIC)),
        Candidate("one, steps of 4 frames", lambda: _one(CLASSIC, frame_skip=4)),
        *(_states(count, **options) for count, options in STATES),
        *(_games(count, **options) for count, options in GAMES),
        *(_pictures(stack, count, **options) for stack, count, options in PICTURES),
        Candidate("save_state", _saving, "", unit="µs"),
        Candidate("restore_state", _restoring, "", unit="µs"),
        *others(),
    ]


STATES: list[tuple[int, dict[str, Any]]] = [
    (FEW, {"threads": 1}),
    (FEW, {}),
    (FEW, {"frame_skip": 4}),
    (MANY, {}),
    (MANY, {"zero_copy": True}),
]
GAMES: list[tuple[int, dict[str, Any]]] = [
    (1, {"rules": False}),
    (1, {}),
    (FEW, {"threads": 1, "rules": False}),
    (FEW, {"threads": 1}),
    (FEW, {}),
]
PICTURES: list[tuple[int, int, dict[str, Any]]] = [
    (1, MANY_PICTURED, {}),
    (1, MANY_PICTURED, {"zero_copy": True}),
    (4, FEW_PICTURED, {}),
    (4, FEW_PICTURED, {"frame_skip": 4}),
    (4, MANY_PICTURED, {}),
    (4, MANY_PICTURED, {"zero_copy": True}),
]


def _states(count: int, **options: Any) -> Candidate:
    return Candidate(
        f"state, {count} environments{_suffix(options)}",
        lambda: _many(RANDOM, count, boards=BOARDS, **options),
    )


def _games(count: int, **options: Any) -> Candidate:
    what = "silver_comet, " + ("hits only" if "rules" in options else "games by its rules")
    if count == 1:
        return Candidate(f"{what}, one", lambda: _one(MISSIONS, **options))
    threads = ", one thread" if "threads" in options else ""
    return Candidate(f"{what}, {count} environments{threads}", lambda: _many(MISSIONS, count, **options))


def _pictures(stack: int, count: int, **options: Any) -> Candidate:
    pictures = "picture 84 × 84" if stack == 1 else f"pictures {stack} × 84 × 84"
    return Candidate(
        f"{pictures}, {count} environments{_suffix(options)}",
        lambda: _many(PIXELS, count, boards=BOARDS, stack=stack, **options),
        "pictures",
    )


def _suffix(options: dict[str, Any]) -> str:
    words = {"threads": "one thread", "zero_copy": "zero_copy", "frame_skip": "steps of 4 frames"}
    return "".join(f", {words[name]}" for name in options)


def others() -> list[Candidate]:
    """The candidates that are not Silverball's."""
    return [
        Candidate("CartPole (Gymnasium), one", lambda: _one("CartPole-v1"), ours=False),
        Candidate(
            f"CartPole (Gymnasium), {MANY} environments", lambda: _many("CartPole-v1", MANY), ours=False
        ),
        Candidate(
            "VideoPinball (ALE), one", _atari_one, "pictures", ours=False, package="ale-py"
        ),
        Candidate(
            f"VideoPinball (ALE's vector), {ATARIS} environments",
            _atari_many,
            "pictures",
            ours=False,
            yardstick="ALE's vector",
            package="ale-py",
        ),
        Candidate(
            f"VideoPinball (EnvPool), {ATARIS} environments",
            _envpool,
            "pictures",
            ours=False,
            yardstick="EnvPool",
            package="envpool",
        ),
        Candidate(
            f"breakout (PufferLib's Ocean), {BREAKOUTS} environments, one thread",
            _breakout,
            ours=False,
            yardstick="Ocean breakout",
            package="pufferlib",
        ),
    ]  # fmt: skip


def _one(id_: str, **options: Any) -> Workload:
    import gymnasium

    import silverball.envs  # noqa: F401  (registers)

    return _stepped(gymnasium.make(id_, **options))


def _stepped(env: Any) -> Workload:
    env.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, env.action_space.n, SINGLE_STEPS).tolist()

    def step() -> None:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return step, len(actions)


def _many(id_: str, count: int, **options: Any) -> Workload:
    import gymnasium

    import silverball.envs  # noqa: F401  (registers)

    return _stepped_together(gymnasium.make_vec(id_, count, **options))


def _stepped_together(envs: Any) -> Workload:
    envs.reset(seed=0)
    return _cycled(envs.step, int(envs.single_action_space.n), int(envs.num_envs))


def _cycled(step: Callable[[Any], object], choices: int, count: int, kind: Any = np.int64) -> Workload:
    actions: NDArray[Any] = np.random.default_rng(0).integers(0, choices, (ACTIONS, count)).astype(kind)
    turn = iter(range(2**62))
    return lambda: step(actions[next(turn) % ACTIONS]), count


def _saving() -> Workload:
    env = _unwrapped()

    def save() -> None:
        for _ in range(SINGLE_STEPS):
            env.save_state()

    return save, SINGLE_STEPS


def _restoring() -> Workload:
    env = _unwrapped()
    state = env.save_state()

    def restore() -> None:
        for _ in range(SINGLE_STEPS):
            env.restore_state(state)

    return restore, SINGLE_STEPS


def _unwrapped() -> Any:
    import gymnasium

    import silverball.envs  # noqa: F401  (registers)

    env = gymnasium.make(CLASSIC).unwrapped
    env.reset(seed=0)
    return env


def _breakout() -> Workload:
    module = importlib.import_module("pufferlib.ocean.breakout.breakout")
    envs = module.Breakout(num_envs=BREAKOUTS)
    envs.reset()
    return _cycled(envs.step, int(envs.single_action_space.n), BREAKOUTS)


def _atari_one() -> Workload:
    import gymnasium

    gymnasium.register_envs(importlib.import_module("ale_py"))
    return _stepped(gymnasium.make("ALE/VideoPinball-v5"))


def _atari_many() -> Workload:
    vector = importlib.import_module("ale_py.vector_env")
    return _stepped_together(vector.AtariVectorEnv("video_pinball", ATARIS, num_threads=cores()))


def _envpool() -> Workload:
    envpool = importlib.import_module("envpool")
    envs = envpool.make_gymnasium("VideoPinball-v5", num_envs=ATARIS, num_threads=cores())
    envs.reset()
    return _cycled(envs.step, int(envs.action_space.n), ATARIS, np.int32)
