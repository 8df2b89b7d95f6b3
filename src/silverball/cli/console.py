"""What does the terminal show while one waits?

Progress goes to standard error, so that standard output can be piped.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console

errors = Console(stderr=True)


@contextmanager
def compiling() -> Iterator[None]:
    """A moving line while the physics is compiled: on the first start only, later ones load it from disk."""
    from silverball.physics.kernel import forget_old_code, is_compiled

    if is_compiled():
        yield
        return
    forget_old_code()
    with errors.status("Compiling the physics, once on this machine (about ten seconds) …"):
        yield
