"""Warms up the players of demos in the background: compiled in another process, loaded in a thread.

    compiled code on disk? (otherwise `python -m silverball.app.player_warmup`, a process of low priority,
    makes it) →  loaded in a thread by one decision  →  ready

Compiling holds the GIL, so it never happens in the process of the game. If it fails, the player never becomes
ready, and the fallback player continues (`demo_players.py`).
"""

from __future__ import annotations

import contextlib
import os
import threading
import warnings
from typing import TYPE_CHECKING

from silverball.app.demo_players import DEMO_PLAYERS, FALLBACK_PLAYER, DemoPlayer, demo_players, introduce
from silverball.app.startup import TABLES, warm_up
from silverball.background_process import Compiler
from silverball.background_thread import BackgroundThread

if TYPE_CHECKING:
    from silverball.table import Table

START_DELAY = 2.0  # [s], since loading would delay the first frames of a game by about 0.15 s
NICENESS = 10  # lower priority than the game and the drawing
COMPILE_TIMEOUT = 1800.0  # [s]; compiling takes 35 s on an idle processor


class PlayerWarmup:
    """Warms up the players one after the other, once the physics is loaded.

    Args:
        table: A board for their first decisions.
    """

    def __init__(self, table: Table) -> None:
        self._table = table
        self._ready = {FALLBACK_PLAYER.name}
        self._stop = threading.Event()
        self._thread = BackgroundThread(self._work, "player warm-up", self._stop)
        self._thread.start()

    def is_ready(self, name: str) -> bool:
        """Return whether a player, by name, can play without a delay."""
        return name in self._ready

    def wait(self, seconds: float | None = None) -> None:
        """Wait until all players are ready or have failed."""
        self._thread.join(seconds)

    def close(self) -> None:
        """Stop after the current player; a running compilation ends with the program."""
        self._stop.set()

    def _work(self) -> None:
        if self._stop.wait(START_DELAY):
            return
        from silverball.players import PlayerError, player_names

        player_names()  # imports the players of installed packages
        for demo_player in demo_players():
            try:
                if is_compiled_on_disk(demo_player) or (self._compile() and is_compiled_on_disk(demo_player)):
                    warm_up_player(demo_player, self._table)
                    self._ready.add(demo_player.name)
            except PlayerError as error:
                warnings.warn(f"{error}; the player {FALLBACK_PLAYER.name!r} plays instead", stacklevel=1)
            except Exception:  # the fallback player continues
                pass
            if self._stop.is_set():
                return

    def _compile(self) -> bool:
        from silverball.physics.kernel import cache_folder

        # Without a cache folder, another process cannot pass on its compiled code.
        return cache_folder() is not None and _compiler.finish(self._stop, COMPILE_TIMEOUT)


def is_compiled_on_disk(demo_player: DemoPlayer) -> bool:
    """Return whether all compiled code of a player is on disk, whatever table it plays on."""
    from silverball.physics.kernel import is_compiled

    return not demo_player.kernel or all(is_compiled(demo_player.kernel, layout=one) for one in TABLES)


def warm_up_player(demo_player: DemoPlayer, table: Table) -> None:
    """Make a player's first decision, which loads and compiles everything that it needs."""
    from silverball.game.game import Game
    from silverball.players import make_player

    game = Game(table, 0)
    game.create_ball()
    game.step(False, False, 1)
    player = make_player(demo_player.name)
    introduce(player, game)
    player.press(game.world)


def compile_all() -> None:
    """Compile what is not on disk of all players, and of games on tables with either record."""
    from silverball.table import load_table

    for table in map(load_table, TABLES.values()):
        warm_up(table)
        for demo_player in DEMO_PLAYERS:
            if demo_player.kernel:
                warm_up_player(demo_player, table)


_compiler = Compiler("silverball.app.player_warmup")

if __name__ == "__main__":
    if hasattr(os, "nice"):
        with contextlib.suppress(OSError):
            os.nice(NICENESS)
    compile_all()
