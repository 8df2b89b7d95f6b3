"""The feel of a table: figures from thousands of simulated games and swept shots, with 95 % intervals.

`measure` lets every player play many games of one ball each (`game_traces.py`), sweeps the shots of each
paddle (`shots.py`), and sums up. The result is a function of the table, the seed and the number of games.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.game_traces import (
    CELLS,
    INTERVAL_BINS,
    TICK_RATE,
    GameEnd,
    Games,
    parts_of_kind,
    play_games,
)
from silverball.metrics.shots import Aim, Shots, shots_of
from silverball.metrics.statistics import Estimate, ratio, share
from silverball.table import Table, generate_table
from silverball.world import WorldBatch

PLAYERS = ("idle", "random", "beginner", "reflex")
STUCK = 5.0  # [s] a ball that stays longer within half a unit is stuck
BUNCH = 10.0  # [deg] the width within which shots are called bunched


class PlayerFeel(NamedTuple):
    """How the table plays under one player; docs/feel.md explains the figures.

    Attributes:
        figures: By name, with their intervals.
        longest: [s] by name: the longest game, stay in one place and time without points.
        longest_stay_at: Where the longest stay was, x and z [u].
        cut_short: Games that did not end by themselves.
        cylinders: Share of the struck balls that met each cylinder, by name; of random boards by number.
        games: The traces of the games, maps included.
    """

    figures: dict[str, Estimate]
    longest: dict[str, float]
    longest_stay_at: tuple[float, float]
    cut_short: int
    cylinders: dict[str, Estimate]
    games: Games


class Feel(NamedTuple):
    """The result of `measure`.

    Attributes:
        table: The table or recipe.
        players: Figures by the name of the player.
        shots: Shots of each paddle and approach; of a recipe those on the board without its random parts.
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
        games: Games of each player.
        seed: Seed of the first game and board.
        players: Some of PLAYERS.
        progress: Called with the name of the work and the share done, 0 to 1.
    """
    report = progress or (lambda what, done: None)
    boards = [table] * games
    if table.random is not None:
        boards = []
        for number in range(games):
            boards.append(generate_table(seed + number, table))
            report("making boards", (number + 1) / games)
    batch = WorldBatch(boards, games, seed, TICK_RATE)
    found = {}
    for name in players:
        played = play_games(
            batch,
            name,
            lambda done, name=name: report(f"{name} games", done),  # type: ignore[misc]
        )
        found[name] = _player_feel(batch, played)
    bare = table.model_copy(update={"random": None})
    approaches = [(side, held) for side in ("left", "right") for held in (False, True)]
    shots = (shots_of(bare, side, held) for side, held in approaches)
    return Feel(table, found, tuple(one for one in shots if one is not None))


def hits_of(batch: WorldBatch, hits: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
    """The hits of all parts of a kind.

    Args:
        batch: The worlds.
        hits: Hits of each part, [world, part].
        kind: The kind, as in the names of parts.

    Returns:
        Hits, [world].
    """
    found: NDArray[np.int64] = (hits * parts_of_kind(batch, kind)[batch.board_of]).sum(axis=1)
    return found


def _player_feel(batch: WorldBatch, games: Games) -> PlayerFeel:
    state, game = games.state, games.game
    count = len(game)
    seconds = game["ticks"] / TICK_RATE
    drained = game["over"] == GameEnd.DRAINED
    cylinder_hits = hits_of(batch, games.hits, "cylinder")
    minutes = seconds / 60.0
    stay = game["longest_stay"] / TICK_RATE
    where = int(stay.argmax())
    figures = {
        "seconds_per_ball": ratio(seconds, drained),
        "points_per_minute": ratio(state["score"], minutes),
        "points_per_ball": ratio(state["score"], drained),
        "hits_per_second": ratio(games.hits.sum(axis=1), seconds),
        "cylinder_hits_per_minute": ratio(cylinder_hits, minutes),
        "prism_hits_per_minute": ratio(hits_of(batch, games.hits, "triangular_prism"), minutes),
        "share_above_half_cap": ratio(game["fast"], game["ticks"]),
        "share_on_a_paddle": ratio(game["on_paddle"], game["ticks"]),
        "share_stuck": share(int((stay > STUCK).sum()), count),
        "share_without_cylinder": share(int((cylinder_hits == 0).sum()), count),
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
    return PlayerFeel(figures, longest, at, int((~drained).sum()), shares_of_cylinders(batch, games), games)


def _quantile(gaps: NDArray[np.int64], part: float) -> float:
    """The quantile [s] of times between hits, from their tenths of a second; infinite beyond the last."""
    below = int(np.searchsorted(np.cumsum(gaps), part * gaps.sum()))
    return (below + 1) / 10.0 if below < INTERVAL_BINS - 1 else float("inf")


def shares_of_cylinders(batch: WorldBatch, games: Games) -> dict[str, Estimate]:
    """The share of struck balls that met each cylinder of the first board; boards without it do not count."""
    found = {}
    for number, part in enumerate(batch.tables[0].cylinder):
        path = f"cylinder[{number}]"
        columns = [names.index(path) if path in names else -1 for names in batch.boards.names]
        column = np.array(columns)[batch.board_of]
        with_it = np.nonzero(column >= 0)[0]
        reached = games.reached[with_it, column[with_it]]
        found[part.name or path] = ratio(reached, games.game["strikes"][with_it])
    return found


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
    """The figures of a paddle's shots, in the form printed as JSON."""
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
