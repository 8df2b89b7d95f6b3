"""Work in a thread of the background, which never outlives the interpreter.

A daemon thread that still runs while the interpreter shuts down can abort the program: an import fails there,
and the message about it may meet the end of stderr. So these threads are stopped and waited for at exit.
"""

from __future__ import annotations

import atexit
import threading
import time
import weakref
from collections.abc import Callable

EXIT_WAIT = 2.0  # longest wait for all threads at exit [s]


class BackgroundThread(threading.Thread):
    """A daemon thread that is stopped and waited for at exit.

    Args:
        work: What it does. An error that it raises after the main thread has ended is not reported.
        name: Its name in tracebacks, after "silverball".
        stop: Set at exit, if the work can be stopped.
    """

    def __init__(self, work: Callable[[], None], name: str, stop: threading.Event | None = None) -> None:
        super().__init__(name=f"silverball {name}", daemon=True)
        self._work = work
        self._stop_work = stop
        _threads.add(self)

    def run(self) -> None:
        """Do the work."""
        try:
            self._work()
        except BaseException:
            if threading.main_thread().is_alive():
                raise

    def ask_to_stop(self) -> None:
        """Ask the work to stop, if it can."""
        if self._stop_work is not None:
            self._stop_work.set()


_threads: weakref.WeakSet[BackgroundThread] = weakref.WeakSet()


@atexit.register
def end_all() -> None:
    """Stop all threads of the background, and wait for them, but not for long."""
    running = [thread for thread in _threads if thread.is_alive()]
    end = time.monotonic() + EXIT_WAIT
    for thread in running:
        thread.ask_to_stop()
    for thread in running:
        thread.join(max(0.0, end - time.monotonic()))
