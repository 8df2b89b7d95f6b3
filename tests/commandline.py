"""How the tests start the command line as a program that can be stopped."""

from __future__ import annotations

import signal
import subprocess
import sys
from typing import Any


def hear_ctrl_c() -> None:
    """Let a new process hear Ctrl-C, as in a terminal: what a shell runs in the background does not."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def started(*arguments: str, **options: Any) -> subprocess.Popen[str]:
    """`silverball` with these arguments, in a process of its own that hears Ctrl-C."""
    if sys.platform != "win32":
        options["preexec_fn"] = hear_ctrl_c
    return subprocess.Popen(
        [sys.executable, "-m", "silverball", *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options,
    )  # fmt: skip
