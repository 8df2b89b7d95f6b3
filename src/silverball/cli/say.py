"""How does a command tell what came of it?

Line by line, or as JSON; whatever stands in it that came from a file or was typed is shown and never obeyed.
"""

from __future__ import annotations

import json
from typing import Any

import typer

from silverball.plain import plain


def say(*lines: str, err: bool = False) -> None:
    """Print lines to standard output, or to standard error."""
    for line in lines:
        typer.echo(plain(line), err=err)


def say_json(value: Any, indent: int | None = 2) -> None:
    """Print a value as JSON, in ASCII."""
    typer.echo(as_json(value, indent))


def as_json(value: Any, indent: int | None = 2) -> str:
    """A value as JSON, in ASCII."""
    # `json` leaves the delete character as it is, the only one that is obeyed.
    return json.dumps(value, indent=indent).replace("\x7f", "\\u007f")
