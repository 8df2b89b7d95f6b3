"""How does play become a film or a picture in a file? The same way for `demo` and for `replay`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from silverball.drawing.film import Picture
    from silverball.table import Table

ENDINGS = (".gif", ".mp4", ".png")
HEIGHTS = {".gif": 720, ".mp4": 1080, ".png": 1152}  # [pixel] if no size is asked for
GIF_LIMIT = 600_000_000  # pixels of all pictures together: a GIF is packed in memory, a byte or two for each

Pictures = Callable[[float, Callable[[float], None]], "Iterator[Picture]"]
"""Makes the pictures, so many for each second of play, and tells after each how many seconds are done."""


def film_size(out: Path, table: Table, seconds: float, height: int | None) -> tuple[int, int]:
    """Width and height [pixel] of a film of a table.

    Raises:
        OutputError: A GIF of that size would be too large.
    """
    from silverball.drawing import best_size
    from silverball.drawing.film import FILM_RATES
    from silverball.errors import OutputError

    ending = out.suffix.lower()
    size = best_size(table.board, height or HEIGHTS[ending])
    if ending == ".gif" and size[0] * size[1] * seconds * FILM_RATES[ending] > GIF_LIMIT:
        raise OutputError(
            f"{out}: a GIF of {seconds:g} s at {size[0]} × {size[1]} pixels is too large to make; "
            "ask for fewer --seconds, a smaller --size, or an .mp4"
        )
    return size


def shoot(out: Path, seconds: float, pictures: Pictures, *, quiet: bool = False) -> None:
    """Make the pictures with a moving line, write them, and say where they are; of a PNG the last one."""
    from rich.progress import Progress

    from silverball.cli.console import errors
    from silverball.drawing.film import FILM_RATES, write_film, write_picture

    ending = out.suffix.lower()
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task(f"playing into {out.name}", total=seconds)

        def advance(done: float) -> None:
            bar.update(task, completed=done)

        if ending == ".png":
            *_, last = pictures(1.0 / max(seconds, 1e-9), advance)
            write_picture(out, last)
        else:
            write_film(out, pictures(FILM_RATES[ending], advance))
    if not quiet:
        typer.echo(f"wrote {out}")
