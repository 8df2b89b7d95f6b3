"""Timing of the candidates: one after another, after a warm-up; the median of several rounds."""

from __future__ import annotations

import contextlib
import importlib.util
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from importlib import metadata
from typing import NamedTuple

from silverball.benchmarks.envs.environments import Candidate, candidates
from silverball.benchmarks.speed import machine
from silverball.errors import MissingExtra

WARM_UP = 60  # calls
MIN_ROUND_TIME = 0.3  # [s], approximately


class Rate(NamedTuple):
    """A measured rate.

    Attributes:
        name: Name of the candidate.
        value: Steps per second of all environments together, or for the unit "µs" the time of one call.
        slowest: The value of the slowest round.
        unit: "steps/s" or "µs".
        sees: The kind of observation: "state" or "pictures"; "" if nothing is observed.
        ours: Whether it is one of Silverball's.
        yardstick: Its name as a baseline of others; "" if it is not a baseline.
    """

    name: str
    value: float
    slowest: float
    unit: str
    sees: str
    ours: bool
    yardstick: str


class Result(NamedTuple):
    """The result of a run.

    Attributes:
        rates: Rates of all measured candidates.
        rounds: Rounds of each candidate.
        missing: Packages that are not installed, so that their candidates were left out.
        machine: A description of the machine.
        versions: Versions of Python and of the packages.
    """

    rates: list[Rate]
    rounds: int
    missing: list[str]
    machine: str
    versions: dict[str, str]


def run(
    rounds: int,
    on_start: Callable[[str], None] = lambda _: None,
    chosen: Sequence[Candidate] | None = None,
) -> Result:
    """Measure the chosen candidates, or all; `on_start` is called with the name of each first.

    Raises:
        MissingExtra: Gymnasium is not installed.
    """
    if importlib.util.find_spec("gymnasium") is None:
        raise MissingExtra("bench envs", "rl")
    rates: list[Rate] = []
    present, missing = {"numba": True, "numpy": True}, {}
    for one in candidates() if chosen is None else chosen:
        on_start(one.name)
        try:
            step, count = one.make()
        except ImportError:
            missing[one.package] = True
            continue
        present[one.package] = True
        rates.append(_rate(one, _seconds(step, rounds), count))
    return Result(rates, rounds, list(missing), machine(), versions(list(present)))


def _seconds(step: Callable[[], object], rounds: int) -> list[float]:
    """Duration of a call in each round [s]."""
    for _ in range(WARM_UP):
        step()
    calls = 1
    while _seconds_of(step, calls) < MIN_ROUND_TIME / 2:
        calls *= 2
    return [_seconds_of(step, calls) / calls for _ in range(rounds)]


def _seconds_of(step: Callable[[], object], calls: int) -> float:
    started = time.perf_counter()
    for _ in range(calls):
        step()
    return time.perf_counter() - started


def _rate(one: Candidate, seconds: list[float], count: int) -> Rate:
    median, longest = statistics.median(seconds), max(seconds)
    if one.unit == "µs":
        value, slowest = 1e6 * median / count, 1e6 * longest / count
    else:
        value, slowest = count / median, count / longest
    return Rate(one.name, value, slowest, one.unit, one.sees, one.ours, one.yardstick)


def versions(packages: list[str]) -> dict[str, str]:
    """Versions of Python and of those packages that have one."""
    found = {"Python": platform.python_version()}
    for package in ("silverball", *packages):
        with contextlib.suppress(metadata.PackageNotFoundError):
            found[package] = metadata.version(package)
    return found
