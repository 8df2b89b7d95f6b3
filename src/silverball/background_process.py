"""Who compiles while a game is played? Another process, of low priority; compiling holds Python's lock.

It fills the cache of machine code, from which the game's own process then loads.
"""

from __future__ import annotations

import atexit
import contextlib
import subprocess
import sys
import threading

POLL_SECONDS = 0.1


class Compiler:
    """The one process that compiles, whoever waits for it. It does not outlive the program.

    Args:
        module: What it runs, and what compiles; the module itself sees to its priority.
    """

    def __init__(self, module: str) -> None:
        self._module = module
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        atexit.register(self.kill)

    def finish(self, stop: threading.Event, most_seconds: float) -> bool:
        """Run it to its end.

        Args:
            stop: Once it is set, nobody waits any longer; the process goes on, for others need it too.
            most_seconds: After which it is killed [s].

        Returns:
            Whether it has ended well.
        """
        try:
            process = self._running()
        except OSError:
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

    def kill(self) -> None:
        """End it if it runs."""
        with self._lock:
            if self._process is not None and self._process.poll() is None:
                with contextlib.suppress(OSError):
                    self._process.kill()
                    self._process.wait()

    def _running(self) -> subprocess.Popen[bytes]:
        """The process, started if none runs."""
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                # On Windows a process cannot lower its own priority later.
                flags = getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0)
                self._process = subprocess.Popen(
                    [sys.executable, "-m", self._module],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    creationflags=flags,
                )
            return self._process
