"""Standard streams: handling of streams that are closed, full, broken, or limited to few characters.

The descriptor of a closed stream is reserved: otherwise the next opened file would get it and be written to
by accident. Printing to a closed standard output is an error (exit code 2); without standard input or
standard error everything works. A reader that closes the output early, like `head`, is not an error: the rest
of the output is dropped and the exit code is 0.
"""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Any, NoReturn

from silverball.errors import OutputError


class ClosedOutput(io.TextIOBase):
    """Replaces a closed standard output; writing to it raises an error."""

    encoding = "utf-8"

    def write(self, _text: str) -> NoReturn:
        """Raise an error.

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


def discard_output(stream: Any) -> None:
    """Redirect a stream that cannot be written to the null device, since Python flushes it at exit."""
    with suppress(OSError):
        stream.flush()
        return
    with suppress(OSError, ValueError, AttributeError):
        number = stream.fileno()
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, number)
        os.close(null)


def is_broken_pipe(error: BaseException) -> bool:
    """Whether the reader has closed the output; click and rich wrap that error in others."""
    return isinstance(error, BrokenPipeError) or isinstance(error.__context__, BrokenPipeError)
