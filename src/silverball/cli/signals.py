"""Signal handlers: Ctrl-C, SIGTERM and SIGHUP end a command at a safe point.

Python calls a signal handler between any two instructions of the main thread. An exception raised there while
a module is imported, an object destroyed or a thread started would be swallowed, become a traceback, or leave
something half done. The handler therefore inspects the stack of the main thread and, if necessary, sends the
signal again a moment later. (Kernels are compiled in another thread, see `physics/compile_thread.py`.)

This module imports only the standard library, so that the handlers are set before anything else is imported.
"""

from __future__ import annotations

import _thread
import atexit
import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType

RETRY_SECONDS = 0.02
STOPPED = 130  # the exit code after Ctrl-C
NAMES = ("SIGINT", "SIGTERM", "SIGHUP")  # SIGHUP too: a closed terminal must not leave partial files
UNINTERRUPTIBLE = {  # functions of the standard library, by file; "" stands for every file
    "threading.py": ("start", "set", "notify", "_release_save", "_acquire_restore"),
    "thread.py": ("submit", "_adjust_thread_count"),
    "subprocess.py": ("__init__",),
    "weakref.py": ("remove", "_commit_removals", "__call__"),
    "_weakrefset.py": ("_remove", "_commit_removals"),
    "": ("__del__", "__getattr__", "__get__"),  # called from C code, which may discard what they raise
}


def run_until_stopped(command: Callable[[], int]) -> None:
    """Run a command and exit with its exit code, or with 128 + N after signal N."""
    try:
        try:
            for number in _handled():
                signal.signal(number, _stop)
            code = command()
        finally:
            _ignore_signals()
    except KeyboardInterrupt:
        _ignore_signals()
        code = stopped()
    except SystemExit as end:
        _ignore_signals()
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    _leave(code)


def stopped() -> int:
    """Print that the program was stopped; returns the exit code."""
    with contextlib.suppress(OSError, ValueError):
        print("stopped", file=sys.stderr)
    return STOPPED


def _handled() -> list[int]:
    """The signals that end the command: those of this system that were not ignored when it was started.

    `nohup` ignores SIGHUP, and a shell ignores SIGINT for its background commands.
    """
    numbers = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]
    return [number for number in numbers if signal.getsignal(number) is not signal.SIG_IGN]


def _ignore_signals() -> None:
    """Ignore further signals."""
    for number in _handled():
        signal.signal(number, signal.SIG_IGN)


def _stop(number: int, frame: FrameType | None) -> None:
    """Signal handler: end the command, now or a moment later."""
    if not _is_safe(frame):
        _thread.start_new_thread(_send_again, (number,))
    elif number == signal.SIGINT:
        raise KeyboardInterrupt
    else:
        raise SystemExit(128 + number)


def _send_again(number: int) -> None:
    time.sleep(RETRY_SECONDS)
    if hasattr(signal, "pthread_kill"):  # also ends a wait of the main thread
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


def _is_safe(frame: FrameType | None) -> bool:
    """Whether an exception may be raised in this frame of the main thread."""
    while frame is not None:
        file, name = os.path.basename(frame.f_code.co_filename), frame.f_code.co_name
        if file.startswith("<frozen importlib") or name in (
            *UNINTERRUPTIBLE.get(file, ()),
            *UNINTERRUPTIBLE[""],
        ):
            return False
        frame = frame.f_back
    return True


def _leave(code: int) -> None:
    """Exit the process with an exit code."""
    from silverball.cli.streams import discard_output

    discard_output(sys.stdout)
    discard_output(sys.stderr)
    if not any(thread.daemon for thread in threading.enumerate()):
        sys.exit(code)
    # A thread may stay in the compiler for many seconds; Python must not be finalized meanwhile.
    compile_thread = sys.modules.get("silverball.physics.compile_thread")
    if compile_thread is not None and hasattr(compile_thread, "wait_for_compiler"):
        atexit.unregister(compile_thread.wait_for_compiler)
    atexit._run_exitfuncs()
    os._exit(code)
