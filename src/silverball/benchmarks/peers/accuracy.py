"""How far from the truth is a ball after 0, 1, 3 and 5 bounces?

A scene is a ball let go on a random board, with the paddles at rest. Scenes are not chosen by hand: of the
drops that a fixed seed draws, those count whose first six contacts are plain bounces (fast enough for every
engine to let the ball bounce, not too flat, and not in too quick succession). All engines are asked at the
same times, whole frames halfway between two bounces, where the reference knows the place to 50 digits.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
import numpy as np

from silverball.benchmarks.peers import tables
from silverball.benchmarks.peers.engine import FRAME_RATE, Playfield
from silverball.benchmarks.peers.play import free_places
from silverball.benchmarks.peers.reference import DIGITS, Path, follow
from silverball.errors import SilverballError
from silverball.table import Table

BOUNCES = (0, 1, 3, 5)  # after how many the error is taken
SCENES = 12
SEED = 1
LEAST_APPROACH = 1.5  # [u/s] along the normal; slower ones Box2D 2.3 swallows
LEAST_SHARE = 0.3  # of the speed that goes along the normal: no grazes
LEAST_FLIGHT = 6 / FRAME_RATE  # [s] between two bounces
MOST_DROPS = 100  # for each scene that is wanted; on the built-in tables one in six is a scene
PUSH = 6.0  # [u/s] a drop starts at most this fast in each direction
ROUGH_DIGITS = 15  # enough to find out whether a drop is a scene


class Scene(NamedTuple):
    """A drop with its true places.

    Attributes:
        start: x, z [u], vx, vz [u/s] at time 0.
        frames: When to look, in frames of 1/60 s, for each of `BOUNCES`.
        places: Where the ball then is, (x, z) [u] in 50 digits.
    """

    table: Table
    start: tuple[float, float, float, float]
    frames: tuple[int, ...]
    places: tuple[tuple[Any, Any], ...]


def scenes(recipe: Table, count: int = SCENES, seed: int = SEED) -> list[Scene]:
    """The first drops of a seed that are scenes.

    Args:
        recipe: A table, or a recipe of which every drop gets a board of its own.
        count: How many.
        seed: Of the drops.

    Raises:
        SilverballError: Next to none of the drops is a scene.
    """
    random = np.random.default_rng(seed)
    found: list[Scene] = []
    number = 0
    while len(found) < count:
        if number == MOST_DROPS * count:
            raise SilverballError(
                f"{recipe.name}: of {number} drops, only {len(found)} bounced six times without a graze or a "
                "touch; compare the engines on a table with more obstacles"
            )
        table = tables.board(recipe, number)
        x, z = free_places(table, number, 1)[0]
        vx, vz = random.uniform(-PUSH, PUSH, 2).tolist()
        start = (x, z, vx, vz)
        number += 1
        rough = follow(table, start, max(BOUNCES) + 1, ROUGH_DIGITS)
        if not is_plain(rough) or min(float(flight[1]) for flight in rough.flights) < table.board.gutter:
            continue
        path = follow(table, start, max(BOUNCES) + 1, DIGITS)
        frames = tuple(frame_after(path, bounces) for bounces in BOUNCES)
        with mpmath.workdps(DIGITS):
            places = tuple(path.position(mpmath.mpf(frame) / FRAME_RATE) for frame in frames)
        found.append(Scene(table, start, frames, places))
    return found


def is_plain(path: Path) -> bool:
    """Whether all bounces of a path are such as every engine can make."""
    times = [0.0, *(float(bounce.time) for bounce in path.bounces)]
    return len(path.bounces) > max(BOUNCES) and all(
        bounce.approach > LEAST_APPROACH and bounce.share > LEAST_SHARE and later - before > LEAST_FLIGHT
        for bounce, before, later in zip(path.bounces, times[:-1], times[1:], strict=True)
    )


def frame_after(path: Path, bounces: int) -> int:
    """The frame halfway between a bounce and the next."""
    before = float(path.bounces[bounces - 1].time) if bounces else 0.0
    return round((before + float(path.bounces[bounces].time)) / 2 * FRAME_RATE)


def errors(scene: Scene, field: Playfield) -> list[float]:
    """Distance [u] of an engine's ball from the true place, for each of `BOUNCES`."""
    field.put_ball(*scene.start)
    found, frame = [], 0
    for until, (x, z) in zip(scene.frames, scene.places, strict=True):
        while frame < until:
            for _ in range(field.stepping.steps):
                field.step(False, False)
            frame += 1
        here = field.balls()
        with mpmath.workdps(DIGITS):
            found.append(float(mpmath.hypot(here[0][0] - x, here[0][1] - z)) if here else math.inf)
    return found


def median_errors(all_scenes: list[Scene], build: Callable[[Table], Playfield]) -> list[float]:
    """The median over all scenes of the error after each of `BOUNCES` [u]."""
    rows = [errors(scene, build(scene.table)) for scene in all_scenes]
    return [statistics.median(column) for column in zip(*rows, strict=True)]
