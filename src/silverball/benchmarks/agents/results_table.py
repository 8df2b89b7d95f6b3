"""The table of results: what each contestant makes on an id, on a scale from blind (0) to planner (1).

The points of a policy are its interquartile mean over all seeds of its training and all test boards; see
`statistics.interquartile_mean`. Every ball is in the CSV, so the figures can be computed again.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.agents.stored_policies import StoredPolicy
from silverball.benchmarks.agents.trials import Entrant, Trial, make_trial, play_trial
from silverball.metrics.statistics import Estimate, interquartile_mean, mean

TRIAL_SEED = 2_000_000  # of all trials, so that contestants play the same balls
ZERO, ONE = "blind", "planner"
"""The contestants at 0 and 1 of the scale."""


class Result(NamedTuple):
    """What one contestant makes.

    Attributes:
        name: The contestant.
        runs: Trainings whose trials are put together; 1 for players.
        balls: Of each run.
        points: Mean points a ball.
        middle: Interquartile mean of points a ball.
        seconds: Mean length of an episode [s].
        strokes: Strokes of both paddles a second.
        score: `middle` on the scale from blind to planner; NaN where one of them did not play.
    """

    name: str
    runs: int
    balls: int
    points: Estimate
    middle: Estimate
    seconds: float
    strokes: float
    score: float


def play_all(
    id_: str,
    entrants: Mapping[str, list[Entrant]],
    balls: int,
    advance: Callable[[str], None] = lambda _: None,
) -> dict[str, list[Trial]]:
    """The trials of each contestant: one ball on each test board for each of its runs.

    Args:
        id_: The environment.
        entrants: The runs of each contestant.
        balls: Balls of a run.
        advance: Called with what is played.
    """
    trials: dict[str, list[Trial]] = {}
    made: dict[str, Any] = {}  # environments, by what is seen of them
    for name, runs in entrants.items():
        for number, entrant in enumerate(runs):
            shown = f"{id_}: {name}" + (f", run {number + 1} of {len(runs)}" if len(runs) > 1 else "")
            show = _shares(shown, advance)
            options = entrant.options if isinstance(entrant, StoredPolicy) else {}
            seen = repr(sorted(options.items()))
            if seen not in made:
                made[seen] = make_trial(id_, balls, "test", **options)
            trials.setdefault(name, []).append(play_trial(entrant, made[seen], TRIAL_SEED, show))
    return trials


def _shares(name: str, advance: Callable[[str], None]) -> Callable[[float], None]:
    return lambda share: advance(f"{name}, {share:.0%} of the balls over")


def summarise(trials: Mapping[str, list[Trial]]) -> list[Result]:
    """The results, in the order of the trials."""
    middles = {name: interquartile_mean(_scores(runs)) for name, runs in trials.items()}
    zero, one = (middles[name].value if name in middles else np.nan for name in (ZERO, ONE))
    results = []
    for name, runs in trials.items():
        scores = _scores(runs)
        length = sum(run.seconds.sum() for run in runs)
        results.append(
            Result(
                name, len(runs), scores.shape[1], mean(scores.mean(axis=0)), middles[name],
                float(length / scores.size), float(sum(run.strokes.sum() for run in runs) / length),
                float((middles[name].value - zero) / (one - zero)),
            )
        )  # fmt: skip
    return results


def _scores(runs: list[Trial]) -> NDArray[np.float64]:
    return np.stack([run.scores for run in runs]).astype(np.float64)


def markdown(results: list[Result]) -> str:
    """The results as a Markdown table."""
    lines = [
        "| player | runs × balls | points a ball | interquartile mean | life [s] | strokes/s | score |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for one in results:
        score = "–" if np.isnan(one.score) else f"{one.score:.2f}"
        lines.append(
            f"| {one.name} | {one.runs} × {one.balls} | {_shown(one.points)} | {_shown(one.middle)} | "
            f"{one.seconds:.1f} | {one.strokes:.2f} | {score} |"
        )
    return "\n".join(lines) + "\n"


def _shown(one: Estimate) -> str:
    return f"{one.value:,.0f} ({one.low:,.0f}–{one.high:,.0f})"


def write_csv(path: Path, id_: str, trials: Mapping[str, list[Trial]]) -> None:
    """Write every ball: id, contestant, run, ball, points, seconds, strokes."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "contestant", "run", "ball", "points", "seconds", "strokes"])
        for name, runs in trials.items():
            for number, run in enumerate(runs):
                columns = (run.scores.tolist(), run.seconds.round(3).tolist(), run.strokes.tolist())
                for ball, row in enumerate(zip(*columns, strict=True)):
                    writer.writerow([id_, name, number, ball, *row])
