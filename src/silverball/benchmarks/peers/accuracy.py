"""Accuracy of an engine: position errors after 0, 1, 3 and 5 bounces, and the drift of energy.

A scene is a ball released on a random board, with the paddles at rest. Scenes are drawn with a fixed seed: a
random drop becomes a scene if its first six contacts are plain bounces (fast enough to bounce in every
engine, not grazing, and not in quick succession). All engines are compared with the reference of 50 digits at
the same times, whole frames halfway between two bounces.

For the drift, a ball bounces with restitution 1 on a closed random board, under gravity. Its energy at the
end is the mean over the last ten seconds of ½v² + g·(x − floor), sampled once per second; the true value is
that of the start.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
import numpy as np

from silverball.benchmarks.peers import common_tables
from silverball.benchmarks.peers.playfield import FRAME_RATE, Playfield
from silverball.benchmarks.peers.random_play import free_places
from silverball.benchmarks.peers.reference import DIGITS, Path, follow
from silverball.errors import SilverballError
from silverball.table import Table

BOUNCES = (0, 1, 3, 5)  # after which the error is measured
SCENES = 12
SEED = 1
MIN_APPROACH = 1.5  # [u/s] along the normal; slower contacts do not bounce in Box2D 2.3
MIN_SHARE = 0.3  # share of the speed along the normal: no grazing contacts
MIN_FLIGHT = 6 / FRAME_RATE  # [s] between two bounces
MAX_DROPS = 100  # per scene; on the built-in tables one drop in six is a scene
MAX_START_SPEED = 6.0  # [u/s] of a drop, in each direction
DRIFT_START = (3.0, 4.0)  # vx, vz [u/s]
DRIFT_SECONDS = 1000
AVERAGED_SECONDS = 10  # at the end of the drift
ROUGH_DIGITS = 15  # enough to decide whether a drop is a scene


class Scene(NamedTuple):
    """A drop and the exact positions of its ball.

    Attributes:
        table: The board.
        start: x, z [u], vx, vz [u/s] at time 0.
        frames: Times of comparison in frames of 1/60 s, one for each of `BOUNCES`.
        positions: Exact (x, z) [u] of the ball at these times, in 50 digits.
    """

    table: Table
    start: tuple[float, float, float, float]
    frames: tuple[int, ...]
    positions: tuple[tuple[Any, Any], ...]


def scenes(recipe: Table, count: int = SCENES, seed: int = SEED) -> list[Scene]:
    """The first random drops that are scenes.

    Args:
        recipe: A table, or a recipe that makes a board for every drop.
        count: Number of scenes.
        seed: Seed of the drops.

    Raises:
        SilverballError: Too few drops are scenes.
    """
    random = np.random.default_rng(seed)
    found: list[Scene] = []
    number = 0
    while len(found) < count:
        if number == MAX_DROPS * count:
            raise SilverballError(
                f"{recipe.name}: only {len(found)} of {number} drops bounced six times without a grazing or "
                "slow contact; compare the engines on a table with more obstacles"
            )
        table = common_tables.board(recipe, number)
        x, z = free_places(table, number, 1)[0]
        vx, vz = random.uniform(-MAX_START_SPEED, MAX_START_SPEED, 2).tolist()
        start = (x, z, vx, vz)
        number += 1
        rough = follow(table, start, max(BOUNCES) + 1, ROUGH_DIGITS)
        if (
            not has_plain_bounces(rough)
            or min(float(flight[1]) for flight in rough.flights) < table.board.gutter
        ):
            continue
        path = follow(table, start, max(BOUNCES) + 1, DIGITS)
        frames = tuple(frame_after(path, bounces) for bounces in BOUNCES)
        with mpmath.workdps(DIGITS):
            positions = tuple(path.position(mpmath.mpf(frame) / FRAME_RATE) for frame in frames)
        found.append(Scene(table, start, frames, positions))
    return found


def has_plain_bounces(path: Path) -> bool:
    """Whether every engine can reproduce all bounces of a path."""
    times = [0.0, *(float(bounce.time) for bounce in path.bounces)]
    return len(path.bounces) > max(BOUNCES) and all(
        bounce.approach > MIN_APPROACH and bounce.share > MIN_SHARE and later - before > MIN_FLIGHT
        for bounce, before, later in zip(path.bounces, times[:-1], times[1:], strict=True)
    )


def frame_after(path: Path, bounces: int) -> int:
    """The whole frame nearest to the middle between a bounce and the next."""
    before = float(path.bounces[bounces - 1].time) if bounces else 0.0
    return round((before + float(path.bounces[bounces].time)) / 2 * FRAME_RATE)


def errors(scene: Scene, field: Playfield) -> list[float]:
    """Distance [u] of an engine's ball from its exact position, for each of `BOUNCES`."""
    field.add_ball(*scene.start)
    found, frame = [], 0
    for until, (x, z) in zip(scene.frames, scene.positions, strict=True):
        while frame < until:
            for _ in range(field.stepping.steps):
                field.step(False, False)
            frame += 1
        balls = field.balls()
        with mpmath.workdps(DIGITS):
            found.append(float(mpmath.hypot(balls[0][0] - x, balls[0][1] - z)) if balls else math.inf)
    return found


def median_errors(all_scenes: list[Scene], build: Callable[[Table], Playfield]) -> list[float]:
    """Median error [u] over all scenes, for each of `BOUNCES`."""
    rows = [errors(scene, build(scene.table)) for scene in all_scenes]
    return [statistics.median(column) for column in zip(*rows, strict=True)]


def energy(table: Table, ball: tuple[float, float, float, float]) -> float:
    """Kinetic and potential energy [u²/s²] of a ball of mass 1 above the floor."""
    x, _, vx, vz = ball
    return 0.5 * (vx * vx + vz * vz) + table.board.gravity * (x - common_tables.FLOOR)


def drift_start(table: Table) -> tuple[float, float, float, float]:
    """Start of the ball for the drift on a table: x, z [u], vx, vz [u/s]."""
    return (*free_places(table, 0, 1)[0], *DRIFT_START)


def drift(field: Playfield, ball: tuple[float, float, float, float], seconds: int = DRIFT_SECONDS) -> float:
    """Relative error of the energy after some time on a closed table; 1 if the ball is lost.

    Args:
        field: A closed table without a ball.
        ball: Start of the ball: x, z [u], vx, vz [u/s].
        seconds: Simulated time [s].
    """
    field.add_ball(*ball)
    exact = energy(field.table, ball)
    energies = []
    for second in range(seconds):
        for _ in range(FRAME_RATE * field.stepping.steps):
            field.step(False, False)
        if second >= seconds - AVERAGED_SECONDS:
            balls = field.balls()
            energies.append(energy(field.table, balls[0]) if balls else 0.0)
    return abs(statistics.mean(energies) / exact - 1.0)
