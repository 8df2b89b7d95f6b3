"""Helpers that play games for tests.

Nothing in here knows the rules: every expected value is computed in the test.
"""

from __future__ import annotations

import random
from typing import Any

from boards import full_table, table_of
from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.view import GameEvent, GameEventKind, Mode, Phase
from silverball.players import make_player
from silverball.table import Arcade, Cylinder, SlantWall, Table

POCKET = (SlantWall(start=(1.0, -1.5), end=(0.0, 0.0)), SlantWall(start=(0.0, 0.0), end=(1.0, 1.5)))
IN_POCKET = (0.5, 0.0)  # a ball put here comes to rest between the two walls


def ruled(table: Table, **arcade: Any) -> Table:
    """The table with some rules changed."""
    return table.model_copy(update={"arcade": Arcade(**arcade)})


def bare(*parts: Any, **arcade: Any) -> Table:
    """A board with these parts alone, and these rules."""
    return ruled(table_of(*parts), **arcade)


def bumper(points: int = 100) -> Cylinder:
    """A cylinder in the middle of the board."""
    return Cylinder(center=(0.0, 0.0), radius=0.6, points=points)


def put(game: Game, x: float, z: float, vx: float = 0.0, vz: float = 0.0, slot: int = 0) -> None:
    """Put the ball of a slot somewhere, as if it had come there."""
    ball = game.world.records[0]["ball"]
    ball["x"][slot], ball["z"][slot], ball["vx"][slot], ball["vz"][slot] = x, z, vx, vz


def hit_bumper(game: Game, slot: int = 0) -> list[GameEvent]:
    """Let a ball hit the bumper once from the right; the events of that."""
    put(game, 0.0, 1.2, vz=-10.0, slot=slot)
    game.take_game_events()
    game.step(ticks=15)
    return game.take_game_events()


def lose(game: Game, slot: int = 0) -> list[GameEvent]:
    """Let a ball go into the gutter; the events of that."""
    put(game, game.table.board.gutter + 0.05, 0.0, vx=-5.0, slot=slot)
    game.take_game_events()
    game.step(ticks=5)
    return game.take_game_events()


def kinds(events: list[GameEvent]) -> list[GameEventKind]:
    return [one.kind for one in events]


def reflex_game(table: Table | str, seed: int, mode: Mode = Mode.ARCADE, seconds: float = 60.0) -> Game:
    """A game that the reflex player has played, with both balls as soon as the rules allow."""
    game, player = Game(table, seed, mode), make_player("reflex")
    while not game.is_over and game.tick < seconds * game.tick_rate:
        if game.phase is Phase.READY or (game.tick % 2000 == 1999 and mode is Mode.FREE):
            bring(game)
        game.step(*player.press(game.world))
    return game


def frantic_game(
    seed: int, seconds: float = 60.0, presses: float = 6.0, table: Table | str = "classic"
) -> Game:
    """A game in free play with random presses at some rate per second, and a shove now and then."""
    game, draw = Game(table, seed, Mode.FREE), random.Random(seed)
    held = [False, False]
    next_change = [0, 0]
    while game.tick < seconds * game.tick_rate:
        for side in (0, 1):
            if game.tick >= next_change[side]:
                held[side] = not held[side]
                # Each side changes twice a press, and half of all presses are its own.
                mean = game.tick_rate / presses
                next_change[side] = game.tick + max(1, round(mean * draw.uniform(0.5, 1.5)))
        if game.view.on_board < 2 and game.tick % 240 == 0:
            bring(game)
        if game.view.on_board and draw.random() < 0.2 / 240:
            game.jitter()
        game.step(*held)
    return game


def bring(game: Game) -> None:
    """Bring a ball if the rules and the board allow it."""
    try:
        game.create_ball()
    except SilverballError:
        return


def crowded() -> Table:
    """A table on which a lot happens."""
    return full_table()
