"""Standard streams: made safe where they are closed, full, broken, or limited to few characters.

The number of a closed stream is reserved: otherwise the next file to be opened would get it, and be written
to by accident. Printing to a closed standard output is an error (exit code 2); without standard input or
standard error everything works. A reader that goes away, as `head` does, is not an error: the rest of the
output is dropped and the exit code is 0.
"""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Any, NoReturn

from silverball.errors import OutputError


class ClosedOutput(io.TextIOBase):
    """Stands in for a closed standard output."""

    encoding = "utf-8"

    def write(self, _text: str) -> NoReturn:
        """Refuse to print.

        Raises:
            OutputError: Always.
        """
        raise OutputError("standard output is closed: open it, or send it to a file or to /dev/null")


def prepare() -> None:
    """Make the three streams safe to use; called before anything else."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            null = os.open(os.devnull, os.O_RDWR)  # gets the lowest free number: this one
            os.set_inheritable(null, True)
    if sys.stdin is None:
        sys.stdin = open(os.devnull, encoding="utf-8")  # noqa: SIM115  (open until the exit)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = ClosedOutput()
    elif isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # as standard error does by default


def give_up(stream: Any) -> None:
    """Send the rest of a stream that cannot be written to the null device; Python flushes it at the exit."""
    with suppress(OSError):
        stream.flush()
        return
    with suppress(OSError, ValueError, AttributeError):
        number = stream.fileno()
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, number)
        os.close(null)


def is_broken_pipe(error: BaseException) -> bool:
    """Whether the reader of the output has gone; click and rich wrap that in errors of their own."""
    return isinstance(error, BrokenPipeError) or isinstance(error.__context__, BrokenPipeError)
