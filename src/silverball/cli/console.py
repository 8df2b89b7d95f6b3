"""What does the terminal show while one waits?

Progress goes to standard error, so that standard output can be piped.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console

errors = Console(stderr=True, markup=False, highlight=False, emoji=False)


@contextmanager
def compiling(kernel: str = "run_worlds", about: str = "ten seconds") -> Iterator[None]:
    """A moving line while the physics is compiled: on the first start only, later ones load it from disk."""
    from silverball.physics.kernel import cache_folder, forget_old_code, is_compiled

    if is_compiled(kernel):
        yield
        return
    forget_old_code()
    often = "once on this machine" if cache_folder() else "at every start, for its cache cannot be written"
    with errors.status(f"Compiling the physics, {often} (about {about}) …"):
        yield
