"""What do Ctrl-C, SIGTERM and SIGHUP do? They end a command, in a place where that is safe.

Python calls a handler between any two instructions of the main thread. If it raised while a module is being
imported, an object destroyed or a thread begun, the exception would be swallowed, become a traceback, or
leave something half made. So the handler looks at what the thread is doing and, if need be, comes again a
little later. (What is compiled is compiled in another thread, see `physics/compile_thread.py`.)

Only the standard library is imported here, and nothing else before the handlers are set.
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

AGAIN_SECONDS = 0.02
STOPPED = 130  # the exit code after Ctrl-C
NAMES = ("SIGINT", "SIGTERM", "SIGHUP")  # a terminal that closes must not leave half files behind either
DELICATE = {  # functions of the standard library that must not be left half done; of all files the last line
    "threading.py": ("start", "set", "notify", "_release_save", "_acquire_restore"),
    "thread.py": ("submit", "_adjust_thread_count"),
    "subprocess.py": ("__init__",),
    "weakref.py": ("remove", "_commit_removals", "__call__"),
    "_weakrefset.py": ("_remove", "_commit_removals"),
    "": ("__del__",),
}


def run_until_stopped(command: Callable[[], int]) -> None:
    """Run a command and end the process with its exit code, 128 + N after signal N."""
    try:
        try:
            for number in _heard():
                signal.signal(number, _stop)
            code = command()
        finally:
            _hear_nothing()
    except KeyboardInterrupt:
        _hear_nothing()
        code = stopped()
    except SystemExit as end:
        _hear_nothing()
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    _leave(code)


def stopped() -> int:
    """Say that somebody has stopped the program; the exit code."""
    with contextlib.suppress(OSError, ValueError):
        print("stopped", file=sys.stderr)
    return STOPPED


def _heard() -> list[int]:
    """The signals that end the command: those of this system that whoever has started it wants to be heard.

    `nohup` does not want it of SIGHUP, nor a shell of SIGINT for what runs in the background.
    """
    numbers = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]
    return [number for number in numbers if signal.getsignal(number) is not signal.SIG_IGN]


def _hear_nothing() -> None:
    """From here on nothing is interrupted."""
    for number in _heard():
        signal.signal(number, signal.SIG_IGN)


def _stop(number: int, frame: FrameType | None) -> None:
    """End the command, now or a little later."""
    if not _is_safe(frame):
        _thread.start_new_thread(_send_again, (number,))
    elif number == signal.SIGINT:
        raise KeyboardInterrupt
    else:
        raise SystemExit(128 + number)


def _send_again(number: int) -> None:
    time.sleep(AGAIN_SECONDS)
    if hasattr(signal, "pthread_kill"):  # ends a wait of the main thread too
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


def _is_safe(frame: FrameType | None) -> bool:
    """Whether an exception may be raised in this frame of the main thread."""
    while frame is not None:
        file, name = os.path.basename(frame.f_code.co_filename), frame.f_code.co_name
        if file.startswith("<frozen importlib") or name in (*DELICATE.get(file, ()), *DELICATE[""]):
            return False
        frame = frame.f_back
    return True


def _leave(code: int) -> None:
    """End the process."""
    from silverball.cli.streams import give_up

    give_up(sys.stdout)
    give_up(sys.stderr)
    if not any(thread.daemon for thread in threading.enumerate()):
        sys.exit(code)
    # A thread may be in the compiler, for many seconds more; Python must not be taken down under it.
    aside = sys.modules.get("silverball.physics.compile_thread")
    if aside is not None and hasattr(aside, "wait_for_compiler"):
        atexit.unregister(aside.wait_for_compiler)
    atexit._run_exitfuncs()
    os._exit(code)
