"""Compiling in a background process of low priority, because compiling holds the interpreter lock.

The process fills the cache of machine code, from which the game then loads.
"""

from __future__ import annotations

import atexit
import contextlib
import subprocess
import sys
import threading

POLL_SECONDS = 0.1


class Compiler:
    """One process that compiles, shared by all who wait for it. It ends with the program.

    Args:
        module: The module that it runs, which compiles and may lower its own priority.
        arguments: What it is told.
    """

    def __init__(self, module: str, *arguments: str) -> None:
        self._command = module, *arguments
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        atexit.register(self.kill)

    def start(self) -> None:
        """Start the process, if it can be."""
        with contextlib.suppress(OSError, RuntimeError):  # `finish` tells
            self._running()

    def finish(self, stop: threading.Event, most_seconds: float) -> bool:
        """Run the process to its end.

        Args:
            stop: When it is set, this call stops waiting; the process continues for others.
            most_seconds: The time after which the process is killed [s].

        Returns:
            Whether the process has succeeded.
        """
        try:
            process = self._running()
        except (OSError, RuntimeError):  # RuntimeError: the interpreter is shutting down
            return False
        waited = 0.0
        while process.poll() is None:
            if stop.wait(POLL_SECONDS):
                return False
            waited += POLL_SECONDS
            if waited > most_seconds:
                self.kill()
                return False
        return process.returncode == 0

    def close(self) -> None:
        """Kill the process if it runs; the object is not used any more."""
        self.kill()
        atexit.unregister(self.kill)

    def kill(self) -> None:
        """Kill the process if it runs."""
        with self._lock:
            if self._process is not None and self._process.poll() is None:
                with contextlib.suppress(OSError):
                    self._process.kill()
                    self._process.wait()

    def _running(self) -> subprocess.Popen[bytes]:
        """Return the process, and start it if it does not run."""
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                # On Windows a process cannot lower its priority later.
                flags = getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0)
                self._process = subprocess.Popen(
                    [sys.executable, "-m", *self._command],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    creationflags=flags,
                )
            return self._process
