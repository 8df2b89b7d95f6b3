"""Compilation in another thread, so that Ctrl-C can interrupt the wait for it.

Python handles Ctrl-C in the main thread only, between two of its instructions. Within the compiler that would
leave half-compiled code, print tracebacks from destructors, or end the process. So the main thread only
waits. An interruption ends the wait at once, and the compilation continues, since the next call needs it too.
Python cannot exit while a thread is in the compiler, so its exit waits until the current function is
compiled; the functions that call it are then not compiled.
"""

from __future__ import annotations

import atexit
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core.compiler_lock import global_compiler_lock

POLL_SECONDS = 0.1  # on Windows Ctrl-C is handled only when a wait ends
MAX_EXIT_WAIT = 60.0  # [s]


class Exiting(BaseException):
    """Python is exiting: nothing more is compiled."""


class _State:
    lock = threading.Lock()
    busy = 0  # threads in the compiler
    is_exiting = False


class _Job:
    """A call, and its result or error."""

    def __init__(self, call: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        self._call, self._arguments = call, arguments
        self.result: Any = None
        self.error: BaseException | None = None
        self.done = threading.Event()

    def run(self) -> None:
        try:
            with _busy():
                self.result = self._call(*self._arguments)
        except BaseException as error:  # raised again in the waiting thread
            self.error = error
        finally:
            self.done.set()


def run_in_compiler_thread(call: Callable[..., Any], *arguments: Any) -> Any:
    """Call something that compiles in a thread that no signal interrupts.

    Returns:
        The call's result.

    Raises:
        KeyboardInterrupt: Or whatever else a signal's handler raises; the call continues.
        BaseException: Whatever the call raised.
    """
    if _State.is_exiting:
        raise Exiting
    # A thread that is compiling or importing holds a lock: another thread would wait for it forever.
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or _is_compiling() or _is_importing():
        with _busy():
            return call(*arguments)
    job = _Job(call, arguments)
    threading.Thread(target=job.run, name="silverball compiler", daemon=True).start()
    while not job.done.wait(POLL_SECONDS):
        pass
    if job.error is not None:
        raise job.error
    return job.result


def wait_for_compiler() -> None:
    """Wait at exit until no thread is in the compiler."""
    _State.is_exiting = True
    end = time.monotonic() + MAX_EXIT_WAIT
    while _State.busy and time.monotonic() < end:
        time.sleep(POLL_SECONDS / 10)


atexit.register(wait_for_compiler)


def _is_compiling() -> bool:
    """Whether this thread holds the compiler's lock."""
    lock: Any = global_compiler_lock
    return bool(lock.is_locked())


def _is_importing() -> bool:
    """Whether this thread is called by a module that is being imported."""
    frame = sys._getframe()
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back  # type: ignore[assignment]
    return False


@contextmanager
def _busy() -> Iterator[None]:
    with _State.lock:
        _State.busy += 1
    try:
        yield
    finally:
        with _State.lock:
            _State.busy -= 1
