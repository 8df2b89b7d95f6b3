"""All errors that Silverball raises on purpose, by who has to fix what.

    SilverballError
    ├── TableError        a table cannot be used; `problems` lists every mistake with its path
    │   └── UnknownTable  no built-in table and no file has that name
    ├── BoardFull         the board already holds as many balls as the table allows
    ├── NoRoom            there is no free place for a ball, or the given place overlaps something
    ├── StateError        saved bytes belong to another table, are damaged or describe an impossible state
    ├── FaultError        a world has stopped at an impossible state; `fault` names it
    ├── NoDisplay         there is no screen to open a window on
    ├── MissingExtra      an optional package is needed; the message says which extra to install
    │   └── OutdatedExtra an optional package is there, but too old
    └── OutputError       a file cannot be written (unknown ending, no such folder, no permission)

A message says where, what was expected, what was given and what to do. The command line prints the message
alone and exits with code 2; it leaves no partial files. Control characters of files, names and
arguments that a message repeats are escaped: every line goes through `plain`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

from silverball.plain import plain


class SilverballError(Exception):
    """The root of every error that Silverball raises on purpose.

    Args:
        lines: The lines of the message, usually one.
    """

    def __init__(self, *lines: str) -> None:
        super().__init__("\n".join(map(plain, lines)))


class Problem(NamedTuple):
    """One mistake in a table: where it is and how to fix it.

    Attributes:
        path: The place in the file, for example ``triangular_prism[2].vertices``.
        message: What was expected, what was given and how to fix it, as one sentence.
        severity: An ``"error"`` keeps a table from being played; a ``"warning"`` is something that its maker
            may want, for example parts that overlap.
    """

    path: str
    message: str
    severity: Literal["error", "warning"] = "error"

    @property
    def is_error(self) -> bool:
        """Whether the table cannot be played."""
        return self.severity == "error"

    def __str__(self) -> str:
        """Return the problem on one line."""
        return f"{self.path}: {self.message}" if self.path else self.message


class TableError(SilverballError):
    """A table cannot be used; all problems are reported, not only the first.

    Attributes:
        source: The file or the name of the table.
        problems: Every `Problem`, in the order of the file.
    """

    def __init__(self, source: str, problems: Sequence[Problem]) -> None:
        self.source = plain(source)
        self.problems = tuple(p._replace(path=plain(p.path), message=plain(p.message)) for p in problems)
        count = len(self.problems)
        head = f"{source}: {count} problem{'' if count == 1 else 's'}"
        super().__init__(head, *(f"  {problem}" for problem in self.problems))


class UnknownTable(TableError):
    """No built-in table and no file has that name."""

    def __init__(self, name: str, message: str) -> None:
        super().__init__(name, [Problem("", message)])


class BoardFull(SilverballError):
    """The board already holds as many balls as the table allows."""


class NoRoom(SilverballError):
    """There is no free place for a ball, or the given place overlaps something."""


class StateError(SilverballError):
    """Saved bytes belong to another table, are damaged, or describe an impossible state."""


class FaultError(SilverballError):
    """A world has stopped because its state became impossible.

    Attributes:
        fault: The name of the fault.
        state: The bytes of the world at the fault, for `World.restore` and for a report.
    """

    def __init__(self, message: str, fault: str, state: bytes) -> None:
        super().__init__(message)
        self.fault = fault
        self.state = state


class NoDisplay(SilverballError):
    """There is no screen to open a window on."""


class MissingExtra(SilverballError):
    """An optional package is missing; the message says which extra installs it."""

    def __init__(self, what: str, extra: str) -> None:
        super().__init__(
            f"{what} needs an optional package: install it with  pip install 'silverball[{extra}]'"
        )


class OutdatedExtra(MissingExtra):
    """An optional package is installed, but too old."""

    def __init__(self, what: str, package: str, found: str, needed: str, extra: str) -> None:
        SilverballError.__init__(
            self,
            f"{what} needs {package} {needed} or later, and {found} is installed: "
            f"update it with  pip install --upgrade 'silverball[{extra}]'",
        )


class OutputError(SilverballError):
    """A file cannot be written."""
