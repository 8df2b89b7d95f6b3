"""How does the physics get loaded while the table is already on screen? In a thread.

The first start on a machine compiles for some seconds; later ones load in a fraction of one.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.app.progress_bar import Progress

if TYPE_CHECKING:
    from silverball.table import Table


class Startup:
    """Loads, and if need be compiles, everything that a game needs.

    Args:
        table: A finished table to try the physics on.
        on_compile: Called from the thread if the physics has to be compiled first.
    """

    def __init__(self, table: Table, on_compile: Callable[[], None] = lambda: None) -> None:
        self._compiles_since: float | None = None  # by time.monotonic
        self._on_compile = on_compile
        self._table = table
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._load, name="silverball startup", daemon=True)
        self._thread.start()

    @property
    def is_done(self) -> bool:
        """Whether a game can begin.

        Raises:
            Exception: Whatever went wrong in the thread.
        """
        if self._thread.is_alive():
            return False
        if self._error is not None:
            raise self._error
        return True

    @property
    def progress(self) -> Progress | None:
        """How far the compilation is; None if nothing is compiled."""
        if self._compiles_since is None:
            return None
        from silverball.physics.kernel import compiled_share

        return Progress(time.monotonic() - self._compiles_since, compiled_share())

    def wait(self) -> None:
        """Wait until a game can begin."""
        self._thread.join()

    def _load(self) -> None:
        try:
            from silverball.physics.kernel import evict_old_code, is_compiled

            if not is_compiled():
                evict_old_code()
                self._compiles_since = time.monotonic()
                self._on_compile()
            warm_up(self._table)
        except BaseException as error:  # shown to the player by whoever asks `is_done`
            self._error = error


def compiling_words() -> str:
    """What to tell while the physics is compiled; asked only then, for it loads the compiler."""
    from silverball.physics.code_cache import Damage
    from silverball.physics.kernel import cache_folder

    if Damage.message:
        return "some compiled code was damaged: compiling it anew; this takes some seconds…"
    if cache_folder() is None:
        return "compiling the physics, as at every start: its cache folder cannot be written…"
    return "compiling the physics for this machine, once; this takes some seconds…"


def warm_up(table: Table) -> None:
    """Call once what every game calls, so that no later call has to load or compile."""
    from silverball.game.game import Game
    from silverball.players import make_player

    game = Game(table, 0)
    game.create_ball()
    game.jitter()
    game.step(True, True, 2)
    game.step(False, False, 2)
    game.replay.to_text()
    make_player("reflex").press(game.world)
