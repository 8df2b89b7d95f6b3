"""The comparison: every engine plays the same tables in one run.

Speed is measured in rounds. In each round, all engines play the same board for a moment, one after the other,
so noise of the machine affects all alike; ratios are computed within a round. A recipe gives another
board in each round. Escapes, penetration, errors and drift do not depend on the clock and are measured
afterwards.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from typing import NamedTuple

from silverball.benchmarks.peers import accuracy, common_tables, random_play
from silverball.benchmarks.peers.engines import BATCH, OWN, SILVERBALL, Engine, Entry, versions
from silverball.benchmarks.peers.penetration import Penetration, PenetrationMonitor, play_monitored
from silverball.benchmarks.peers.playfield import FRAME_RATE
from silverball.benchmarks.peers.silverball_table import FRAMES_PER_CALL, batch_speed
from silverball.benchmarks.speed import machine
from silverball.table import Table

PRESSES = 6000  # frames of random buttons in a round, repeated if it is longer


class Plan(NamedTuple):
    """The extent of the measurements.

    Attributes:
        worlds: Worlds in Silverball's batch.
        rounds: Rounds of the speed measurement, each on its own board.
        seconds: Wall time of each engine in each round [s].
        calls: Calls of the batch in each round, of `FRAMES_PER_CALL` frames.
        boards: Boards on which penetration is measured.
        frames: Frames on each of these boards, for each engine.
        scenes: Scenes of the accuracy.
        energy_seconds: Simulated time for the drift of energy [s].
    """

    worlds: int = 4096
    rounds: int = 9
    seconds: float = 0.3
    calls: int = 8
    boards: int = 10
    frames: int = 10_000
    scenes: int = accuracy.SCENES
    energy_seconds: int = accuracy.DRIFT_SECONDS

    def shortened(self) -> Plan:
        """The plan of rough figures in ten seconds."""
        return self._replace(
            worlds=min(self.worlds, 512), rounds=min(self.rounds, 3), seconds=0.1, calls=1, boards=2,
            frames=1000, scenes=3, energy_seconds=30,
        )  # fmt: skip


class Row(NamedTuple):
    """Results of one engine with one stepping.

    Attributes:
        engine: Name of the engine.
        stepping: Length of its step, as text.
        frames_per_second: Median of the rounds, on one core.
        slowest: Frames per second in the slowest round.
        fastest: Frames per second in the fastest round.
        batch_ratio: How many times as fast Silverball's batch was; median of the rounds' ratios.
        world_ratio: The same for one Silverball world stepped from Python at 1/60 s, as the peers are.
        watched: Frames in which escapes and penetration were measured.
        escapes: Balls that reached an impossible position.
        deepest: Deepest penetration [u].
        errors: Median error [u] after each of `accuracy.BOUNCES`.
        energy: Relative error of the energy on a closed elastic table.
    """

    engine: str
    stepping: str
    frames_per_second: float
    slowest: float
    fastest: float
    batch_ratio: float
    world_ratio: float
    watched: int
    escapes: int
    deepest: float
    errors: list[float]
    energy: float


class Result(NamedTuple):
    """All rows, and the machine and versions they were measured on."""

    rows: list[Row]
    plan: Plan
    balls: float
    ball_radius: float
    machine: str
    versions: dict[str, str]


def units(plan: Plan, engines: list[Engine]) -> int:
    """The number of progress reports of `run`."""
    entries = len(OWN) + sum(len(engine.entries()) for engine in engines)
    return plan.rounds * (entries + 1) + 1 + entries * (plan.boards + 2)


def run(recipe: Table, plan: Plan, engines: list[Engine], advance: Callable[[str], None]) -> Result:
    """Measure everything.

    Args:
        recipe: A table, or a recipe that makes a board for every round.
        plan: The extent of the measurements.
        engines: The peers to compare with.
        advance: Called with the name of the next of `units` pieces of work.
    """
    entries = [*OWN, *(entry for engine in engines for entry in engine.entries())]
    speeds, batch, balls = measure_speeds(recipe, plan, entries, advance)
    advance("following the scenes in 50 digits")
    scenes = accuracy.scenes(recipe, plan.scenes)
    opened = common_tables.board(recipe, 0)
    rows = []
    for entry, own in zip(entries, speeds, strict=True):
        penetration = measure_penetration(recipe, plan, entry, advance)
        advance(f"{entry.name}, {entry.stepping.label}: errors")
        errors = accuracy.median_errors(scenes, entry.build)
        advance(f"{entry.name}, {entry.stepping.label}: energy")
        drift = accuracy.drift(
            entry.build(common_tables.elastic(opened)), accuracy.drift_start(opened), plan.energy_seconds
        )
        rows.append(row(entry.name, entry.stepping.label, own, batch, speeds[0], penetration, errors, drift))
    # A world of a batch equals the single world bit for bit, so all results but the speed are the same.
    first = rows[0]
    penetration = Penetration(first.watched, first.escapes, first.deepest)
    stepping = f"{first.stepping}, {plan.worlds} worlds"
    rows.insert(0, row(BATCH, stepping, batch, batch, speeds[0], penetration, first.errors, first.energy))
    radius = recipe.board.ball_radius
    return Result(rows, plan, balls, radius, machine(), versions(engines))


def row(
    name: str,
    stepping: str,
    own: list[float],
    batch: list[float],
    world: list[float],
    penetration: Penetration,
    errors: list[float],
    drift: float,
) -> Row:
    """The row of an engine, from its speeds in all rounds and its other results."""
    return Row(
        name,
        stepping,
        statistics.median(own),
        min(own),
        max(own),
        statistics.median(b / o for b, o in zip(batch, own, strict=True)),
        statistics.median(w / o for w, o in zip(world, own, strict=True)),
        *penetration,
        errors,
        drift,
    )


def measure_speeds(
    recipe: Table, plan: Plan, entries: list[Entry], advance: Callable[[str], None]
) -> tuple[list[list[float]], list[float], float]:
    """Frames per second of every entry and of the batch in each round, and the batch's balls per board."""
    speeds: list[list[float]] = [[] for _ in entries]
    batch, balls = [], []
    for number in range(plan.rounds):
        table = common_tables.board(recipe, number)
        press = random_play.random_presses(PRESSES, number)
        places = random_play.free_places(table, number)
        advance(f"speed, round {number + 1}: {BATCH}")
        frames, mean_balls = batch_speed(table, plan.worlds, plan.calls, press, number)
        batch.append(frames)
        balls.append(mean_balls)
        for entry, own in zip(entries, speeds, strict=True):
            advance(f"speed, round {number + 1}: {entry.name}, {entry.stepping.label}")
            own.append(random_play.speed(random_play.Game(entry.build(table), press, places), plan.seconds))
    return speeds, batch, statistics.mean(balls)


