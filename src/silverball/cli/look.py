"""Which look was asked for, and how far is the baking? What commands share that make pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from silverball.drawing import Theme


def theme_named(name: str) -> Theme:
    """The theme of a name.

    Raises:
        SilverballError: There is none.
    """
    from silverball.drawing import THEMES
    from silverball.errors import SilverballError

    if name not in THEMES:
        raise SilverballError(f"--theme must be one of {', '.join(THEMES)}, got {name!r}")
    return THEMES[name]


@contextmanager
def baking() -> Iterator[Callable[[float], None]]:
    """A progress bar; call what it gives with the share that is done, 0 to 1."""
    from rich.progress import Progress

    from silverball.cli.console import errors
    from silverball.drawing.background import is_compiled

    words = "baking the table" if is_compiled() else "compiling the drawing for this machine, once"
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task(words, total=1.0)

        def advance(share: float) -> None:
            bar.update(task, completed=share, description="baking the table")

        yield advance
