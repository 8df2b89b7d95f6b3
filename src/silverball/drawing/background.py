"""Baking in the background while a game is played: a thread bakes, and another process compiles.

    compile, if the machine code is not cached  →  the table  →  its moving parts  →  the empty table

Compiling holds Python's lock, so it runs in a process of its own, at low priority. If it fails, the sketch
remains.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from silverball.background_process import Compiler
from silverball.background_thread import BackgroundThread
from silverball.drawing.camera import Camera
from silverball.drawing.picture_cache import PictureCache
from silverball.drawing.themes import Theme
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.drawing.compose import Composer

LAST_KERNEL = "draw_ball"  # the last kernel that a frame calls: when it is compiled, all are
COMPILE_SECONDS = 1800.0  # timeout of the compilation; it takes 12 to 35 s of processor time


class Background:
    """Bakes a table in the background.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        cache: Where baked pictures are kept.
        is_random: Whether other boards of the same recipe may follow, which share the empty table.

    Attributes:
        painter: Draws the table in full quality; None until it is baked.
        error: The error that ended the baking, if any.
    """

    def __init__(
        self, table: Table, camera: Camera, theme: Theme, cache: PictureCache, is_random: bool
    ) -> None:
        self.painter: Composer | None = None
        self.error: Exception | None = None
        self._table = table
        self._camera = camera
        self._theme = theme
        self._cache = cache
        self._is_random = is_random
        self._stop = threading.Event()
        self._thread = BackgroundThread(self._work, "drawing", self._stop)
        self._thread.start()

    @property
    def is_done(self) -> bool:
        """Whether the work has ended, finished or not."""
        return not self._thread.is_alive()

    def wait(self, seconds: float | None = None) -> None:
        """Wait until everything is baked, or for some seconds."""
        self._thread.join(seconds)

    def close(self) -> None:
        """Cancel what is not finished. Compiling continues, because the next picture needs it too."""
        self._stop.set()

    def _work(self) -> None:
        from silverball.drawing.bake_threads import BakeCancelled, BakeThreads, lower_priority

        lower_priority()
        if self._stop.is_set() or not self._compile():
            return
        from silverball.drawing.compose import Composer
        from silverball.drawing.picture_provider import PictureProvider

        bake_threads = BakeThreads(stop=self._stop, in_background=True)
        try:
            provider = PictureProvider(self._table, self._camera, self._theme, self._cache, bake_threads)
            painter = Composer(
                self._table, self._camera, self._theme, provider.table(), provider.levels(), provider.sprite
            )
            if self._stop.is_set():
                return
            self.painter = painter
            provider.bake_sprites()
            if self._is_random:
                provider.bake_empty()
        except BakeCancelled:
            provider.save_sprites()
        except Exception as error:  # the game continues with the present picture
            self.error = error

    def _compile(self) -> bool:
        """Compile the drawing if it is not compiled yet; return whether it is now."""
        if is_compiled():
            return True
        return _compiler.finish(self._stop, COMPILE_SECONDS) and is_compiled()


def is_compiled() -> bool:
    """Return whether the machine code of the drawing is on disk."""
    from silverball.physics import kernel

    return kernel.is_compiled(LAST_KERNEL, kernel.DRAWING)


_compiler = Compiler("silverball.drawing.warm_up")  # one for all renderers
