"""Loading of the physics in a thread while the table is already on screen, and the page that shows it.

The first start on a machine compiles for some seconds, in two processes: the step here, the rules in
`python -m silverball.app.startup LAYOUT`. Later starts load in a fraction of a second.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from silverball.app.loading import layout_of
from silverball.app.menus import page_layout
from silverball.background_process import Compiler
from silverball.background_thread import BackgroundThread
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL, TINY

if TYPE_CHECKING:
    from silverball.app.dot_game import DotGame
    from silverball.table import Table


TABLES = {"full": "silver_comet", "plain": "classic"}
"""A table of each layout of worlds, which has machine code of its own."""
COMPILE_TIMEOUT = 600.0  # [s] after which this process compiles the rules itself
ELSEWHERE = ("silverball.referee.", "silverball.players.")  # modules that the other process compiles


class Startup:
    """Loads, and if necessary compiles, everything that a game needs.

    Args:
        table: A board for the first calls of the physics.
        on_compile: Called from the thread if the physics must be compiled first.

    Attributes:
        table: The board.
        layout: The layout of worlds that is loaded, once it is known.
    """

    layout = ""

    def __init__(self, table: Table, on_compile: Callable[[], None] = lambda: None) -> None:
        self._compiles_since: float | None = None  # by time.monotonic
        self._compiled_before: dict[Any, int] = {}
        self._is_shared = False  # the compilation, by two processes
        self._on_compile = on_compile
        self.table = table
        self._error: BaseException | None = None
        self._thread = BackgroundThread(self._load, "startup")
        self._thread.start()

    @property
    def is_done(self) -> bool:
        """Whether a game can begin.

        Raises:
            Exception: The error of the thread, if it failed.
        """
        if self._thread.is_alive():
            return False
        if self._error is not None:
            raise self._error
        return True

    @property
    def progress(self) -> Progress | None:
        """The progress of the compilation; None if nothing is compiled."""
        if self._compiles_since is None:
            return None
        from silverball.physics.kernel import compiled_share

        share = compiled_share(before=self._compiled_before, without=ELSEWHERE if self._is_shared else ())
        return Progress(time.monotonic() - self._compiles_since, share)

    def wait(self) -> None:
        """Wait until a game can begin."""
        self._thread.join()

    def _load(self) -> None:
        try:
            self.layout = layout_of(self.table)
            if not is_compiled_on_disk(self.layout):
                self._compile()
            warm_up(self.table)
        except BaseException as error:  # raised by `is_done`
            self._error = error

    def _compile(self) -> None:
        """Compile the step, and meanwhile the rules in another process, if that is worth it."""
        from silverball.physics.kernel import cache_folder, compiled_counts, evict_old_code
        from silverball.world import World

        evict_old_code()
        self._compiled_before = compiled_counts()
        self._is_shared = cache_folder() is not None and (os.cpu_count() or 1) > 1
        self._compiles_since = time.monotonic()
        self._on_compile()
        if not self._is_shared:
            return
        compiler = Compiler(__name__, self.layout)
        compiler.start()
        World(self.table).step()
        compiler.finish(threading.Event(), COMPILE_TIMEOUT)
        compiler.close()


def is_compiled_on_disk(layout: str) -> bool:
    """Whether the compiled code of a game is on disk, for worlds of a layout."""
    from silverball.physics.kernel import is_compiled

    return all(is_compiled(name, layout=layout) for name in ("step_single_world", "judge_single_game"))


def compile_rules(layout: str) -> None:
    """Compile the rules, and what else a game needs apart from the step, for worlds of a layout."""
    from silverball.game.game import Game
    from silverball.players import make_player

    game = Game(TABLES[layout], 0)
    game.create_ball()
    make_player("reflex").press(game.world)


def compiling_message() -> str:
    """Return the message shown while the physics is compiled; it imports the compiler."""
    from silverball.physics.code_cache import Damage
    from silverball.physics.kernel import cache_folder

    if Damage.message:
        return "some compiled code was damaged: compiling it again; this takes some seconds…"
    if cache_folder() is None:
        return "compiling the physics, as at every start: its cache folder cannot be written…"
    return "compiling the physics for this machine, once; this takes some seconds…"


def warm_up(table: Table) -> None:
    """Call everything that a game calls once, so that no later call has to load or compile."""
    from silverball.game.game import Game
    from silverball.players import make_player

    game = Game(table, 0)
    game.create_ball()
    game.jitter()
    game.step(True, True, 2)
    game.step(False, False, 2)
    game.replay.to_text()
    make_player("reflex").press(game.world)


MIN_SHARE = 0.05  # below which the total time cannot be estimated
LINE_Y = 8  # [dot] of the bar below the title of a menu
TITLE_WIDTH = WIDTH - 62  # [dot] of the title, left of the page dots
HINT_TURN = 2.5  # [s] for each hint on the page
SWEEP_TIME = 1.2  # [s] of one sweep of the bar while progress is unknown


class Progress(NamedTuple):
    """Progress of the compilation.

    Attributes:
        seconds: Since it began.
        share: Compiled fraction, 0 to 1.
    """

    seconds: float
    share: float

    @property
    def text(self) -> str:
        """The time so far and, once it can be estimated, the total time."""
        if self.share < MIN_SHARE:
            return f"{self.seconds:.0f} S"
        total = max(self.seconds / self.share, self.seconds + 1.0)
        return f"{self.seconds:.0f}/{total:.0f} S"


def draw_page(
    seconds: float, progress: Progress | None, game: DotGame, keys: tuple[str, str] = ("A", "D")
) -> Dots:
    """Draw the whole display while a requested game waits for the physics: its progress, and a tiny game.

    Args:
        seconds: Time of a monotonic clock [s].
        progress: Progress of the compilation; None while nothing is compiled, only loaded.
        game: What can be played meanwhile.
        keys: The paddle keys, as the display writes them.
    """
    dots = Dots()
    if progress is None:
        page_layout.title(dots, "GETTING READY")
        place = round(seconds % SWEEP_TIME / SWEEP_TIME * WIDTH)
        dots.frame(0, page_layout.MIDDLE_Y, WIDTH, 10, page_layout.HALF)
        dots.box(min(place, WIDTH - 14), page_layout.MIDDLE_Y + 2, 12, 6)
        return dots
    game.draw(dots)
    draw_line(dots, progress)
    after = "THEN IT BEGINS" if seconds % (2.0 * HINT_TURN) < HINT_TURN else "ESC: THE MENU"
    dots.text(after, WIDTH, page_layout.TITLE_Y + 1, TINY, "right", page_layout.HALF)
    if not game.is_begun and page_layout.is_blink_on(seconds, HINT_TURN):
        text = f"HOLD {keys[0]} OR {keys[1]}"
        width = NORMAL.width(text) + 4
        dots.box((WIDTH - width) // 2, page_layout.FOOT_Y - 1, width, HEIGHT - page_layout.FOOT_Y + 1, 0)
        dots.text(text, WIDTH // 2, page_layout.FOOT_Y, NORMAL, "center")
    return dots


def draw_line(dots: Dots, progress: Progress) -> None:
    """Draw a bar in a menu, with the time in place of the menu's title."""
    dots.box(0, page_layout.TITLE_Y, TITLE_WIDTH, LINE_Y, 0)
    text = f"COMPILING {progress.text}"
    if NORMAL.width(text) > TITLE_WIDTH:
        text = progress.text
    dots.text(text, 0, page_layout.TITLE_Y, NORMAL)
    dots.box(0, LINE_Y, WIDTH, 1, page_layout.FAINT)
    dots.box(0, LINE_Y, round(WIDTH * min(progress.share, 1.0)), 1)


if __name__ == "__main__":
    compile_rules(sys.argv[1])
