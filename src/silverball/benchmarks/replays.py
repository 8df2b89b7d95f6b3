"""Size of replays, speed of verifying them, and time of a seek in a long one.

Three games: the reflex player in arcade, the same in free play with two balls, and a frantic player that
changes a button six times per second. Times are processor times, so other load on the machine matters little.
"""

from __future__ import annotations

import random
import statistics
import time
from collections.abc import Callable

import numpy as np

from silverball.benchmarks.speed import Figure
from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import ReplayPlayer
from silverball.game.replay.verify import verify
from silverball.game.view import Mode
from silverball.players import make_player

GAME_SECONDS = 120.0
ROUNDS = 5
SEEKS = 200
PREPARED_TICKS = 24_000  # per call while a replay is made ready to seek in
FRANTIC_RATE = 6.0  # presses and releases per second, both buttons together


def measure_replays(minutes: float, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Measure replays.

    Args:
        minutes: Length of the replay used to time seeks [min].
        advance: Called with the name of what is measured next.
    """
    make_player("reflex").press(Game("classic").world)  # compile before the measurement
    games: dict[str, Callable[[], Game]] = {
        "reflex, arcade": lambda: reflex_game(Mode.ARCADE, 2, GAME_SECONDS),
        "reflex, two balls": lambda: reflex_game(Mode.FREE, 2, GAME_SECONDS),
        "frantic": lambda: frantic_game(2, GAME_SECONDS),
    }
    figures = []
    for name, play in games.items():
        advance(f"verifying: {name}")
        game = play()
        figures += [
            Figure(f"{name}: size per minute", bytes_per_minute(game), "B"),
            Figure(f"{name}: verified at real time", verifying_speed(game), "×"),
        ]
    advance(f"playing {minutes:g} minutes")
    text = frantic_game(3, 60.0 * minutes).replay.to_text()
    advance("seeking")
    return [*figures, *seek_times(text, f"{minutes:g} min, frantic")]


def reflex_game(mode: Mode, seed: int, seconds: float) -> Game:
    """A game of the reflex player; in free play always with two balls."""
    game, player = Game("classic", seed, mode), make_player("reflex")
    wanted = 2 if mode is Mode.FREE else 1
    while not game.is_over and game.tick < seconds * game.tick_rate:
        if game.tick % 60 == 0 and game.view.on_board < wanted:
            create_ball(game)
        game.step(*player.press(game.world))
    return game


def frantic_game(seed: int, seconds: float) -> Game:
    """A game in which both buttons are pressed and released at random, `FRANTIC_RATE` times per second."""
    game, draw = Game("classic", seed, Mode.FREE), random.Random(seed)
    held, change = [False, False], [0, 0]
    while game.tick < seconds * game.tick_rate:
        for side in (0, 1):
            if game.tick >= change[side]:
                held[side] = not held[side]
                pause = game.tick_rate / FRANTIC_RATE * draw.uniform(0.5, 1.5)
                change[side] = game.tick + max(1, round(pause))
        if game.tick % 240 == 0 and game.view.on_board < 2:
            create_ball(game)
        game.step(*held)
    return game


def create_ball(game: Game) -> None:
    """Create a ball if the rules and the board allow it."""
    try:
        game.create_ball()
    except SilverballError:
        return


def bytes_per_minute(game: Game) -> float:
    """Size of the lines of play per simulated minute, without head and end."""
    text = game.replay.to_text()
    play = text[text.index("--- play\n") + 9 : text.index("--- end")]
    return len(play.encode()) * 60.0 * game.tick_rate / game.tick


def verifying_speed(game: Game) -> float:
    """Simulated seconds that are verified per second of processor time."""
    replay = Replay.from_text(game.replay.to_text())
    times = []
    for _ in range(ROUNDS):
        started = time.process_time()
        verdict = verify(replay)
        times.append(time.process_time() - started)
        if not verdict.ok:
            raise SilverballError(f"a replay that was just recorded does not verify: {verdict.message}")
    return replay.seconds / statistics.median(times)


def seek_times(text: str, name: str) -> list[Figure]:
    """Size of a long replay, and the times of reading it, making it ready to seek in, and seeking."""
    started = time.process_time()
    player = ReplayPlayer(Replay.from_text(text))
    read = time.process_time() - started
    started = time.process_time()
    while player.prepare(PREPARED_TICKS) < 1.0:
        pass
    prepared = time.process_time() - started
    draw, times = random.Random(1), []
    for _ in range(SEEKS):
        tick = draw.randrange(player.ticks)
        started = time.process_time()
        player.seek(tick)
        times.append(1e3 * (time.process_time() - started))
    return [
        Figure(f"{name}: size", len(text), "B"),
        Figure(f"{name}: read", read, "s"),
        Figure(f"{name}: ready to seek", prepared, "s"),
        Figure(f"{name}: a seek, median", float(np.median(times)), "ms"),
        Figure(f"{name}: a seek, 99 %", float(np.quantile(times, 0.99)), "ms"),
    ]
