"""How do players with code of their own get ready while the window goes on? Compiled elsewhere, loaded here.

    compiled code there? (else: `python -m silverball.app.player_warmup`, a process of low priority, makes it)
    →  loaded in a thread, by one press  →  ready

Compiling holds Python's lock, so it never happens in the game's own process. If it fails, the player does not
get ready and its stand-in goes on (`demo_players.py`).
"""

from __future__ import annotations

import contextlib
import os
import threading
import warnings
from typing import TYPE_CHECKING

from silverball.app.demo_players import PERFORMERS, STAND_IN, Performer, performers
from silverball.background_process import Compiler

if TYPE_CHECKING:
    from silverball.table import Table

HEAD_START = 2.0  # [s] for the first pictures of a game, which loading would hold up by some 0.15 s
NICENESS = 10  # behind the game, and behind the drawing, which is seen first
COMPILE_SECONDS = 1800.0  # after which compiling is given up; 17 s of a processor, if it gets one


class Rehearsal:
    """Makes the players ready, one after the other; begun when the physics is loaded.

    Args:
        table: A finished table to try them on.
    """

    def __init__(self, table: Table) -> None:
        self._table = table
        self._ready = {STAND_IN.name}
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._work, name="silverball rehearsal", daemon=True)
        self._thread.start()

    def is_ready(self, name: str) -> bool:
        """Whether the player of a name can play without a wait."""
        return name in self._ready

    def wait(self, seconds: float | None = None) -> None:
        """Wait until all players are ready, or given up."""
        self._thread.join(seconds)

    def close(self) -> None:
        """Stop; what is being compiled is dropped at the program's end."""
        self._stop.set()

    def _work(self) -> None:
        if self._stop.wait(HEAD_START):
            return
        from silverball.players import PlayerError, player_names

        player_names()  # imports the players of installed packages
        for performer in performers():
            try:
                if is_there(performer) or (self._compile() and is_there(performer)):
                    press_once(performer, self._table)
                    self._ready.add(performer.name)
            except PlayerError as error:
                warnings.warn(f"{error}; the player {STAND_IN.name!r} stands in", stacklevel=1)
            except Exception:  # the game goes on, and so does the stand-in
                pass
            if self._stop.is_set():
                return

    def _compile(self) -> bool:
        from silverball.physics.kernel import cache_folder

        # Without a folder for it, another process would compile in vain.
        return cache_folder() is not None and _compiler.finish(self._stop, COMPILE_SECONDS)


def is_there(performer: Performer) -> bool:
    """Whether all compiled code of a player is on disk."""
    from silverball.physics.kernel import is_compiled

    return not performer.kernel or is_compiled(performer.kernel)


def press_once(performer: Performer, table: Table) -> None:
    """Let a player press once before a ball, so that no later press has to load or compile."""
    from silverball.game.game import Game
    from silverball.players import make_player

    game = Game(table, 0)
    game.create_ball()
    game.step(False, False, 1)
    make_player(performer.name).press(game.world)


def compile_all() -> None:
    """Compile what is missing of all players."""
    from silverball.table import load_table

    for performer in PERFORMERS:
        if not is_there(performer):
            press_once(performer, load_table("classic"))


_compiler = Compiler("silverball.app.player_warmup")

if __name__ == "__main__":
    if hasattr(os, "nice"):
        with contextlib.suppress(OSError):
            os.nice(NICENESS)
    compile_all()
