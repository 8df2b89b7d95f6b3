"""What if a standard stream is closed, full, read by nobody, or knows few characters?

A closed one is kept from being taken: else the next file that is opened would get its number, and be
written into. Who closes standard output and then asks for something that is printed is told so (exit code
2); without standard input or standard error everything works. A reader who goes away, as `head` does, is no
error: what is left to say is not wanted, and the exit code is 0.
"""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Any, NoReturn

from silverball.errors import OutputError


class Closed(io.TextIOBase):
    """Standard output where there is none."""

    encoding = "utf-8"

    def write(self, _text: str) -> NoReturn:
        """Nothing can be printed.

        Raises:
            OutputError: Always.
        """
        raise OutputError("standard output is closed: open it, or send it to a file or to /dev/null")


def prepare() -> None:
    """Make the three streams safe to use; called first of all."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            null = os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free: this one
            os.set_inheritable(null, True)
    if sys.stdin is None:
        sys.stdin = open(os.devnull, encoding="utf-8")  # noqa: SIM115  (as long as the program)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = Closed()
    elif isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # as standard error does by itself


def give_up(stream: Any) -> None:
    """Let a stream that cannot be written end in nothing, or Python would try the rest again at the exit."""
    with suppress(OSError):
        stream.flush()
        return
    with suppress(OSError, ValueError, AttributeError):
        number = stream.fileno()
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, number)
        os.close(null)


def is_broken_pipe(error: BaseException) -> bool:
    """Whether whoever read the output has gone; click and rich end the program then in their own ways."""
    return isinstance(error, BrokenPipeError) or isinstance(error.__context__, BrokenPipeError)
