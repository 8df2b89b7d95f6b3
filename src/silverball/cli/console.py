"""What does the terminal show while one waits?

Progress goes to standard error, so that standard output can be piped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

errors = Console(stderr=True, markup=False, highlight=False, emoji=False)


class CompilingBar(Progress):
    """A bar that asks how far the compilation is whenever it is drawn."""

    def get_renderables(self) -> Iterable[RenderableType]:
        """What is drawn now."""
        from silverball.physics.kernel import compiled_share

        for task in self.tasks:
            task.completed = compiled_share()
        return super().get_renderables()


@contextmanager
def compiling(kernel: str = "run_worlds", about: str = "ten seconds") -> Iterator[None]:
    """A bar while the physics is compiled: on the first start only, later ones load it from disk."""
    from silverball.physics.kernel import cache_folder, evict_old_code, is_compiled

    if is_compiled(kernel):
        yield
        return
    evict_old_code()
    often = "once on this machine" if cache_folder() else "at every start, for its cache cannot be written"
    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn()
    with CompilingBar(*columns, console=errors, transient=True, disable=not errors.is_terminal) as bar:
        bar.add_task(f"Compiling the physics, {often} (about {about}) …", total=1.0)
        yield
