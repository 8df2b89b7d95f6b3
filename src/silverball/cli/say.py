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
    typer.echo(json.dumps(value, indent=indent))
