"""Terminal output of the commands: reports on standard output, progress on standard error.

A report is printed line by line, as JSON, or as a table. Text from files or from the command line is escaped
by `plain`, so that a terminal shows control characters instead of executing them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from silverball.plain import plain

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from silverball.table import Table

PIPE_WIDTH = 200  # columns of a table where the output is not a terminal

error_console = Console(stderr=True, markup=False, highlight=False, emoji=False)


def print_lines(*lines: str, err: bool = False) -> None:
    """Print lines to standard output, or to standard error."""
    for line in lines:
        typer.echo(plain(line), err=err)


def print_json(value: Any, indent: int | None = 2) -> None:
    """Print a value as JSON, in ASCII."""
    typer.echo(json.dumps(value, indent=indent))


def print_table(table: RichTable) -> None:
    """Print a table; if the output is not a terminal, it is `PIPE_WIDTH` columns wide."""
    console = Console() if Console().is_terminal else Console(width=PIPE_WIDTH)
    console.print(table)


def progress_bar(*columns: TextColumn) -> Progress:
    """A progress bar on standard error that is removed at the end; invisible where that is not a terminal."""
    return Progress(*columns, console=error_console, transient=True, disable=not error_console.is_terminal)


class CompilationBar(Progress):
    """A bar that reads the progress of the compilation whenever it is drawn."""

    def get_renderables(self) -> Iterable[RenderableType]:
        """Update the task before it is drawn."""
        from silverball.physics.kernel import compiled_share

        for task in self.tasks:
            task.completed = compiled_share()
        return super().get_renderables()


@contextmanager
def compiling(kernel: str = "run_worlds", duration: str = "ten seconds") -> Iterator[None]:
    """Show a bar while a kernel is compiled: on the first start only, later starts load it from disk.

    Args:
        kernel: The kernel that takes longest to compile; no bar is shown if it is in the cache.
        duration: The approximate time that the compilation takes, in words.
    """
    from silverball.physics.kernel import PLAY, STUDY, cache_folder, evict_old_code, is_compiled

    if any(is_compiled(kernel, packages) for packages in (PLAY, STUDY)):
        yield
        return
    evict_old_code()
    often = "once on this machine" if cache_folder() else "at every start: its cache cannot be written"
    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn()
    with CompilationBar(
        *columns, console=error_console, transient=True, disable=not error_console.is_terminal
    ) as bar:
        bar.add_task(f"Compiling the physics, {often} (about {duration}) …", total=1.0)
        yield


@contextmanager
def baking() -> Iterator[Callable[[float], None]]:
    """Show a progress bar while a table is drawn; yields a callback that takes the share done, 0 to 1."""
    from silverball.drawing.background import is_compiled

    words = "baking the table" if is_compiled() else "compiling the drawing, once on this machine"
    with progress_bar() as bar:
        task = bar.add_task(words, total=1.0)

        def advance(share: float) -> None:
            bar.update(task, completed=share, description="baking the table")

        yield advance


def make_boards(table: Table, seed: int, worlds: int, bar: Progress) -> list[Table]:
    """A board for each world: the table itself, or the boards of consecutive seeds if it is a recipe."""
    from silverball.table import generate_table

    if table.random is None:
        return [table] * worlds
    seeds = bar.track(range(seed, seed + worlds), description="making boards")
    return [generate_table(number, table) for number in seeds]
