"""Loading of the physics in a thread while the table is already on screen, and its progress bar.

The first start on a machine compiles for some seconds; later ones load in a fraction of one.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.menus import page_layout
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL

if TYPE_CHECKING:
    from silverball.table import Table


class Startup:
    """Loads, and if necessary compiles, everything that a game needs.

    Args:
        table: A board for the first calls of the physics.
        on_compile: Called from the thread if the physics must be compiled first.
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
        except BaseException as error:  # raised by `is_done`
            self._error = error


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


def draw_page(seconds: float, progress: Progress | None) -> Dots:
    """Draw the whole display while a requested game waits for the physics.

    Args:
        seconds: Time of a monotonic clock [s].
        progress: Progress of the compilation; None while nothing is compiled, only loaded.
    """
    dots = Dots()
    if progress is None:
        page_layout.title(dots, "GETTING READY")
        place = round(seconds % SWEEP_TIME / SWEEP_TIME * WIDTH)
        dots.frame(0, page_layout.MIDDLE_Y, WIDTH, 10, page_layout.HALF)
        dots.box(min(place, WIDTH - 14), page_layout.MIDDLE_Y + 2, 12, 6)
        return dots
    page_layout.title(dots, "COMPILING, ONCE")
    dots.text(progress.text, WIDTH, page_layout.TITLE_Y, NORMAL, "right")
    page_layout.meter(dots, 0, page_layout.MIDDLE_Y, WIDTH, progress.share, 10)
    page_layout.foot(dots, ("THEN IT BEGINS", "ESC: BACK TO THE MENU"), seconds)
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
