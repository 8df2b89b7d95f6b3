"""How large are replays, how fast are they verified, and how fast does one seek in an hour of play?

    python benchmarks/replays.py [--minutes 60]

Three players: the reflex player in arcade and in free play with two balls, and somebody frantic who presses
six times a second. Times of the processor, so that a busy machine changes little; medians after a warm-up.
"""

from __future__ import annotations

import argparse
import platform
import random
import statistics
import time

from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import ReplayPlayer
from silverball.game.replay.verify import verify
from silverball.game.view import Mode
from silverball.players import make_player


def reflex(mode: Mode, seed: int, seconds: float) -> Game:
    """A game of the reflex player, in free play always with two balls."""
    game, player = Game("classic", seed, mode), make_player("reflex")
    while not game.is_over and game.tick < seconds * game.tick_rate:
        wanted = 2 if mode is Mode.FREE else 1
        if game.tick % 60 == 0 and game.view.on_board < wanted:
            bring(game)
        game.step(*player.press(game.world))
    return game


def frantic(seed: int, seconds: float, presses: float = 6.0) -> Game:
    """A game in which each hand presses and lets go at random, `presses` times a second together."""
    game, draw = Game("classic", seed, Mode.FREE), random.Random(seed)
    held, change = [False, False], [0, 0]
    while game.tick < seconds * game.tick_rate:
        for side in (0, 1):
            if game.tick >= change[side]:
                held[side] = not held[side]
                change[side] = game.tick + max(1, round(game.tick_rate / presses * draw.uniform(0.5, 1.5)))
        if game.tick % 240 == 0 and game.view.on_board < 2:
            bring(game)
        game.step(*held)
    return game


def bring(game: Game) -> None:
    """Bring a ball if the rules and the board allow it."""
    try:
        game.create_ball()
    except SilverballError:
        return


def bytes_per_minute(game: Game) -> float:
    """Of the lines of play, without the head and the end."""
    text = game.replay.to_text()
    play = text[text.index("--- play\n") + 9 : text.index("--- end")]
    return len(play.encode()) * 60.0 * game.tick_rate / game.tick


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--minutes", type=float, default=60.0, help="of the long game")
    minutes = options.parse_args().minutes
    print(f"{platform.machine()}, Python {platform.python_version()}")
    make_player("reflex").press(Game("classic").world)
    games = {
        "reflex, arcade": reflex(Mode.ARCADE, 2, 120),
        "reflex, two balls": reflex(Mode.FREE, 2, 120),
        "frantic, 6 presses a second": frantic(2, 120),
    }
    for name, game in games.items():
        replay = Replay.from_text(game.replay.to_text())
        times = []
        for _ in range(5):
            started = time.process_time()
            assert verify(replay).ok
            times.append(time.process_time() - started)
        speed = replay.seconds / statistics.median(times)
        print(f"{name:28} {bytes_per_minute(game):5.0f} bytes a minute, verified at {speed:,.0f} × real time")
    long = frantic(3, 60.0 * minutes)
    text = long.replay.to_text()
    started = time.process_time()
    player = ReplayPlayer(Replay.from_text(text))
    read = time.process_time() - started
    started = time.process_time()
    while player.prepare(24_000) < 1.0:
        pass
    ready = time.process_time() - started
    draw, times = random.Random(1), []
    for _ in range(200):
        tick = draw.randrange(player.ticks)
        started = time.process_time()
        player.seek(tick)
        times.append(time.process_time() - started)
    times.sort()
    print(
        f"{minutes:g} minutes of frantic play: {len(text):,} bytes, read in {read:.2f} s, ready to seek in "
        f"{ready:.2f} s; a seek takes {1e3 * times[100]:.1f} ms, 1 in 100 {1e3 * times[197]:.1f} ms"
    )


if __name__ == "__main__":
    main()