def measure_penetration(
    recipe: Table, plan: Plan, entry: Entry, advance: Callable[[str], None]
) -> Penetration:
    """Escapes and penetration of one entry, on some boards."""
    escapes, depth = 0, 0.0
    for number in range(plan.boards):
        advance(f"{entry.name}, {entry.stepping.label}: penetration")
        table = common_tables.board(recipe, number)
        monitor = PenetrationMonitor(table)
        press = random_play.random_presses(plan.frames, number)
        game = random_play.Game(entry.build(table), press, random_play.free_places(table, number))
        escapes += play_monitored(game, plan.frames, monitor)
        depth = max(depth, monitor.depth)
    return Penetration(plan.boards * plan.frames, escapes, depth)


def digits_ahead(result: Result) -> list[float]:
    """Powers of ten by which the best peer's error exceeds Silverball's, for each of `BOUNCES`."""
    own = result.rows[0].errors
    peer_errors = [row.errors for row in result.rows if row.engine not in (BATCH, SILVERBALL)]
    return [
        math.log10(min(errors[index] for errors in peer_errors) / own[index])
        if own[index] > 0.0
        else math.inf
        for index in range(len(own))
    ]


def description(plan: Plan) -> str:
    """A description of the measurement, in sentences."""
    return (
        f"A frame is 1/{FRAME_RATE} s of one table with two balls and random paddles, on one core; speeds "
        f"are medians of {plan.rounds} rounds, ratios are taken within a round. "
        f"The batch moves {plan.worlds} worlds by {FRAMES_PER_CALL} frames per call; every other row is one "
        f"world stepped from Python. Errors are medians of {plan.scenes} scenes, against 50 digits. "
        f"Energy: {plan.energy_seconds} s of elastic bouncing on a closed board."
    )
