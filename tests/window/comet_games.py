"""The games on Silver Comet that the window's tests play again: `python tests/window/comet_games.py`.

The command finds them by a scout (`scout.py`) and writes their replays to `tests/window/games`: some minutes.
It is to be run when the table, its rules or the physics have changed.

    great.replay    a skill shot, two missions won, an extra ball, two locks, a multiball with both jackpots
                    and the super jackpot, the other three missions, and the wizard mode
    late.replay     a mission whose time runs out
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scout import STEP, Games, Goal, Presses, Scout, counted, in_state, play_presses, started

from silverball.app.sessions import GameSession
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import DIRECTIONS, Playback
from silverball.game.replay.recording import BALL, LAUNCH, LEFT, RIGHT, parse_inputs
from silverball.game.view import Phase
from silverball.table import load_table

FOLDER = Path(__file__).parent / "games"
TABLE = "silver_comet"
SEEDS = {"great": 2, "late": 8}
MISSIONS = ("chase the comet", "land on the moon", "storm of Mars", "through the rings", "birth of a star")
OFF, ON, BLINKING = 0, 1, 2
COMMAND = "python tests/window/comet_games.py"


def won(number: int, goals: int) -> list[Goal]:
    """A mission is started and won by so many goals."""
    return [
        started(MISSIONS[number], 20.0),
        *[counted("goals", goal, 20.0) for goal in range(1, goals)],
        counted("rank", number + 1, 20.0),
    ]


def too_late(games: Games, before: Any) -> NDArray[np.bool_]:
    """The mission has ended, and was not won."""
    rank = games.batch.books.counters[0].index("rank")
    is_same = games.counter("rank") == before["counter"][rank]
    return ~games.runs(MISSIONS[0]) & is_same & (games.in_play > 0)


def lasts(seconds: float) -> Goal:
    """The mission runs, and its time is down to some seconds."""

    def is_reached(games: Games, before: Any) -> NDArray[np.bool_]:
        mode = games.batch.books.modes[0].index(MISSIONS[0])
        left = games.batch.games["mode_end"][:, mode] - games.batch.state["tick"]
        return games.runs(MISSIONS[0]) & (games.in_play > 0) & (left < seconds * 240)

    return Goal(f"{seconds} s are left", is_reached, 12.0)


GOALS = {
    "great": [
        counted("skill value"),
        *won(0, 3),
        *won(1, 2),
        in_state("shoot again", ON, 20.0),
        in_state("lock", BLINKING, 20.0),
        counted("locks", 1, 20.0),
        in_state("lock", BLINKING, 25.0),
        started("multiball", 20.0),
        counted("jackpots hit", 1, 20.0),
        counted("jackpots hit", 2, 20.0),
        in_state("super jackpot", OFF, 20.0),
        *won(2, 5),
        *won(3, 3),
        *won(4, 4),
        in_state("wizard", BLINKING, 10.0),
        started("silver comet", 20.0),
    ],
    "late": [
        started(MISSIONS[0], 30.0),
        *map(lasts, (32.0, 24.0, 16.0, 8.0)),
        Goal("too late", too_late, 12.0),
    ],
}


def find(name: str) -> Replay:
    """Find a game, and play it to its end without hands."""
    table, seed = load_table(TABLE), SEEDS[name]
    presses: Presses = Scout(table, seed).find(GOALS[name])
    game = Game(table, seed)
    play_presses(game, presses)
    game.step(ticks=3 * STEP * 60)
    return game.replay


def load(name: str) -> Replay:
    """A game that was found before.

    Raises:
        AssertionError: It was found on another table.
    """
    replay = Replay.from_text((FOLDER / f"{name}.replay").read_text(encoding="utf-8"))
    assert replay.table == load_table(TABLE).resolved(), f"{TABLE} has changed: run {COMMAND}"
    return replay


def first_ticks(replay: Replay) -> dict[str, int]:
    """The first tick of everything that the rules of a replayed game have said, started or played."""
    player, found = Playback(replay), {}
    while player.tick < replay.ticks:
        player.play(1)
        for event in player.game.events:
            found.setdefault(event.part, event.tick)
    return found


def inputs_of(replay: Replay) -> Iterator[tuple[int, str]]:
    """The inputs of a replay, each with its tick."""
    for second, line in enumerate((*replay.lines, f"= {replay.tail}")):
        for one in parse_inputs(line.partition(" ")[2]):
            yield second * replay.tick_rate + one.tick, one.kind


def skip(session: GameSession, replay: Replay, tick: int) -> dict[str, bool]:
    """Play a game of the window on to a tick of a replay, with its inputs.

    Returns:
        Whether the left, the right and the launch button are held there.
    """
    game, held = session.game, dict.fromkeys((LEFT, RIGHT, LAUNCH), False)

    def step(end: int) -> None:
        game.step(held[LEFT], held[RIGHT], end - game.tick, launch=held[LAUNCH])
        session.tally.add(game.events)

    for at, kind in inputs_of(replay):
        if at >= tick:
            break
        if at >= game.tick:
            step(at)
        if kind in held:
            held[kind] = not held[kind]
        elif at == game.tick and kind == BALL and game.phase is Phase.READY:
            game.create_ball()
        elif at == game.tick and kind in DIRECTIONS:
            game.nudge(DIRECTIONS[kind])
    step(tick)
    return held


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name in sys.argv[1:] or GOALS:
        found = find(name)
        (FOLDER / f"{name}.replay").write_text(found.to_text(), encoding="utf-8")
        print(f"{name}: {found.seconds:.0f} s, {found.score:,} points")
