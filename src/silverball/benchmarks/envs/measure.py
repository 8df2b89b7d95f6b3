"""How are they measured? Each alone, after a warm-up, in rounds of which the median counts."""

from __future__ import annotations

import contextlib
import importlib.util
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from importlib import metadata
from typing import NamedTuple

from silverball.benchmarks.envs.environments import Contestant, contestants
from silverball.benchmarks.speed import machine
from silverball.errors import MissingExtra

WARM_UP = 60  # calls
ROUND = 0.3  # [s] that a round takes at least


class Rate(NamedTuple):
    """A measured rate.

    Attributes:
        name: What was measured.
        value: Steps of all environments together per second, or for `unit` "µs" the time of one call.
        slowest: That of the slowest round.
        unit: "steps/s" or "µs".
        sees: What an observation is: "state" or "pictures"; "" if nothing is observed.
        ours: Whether it is ours.
        yardstick: Its name as something that others are compared with; "" if they are not.
    """

    name: str
    value: float
    slowest: float
    unit: str
    sees: str
    ours: bool
    yardstick: str


class Result(NamedTuple):
    """What came of it.

    Attributes:
        rates: Of all who took part.
        rounds: Of each.
        missing: Packages of those who did not.
        machine: What it was measured on.
        versions: Of the packages.
    """

    rates: list[Rate]
    rounds: int
    missing: list[str]
    machine: str
    versions: dict[str, str]


def run(
    rounds: int,
    told: Callable[[str], None] = lambda _: None,
    taking_part: Sequence[Contestant] | None = None,
) -> Result:
    """Measure those who take part, or all; `told` hears who comes next.

    Raises:
        MissingExtra: Gymnasium is not installed.
    """
    if importlib.util.find_spec("gymnasium") is None:
        raise MissingExtra("bench envs", "rl")
    rates: list[Rate] = []
    present, missing = {"numba": True, "numpy": True}, {}
    for one in contestants() if taking_part is None else taking_part:
        told(one.name)
        try:
            step, count = one.make()
        except ImportError:
            missing[one.package] = True
            continue
        present[one.package] = True
        rates.append(_rate(one, _seconds(step, rounds), count))
    return Result(rates, rounds, list(missing), machine(), versions(list(present)))


def _seconds(step: Callable[[], object], rounds: int) -> list[float]:
    """What a call takes in each round [s]."""
    for _ in range(WARM_UP):
        step()
    calls = 1
    while _seconds_of(step, calls) < ROUND / 2:
        calls *= 2
    return [_seconds_of(step, calls) / calls for _ in range(rounds)]


def _seconds_of(step: Callable[[], object], calls: int) -> float:
    started = time.perf_counter()
    for _ in range(calls):
        step()
    return time.perf_counter() - started


def _rate(one: Contestant, seconds: list[float], count: int) -> Rate:
    middle, longest = statistics.median(seconds), max(seconds)
    if one.unit == "µs":
        value, slowest = 1e6 * middle / count, 1e6 * longest / count
    else:
        value, slowest = count / middle, count / longest
    return Rate(one.name, value, slowest, one.unit, one.sees, one.ours, one.yardstick)


def versions(packages: list[str]) -> dict[str, str]:
    """Versions of Python and of packages, of those that have one."""
    found = {"Python": platform.python_version()}
    for package in ("silverball", *packages):
        with contextlib.suppress(metadata.PackageNotFoundError):
            found[package] = metadata.version(package)
    return found
