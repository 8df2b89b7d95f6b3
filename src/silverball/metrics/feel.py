"""How does a table play? Figures of its feel, from thousands of simulated games, with 95 % intervals.

`measure` lets every player play many games of one ball each (`game_traces.py`), sweeps the shots of each
paddle
(`shots.py`), and sums up. All of it follows from the table, the seed and the number of games.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from silverball.metrics.game_traces import CELLS, GAPS, TICK_RATE, Games, kind_of, play_games
from silverball.metrics.shots import Aim, Shots, shots_of
from silverball.table import Table, generate_table
from silverball.world import WorldBatch

PLAYERS = ("idle", "random", "beginner", "reflex")
NORMAL = 1.96  # standard deviations on either side that hold 95 %
STUCK = 5.0  # [s] a ball that stays longer within half a unit is stuck
BUNCH = 10.0  # [deg] the width within which shots are called bunched


class Estimate(NamedTuple):
    """A figure and the interval that holds the true one with 95 %."""

    value: float
    low: float
    high: float


def ratio(above: ArrayLike, below: ArrayLike) -> Estimate:
    """Σ above / Σ below over independent games, neither ever negative; NaN where nothing is below.

    The interval is that of the residuals, above − ratio·below, whose sum is nearly normal.
    Source: W. G. Cochran, "Sampling Techniques" (1977), chapter 6, the ratio estimate.
    """
    a, b = np.asarray(above, np.float64), np.asarray(below, np.float64)
    total = float(b.sum())
    if total == 0.0:
        return Estimate(float("nan"), float("nan"), float("nan"))
    value = float(a.sum()) / total
    wide = NORMAL * sqrt(float(((a - value * b) ** 2).sum())) / total
    return Estimate(value, max(0.0, value - wide), value + wide)


def share(count: int, of: int) -> Estimate:
    """A share of independent cases, right for rare ones too.

    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927).
    """
    if of == 0:
        return Estimate(float("nan"), float("nan"), float("nan"))
    p, z = count / of, NORMAL
    middle = (p + z * z / (2.0 * of)) / (1.0 + z * z / of)
    wide = z / (1.0 + z * z / of) * sqrt(p * (1.0 - p) / of + z * z / (4.0 * of * of))
    return Estimate(p, max(0.0, middle - wide), min(1.0, middle + wide))


class PlayerFeel(NamedTuple):
    """How the table plays under one player; the docs say what each figure is good for.

    Attributes:
        figures: By name, with their intervals.
        longest: [s] by name: the longest game, stay in one place and time without points.
        longest_stay_at: Where the longest stay was, x and z [u].
        cut_short: Games that did not end by themselves.
        cylinders: Share of the struck balls that met each cylinder, by name; of random boards by number.
        games: All that came of them, maps included.
    """

    figures: dict[str, Estimate]
    longest: dict[str, float]
    longest_stay_at: tuple[float, float]
    cut_short: int
    cylinders: dict[str, Estimate]
    games: Games


class Feel(NamedTuple):
    """What `measure` found.

    Attributes:
        table: The table or recipe.
        players: By name.
        shots: Of each paddle and way; of a recipe those on the board without its random parts.
    """

    table: Table
    players: dict[str, PlayerFeel]
    shots: tuple[Shots, ...]


def measure(
    table: Table,
    games: int = 1000,
    seed: int = 0,
    players: tuple[str, ...] = PLAYERS,
    progress: Callable[[str, float], None] | None = None,
) -> Feel:
    """Measure the feel of a table.

    Args:
        table: A table, or a recipe, of which every game gets a board of its own.
        games: For each player.
        seed: Of the first game and board.
        players: Which of PLAYERS.
        progress: Called with what is done and its share, 0 to 1.
    """
    said = progress or (lambda what, done: None)
    boards = [table] * games
    if table.random is not None:
        boards = []
        for number in range(games):
            boards.append(generate_table(seed + number, table))
            said("making boards", (number + 1) / games)
    batch = WorldBatch(boards, games, seed, TICK_RATE)
    found = {}
    for name in players:
        played = play_games(
            batch,
            kind_of(name),
            lambda done, name=name: said(f"{name} games", done),  # type: ignore[misc]
        )
        found[name] = _player_feel(boards, played)
    bare = table.model_copy(update={"random": None})
    ways = [(side, held) for side in ("left", "right") for held in (False, True)]
    shots = (shots_of(bare, side, held) for side, held in ways)
    return Feel(table, found, tuple(one for one in shots if one is not None))


def _player_feel(boards: list[Table], games: Games) -> PlayerFeel:
    state, game = games.state, games.game
    count = len(game)
    seconds = game["ticks"] / TICK_RATE
    drained = game["over"] == 1
    kinds = ("wall", "slant_wall", "paddle", "triangular_prism", "cylinder")
    hits = sum(state[f"{kind}_hits"] for kind in kinds)
    minutes = seconds / 60.0
    stay = game["longest_stay"] / TICK_RATE
    where = int(stay.argmax())
    figures = {
        "seconds_per_ball": ratio(seconds, drained),
        "points_per_minute": ratio(state["score"], minutes),
        "points_per_ball": ratio(state["score"], drained),
        "hits_per_second": ratio(hits, seconds),
        "cylinder_hits_per_minute": ratio(state["cylinder_hits"], minutes),
        "prism_hits_per_minute": ratio(state["triangular_prism_hits"], minutes),
        "share_above_half_cap": ratio(game["fast"], game["ticks"]),
        "share_on_a_paddle": ratio(game["on_paddle"], game["ticks"]),
        "share_stuck": share(int((stay > STUCK).sum()), count),
        "share_without_cylinder": share(int((state["cylinder_hits"] == 0).sum()), count),
        "strikes_per_minute": ratio(game["strikes"], minutes),
        "strikes_to_top": ratio(game["to_top"], game["strikes"]),
        "strikes_to_a_cylinder": ratio(game["to_cylinder"], game["strikes"]),
    }
    lived = np.sort(seconds)
    longest = {
        "median_game": float(np.median(lived)),
        "p95_game": float(lived[int(0.95 * (count - 1))]),
        "longest_game": float(lived[-1]),
        "longest_stay": float(stay[where]),
        "p99_stay": float(np.quantile(stay, 0.99)),
        "longest_without_points": float(game["longest_dry"].max()) / TICK_RATE,
        "p95_between_hits": _quantile(games.gaps, 0.95),
    }
    at = (float(game["longest_x"][where]), float(game["longest_z"][where]))
    return PlayerFeel(figures, longest, at, int((~drained).sum()), _cylinders(boards, games), games)


def _quantile(gaps: NDArray[np.int64], part: float) -> float:
    """The quantile [s] of times between hits, from their tenths of a second; infinite beyond the last."""
    below = int(np.searchsorted(np.cumsum(gaps), part * gaps.sum()))
    return (below + 1) / 10.0 if below < GAPS - 1 else float("inf")


def _cylinders(boards: list[Table], games: Games) -> dict[str, Estimate]:
    """Of the struck balls, the share that met each cylinder."""
    first = boards[0]
    offset = 5 + len(first.slant_wall) + len(first.triangular_prism)  # in the order of physics.layout.Part
    strikes = games.game["strikes"]
    return {
        part.name or f"cylinder[{number}]": ratio(games.reached[:, offset + number], strikes)
        for number, part in enumerate(first.cylinder)
    }


def hot_cells(feel: PlayerFeel, table: Table, count: int = 3) -> list[tuple[float, float, float]]:
    """The cells with the longest stays: x, z of their middle [u] and the stay [s]."""
    stays = feel.games.stays
    rows = np.argsort(stays, axis=None)[::-1][:count]
    board = table.board
    cells = (np.unravel_index(row, stays.shape) for row in rows)
    return [
        (
            (float(i) + 0.5) / CELLS - 0.5 * board.length,
            (float(j) + 0.5) / CELLS - 0.5 * board.width,
            float(stays[i, j]) / TICK_RATE,
        )
        for i, j in cells
    ]


def shots_as_dict(shots: Shots) -> dict[str, Any]:
    """The figures of a paddle's shots, for people and for JSON."""
    directions, aimed = shots.directions(), shots.shot["direction"][shots.aim != Aim.NOWHERE]
    windows = {aim.name.lower(): shots.window(aim) for aim in (Aim.LEFT, Aim.MIDDLE, Aim.RIGHT)}
    struck = shots.shot[shots.shot["launched"] == 1]
    bunched = max(
        (float(((aimed >= low) & (aimed < low + BUNCH)).mean()) for low in aimed.tolist()),
        default=float("nan"),
    )
    first = [shots.names[part] for part in struck["first"].tolist() if part >= 0]
    return {
        "paddle": shots.side,
        "way": "held, then dropped" if shots.held else "down the guide",
        "struck_ms": len(struck) * 1000.0 / TICK_RATE,
        "windows_ms": {name: round(width, 1) for name, (width, _) in windows.items()},
        "since_ms": {name: round(since, 1) for name, (_, since) in windows.items()},
        "clean_ms": {
            aim.name.lower(): round(float((shots.aim == aim).sum()) * 1000.0 / TICK_RATE, 1)
            for aim in (Aim.LEFT, Aim.MIDDLE, Aim.RIGHT)
        },
        "directions_deg": [float(directions.min()), float(directions.max())] if len(struck) else None,
        "bunched_in_10_deg": bunched,
        "share_to_top": float((struck["highest"] > shots.top).mean()) if len(struck) else None,
        "first_met": {name: first.count(name) for name in dict.fromkeys(first)},
    }
